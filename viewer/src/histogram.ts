/** A histogram of signed distances, in the colours of the cloud. */

import { css, distanceColour } from "./colours";
import { svg } from "./dom";
import { figures, percent, signed } from "./format";

export interface Bins {
  /** From -range to range; what is beyond is in the first and the last. */
  counts: number[];
  below: number;
  above: number;
}

export function bins(values: ArrayLike<number>, range: number, size: number): Bins {
  const counts = new Array<number>(size).fill(0);
  let [below, above] = [0, 0];
  for (let i = 0; i < values.length; ++i) {
    const share = (values[i] / range + 1) / 2;
    if (share < 0) ++below;
    else if (share > 1) ++above;
    counts[Math.min(size - 1, Math.max(0, Math.floor(share * size)))] += 1;
  }
  return { counts, below, above };
}

export interface HistogramOptions {
  height: number;
  /** Normal distribution of this width, drawn over the bars. */
  sigma?: number;
  size?: number;
  /** Of the place where it is shown, for legible text. */
  width?: number;
}

export function histogram(
  values: ArrayLike<number>,
  range: number,
  dark: boolean,
  { height, sigma, size = 61, width = 340 }: HistogramOptions,
): SVGSVGElement {
  const axis = 16;
  const { counts, below, above } = bins(values, range, size);
  const most = Math.max(1, ...counts);
  const step = width / size;
  const room = height - axis;
  const bars = counts.map((value, i) => {
    const tall = (value / most) * (room - 3);
    const middle = (2 * (i + 0.5)) / size - 1;
    return svg("rect", {
      x: (i * step + 0.4).toFixed(2),
      y: (room - tall).toFixed(2),
      width: (step - 0.8).toFixed(2),
      height: Math.max(value ? 0.8 : 0, tall).toFixed(2),
      fill: css(distanceColour(middle, dark)),
    });
  });
  // Between the outer ones others have room only where the numbers are short.
  const isRoomy = width > 300 && signed(-range, 2).length < 8;
  const ticks = (isRoomy ? [-1, -0.5, 0, 0.5, 1] : [-1, 0, 1]).map((share) =>
    svg(
      "text",
      {
        x: ((share + 1) / 2) * width,
        y: height - 3,
        "text-anchor": share === -1 ? "start" : share === 1 ? "end" : "middle",
      },
      share === 0 ? "0" : signed(share * range, 2),
    ),
  );
  const total = values.length || 1;
  const summary =
    `Histogram of signed distances from ${signed(-range, 2)} to ${signed(range, 2)}; ` +
    `${percent(below / total)} of the points are below and ${percent(above / total)} above.`;
  return svg(
    "svg",
    { class: "histogram", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": summary },
    svg("title", {}, summary),
    ...bars,
    sigma ? normalCurve(sigma, range, width, room, (total * (2 * range)) / size / most) : null,
    svg("line", { class: "axis", x1: 0, x2: width, y1: room + 0.5, y2: room + 0.5 }),
    svg("line", { class: "axis", x1: width / 2, x2: width / 2, y1: 0, y2: room + 4 }),
    ...ticks,
  );
}

function normalCurve(sigma: number, range: number, width: number, room: number, scale: number): SVGPathElement {
  const steps = 120;
  const points = Array.from({ length: steps + 1 }, (_, i) => {
    const share = (2 * i) / steps - 1;
    const density = Math.exp(-0.5 * ((share * range) / sigma) ** 2) / (sigma * Math.sqrt(2 * Math.PI));
    const y = room - Math.min(1.02, density * scale) * (room - 3);
    return `${(((share + 1) / 2) * width).toFixed(1)},${y.toFixed(1)}`;
  });
  return svg("path", { class: "curve", d: `M${points.join("L")}` }, svg("title", {}, `normal, ${figures(sigma)}`));
}
