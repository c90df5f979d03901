/** How far the points are from the solid: the report that metrologists know. */

import { css, primitiveColour } from "./colours";
import { h } from "./dom";
import { count, figures, percent, signed } from "./format";
import { histogram } from "./histogram";
import type { Deviation, Report } from "./payload";
import { type Store, isDark } from "./state";
import type { Views } from "./views";

type Entry = Deviation["by_primitive"][number];
interface Column {
  name: string;
  title: string;
  value: (entry: Entry) => number;
  text: (value: number) => string;
}

const greatest = (entry: { least: number; greatest: number }): number =>
  Math.max(Math.abs(entry.least), Math.abs(entry.greatest));

const k_columns: Column[] = [
  { name: "Points", title: "Points whose nearest surface it is", value: (e) => e.points, text: count },
  { name: "Mean", title: "Mean signed distance: positive outside", value: (e) => e.mean, text: (v) => signed(v, 2) },
  { name: "RMS", title: "Root mean square distance", value: (e) => e.rms, text: (v) => figures(v, 2) },
  { name: "95 %", title: "95 % of the points are nearer than this", value: (e) => e.p95, text: (v) => figures(v, 2) },
  { name: "Max", title: "Largest distance", value: greatest, text: (v) => figures(v, 2) },
];

function tile(name: string, value: string, note: string | null = null): HTMLElement {
  return h("div", { class: "tile", title: note }, h("dt", {}, name), h("dd", {}, value));
}

function tiles(deviation: Deviation): HTMLElement {
  const { all } = deviation;
  const beyond = deviation.beyond_three_noises;
  return h(
    "dl",
    { class: "tiles" },
    tile("Points", count(all.points)),
    tile("RMS", figures(all.rms)),
    tile("95 % within", figures(all.p95)),
    tile("Mean", signed(all.mean)),
    tile("Std. deviation", figures(all.standard_deviation)),
    tile("Largest outside", signed(Math.max(0, all.greatest))),
    tile("Largest inside", signed(Math.min(0, all.least))),
    tile("Noise σ", figures(deviation.noise)),
    tile("Beyond 3 σ", percent(beyond / all.points), `${count(beyond)} points`),
  );
}

function primitiveTable(report: Report, deviation: Deviation, store: Store): HTMLElement {
  const body = h("tbody");
  let order = 2;
  let descending = true;
  const fill = (): void => {
    const { value } = k_columns[order];
    const rows = [...deviation.by_primitive].sort((a, b) => (descending ? -1 : 1) * (value(a) - value(b)));
    const worst = Math.max(...rows.map((entry) => entry.rms), 1e-300);
    const dark = isDark(store.state);
    body.replaceChildren(
      ...rows.map((entry) =>
        h(
          "tr",
          {
            mouseenter: () => store.set({ hovered: entry.primitive }),
            mouseleave: () => store.set({ hovered: null }),
          },
          h(
            "th",
            { scope: "row" },
            h("span", { class: "swatch", style: `background-color: ${css(primitiveColour(entry.primitive, dark))}` }),
            h(
              "button",
              {
                type: "button",
                class: "link",
                focus: () => store.set({ hovered: entry.primitive }),
                blur: () => store.set({ hovered: null }),
                click: () => store.set({ node: leafOf(report, entry.primitive) }),
              },
              report.text.primitives[entry.primitive].id,
            ),
          ),
          ...k_columns.map((column) =>
            h(
              "td",
              column.name === "RMS" ? { class: "bar", style: `--share: ${(entry.rms / worst).toFixed(3)}` } : {},
              column.text(withoutRounding(column.value(entry), report.radius)),
            ),
          ),
        ),
      ),
    );
    heads.forEach((head, k) =>
      head.setAttribute("aria-sort", k !== order ? "none" : descending ? "descending" : "ascending"),
    );
  };
  const heads = k_columns.map((column, k) =>
    h(
      "th",
      { scope: "col", title: column.title },
      h(
        "button",
        {
          type: "button",
          click: () => {
            descending = k === order ? !descending : true;
            order = k;
            fill();
          },
        },
        column.name,
      ),
    ),
  );
  store.watch((state, before) => (state === before || state.theme !== before.theme) && fill());
  return h(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": "Deviation by primitive" },
    h("table", {}, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Primitive"), ...heads)), body),
  );
}

/** What is zero but for the rounding of double precision. */
const withoutRounding = (value: number, size: number): number => (Math.abs(value) < 1e-10 * size ? 0 : value);

/** The first leaf of the tree that is this primitive; the whole where there is none. */
export function leafOf(report: Report, primitive: number): number {
  return Math.max(
    0,
    report.text.solid.nodes.findIndex((node) => node.primitive === primitive),
  );
}

function worstPoints(report: Report, deviation: Deviation, views: Views): HTMLElement {
  return h(
    "ol",
    { class: "worst" },
    ...deviation.worst.map(({ position, distance, primitive }) =>
      h(
        "li",
        {},
        h(
          "button",
          { type: "button", title: "Show it in the middle of the view", click: () => views.visit(position) },
          h("strong", {}, signed(distance)),
          h("span", {}, report.text.primitives[primitive]?.id ?? ""),
          h("span", { class: "place" }, position.map((value) => figures(value, 4)).join(", ")),
        ),
      ),
    ),
  );
}

export function deviationPane(report: Report, store: Store, views: Views): HTMLElement {
  const { deviation } = report.text;
  const { points } = report;
  if (!deviation || !points) {
    return h("p", { class: "note" }, "There is no cloud in this report, so there are no distances.");
  }
  const chart = h("div");
  store.watch((state, before) => {
    if (state !== before && state.range === before.range && state.theme === before.theme) return;
    chart.replaceChildren(
      histogram(points.distances, state.range, isDark(state), { height: 170, sigma: deviation.noise }),
    );
  });
  const { shown, points: all } = report.text.cloud!;
  return h(
    "div",
    { class: "stack" },
    h("h3", {}, "Signed distance to the solid"),
    tiles(deviation),
    chart,
    h(
      "p",
      { class: "note" },
      "Positive is outside the solid. The line is a normal distribution as wide as the noise.",
      shown < all ? ` The histogram is of ${count(shown)} of ${count(all)} points; figures are of all.` : "",
    ),
    h("h3", {}, "By primitive"),
    primitiveTable(report, deviation, store),
    h("h3", {}, "Farthest points"),
    worstPoints(report, deviation, views),
  );
}
