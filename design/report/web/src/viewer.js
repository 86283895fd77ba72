// SPDX-License-Identifier: MIT
// The picture: mechanisms, camera, section, what is marked in it. Draws when something has changed, not all the time.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { element, reducedMotion } from "./dom.js";
import { blendMaterial, partMaterials, shared } from "./materials.js";
import { Mechanism } from "./mechanism.js";
import { Overlaps } from "./overlap.js";
import { solidOf } from "./solid.js";

// Material that two parts share.
const interfering = (data) => (data.pairs ?? []).filter((pair) => pair.finding === "clash" && pair.body_a >= 0 && pair.body_b >= 0).map((pair) => [pair.body_a, pair.body_b]);

const isSame = (x, y) => x.length === y.length && x.every((v, i) => v === y[i]);
const isSameMesh = (x, y) => isSame(x.vertices, y.vertices) && isSame(x.triangles, y.triangles) && isSame(x.edges ?? [], y.edges ?? []);

export class Viewer {
  constructor(canvas, overlay, data) {
    this.canvas = canvas;
    this.overlay = overlay;
    this.mode = data.views.some((view) => view.name === "after") ? "after" : data.views[0].name;
    this.time = 0;
    this.exploded = 0;
    this.share = 0.5;
    this.hidden = new Set();
    this.section = null;
    this.marked = null;
    this.held = null;  // poses of a pair's worst position among the joints', or those of `pose`
    this.beyond = null;
    this.coarse = false;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: false, alpha: true, stencil: true, powerPreference: "high-performance" });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.renderer.setClearColor(0, 0);
    this.scene = new THREE.Scene();
    this.scene.matrixWorldAutoUpdate = true;
    this.camera = new THREE.PerspectiveCamera(26, 1, 0.1, 1000);
    this.up = new THREE.Vector3(...data.up);
    this.camera.up.copy(this.up);
    this.bodies = data.views[0].bodies;
    this.materials = this.bodies.map((_, i) => partMaterials(i));
    this.meshes = data.meshes;
    this.solids = [];
    this.views = new Map(data.views.map((view) => [view.name, view]));
    this.mechanisms = new Map();
    this.overlaps = new Overlaps(this.renderer, shared.plane, interfering(data));
    this.look(this.mode === "after" ? [...this.views.keys()].filter((name) => name === "before" || name === "after") : [this.mode]);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.rotateSpeed = 0.8;
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(canvas.parentElement);
    this.view("home", true);
    this.resize();
  }

  // Made when it is first shown: of many designs few are.
  mechanism(name) {
    if (!this.mechanisms.has(name)) {
      const view = this.views.get(name);
      for (const { mesh } of view.bodies) this.solids[mesh] ??= solidOf(this.meshes[mesh]);
      const made = new Mechanism(view, this.solids, this.materials);
      made.setSection(!!this.section);
      this.mechanisms.set(name, made);
      this.scene.add(made.root);
    }
    return this.mechanisms.get(name);
  }

  // Other parts and another motion; camera, section, what is hidden and how far parts are apart stay. Parts that are the same stay drawn.
  replace(views, meshes) {
    for (const { root } of this.mechanisms.values()) this.scene.remove(root);
    this.mechanisms.clear();
    const former = this.solids, kept = meshes.map((mesh, k) => (this.meshes[k] && isSameMesh(this.meshes[k], mesh) ? former[k] : undefined));
    for (const solid of former) if (solid && !kept.includes(solid)) [solid.solid, solid.lines, solid.points].forEach((geometry) => geometry?.dispose());
    this.solids = kept;
    this.meshes = meshes;
    this.views = new Map(views.map((view) => [view.name, view]));
    this.bodies = views[0].bodies;
    for (let i = this.materials.length; i < this.bodies.length; ++i) this.materials.push(partMaterials(i));
    this.look([this.mode]);
    this.fitted = this.fit(this.camera.position.clone().sub(this.controls.target).normalize()).distance;
    this.draw();
  }

  // All parts where someone puts them, which may be farther out than their motion takes them. null: where their motion has them.
  pose(poses) {
    this.held = poses;
    this.beyond = null;
    if (poses) {
      const mechanism = this.mechanism(this.mode);
      mechanism.setTime(this.time, 0, poses);
      this.beyond = mechanism.parts.reduce((box, part) => box.union(part.solid.box.clone().applyMatrix4(part.group.matrix)), this.box.clone());
    }
    this.draw();
  }

  setPairs(data) {
    this.overlaps.pairs = interfering(data);
  }

  // Does it show the whole as it did at first?
  isAtHome() {
    const direction = this.homeDirection(), { target, distance } = this.fit(direction);
    return this.camera.position.distanceTo(target.addScaledVector(direction, distance)) < 1e-3 * distance;
  }

  // What the picture is to have room for: these over their whole motions.
  look(names) {
    this.points = names.flatMap((name) => this.mechanism(name).reach());
    this.box = new THREE.Box3().setFromPoints(this.points.map(({ at }) => at));
    this.apart = this.points.reduce((most, { away }) => Math.max(most, away.length()), 0);
  }

  // What share of what moves is hidden as the page opens.
  firstHiddenShare() {
    return this.mechanisms.values().next().value.hiddenShare(this.homeDirection());
  }

  // Another mechanism alone, with the camera where it is.
  showOnly(name) {
    this.mode = name;
    this.look([name]);
    this.refit();
  }

  paint(dark) {
    this.materials.forEach((each, i) => each.paint(this.bodies[i].colour, dark));
    this.overlaps.paint(getComputedStyle(document.documentElement).getPropertyValue("--bad").trim());
    shared.faded.value.setStyle(dark ? "#22262c" : "#eae7e0", THREE.LinearSRGBColorSpace);
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    this.renderer.setSize(width, height, false);
    this.targets?.forEach((target) => target?.dispose());
    this.targets = null;
    this.refit();
  }

  // Another place to draw in, or two instead of one: what was seen whole is seen whole, what was near stays near.
  refit() {
    const offset = this.camera.position.clone().sub(this.controls.target), { distance } = this.fit(offset.clone().normalize());
    if (this.fitted) this.camera.position.copy(this.controls.target).addScaledVector(offset, distance / this.fitted);
    this.fitted = distance;
    this.controls.update();
    this.draw();
  }

  // Takes the parts apart by this share; what was seen whole is seen whole.
  explode(share) {
    const direction = () => this.camera.position.clone().sub(this.controls.target).normalize();
    const before = this.fit(direction()).target;
    this.exploded = share;
    const shift = this.fit(direction()).target.sub(before);
    this.controls.target.add(shift);
    this.camera.position.add(shift);
    this.refit();
  }

  // Asks for one picture, soon.
  draw() {
    if (this.asked) return;
    this.asked = requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    if (this.asked) cancelAnimationFrame(this.asked);
    this.asked = 0;
    this.drawn = (this.drawn ?? 0) + 1;
    const size = this.renderer.getSize(new THREE.Vector2());
    const side = this.mode === "side";
    this.camera.aspect = (side ? size.x / 2 : size.x) / size.y;
    const box = this.beyond ?? this.box, reach = box.getBoundingSphere(new THREE.Sphere()).radius + this.apart * this.exploded || 1;
    const distance = this.camera.position.distanceTo(box.getCenter(new THREE.Vector3()));
    this.camera.near = Math.max(distance - reach * 1.6, this.camera.position.distanceTo(this.controls.target) * 0.05, reach * 1e-4);
    this.camera.far = distance + reach * 1.6;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    if (this.mode === "fade") {
      this.begin(this.target(0, size));
      this.drawOne("before");
      this.begin(this.target(1, size));
      this.drawOne("after");
      this.show(0, 1, this.share);
    } else {
      this.begin(this.coarse ? null : this.target(0, size));
      if (side) {
        this.drawIn("before", 0, size);
        this.drawIn("after", 1, size);
      } else {
        this.drawOne(this.mode);
      }
      if (!this.coarse) this.show(0, 0, 1);
    }
    this.mark(size);
  }

  // Pictures with smooth edges are drawn aside first; where that is too slow for a motion, `coarse` draws straight to the page.
  target(k, size) {
    const ratio = this.renderer.getPixelRatio();
    this.targets ??= [null, null];
    return (this.targets[k] ??= new THREE.WebGLRenderTarget(size.x * ratio, size.y * ratio, { samples: 4, stencilBuffer: true }));
  }

  begin(target) {
    this.renderer.setRenderTarget(target);
    this.renderer.setScissorTest(false);
    this.renderer.clear();
  }

  // What was drawn aside, two of it over each other.
  show(before, after, share) {
    this.blend ??= new THREE.Mesh(new THREE.PlaneGeometry(2, 2), blendMaterial());
    this.blend.frustumCulled = false;
    const { uniforms } = this.blend.material;
    uniforms.before.value = this.targets[before].texture;
    uniforms.after.value = this.targets[after].texture;
    uniforms.share.value = share;
    this.begin(null);
    this.renderer.render(this.blend, this.camera);
  }

  drawOne(name) {
    for (const [other, mechanism] of this.mechanisms) mechanism.root.visible = other === name;
    const mechanism = this.mechanism(name);
    mechanism.root.visible = true;
    mechanism.setTime(this.time, this.exploded, this.held);
    mechanism.parts.forEach((part, i) => (part.group.visible = !this.hidden.has(i)));
    this.renderer.render(this.scene, this.camera);
    if (name !== "before" && this.exploded === 0) {
      const target = this.renderer.getRenderTarget(), place = target ? target.viewport : this.renderer.getCurrentViewport(new THREE.Vector4());
      this.overlaps.draw(target, place.z, place.w, mechanism, this.camera, this.section, this.box, this.coarse);
    }
  }

  // In the left (0) or right (1) half.
  drawIn(name, half, size) {
    const target = this.coarse ? this.renderer : this.targets[0], width = this.coarse ? size.x / 2 : target.width / 2;
    const box = [half * width, 0, width, this.coarse ? size.y : target.height];
    if (this.coarse) {
      target.setViewport(...box);
      target.setScissor(...box);
      target.setScissorTest(true);
    } else {
      target.viewport.set(...box);
      target.scissor.set(...box);
      target.scissorTest = true;
      this.renderer.setRenderTarget(target);
    }
    this.drawOne(name);
    if (this.coarse) {
      target.setViewport(0, 0, size.x, size.y);
      target.setScissorTest(false);
    } else {
      target.viewport.set(0, 0, target.width, target.height);
      target.scissorTest = false;
    }
  }

  // Where a point of the world is in the picture, in pixels of the page.
  project(point, size) {
    const side = this.mode === "side", at = point.clone().project(this.camera);
    const width = side ? size.x / 2 : size.x;
    return { x: (side ? width : 0) + ((at.x + 1) / 2) * width, y: ((1 - at.y) / 2) * size.y, inside: at.z < 1 };
  }

  // The gap of the marked pair: its line, arrows along its normal, its length.
  mark(size) {
    this.overlay.replaceChildren();
    this.overlay.toggleAttribute("hidden", true);  // an empty layer over the picture costs time as well
    const showsAfter = this.mode !== "before";
    if (!this.marked || !showsAfter || this.exploded > 0 || Math.abs(this.time - this.marked.time) > this.marked.near) return;
    const isShared = this.marked.shared;
    const p = this.project(this.marked.a, size), q = this.project(this.marked.b, size);
    if (!p.inside || !q.inside) return;
    this.overlay.toggleAttribute("hidden", false);
    this.overlay.classList.toggle("shared", !!isShared);
    let dx = q.x - p.x, dy = q.y - p.y;
    const long = Math.hypot(dx, dy);
    if (long > 1e-6) [dx, dy] = [dx / long, dy / long];
    else [dx, dy] = [0, 1];
    const line = (type, x1, y1, x2, y2) => this.overlay.append(element("svg:line", { class: type, x1, y1, x2, y2 }));
    if (!isShared) line("gap", p.x, p.y, q.x, q.y);
    for (const [end, sign] of isShared ? [] : [[p, -1], [q, 1]]) {  // as on a drawing, from outside towards the gap
      const at = (n, m) => `${end.x + sign * dx * n - dy * m},${end.y + sign * dy * n + dx * m}`;
      this.overlay.append(element("svg:polyline", { class: "arrow", points: [at(34, 0), at(5, 0)].join(" ") }));
      this.overlay.append(element("svg:polyline", { class: "arrow", points: [at(11, 4), at(5, 0), at(11, -4)].join(" ") }));
      this.overlay.append(element("svg:circle", { class: "dot", cx: end.x, cy: end.y, r: 3 }));
    }
    const mx = (p.x + q.x) / 2, my = (p.y + q.y) / 2, right = mx < size.x - 130;
    const tx = mx + (right ? 1 : -1) * (24 + Math.abs(dx) * 20), ty = my - 30;
    line("leader", mx, my, tx, ty);
    if (isShared) this.overlay.append(element("svg:circle", { class: "dot", cx: mx, cy: my, r: 3 }));
    const text = element("svg:text", { x: tx + (right ? 5 : -5), y: ty + 4, "text-anchor": right ? "start" : "end" });
    text.textContent = this.marked.label;
    this.overlay.append(text);
    if (!this.marked.within) return;
    const { x, width } = text.getBBox();  // of one that has names in it, and is to be read whole where there is room for it
    text.setAttribute("x", Number(text.getAttribute("x")) + Math.max(4 - x, Math.min(0, size.x - 4 - x - width)));
  }

  setSection(normal, offset) {
    this.section = normal ? { normal, offset } : null;
    for (const mechanism of this.mechanisms.values()) mechanism.setSection(!!normal);
    if (normal) shared.plane.value.set(normal.x, normal.y, normal.z, offset);
    this.draw();
  }

  // Draws all parts back but these; null: none.
  emphasise(indices) {
    this.materials.forEach((each, i) => (each.fade.value = !indices || indices.includes(i) ? 0 : 0.72));
    this.draw();
  }

  // The direction from which the whole is looked at first: across its flattest side, a little from above and from the right.
  homeDirection() {
    const size = this.box.getSize(new THREE.Vector3()), lengths = [size.x, size.y, size.z];
    const normal = new THREE.Vector3().setComponent(lengths.indexOf(Math.min(...lengths)), 1);
    const lying = Math.abs(normal.dot(this.up)) > 0.8;
    if (lying) normal.copy(this.across());
    if (normal.dot(new THREE.Vector3(0.1, -1, 1)) < 0) normal.negate();
    const right = new THREE.Vector3().crossVectors(this.up, normal).normalize();
    return normal.addScaledVector(right, 0.45).addScaledVector(this.up, lying ? 1 : 0.42).normalize();
  }

  // The axis nearest to horizontal along which the mechanism is shortest.
  across() {
    const size = this.box.getSize(new THREE.Vector3()), axes = [new THREE.Vector3(1, 0, 0), new THREE.Vector3(0, 1, 0), new THREE.Vector3(0, 0, 1)];
    return axes.filter((axis) => Math.abs(axis.dot(this.up)) < 0.8).sort((p, q) => size.dot(p) - size.dot(q))[0];
  }

  view(which, atOnce = false) {
    let direction = this.homeDirection();
    if (which !== "home") {
      direction = new THREE.Vector3(which === "x" ? 1 : 0, which === "y" ? 1 : 0, which === "z" ? 1 : 0);
      // Not quite along the upright axis, round which the view turns.
      if (Math.abs(direction.dot(this.up)) > 0.99) direction.addScaledVector(this.across(), -0.001).normalize();
    }
    const { target, distance } = this.fit(direction);
    this.fitted = distance;
    this.fly(target, direction, distance, atOnce);
  }

  // Where to look at, and from how far, to see all of it from this direction, parts taken apart included.
  fit(direction) {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const tall = Math.tan((this.camera.fov * Math.PI) / 360), wide = (tall * width * (this.mode === "side" ? 0.5 : 1)) / Math.max(1, height);
    const right = new THREE.Vector3().crossVectors(this.up, direction).normalize(), above = new THREE.Vector3().crossVectors(direction, right);
    const target = this.box.getCenter(new THREE.Vector3()), flat = new THREE.Box2(), at = new THREE.Vector3();
    for (const point of this.points) {
      at.copy(point.at).addScaledVector(point.away, this.exploded).sub(target);
      flat.expandByPoint(new THREE.Vector2(at.dot(right), at.dot(above)));
    }
    const middle = flat.getCenter(new THREE.Vector2());
    target.addScaledVector(right, middle.x).addScaledVector(above, middle.y);
    let distance = 0;
    for (const point of this.points) {
      at.copy(point.at).addScaledVector(point.away, this.exploded).sub(target);
      distance = Math.max(distance, at.dot(direction) + Math.max(Math.abs(at.dot(right)) / wide, Math.abs(at.dot(above)) / tall));
    }
    return { target, distance: distance * 1.12 || 1 };
  }

  // Moves the camera to look at `target` from `direction`, `distance` away.
  fly(target, direction, distance, atOnce = false) {
    const end = target.clone().addScaledVector(direction, distance);
    if (this.flight) cancelAnimationFrame(this.flight);
    const start = this.camera.position.clone(), from = this.controls.target.clone(), began = performance.now();
    const step = () => {
      const share = atOnce || reducedMotion() ? 1 : Math.min(1, (performance.now() - began) / 650), eased = 1 - (1 - share) ** 3;
      this.controls.target.lerpVectors(from, target, eased);
      // Round the target and towards it: direction and distance each by itself.
      const a = start.clone().sub(from), b = end.clone().sub(target);
      const length = a.length() ** (1 - eased) * b.length() ** eased;
      const way = share === 1 ? b : a.normalize().lerp(b.normalize(), eased);
      if (way.lengthSq() < 1e-12) way.copy(direction);
      this.camera.position.copy(this.controls.target).addScaledVector(way.normalize(), Number.isFinite(length) && length > 0 ? length : distance);
      this.controls.update();
      this.draw();
      this.flight = share < 1 ? requestAnimationFrame(step) : 0;
    };
    step();
  }

  turn(right, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const aside = new THREE.Vector3().crossVectors(this.camera.up, offset).normalize();
    offset.applyAxisAngle(this.camera.up, right);
    const tilted = offset.clone().applyAxisAngle(aside, up);
    if (Math.abs(tilted.clone().normalize().dot(this.camera.up)) < 0.995) offset.copy(tilted);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  nearer(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  // A still picture, as a data address.
  picture() {
    this.drawNow();
    return this.canvas.toDataURL("image/png");
  }
}
