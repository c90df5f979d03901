/** The two views with what lies over them: names, legend, the divider, what is under the pointer. */

import { css, distanceColour } from "./colours";
import { leafOf } from "./deviation_pane";
import { h } from "./dom";
import { count, plural, signed } from "./format";
import { histogram } from "./histogram";
import type { Report } from "./payload";
import { type Store, isDark } from "./state";
import { nodeName } from "./tree_pane";
import { Views } from "./views";

const k_drag = 4;

export class Stage {
  readonly element: HTMLElement;
  readonly views: Views;
  private readonly host: HTMLElement;
  private readonly tip = h("div", { class: "tip", hidden: true, "aria-hidden": "true" });

  constructor(
    private readonly report: Report,
    private readonly store: Store,
    byNode: Set<number>[],
  ) {
    this.host = h("div", {
      class: "host",
      tabindex: 0,
      role: "application",
      "aria-label":
        "Point cloud and solid in three dimensions. Arrow keys turn, plus and minus zoom, 0 shows all, Escape shows the whole solid.",
      keydown: (event: KeyboardEvent) => this.onKey(event),
    });
    this.views = new Views(report, store, byNode, this.host);
    this.host.append(...this.names(), this.tip);
    if (report.points) this.host.append(this.legend(), this.divider());
    this.watchPointer();
    this.element = h("div", { class: "stage" }, this.host);
    store.watch((state) => {
      this.host.dataset["layout"] = report.points ? state.layout : "single";
      this.host.style.setProperty("--divider", String(state.divider));
    });
  }

  private names(): HTMLElement[] {
    const { cloud } = this.report.text;
    const solid = h("div", { class: "pane-name solid", "aria-live": "polite" });
    this.store.watch((state, before) => {
      if (state !== before && state.node === before.node) return;
      const part = state.node === 0 ? "the whole" : nodeName(this.report, state.node);
      solid.replaceChildren(h("b", {}, "Solid"), ` ${part}`);
    });
    if (!cloud) return [solid];
    const shown =
      cloud.shown < cloud.points ? `${count(cloud.shown)} of ${count(cloud.points)} points` : plural(cloud.points, "point");
    return [h("div", { class: "pane-name cloud" }, h("b", {}, "Cloud"), ` ${shown}`), solid];
  }

  private legend(): HTMLElement {
    const points = this.report.points!;
    const element = h("div", { class: "legend" });
    this.store.watch((state, before) => {
      if (
        state !== before &&
        state.colour === before.colour &&
        state.range === before.range &&
        state.theme === before.theme
      ) {
        return;
      }
      element.hidden = state.colour !== "deviation";
      if (element.hidden) return;
      const dark = isDark(state);
      const stops = Array.from({ length: 17 }, (_, k) => css(distanceColour(k / 8 - 1, dark)));
      element.replaceChildren(
        h("div", { class: "legend-title" }, "Signed distance"),
        histogram(points.distances, state.range, dark, { height: 60, size: 41, width: 228 }),
        h("div", { class: "ramp", style: `background: linear-gradient(to right, ${stops.join(", ")})` }),
        h("div", { class: "ramp-names" }, h("span", {}, "inside"), h("span", {}, "outside")),
      );
    });
    return element;
  }

  private divider(): HTMLElement {
    const move = (divider: number): void => this.store.set({ divider: Math.min(1, Math.max(0, divider)) });
    const element = h("div", {
      class: "divider",
      role: "slider",
      tabindex: 0,
      "aria-label": "Slider between cloud and solid",
      "aria-valuemin": 0,
      "aria-valuemax": 100,
      keydown: (event: KeyboardEvent) => {
        const steps: Record<string, number> = { ArrowLeft: -0.02, ArrowRight: 0.02, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 };
        const step = steps[event.key];
        if (step === undefined) return;
        event.preventDefault();
        event.stopPropagation();
        move(this.store.state.divider + step);
      },
      pointerdown: (event: PointerEvent) => {
        element.setPointerCapture(event.pointerId);
        event.stopPropagation();
      },
      pointermove: (event: PointerEvent) => {
        if (!element.hasPointerCapture(event.pointerId)) return;
        const box = this.host.getBoundingClientRect();
        move((event.clientX - box.left) / box.width);
      },
    });
    this.store.watch((state) => {
      element.setAttribute("aria-valuenow", String(Math.round(state.divider * 100)));
      element.setAttribute("aria-valuetext", `${Math.round(state.divider * 100)} % cloud`);
    });
    return element;
  }

  private onKey(event: KeyboardEvent): void {
    if (event.target !== this.host || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = Math.PI / 24;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => this.views.turn(-step, 0),
      ArrowRight: () => this.views.turn(step, 0),
      ArrowUp: () => this.views.turn(0, step),
      ArrowDown: () => this.views.turn(0, -step),
      "+": () => this.views.turn(0, 0, 1.15),
      "=": () => this.views.turn(0, 0, 1.15),
      "-": () => this.views.turn(0, 0, 1 / 1.15),
      "0": () => this.views.look("iso"),
      Escape: () => this.store.set({ node: 0 }),
    };
    const action = actions[event.key];
    if (!action) return;
    action();
    event.preventDefault();
  }

  /** Once a frame at most, and not while the view is turned. */
  private watchPointer(): void {
    const { canvas } = this.views;
    let latest: PointerEvent | null = null;
    let down: { x: number; y: number } | null = null;
    const look = (): void => {
      const event = latest;
      latest = null;
      if (event) this.pointAt(event);
    };
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons !== 0) return this.clear();
      if (!latest) requestAnimationFrame(look);
      latest = event;
    });
    canvas.addEventListener("pointerdown", (event) => {
      down = { x: event.clientX, y: event.clientY };
    });
    canvas.addEventListener("pointerup", (event) => {
      const still = down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < k_drag;
      down = null;
      if (!still || event.button !== 0) return;
      const hit = this.views.hit(event.offsetX, event.offsetY);
      this.store.set({ node: hit?.primitive == null ? 0 : leafOf(this.report, hit.primitive) });
    });
    canvas.addEventListener("pointerleave", () => {
      latest = null;
      this.clear();
    });
  }

  private clear(): void {
    this.tip.hidden = true;
    this.store.set({ hovered: null });
  }

  private pointAt(event: PointerEvent): void {
    const hit = this.views.hit(event.offsetX, event.offsetY);
    if (!hit) return this.clear();
    this.store.set({ hovered: hit.primitive, group: null });
    const name = hit.primitive === null ? "no primitive" : this.report.text.primitives[hit.primitive].id;
    this.tip.replaceChildren(h("b", {}, name), hit.distance === null ? "" : ` ${signed(hit.distance)}`);
    this.tip.hidden = false;
    const room = this.host.clientWidth - this.tip.offsetWidth - 8;
    this.tip.style.left = `${Math.max(4, Math.min(event.offsetX + 14, room))}px`;
    this.tip.style.top = `${Math.max(4, event.offsetY - 34)}px`;
  }
}
