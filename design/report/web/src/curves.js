// SPDX-License-Identifier: MIT
// The figures: clearances over time, how the search went, forces.
import { Plot } from "./plots.js";
import { element } from "./dom.js";
import { lowerBound, number, plural, withUnit } from "./numbers.js";

const least = (values) => values.reduce((a, b) => (b !== null && b < a ? b : a), Infinity);
const most = (values) => values.reduce((a, b) => (b !== null && b > a ? b : a), -Infinity);
const asList = (values) => Array.from(values, (v) => (Number.isFinite(v) ? v : null));

// Steps: of every stretch of the path its bounds, from its start; the last one's again at the end.
export const marginPlot = (parent, data, pick) => new Plot(parent, ...marginCurves(data, pick));

// What such a plot is made of: its abscissas and options.
export function marginCurves(data, pick) {
  const { margins, pairs } = data;
  const lines = [], bands = [];
  const told = (values) => asList(values).map((v) => (v !== null && v < 1e-7 ? 0 : v));  // of what touches, bounds are not quite 0
  const ended = (values) => [...told(values), values.length ? told(values)[values.length - 1] : null];
  margins.pairs.forEach((margin, k) => {
    const pair = pairs[margin.pair], upper = lines.length;
    lines.push({ name: `${pair.a} \u2013 ${pair.b}`, values: ended(margin.upper), style: "step", colour: k });
    lines.push({ name: "", values: ended(margin.lower), style: "step", colour: k, edge: true, with: upper });
    bands.push([upper, upper + 1]);
  });
  const required = [...new Set(margins.pairs.map((m) => pairs[m.pair]).filter((pair) => pair.minimum > 0 && pair.status !== "contact").map((pair) => pair.minimum))].sort((x, y) => x - y);
  const values = lines.flatMap((line) => line.values.filter((v) => v !== null)), top = Math.max(most(values), ...required), floor = floorOf(values, required);
  const all = { name: "All", yRange: () => [0, top * 1.08] }, log = { name: "Log", log: true, floor, yRange: () => [floor * 0.9, top * 1.3] };
  const strictest = required[required.length - 1], near = { name: "Near the limit", yRange: () => [0, strictest * 3] };
  const zooms = required.length && top > 4 * strictest ? [near, all, log] : [all, log];
  return [asList(margins.time), {
    title: "Clearance over the motion", note: "certified band: lower to upper bound", unit: "mm", quantity: "distance", x: { label: "time [s]", time: true },
    lines, bands, zooms, limits: required.map((minimum) => ({ value: minimum, name: `required ${withUnit(number(minimum), "mm")}` })), onPick: pick, height: 260,
    summary: margins.pairs.map((m) => `${pairs[m.pair].a} and ${pairs[m.pair].b}: at least ${withUnit(lowerBound(m.least), "mm")}`).join("; ") + ".",
  }];
}

// The lowest value of a logarithmic axis: below what is required, and no lower than a ten thousandth of what there is; 0 is drawn there.
function floorOf(values, required) {
  const positive = least(values.filter((v) => v > 0)), top = most(values);
  return Math.max(Math.min(positive, ...required.map((x) => 0.3 * x)), 1e-4 * top) || 1e-6;
}

function bestSoFar(history) {
  let best = null;
  return history.objective.map((value, i) => {
    if (value !== null && history.own[i] && history.violation[i] !== null && history.violation[i] <= 0 && (best === null || value < best)) best = value;
    return best;
  });
}

// Runs of evaluations of one model.
function stages(history) {
  const found = [];
  history.model.forEach((model, i) => {
    if (found.length === 0 || found[found.length - 1].model !== model) found.push({ model, from: i + 0.5, to: i + 1.5 });
    else found[found.length - 1].to = i + 1.5;
  });
  return found;
}

export function searchPlots(parent, data) {
  const { history } = data, xs = history.objective.map((_, i) => i + 1), x = { label: "evaluation" };
  const stripes = stages(history), shaded = stripes.length > 1 ? "shaded: by turns wider contact, in which parts do not rattle, and the design as written" : undefined;
  const end = xs.length, span = (u, low, high) => [Math.min(low, 0.5), Math.max(high, end + 0.5)];
  new Plot(parent, xs, {
    title: "Objective", note: shaded, quantity: "objective", x, xRange: span, stripes,
    lines: [{ name: "evaluated", values: history.objective, points: end < 80, colour: 8 }, { name: "best that meets all requirements", values: bestSoFar(history), style: "step", colour: 0 }],
    summary: `${plural(end, "evaluation")}, from ${number(data.objective.start)} to ${number(data.objective.end)}.`,
  });
  new Plot(parent, xs, {
    title: "Largest violation", note: "of a requirement, in its unit; 0: all met", quantity: "violation", x, xRange: span, stripes,
    lines: [{ name: "violation", values: history.violation, points: end < 80, colour: 1 }], yRange: (u, low, high) => [0, Math.max(high * 1.08, 1e-6)],
    summary: `From ${number(history.violation[0])} to ${number(data.violation)}.`,
  });
  const requirements = history.constraints ?? [];
  if (requirements.length)
    new Plot(parent, xs, {
      title: "Requirements", note: "spare, in the unit of each; below 0: violated", quantity: "spare", x, xRange: span, stripes,
      lines: requirements.map((r) => ({ name: r.name, values: r.spare })), height: 260,
      summary: requirements.map((r) => `${r.name}: ${number(r.spare[r.spare.length - 1])}`).join("; ") + ".",
    });
  new Plot(parent, xs, {
    title: "Parameters", note: "share of the range between their bounds", quantity: "share", x, xRange: span, stripes,
    lines: history.parameters.map((values, k) => ({ name: data.parameters[k].name, values })), yRange: () => [-0.03, 1.03], height: 260,
    summary: data.parameters.map((p) => `${p.name} from ${number(p.start)} to ${number(p.end)} ${p.unit}`).join("; ") + ".",
  });
}

// Curves over the motion's time, of charts as the program gives them.
export function motionPlots(parent, charts, pick) {
  for (const chart of charts) new Plot(parent, ...motionCurves(chart, pick));
}

export function motionCurves(chart, pick) {
  const shown = chart.lines.map((line) => ({ name: line.name, values: asList(line.values) }));
  return [asList(chart.time), {
    title: chart.title, note: chart.note, unit: chart.unit, quantity: chart.quantity, x: { label: "time [s]", time: true }, lines: shown, onPick: pick,
    summary: shown.map((line) => `${line.name}: from ${number(least(line.values))} to ${number(most(line.values))} ${chart.unit}`).join("; ") + ".",
  }];
}
