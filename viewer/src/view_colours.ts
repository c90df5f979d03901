/** The colours of the views: textures that shaders read, and those of each theme. */

import { DataTexture, FloatType, NearestFilter, RGBAFormat } from "three";
import { type Rgb, distanceColour } from "./colours";

export function colourTexture(colours: [number, number, number, number][], width: number): DataTexture {
  const height = Math.ceil(colours.length / width);
  const data = new Float32Array(4 * width * height);
  colours.forEach((colour, i) => data.set(colour, 4 * i));
  const texture = new DataTexture(data, width, height, RGBAFormat, FloatType);
  texture.needsUpdate = true;
  return texture;
}

export function distanceTexture(dark: boolean): DataTexture {
  const steps = 256;
  const colours = Array.from(
    { length: steps },
    (_, i) => [...distanceColour((2 * i) / (steps - 1) - 1, dark), 1] as [number, number, number, number],
  );
  const texture = colourTexture(colours, steps);
  texture.minFilter = NearestFilter;
  texture.magFilter = NearestFilter;
  return texture;
}

export const k_themes = {
  light: { background: [0.957, 0.965, 0.976], plain: [0.66, 0.7, 0.75], points: [0.3, 0.36, 0.44], edge: [0.16, 0.2, 0.27], cut: [0.93, 0.66, 0.4] },
  dark: { background: [0.075, 0.09, 0.115], plain: [0.56, 0.6, 0.66], points: [0.72, 0.77, 0.84], edge: [0.03, 0.04, 0.06], cut: [0.78, 0.5, 0.27] },
} satisfies Record<string, Record<string, Rgb>>;
