/** Colours of primitives and of distances, in both themes. */

export type Rgb = [number, number, number];

const clamp = (value: number, least = 0, greatest = 1): number => Math.min(greatest, Math.max(least, value));

/** OKLCH (lightness, chroma, hue in degrees) to sRGB, 0 to 1. */
function fromOklch(lightness: number, chroma: number, hue: number): Rgb {
  const angle = (hue * Math.PI) / 180;
  const a = chroma * Math.cos(angle);
  const b = chroma * Math.sin(angle);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  return linear.map((value) => {
    const x = clamp(value);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055;
  }) as Rgb;
}

/** As primitive_colour() of the library in the light theme. Neighbours in the list get hues far apart; lightness changes too, for those who see few hues. */
export function primitiveColour(index: number, dark: boolean): Rgb {
  const hue = (28 + index * 137.508) % 360;
  const step = [0, 0.1, -0.07][index % 3];
  return fromOklch((dark ? 0.72 : 0.62) + step, 0.135, hue);
}

const k_distance_stops: Record<"light" | "dark", string[]> = {
  light: ["#1d3f9e", "#3f83dd", "#b4bac2", "#e58a3a", "#a8201a"],
  dark: ["#3d6bff", "#7fb2f5", "#7d858f", "#f0a35e", "#ff5a4d"],
};

const channels = (hex: string): Rgb =>
  [1, 3, 5].map((at) => Number.parseInt(hex.slice(at, at + 2), 16) / 255) as Rgb;

/** Of a distance in units of the range: blue inside, red outside, grey on the surface. */
export function distanceColour(share: number, dark: boolean): Rgb {
  const stops = k_distance_stops[dark ? "dark" : "light"];
  const place = ((clamp(share, -1, 1) + 1) / 2) * (stops.length - 1);
  const below = Math.min(stops.length - 2, Math.floor(place));
  const from = channels(stops[below]);
  const to = channels(stops[below + 1]);
  return from.map((value, k) => value + (to[k] - value) * (place - below)) as Rgb;
}

export const css = (colour: Rgb): string =>
  `rgb(${colour.map((value) => Math.round(value * 255)).join(" ")})`;
