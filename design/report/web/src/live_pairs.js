// SPDX-License-Identifier: MIT
// The clearances and the charts over the motion while they change: tables made anew, charts that keep what was chosen of them.
import { marginCurves, motionCurves } from "./curves.js";
import { element } from "./dom.js";
import { Plot } from "./plots.js";
import { interferenceTable, pairTable } from "./tables.js";
import { isShared } from "./words.js";

class LiveCharts {
  constructor() {
    this.root = element("div", { class: "figures" });
    this.plots = [];
  }

  // Each [abscissas, options].
  show(charts) {
    if (charts.length !== this.plots.length) this.clear();
    charts.forEach((chart, k) => (this.plots[k] ? this.plots[k].replace(...chart) : this.plots.push(new Plot(this.root, ...chart))));
  }

  clear() {
    this.plots.splice(0).forEach((plot) => plot.remove());
  }
}

export class LivePairs {
  // show(pair): its gap in the picture; pick(t): an instant was chosen in a chart.
  constructor(show, pick) {
    this.showPair = show;
    this.pick = pick;
    this.tables = element("div");
    this.margins = new LiveCharts();
    this.quantities = new LiveCharts();
  }

  show(data) {
    const focused = this.tables.contains(document.activeElement) ? document.activeElement.dataset.pair : null, shared = data.pairs.filter(isShared);
    this.tables.replaceChildren(...[
      shared.length ? interferenceTable(data, this.showPair) : null,
      shared.length < data.pairs.length ? pairTable(data, this.showPair) : null,
      data.pair_count > data.pairs.length ? element("p", { class: "section-intro" }, `The worst ${data.pairs.length} of ${data.pair_count} pairs.`) : null].filter(Boolean));
    if (focused !== null) this.tables.querySelector(`button[data-pair="${focused}"]`)?.focus({ preventScroll: true });
    this.margins.show(data.margins ? [marginCurves(data, this.pick)] : []);
    this.quantities.show((data.scenarios?.[0]?.quantities ?? []).map((chart) => motionCurves(chart, this.pick)));
  }

  clear() {
    this.margins.clear();
    this.quantities.clear();
  }
}
