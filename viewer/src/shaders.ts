/** GLSL of points, surfaces and their edges. All are cut by the same section plane. */

const k_section = /* glsl */ `
uniform vec4 section;  // normal and offset: what is beyond is cut away
uniform bool sectionOn;
bool isCut(vec3 place) { return sectionOn && dot(place, section.xyz) > section.w; }
`;

/** Colours by primitive, one texel each; alpha says whether the primitive is in focus. Texel 0 is for none. */
const k_palette = /* glsl */ `
uniform sampler2D palette;
uniform int paletteWidth;
vec4 paletteColour(float owner) {
  int texel = int(owner + 1.5);
  return texelFetch(palette, ivec2(texel % paletteWidth, texel / paletteWidth), 0);
}
`;

/** One light for points and surfaces, so that the same colour looks the same. */
const k_light = /* glsl */ `
vec3 lit(vec3 colour, vec3 normal, vec3 toEye) {
  vec3 key = normalize(vec3(0.35, 0.6, 0.75));
  float sky = 0.5 + 0.5 * normal.y;
  float fill = max(dot(normal, normalize(vec3(-0.7, -0.2, 0.5))), 0.0);
  float shine = pow(max(dot(reflect(-key, normal), toEye), 0.0), 40.0);
  return colour * (0.53 + 0.13 * sky + 0.38 * max(dot(normal, key), 0.0) + 0.12 * fill) + vec3(0.06 * shine);
}
`;

export const pointVertex = /* glsl */ `
${k_section}
${k_palette}
${k_light}
in float owner;
in float deviation;
uniform float worldSize;
uniform float pixelsPerUnit;  // at depth one
uniform int mode;             // 0 primitive, 1 distance, 2 plain
uniform sampler2D distanceColours;
uniform float range;
uniform vec3 plain;
uniform vec3 background;
uniform bool hasNormals;
out vec3 colour;
void main() {
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * view;
  vec4 own = paletteColour(owner);
  colour = plain;
  if (mode == 0) colour = own.rgb;
  if (mode == 1) colour = texture(distanceColours, vec2(0.5 + 0.5 * clamp(deviation / range, -1.0, 1.0), 0.5)).rgb;
  if (hasNormals) {
    vec3 toEye = normalize(-view.xyz);
    vec3 facing = normalize(normalMatrix * normal);
    colour = lit(colour, facing * (dot(facing, toEye) < 0.0 ? -1.0 : 1.0), toEye);
  }
  bool inFocus = own.a > 0.5;
  float size = max(worldSize * pixelsPerUnit / -view.z, 1.6);
  colour = inFocus ? colour : mix(background, colour, 0.13);
  gl_PointSize = inFocus ? size : size * 0.75;
  // In front of what is not in focus, so that a primitive lights up through it.
  if (!inFocus) gl_Position.z += 0.0005 * gl_Position.w;
  if (isCut(position)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
`;

export const pointFragment = /* glsl */ `
precision highp float;
in vec3 colour;
out vec4 result;
void main() {
  vec2 offset = gl_PointCoord - 0.5;
  if (dot(offset, offset) > 0.25) discard;
  result = vec4(colour, 1.0);
}
`;

export const surfaceVertex = /* glsl */ `
${k_palette}
in float owner;
uniform bool byPrimitive;
uniform vec3 plain;
out vec3 base;
out vec3 viewNormal;
out vec3 viewPlace;
out vec3 place;
out float focus;
void main() {
  place = position;
  vec4 view = modelViewMatrix * vec4(position, 1.0);
  viewPlace = view.xyz;
  viewNormal = normalMatrix * normal;
  vec4 own = paletteColour(owner);
  base = byPrimitive ? own.rgb : plain;
  focus = own.a;
  gl_Position = projectionMatrix * view;
}
`;

export const surfaceFragment = /* glsl */ `
precision highp float;
${k_section}
${k_light}
uniform float opacity;
uniform vec3 cutColour;
uniform vec3 background;
uniform vec3 plain;
uniform bool dims;
in vec3 base;
in vec3 viewNormal;
in vec3 viewPlace;
in vec3 place;
in float focus;
out vec4 result;
void main() {
  if (isCut(place)) discard;
  if (bool(SEEN_FROM_INSIDE) && sectionOn) {
    // What is seen from inside is where the section cuts: hatched, as in a drawing.
    float stripe = step(0.5, fract((gl_FragCoord.x + gl_FragCoord.y) / 9.0));
    result = vec4(mix(cutColour, cutColour * 0.86, stripe), opacity);
    return;
  }
  vec3 normal = normalize(viewNormal) * (bool(SEEN_FROM_INSIDE) ? -1.0 : 1.0);
  vec3 toEye = normalize(-viewPlace);
  vec3 colour = dims && focus < 0.5 ? mix(background, plain, 0.35) : base;
  result = vec4(lit(colour, normal, toEye), opacity);
}
`;

export const edgeVertex = /* glsl */ `
out vec3 place;
void main() {
  place = position;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_Position.z -= 0.00004 * gl_Position.w;
}
`;

export const edgeFragment = /* glsl */ `
precision highp float;
${k_section}
uniform vec3 colour;
uniform float opacity;
in vec3 place;
out vec4 result;
void main() {
  if (isCut(place)) discard;
  result = vec4(colour, opacity);
}
`;
