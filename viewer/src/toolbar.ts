/** What is above the views: colours, layout, section, directions. */

import { h } from "./dom";
import { figures } from "./format";
import type { Report } from "./payload";
import type { Axis, ColourMode, Layout, State, Store } from "./state";
import type { Direction, Views } from "./views";

interface Choice<T> {
  value: T;
  text: string;
  title?: string;
}

/** Buttons of which one is pressed. */
function choices<T>(label: string, options: Choice<T>[], store: Store, read: (s: Readonly<State>) => T, set: (v: T) => void) {
  const buttons = options.map(({ value, text, title }) =>
    h("button", { type: "button", title, click: () => set(value) }, text),
  );
  store.watch((state) =>
    options.forEach(({ value }, k) => buttons[k].setAttribute("aria-pressed", String(read(state) === value))),
  );
  return h("div", { class: "choices", role: "group", "aria-label": label }, h("span", { class: "caption" }, label), h("span", { class: "segments" }, ...buttons));
}

function sectionControls(store: Store): HTMLElement {
  const change = (part: Partial<State["section"]>): void =>
    store.set({ section: { ...store.state.section, ...part } });
  const toggle = h("input", {
    type: "checkbox",
    id: "section",
    change: () => change({ on: toggle.checked }),
  });
  const axis = h(
    "select",
    { "aria-label": "Section across", change: () => change({ axis: Number(axis.value) as Axis, on: true }) },
    ...["X", "Y", "Z"].map((name, k) => h("option", { value: k }, name)),
  );
  const place = h("input", {
    type: "range",
    min: 0,
    max: 1000,
    "aria-label": "Place of the section",
    input: () => change({ place: Number(place.value) / 1000, on: true }),
  });
  const flip = h(
    "button",
    { type: "button", title: "Show the other side", "aria-label": "Show the other side of the section", click: () => change({ flipped: !store.state.section.flipped, on: true }) },
    "⇄",
  );
  store.watch(({ section }) => {
    toggle.checked = section.on;
    axis.value = String(section.axis);
    place.value = String(Math.round(section.place * 1000));
    flip.setAttribute("aria-pressed", String(section.flipped));
  });
  return h(
    "div",
    { class: "choices", role: "group", "aria-label": "Section plane" },
    h("label", { for: "section", class: "caption check" }, toggle, "Section"),
    axis,
    place,
    flip,
  );
}

function rangeControls(report: Report, store: Store): HTMLElement {
  const noise = report.text.deviation?.noise ?? 1;
  const largest = Math.max(report.text.cloud?.distance_unit ?? 1, noise);
  // Logarithmic, from a third of the noise to the largest distance.
  const least = noise / 3;
  const decades = Math.log(Math.max(largest / least, 1.01));
  const input = h("input", {
    type: "range",
    min: 0,
    max: 1000,
    "aria-label": "Distance that has the full colour",
    input: () => store.set({ range: least * Math.exp((Number(input.value) / 1000) * decades) }),
  });
  const text = h("output", { class: "value" });
  const element = h("label", { class: "choices" }, h("span", { class: "caption" }, "Range"), input, text);
  store.watch((state) => {
    input.value = String(Math.round((1000 * Math.log(state.range / least)) / decades));
    text.textContent = `±${figures(state.range, 2)}`;
    input.setAttribute("aria-valuetext", `plus or minus ${figures(state.range, 2)}`);
    element.hidden = state.colour !== "deviation";
  });
  return element;
}

function pointSizeControl(store: Store): HTMLElement {
  const input = h("input", {
    type: "range",
    min: -100,
    max: 100,
    class: "short",
    "aria-label": "Size of points",
    input: () => store.set({ pointSize: 4 ** (Number(input.value) / 100) }),
  });
  store.watch((state) => (input.value = String(Math.round((100 * Math.log(state.pointSize)) / Math.log(4)))));
  return h("label", { class: "choices" }, h("span", { class: "caption" }, "Points"), input);
}

export function toolbar(report: Report, store: Store, views: Views): HTMLElement {
  const hasCloud = report.points !== null;
  const colours: Choice<ColourMode>[] = [
    { value: "primitive", text: "Primitive", title: "Each primitive has a colour" },
    { value: "deviation", text: "Distance", title: "Signed distance of points to the solid" },
    { value: "plain", text: "Plain" },
  ];
  const layouts: Choice<Layout>[] = [
    { value: "side", text: "Side by side" },
    { value: "slider", text: "Slider", title: "One picture, with a slider between cloud and solid" },
  ];
  const directions: Choice<Direction>[] = [
    { value: "iso", text: "3D" },
    { value: "front", text: "Front" },
    { value: "right", text: "Right" },
    { value: "top", text: "Top" },
  ];
  return h(
    "div",
    { class: "toolbar", role: "toolbar", "aria-label": "View" },
    choices(
      "Colour",
      hasCloud ? colours : colours.filter(({ value }) => value !== "deviation"),
      store,
      (state) => state.colour,
      (colour) => store.set({ colour }),
    ),
    hasCloud ? rangeControls(report, store) : null,
    hasCloud ? choices("Layout", layouts, store, (state) => state.layout, (layout) => store.set({ layout })) : null,
    sectionControls(store),
    h(
      "div",
      { class: "choices", role: "group", "aria-label": "Look from" },
      h("span", { class: "caption" }, "Look"),
      h(
        "span",
        { class: "segments" },
        ...directions.map(({ value, text }) => h("button", { type: "button", click: () => views.look(value) }, text)),
      ),
    ),
    hasCloud ? pointSizeControl(store) : null,
  );
}
