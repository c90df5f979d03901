/** The overlap graph and its partitions, the maximal cliques. */

import {
  type SimulationLinkDatum,
  type SimulationNodeDatum,
  forceCollide,
  forceLink,
  forceManyBody,
  forceSimulation,
  forceX,
  forceY,
} from "d3-force";
import { css, primitiveColour } from "./colours";
import { leafOf } from "./deviation_pane";
import { h, svg } from "./dom";
import { count, figures, plural } from "./format";
import type { Report } from "./payload";
import { type Store, focusOf, isDark } from "./state";

const k_most_drawn = 400;
const k_most_listed = 300;
const k_width = 400;
const k_height = 300;

interface Body extends SimulationNodeDatum {
  primitive: number;
}

/** The same picture for the same graph: d3 places nodes on a spiral first, and its random numbers are fixed. */
function layOut(size: number, edges: [number, number][]): Body[] {
  const bodies: Body[] = Array.from({ length: size }, (_, primitive) => ({ primitive }));
  const links: SimulationLinkDatum<Body>[] = edges.map(([source, target]) => ({ source, target }));
  const apart = Math.min(46, 380 / Math.sqrt(size));
  forceSimulation(bodies)
    .force("link", forceLink(links).distance(apart).strength(0.25))
    .force("charge", forceManyBody().strength(-5 * apart))
    .force("collide", forceCollide(apart * 0.4))
    .force("x", forceX(0).strength(0.06))
    .force("y", forceY(0).strength(0.09))
    .stop()
    .tick(300);
  const xs = bodies.map((body) => body.x ?? 0);
  const ys = bodies.map((body) => body.y ?? 0);
  const margin = 26;
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const scale = Math.min(
    2,
    (k_width - 2 * margin) / Math.max(1, right - left),
    (k_height - 2 * margin) / Math.max(1, bottom - top),
  );
  for (const body of bodies) {
    body.x = k_width / 2 + ((body.x ?? 0) - (left + right) / 2) * scale;
    body.y = k_height / 2 + ((body.y ?? 0) - (top + bottom) / 2) * scale;
  }
  return bodies;
}

function graphPicture(report: Report, store: Store, byNode: Set<number>[], edges: [number, number][]): HTMLElement {
  const bodies = layOut(report.text.primitives.length, edges);
  const radius = bodies.length > 80 ? 4 : bodies.length > 30 ? 6 : 8;
  const lines = edges.map(([a, b]) =>
    svg("line", { x1: bodies[a].x!, y1: bodies[a].y!, x2: bodies[b].x!, y2: bodies[b].y! }),
  );
  const dots = bodies.map((body) =>
    svg(
      "circle",
      {
        cx: body.x!,
        cy: body.y!,
        r: radius,
        mouseenter: () => store.set({ hovered: body.primitive, group: null }),
        mouseleave: () => store.set({ hovered: null }),
        click: () => store.set({ node: leafOf(report, body.primitive) }),
      },
      svg("title", {}, report.text.primitives[body.primitive].id),
    ),
  );
  const names = bodies.map((body) =>
    svg("text", { x: body.x!, y: body.y! - radius - 3, "text-anchor": "middle" }, shortened(report.text.primitives[body.primitive].id)),
  );
  store.watch((state) => {
    const dark = isDark(state);
    const focus = focusOf(state, byNode);
    const has = (primitive: number): boolean => !focus || focus.has(primitive);
    dots.forEach((dot, p) => {
      dot.setAttribute("fill", css(primitiveColour(p, dark)));
      dot.classList.toggle("dim", !has(p));
    });
    names.forEach((name, p) => {
      name.classList.toggle("dim", !has(p));
      name.classList.toggle("crowded", bodies.length > 40 && !(focus && has(p)));
    });
    edges.forEach(([a, b], k) => {
      lines[k].classList.toggle("dim", focus !== null && !(has(a) && has(b)));
      lines[k].classList.toggle("lit", focus !== null && has(a) && has(b));
    });
  });
  const summary = `Overlap graph: ${plural(bodies.length, "primitive")}, ${plural(edges.length, "overlap")}.`;
  return h(
    "div",
    { class: "graph" },
    svg(
      "svg",
      { viewBox: `0 0 ${k_width} ${k_height}`, role: "img", "aria-label": summary },
      ...lines,
      ...dots,
      ...names,
    ),
  );
}

const shortened = (name: string): string => (name.length > 14 ? `${name.slice(0, 13)}…` : name);

function cliqueList(report: Report, store: Store, cliques: number[][]): HTMLElement {
  return h(
    "ol",
    { class: "cliques" },
    ...cliques.slice(0, k_most_listed).map((clique) => {
      const light = (): void => store.set({ group: clique, hovered: null });
      const dim = (): void => store.set({ group: null });
      return h(
        "li",
        {},
        h(
          "button",
          { type: "button", mouseenter: light, mouseleave: dim, focus: light, blur: dim },
          h("strong", {}, String(clique.length)),
          h("span", {}, clique.map((p) => report.text.primitives[p].id).join(", ")),
        ),
      );
    }),
  );
}

export function overlapPane(report: Report, store: Store, byNode: Set<number>[]): HTMLElement {
  const { overlap, primitives } = report.text;
  if (!overlap) {
    return h("p", { class: "note" }, "The overlap graph has too many primitives or overlaps to be shown.");
  }
  const { cliques } = overlap;
  return h(
    "div",
    { class: "stack" },
    h("h3", {}, "Overlap graph"),
    h(
      "p",
      { class: "note" },
      `${plural(primitives.length, "primitive")}, ${plural(overlap.edges.length, "overlap")}; ` +
        `nearer than ${figures(overlap.tolerance)} counts as overlapping.`,
    ),
    primitives.length <= k_most_drawn
      ? graphPicture(report, store, byNode, overlap.edges)
      : h("p", { class: "note" }, `Drawn for up to ${k_most_drawn} primitives.`),
    h("h3", {}, `Partitions: ${plural(overlap.clique_count, "maximal clique")}`),
    cliqueList(report, store, cliques),
    overlap.clique_count > k_most_listed
      ? h("p", { class: "note" }, `The largest ${count(Math.min(k_most_listed, cliques.length))} are listed.`)
      : null,
  );
}
