// SPDX-License-Identifier: MIT
// What two parts share, as a solid of its own, at any instant: no mesh of it is made. A piece of one part's surface bounds what both share
// where it lies inside the other part, and a point lies inside a closed part if, from the eye to it, more of that part's faces turn towards
// the eye than away. The stencil counts them (Goldfeather's method); surfaces behind surfaces are taken layer by layer.
import * as THREE from "three";

const layers = 3;

const vertex = /* glsl */ `
  varying vec3 facing;
  #ifdef SECTION
  varying vec3 world;
  #endif
  void main() {
    facing = normalMatrix * normal;
    #ifdef SECTION
      world = (modelMatrix * vec4(position, 1.0)).xyz;
    #endif
    gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0));
  }`;

const fragment = /* glsl */ `
  uniform vec3 color;
  uniform sampler2D before;
  uniform vec2 size;
  uniform vec4 plane;
  varying vec3 facing;
  #ifdef SECTION
  varying vec3 world;
  #endif
  void main() {
    #ifdef SECTION
      if (dot(world, plane.xyz) > plane.w) discard;
    #endif
    #ifdef BEHIND
      if (gl_FragCoord.z <= texture2D(before, gl_FragCoord.xy / size).x + 1e-6) discard;
    #endif
    float key = max(dot(normalize(facing), normalize(vec3(-0.45, 0.65, 0.75))), 0.0);
    gl_FragColor = vec4(color * (0.68 + 0.4 * key), 1.0);
  }`;

const screen = "varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }";

function candidate(uniforms, defines) {
  return new THREE.ShaderMaterial({ vertexShader: vertex, fragmentShader: fragment, uniforms, defines, side: THREE.FrontSide, blending: THREE.NoBlending });
}

function counter(side, pass) {
  return new THREE.ShaderMaterial({
    vertexShader: "void main() { gl_Position = projectionMatrix * (modelViewMatrix * vec4(position, 1.0)); }",
    fragmentShader: "void main() { gl_FragColor = vec4(0.0); }",
    side, colorWrite: false, depthWrite: false, depthFunc: THREE.LessDepth, stencilWrite: true, stencilFunc: THREE.AlwaysStencilFunc, stencilZPass: pass,
  });
}

export class Overlaps {
  // pairs: of parts that share material somewhere, by their indices.
  constructor(renderer, plane, pairs) {
    this.renderer = renderer;
    this.pairs = pairs;
    this.color = new THREE.Color();
    this.uniforms = { color: { value: this.color }, before: { value: null }, size: { value: new THREE.Vector2() }, plane };
    this.first = [candidate(this.uniforms, {}), candidate(this.uniforms, { SECTION: 1 })];
    this.behind = [candidate(this.uniforms, { BEHIND: 1 }), candidate(this.uniforms, { BEHIND: 1, SECTION: 1 })];
    this.counters = [counter(THREE.FrontSide, THREE.IncrementWrapStencilOp), counter(THREE.BackSide, THREE.DecrementWrapStencilOp)];
    this.erase = new THREE.ShaderMaterial({
      vertexShader: screen, fragmentShader: "void main() { gl_FragColor = vec4(0.0); }", blending: THREE.NoBlending, depthTest: false, depthWrite: false,
      stencilWrite: true, stencilFunc: THREE.EqualStencilFunc, stencilRef: 0,
    });
    const source = { colour: { value: null }, depth: { value: null } };
    this.merge = new THREE.ShaderMaterial({
      vertexShader: screen, uniforms: source, blending: THREE.NoBlending,
      fragmentShader: `uniform sampler2D colour; uniform sampler2D depth; varying vec2 at;
        void main() { vec4 c = texture2D(colour, at); if (c.a < 0.5) discard; gl_FragColor = c; gl_FragDepth = texture2D(depth, at).x; }`,
    });
    this.cover = new THREE.ShaderMaterial({
      vertexShader: screen, uniforms: { colour: { value: null }, size: this.uniforms.size }, transparent: true, premultipliedAlpha: true, depthTest: false, depthWrite: false,
      fragmentShader: `uniform sampler2D colour; uniform vec2 size; varying vec2 at;
        void main() { vec2 d = 0.5 / size; vec4 c = 0.25 * (texture2D(colour, at + d) + texture2D(colour, at - d) + texture2D(colour, at + vec2(d.x, -d.y)) + texture2D(colour, at + vec2(-d.x, d.y)));
          gl_FragColor = 0.94 * c; }`,
    });
    this.solo = new THREE.Mesh();
    this.solo.matrixAutoUpdate = this.solo.frustumCulled = false;
    this.stage = new THREE.Scene();
    this.stage.add(this.solo);
    this.quad = new THREE.PlaneGeometry(2, 2);
    this.boxes = [new THREE.Box3(), new THREE.Box3()];
  }

  paint(css) {
    this.color.setStyle(css, THREE.LinearSRGBColorSpace);
  }

  resize(width, height) {
    if (this.width === width && this.height === height) return;
    [this.width, this.height] = [width, height];
    for (const target of this.targets ?? []) target.dispose();
    this.targets = [0, 1, 2].map(() => {
      const depthTexture = new THREE.DepthTexture(width, height, THREE.UnsignedInt248Type);
      depthTexture.format = THREE.DepthStencilFormat;
      return new THREE.WebGLRenderTarget(width, height, { depthTexture, stencilBuffer: true });
    });
    this.uniforms.size.value.set(width, height);
  }

  render(camera, geometry, material, matrix) {
    this.solo.geometry = geometry;
    this.solo.material = material;
    this.solo.matrix.copy(matrix);
    this.solo.matrixWorldNeedsUpdate = true;
    this.renderer.render(this.stage, camera);
  }

  full(camera, material) {
    this.render(camera, this.quad, material, new THREE.Matrix4());
  }

  // Where the surface drawn last lies inside none of `part`'s material it is taken away again.
  keepInside(camera, part) {
    this.renderer.clear(false, false, true);
    for (const material of this.counters) this.render(camera, part.meshes[0].geometry, material, part.group.matrix);
    this.full(camera, this.erase);
  }

  add(camera, from) {
    this.merge.uniforms.colour.value = from.texture;
    this.merge.uniforms.depth.value = from.depthTexture;
    this.renderer.setRenderTarget(this.targets[2]);
    this.full(camera, this.merge);
  }

  // The sides of what both share that are of part `a`.
  addSides(camera, a, b, inSection, count) {
    for (let k = 0; k < count; ++k) {
      const target = this.targets[k % 2];
      this.uniforms.before.value = k > 0 ? this.targets[(k + 1) % 2].depthTexture : null;
      this.renderer.setRenderTarget(target);
      this.renderer.clear();
      this.render(camera, a.meshes[0].geometry, (k > 0 ? this.behind : this.first)[Number(inSection)], a.group.matrix);
      this.keepInside(camera, b);
      this.add(camera, target);
    }
    this.uniforms.before.value = null;
  }

  // The side that a section makes.
  addCut(camera, a, b, section, reach) {
    const [target] = this.targets, place = new THREE.Matrix4().lookAt(section.normal, new THREE.Vector3(), camera.up);
    place.setPosition(section.normal.clone().multiplyScalar(section.offset / section.normal.lengthSq()).add(reach.along)).scale(new THREE.Vector3(reach.radius, reach.radius, 1));
    this.renderer.setRenderTarget(target);
    this.renderer.clear();
    this.render(camera, this.quad, this.first[0], place);
    this.keepInside(camera, a);
    this.keepInside(camera, b);
    this.add(camera, target);
  }

  isNear(a, b) {
    const [x, y] = this.boxes;
    x.copy(a.solid.box).applyMatrix4(a.group.matrix);
    y.copy(b.solid.box).applyMatrix4(b.group.matrix);
    return x.intersectsBox(y);
  }

  // Draws over what `target` (null: the page) has of the mechanism.
  draw(target, width, height, mechanism, camera, section, box, plain) {
    const near = this.pairs.filter(([i, j]) => [i, j].every((k) => mechanism.parts[k]?.solid.closed && mechanism.parts[k].group.visible) && this.isNear(mechanism.parts[i], mechanism.parts[j]));
    if (near.length === 0) return;
    this.resize(Math.round(width), Math.round(height));
    this.renderer.setRenderTarget(this.targets[2]);
    this.renderer.clear();
    for (const [i, j] of near) {
      const a = mechanism.parts[i], b = mechanism.parts[j];
      this.addSides(camera, a, b, !!section, plain ? 1 : layers);
      this.addSides(camera, b, a, !!section, plain ? 1 : layers);
      if (section) {
        const middle = box.getCenter(new THREE.Vector3()), radius = 2 * box.getBoundingSphere(new THREE.Sphere()).radius;
        this.addCut(camera, a, b, section, { radius, along: middle.addScaledVector(section.normal, -middle.dot(section.normal) / section.normal.lengthSq()) });
      }
    }
    this.cover.uniforms.colour.value = this.targets[2].texture;
    this.renderer.setRenderTarget(target);
    this.full(camera, this.cover);
  }
}
