// A picture of a report: picture.mjs FOLDER REPORT.html OUT.png, where `npm ci` ran in FOLDER.
import { createRequire } from "node:module";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

const [folder, report, output] = process.argv.slice(2).map((name) => resolve(name));
const { chromium } = createRequire(join(folder, "package.json"))("playwright-core");

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"],
});
const page = await browser.newPage({ viewport: { width: 1280, height: 760 }, colorScheme: "light" });
await page.goto(pathToFileURL(report).href);
await page.waitForSelector("html[data-state=ready]");
await page.getByLabel("Section", { exact: true }).check();
await page.getByLabel("Place of the section").fill("560");
await page.getByRole("tab", { name: "Deviation" }).click();
await page.mouse.move(2, 2);
await page.waitForTimeout(1500);
await page.screenshot({ path: output });
await browser.close();
