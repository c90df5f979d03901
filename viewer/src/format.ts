/** Numbers as people read them. */

const k_minus = "\u2212";
const k_thin_space = "\u202f";

/** Three or four figures, without needless zeros. */
export function figures(value: number | null | undefined, digits = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  const text =
    size < 1e-4 || size >= 1e6 ? value.toExponential(digits - 1) : String(Number(value.toPrecision(digits)));
  return text.replaceAll("-", k_minus);
}

/** With its sign, always: a signed distance. */
export const signed = (value: number, digits = 3): string =>
  (value > 0 ? "+" : "") + figures(value, digits);

export function count(value: number): string {
  return String(Math.round(value)).replace(/\B(?=(\d{3})+(?!\d))/g, k_thin_space);
}

export function seconds(value: number): string {
  return value >= 1 ? `${figures(value)} s` : `${figures(value * 1000)} ms`;
}

export const percent = (share: number): string => `${figures(100 * share, 3)} %`;

export const plural = (value: number, one: string, many = `${one}s`): string =>
  `${count(value)} ${value === 1 ? one : many}`;

/** The field of a JSON text as words. */
export const words = (field: string): string => field.replaceAll("_", " ");
