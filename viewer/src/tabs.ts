/** Tabs, of which one shows its panel; arrow keys go from one to the next. */

import { h } from "./dom";

export interface Tab {
  id: string;
  name: string;
  /** Made when it is first shown. */
  content: () => HTMLElement;
  mark?: string | null;
}

export function tabs(label: string, entries: Tab[]): HTMLElement {
  const made = new Set<string>();
  const buttons: HTMLButtonElement[] = [];
  const panels: HTMLElement[] = [];
  const show = (index: number, focus: boolean): void => {
    entries.forEach((entry, k) => {
      const chosen = k === index;
      buttons[k].setAttribute("aria-selected", String(chosen));
      buttons[k].tabIndex = chosen ? 0 : -1;
      panels[k].hidden = !chosen;
      if (chosen && !made.has(entry.id)) {
        made.add(entry.id);
        panels[k].append(entry.content());
      }
    });
    if (focus) buttons[index].focus();
  };
  entries.forEach((entry, index) => {
    buttons.push(
      h(
        "button",
        {
          type: "button",
          role: "tab",
          id: `tab-${entry.id}`,
          "aria-controls": `panel-${entry.id}`,
          click: () => show(index, false),
          keydown: (event: KeyboardEvent) => {
            const steps: Record<string, number> = { ArrowRight: index + 1, ArrowLeft: index - 1, Home: 0, End: -1 };
            const next = steps[event.key];
            if (next === undefined) return;
            event.preventDefault();
            show((next + entries.length) % entries.length, true);
          },
        },
        entry.name,
        entry.mark ? h("span", { class: "mark" }, entry.mark) : null,
      ),
    );
    panels.push(
      h("div", {
        role: "tabpanel",
        id: `panel-${entry.id}`,
        class: "panel",
        "aria-labelledby": `tab-${entry.id}`,
        tabindex: -1,
      }),
    );
  });
  const element = h("aside", { class: "side-pane" }, h("div", { role: "tablist", class: "tabs", "aria-label": label }, ...buttons), ...panels);
  show(0, false);
  return element;
}
