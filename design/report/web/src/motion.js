// SPDX-License-Identifier: MIT
// The picture's controls: time, which design, parts, explosion, section, and the gap of a pair.
import * as THREE from "three";

import { indexAt } from "./data.js";
import { announce, byId, element } from "./dom.js";
import { seconds, spaced, upperBound, withUnit } from "./numbers.js";
import { Viewer } from "./viewer.js";

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
    const all = data.views.map((view) => view.times);
    this.start = Math.min(...all.map((times) => times[0]));
    this.end = Math.max(...all.map((times) => times[times.length - 1]));
    this.times = all[all.length - 1];
    this.time = this.start;
    this.speed = this.firstSpeed();
    this.chosen = null;
    this.fillTransport();
    this.fillCompare();
    this.fillParts();
    this.fillSection();
    this.listen();
    byId("canvas").setAttribute("aria-label", `${data.name}: ${data.views[0].bodies.map((body) => body.name).slice(0, 12).join(", ")}`);
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
    scrub.min = this.start;
    scrub.max = this.end;
    document.querySelector(".transport").hidden = !this.moves();
    byId("speed").append(...speeds.map((s) => element("option", { value: s, selected: s === this.speed }, `${s}\u00d7`)));
    byId("speed").addEventListener("change", (event) => (this.speed = Number(event.target.value)));
    scrub.addEventListener("input", () => {
      this.pause();
      this.seek(Number(scrub.value));
    });
    byId("play").addEventListener("click", () => (this.playing ? this.pause() : this.play()));
    const marks = this.data.pairs.map((pair, k) => ({ pair, k })).filter(({ pair, k }) => pair.motion && this.canShow(k));
    byId("ticks").append(...marks.map(({ pair, k }) => {
      const mark = element("span", { "data-pair": k });
      mark.style.left = `${(100 * (pair.time - this.start)) / (this.end - this.start || 1)}%`;
      return mark;
    }));
  }

  play() {
    if (!this.moves()) return;
    if (this.time >= this.end) this.seek(this.start);
    this.playing = true;
    this.setPlayButton();
    announce("Playing");
    let last = null, between = 0, frames = 0;
    const frame = (now) => {
      if (!this.playing) return;
      if (last !== null) {
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
    if (this.data.views.length < 2) return;
    const choices = ["after", "before", "side", "fade"];
    byId("compare").hidden = false;
    byId("compare").append(...choices.map((mode) => element("label", {},
      element("input", { type: "radio", name: "compare", value: mode, checked: mode === "after", onchange: () => this.setMode(mode) }), element("span", {}, names[mode]))));
    byId("fade").addEventListener("input", (event) => {
      this.viewer.share = Number(event.target.value);
      this.viewer.draw();
    });
  }

  setMode(mode) {
    this.viewer.mode = mode;
    for (const input of byId("compare").querySelectorAll("input")) input.checked = input.value === mode;
    byId("fade-field").hidden = mode !== "fade";
    byId("corner-left").hidden = byId("corner-right").hidden = mode !== "side";
    byId("corner-left").textContent = "before";
    byId("corner-right").textContent = "after";
    announce(`Shown: ${names[mode]}`);
    this.viewer.draw();
  }

  fillParts() {
    this.swatches = [];
    byId("parts").append(...this.data.views[0].bodies.map((body, i) => {
      const swatch = element("span", { class: "swatch", "aria-hidden": "true" }), box = element("input", { type: "checkbox", checked: true });
      box.addEventListener("change", () => {
        if (box.checked) this.viewer.hidden.delete(i);
        else this.viewer.hidden.add(i);
        this.viewer.draw();
      });
      this.swatches.push(swatch);
      return element("li", {}, element("label", {}, box, swatch, element("span", {}, body.name)));
    }));
    byId("parts-all").addEventListener("click", () => {
      this.viewer.hidden.clear();
      for (const box of byId("parts").querySelectorAll("input")) box.checked = true;
      this.viewer.draw();
    });
  }

  paint(dark) {
    this.viewer.paint(dark);
    this.viewer.colours.forEach((colour, i) => (this.swatches[i].style.background = colour));
  }

  fillSection() {
    this.side = 1;
    byId("section").addEventListener("change", () => this.applySection());
    byId("section-axis").addEventListener("change", () => this.applySection());
    byId("section-at").addEventListener("input", () => this.applySection());
    byId("section-flip").addEventListener("click", () => {
      this.side = -this.side;
      this.applySection();
    });
    byId("section-axis").value = this.firstAxis();
    byId("explode").addEventListener("input", (event) => {
      this.viewer.exploded = Number(event.target.value);
      this.viewer.draw();
    });
  }

  // Across the flattest extent, so that the longest are seen in section.
  firstAxis() {
    const size = this.viewer.box.getSize(new THREE.Vector3());
    return ["x", "y", "z"].reduce((least, axis) => (size[axis] < size[least] ? axis : least));
  }

  applySection() {
    const on = byId("section").checked, axis = byId("section-axis").value;
    byId("section-fields").hidden = !on;
    if (!on) {
      this.viewer.setSection(null);
      return;
    }
    const normal = axis === "witness" ? this.gapNormal.clone() : new THREE.Vector3(Number(axis === "x"), Number(axis === "y"), Number(axis === "z"));
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

  // The gap of a pair: its instant or its worst position, a section through it along its normal, seen from near.
  show(k) {
    const pair = this.data.pairs[k], { viewer } = this;
    this.pause();
    if (viewer.mode !== "after" && this.data.views.length > 1) this.setMode("after");
    byId("explode").value = viewer.exploded = 0;
    const a = new THREE.Vector3(...pair.point_a), b = new THREE.Vector3(...pair.point_b), middle = a.clone().add(b).multiplyScalar(0.5);
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
    const near = Math.max(1e-9, 0.51 * (this.data.step || 0));
    const time = pair.time ?? this.time;
    viewer.held = pair.poses ?? null;
    viewer.marked = { a, b, time, near, label: `${withUnit(upperBound(pair.upper), "mm")}` };
    viewer.emphasise([pair.body_a, pair.body_b].every((i) => i >= 0) ? [pair.body_a, pair.body_b] : null);
    for (const i of [pair.body_a, pair.body_b]) viewer.hidden.delete(i);
    [...byId("parts").querySelectorAll("input")].forEach((box, i) => (box.checked = !viewer.hidden.has(i)));
    byId("section-axis").querySelector('[value="witness"]').hidden = false;
    byId("section-axis").value = "witness";
    byId("section").checked = true;
    byId("section-at").value = 0.5;
    this.side = 1;
    this.applySection();
    const height = Math.max(gap * 9, radius * 0.16);
    const tilt = this.gapNormal.clone().addScaledVector(new THREE.Vector3().crossVectors(viewer.up, this.gapNormal), 0.18).addScaledVector(viewer.up, 0.12).normalize();
    viewer.fly(middle, tilt, height / (2 * Math.tan((viewer.camera.fov * Math.PI) / 360)));
    this.seek(time);
    this.highlight();
    announce(`Shown: ${pair.a} and ${pair.b}, ${withUnit(upperBound(pair.upper), "mm")} apart ${pair.poses ? spaced(pair.note ?? "at the start") : `at ${seconds(time, this.data.step)}`}`);
    byId("viewport").scrollIntoView({ block: "nearest" });
  }

  highlight() {
    for (const row of document.querySelectorAll("tr[data-pair], .ticks span")) row.classList.toggle("chosen", Number(row.dataset.pair) === this.chosen);
  }

  // Nothing chosen, everything seen.
  whole() {
    this.chosen = null;
    this.viewer.marked = this.viewer.held = null;
    this.viewer.emphasise(null);
    byId("section-axis").querySelector('[value="witness"]').hidden = true;
    if (byId("section-axis").value === "witness") {
      byId("section-axis").value = this.firstAxis();
      byId("section").checked = false;
      byId("section-at").value = 0.5;
    }
    this.applySection();
    this.highlight();
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
