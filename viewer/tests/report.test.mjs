// The page of a report, as readers use it. Takes from the environment: REPORT (a report of model M0 with a cloud),
// RAW (one from points alone), HOSTILE (one whose names try to break out), VIEWER_FOLDER (where npm ci ran), CHROMIUM, and PICTURES (a folder for
// screenshots; optional).
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const folder = process.env.VIEWER_FOLDER ?? dirname(here);
const { chromium } = createRequire(join(folder, "package.json"))("playwright-core");

const { REPORT, RAW, HOSTILE, CHROMIUM = "/usr/bin/chromium", PICTURES } = process.env;
let browser;

before(async () => {
  browser = await chromium.launch({
    executablePath: CHROMIUM,
    args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"],
  });
});
after(() => browser?.close());

async function open(options = {}, file = REPORT) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
  const page = await context.newPage();
  const faults = [];
  page.on("console", (message) => {
    // Drivers without a graphics card say how slow they are.
    if (["error", "warning"].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text())) {
      faults.push(message.text());
    }
  });
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) faults.push(`asked for ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector("html[data-state]");
  assert.equal(await page.locator("html").getAttribute("data-state"), "ready");
  await settle(page);
  return { page, faults, close: () => context.close() };
}

/** Until two pictures in a row are the same: the view has come to rest. */
async function settle(page) {
  let previous = "";
  for (let k = 0; k < 40; ++k) {
    const picture = (await page.locator(".host").screenshot()).toString("base64");
    if (picture === previous) return picture;
    previous = picture;
  }
  throw new Error("the view does not come to rest");
}

async function keepPicture(page, name) {
  if (PICTURES) await page.screenshot({ path: join(PICTURES, `${name}.png`) });
}

/** Counts what a half of the canvas shows: pixels unlike the background, and how colourful they are. */
async function look(page, half) {
  const box = await page.locator(".host").boundingBox();
  const clip = { x: box.x + (half === "solid" ? box.width / 2 + 2 : 0), y: box.y + 40, width: box.width / 2 - 4, height: box.height - 200 };
  const picture = (await page.screenshot({ clip })).toString("base64");
  return page.evaluate(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data: pixels } = context.getImageData(0, 0, image.width, image.height);
    let [drawn, vivid] = [0, 0];
    for (let i = 0; i < pixels.length; i += 4) {
      const differs = [0, 1, 2].some((k) => Math.abs(pixels[i + k] - pixels[k]) > 12);
      const spread = Math.max(pixels[i], pixels[i + 1], pixels[i + 2]) - Math.min(pixels[i], pixels[i + 1], pixels[i + 2]);
      if (differs) ++drawn;
      if (spread > 70) ++vivid;
    }
    return { drawn, vivid };
  }, picture);
}

for (const [name, viewport] of [
  ["wide", { width: 1920, height: 1080 }],
  ["usual", { width: 1280, height: 800 }],
  ["narrow", { width: 800, height: 900 }],
]) {
  test(`loads without a fault, and nothing is cut off: ${name}`, async () => {
    const { page, faults, close } = await open({ viewport });
    const [cloud, solid] = [await look(page, "cloud"), await look(page, "solid")];
    assert.ok(cloud.drawn > 2000, `the cloud is seen: ${cloud.drawn} pixels`);
    assert.ok(solid.drawn > 2000, `the solid is seen: ${solid.drawn} pixels`);
    const tooWide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(tooWide <= 0, `the page is ${tooWide} pixels wider than the window`);
    for (const tab of ["Deviation", "Overlap", "Run", "Tree"]) {
      await page.getByRole("tab", { name: tab }).click();
      const panel = page.getByRole("tabpanel", { name: tab });
      assert.ok((await panel.innerText()).length > 20, tab);
      const beyond = await panel.evaluate((element) => element.scrollWidth - element.clientWidth);
      assert.ok(beyond <= 0, `${tab} is ${beyond} pixels too wide`);
      await keepPicture(page, `${name}_${tab.toLowerCase()}`);
    }
    assert.deepEqual(faults, []);
    await close();
  });
}

test("light and dark follow the system, and can be chosen", async () => {
  const back = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const brightness = (colour) => colour.match(/\d+/g).slice(0, 3).reduce((sum, value) => sum + Number(value), 0) / 3;
  const { page, faults, close } = await open({ colorScheme: "dark" });
  assert.ok(brightness(await back(page)) < 60);
  const dark = await settle(page);
  await page.getByLabel("Theme").selectOption("light");
  assert.ok(brightness(await back(page)) > 200);
  assert.notEqual(await settle(page), dark);
  await page.emulateMedia({ colorScheme: "light" });
  await page.getByLabel("Theme").selectOption("dark");
  assert.ok(brightness(await back(page)) < 60);
  await settle(page);
  await keepPicture(page, "dark");
  assert.deepEqual(faults, []);
  await close();
});

test("a node that is picked is shown alone", async () => {
  const { page, close } = await open();
  const whole = await look(page, "solid");
  const leaf = page.getByRole("treeitem", { name: "Cylinder_2" });
  await leaf.locator("> .line").click();
  await page.mouse.move(5, 5);
  await settle(page);
  const part = await look(page, "solid");
  assert.ok(part.vivid < whole.vivid / 3, `${part.vivid} of ${whole.vivid} pixels`);
  assert.ok(part.vivid > 20);
  assert.equal(await leaf.getAttribute("aria-selected"), "true");
  assert.match(await page.locator(".pane-name.solid").innerText(), /Cylinder_2/);
  assert.match(await page.locator(".detail").innerText(), /radius\s+0\.2/);
  await keepPicture(page, "picked");
  await page.getByRole("button", { name: "Show the whole" }).click();
  await settle(page);
  assert.equal((await look(page, "solid")).vivid, whole.vivid);
  await close();
});

test("a primitive that is pointed at lights up its points", async () => {
  const { page, close } = await open();
  const all = await look(page, "cloud");
  await page.getByRole("treeitem", { name: "Sphere_6" }).locator("> .line").hover();
  await settle(page);
  const lit = await look(page, "cloud");
  assert.ok(lit.vivid < all.vivid / 4 && lit.vivid > 100, `${lit.vivid} of ${all.vivid} pixels`);
  await keepPicture(page, "pointed");
  await page.mouse.move(5, 5);
  await settle(page);
  assert.equal((await look(page, "cloud")).vivid, all.vivid);
  // The same from a partition of the overlap graph.
  await page.getByRole("tab", { name: "Overlap" }).click();
  await page.getByRole("button", { name: "Sphere_6, Sphere_7" }).focus();
  await settle(page);
  const clique = await look(page, "cloud");
  assert.ok(clique.vivid < all.vivid / 3 && clique.vivid > 100, `${clique.vivid} of ${all.vivid} pixels`);
  await close();
});

test("a click on points or on the solid picks what is there", async () => {
  const { page, close } = await open();
  const host = await page.locator(".host").boundingBox();
  for (const place of [0.25, 0.75]) {
    const [x, y] = [host.x + place * host.width, host.y + 0.46 * host.height];
    await page.mouse.move(x, y);
    await page.waitForSelector(".tip:not([hidden])");
    const name = await page.locator(".tip b").innerText();
    await page.mouse.click(x, y);
    assert.match(await page.locator(".pane-name.solid").innerText(), new RegExp(name));
    assert.equal(await page.locator('[role="treeitem"][aria-selected="true"]').count(), 1);
    await page.locator(".host").focus();
    await page.keyboard.press("Escape");
    assert.match(await page.locator(".pane-name.solid").innerText(), /the whole/);
  }
  await close();
});

test("the tree is used by the keyboard", async () => {
  const { page, close } = await open();
  const focused = () => page.evaluate(() => document.activeElement?.getAttribute("aria-label"));
  await page.getByRole("tree").getByRole("treeitem").first().focus();
  assert.match(await focused(), /^Union of 12/);
  await page.keyboard.press("ArrowDown");
  assert.match(await focused(), /^Difference of 2/);
  await page.keyboard.press("ArrowLeft");
  assert.equal(await page.locator("#node-1").getAttribute("aria-expanded"), "false");
  assert.ok(await page.getByRole("treeitem", { name: "Cylinder_2" }).isHidden());
  await page.keyboard.press("ArrowDown");
  assert.match(await focused(), /^Cylinder_0/);
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  assert.match(await focused(), /^Cylinder_2/);
  await page.keyboard.type("Box_3");
  assert.match(await focused(), /^Box_3/);
  await page.keyboard.press("Enter");
  assert.match(await page.locator(".pane-name.solid").innerText(), /Box_3/);
  await page.keyboard.press("ArrowLeft");
  assert.match(await focused(), /^Union/);
  await page.keyboard.press("End");
  assert.match(await focused(), /^minus Sphere/);
  await page.keyboard.press("Home");
  assert.match(await focused(), /^Union of 12/);
  // One stop for the whole tree.
  assert.equal(await page.locator('[role="treeitem"][tabindex="0"]').count(), 1);
  await page.keyboard.press("Escape");
  assert.match(await page.locator(".pane-name.solid").innerText(), /the whole/);
  await close();
});

test("the view is turned by the keyboard, and comes back", async () => {
  const { page, close } = await open({ reducedMotion: "reduce" });
  await page.locator(".host").focus();
  const first = await settle(page);
  await page.keyboard.press("ArrowRight");
  assert.notEqual(await settle(page), first);
  await page.keyboard.press("0");
  assert.equal(await settle(page), first);
  await close();
});

test("the section plane cuts cloud and solid", async () => {
  const { page, close } = await open();
  const before = [await look(page, "cloud"), await look(page, "solid")];
  await page.getByLabel("Section", { exact: true }).check();
  await settle(page);
  const cut = [await look(page, "cloud"), await look(page, "solid")];
  for (const k of [0, 1]) assert.ok(cut[k].drawn < 0.9 * before[k].drawn, `${cut[k].drawn} of ${before[k].drawn}`);
  await keepPicture(page, "section");
  await page.getByRole("button", { name: "Show the other side of the section" }).click();
  const half = await settle(page);
  await page.getByLabel("Section across").selectOption("Z");
  assert.notEqual(await settle(page), half);
  await page.getByLabel("Section", { exact: true }).uncheck();
  await settle(page);
  assert.equal((await look(page, "solid")).drawn, before[1].drawn);
  await close();
});

test("distances colour the cloud, with a legend", async () => {
  const { page, close } = await open();
  const before = await settle(page);
  assert.ok(await page.locator(".legend").isHidden());
  await page.getByRole("button", { name: "Distance" }).click();
  assert.notEqual(await settle(page), before);
  assert.ok(await page.locator(".legend").isVisible());
  assert.equal(await page.locator(".legend rect").count(), 41);
  await keepPicture(page, "distance");
  await close();
});

test("the slider goes from cloud to solid", async () => {
  const { page, close } = await open();
  await page.getByRole("button", { name: "Slider" }).click();
  const slider = page.getByRole("slider", { name: "Slider between cloud and solid" });
  const half = await settle(page);
  await slider.focus();
  await page.keyboard.press("End");
  assert.equal(await slider.getAttribute("aria-valuenow"), "100");
  const cloud = await settle(page);
  await page.keyboard.press("Home");
  assert.equal(await slider.getAttribute("aria-valuenow"), "0");
  assert.notEqual(await settle(page), cloud);
  assert.notEqual(cloud, half);
  await close();
});

test("the deviation report says what the program measured", async () => {
  const { page, close } = await open();
  await page.getByRole("tab", { name: "Deviation" }).click();
  const panel = page.getByRole("tabpanel", { name: "Deviation" });
  const text = await panel.innerText();
  for (const word of ["RMS", "95 % within", "Mean", "Largest outside", "Noise"]) assert.ok(text.includes(word), word);
  const rows = panel.locator("tbody tr");
  assert.equal(await rows.count(), 17);
  const points = async () => (await rows.locator("td:nth-child(2)").allInnerTexts()).map((cell) => Number(cell.replace(/\D/g, "")));
  await panel.getByRole("button", { name: "Points" }).click();
  const sorted = await points();
  assert.deepEqual(sorted, [...sorted].sort((a, b) => b - a));
  const before = await settle(page);
  await panel.locator(".worst button").first().click();
  assert.notEqual(await settle(page), before);
  await close();
});

test("the written files are saved", async () => {
  const { page, close } = await open();
  const waiting = page.waitForEvent("download");
  await page.getByRole("button", { name: ".scad" }).click();
  const download = await waiting;
  assert.match(download.suggestedFilename(), /\.scad$/);
  const { readFile } = await import("node:fs/promises");
  assert.match(await readFile(await download.path(), "utf8"), /difference\(\)/);
  await close();
});

test("what was made regular is listed, the largest change first", async () => {
  const { page, faults, close } = await open({}, RAW);
  await page.getByRole("tab", { name: "Run" }).click();
  const kinds = page.locator("details", { hasText: "radii made equal" });
  await kinds.locator("summary").click();
  const lines = await kinds.locator("li").allInnerTexts();
  const changes = lines.map((line) => Number(/^(?:cylinder|sphere) \d+ by ([0-9.e−-]+)$/.exec(line)?.[1].replace("−", "-")));
  assert.ok(changes.length > 1 && changes.every((change) => change > 0), lines.join());
  assert.deepEqual(changes, [...changes].sort((a, b) => b - a));
  assert.match(await kinds.locator("summary").innerText(), new RegExp(`^${lines.length} radii`));
  await keepPicture(page, "regular");
  assert.deepEqual(faults, []);
  await close();
});

test("names are shown as they are, and run nothing", async () => {
  const { page, faults, close } = await open({}, HOSTILE);
  let asked = false;
  page.on("dialog", (dialog) => {
    asked = true;
    void dialog.dismiss();
  });
  const names = await page.locator(".tree .name").allInnerTexts();
  assert.ok(names.some((name) => name.includes("</script><script>alert(1)</script>")), names.join());
  assert.ok(names.some((name) => name.includes("$(reboot)")), names.join());
  for (const tab of ["Deviation", "Overlap", "Run"]) await page.getByRole("tab", { name: tab }).click();
  assert.equal(await page.locator("#page img, #page script").count(), 0);
  assert.equal(asked, false);
  assert.deepEqual(faults, []);
  await close();
});
