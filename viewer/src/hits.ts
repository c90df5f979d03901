/** What is under the pointer, in the cloud and on the solid. */

import { type Camera, type Group, type Mesh as ThreeMesh, Raycaster, type Vector2, Vector3 } from "three";
import type { Report } from "./payload";

export type Pane = "cloud" | "solid";

/** What is under the pointer. */
export interface Hit {
  pane: Pane;
  primitive: number | null;
  /** Signed, of a point of the cloud. */
  distance: number | null;
  place: Vector3;
}

export interface Rectangle {
  left: number;
  bottom: number;
  width: number;
  height: number;
}

/** Whether a section cuts a place away. */
export type IsCut = (x: number, y: number, z: number) => boolean;

/** The front-most point within some pixels. `pointer`: in the picture, from -1 to 1. */
export function hitCloud(report: Report, camera: Camera, pointer: Vector2, picture: Rectangle, isCut: IsCut): Hit | null {
  const points = report.points;
  if (!points) return null;
  const reach = 7;
  camera.updateMatrixWorld();
  const m = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse).elements;
  const { positions: p } = points;
  const [limitX, limitY] = [(2 * reach) / picture.width, (2 * reach) / picture.height];
  let best = -1;
  let depth = Infinity;
  for (let i = 0; i < points.count; ++i) {
    const [x, y, z] = [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    if (w <= 0 || w >= depth) continue;
    if (Math.abs((m[0] * x + m[4] * y + m[8] * z + m[12]) / w - pointer.x) > limitX) continue;
    if (Math.abs((m[1] * x + m[5] * y + m[9] * z + m[13]) / w - pointer.y) > limitY) continue;
    if (isCut(x, y, z)) continue;
    best = i;
    depth = w;
  }
  if (best < 0) return null;
  return {
    pane: "cloud",
    primitive: points.owners[best] < 0 ? null : points.owners[best],
    distance: points.distances[best],
    place: new Vector3(p[3 * best], p[3 * best + 1], p[3 * best + 2]),
  };
}

/** The front-most place of the surface that is shown. */
export function hitSolid(surface: Group, camera: Camera, pointer: Vector2, isCut: IsCut): Hit | null {
  const caster = new Raycaster();
  camera.updateMatrixWorld();
  caster.setFromCamera(pointer, camera);
  for (const found of caster.intersectObject(surface)) {
    if (isCut(found.point.x, found.point.y, found.point.z) || !found.face) continue;
    const owner = (found.object as ThreeMesh).geometry.getAttribute("owner").getX(found.face.a);
    return { pane: "solid", primitive: owner < 0 ? null : owner, distance: null, place: found.point };
  }
  return null;
}
