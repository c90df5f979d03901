/** The tree as an outline: pick a node to see its solid alone, point at a primitive to light up its points. */

import { css, primitiveColour } from "./colours";
import { h } from "./dom";
import { count, figures, signed } from "./format";
import { histogram } from "./histogram";
import type { PrimitiveEntry, Report, TreeNode } from "./payload";
import { type Store, isDark } from "./state";

const k_signs: Record<string, string> = {
  union: "∪",
  intersection: "∩",
  difference: "−",
  complement: "¬",
  empty: "∅",
  full: "∞",
};
const k_names: Record<string, string> = {
  union: "Union",
  intersection: "Intersection",
  difference: "Difference",
  complement: "Complement",
  empty: "Empty",
  full: "All of space",
};
/** Larger trees begin folded below this level. */
const k_open_levels = 2;
const k_large_tree = 200;

interface Row {
  item: HTMLLIElement;
  line: HTMLDivElement;
  group: HTMLUListElement | null;
  parent: number;
}

export function nodeName(report: Report, index: number): string {
  const node = report.text.solid.nodes[index];
  if (node.primitive !== null) return report.text.primitives[node.primitive].id;
  return k_names[node.operation];
}

class TreePane {
  readonly element: HTMLElement;
  private readonly rows = new Map<number, Row>();
  private readonly list: HTMLUListElement;
  private readonly detail = h("section", { class: "detail", "aria-live": "polite", "aria-label": "Chosen part" });
  private typed = "";
  private typedAt = 0;

  constructor(
    private readonly report: Report,
    private readonly store: Store,
    private readonly byNode: Set<number>[],
  ) {
    this.list = h("ul", {
      role: "tree",
      class: "tree",
      "aria-label": "Tree of the solid",
      keydown: (event: KeyboardEvent) => this.onKey(event),
      mouseleave: () => this.store.set({ hovered: null, group: null }),
      focusout: () => this.store.set({ hovered: null, group: null }),
    });
    this.addRow(0, 0, 0, this.list, 1, 1);
    this.element = h("div", { class: "tree-pane" }, this.list, this.detail);
    store.watch((state, before) => {
      if (state === before || state.node !== before.node) this.choose(state.node);
      if (state === before || state.hovered !== before.hovered) this.mark(state.hovered);
      if (state === before || state.theme !== before.theme) this.paint();
      if (state === before || state.node !== before.node || state.theme !== before.theme) this.showDetail();
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.paint());
  }

  private get nodes(): TreeNode[] {
    return this.report.text.solid.nodes;
  }

  private addRow(index: number, parent: number, level: number, into: HTMLUListElement, place: number, size: number) {
    const node = this.nodes[index];
    const isSubtracted = index !== 0 && this.nodes[parent].operation === "difference" && place > 1;
    const hasChildren = node.children.length > 0;
    const line = this.line(index, isSubtracted);
    const group = hasChildren ? h("ul", { role: "group" }) : null;
    const item = h(
      "li",
      {
        role: "treeitem",
        id: `node-${index}`,
        tabindex: index === 0 ? 0 : -1,
        "aria-level": level + 1,
        "aria-posinset": place,
        "aria-setsize": size,
        "aria-selected": "false",
        "aria-label": this.label(index, isSubtracted),
        "aria-expanded": hasChildren ? "false" : null,
        style: `--level: ${level}`,
        focus: () => this.point(index),
      },
      line,
      group,
    );
    into.append(item);
    this.rows.set(index, { item, line, group, parent });
    const isLarge = this.nodes.length > k_large_tree;
    if (hasChildren && (!isLarge || level < k_open_levels)) this.unfold(index);
  }

  private label(index: number, isSubtracted: boolean): string {
    const node = this.nodes[index];
    const name = nodeName(this.report, index);
    const kind =
      node.primitive === null
        ? node.children.length
          ? `of ${node.children.length}`
          : ""
        : this.report.text.primitives[node.primitive].type.replaceAll("_", " ");
    return `${isSubtracted ? "minus " : ""}${name} ${kind}`.trim();
  }

  private line(index: number, isSubtracted: boolean): HTMLDivElement {
    const node = this.nodes[index];
    const { primitive } = node;
    const summary = this.report.text.deviation?.by_primitive.find((entry) => entry.primitive === primitive);
    const side =
      primitive === null
        ? h("span", { class: "side" }, node.children.length ? `${node.children.length} parts` : "")
        : h("span", { class: "side" }, summary ? `${count(summary.points)} pts` : "");
    return h(
      "div",
      {
        class: `line${isSubtracted ? " subtracted" : ""}`,
        click: () => {
          this.store.set({ node: index });
          this.rows.get(index)?.item.focus({ preventScroll: true });
        },
        dblclick: () => this.toggle(index),
        mouseenter: () => this.point(index),
      },
      h("span", {
        class: "twist",
        "aria-hidden": "true",
        click: (event: MouseEvent) => {
          event.stopPropagation();
          this.toggle(index);
        },
      }),
      primitive === null
        ? h("span", { class: "sign", "aria-hidden": "true" }, k_signs[node.operation])
        : h("span", { class: "swatch", "aria-hidden": "true", "data-primitive": primitive }),
      h("span", { class: "name" }, isSubtracted ? h("span", { class: "minus" }, "− ") : null, nodeName(this.report, index)),
      primitive === null
        ? null
        : h("span", { class: "type" }, this.report.text.primitives[primitive].type.replaceAll("_", " ")),
      side,
    );
  }

  /** Children are made when they are first seen. */
  private unfold(index: number): void {
    const row = this.rows.get(index);
    if (!row?.group) return;
    if (row.group.childElementCount === 0) {
      const level = Number(row.item.getAttribute("aria-level"));
      const { children } = this.nodes[index];
      children.forEach((child, k) => this.addRow(child, index, level, row.group!, k + 1, children.length));
      this.paint(row.group);
    }
    row.item.setAttribute("aria-expanded", "true");
  }

  private fold(index: number): void {
    this.rows.get(index)?.item.setAttribute("aria-expanded", "false");
  }

  private isOpen(index: number): boolean {
    return this.rows.get(index)?.item.getAttribute("aria-expanded") === "true";
  }

  private toggle(index: number): void {
    if (this.isOpen(index)) this.fold(index);
    else this.unfold(index);
  }

  private point(index: number): void {
    const { primitive } = this.nodes[index];
    if (primitive === null) this.store.set({ hovered: null, group: null });
    else this.store.set({ hovered: primitive, group: null });
  }

  /** Rows from top to bottom, those in folded ones left out. */
  private visibleRows(): number[] {
    const visible: number[] = [];
    const visit = (index: number): void => {
      visible.push(index);
      if (this.isOpen(index)) this.nodes[index].children.forEach(visit);
    };
    visit(0);
    return visible;
  }

  private focusedNode(): number {
    const id = document.activeElement?.id ?? "";
    return id.startsWith("node-") ? Number(id.slice(5)) : this.store.state.node;
  }

  private focus(index: number | undefined): void {
    const row = index === undefined ? undefined : this.rows.get(index);
    if (!row) return;
    for (const { item } of this.rows.values()) item.tabIndex = -1;
    row.item.tabIndex = 0;
    row.item.focus();
    row.line.scrollIntoView({ block: "nearest" });
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const at = this.focusedNode();
    const visible = this.visibleRows();
    const place = visible.indexOf(at);
    const { children } = this.nodes[at];
    const actions: Record<string, () => void> = {
      ArrowDown: () => this.focus(visible[place + 1]),
      ArrowUp: () => this.focus(visible[place - 1]),
      ArrowRight: () => (this.isOpen(at) ? this.focus(children[0]) : this.unfold(at)),
      ArrowLeft: () => (this.isOpen(at) ? this.fold(at) : this.focus(this.rows.get(at)?.parent)),
      Home: () => this.focus(0),
      End: () => this.focus(visible.at(-1)),
      Enter: () => this.store.set({ node: at }),
      " ": () => this.store.set({ node: at }),
      Escape: () => this.store.set({ node: 0 }),
      "*": () => this.nodes[this.rows.get(at)?.parent ?? 0].children.forEach((child) => this.unfold(child)),
    };
    const action = actions[event.key];
    if (action) action();
    else if (event.key.length === 1) this.findByName(event.key, visible, place);
    else return;
    event.preventDefault();
  }

  /** Typed letters go to the next row that begins with them. */
  private findByName(letter: string, visible: number[], place: number): void {
    const now = performance.now();
    this.typed = now - this.typedAt < 700 ? this.typed + letter : letter;
    this.typedAt = now;
    const from = this.typed.length > 1 ? place : place + 1;
    const ahead = [...visible.slice(from), ...visible.slice(0, from)];
    const wanted = this.typed.toLowerCase();
    this.focus(ahead.find((index) => nodeName(this.report, index).toLowerCase().startsWith(wanted)));
  }

  private choose(index: number): void {
    // The way to it is unfolded.
    const path: number[] = [];
    const parents = this.parents();
    for (let at = index; at !== 0; at = parents[at]) path.push(parents[at]);
    path.reverse().forEach((node) => this.unfold(node));
    for (const [node, { item, line }] of this.rows) {
      item.setAttribute("aria-selected", String(node === index));
      item.tabIndex = node === index ? 0 : -1;
      line.classList.toggle("chosen", node === index);
    }
    this.rows.get(index)?.line.scrollIntoView({ block: "nearest" });
  }

  private parents(): number[] {
    const parents = this.nodes.map(() => 0);
    this.nodes.forEach((node, index) => node.children.forEach((child) => (parents[child] = index)));
    return parents;
  }

  private mark(hovered: number | null): void {
    for (const [node, { line }] of this.rows) {
      line.classList.toggle("pointed", hovered !== null && this.nodes[node].primitive === hovered);
    }
  }

  private paint(within: HTMLElement = this.list ?? document.body): void {
    const dark = isDark(this.store.state);
    for (const swatch of within.querySelectorAll<HTMLElement>(".swatch")) {
      swatch.style.backgroundColor = css(primitiveColour(Number(swatch.dataset["primitive"]), dark));
    }
  }

  private showDetail(): void {
    const { node: index } = this.store.state;
    const node = this.nodes[index];
    const isLeaf = node.primitive !== null;
    const heading = h("h3", {}, index === 0 ? "The whole solid" : nodeName(this.report, index));
    const back =
      index === 0
        ? null
        : h("button", { type: "button", class: "quiet", click: () => this.store.set({ node: 0 }) }, "Show the whole");
    const facts = isLeaf
      ? primitiveFacts(this.report.text.primitives[node.primitive!])
      : [["primitives", String(this.byNode[index].size)] as [string, string]];
    this.detail.replaceChildren(
      h("header", {}, heading, back),
      factList(facts),
      node.mesh === null ? h("p", { class: "note" }, "This part has no mesh of its own in the report.") : "",
      ...this.deviationOf(index),
    );
  }

  private deviationOf(index: number): Element[] {
    const { deviation } = this.report.text;
    const { points } = this.report;
    if (!deviation || !points) return [];
    const { primitive } = this.nodes[index];
    const members = this.byNode[index];
    const summary =
      index === 0 ? deviation.all : deviation.by_primitive.find((entry) => entry.primitive === primitive);
    const values: number[] = [];
    for (let i = 0; i < points.count; ++i) {
      if (index === 0 || members.has(points.owners[i])) values.push(points.distances[i]);
    }
    if (values.length === 0) return [h("p", { class: "note" }, "No point lies on its surface.")];
    const list = summary
      ? factList([
          ["points", count(summary.points)],
          ["rms", figures(summary.rms)],
          ["95 % within", figures(summary.p95)],
          ["mean", signed(summary.mean)],
        ])
      : factList([["points shown", count(values.length)]]);
    return [list, histogram(values, this.store.state.range, isDark(this.store.state), { height: 62 })];
  }
}

const k_hidden = new Set(["id", "type", "pose"]);

function textOf(value: unknown): string {
  if (typeof value === "number") return figures(value, 5);
  if (Array.isArray(value)) return value.length > 8 ? `${value.length} entries` : value.map(textOf).join(", ");
  if (value && typeof value === "object") return Object.entries(value).map(([k, v]) => `${k} ${textOf(v)}`).join(", ");
  return String(value);
}

function primitiveFacts(primitive: PrimitiveEntry): [string, string][] {
  const facts: [string, string][] = [["type", primitive.type.replaceAll("_", " ")]];
  for (const [field, value] of Object.entries(primitive)) {
    if (!k_hidden.has(field)) facts.push([field.replaceAll("_", " "), textOf(value)]);
  }
  const pose = primitive["pose"] as { position?: number[] } | undefined;
  if (pose?.position) facts.push(["centre", pose.position.map((value) => figures(value, 4)).join(", ")]);
  return facts;
}

export function factList(facts: [string, string][]): HTMLDListElement {
  return h("dl", { class: "facts" }, ...facts.map(([term, value]) => h("div", {}, h("dt", {}, term), h("dd", {}, value))));
}

export function treePane(report: Report, store: Store, byNode: Set<number>[]): HTMLElement {
  return new TreePane(report, store, byNode).element;
}
