/** The pictures of cloud and solid: one camera, one canvas, two halves. */

import {
  BackSide,
  DoubleSide,
  FrontSide,
  GLSL3,
  Group,
  LineSegments,
  Mesh as ThreeMesh,
  NotEqualStencilFunc,
  PerspectiveCamera,
  Points as ThreePoints,
  ReplaceStencilOp,
  Scene,
  ShaderMaterial,
  type Side,
  Vector2,
  Vector3,
  Vector4,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { primitiveColour } from "./colours";
import { edgeGeometry, pointGeometry, surfaceGeometry } from "./geometry";
import { type Hit, type Pane, type Rectangle, hitCloud, hitSolid } from "./hits";
import type { Report } from "./payload";
import { edgeFragment, edgeVertex, pointFragment, pointVertex, surfaceFragment, surfaceVertex } from "./shaders";
import { type ColourMode, type State, type Store, focusOf, isDark } from "./state";
import { colourTexture, distanceTexture, k_themes } from "./view_colours";

const k_palette_width = 1024;
const k_inside = 1; // in the stencil: seen from inside
const k_modes: Record<ColourMode, number> = { primitive: 0, deviation: 1, plain: 2 };
const k_view_angle = 32;
const k_room = 1.08;

export type Direction = "iso" | "front" | "right" | "top";
const k_directions: Record<Direction, [number, number, number]> = {
  iso: [0.82, -1, 0.72],
  front: [0, -1, 0],
  right: [1, 0, 0],
  top: [0, -0.0005, 1],
};

export class Views {
  readonly canvas: HTMLCanvasElement;
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(k_view_angle, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private readonly cloudScene = new Scene();
  private readonly solidScene = new Scene();
  private readonly shared = {
    section: { value: new Vector4(1, 0, 0, 0) },
    sectionOn: { value: false },
    palette: { value: colourTexture([[0.5, 0.5, 0.5, 1]], k_palette_width) },
    paletteWidth: { value: k_palette_width },
    background: { value: new Vector3() },
    plain: { value: new Vector3() },
  };
  private readonly pointUniforms = {
    ...this.shared,
    plain: { value: new Vector3() },
    worldSize: { value: 1 },
    pixelsPerUnit: { value: 1 },
    mode: { value: 0 },
    distanceColours: { value: distanceTexture(false) },
    range: { value: 1 },
    hasNormals: { value: false },
  };
  private readonly surfaceUniforms = {
    ...this.shared,
    byPrimitive: { value: true },
    cutColour: { value: new Vector3() },
    opacity: { value: 1 },
    dims: { value: true },
  };
  private readonly edgeUniforms = { ...this.shared, colour: { value: new Vector3() }, opacity: { value: 0.8 } };
  private readonly nodeMeshes = new Map<number, { surface: Group; edges: LineSegments }>();
  private readonly ghost: LineSegments | null;
  private shownMesh: number | null = null;
  private isAsked = false;
  /** The reader has not moved the camera since all was in view. */
  private isFitted = true;

  constructor(
    private readonly report: Report,
    private readonly store: Store,
    private readonly byNode: Set<number>[],
    private readonly host: HTMLElement,
  ) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, stencil: true, powerPreference: "high-performance" });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.autoClear = false;
    this.canvas = this.renderer.domElement;
    host.prepend(this.canvas);

    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.controls.dampingFactor = 0.15;
    this.controls.zoomToCursor = false;
    this.controls.addEventListener("change", () => this.ask());
    this.controls.addEventListener("start", () => {
      this.isFitted = false;
    });

    this.addPoints();
    this.ghost = this.makeGhost();
    this.look("iso");
    new ResizeObserver(() => this.resize()).observe(host);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.apply(store.state, null));
    this.resize();
    store.watch((state, before) => this.apply(state, state === before ? null : before));
  }

  private material(vertexShader: string, fragmentShader: string, uniforms: Record<string, { value: unknown }>) {
    return new ShaderMaterial({ glslVersion: GLSL3, vertexShader, fragmentShader, uniforms, side: DoubleSide });
  }

  private addPoints(): void {
    const { points, radius } = this.report;
    if (!points) return;
    this.pointUniforms.hasNormals.value = points.normals !== null;
    // About the distance to the next point, were they spread over a ball's surface.
    this.pointUniforms.worldSize.value = 1.6 * radius * Math.sqrt(4 / Math.max(points.count, 2000));
    const cloud = new ThreePoints(
      pointGeometry(points),
      this.material(pointVertex, pointFragment, this.pointUniforms),
    );
    cloud.frustumCulled = false;
    this.cloudScene.add(cloud);
  }

  /** The whole solid's edges, faint, around a part of it. */
  private makeGhost(): LineSegments | null {
    const index = this.report.text.solid.nodes[0].mesh;
    const mesh = index === null ? null : this.report.mesh(index);
    if (!mesh) return null;
    const material = this.material(edgeVertex, edgeFragment, {
      ...this.edgeUniforms,
      opacity: { value: 0.22 },
      colour: this.pointUniforms.plain,
    });
    material.transparent = true;
    const ghost = new LineSegments(edgeGeometry(mesh), material);
    ghost.visible = false;
    this.solidScene.add(ghost);
    return ghost;
  }

  /** Of what is seen from outside or from inside, which leaves its mark in the stencil. */
  private sideMaterial(side: Side, mark: number): ShaderMaterial {
    const material = this.material(surfaceVertex, surfaceFragment, this.surfaceUniforms);
    material.side = side;
    // The shader is not told: what is drawn of either side is in front for it.
    material.defines = { SEEN_FROM_INSIDE: side === BackSide ? 1 : 0 };
    material.stencilWrite = true;
    material.stencilRef = mark;
    material.stencilZPass = ReplaceStencilOp;
    // Behind its own edges.
    material.polygonOffset = true;
    material.polygonOffsetFactor = 1;
    material.polygonOffsetUnits = 2;
    return material;
  }

  private meshOf(index: number): { surface: Group; edges: LineSegments } | null {
    const known = this.nodeMeshes.get(index);
    if (known) return known;
    const mesh = this.report.mesh(index);
    if (!mesh) return null;
    const edgeMaterial = this.material(edgeVertex, edgeFragment, this.edgeUniforms);
    edgeMaterial.transparent = true;
    // Where the nearest surface is seen from inside the section cuts, and edges behind it are hidden.
    edgeMaterial.stencilWrite = true;
    edgeMaterial.stencilFunc = NotEqualStencilFunc;
    edgeMaterial.stencilRef = k_inside;
    const geometry = surfaceGeometry(mesh);
    const surface = new Group();
    surface.add(
      new ThreeMesh(geometry, this.sideMaterial(FrontSide, 0)),
      new ThreeMesh(geometry, this.sideMaterial(BackSide, k_inside)),
    );
    const made = {
      surface,
      edges: new LineSegments(edgeGeometry(mesh), edgeMaterial),
    };
    this.solidScene.add(made.surface, made.edges);
    this.nodeMeshes.set(index, made);
    return made;
  }

  private apply(state: Readonly<State>, before: Readonly<State> | null): void {
    if (!before || before.theme !== state.theme) this.applyTheme(state);
    this.applyFocus(state);
    if (!before || before.node !== state.node) this.showNode(state.node);
    this.pointUniforms.mode.value = k_modes[state.colour];
    this.surfaceUniforms.byPrimitive.value = state.colour === "primitive";
    this.pointUniforms.range.value = state.range;
    this.applySection(state);
    if (before && before.layout !== state.layout) this.resize();
    this.ask();
  }

  private applyTheme(state: Readonly<State>): void {
    const dark = isDark(state);
    const theme = k_themes[dark ? "dark" : "light"];
    this.shared.background.value.fromArray(theme.background);
    this.shared.plain.value.fromArray(theme.plain);
    this.pointUniforms.plain.value.fromArray(theme.points);
    this.surfaceUniforms.cutColour.value.fromArray(theme.cut);
    this.edgeUniforms.colour.value.fromArray(theme.edge);
    this.pointUniforms.distanceColours.value.dispose();
    this.pointUniforms.distanceColours.value = distanceTexture(dark);
  }

  private applyFocus(state: Readonly<State>): void {
    const dark = isDark(state);
    const focus = focusOf(state, this.byNode);
    const colours: [number, number, number, number][] = [[0.55, 0.55, 0.55, focus ? 0 : 1]];
    this.report.text.primitives.forEach((_, p) => {
      colours.push([...primitiveColour(p, dark), !focus || focus.has(p) ? 1 : 0]);
    });
    this.shared.palette.value.dispose();
    this.shared.palette.value = colourTexture(colours, k_palette_width);
    // A part that is shown alone has its colours unless one of its primitives is pointed at.
    this.surfaceUniforms.dims.value = state.hovered !== null || state.group !== null;
  }

  private showNode(node: number): void {
    const { nodes } = this.report.text.solid;
    const index = nodes[node].mesh;
    for (const { surface, edges } of this.nodeMeshes.values()) surface.visible = edges.visible = false;
    const shown = index === null ? null : this.meshOf(index);
    if (shown) shown.surface.visible = shown.edges.visible = true;
    if (this.ghost) this.ghost.visible = node !== 0;
    this.shownMesh = shown ? index : null;
  }

  private applySection({ section }: Readonly<State>): void {
    this.shared.sectionOn.value = section.on;
    const sign = section.flipped ? -1 : 1;
    const normal = [0, 0, 0];
    normal[section.axis] = sign;
    const offset = (2 * section.place - 1) * this.report.radius;
    this.shared.section.value.set(normal[0], normal[1], normal[2], sign * offset);
  }

  /** How far away the camera must be in a direction to see the whole box around everything. */
  private distanceFor(direction: Vector3): number {
    const { half } = this.report;
    const right = new Vector3().crossVectors(this.camera.up, direction).normalize();
    const up = new Vector3().crossVectors(direction, right);
    const tangent = Math.tan((k_view_angle * Math.PI) / 360);
    let distance = 0;
    for (let corner = 0; corner < 8; ++corner) {
      const place = new Vector3(...half.map((size, axis) => ((corner >> axis) & 1 ? size : -size)));
      const wide = Math.abs(place.dot(right)) / (tangent * this.camera.aspect);
      const high = Math.abs(place.dot(up)) / tangent;
      distance = Math.max(distance, Math.max(wide, high) + place.dot(direction));
    }
    return k_room * distance;
  }

  /** From a direction, with all in view. */
  look(direction: Direction): void {
    const towards = new Vector3(...k_directions[direction]).normalize();
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(towards).multiplyScalar(this.distanceFor(towards));
    this.controls.minDistance = this.report.radius / 20;
    this.controls.maxDistance = 12 * this.report.radius;
    this.controls.update();
    this.isFitted = true;
    this.ask();
  }

  /** Brings a place to the middle, near enough to see what is around it. */
  visit(world: [number, number, number]): void {
    const place = new Vector3(...world).sub(new Vector3(...this.report.centre));
    const towards = this.camera.position.clone().sub(this.controls.target).normalize();
    this.isFitted = false;
    this.controls.target.copy(place);
    this.camera.position.copy(place).addScaledVector(towards, 1.4 * this.report.radius);
    this.controls.update();
    this.ask();
  }

  /** Turns by angles in radians, and comes nearer by a factor: for the keyboard. */
  turn(around: number, up: number, nearer = 1): void {
    this.isFitted = false;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const radius = Math.min(
      this.controls.maxDistance,
      Math.max(this.controls.minDistance, offset.length() / nearer),
    );
    const azimuth = Math.atan2(offset.y, offset.x) + around;
    const height = Math.min(1.56, Math.max(-1.56, Math.asin(offset.z / offset.length()) + up));
    offset.set(Math.cos(azimuth) * Math.cos(height), Math.sin(azimuth) * Math.cos(height), Math.sin(height));
    this.camera.position.copy(this.controls.target).addScaledVector(offset, radius);
    this.controls.update();
    this.ask();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    const halved = this.store.state.layout === "side" && this.report.points !== null;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / (halved ? 2 : 1) / height;
    this.camera.updateProjectionMatrix();
    const offset = this.camera.position.clone().sub(this.controls.target);
    if (this.isFitted) this.camera.position.setLength(this.distanceFor(offset.normalize()));
    this.controls.update();
    this.pointUniforms.pixelsPerUnit.value =
      (height * this.renderer.getPixelRatio()) / (2 * Math.tan((k_view_angle * Math.PI) / 360));
    this.ask();
  }

  private ask(): void {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.controls.update();
      this.draw();
    });
  }

  /** Where a pane's picture is drawn, and the part of it that is seen; in CSS pixels from the lower left. */
  private area(pane: Pane): { picture: Rectangle; seen: Rectangle } {
    const { clientWidth: width, clientHeight: height } = this.host;
    const { layout, divider } = this.store.state;
    const whole = { left: 0, bottom: 0, width, height };
    if (!this.report.points) {
      return { picture: whole, seen: pane === "solid" ? whole : { ...whole, width: 0 } };
    }
    if (layout === "side") {
      const half = { left: pane === "cloud" ? 0 : width / 2, bottom: 0, width: width / 2, height };
      return { picture: half, seen: half };
    }
    const cut = divider * width;
    const seen =
      pane === "cloud" ? { ...whole, width: cut } : { left: cut, bottom: 0, width: width - cut, height };
    return { picture: whole, seen };
  }

  private draw(): void {
    // As near to what is shown as can be: the depth of a picture has few steps.
    const { radius } = this.report;
    const distance = this.camera.position.length();
    this.camera.near = Math.max(distance - 1.2 * radius, radius / 200);
    this.camera.far = distance + 1.2 * radius;
    this.camera.updateProjectionMatrix();
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    const pointSize = this.pointUniforms.worldSize.value;
    this.pointUniforms.worldSize.value = pointSize * this.store.state.pointSize;
    for (const [pane, scene] of [
      ["cloud", this.cloudScene],
      ["solid", this.solidScene],
    ] as const) {
      const { picture, seen } = this.area(pane);
      if (seen.width < 1) continue;
      this.renderer.setViewport(picture.left, picture.bottom, picture.width, picture.height);
      this.renderer.setScissor(seen.left, seen.bottom, seen.width, seen.height);
      this.renderer.render(scene, this.camera);
    }
    this.pointUniforms.worldSize.value = pointSize;
  }

  /** What is at a place of the canvas, in CSS pixels from its upper left. */
  hit(x: number, y: number): Hit | null {
    const fromBelow = this.host.clientHeight - y;
    for (const pane of ["cloud", "solid"] as const) {
      const { picture, seen } = this.area(pane);
      if (x < seen.left || x >= seen.left + seen.width) continue;
      const pointer = new Vector2(
        (2 * (x - picture.left)) / picture.width - 1,
        (2 * (fromBelow - picture.bottom)) / picture.height - 1,
      );
      const plane = this.shared.section.value;
      const isCut = (px: number, py: number, pz: number) =>
        this.shared.sectionOn.value && px * plane.x + py * plane.y + pz * plane.z > plane.w;
      if (pane === "cloud") return hitCloud(this.report, this.camera, pointer, picture, isCut);
      const shown = this.shownMesh === null ? null : this.nodeMeshes.get(this.shownMesh);
      return shown ? hitSolid(shown.surface, this.camera, pointer, isCut) : null;
    }
    return null;
  }
}
