// SPDX-License-Identifier: MIT
// What the studio does beside setting values: undo, save, export, tune; the command that would do the same, to copy; keys.
import { byId, element } from "./dom.js";
import { number, plural, withUnit } from "./numbers.js";

const isText = (target) => target instanceof HTMLInputElement && target.type === "text";

function download(name, base64) {
  const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)), address = URL.createObjectURL(new Blob([bytes]));
  element("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60000);
}

export class Actions {
  // call(body) -> promise of the answer, in its turn; now(body): at once, whatever else is on its way.
  constructor({ call, now, values, parameters, command, wants }) {
    Object.assign(this, { call, now, values, parameters });
    const button = (text, action, more = {}) => element("button", { type: "button", onclick: () => this.do(action), ...more }, text);
    this.undo = button("Undo", { do: "undo" }, { "aria-keyshortcuts": "Control+Z" });
    this.redo = button("Redo", { do: "redo" }, { "aria-keyshortcuts": "Control+Y Control+Shift+Z" });
    this.reset = button("Reset", { do: "reset" }, { title: "The file\u2019s values" });
    this.save = button("Save", { do: "save", as: null });
    this.tune = button("Tune", null, { class: "main", hidden: !wants || !parameters.length, onclick: () => (this.runs ? this.do({ do: "stop" }, this.now) : this.do({ do: "tune" })) });
    this.fileName = element("input", { type: "text", "aria-label": "Name of the file to save as", placeholder: "name.design.json", size: 16, oninput: () => this.offerReplacing(null) });
    this.saveOther = element("button", {}, "Save as");
    const saveAs = element("form", { onsubmit: (event) => this.saveAs(event) }, this.fileName, this.saveOther);
    this.kind = element("select", { "aria-label": "What to export" }, ...[["3mf", "3MF"], ["stl", "STL"], ["glb", "GLB"], ["design", "design"]].map(([value, text]) => element("option", { value }, text)));
    const give = element("span", { class: "give" }, this.kind, button("Export", null, { onclick: () => this.do({ do: "export", what: this.kind.value }) }));
    this.bar = element("div", { class: "actions", role: "group", "aria-label": "What is set" }, this.undo, this.redo, this.reset, this.tune);
    this.files = element("div", { class: "actions", role: "group", "aria-label": "Files" }, this.save, saveAs, give);
    this.told = element("p", { class: "told", role: "status" });
    this.tuning = element("div", { class: "tuning", hidden: true });
    this.command = element("code", {}, command ?? "");
    this.copy = element("button", { type: "button", class: "quiet", onclick: () => this.copyCommand() }, "Copy");
    this.commandLine = element("p", { class: "command" }, element("span", {}, "The same, typed: "), this.command, this.copy);
  }

  // Does it, and says what came of it.
  async do(body, send = this.call) {
    this.say("");
    try {
      const answer = await send(body);
      if (answer.command) this.tellCommand(answer.command);
      if (answer.file) this.say(`Written: ${answer.file}`);
      if (answer.base64 !== undefined) {
        download(answer.name, answer.base64);
        this.say(`Exported: ${answer.name}`);
      }
      return answer;
    } catch (error) {
      this.say(error.message, true);
      if (error.told?.exists) this.offerReplacing(body.as);
      return null;
    }
  }

  say(text, isError = false) {
    this.told.textContent = text;
    this.told.classList.toggle("error", isError);
  }

  tellCommand(command) {
    this.command.textContent = command;
  }

  async copyCommand() {
    try {
      await navigator.clipboard.writeText(this.command.textContent);
      this.copy.textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(this.command);
      this.copy.textContent = "Selected";
    }
    setTimeout(() => (this.copy.textContent = "Copy"), 1500);
  }

  saveAs(event) {
    event.preventDefault();
    const name = this.fileName.value.trim(), replace = name === this.replacing;
    this.offerReplacing(null);
    if (name) this.do({ do: "save", as: name, ...(replace ? { replace } : {}) });
    else this.fileName.focus();
  }

  // A file of this name is there: the next time it is replaced. null: no more.
  offerReplacing(name) {
    this.replacing = name;
    this.saveOther.textContent = name === null ? "Save as" : "Replace it";
  }

  // What can be undone, and whether there is something to save.
  history({ can_undo, can_redo, saved }) {
    this.undo.disabled = !can_undo;
    this.redo.disabled = !can_redo;
    this.save.disabled = this.reset.disabled = !!saved;
  }

  // A search tells what it has come to; when it has ended, what changed.
  hearTuning({ state, evaluations, values, objective, violation, message }) {
    const runs = state === "running";
    if (runs && !this.runs) this.before = this.values();
    this.runs = runs;
    this.tune.textContent = runs ? "Stop" : "Tune";
    const best = objective === null ? "none found yet" : `best objective ${number(objective)}${violation > 0 ? `, requirements missed by up to ${number(violation, 3)}` : ", requirements met"}`;
    const told = [element("p", {}, `${runs ? "Tuning" : "Tuned"}: ${plural(evaluations, "evaluation")}, ${best}.`)];
    if (runs) told.push(element("progress", { "aria-label": "Tuning" }));
    if (message) told.push(element("p", {}, message));
    if (!runs && values && this.before) told.push(this.changes(values));
    this.tuning.replaceChildren(...told);
    this.tuning.hidden = false;
    this.tuning.setAttribute("aria-live", runs ? "off" : "polite");
  }

  changes(values) {
    const changed = this.parameters.filter(({ name }) => values[name] !== undefined && values[name] !== this.before[name]);
    if (!changed.length) return element("p", {}, "Nothing has changed.");
    return element("ul", {}, ...changed.map(({ name, unit }) => element("li", {}, `${name}: ${number(this.before[name])} \u2192 ${withUnit(number(values[name]), unit)}`)));
  }

  // Ctrl+Z, Ctrl+Y, Ctrl+Shift+Z, but where text is written; `mayChange()`: is this window the one that may?
  press(event, mayChange) {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || isText(event.target)) return;
    const key = event.key.toLowerCase(), what = key === "y" || (key === "z" && event.shiftKey) ? "redo" : key === "z" ? "undo" : null;
    if (!what) return;
    event.preventDefault();
    if (mayChange() && !this[what].disabled) this.do({ do: what });
  }
}

// Errors of the file on the disk, at the top of the page.
export function showFaults(errors) {
  const box = byId("faults");
  box.hidden = !errors.length;
  box.replaceChildren(...(errors.length ? [
    element("p", {}, element("strong", {}, "The file has an error."), " What is shown is as it was before."),
    element("ul", {}, ...errors.map(({ where, message }) => element("li", {}, where ? element("code", {}, where) : null, where ? ": " : "", message)))] : []));
}
