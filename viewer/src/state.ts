/** What the reader has chosen, and who wants to know. */

import type { Report } from "./payload";

export type ColourMode = "primitive" | "deviation" | "plain";
export type Layout = "side" | "slider";
export type Theme = "auto" | "light" | "dark";
export type Axis = 0 | 1 | 2;

export interface Section {
  on: boolean;
  axis: Axis;
  /** 0 to 1 through what is shown. */
  place: number;
  flipped: boolean;
}

export interface State {
  /** The chosen node of the tree; 0 is the whole. */
  node: number;
  /** The primitive that is pointed at. */
  hovered: number | null;
  /** Primitives that are pointed at together: a partition. */
  group: readonly number[] | null;
  colour: ColourMode;
  layout: Layout;
  /** Of the slider layout: how much of the width shows the cloud. */
  divider: number;
  /** Distance that has the full colour. */
  range: number;
  /** Factor on the size of points. */
  pointSize: number;
  section: Section;
  theme: Theme;
}

type Listener = (state: Readonly<State>, before: Readonly<State>) => void;

export class Store {
  private readonly listeners: Listener[] = [];
  constructor(private current: State) {}

  get state(): Readonly<State> {
    return this.current;
  }

  set(change: Partial<State>): void {
    const before = this.current;
    const changed = (Object.keys(change) as (keyof State)[]).some((key) => change[key] !== before[key]);
    if (!changed) return;
    this.current = { ...before, ...change };
    for (const listener of this.listeners) listener(this.current, before);
  }

  /** Called at once, and after each change. */
  watch(listener: Listener): void {
    this.listeners.push(listener);
    listener(this.current, this.current);
  }
}

export function isDark(state: Readonly<State>): boolean {
  if (state.theme !== "auto") return state.theme === "dark";
  return matchMedia("(prefers-color-scheme: dark)").matches;
}

/** The primitives of each node's subtree, by node. */
export function primitivesByNode(report: Report): Set<number>[] {
  const { nodes } = report.text.solid;
  const sets = nodes.map((node) => new Set<number>(node.primitive === null ? [] : [node.primitive]));
  // Children come after their parents.
  for (let i = nodes.length - 1; i >= 0; --i) {
    for (const child of nodes[i].children) for (const p of sets[child]) sets[i].add(p);
  }
  return sets;
}

/** The primitives to show at full strength; null for all. */
export function focusOf(state: Readonly<State>, byNode: Set<number>[]): ReadonlySet<number> | null {
  if (state.hovered !== null) return new Set([state.hovered]);
  if (state.group) return new Set(state.group);
  return state.node === 0 ? null : byNode[state.node];
}
