/** What a report holds: the C++ side writes it (src/view/report/payload.hpp), as a JSON text and arrays of numbers. */

/** Where in the bytes an array is, and how it was written. */
export interface Section {
  at: number;
  bytes: number;
  width: 1 | 2 | 4;
  columns: number;
  differences: boolean;
}

type Triple = [number, number, number];

export interface PrimitiveEntry {
  id: string;
  type: string;
  [field: string]: unknown;
}

export type Operation =
  | "primitive"
  | "empty"
  | "full"
  | "complement"
  | "union"
  | "intersection"
  | "difference";

export interface TreeNode {
  operation: Operation;
  primitive: number | null;
  children: number[];
  mesh: number | null;
}

export interface MeshEntry {
  triangles: number;
  least?: Triple;
  greatest?: Triple;
  positions?: Section;
  corners?: Section;
  owners?: Section;
}

export interface Summary {
  points: number;
  mean: number;
  standard_deviation: number;
  rms: number;
  p95: number;
  least: number;
  greatest: number;
}

export interface Deviation {
  all: Summary;
  noise: number;
  beyond_three_noises: number;
  by_primitive: (Summary & { primitive: number })[];
  worst: { position: Triple; distance: number; primitive: number }[];
}

export interface CloudEntry {
  points: number;
  shown: number;
  least: Triple;
  greatest: Triple;
  positions: Section;
  normals: Section | null;
  distance_unit: number;
  distances: Section;
  owners: Section;
}

/** A value of a surface, which is known by its number and type, that was made regular. */
export interface Snap {
  kind: string;
  surface: number;
  type: string;
  change: number;
}

export interface Statistics {
  strategy: string;
  threads: number;
  seed: number;
  complete: boolean;
  points: number;
  unassigned_points: number;
  primitives: number;
  noise: number;
  seconds: Record<string, number>;
  tree: { size: number; leaves: number; depth: number; levels: number; price: number; operations: number };
  fit: {
    objective: number;
    rms_distance: number;
    p95_distance: number;
    rms_angle_deg: number;
    p95_angle_deg: number;
    unexplained_points: number;
  };
  finding: { snaps: Snap[]; [field: string]: unknown } | null;
  cells: Record<string, unknown> | null;
  refine: {
    is_taken: boolean;
    regularities: { type: string; primitives: number[]; spread: number }[];
    [field: string]: unknown;
  } | null;
  verdict: { text: string; doubts: string[] };
  warnings: string[];
}

export interface ReportText {
  program: string;
  title: string;
  source: string;
  primitives: PrimitiveEntry[];
  solid: { nodes: TreeNode[]; meshes: MeshEntry[] };
  cloud?: CloudEntry;
  deviation?: Deviation;
  overlap: { tolerance: number; edges: [number, number][]; clique_count: number; cliques: number[][] } | null;
  statistics: Statistics | null;
  parameters: { group: string; name: string; value: string }[];
  warnings: string[];
  downloads: { name: string; content: Section }[];
}

/** The points that are shown. Positions are relative to the report's centre. */
export interface Points {
  count: number;
  positions: Float32Array;
  normals: Float32Array | null;
  /** Signed, in the cloud's units; positive outside. */
  distances: Float32Array;
  /** Primitives; -1 where there is none. */
  owners: Int32Array;
}

export interface Mesh {
  positions: Float32Array;
  corners: Uint32Array;
  owners: Int32Array;
}

export interface Report {
  text: ReportText;
  /** Subtracted from all positions, so that single precision does for parts that are far from the origin. */
  centre: Triple;
  /** Half of the box around all that is shown, and the radius of the sphere around that. */
  half: Triple;
  radius: number;
  points: Points | null;
  /** Decoded when asked for; null when it has no triangles. */
  mesh(index: number): Mesh | null;
  bytes(section: Section): Uint8Array<ArrayBuffer>;
}

export class UnreadableReport extends Error {}

async function unpack(base64: string): Promise<Uint8Array<ArrayBuffer>> {
  const packed = Uint8Array.from(atob(base64.trim()), (character) => character.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Undoes Payload::add(): bytes apart, columns apart, zigzag differences. */
export function numbers(bytes: Uint8Array, section: Section): Uint32Array {
  const { at, width, columns } = section;
  const count = section.bytes / width;
  const rows = count / columns;
  const mask = width === 4 ? 0xffffffff : (1 << (8 * width)) - 1;
  const values = new Uint32Array(count);
  for (let column = 0; column < columns; ++column) {
    let previous = 0;
    for (let row = 0; row < rows; ++row) {
      let value = 0;
      for (let byte = 0; byte < width; ++byte) {
        value |= bytes[at + byte * count + column * rows + row] << (8 * byte);
      }
      value >>>= 0;
      if (section.differences) {
        const difference = (value >>> 1) ^ -(value & 1);
        value = ((previous + difference) & mask) >>> 0;
        previous = value;
      }
      values[row * columns + column] = value;
    }
  }
  return values;
}

/** IEEE 754 binary16. */
export function halfFloat(bits: number): number {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? Number.NaN : sign * Number.POSITIVE_INFINITY;
  return sign * (1024 + fraction) * 2 ** (exponent - 25);
}

function places(steps: Uint32Array, least: Triple, greatest: Triple, centre: Triple): Float32Array {
  const values = new Float32Array(steps.length);
  for (let i = 0; i < steps.length; ++i) {
    const axis = i % 3;
    values[i] = least[axis] + (steps[i] / 65535) * (greatest[axis] - least[axis]) - centre[axis];
  }
  return values;
}

/** Undoes octahedral() of the C++ side. */
function directions(bytes: Uint8Array): Float32Array {
  const values = new Float32Array((bytes.length / 2) * 3);
  for (let i = 0; i < bytes.length / 2; ++i) {
    let x = (bytes[2 * i] / 255) * 2 - 1;
    let y = (bytes[2 * i + 1] / 255) * 2 - 1;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) {
      const folded = (1 - Math.abs(y)) * (x < 0 ? -1 : 1);
      y = (1 - Math.abs(x)) * (y < 0 ? -1 : 1);
      x = folded;
    }
    const length = Math.hypot(x, y, z) || 1;
    values.set([x / length, y / length, z / length], 3 * i);
  }
  return values;
}

/** Owners are stored plus one, so that 0 is none. */
const owners = (stored: Uint32Array): Int32Array => Int32Array.from(stored, (value) => value - 1);

function bounds(text: ReportText): { centre: Triple; half: Triple; radius: number } {
  const least: Triple = [Infinity, Infinity, Infinity];
  const greatest: Triple = [-Infinity, -Infinity, -Infinity];
  const whole = text.solid.meshes[text.solid.nodes[0].mesh ?? 0];
  for (const box of [text.cloud, whole]) {
    if (!box?.least || !box.greatest) continue;
    for (let axis = 0; axis < 3; ++axis) {
      least[axis] = Math.min(least[axis], box.least[axis]);
      greatest[axis] = Math.max(greatest[axis], box.greatest[axis]);
    }
  }
  if (!Number.isFinite(least[0])) return { centre: [0, 0, 0], half: [1, 1, 1], radius: 1 };
  const centre = least.map((value, axis) => (value + greatest[axis]) / 2) as Triple;
  const half = least.map((value, axis) => (greatest[axis] - value) / 2) as Triple;
  return { centre, half, radius: Math.hypot(...half) || 1 };
}

function readPoints(bytes: Uint8Array, cloud: CloudEntry, centre: Triple): Points {
  const normals = cloud.normals
    ? directions(bytes.subarray(cloud.normals.at, cloud.normals.at + cloud.normals.bytes))
    : null;
  const stored = numbers(bytes, cloud.distances);
  return {
    count: cloud.shown,
    positions: places(numbers(bytes, cloud.positions), cloud.least, cloud.greatest, centre),
    normals,
    distances: Float32Array.from(stored, (bits) => halfFloat(bits) * cloud.distance_unit),
    owners: owners(numbers(bytes, cloud.owners)),
  };
}

function readMesh(bytes: Uint8Array, entry: MeshEntry, centre: Triple): Mesh | null {
  if (!entry.triangles || !entry.positions || !entry.corners || !entry.owners) return null;
  return {
    positions: places(numbers(bytes, entry.positions), entry.least!, entry.greatest!, centre),
    corners: numbers(bytes, entry.corners),
    owners: owners(numbers(bytes, entry.owners)),
  };
}

/** @throws UnreadableReport when the page has no data or it is damaged. */
export async function readReport(base64: string): Promise<Report> {
  let all: Uint8Array<ArrayBuffer>;
  let text: ReportText;
  let sections: Uint8Array<ArrayBuffer>;
  try {
    all = await unpack(base64);
    const length = new DataView(all.buffer).getUint32(0, true);
    text = JSON.parse(new TextDecoder().decode(all.subarray(4, 4 + length))) as ReportText;
    sections = all.subarray(4 + length);
  } catch (cause) {
    throw new UnreadableReport("The data in this page is missing or damaged.", { cause });
  }
  const { centre, half, radius } = bounds(text);
  const meshes = new Map<number, Mesh | null>();
  return {
    text,
    centre,
    half,
    radius,
    points: text.cloud ? readPoints(sections, text.cloud, centre) : null,
    mesh(index) {
      if (!meshes.has(index)) meshes.set(index, readMesh(sections, text.solid.meshes[index], centre));
      return meshes.get(index) ?? null;
    },
    bytes: (section) => sections.slice(section.at, section.at + section.bytes),
  };
}
