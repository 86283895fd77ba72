// SPDX-License-Identifier: MIT
// The designs of an exploration: what is known of each, which are wanted, which one is chosen, and which no other one beats.

export class Designs {
  constructor(data) {
    this.columns = data.columns;
    this.names = this.columns.map((column) => this.nameOf(column));
    this.list = data.designs;
    this.ranges = new Map();  // of a column: [low, high] that is wanted
    this.onlyMet = this.list.some((design) => design.met);
    this.listeners = [];
    const axes = this.firstAxes();
    this.x = axes[0];
    this.y = axes[1];
    this.shade = null;
    this.chosen = this.bestFirst()[0] ?? 0;
  }

  // As axes and tables tell it: with its kind where another one has its name, as the mass that counts and the mass that is bounded.
  nameOf(column) {
    const kind = { objective: "objective", term: "in the objective", constraint: "requirement", parameter: "parameter", violation: "violation" }[column.group];
    return this.columns.some((other) => other !== column && other.name === column.name) ? `${column.name} (${kind})` : column.name;
  }

  of(group) {
    return this.columns.map((column, k) => ({ column, k })).filter(({ column }) => column.group === group);
  }

  varies(k) {
    const known = this.columns[k].values.filter(Number.isFinite);
    return known.length > 0 && known.some((v) => Math.abs(v - known[0]) > 1e-9 * Math.abs(known[0]));
  }

  // Two things that are wanted at once: terms of the objective, else the objective and what some requirement leaves, else a parameter; without
  // any, the objective alone.
  firstAxes() {
    const terms = this.of("term").filter(({ k }) => this.varies(k)), [objective] = this.of("objective");
    if (terms.length > 1) return [(terms.find(({ column }) => column.unit !== terms[0].column.unit) ?? terms[1]).k, terms[0].k];
    const judged = this.of("constraint").filter(({ column, k }) => column.better && this.varies(k)), free = this.of("parameter").filter(({ k }) => this.varies(k));
    return [(judged[0] ?? free[0] ?? this.of("parameter")[0] ?? objective).k, objective.k];
  }

  value(k, i) {
    return this.columns[k].values[i];
  }

  wanted(i) {
    if (this.onlyMet && !this.list[i].met) return false;
    for (const [k, [low, high]] of this.ranges) if (!(this.value(k, i) >= low && this.value(k, i) <= high)) return false;
    return true;
  }

  // Those that meet everything, by their objectives, then the others by how far they are from it.
  bestFirst() {
    const objective = this.of("objective")[0].k, violation = this.of("violation")[0].k;
    const known = this.list.map((_, i) => i).filter((i) => Number.isFinite(this.value(objective, i)) && Number.isFinite(this.value(violation, i)));
    const over = (i) => Math.max(0, this.value(violation, i));
    return known.sort((i, j) => over(i) - over(j) || this.value(objective, i) - this.value(objective, j));
  }

  // Of what is wanted those that no other one beats in both axes; null where an axis has no better side.
  front() {
    const bx = this.columns[this.x].better, by = this.columns[this.y].better;
    if (!bx || !by || this.x === this.y) return null;
    const known = this.list.map((_, i) => i).filter((i) => this.wanted(i) && Number.isFinite(this.value(this.x, i)) && Number.isFinite(this.value(this.y, i)));
    known.sort((i, j) => bx * (this.value(this.x, j) - this.value(this.x, i)) || by * (this.value(this.y, j) - this.value(this.y, i)));
    let best = -Infinity;
    return known.filter((i) => {
      const y = by * this.value(this.y, i);
      if (y <= best) return false;
      best = y;
      return true;
    });
  }

  choose(i) {
    this.chosen = i;
    this.tell();
  }

  set(members) {
    Object.assign(this, members);
    this.tell();
  }

  tell() {
    for (const listener of this.listeners) listener();
  }
}
