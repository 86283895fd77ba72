// SPDX-License-Identifier: MIT
// The requirements and the objective while they change: one of them is chosen, whose derivatives are told, and each can be set to a value.
import { element } from "./dom.js";
import { judged, lack, reachOf, stepOf } from "./effects.js";
import { number, raised, withUnit } from "./numbers.js";
import { cell, requirementTable } from "./tables.js";

// What a row has beside its numbers, and keeps while these change: whether it is chosen, and what its number is to become.
class Controls {
  constructor(row, onChoose, onWant) {
    const said = row.unit ? `${row.name} in ${row.unit}` : row.name;
    this.row = row;
    this.onWant = onWant;
    this.radio = element("input", { type: "radio", name: "chosen-number", "aria-label": `Tell beside the sliders: ${row.name}`, onchange: onChoose });
    this.field = element("input", { type: "number", step: "any", "aria-label": `${said}: wanted`, onchange: () => this.want(Number(this.field.value), this.field.value !== "") });
    this.handle = element("input", { type: "range", step: "any", "aria-label": `${said}: pull to`, oninput: () => (this.field.value = Number(Number(this.handle.value).toPrecision(4))), onchange: () => this.want(Number(this.handle.value)) });
    this.told = element("small", { "aria-live": "polite" });
    this.first = element("td", { class: "choose" }, element("label", {}, this.radio, element("span", { "aria-hidden": "true" }, "tell beside the sliders")));
    const unit = row.unit ? element("span", { class: "unit" }, raised(row.unit)) : null;
    this.last = element("td", { class: "wanted", "data-label": "Pull to" }, element("span", { class: "pull" }, element("span", { class: "amount" }, this.field, unit), this.handle), this.told);
  }

  want(x, isThere = true) {
    if (isThere && Number.isFinite(x) && x !== this.value) this.onWant(x);
    else this.show(this.value, this.reach);
  }

  // The value as it is, and from where to where it can be pulled; null: not known.
  show(value, reach) {
    this.value = value;
    this.reach = reach;
    const [low, high] = reach ?? [0, 0], known = value !== null && Number.isFinite(low) && high > low;
    this.field.step = value ? stepOf({ lower: 0, upper: value }) : "any";
    this.handle.disabled = !known || this.isHeld;
    this.field.disabled = value === null || this.isHeld;
    if (known) Object.assign(this.handle, { min: low, max: high, value });
    this.handle.setAttribute("aria-valuetext", withUnit(number(value), this.row.unit));
    if (document.activeElement !== this.field || Number(this.field.value) !== value) this.field.value = value === null ? "" : Number(value.toPrecision(5));
  }

  hold(isHeld) {
    this.isHeld = isHeld;
    this.show(this.value ?? null, this.reach ?? null);
  }
}

export class LiveRequirements {
  // show(pair): its gap in the picture. onChoose(): another row's derivatives are to be told. onWant(row, value): a number is pulled.
  constructor(data, show, onChoose, onWant) {
    this.data = data;
    this.show = show;
    this.objective = data.objective.length ? { isObjective: true, name: data.objective.length === 1 ? data.objective[0].name : "objective", unit: unitOf(data.objective), lower: null, upper: null } : null;
    this.chosen = null;
    this.controls = this.rows().map((row, k) => new Controls(row, () => this.choose(k, onChoose), (value) => onWant(this.rows()[k], value, this.controls[k])));
    this.root = this.table();
    const body = this.root.querySelector("tbody");
    this.lines = [...body.rows];
    this.lines.forEach((line, k) => {
      line.prepend(this.controls[k].first);
      line.append(this.controls[k].last);
    });
    const head = this.root.querySelector("thead tr"), heading = (text, hides) => element("th", { scope: "col" }, hides ? element("span", { class: "visually-hidden" }, text) : text);
    head.prepend(heading("Told beside the sliders", true));
    head.append(heading("Pull to"));
    this.controls.forEach((each) => each.show(null, null));
  }

  // As the report has it, and the objective. Nothing is said of what is not known yet.
  table() {
    const made = requirementTable(this.data, this.show), body = made.querySelector("tbody");
    this.data.requirements.forEach((row, k) => {
      if (row.lower === null && row.upper === null && !row.fault) body.rows[k].cells[body.rows[k].cells.length - 1].replaceWith(cell("Verdict", "", "\u2013"));
    });
    if (this.objective) body.append(this.objectiveRow());
    return made;
  }

  rows() {
    return this.objective ? [...this.data.requirements, this.objective] : this.data.requirements;
  }

  // The row whose derivatives are told.
  get chosenRow() {
    return this.rows()[this.chosen] ?? null;
  }

  choose(k, onChoose) {
    this.chosen = k;
    this.isChosenByUser = true;
    onChoose();
  }

  objectiveRow() {
    const { name, unit, upper, start } = this.objective;
    const before = typeof start === "number" ? `${withUnit(number(start), unit)} with the file\u2019s values` : null;
    return element("tr", {}, element("td", {}, name, element("small", {}, "minimised")), cell("Required", "num", "least"), cell("At least", "num", withUnit(number(upper), unit)),
      cell("At most", "num", withUnit(number(upper), unit)), cell("These are", "", "computed"), cell("When", "num", "\u2013"), cell("Before", "", before ? element("small", {}, before) : "\u2013"));
  }

  // Rows as the data have them now, and the objective {value, start}.
  update(objective) {
    if (objective && this.objective) Object.assign(this.objective, { lower: objective.value, upper: objective.value, start: objective.start });
    const fresh = [...this.table().querySelectorAll("tbody tr")];
    fresh.forEach((line, k) => {
      const old = [...this.lines[k].cells].slice(1, -1);
      [...line.cells].forEach((made, n) => made.outerHTML !== old[n].outerHTML && old[n].replaceWith(made));
      if ("pair" in line.dataset) this.lines[k].dataset.pair = line.dataset.pair;
    });
    if (!this.isChosenByUser && this.rows().some((row) => row.upper !== null)) this.chosen = this.worst();
    this.controls.forEach((each, k) => (each.radio.checked = k === this.chosen));
  }

  // The requirement that is missed by most, or has least to spare; without any the objective.
  worst() {
    const lacks = this.data.requirements.map(lack);
    return lacks.length ? lacks.indexOf(Math.max(...lacks)) : 0;
  }

  // Where each number can be pulled to, by its derivatives `slopesOf(row)`, null where they are not known.
  reach(parameters, values, slopesOf) {
    this.rows().forEach((row, k) => {
      const value = judged(row), by = slopesOf(row);
      this.controls[k].show(value, by && value !== null ? reachOf(parameters, values, by, value) : null);
    });
  }

  // What was told of a pull is of other values now.
  forgetPull() {
    this.controls.forEach((each) => (each.told.textContent = ""));
  }

  hold(isHeld) {
    this.controls.forEach((each) => each.hold(isHeld));
  }
}

// Of a weighted sum there is none.
const unitOf = (terms) => (terms.length === 1 && terms[0].weight === 1 ? terms[0].unit : "");
