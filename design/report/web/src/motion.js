// SPDX-License-Identifier: MIT
// The picture's controls: time, which design, parts, explosion, section, and the gap of a pair.
import * as THREE from "three";

import { indexAt } from "./data.js";
import { announce, byId, element, reducedMotion } from "./dom.js";
import { seconds, spaced, upperBound, withUnit } from "./numbers.js";
import { isDark } from "./theme.js";
import { Viewer } from "./viewer.js";
import { depthWords, isShared, isTouching, touchWords } from "./words.js";

const playIcon = "M4 2.2v11.6L13.5 8z", pauseIcon = "M3.5 2.5h3.2v11H3.5zM9.3 2.5h3.2v11H9.3z";
const speeds = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
const names = { after: "After", before: "Before", side: "Side by side", fade: "Over each other" };

export function startMotion(data, onTime) {
  const viewer = new Viewer(byId("canvas"), byId("overlay"), data);
  const motion = new Motion(viewer, data, onTime);
  return motion;
}

class Motion {
  constructor(viewer, data, onTime) {
    this.viewer = viewer;
    this.data = data;
    this.onTime = onTime;
    this.takeTimes();
    this.scenario = 0;
    this.scenarioShown = [];
    this.time = this.start;
    this.speed = this.firstSpeed();
    this.chosen = null;
    this.hand = null;  // what moves the parts by hand: leave() for the motion, show() it again
    this.fillTransport();
    this.fillCompare();
    this.fillScenarios();
    this.fillParts();
    byId("parts-all").addEventListener("click", () => this.showAll());
    this.fillSection();
    this.openWhatHides();
    this.listen();
  }

  takeTimes() {
    const { views } = this.data, all = views.map((view) => view.times);
    this.start = Math.min(...all.map((times) => times[0]));
    this.end = Math.max(...all.map((times) => times[times.length - 1]));
    this.times = (views.find((view) => view.name === this.viewer.mode) ?? views[0]).times;
  }

  // Other parts or another motion, as `data` has them: of other values of a design, or of files that were written to. The instant, what is
  // chosen, and whether it plays, stay; what is marked is not known of these yet.
  replace() {
    const { viewer, data } = this, moved = this.moves(), home = viewer.isAtHome(), names = viewer.bodies.map((body) => body.name);
    viewer.replace(data.views, data.meshes);
    viewer.marked = null;
    viewer.pose(null);
    this.takeTimes();
    this.fitTransport();
    if (names.join("\n") !== viewer.bodies.map((body) => body.name).join("\n")) {
      this.chosen = null;
      this.fillParts();
      this.paint(isDark());
    }
    if (this.moves() && !this.hasMoved) {
      this.speed = this.firstSpeed();
      byId("speed").value = this.speed;
      if (home) viewer.view("home", true);
      if (!byId("section").checked) byId("section-axis").value = this.firstAxis();
      this.openWhatHides();
    }
    if (moved && !this.moves()) this.resumes = this.playing;  // as soon as there is a motion again
    if (!this.moves()) this.pause();
    else if (!moved && (this.hasMoved ? this.resumes : !reducedMotion())) this.play();
    this.hasMoved ||= this.moves();
    if (this.moves()) this.go(this.time);
  }

  // What is marked, as the data's pairs have it: those of what is shown.
  setPairs() {
    const { viewer, data } = this, pair = this.chosen === null ? null : data.pairs[this.chosen];
    viewer.setPairs(data);
    this.fillTicks();
    viewer.marked = viewer.held = null;
    if (pair && this.canShow(this.chosen)) {
      viewer.held = pair.poses ?? null;
      viewer.marked = this.markOf(pair, this.nearInstant());
    } else {
      this.markWorst();
    }
    this.highlight();
    viewer.draw();
    this.hand?.show();
  }

  moves() {
    return this.end > this.start;
  }

  // So that the whole takes from 3 to 8 s, where it can.
  firstSpeed() {
    const span = this.end - this.start;
    if (span >= 3 && span <= 10) return 1;
    return speeds.reduce((best, s) => (Math.abs(Math.log(span / s / 5)) < Math.abs(Math.log(span / best / 5)) ? s : best), 1);
  }

  fillTransport() {
    const scrub = byId("scrub");
    this.fitTransport();
    byId("speed").append(...speeds.map((s) => element("option", { value: s, selected: s === this.speed }, `${s}\u00d7`)));
    byId("speed").addEventListener("change", (event) => (this.speed = Number(event.target.value)));
    scrub.addEventListener("input", () => {
      this.pause();
      this.seek(Number(scrub.value));
    });
    byId("play").addEventListener("click", () => (this.playing ? this.pause() : this.play()));
    this.fillTicks();
  }

  fitTransport() {
    const scrub = byId("scrub");
    scrub.min = this.start;
    scrub.max = this.end;
    document.querySelector(".transport").hidden = !this.moves();
  }

  fillTicks() {
    byId("overlap-key").hidden = !this.data.pairs.some(isShared);
    const marks = this.data.pairs.map((pair, k) => ({ pair, k })).filter(({ pair, k }) => pair.motion && this.canShow(k));
    byId("ticks").replaceChildren(...marks.map(({ pair, k }) => {
      const mark = element("span", { "data-pair": k });
      mark.style.left = `${(100 * (this.instant(pair) - this.start)) / (this.end - this.start || 1)}%`;
      return mark;
    }));
  }

  // A report opens in motion, but for those who do not want any.
  open() {
    this.seek(this.start);
    this.markWorst();
    new IntersectionObserver(([entry]) => (this.seen = entry.isIntersecting)).observe(byId("viewport"));
    if (!reducedMotion()) this.play();
  }

  play() {
    if (!this.moves()) return;
    this.hand?.leave();
    if (this.time >= this.end) this.seek(this.start);
    this.playing = true;
    this.setPlayButton();
    announce("Playing");
    let last = null, between = 0, frames = 0;
    const frame = (now) => {
      if (!this.playing) return;
      if (last !== null && this.seen !== false) {
        // A machine that is slow at it gets plainer pictures while they move.
        between = frames++ === 0 ? now - last : 0.75 * between + 0.25 * (now - last);
        if (frames > 4 && between > 25) this.viewer.coarse = true;
        let t = this.time + ((now - last) / 1000) * this.speed;
        if (t > this.end) t = this.start + ((t - this.start) % (this.end - this.start));
        this.seek(t, true);
      }
      last = now;
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  pause() {
    if (!this.playing) return;
    this.playing = this.viewer.coarse = false;
    this.viewer.draw();
    this.setPlayButton();
    announce(`Paused at ${seconds(this.time, this.data.step)}`);
  }

  setPlayButton() {
    const button = byId("play");
    button.setAttribute("aria-label", this.playing ? "Pause" : "Play");
    button.setAttribute("aria-pressed", String(!!this.playing));
    button.querySelector("path").setAttribute("d", this.playing ? pauseIcon : playIcon);
  }

  seek(t) {
    this.hand?.leave();
    this.go(t);
  }

  go(t) {
    this.time = Math.min(this.end, Math.max(this.start, t));
    this.viewer.time = this.time;
    byId("scrub").value = this.time;
    byId("scrub").setAttribute("aria-valuetext", seconds(this.time, this.data.step));
    byId("clock").textContent = seconds(this.time, this.data.step);
    this.onTime(this.time);
    if (this.playing) this.viewer.drawNow();
    else this.viewer.draw();
  }

  step(by) {
    this.pause();
    const k = indexAt(this.times, this.time + 1e-12 * Math.abs(this.time)) + by;
    this.seek(this.times[Math.max(0, Math.min(this.times.length - 1, k))]);
  }

  fillCompare() {
    if (!this.data.views.some((view) => view.name === "before")) return;
    const choices = ["after", "before", "side", "fade"];
    byId("compare").hidden = false;
    byId("compare").append(...choices.map((mode) => element("label", {},
      element("input", { type: "radio", name: "compare", value: mode, checked: mode === "after", onchange: () => this.setMode(mode) }), element("span", {}, names[mode]))));
    byId("fade").addEventListener("input", (event) => {
      this.viewer.share = Number(event.target.value);
      this.viewer.draw();
    });
  }

  // The motions of the design's scenarios; those before and after are of the first.
  fillScenarios() {
    const { scenarios } = this.data;
    if (!scenarios || scenarios.length < 2) return;
    byId("scenario").hidden = false;
    byId("scenario").append(...scenarios.map(({ name }, k) => element("label", {},
      element("input", { type: "radio", name: "scenario", value: k, checked: k === 0, onchange: () => this.setScenario(k) }), element("span", {}, name))));
  }

  // Calls `show` with the scenario's number whenever another one is shown.
  onScenario(show) {
    this.scenarioShown.push(show);
  }

  setScenario(k) {
    if (k === this.scenario) return;
    this.scenario = k;
    const { name, view } = this.data.scenarios[k], compares = this.data.views.some((each) => each.name === "before");
    for (const input of byId("scenario").querySelectorAll("input")) input.checked = Number(input.value) === k;
    byId("compare").hidden = k > 0 || !compares;
    if (k === 0) this.setMode("after");
    else this.setMode(view);
    this.times = this.data.views.find((each) => each.name === view).times;
    this.seek(this.time);
    this.scenarioShown.forEach((show) => show(k));
    announce(`Shown: the scenario ${name}`);
  }

  setMode(mode) {
    if (names[mode]) this.setScenario(0);
    this.viewer.marked = names[mode] ? this.viewer.marked : null;
    this.viewer.mode = mode;
    for (const input of byId("compare").querySelectorAll("input")) input.checked = input.value === mode;
    byId("fade-field").hidden = mode !== "fade";
    byId("corner-left").hidden = byId("corner-right").hidden = byId("divider").hidden = mode !== "side";
    byId("corner-left").textContent = "before";
    byId("corner-right").textContent = "after";
    if (names[mode]) announce(`Shown: ${names[mode]}`);
    this.viewer.refit();
  }

  fillParts() {
    this.swatches = [];
    this.viewer.hidden.clear();
    byId("canvas").setAttribute("aria-label", `${this.data.name}: ${this.data.views[0].bodies.map((body) => body.name).slice(0, 12).join(", ")}`);
    byId("parts").replaceChildren(...this.data.views[0].bodies.map((body, i) => {
      const swatch = element("span", { class: "swatch", "aria-hidden": "true" }), box = element("input", { type: "checkbox", checked: true });
      box.addEventListener("change", () => {
        if (box.checked) this.viewer.hidden.delete(i);
        else this.viewer.hidden.add(i);
        this.viewer.draw();
      });
      this.swatches.push(swatch);
      return element("li", {}, element("label", {}, box, swatch, element("span", {}, body.name)));
    }));
  }

  showAll() {
    this.viewer.hidden.clear();
    for (const box of byId("parts").querySelectorAll("input")) box.checked = true;
    this.viewer.draw();
  }

  paint(dark) {
    this.viewer.paint(dark);
    this.viewer.bodies.forEach((body, i) => (this.swatches[i].style.background = body.colour));
  }

  fillSection() {
    this.side = 1;
    this.faces = true;  // the viewer, so that no part of what is kept hides the cut; until someone wants the other side
    const again = () => {
      this.faces = true;
      this.applySection();
    };
    byId("section").addEventListener("change", again);
    byId("section-axis").addEventListener("change", again);
    byId("section-at").addEventListener("input", () => this.applySection());
    byId("section-flip").addEventListener("click", () => {
      this.faces = false;
      this.side = -this.side;
      this.applySection();
    });
    this.viewer.controls.addEventListener("change", () => {
      if (byId("section").checked && this.faces && this.facingSide() !== this.side) this.applySection();
    });
    byId("section-axis").value = this.firstAxis();
    byId("explode").addEventListener("input", (event) => {
      this.viewer.explode(Number(event.target.value));
    });
  }

  // Where parts that stand still hide what moves, the page opens on a section.
  openWhatHides() {
    const mostHidden = 0.4;
    if (!this.moves() || !(this.viewer.firstHiddenShare() > mostHidden)) return;
    byId("section").checked = true;
    this.applySection();
  }

  // Across the flattest extent, so that the longest are seen in section.
  firstAxis() {
    const size = this.viewer.box.getSize(new THREE.Vector3());
    return ["x", "y", "z"].reduce((least, axis) => (size[axis] < size[least] ? axis : least));
  }

  sectionNormal() {
    const axis = byId("section-axis").value;
    return axis === "witness" ? this.gapNormal.clone() : new THREE.Vector3(Number(axis === "x"), Number(axis === "y"), Number(axis === "z"));
  }

  // Which half to take away for the cut to face the viewer.
  facingSide() {
    const { camera, controls } = this.viewer;
    return camera.position.clone().sub(controls.target).dot(this.sectionNormal()) < 0 ? -1 : 1;
  }

  applySection() {
    const on = byId("section").checked, axis = byId("section-axis").value;
    byId("section-fields").hidden = !on;
    if (!on) {
      this.viewer.setSection(null);
      return;
    }
    const normal = this.sectionNormal();
    if (this.faces) this.side = this.facingSide();
    const box = this.viewer.box, corners = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => new THREE.Vector3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z).dot(normal));
    const low = Math.min(...corners), high = Math.max(...corners), share = Number(byId("section-at").value);
    // At the middle of its slider the section through a gap goes through the gap.
    const offset = axis === "witness" ? this.gapOffset + (share - 0.5) * 2 * (high - low) : low + share * (high - low);
    this.viewer.setSection(normal.multiplyScalar(this.side), this.side * offset);
  }

  canShow(k) {
    const pair = this.data.pairs[k];
    return !!pair?.point_a && !!pair.point_b && (pair.time !== null || !!pair.poses);
  }

  // When a pair is shown: where it is nearest, of an interference where it is deepest.
  instant(pair) {
    return (isShared(pair) ? pair.depth?.time : null) ?? pair.time ?? this.time;
  }

  // For how long round its instant a chosen pair is marked.
  nearInstant() {
    return Math.max(1e-9, 0.51 * (this.data.step || 0));
  }

  // Its two points, or twice the middle of what both bodies share; and for how long round its instant.
  markOf(pair, near) {
    const shared = isShared(pair), middle = shared ? pair.depth?.point : null;
    const a = new THREE.Vector3(...(middle ?? pair.point_a)), b = new THREE.Vector3(...(middle ?? pair.point_b));
    return { a, b, time: this.instant(pair), near, shared, label: shared ? `${pair.a} \u2013 ${pair.b}: ${depthWords(pair)}` : isTouching(pair) ? `${pair.a} \u2013 ${pair.b}: ${touchWords(pair)}` : withUnit(upperBound(pair.upper), "mm") };
  }

  // Before anything is chosen: the worst pair, whatever hides it.
  markWorst() {
    const slack = (pair) => (isTouching(pair) ? 0 : pair.lower ?? Infinity) - (pair.minimum ?? 0);
    const shown = this.data.pairs.filter((pair, k) => this.canShow(k) && !pair.poses);
    const depth = (pair) => pair.depth?.upper ?? 0, deepest = shown.filter(isShared).sort((x, y) => depth(y) - depth(x))[0];
    const worst = deepest ?? shown.reduce((least, pair) => (least === null || slack(pair) < slack(least) ? pair : least), null);
    if (!worst) return;
    const near = worst.motion ? Math.max(0.51 * (this.data.step || 0), 0.02 * (this.end - this.start)) : this.moves() ? 0.51 * (this.data.step || 0) : Infinity;
    this.viewer.marked = this.markOf(worst, near);
  }

  // Of an exploration: a design by the name of its view; null: it has none.
  showDesign(name, label) {
    byId("canvas").hidden = byId("overlay").hidden = name === null;
    byId("corner-left").hidden = false;
    byId("corner-left").textContent = name === null ? `${label}: its parts are not in this page` : label;
    if (name !== null) this.viewer.showOnly(name);
  }

  // The gap of a pair: its instant or its worst position, a section through it along its normal, seen from near. Of an interference what both
  // bodies share.
  show(k) {
    const pair = this.data.pairs[k], { viewer } = this;
    this.pause();
    if (viewer.mode !== "after" && this.data.views.length > 1) this.setMode("after");
    byId("explode").value = 0;
    viewer.explode(0);
    const marked = this.markOf(pair, this.nearInstant()), { a, b } = marked, middle = a.clone().add(b).multiplyScalar(0.5);
    const along = b.clone().sub(a), gap = along.length();
    along.normalize();
    const home = viewer.homeDirection(), thin = new THREE.Vector3().setComponent("xyz".indexOf(this.firstAxis()), 1);
    if (thin.dot(home) < 0) thin.negate();
    // Across the mechanism's flat side if the gap lies in it, else as near to the usual view as the gap allows.
    const normal = (Math.abs(thin.dot(along)) < 0.3 ? thin : home).clone().addScaledVector(along, -(Math.abs(thin.dot(along)) < 0.3 ? thin : home).dot(along));
    if (normal.lengthSq() < 1e-6) normal.copy(viewer.up).addScaledVector(along, -viewer.up.dot(along));
    this.gapNormal = normal.normalize();
    const radius = viewer.box.getBoundingSphere(new THREE.Sphere()).radius;
    this.gapOffset = middle.dot(normal) + 0.003 * radius;  // nearest points often lie in a face, which is not to be the section's
    this.chosen = k;
    viewer.held = pair.poses ?? null;
    viewer.marked = marked;
    viewer.emphasise([pair.body_a, pair.body_b].every((i) => i >= 0) ? [pair.body_a, pair.body_b] : null);
    for (const i of [pair.body_a, pair.body_b]) viewer.hidden.delete(i);
    [...byId("parts").querySelectorAll("input")].forEach((box, i) => (box.checked = !viewer.hidden.has(i)));
    byId("section-axis").querySelector('[value="witness"]').hidden = false;
    byId("section-axis").value = "witness";
    byId("section").checked = true;
    byId("section-at").value = 0.5;
    this.side = 1;
    this.faces = false;  // it is about to fly there
    this.applySection();
    // Of an interference so much that the two parts are known again.
    const height = marked.shared ? Math.min(2 * radius, Math.max(9 * (pair.depth?.upper ?? 0), 5 * Math.cbrt(pair.volume?.upper ?? 0), 0.35 * radius)) : Math.max(gap * 9, radius * 0.16);
    const tilt = this.gapNormal.clone().addScaledVector(new THREE.Vector3().crossVectors(viewer.up, this.gapNormal), 0.18).addScaledVector(viewer.up, 0.12).normalize();
    viewer.fly(middle, tilt, height / (2 * Math.tan((viewer.camera.fov * Math.PI) / 360)));
    this.seek(marked.time);
    this.highlight();
    const told = marked.shared ? `interference, ${depthWords(pair)}` : isTouching(pair) ? touchWords(pair) : `${withUnit(upperBound(pair.upper), "mm")} apart`;
    announce(`Shown: ${pair.a} and ${pair.b}, ${told} ${pair.poses ? spaced(pair.note ?? "at the start") : `at ${seconds(marked.time, this.data.step)}`}`);
    byId("viewport").scrollIntoView({ block: "nearest" });
  }

  highlight() {
    for (const row of document.querySelectorAll("tr[data-pair], .ticks span")) row.classList.toggle("chosen", Number(row.dataset.pair) === this.chosen);
  }

  // Nothing chosen, everything seen.
  whole() {
    this.chosen = null;
    this.viewer.marked = this.viewer.held = null;
    this.markWorst();
    this.viewer.emphasise(null);
    byId("section-axis").querySelector('[value="witness"]').hidden = true;
    if (byId("section-axis").value === "witness") {
      byId("section-axis").value = this.firstAxis();
      byId("section").checked = false;
      byId("section-at").value = 0.5;
    }
    this.applySection();
    this.highlight();
    this.hand?.show();
    this.viewer.view("home");
  }

  listen() {
    for (const button of document.querySelectorAll("[data-view]"))
      button.addEventListener("click", () => (button.dataset.view === "home" ? this.whole() : this.viewer.view(button.dataset.view)));
    const turn = Math.PI / 24, keys = {
      ArrowLeft: () => this.viewer.turn(turn, 0), ArrowRight: () => this.viewer.turn(-turn, 0), ArrowUp: () => this.viewer.turn(0, -turn), ArrowDown: () => this.viewer.turn(0, turn),
      "+": () => this.viewer.nearer(0.85), "=": () => this.viewer.nearer(0.85), "-": () => this.viewer.nearer(1 / 0.85),
      " ": () => (this.playing ? this.pause() : this.play()), ",": () => this.step(-1), ".": () => this.step(1), Home: () => this.whole(),
    };
    byId("canvas").addEventListener("keydown", (event) => {
      if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      keys[event.key]();
    });
  }
}
