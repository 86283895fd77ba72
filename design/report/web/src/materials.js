// SPDX-License-Identifier: MIT
// How parts look: matt, lit from the viewer's upper left; a section shows the material it cuts, hatched. Colours are as they appear, sRGB.
//
// A section draws the cut without cutting the mesh: where the first thing seen behind the plane is the inside of a solid, the plane went
// through its material there, since no two solids share any. Edges that lie behind a cut are kept out of it by the stencil.
import * as THREE from "three";

const vertex = /* glsl */ `
  #ifdef SECTION
  varying vec3 world;
  #endif
  #ifndef LINES
  varying vec3 facing;
  #endif
  void main() {
    vec4 at = vec4(position, 1.0);
    #ifdef SECTION
      world = (modelMatrix * at).xyz;
    #endif
    #ifdef LINES
      gl_PointSize = 7.0;
    #else
      facing = normalMatrix * normal;
    #endif
    gl_Position = projectionMatrix * (modelViewMatrix * at);
  }`;

const cut = /* glsl */ `
  #ifdef SECTION
    if (dot(world, plane.xyz) > plane.w) discard;
  #endif`;

const fragment = /* glsl */ `
  uniform vec3 color;
  uniform vec3 faded;
  uniform float fade;
  uniform vec2 hatch;
  #ifdef SECTION
  uniform vec4 plane;
  varying vec3 world;
  #endif
  varying vec3 facing;
  void main() {
    ${cut}
    #ifdef CUT
      float stripe = abs(fract(dot(gl_FragCoord.xy, hatch)) - 0.5) * 2.0;
      gl_FragColor = vec4(mix(mix(color * 1.02, color * 0.66, smoothstep(0.66, 0.86, stripe)), faded, fade), 1.0);
      return;
    #endif
    vec3 n = normalize(gl_FrontFacing ? facing : -facing);
    float key = max(dot(n, normalize(vec3(-0.45, 0.65, 0.75))), 0.0);
    float fill = max(dot(n, normalize(vec3(0.7, -0.2, 0.45))), 0.0);
    vec3 lit = color * (0.66 + 0.09 * n.y + 0.33 * key + 0.10 * fill);
    gl_FragColor = vec4(mix(lit, faded, fade), 1.0);
  }`;

const lineFragment = /* glsl */ `
  uniform vec3 color;
  uniform vec3 faded;
  uniform float fade;
  #ifdef SECTION
  uniform vec4 plane;
  varying vec3 world;
  #endif
  void main() {
    ${cut}
    gl_FragColor = vec4(mix(color, faded, fade), 1.0);
  }`;

// Shared by everything: the section's plane (normal, offset: what is beyond it is cut away), and what fading fades to.
export const shared = {
  plane: { value: new THREE.Vector4(0, 0, 1, 1e9) },
  faded: { value: new THREE.Color() },
};

// What is drawn of a part: the whole of it, whose insides are not seen if it is closed; in section what faces the viewer, and what the section shows of its material; lines.
const cutRef = 1;
const kinds = {
  whole: { side: THREE.FrontSide },
  open: { side: THREE.DoubleSide },
  kept: { side: THREE.FrontSide, defines: { SECTION: 1 }, stencilRef: 0, stencilFunc: THREE.AlwaysStencilFunc },
  cut: { side: THREE.BackSide, defines: { SECTION: 1, CUT: 1 }, stencilRef: cutRef, stencilFunc: THREE.AlwaysStencilFunc },
  lines: {},
  keptLines: { defines: { SECTION: 1 }, stencilRef: cutRef, stencilFunc: THREE.NotEqualStencilFunc },
};

function material(kind, color, index, fade) {
  const angle = (0.25 + 0.2 * (index % 4)) * Math.PI, pitch = 7, isLine = kind === "lines" || kind === "keptLines";
  const { stencilFunc, stencilRef, side, defines } = kinds[kind];
  const made = new THREE.ShaderMaterial({
    vertexShader: vertex,
    fragmentShader: isLine ? lineFragment : fragment,
    polygonOffset: !isLine,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
    uniforms: {
      color: { value: color },
      fade,
      hatch: { value: new THREE.Vector2(Math.cos(angle) / pitch, Math.sin(angle) / pitch) },
      faded: shared.faded,
      plane: shared.plane,
    },
  });
  if (side !== undefined) made.side = side;
  Object.assign(made.defines, defines, isLine ? { LINES: 1 } : {});
  if (stencilFunc !== undefined) {
    made.stencilWrite = true;
    made.stencilRef = stencilRef;
    made.stencilFunc = stencilFunc;
    made.stencilZPass = isLine ? THREE.KeepStencilOp : THREE.ReplaceStencilOp;
  }
  return made;
}

// Those of one part; `fade.value` in [0, 1] draws it back.
export function partMaterials(index) {
  const fade = { value: 0 }, color = new THREE.Color(), lineColor = new THREE.Color();
  const made = {
    fade,
    paint(css, dark) {
      color.setStyle(css, THREE.LinearSRGBColorSpace);
      lineColor.copy(color).multiplyScalar(dark ? 0.28 : 0.42);
    },
  };
  for (const kind of Object.keys(kinds)) made[kind] = material(kind, kind.toLowerCase().includes("lines") ? lineColor : color, index, fade);
  return made;
}

// Two pictures over each other.
export function blendMaterial() {
  return new THREE.ShaderMaterial({
    vertexShader: "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }",
    fragmentShader: `uniform sampler2D before; uniform sampler2D after; uniform float share; varying vec2 at;
      void main() { gl_FragColor = mix(texture2D(before, at), texture2D(after, at), share); }`,
    uniforms: { before: { value: null }, after: { value: null }, share: { value: 0.5 } },
    depthTest: false,
    depthWrite: false,
    transparent: true,
    premultipliedAlpha: true,
    blending: THREE.NoBlending,
  });
}
