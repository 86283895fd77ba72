// SPDX-License-Identifier: MIT
// The parameters: a slider and a field of each, with the file's value, and what a step of it does.
import { element } from "./dom.js";
import { effectOf, stepOf } from "./effects.js";
import { number, raised, withUnit } from "./numbers.js";

const backward = ["ArrowLeft", "ArrowDown"], forward = ["ArrowRight", "ArrowUp"], sideways = ["ArrowLeft", "ArrowRight"];  // in a field these move in its text

export class Slider {
  // `origin`: what the parameter's value is the value of.
  constructor(parameter, id, onSet, origin = { short: "file", long: "the file\u2019s" }) {
    const { name, unit, lower, upper, value } = parameter, said = unit ? `${name} in ${unit}` : name;
    this.parameter = parameter;
    this.step = stepOf(parameter);
    this.fine = this.step / 10;
    this.onSet = onSet;
    this.range = element("input", { type: "range", min: lower, max: upper, step: "any", "aria-label": said, disabled: !(upper > lower), oninput: () => this.set(this.rounded(Number(this.range.value))), onkeydown: (event) => this.press(event) });
    this.field = element("input", { type: "number", id, min: lower, max: upper, step: "any", "aria-label": said, oninput: () => this.type(), onchange: () => this.type(true), onkeydown: (event) => this.press(event, true) });
    const mark = element("i", { class: "file-mark", "aria-hidden": "true" });
    mark.style.setProperty("--at", (value - lower) / (upper - lower || 1));
    this.back = element("button", { type: "button", class: "quiet back", "aria-label": `${name}: back to ${origin.long} ${withUnit(number(value), unit)}`, onclick: () => this.set(value) }, `${origin.short}: ${withUnit(number(value), unit)}`);
    this.effect = element("span", { class: "effect-words" });
    this.root = element("li", { class: "parameter" },
      element("label", { for: id }, name), this.back, element("span", { class: "amount" }, this.field, unit ? element("span", { class: "unit" }, raised(unit)) : null),
      element("span", { class: "track" }, this.range, mark), this.effect);
  }

  rounded(x) {
    const { lower, upper } = this.parameter;
    return Number(Math.min(upper, Math.max(lower, Math.round(x / this.fine) * this.fine)).toPrecision(12));
  }

  // Arrows go by the step that is told beside the slider, with Shift by a tenth of it.
  press(event, isField = false) {
    const way = forward.includes(event.key) ? 1 : backward.includes(event.key) ? -1 : 0;
    if (!way || event.ctrlKey || event.metaKey || event.altKey || (isField && sideways.includes(event.key))) return;
    event.preventDefault();
    this.set(this.rounded(this.value + way * (event.shiftKey ? this.fine : this.step)));
  }

  // What is typed counts while it is a value within the bounds; in the end the nearest one does.
  type(ended = false) {
    const { lower, upper } = this.parameter, x = this.field.value.trim() === "" ? NaN : Number(this.field.value);
    const fits = Number.isFinite(x) && x >= lower && x <= upper;
    this.field.setAttribute("aria-invalid", String(!fits && !ended));
    if (fits) this.set(x, this.field);
    else if (ended) this.set(Number.isFinite(x) ? Math.min(upper, Math.max(lower, x)) : this.value);
  }

  set(x, from = null) {
    const changed = x !== this.value;
    this.show(x, from);
    if (changed) this.onSet(this.parameter.name, x);
  }

  show(x, from = null) {
    this.value = x;
    this.range.value = x;
    this.range.setAttribute("aria-valuetext", withUnit(number(x, 7), this.parameter.unit));
    const isTyped = this.field === from || (this.field === document.activeElement && Number(this.field.value) === x);
    if (!isTyped) this.field.value = Number(x.toPrecision(7));
    if (!isTyped) this.field.setAttribute("aria-invalid", "false");
    this.back.classList.toggle("same", x === this.parameter.value);
    this.back.disabled = x === this.parameter.value;
  }

  tell(row, slope) {
    const { text, tone } = row && Number.isFinite(slope) ? effectOf(this.parameter, row, slope) : { text: "", tone: "" };
    this.effect.textContent = text;
    this.effect.className = `effect-words ${tone}`;
  }
}

export class Sliders {
  // onSet(name, value) where the user sets one.
  constructor(parameters, onSet) {
    this.sliders = parameters.map((parameter, k) => new Slider(parameter, `parameter-${k}`, onSet));
    this.root = element("ul", { class: "parameters" }, ...this.sliders.map((slider) => slider.root));
  }

  // Values that came from elsewhere; not over one that the user has just set.
  show(values, isSet = () => false) {
    for (const slider of this.sliders) {
      const { name } = slider.parameter;
      if (typeof values[name] === "number" && !isSet(name)) slider.show(values[name]);
    }
  }

  get values() {
    return Object.fromEntries(this.sliders.map((slider) => [slider.parameter.name, slider.value]));
  }

  // What a step of each does to the number of a row of requirements; null: not known.
  tell(row, by) {
    for (const slider of this.sliders) slider.tell(row, by?.[slider.parameter.name]);
  }
}
