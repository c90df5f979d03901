/** How the solid was made: seconds, figures, what was made regular, options. */

import { h } from "./dom";
import { count, figures, percent, seconds, words } from "./format";
import type { Report, Snap, Statistics } from "./payload";
import { factList } from "./tree_pane";

const k_sums = new Set(["extraction", "total"]);

function timings(statistics: Statistics): HTMLElement {
  const stages = Object.entries(statistics.seconds).filter(([name, value]) => !k_sums.has(name) && value > 0);
  const most = Math.max(...stages.map(([, value]) => value), 1e-9);
  return h(
    "table",
    { class: "timings" },
    h("caption", { class: "unseen" }, "Seconds of each stage"),
    h(
      "tbody",
      {},
      ...stages.map(([name, value]) =>
        h(
          "tr",
          {},
          h("th", { scope: "row" }, words(name)),
          h("td", { class: "bar", style: `--share: ${(value / most).toFixed(4)}` }, h("i", {})),
          h("td", {}, seconds(value)),
        ),
      ),
      h("tr", { class: "sum" }, h("th", { scope: "row" }, "in all"), h("td", {}), h("td", {}, seconds(statistics.seconds["total"]))),
    ),
  );
}

function figuresOf(statistics: Statistics): [string, string][] {
  const facts: [string, string][] = [
    ["points", count(statistics.points)],
    ["on no primitive", count(statistics.unassigned_points)],
    ["noise σ", figures(statistics.noise)],
    ["rms distance", figures(statistics.fit.rms_distance)],
    ["95 % within", figures(statistics.fit.p95_distance)],
    ["unexplained", count(statistics.fit.unexplained_points)],
    ["rms angle", `${figures(statistics.fit.rms_angle_deg)}°`],
    ["nodes", count(statistics.tree.size)],
    ["leaves", count(statistics.tree.leaves)],
    ["levels", count(statistics.tree.levels)],
    ["price", figures(statistics.tree.price)],
    ["operations", count(statistics.tree.operations)],
    ["strategy", statistics.strategy],
    ["seed", String(statistics.seed)],
    ["threads", String(statistics.threads)],
  ];
  const { cells } = statistics;
  if (cells) {
    facts.push(["cells", `${count(cells["cells"] as number)}, ${count(cells["open_cells"] as number)} open`]);
    facts.push(["smallest tree", cells["is_minimal"] ? "proved" : "not proved"]);
    const speaking = Math.max(1, cells["speaking_points"] as number);
    facts.push(["contradicted", percent((cells["contradicted_points"] as number) / speaking)]);
  }
  return facts;
}

const k_regular: Record<string, string> = {
  directions: "parallel or orthogonal",
  faces: "in one plane",
  centres: "in line",
  radii: "of equal radius",
};
const k_snapped: Record<string, string> = {
  direction: "directions made parallel or orthogonal",
  offset: "planes made coplanar",
  axis: "axes made coaxial",
  radius: "radii made equal",
  arrangement: "axes put into rows, grids or circles",
  "given direction": "directions made one of those given",
  "given radius": "radii made one of those given",
};

/** What was snapped in one way, the largest changes first; surfaces are numbered as they were found. */
function snapped(kind: string, snaps: Snap[]): HTMLElement {
  const unit = kind.endsWith("direction") ? "°" : "";
  const sorted = [...snaps].sort((a, b) => b.change - a.change);
  const lines = sorted.map(({ type, surface, change }) => h("li", {}, `${type} ${surface} by ${figures(change)}${unit}`));
  const title = h("strong", {}, `${sorted.length} ${k_snapped[kind] ?? words(kind)}`);
  return h(
    "li",
    {},
    h("details", {}, h("summary", {}, title, ` — by up to ${figures(sorted[0].change)}${unit}`), h("ol", {}, ...lines)),
  );
}

function regularities(report: Report): HTMLElement {
  const items: HTMLElement[] = [];
  const snaps = report.text.statistics?.finding?.snaps ?? [];
  for (const kind of new Set(snaps.map((snap) => snap.kind))) {
    items.push(snapped(kind, snaps.filter((snap) => snap.kind === kind)));
  }
  for (const { type, primitives, spread } of report.text.statistics?.refine?.regularities ?? []) {
    const names = [...new Set(primitives)].map((p) => report.text.primitives[p].id);
    const before = type === "directions" ? `${figures((spread * 180) / Math.PI)}°` : figures(spread);
    items.push(
      h("li", {}, h("strong", {}, k_regular[type] ?? words(type)), ` — ${names.join(", ")}; before: ${before} apart`),
    );
  }
  return items.length
    ? h("ul", { class: "plain" }, ...items)
    : h("p", { class: "note" }, "Nothing was made regular.");
}

function parameters(report: Report): HTMLElement[] {
  const groups = [...new Set(report.text.parameters.map((parameter) => parameter.group))];
  return groups.map((group) =>
    h(
      "table",
      { class: "parameters" },
      h("caption", {}, group),
      h(
        "tbody",
        {},
        ...report.text.parameters
          .filter((parameter) => parameter.group === group)
          .map(({ name, value }) => h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, value))),
      ),
    ),
  );
}

export function warningsOf(report: Report): string[] {
  const { statistics } = report.text;
  return [...(statistics?.verdict.doubts ?? []), ...(statistics?.warnings ?? []), ...report.text.warnings];
}

export function runPane(report: Report): HTMLElement {
  const { statistics, source } = report.text;
  const warnings = warningsOf(report);
  return h(
    "div",
    { class: "stack" },
    warnings.length ? h("ul", { class: "warnings" }, ...warnings.map((text) => h("li", {}, text))) : null,
    source ? h("p", { class: "source" }, source) : null,
    statistics ? h("h3", {}, "Time") : null,
    statistics ? timings(statistics) : null,
    statistics ? h("h3", {}, "Figures") : null,
    statistics ? factList(figuresOf(statistics)) : null,
    h("h3", {}, "Made regular"),
    regularities(report),
    report.text.parameters.length ? h("h3", {}, "Parameters") : null,
    ...parameters(report),
    h("p", { class: "note" }, report.text.program),
  );
}
