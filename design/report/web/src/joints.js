// SPDX-License-Identifier: MIT
// The mechanism moved by hand: a slider of each joint, where the program says that all bodies are then and how far apart, and a stop where
// parts meet. One question at a time; the last values are always asked for. What an earlier value answered is shown grey.
import { decoded } from "./data.js";
import { Dragging } from "./dragging.js";
import { announce, element } from "./dom.js";
import { lowerBound, number, upperBound, withUnit } from "./numbers.js";
import { Slider } from "./sliders.js";
import { depthWords, isShared } from "./words.js";

const mostTold = 5, noGap = 1e-6;  // mm
const mostHalvings = 6, patience = 2000;  // ms for all of them: a clash may take long to be told
const byHand = "Moved by hand: not simulated, forces are not known.";

const nameOf = (pair) => `${pair.a} \u2013 ${pair.b}`;
const between = (from, to, share) => Object.fromEntries(Object.keys(to).map((name) => [name, from[name] + share * (to[name] - from[name])]));
const isSame = (x, y) => Object.keys(x).every((name) => x[name] === y[name]);
const clashes = ({ pairs }) => pairs.filter(isShared);

function distanceWords(pair) {
  if (isShared(pair)) return depthWords(pair);
  if (pair.lower > noGap) return `at least ${withUnit(lowerBound(pair.lower, 3), "mm")}`;
  return pair.upper === null ? "not known" : pair.upper > noGap ? `at most ${withUnit(upperBound(pair.upper, 3), "mm")}` : "no gap found";
}

export class Joints {
  // call(body) -> promise of the answer; motion(): the moving picture or null; onChange(): something else is shown, or is old now.
  constructor({ call, motion, onChange }) {
    Object.assign(this, { call, motion, onChange, joints: [], sliders: [], epoch: 0, turn: Promise.resolve(), fault: "" });
    this.wanted = null;  // {values, jumps: whatever lies between}; null: the motion is shown
    this.known = null;  // the pose that is shown: {values, answer, of: what was wanted, if it is that}
    this.stopped = null;  // {pair, beyond: values where it clashes}
    this.hand = { leave: () => this.leave(), show: () => this.draw() };
    const button = (text, onclick) => element("button", { type: "button", onclick }, text);
    this.list = element("ul", { class: "parameters" });
    this.stop = element("input", { type: "checkbox", checked: true });
    this.back = button("Back to the motion", () => this.leave());
    this.back.setAttribute("aria-keyshortcuts", "Escape");
    this.back.hidden = true;
    this.line = element("p", { class: "told", role: "status" });
    this.rows = element("tbody");
    this.table = element("table", { class: "nearest", hidden: true }, element("caption", {}, "The nearest pairs, proven in this position"), this.rows);
    this.root = element("fieldset", { id: "joints", hidden: true }, element("legend", {}, "Joints"), this.list,
      element("div", { class: "actions" }, element("label", { class: "field" }, this.stop, "Stop at contact"), button("Reset", () => this.move(this.starts, true)), this.back), this.line, this.table);
  }

  get isPosed() {
    return this.wanted !== null;
  }

  get isOld() {
    return this.isPosed && this.known?.of !== this.wanted;
  }

  get starts() {
    return Object.fromEntries(this.joints.map(({ name, start }) => [name, start]));
  }

  get values() {
    return this.wanted?.values ?? this.starts;
  }

  // The joint by which a body is moved: of those that move it the one with the fewest others.
  of(body) {
    return this.joints.filter(({ moves }) => moves.includes(body)).sort((x, y) => x.moves.length - y.moves.length)[0] ?? null;
  }

  // The joints of parts that are shown now; `known`: are they those that the program can be asked about? What was posed is asked for again.
  take(joints, known) {
    const { motion } = this, before = this.values, text = JSON.stringify(joints);
    if (motion()) motion().hand = this.hand;
    if (motion()) this.dragging ??= new Dragging(motion().viewer, this);
    if (text !== this.text) this.make(joints);
    this.text = text;
    ++this.epoch;
    this.isKnown = known;
    const last = this.known?.answer.poses, values = Object.fromEntries(this.joints.map(({ name, start, low, high }) => [name, Math.min(high, Math.max(low, before[name] ?? start))]));
    this.known = this.stopped = this.failed = null;
    if (this.isPosed && !joints.length) return this.leave();
    this.base = this.isPosed ? values : this.starts;
    if (!this.isPosed) return;
    if (last?.length === 7 * motion()?.viewer.bodies.length) motion().viewer.pose(last);
    this.move(values);
  }

  make(joints) {
    this.joints = joints.map((joint) => ({ ...joint, start: Number(joint.start.toFixed(9)) }));
    this.sliders = this.joints.map(({ name, unit, low, high, start, has_limits: hasLimits }, k) => {
      const made = new Slider({ name, unit, lower: low, upper: high, value: start }, `joint-${k}`, (_, value) => this.move({ [name]: value }), { short: "start", long: "the start\u2019s" });
      made.show(start);
      made.effect.textContent = `${hasLimits ? "limits" : "no limits; shown"}: ${number(low, 4)} to ${withUnit(number(high, 4), unit)}`;
      return made;
    });
    this.list.replaceChildren(...this.sliders.map((slider) => slider.root));
    this.root.hidden = !joints.length;
  }

  move(changes, jumps = false) {
    if (!this.isPosed) this.motion()?.pause();
    this.moved = Object.keys(changes).length === 1 ? Object.keys(changes)[0] : null;
    this.setWanted({ values: { ...this.values, ...changes }, jumps });
    this.run();
  }

  setWanted(wanted) {
    this.wanted = wanted;
    for (const slider of this.sliders) if (slider.value !== this.values[slider.parameter.name]) slider.show(this.values[slider.parameter.name]);
    this.tell();
  }

  // Back to the motion.
  leave() {
    if (!this.isPosed) return;
    this.known = this.stopped = this.failed = this.chosen = null;
    ++this.epoch;
    this.setWanted(null);
    this.base = this.starts;
    const motion = this.motion(), pair = motion?.data.pairs[motion.chosen];
    motion?.viewer.pose(null);
    motion?.setPairs();
    motion?.viewer.emphasise(pair ? [pair.body_a, pair.body_b] : null);
  }

  async run() {
    if (this.runs) return;
    this.runs = true;
    while (this.isKnown && this.isOld && this.failed !== this.wanted) {
      const { wanted } = this;
      await this.go(wanted).catch((error) => {
        this.failed = wanted;
        this.fault = error.message;
      });
    }
    this.runs = false;
    this.tell();
  }

  // The program's answer for these values; `depth`: how deep are clashes, too, which takes longer? null: it is of what is not shown any more.
  asked(values, depth) {
    const { epoch } = this, isWanted = () => epoch === this.epoch;
    const answer = this.turn.then(() => (isWanted() ? this.call({ do: "pose", joints: values, depth }) : null));
    this.turn = answer.catch(() => {});
    return answer.then((told) => {
      if (!isWanted()) return null;
      if (told.poses && decoded(told).poses.length !== 7 * (this.motion()?.viewer.bodies.length ?? told.poses.length / 7)) throw new Error("Other parts are on their way.");
      return told;
    });
  }

  // On towards what is wanted; where parts are to stop each other, in steps, each from a pose where nothing has met.
  async go(wanted) {
    const stops = this.stop.checked && !wanted.jumps, from = this.known;
    if (stops && from && this.isBehindStop(wanted.values)) return this.settle();
    const next = !from ? this.base : stops ? this.stepTo(from.values, wanted.values) : wanted.values, answer = await this.asked(next, false);
    if (!answer) return;
    if (!from) this.touching = answer.pairs.filter(({ upper }) => upper !== null && upper <= noGap).map(nameOf);
    if (stops && from && this.met(answer)) return this.halve(wanted, next, answer);
    const isThere = () => this.wanted === wanted && isSame(next, wanted.values);
    const lacks = isThere() && clashes(answer).some(({ depth }) => !depth);
    this.show(next, answer, isThere() && !lacks ? wanted : null);
    const deep = lacks ? await this.asked(next, true) : null;
    if (deep && isThere()) this.show(next, deep, wanted);
  }

  // By no more than a step of any joint's slider.
  stepTo(from, to) {
    const share = Math.min(...this.sliders.map(({ step, parameter: { name } }) => step / Math.abs(to[name] - from[name])));
    return share >= 1 ? to : between(from, to, share);
  }

  // A pair that clashes, and does not in the pose that is shown. Parts that touch from the start, as at a joint, do not stop each other.
  met(answer) {
    const there = [...clashes(this.known.answer).map(nameOf), ...this.touching];
    return clashes(answer).find((pair) => !there.includes(nameOf(pair)));
  }

  // Between the pose that is shown and one where more has met.
  async halve(wanted, beyond, answer) {
    const began = performance.now();
    for (let k = 0; k < mostHalvings && this.wanted === wanted && performance.now() - began < patience; ++k) {
      const middle = between(this.known.values, beyond, 0.5), there = await this.asked(middle, false);
      if (!there) return;
      if (this.met(there)) [beyond, answer] = [middle, there];
      else this.show(middle, there, null);
    }
    if (this.wanted !== wanted) return;
    const name = nameOf(this.met(answer));
    this.stopped = { pair: this.known.answer.pairs.find((pair) => nameOf(pair) === name), beyond };
    this.settle();
    announce(`Stopped before ${name} meet`);
  }

  isBehindStop(values) {
    if (!this.stopped) return false;
    const { values: at } = this.known, { beyond } = this.stopped, names = Object.keys(at), moved = names.filter((name) => beyond[name] !== at[name]);
    return moved.length === 1 && names.every((name) => (name === moved[0] ? (values[name] - at[name]) * (beyond[name] - at[name]) > 0 : values[name] === at[name]));
  }

  // What is shown is as far as it goes.
  settle() {
    this.setWanted(this.known.of = { values: this.known.values });
    this.draw();
  }

  show(values, answer, of) {
    this.known = { values, answer, of };
    this.stopped = null;
    this.fault = "";
    this.draw();
    this.tell();
  }

  // The pair whose distance is drawn: which stopped it, was chosen, clashes, or is the nearest that changes with the joint.
  get told() {
    if (!this.known) return null;
    const near = this.nearest, moves = this.joints.find(({ name }) => name === this.moved)?.moves ?? [], open = near.filter(({ upper }) => upper > noGap);
    return this.stopped?.pair ?? near.find((pair) => nameOf(pair) === this.chosen) ?? near.find(isShared) ?? open.find(({ a, b }) => moves.includes(a) !== moves.includes(b)) ?? open[0] ?? null;
  }

  get nearest() {
    return this.known.answer.pairs.slice(0, mostTold);
  }

  draw() {
    const motion = this.motion(), { told } = this;
    if (!motion || !this.known) return;
    const { viewer } = motion, { poses, pairs } = this.known.answer, mark = told && { ...motion.markOf(told, Infinity), within: true };
    if (this.stopped && mark) {
      mark.a = mark.b = mark.a.clone().add(mark.b).multiplyScalar(0.5);
      Object.assign(mark, { shared: true, label: `${nameOf(told)}: stopped` });
    }
    viewer.setPairs({ pairs });
    viewer.marked = mark;
    viewer.emphasise(mark?.shared ? [told.body_a, told.body_b] : null);
    viewer.pose(poses);
  }

  tell() {
    const { isPosed, isOld, known, stopped, told } = this, failed = this.failed !== null && this.failed === this.wanted;
    const stop = stopped ? ` Stopped before ${nameOf(stopped.pair)} meet.` : "";
    this.line.textContent = !isPosed ? "" : failed ? this.fault : !this.isKnown ? "These parts are not simulated yet." : `${byHand}${stop}`;
    this.line.classList.toggle("error", failed);
    this.back.hidden = !isPosed;
    this.table.hidden = !isPosed || !this.rows.children.length;
    this.table.classList.toggle("stale", isOld);
    document.querySelector(".transport").classList.toggle("posed", isPosed);
    if (!isPosed) this.rows.replaceChildren();
    else if (known) this.fill(told);
    this.onChange();
  }

  fill(told) {
    const focused = this.rows.contains(document.activeElement) ? document.activeElement.textContent : null;
    this.rows.replaceChildren(...this.nearest.map((pair) => {
      const isBad = isShared(pair) || pair === this.stopped?.pair, choose = () => ((this.chosen = nameOf(pair)), this.draw(), this.tell());
      return element("tr", { class: pair === told ? "chosen" : null }, element("td", {}, element("button", { type: "button", class: "row-button", onclick: choose }, nameOf(pair))), element("td", { class: `num${isBad ? " bad" : ""}` }, distanceWords(pair)));
    }));
    if (focused !== null) [...this.rows.querySelectorAll("button")].find((each) => each.textContent === focused)?.focus({ preventScroll: true });
  }
}
