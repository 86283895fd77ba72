// SPDX-License-Identifier: MIT
// The page of the studio: what the program tells while values change, each result with the values that it is of.
import { Actions, showFaults } from "./actions.js";
import { Calls } from "./calls.js";
import { Connection, firstOpened } from "./connection.js";
import { decoded } from "./data.js";
import { byId, element } from "./dom.js";
import { judged } from "./effects.js";
import { Joints } from "./joints.js";
import { LivePairs } from "./live_pairs.js";
import { LiveRequirements } from "./live_requirements.js";
import { lowerBound, number, plural, withUnit } from "./numbers.js";
import { Revisions } from "./revisions.js";
import { Sliders } from "./sliders.js";
import { factList } from "./tables.js";
import { capital, isShared } from "./words.js";

const links = { connected: "connected", waiting: "connecting again \u2026", ended: "the program has ended" };

// What is opened, but for the values that are set.
const lasting = ({ revision, values, can_undo, can_redo, saved, ...rest }) => JSON.stringify(rest);

export const startStudio = (data, section, picture) => new Studio(data, section, picture);

class Studio {
  // `picture`: motion(): the moving picture or null; start(): makes it.
  constructor(data, section, picture) {
    Object.assign(this, { data, section, picture });
    this.opened = lasting(firstOpened());
    this.isWriter = true;
    this.calls = new Calls((body) => this.ask(body), () => this.tellState());
    this.revisions = new Revisions(() => this.calls.waits, () => this.tellState());
    this.joints = new Joints({ call: (body) => this.connection.call(body), motion: () => this.picture.motion(), onChange: () => this.tellState() });
    this.makeFrame();
    this.build();
    this.joints.take(data.joints ?? [], false);
    document.addEventListener("keydown", (event) => this.actions.press(event, () => this.mayChange));
    document.addEventListener("keydown", (event) => event.key === "Escape" && this.joints.leave());
    this.connection = new Connection((name, told) => this.hear(name, told), (link) => this.setLink(link));
    this.setLink("waiting");
  }

  // What is shown is old as soon as the program has taken other values, whatever it tells when.
  async ask(body) {
    const answer = await this.connection.call(body);
    if (answer.revision !== undefined) this.revisions.ask(answer.revision);
    return answer;
  }

  get mayChange() {
    return this.isWriter && this.link === "connected";
  }

  // What stays when the files are written to.
  makeFrame() {
    document.documentElement.classList.add("studio");
    byId("main").prepend(element("div", { id: "faults", role: "alert", hidden: true }));
    this.linkLine = element("span", { id: "link", role: "status" });
    document.querySelector(".topbar-tools").prepend(this.linkLine);
    this.state = element("span", { role: "status", id: "state" });
    this.progress = element("progress", { max: 1, "aria-label": "How far it is" });
    this.reason = element("p", { id: "refused", class: "told error", role: "alert", hidden: true });
    this.writing = element("div", { id: "writing", hidden: true }, element("p", {}, "Another window changes this design."), element("button", { type: "button", onclick: () => this.actions.do({ do: "write" }, (body) => this.connection.call(body)) }, "Take over"));
    this.panel = element("fieldset", { id: "panel" }, element("legend", { class: "visually-hidden" }, "Parameters"));
    byId("reached").after(element("p", { class: "state" }, this.state, this.progress), this.reason);
    byId("verdict").append(this.writing, this.panel);
  }

  // All that is made of what the files say.
  build() {
    const { data, revisions } = this;
    revisions.start(data.revision);
    revisions.known.set("start", data.revision);  // the parts as assembled, which are shown until their motion comes
    this.isAtStart = true;
    this.gradient = [];
    this.startObjective = null;
    this.pairs?.clear();
    byId("sections").replaceChildren();
    const show = (k) => revisions.isCurrent("pairs") && this.picture.motion()?.show(k);
    this.openable = [];
    show.can = (k) => !!this.openable[k];
    this.sliders = new Sliders(data.parameters, (name, value) => this.set(name, value));
    this.sliders.show(data.values);
    this.actions = new Actions({ call: (body) => this.calls.push(body), now: (body) => this.connection.call(body), values: () => this.sliders.values, parameters: data.parameters, command: data.command, wants: data.requirements.length + data.objective.length > 0 });
    this.panel.replaceChildren(this.panel.firstElementChild, this.actions.bar, this.sliders.root, this.actions.tuning, this.actions.files);
    byId("told")?.remove();
    this.panel.after(this.joints.root, element("div", { id: "told" }, this.actions.told, this.actions.commandLine));
    this.actions.history(data);
    this.pairs = new LivePairs(show, (t) => this.picture.motion()?.seek(t));
    this.requirements = data.requirements.length || data.objective.length ? new LiveRequirements(data, show, () => this.tellEffects(), (row, value, controls) => this.pull(row, value, controls)) : null;
    this.regions = [{ kind: "numbers", element: byId("reached") }, { kind: "numbers", element: byId("facts") }, { kind: "picture", element: byId("viewport") }, { kind: "gradient", element: this.sliders.root }];
    if (this.requirements) this.region("numbers", "Requirements", "The chosen row is told beside the sliders. Pull a number to another value, and the parameters follow by the least change that brings it there.", this.requirements.root);
    this.region("pairs", "Clearances", "Proven over the whole motion. A row shows its narrowest gap in the picture.", this.pairs.tables, this.pairs.margins.root);
    this.quantities = this.region("pairs", "Quantities", "What the design names, wants and requires at each step of the motion.", this.pairs.quantities.root);
    this.quantities.hidden = true;
    this.hold();
    this.tellState();
  }

  // A section whose results are of one kind, with a word where they are not of the values that are set.
  region(kind, title, intro, ...children) {
    const made = this.section(title, intro, ...children), word = element("span", { class: "stale-word" });
    made.querySelector("h2").append(word);
    this.regions.push({ kind, element: made, word });
    return made;
  }

  hear(name, told) {
    const hearers = {
      opened: () => this.hearOpened(told),
      fault: () => showFaults(told.errors),
      asked: () => this.hearAsked(told),
      progress: () => this.revisions.ask(told.revision) && ((this.revisions.progress = told), this.tellState()),
      refused: () => this.revisions.refuse(told.revision, told.reason),
      motion: () => this.revisions.takes("motion", told.revision) && this.hearMotion(decoded(told)),
      numbers: () => this.revisions.takes("numbers", told.revision) && this.hearNumbers(told),
      gradient: () => this.revisions.takes("gradient", told.revision) && this.hearGradient(told),
      pairs: () => this.revisions.takes("pairs", told.revision) && this.hearPairs(decoded(told)),
      settled: () => this.revisions.settle(told.revision, told.seconds),
      tune: () => this.actions.hearTuning(told),
      writer: () => this.hearWriter(told),
    };
    hearers[name]();
  }

  // The same again, as after the connection was lost, changes nothing.
  hearOpened(told) {
    const text = lasting(told);
    if (text === this.opened) return;
    this.opened = text;
    Object.assign(this.data, decoded(told));
    byId("name").textContent = this.data.name;
    byId("asked").textContent = this.data.description ?? "";
    byId("notices").replaceChildren(...this.data.notices.map((notice) => element("li", {}, notice)));
    this.build();
    this.showMotion();
    this.joints.take(this.data.joints ?? [], false);
  }

  hearAsked({ revision, values, ...history }) {
    if (!this.revisions.ask(revision)) return;
    if (revision !== this.pulled) this.requirements?.forgetPull();
    this.sliders.show(values, (name) => this.calls.sets(name));
    if (this.isAtStart && JSON.stringify(values) === JSON.stringify(this.data.values)) this.revisions.takes("start", revision);
    this.data.values = values;
    this.saved = history.saved;
    this.actions.history(history);
  }

  hearMotion({ motion, steps, step, duration, meshes, views, joints }) {
    this.isAtStart = false;
    Object.assign(this.data, { motion, steps, step, duration, meshes, views, pairs: [] });  // gaps of another motion are not of this one
    this.showMotion();
    this.joints.take(joints ?? [], true);
    this.tellState();
  }

  showMotion() {
    const motion = this.picture.motion();
    if (!this.data.views.length) return;
    if (!motion) return this.picture.start();
    motion.replace();
    motion.fillTicks();
  }

  hearNumbers({ requirements, objective, met, message, why, notices }) {
    this.data.requirements = requirements;
    if (this.saved && objective.value !== null) this.startObjective = objective.value;
    const start = objective.start ?? this.startObjective, missed = requirements.filter((r) => !r.met && (r.lower !== null || r.upper !== null || r.fault)).map((r) => r.name);
    this.requirements?.update({ value: objective.value, start });
    const head = capital((message || (!requirements.length ? "computed; nothing is required" : met ? "every requirement is met" : `not met: ${missed.join(", ")}`)).replace(/\.?$/, "."));
    const rest = missed.length && !missed.every((name) => head.includes(name)) ? ` Not met: ${missed.join(", ")}.` : "";
    byId("reached").replaceChildren(element("strong", { class: `verdict-${met ? "good" : "bad"}` }, head), `${rest}${why ? ` ${why}` : ""}`);
    const { unit } = this.requirements?.objective ?? {}, facts = [];
    if (this.requirements?.objective) facts.push(["Objective", withUnit(number(objective.value), unit), typeof start === "number" ? `${withUnit(number(start), unit)} with the file\u2019s values` : "minimised"]);
    if (requirements.length) facts.push(["Requirements met", `${requirements.filter((r) => r.met).length} of ${requirements.length}`, ""]);
    byId("facts").replaceChildren(...factList(facts));
    byId("notices").replaceChildren(...[...this.data.notices, ...(notices ?? [])].map((notice) => element("li", {}, notice)));
    this.wanted?.(requirements, objective);
    this.tellEffects();
  }

  hearGradient({ rows }) {
    this.gradient = rows;
    this.tellEffects();
  }

  hearPairs({ pairs, pair_count, margins, requirements, scenarios }) {
    Object.assign(this.data, { pairs, pair_count, margins, scenarios: scenarios ?? [], requirements: requirements ?? this.data.requirements });
    this.picture.motion()?.setPairs();
    this.openable = pairs.map((_, k) => !!this.picture.motion()?.canShow(k));
    this.requirements?.update(null);
    this.pairs.show(this.data);
    this.quantities.hidden = !this.pairs.quantities.plots.length;
    const least = Math.min(...pairs.filter((pair) => !isShared(pair)).map((pair) => pair.lower ?? Infinity));
    if (Number.isFinite(least)) {
      for (const old of byId("facts").querySelectorAll(".least")) old.remove();
      byId("facts").append(...factList([["Least clearance", `\u2265\u00a0${withUnit(lowerBound(least, 4), "mm")}`, "proven", "least"]]));
    }
    this.tellEffects();
  }

  hearWriter({ writer, others }) {
    this.isWriter = writer;
    this.writing.hidden = writer;
    this.writing.firstElementChild.textContent = `Another window changes this design${others > 1 ? ` (${plural(others, "other window")})` : ""}: here it can be looked at.`;
    this.hold();
  }

  setLink(link) {
    this.link = link;
    this.linkLine.textContent = links[link];
    this.linkLine.className = link;
    this.hold();
    this.tellState();
  }

  // A connection that is looked for again does not take a slider out of someone's hand.
  hold() {
    const held = !this.isWriter || this.link === "ended";
    this.panel.disabled = held;
    this.requirements?.hold(held);
    this.joints.root.disabled = this.link === "ended";
  }

  async set(name, value) {
    this.wanted = null;
    const asked = this.actions.do({ do: "set", values: { [name]: value } });
    this.tellState();
    if (!(await asked)) this.sliders.show(this.data.values, (each) => this.calls.sets(each));
  }

  // Brings a number to a value, and tells what was predicted and what came of it.
  async pull(row, value, controls) {
    const said = (x) => withUnit(number(x), row.unit);
    this.wanted = null;
    controls.told.textContent = `${said(value)} is looked for \u2026`;
    const answer = await this.actions.do({ do: "pull", requirement: row.isObjective ? "objective" : row.name, value });
    if (!answer) {
      controls.told.textContent = this.actions.told.textContent;
      this.requirements.update(null);
      return this.tellEffects();
    }
    this.pulled = answer.revision;
    const predicted = answer.reached ? `Predicted: ${said(answer.predicted)}` : `The bounds allow ${said(answer.predicted)}, as predicted`;
    controls.told.textContent = `${predicted}; simulating \u2026`;
    this.sliders.show(answer.values ?? {}, (name) => this.calls.sets(name));
    this.wanted = (requirements, objective) => {
      if (this.revisions.asked !== answer.revision) return;
      const now = row.isObjective ? { isObjective: true, lower: objective.value, upper: objective.value } : requirements.find((r) => r.name === row.name);
      controls.told.textContent = `${predicted}. Simulated: ${said(judged(now))}.`;
    };
    if (this.revisions.known.get("numbers") === answer.revision) this.wanted(this.data.requirements, this.requirements.objective ?? {});
  }

  slopesOf(row) {
    const isOf = (each) => (row.isObjective ? each.of === "objective" : each.of === "requirement" && each.name === row.name);
    return this.gradient.find(isOf)?.by ?? null;
  }

  tellEffects() {
    const row = this.requirements?.chosenRow ?? null;
    this.sliders.tell(row, row && this.slopesOf(row));
    this.requirements?.reach(this.data.parameters, this.sliders.values, (each) => this.slopesOf(each));
  }

  // What is current, what is not, and how far the rest is.
  tellState() {
    const { revisions } = this, isOld = (kind) => !(kind === "picture" ? revisions.isCurrent("motion") || revisions.isCurrent("start") : revisions.isCurrent(kind));
    for (const { kind, element: part, word } of this.regions ?? []) {
      part.classList.toggle("stale", isOld(kind));
      if (word) word.textContent = isOld(kind) ? this.word : "";
    }
    const { isPosed } = this.joints, corner = [...(isPosed ? ["moved by hand"] : []), ...(isOld("motion") ? [isOld("picture") ? "earlier values" : "as assembled", ...(this.waits ? [this.word] : [])] : [])];
    byId("corner-left").hidden = !corner.length;
    byId("corner-left").textContent = corner.join("; ");
    byId("overlay").classList.toggle("stale", isPosed ? this.joints.isOld || isOld("motion") : isOld("pairs"));
    const { waits } = this;
    this.state.textContent = this.link === "ended" ? "What is shown is the last that the program told." : revisions.refused !== null ? "Not possible at these values."
      : waits ? (isOld("numbers") ? "Computing \u2026" : "Computed; derivatives and proofs follow \u2026") : `Up to date${revisions.seconds === null ? "" : ` in ${number(revisions.seconds, 2)}\u00a0s`}.`;
    this.progress.hidden = !waits;
    if (revisions.share === null) this.progress.removeAttribute("value");
    else this.progress.value = revisions.share;
    this.reason.hidden = revisions.refused === null;
    this.reason.textContent = revisions.refused ?? "";
  }

  // Is something still to come?
  get waits() {
    return !this.revisions.isCurrent("all") && (this.revisions.refused === null || this.calls.waits) && this.link !== "ended";
  }

  get word() {
    return this.link === "ended" ? "of other values" : this.revisions.word;
  }
}
