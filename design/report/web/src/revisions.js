// SPDX-License-Identifier: MIT
// Which results are of the values that are set, and which are of earlier ones: those are never told as current.

export class Revisions {
  // waits(): are other values on their way to the program? onChange(): something is current now, or not any more.
  constructor(waits, onChange) {
    this.waits = waits;
    this.onChange = onChange;
    this.start(0);
  }

  start(revision) {
    this.asked = revision;
    this.known = new Map();  // the last revision of each kind of result
    this.progress = this.refused = this.seconds = null;
  }

  // Values were asked for. Is it the newest that is known of?
  ask(revision) {
    if (revision < this.asked) return false;
    if (revision > this.asked) {
      this.asked = revision;
      this.progress = this.refused = this.seconds = null;
    }
    this.onChange();
    return true;
  }

  // A result has come. Is it to be shown?
  takes(kind, revision) {
    if (revision < this.asked) return false;
    this.known.set(kind, revision);
    return this.ask(revision);
  }

  isCurrent(kind) {
    return !this.waits() && this.known.get(kind) === this.asked;
  }

  refuse(revision, reason) {
    if (!this.ask(revision)) return;
    this.refused = reason;
    this.onChange();
  }

  settle(revision, seconds) {
    if (!this.takes("all", revision)) return;
    this.progress = null;
    this.seconds = seconds;
    this.onChange();
  }

  // Share of what is being done, null if it is not known.
  get share() {
    const { step, steps } = this.progress ?? {};
    return steps > 0 ? Math.min(1, step / steps) : null;
  }

  // What is told of results that are not current.
  get word() {
    return this.refused !== null && !this.waits() ? "of other values" : `${this.progress?.doing ?? "computing"} \u2026`;
  }
}
