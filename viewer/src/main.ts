import "./style/base.css";
import "./style/views.css";
import "./style/panels.css";
import "./style/figures.css";
import "./style/run.css";
import { deviationPane } from "./deviation_pane";
import { h } from "./dom";
import { count, figures, plural } from "./format";
import { overlapPane } from "./overlap_pane";
import { type Report, UnreadableReport, readReport } from "./payload";
import { runPane, warningsOf } from "./run_pane";
import { Stage } from "./stage";
import { Store, type Theme, primitivesByNode } from "./state";
import { tabs } from "./tabs";
import { toolbar } from "./toolbar";
import { treePane } from "./tree_pane";

const k_themes: { value: Theme; text: string }[] = [
  { value: "auto", text: "Auto" },
  { value: "light", text: "Light" },
  { value: "dark", text: "Dark" },
];

function themeControl(store: Store): HTMLElement {
  const select = h(
    "select",
    { "aria-label": "Theme", change: () => store.set({ theme: select.value as Theme }) },
    ...k_themes.map(({ value, text }) => h("option", { value }, text)),
  );
  store.watch((state) => {
    select.value = state.theme;
    if (state.theme === "auto") delete document.documentElement.dataset["theme"];
    else document.documentElement.dataset["theme"] = state.theme;
  });
  return select;
}

function save(name: string, bytes: Uint8Array<ArrayBuffer>): void {
  const link = h("a", { href: URL.createObjectURL(new Blob([bytes])), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function header(report: Report, store: Store): HTMLElement {
  const { title, deviation, solid, primitives, downloads, cloud } = report.text;
  const facts = [
    cloud ? plural(cloud.points, "point") : null,
    plural(primitives.length, "primitive"),
    plural(solid.nodes.filter((node) => node.primitive !== null).length, "leaf", "leaves"),
    deviation ? `rms ${figures(deviation.all.rms)}` : null,
  ].filter((fact) => fact !== null);
  return h(
    "header",
    { class: "top" },
    h("h1", {}, title || "Report"),
    h("p", { class: "summary" }, facts.join(" · ")),
    h(
      "div",
      { class: "actions" },
      ...downloads.map(({ name, content }) =>
        h(
          "button",
          { type: "button", title: `Save ${name} (${count(content.bytes)} bytes)`, click: () => save(name, report.bytes(content)) },
          `↓ ${name.slice(name.lastIndexOf("."))}`,
        ),
      ),
      themeControl(store),
    ),
  );
}

function initialRange(report: Report): number {
  const { deviation } = report.text;
  if (!deviation) return 1;
  return Math.max(3 * deviation.noise, 1e-6 * report.radius);
}

function show(page: HTMLElement, report: Report): void {
  document.title = report.text.title ? `${report.text.title} – cloud2csg` : "cloud2csg report";
  const store = new Store({
    node: 0,
    hovered: null,
    group: null,
    colour: "primitive",
    layout: "side",
    divider: 0.5,
    range: initialRange(report),
    pointSize: 1,
    section: { on: false, axis: 0, place: 0.5, flipped: false },
    theme: "auto",
  });
  const byNode = primitivesByNode(report);
  const stage = new Stage(report, store, byNode);
  const warnings = warningsOf(report).length;
  page.replaceChildren(
    header(report, store),
    h(
      "main",
      {},
      h("section", { class: "views", "aria-label": "Views" }, toolbar(report, store, stage.views), stage.element),
      tabs("Report", [
        { id: "tree", name: "Tree", content: () => treePane(report, store, byNode) },
        { id: "deviation", name: "Deviation", content: () => deviationPane(report, store, stage.views) },
        { id: "overlap", name: "Overlap", content: () => overlapPane(report, store, byNode) },
        { id: "run", name: "Run", content: () => runPane(report), mark: warnings ? String(warnings) : null },
      ]),
    ),
  );
  document.documentElement.dataset["state"] = "ready";
}

async function start(): Promise<void> {
  const page = document.getElementById("page");
  if (!page) return;
  try {
    show(page, await readReport(document.getElementById("report")?.textContent ?? ""));
  } catch (error) {
    const text = error instanceof UnreadableReport ? error.message : `The report cannot be shown: ${String(error)}`;
    page.replaceChildren(h("p", { class: "failure", role: "alert" }, text));
    document.documentElement.dataset["state"] = "failed";
  }
}

void start();
