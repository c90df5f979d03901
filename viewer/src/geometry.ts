/** From the report's arrays to what the graphics card draws. */

import { BufferAttribute, BufferGeometry } from "three";
import type { Mesh, Points } from "./payload";

export function pointGeometry(points: Points): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(points.positions, 3));
  geometry.setAttribute("normal", new BufferAttribute(points.normals ?? points.positions, 3));
  geometry.setAttribute("owner", new BufferAttribute(Float32Array.from(points.owners), 1));
  geometry.setAttribute("deviation", new BufferAttribute(points.distances, 1));
  return geometry;
}

/** Vertices at one place get one number: where patches of two primitives meet there are two. */
function joined({ positions: p, corners }: Mesh): Uint32Array {
  const first = new Map<string, number>();
  const same = new Uint32Array(p.length / 3);
  for (let i = 0; i < same.length; ++i) {
    const place = `${p[3 * i]} ${p[3 * i + 1]} ${p[3 * i + 2]}`;
    const known = first.get(place);
    if (known === undefined) first.set(place, i);
    same[i] = known ?? i;
  }
  return corners.map((corner) => same[corner]);
}

/** Of the size of a mesh: triangles less high are slivers. */
const k_sliver = 2e-4;
const k_crease = Math.cos((32 * Math.PI) / 180);

/** Unit normals of triangles, three numbers each. */
function faceNormals({ positions: p, corners }: Mesh): Float32Array {
  const normals = new Float32Array(corners.length);
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [3 * corners[i], 3 * corners[i + 1], 3 * corners[i + 2]];
    const u = [p[b] - p[a], p[b + 1] - p[a + 1], p[b + 2] - p[a + 2]];
    const v = [p[c] - p[a], p[c + 1] - p[a + 1], p[c + 2] - p[a + 2]];
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.hypot(n[0], n[1], n[2]) || 1;
    normals.set([n[0] / length, n[1] / length, n[2] / length], i);
  }
  return normals;
}

/** The least height of each triangle. */
function leastHeights({ positions: p, corners }: Mesh): Float32Array {
  const heights = new Float32Array(corners.length / 3);
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [3 * corners[i], 3 * corners[i + 1], 3 * corners[i + 2]];
    const side = (from: number, to: number): number =>
      Math.hypot(p[to] - p[from], p[to + 1] - p[from + 1], p[to + 2] - p[from + 2]);
    const [u, v, w] = [side(a, b), side(b, c), side(c, a)];
    const half = (u + v + w) / 2;
    const area = Math.sqrt(Math.max(0, half * (half - u) * (half - v) * (half - w)));
    heights[i / 3] = (2 * area) / (Math.max(u, v, w) || 1);
  }
  return heights;
}

/** The angle of a triangle at each of its corners: what a long thin one adds to a normal is then no more than its due. */
function cornerAngles({ positions: p, corners }: Mesh): Float32Array {
  const angles = new Float32Array(corners.length);
  for (let i = 0; i < corners.length; ++i) {
    const first = i - (i % 3);
    const at = 3 * corners[i];
    const b = 3 * corners[first + ((i + 1) % 3)];
    const c = 3 * corners[first + ((i + 2) % 3)];
    let [dot, uu, vv] = [0, 0, 0];
    for (let k = 0; k < 3; ++k) {
      const u = p[b + k] - p[at + k];
      const v = p[c + k] - p[at + k];
      dot += u * v;
      uu += u * u;
      vv += v * v;
    }
    angles[i] = Math.acos(Math.min(1, Math.max(-1, dot / (Math.sqrt(uu * vv) || 1))));
  }
  return angles;
}

/** Smooth where neighbours meet at a small angle, sharp elsewhere: every triangle has corners of its own. */
export function surfaceGeometry(mesh: Mesh): BufferGeometry {
  const { positions: p, owners } = mesh;
  const corners = joined(mesh);
  const faces = faceNormals(mesh);
  const angles = cornerAngles(mesh);
  const around: number[][] = Array.from({ length: p.length / 3 }, () => []);
  corners.forEach((vertex, corner) => around[vertex].push(corner));

  const places = new Float32Array(3 * corners.length);
  const normals = new Float32Array(3 * corners.length);
  const owner = new Float32Array(corners.length);
  for (let i = 0; i < corners.length; ++i) {
    const face = i - (i % 3);
    const n = [0, 0, 0];
    for (const other of around[corners[i]]) {
      const g = other - (other % 3);
      const cosine = faces[face] * faces[g] + faces[face + 1] * faces[g + 1] + faces[face + 2] * faces[g + 2];
      if (cosine < k_crease) continue;
      for (let k = 0; k < 3; ++k) n[k] += angles[other] * faces[g + k];
    }
    const length = Math.hypot(n[0], n[1], n[2]) || 1;
    for (let k = 0; k < 3; ++k) {
      places[3 * i + k] = p[3 * corners[i] + k];
      normals[3 * i + k] = n[k] / length;
    }
    owner[i] = owners[face / 3];
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(places, 3));
  geometry.setAttribute("normal", new BufferAttribute(normals, 3));
  geometry.setAttribute("owner", new BufferAttribute(owner, 1));
  return geometry;
}

/** The sharp edges of a mesh, as pairs of places. */
export function edgeGeometry(mesh: Mesh): BufferGeometry {
  const { positions: p } = mesh;
  const corners = joined(mesh);
  const faces = faceNormals(mesh);
  const heights = leastHeights(mesh);
  const size = p.reduce((largest, value) => Math.max(largest, Math.abs(value)), 0);
  const open = new Map<number, number>();
  const places: number[] = [];
  const vertices = p.length / 3;
  for (let i = 0; i < corners.length; ++i) {
    const from = corners[i];
    const to = corners[i % 3 === 2 ? i - 2 : i + 1];
    const key = Math.min(from, to) * vertices + Math.max(from, to);
    const face = i - (i % 3);
    const other = open.get(key);
    if (other === undefined) {
      open.set(key, face);
      continue;
    }
    const cosine =
      faces[face] * faces[other] + faces[face + 1] * faces[other + 1] + faces[face + 2] * faces[other + 2];
    // Slivers point anywhere.
    if (Math.min(heights[face / 3], heights[other / 3]) < k_sliver * size) continue;
    if (cosine < k_crease) for (const v of [from, to]) places.push(p[3 * v], p[3 * v + 1], p[3 * v + 2]);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(places), 3));
  return geometry;
}
