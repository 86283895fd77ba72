// SPDX-License-Identifier: MIT
// Tables: pairs or requirements (whose rows show their gap in the picture), parameters, what limits the design.
import { element } from "./dom.js";
import { lowerBound, number, percent, plural, seconds, spaced, upperBound, withUnit } from "./numbers.js";
import { capital, depthRange, finerName, heldWords, isShared, isTouching, spansMuch, startName, touchWords, volumeRange } from "./words.js";

// [term, value, small print, tone]
export const factList = (rows) => rows.map(([term, value, small, tone]) => element("div", { class: tone }, element("dt", {}, term), element("dd", {}, value, small ? element("small", {}, small) : null)));

export function tableOf(label, headings, rows) {
  const head = headings.map(([text, type]) => element("th", { scope: "col", class: type }, text));
  const table = element("table", { class: "stacked" }, element("caption", { class: "visually-hidden" }, label), element("thead", {}, element("tr", {}, ...head)), element("tbody", {}, ...rows));
  return element("div", { class: "table-frame" }, table);
}

export const cell = (label, type, ...children) => element("td", { "data-label": label, class: type + (children.length && children[0] !== "\u2013" ? "" : " nothing") }, ...children);

const tones = { clear: "good", met: "good", optimal: "good", feasible: "open", infeasible: "bad", interrupted: "open", failed: "bad", start_failed: "bad", violated: "bad", "not met": "bad", "too close": "bad", interference: "bad", undecided: "open", touching: "open", contact: "plain" };
const told = { clash: "interference", "below threshold": "too close" };
export const status = (word) => element("span", { class: `status ${tones[told[word] ?? word] ?? "plain"}` }, told[word] ?? word);

const pairName = (pair) => `${pair.a} \u2013 ${pair.b}`;

// A row's first cell: a button that shows the gap, where there is one to show.
function opener(text, small, pair, show) {
  const shown = pair !== null && pair !== undefined && show.can(pair);
  const name = shown ? element("button", { type: "button", class: "row-button", "data-pair": pair, onclick: () => show(pair) }, text) : text;
  return element("td", {}, name, small ? element("small", {}, spaced(small)) : null);
}

// Of pairs that share material, the deepest first.
export function interferenceTable(data, show) {
  const shared = data.pairs.map((pair, k) => ({ pair, k })).filter(({ pair }) => isShared(pair)), timed = shared.some(({ pair }) => pair.motion);
  const depth = ({ pair }) => pair.depth?.upper ?? 0;
  const rows = shared.sort((x, y) => depth(y) - depth(x)).map(({ pair, k }) => element("tr", { "data-pair": k },
    opener(pairName(pair), pair.note, k, show),
    cell("Depth", "num", depthRange(pair) || "\u2013"),
    cell("Volume", "num", volumeRange(pair) || "\u2013"),
    timed ? cell("From", "num", pair.motion ? seconds(pair.time, data.step) : "\u2013") : null,
    timed ? cell("Deepest", "num", pair.motion && pair.depth ? seconds(pair.depth.time, data.step) : "\u2013") : null,
    cell("Verdict", "", status("interference"))));
  return tableOf("Interferences of pairs", [["Pair"], ["Depth", "num"], ["Volume", "num"], ...(timed ? [["From", "num"], ["Deepest", "num"]] : []), ["Verdict"]], rows);
}

export function pairTable(data, show) {
  const apart = data.pairs.map((pair, k) => ({ pair, k })).filter(({ pair }) => !isShared(pair));
  const required = apart.some(({ pair }) => pair.minimum !== null), timed = apart.some(({ pair }) => pair.motion && pair.time !== null);
  const headings = [["Pair"], ...(required ? [["Required", "num"]] : []), ["Proven at least", "num"], ["At most", "num"], ...(timed ? [["When", "num"]] : []), ["Verdict"]];
  const rows = apart.map(({ pair, k }) => element("tr", { "data-pair": k },
    opener(pairName(pair), pair.note ?? (isTouching(pair) ? touchWords(pair) : null), k, show),
    required ? cell("Required", "num", withUnit(number(pair.minimum), "mm")) : null,
    cell("Proven at least", "num", withUnit(lowerBound(pair.lower), "mm")),
    cell("At most", "num", withUnit(upperBound(pair.upper), "mm")),
    timed ? cell("When", "num", pair.time === null || !pair.motion ? "\u2013" : seconds(pair.time, data.step)) : null,
    cell("Verdict", "", status(pair.finding ?? pair.status))));
  return tableOf("Clearances of pairs", headings, rows);
}

export function requiredWords(r) {
  const low = r.required_lower !== null, high = r.required_upper !== null;
  if (low && high) return r.required_lower === r.required_upper ? withUnit(number(r.required_lower), r.unit) : `${number(r.required_lower)} to ${withUnit(number(r.required_upper), r.unit)}`;
  return low ? `\u2265 ${withUnit(number(r.required_lower), r.unit)}` : `\u2264 ${withUnit(number(r.required_upper), r.unit)}`;
}

// Is a requirement met in one of its simulations, as found and finer, and not in the other?
const flips = (data, requirement) => data.resolution?.rows.some((row) => row.of === "constraint" && row.flips && row.name === requirement.name);

const runName = (run) => capital(finerName(run));

// The check of resolution: each number as found and in each finer run.
export function resolutionTable({ runs, rows }) {
  const then = (row) => status(row.met_finer ? "met" : "not met");
  const made = rows.map((row) => element("tr", row.flips ? { class: "flips" } : {},
    element("td", {}, row.name, row.of === "term" ? element("small", {}, "in the objective") : null),
    cell("As found", "num", withUnit(number(row.found), row.unit)),
    ...runs.map((run, k) => cell(runName(run), "num", withUnit(number(row.finer[k]), row.unit))),
    cell("Change", "num", percent(row.change)),
    cell("Met then", "", row.of === "constraint" ? then(row) : "\u2013", row.flips ? element("small", {}, row.met ? "met as found" : "not met as found") : null)));
  const notes = runs.flatMap((run) => [
    run.failure ? `${runName(run)} it could not be simulated: ${run.failure}` : null,
    run.change_of_best ? `${runName(run)} the best objective near by changes by about ${number(run.change_of_best, 3)}.` : null]).filter(Boolean);
  const list = notes.length ? element("ul", { class: "plain-list" }, ...notes.map((note) => element("li", {}, note))) : "";
  if (!made.length) return [list];
  return [tableOf("Numbers with finer facets and time steps", [["Number"], ["As found", "num"], ...runs.map((run) => [runName(run), "num"]), ["Change", "num"], ["Met then"]], made), list];
}

export function requirementTable(data, show) {
  const rows = data.requirements.map((r) => {
    const pair = data.pairs[r.pair] ?? null, shared = pair !== null && isShared(pair);
    return element("tr", r.pair === null ? {} : { "data-pair": r.pair },
      opener(r.name, r.fault, r.pair, show),
      cell("Required", "num", requiredWords(r)),
      cell("At least", "num", shared ? "\u2013" : withUnit(lowerBound(r.lower), r.unit)),
      cell("At most", "num", shared ? "\u2013" : withUnit(upperBound(r.upper), r.unit)),
      cell("These are", "", r.proven ? "proven" : "computed"),
      cell("When", "num", pair && pair.motion ? seconds(pair.time, data.step) : "\u2013"),
      cell("Verdict", "", status(r.met ? "met" : shared ? "interference" : "not met"), flips(data, r) ? element("small", {}, r.met ? "not when finer" : "met when finer") : null));
  });
  return tableOf("Requirements", [["Requirement"], ["Required", "num"], ["At least", "num"], ["At most", "num"], ["These are"], ["When", "num"], ["Verdict"]], rows);
}

export function rangeDrawing(p) {
  const place = (x) => 6 + 108 * Math.min(1, Math.max(0, (x - p.lower) / (p.upper - p.lower || 1)));
  const from = place(p.start), to = place(p.end);
  return element("svg", { class: "range", viewBox: "0 0 120 16", "aria-hidden": "true" },
    element("svg:line", { x1: 6, x2: 114, y1: 8, y2: 8 }), element("svg:line", { class: "moved", x1: from, x2: to, y1: 8, y2: 8 }),
    element("svg:circle", { class: "from", cx: from, cy: 8, r: 3.5 }), element("svg:circle", { class: "to", cx: to, cy: 8, r: 4.5 }));
}

export function parameterTable(data) {
  const rows = data.parameters.map((p) => element("tr", {},
    element("td", {}, p.name),
    cell("Start", "num", withUnit(number(p.start), p.unit)),
    cell("End", "num", withUnit(number(p.end), p.unit)),
    cell("Bounds", "num", `${number(p.lower)} to ${withUnit(number(p.upper), p.unit)}`),
    cell("Within them", "", rangeDrawing(p)),
    cell("Held by", "wide", p.held ? heldWords[p.held] ?? p.held : "\u2013", p.step ? element("small", {}, `could move by ${withUnit(number(p.step, 3), p.unit)}`) : null)));
  return tableOf("Parameters", [["Parameter"], ["Start", "num"], ["End", "num"], ["Bounds", "num"], ["Within them"], ["Held by"]], rows);
}

const mostStarts = 100;

// Where a start's number lies among all: 0 to 1, by its logarithm where they span more than a hundredfold.
function placing(numbers) {
  const known = numbers.filter((x) => typeof x === "number" && Number.isFinite(x));
  const low = Math.min(...known), high = Math.max(...known);
  const scale = spansMuch(known) ? Math.log : (x) => x;
  return (x) => (high > low ? (scale(x) - scale(low)) / (scale(high) - scale(low)) : 0);
}

function startDot(place, met, taken) {
  const x = 6 + 108 * place;
  return element("svg", { class: `range start${met ? "" : " unmet"}${taken ? " taken" : ""}`, viewBox: "0 0 120 16", "aria-hidden": "true" },
    element("svg:line", { x1: 6, x2: 114, y1: 8, y2: 8 }), element("svg:circle", { cx: x, cy: 8, r: taken ? 5 : 4 }));
}

// The starts of an optimisation, the best first.
export function startTable(data) {
  const least = (s) => (data.repair ? s.distance : s.objective), words = { start_failed: "start failed" };
  const place = placing(data.starts.map(least));
  const rows = data.starts.slice(0, mostStarts).map((s) => {
    const met = s.violation !== null && s.violation <= 0, known = least(s) !== null;
    const why = met ? s.limits.join("; ") : s.violation !== null ? `violated by up to ${number(s.violation, 3)}` : s.message;
    return element("tr", s.taken ? { class: "taken" } : {},
      element("td", {}, startName(s), s.taken ? element("small", {}, "taken") : null),
      cell("Verdict", "", status(words[s.status] ?? s.status)),
      cell(data.repair ? "Change" : "Objective", "num", number(least(s))),
      cell("Among all", "", known ? startDot(place(least(s)), met, s.taken) : "\u2013"),
      cell("Away", "num", s.taken || s.away === null ? "\u2013" : `${number(100 * s.away, 2)}\u00a0%`),
      cell("Simulations", "num", number(s.evaluations)),
      cell("Limited by", "whole", why || "\u2013"));
  });
  const headings = [["Start"], ["Verdict"], [data.repair ? "Change" : "Objective", "num"], ["Among all"], ["Away", "num"], ["Simulations", "num"], ["Limited by"]];
  const table = tableOf("Starts", headings, rows), more = data.starts.length - rows.length;
  if (more > 0) table.append(element("p", { class: "section-intro" }, `${plural(more, "more start")} in result.json.`));
  return table;
}

// What each requirement costs: bars, the dearest first.
export function costBars(data) {
  const costs = data.requirements.filter((r) => r.counts).sort((a, b) => Math.abs(b.cost) - Math.abs(a.cost));
  const top = Math.abs(costs[0]?.cost ?? 1);
  return element("ul", { class: "bars" }, ...costs.map((r) => {
    const bar = element("div", { class: "bar" });
    bar.style.width = `${(100 * Math.abs(r.cost)) / top}%`;  // of tracks that are all equally long
    const told = `${withUnit(number(0.01), r.unit)} ${r.cost > 0 ? "less" : "more"} would gain ${number(0.01 * Math.abs(r.cost), 3)}`;
    return element("li", {}, element("span", {}, r.name), element("div", { class: "track", "aria-hidden": "true" }, bar), element("span", { class: "told" }, told));
  }));
}
