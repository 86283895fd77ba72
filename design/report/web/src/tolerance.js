// SPDX-License-Identifier: MIT
// The page of a study of tolerances (design/report/tolerance_data.hpp): all numbers at a glance, what moves them, and each by itself.
import { element, wholeWords } from "./dom.js";
import { number, percent, plural, withUnit } from "./numbers.js";
import { histogram, scatter } from "./spread.js";
import { cell, tableOf } from "./tables.js";
import { isJudged, yieldWords } from "./words.js";

const dust = 1e-3;  // a share of the variance that is not worth a row
const mostBars = 16, mostFailures = 200, mostOthers = 2, muchUnexplained = 0.05;

// What the answer and the page's own numbers say of each; the index is that of the samples' numbers.
const responsesOf = (data) => data.answer.responses.map((told, index) => ({ ...told, ...data.responses[index], index }));
const amount = (response, si, digits = 5) => withUnit(number(si / response.scale, digits), response.unit);
const change = (response, si) => (si > 0 ? "+" : "") + number(si / response.scale, 3);
const limitsOf = (tolerance) => `${signed(tolerance.lower)} to ${withUnit(signed(tolerance.upper), tolerance.unit)}`;
const signed = (x) => (x > 0 ? "+" : "") + number(x, 4);

// The share of what is made that meets it: of the samples, else by the linear prediction; all where nothing is required.
const metOf = (response) => (isJudged(response) ? response.sampled?.yield.within ?? response.linear.yield.within : 1);
// Those that are met least often, then those of which nothing is required.
const worstFirst = (responses) => [...responses].sort((a, b) => Number(isJudged(b)) - Number(isJudged(a)) || metOf(a) - metOf(b) || (isJudged(a) ? a.linear.yield.within - b.linear.yield.within : 0));

function atAGlance(responses, sampled) {
  const headings = [["Of"], ["As drawn", "num"], ["Required", "num"], ["Sigma", "num"], ["Yield, predicted", "num"], ...(sampled ? [["Yield, sampled", "num"]] : []), ["Most by"]];
  const rows = responses.map((r) => {
    const [most] = r.contributions;
    return element("tr", {},
      element("td", {}, element("a", { class: "row-button", href: `#number-${r.index}` }, r.name)),
      cell("As drawn", "num", amount(r, r.nominal)),
      cell("Required", "num", r.required ?? "\u2013"),
      cell("Sigma", "num", amount(r, r.linear.standard_deviation)),
      cell("Yield, predicted", "num", yieldWords(r.linear.yield)),
      sampled ? cell("Yield, sampled", "num wide", yieldWords(r.sampled?.yield)) : null,
      cell("Most by", "whole", most && most.share > 0 ? `${most.of} (${percent(most.share)})` : "\u2013"));
  });
  return tableOf("All numbers at a glance", headings, rows);
}

const effect = (...parts) => element("svg", { class: "range effect", viewBox: "0 0 120 16", preserveAspectRatio: "none", "aria-hidden": "true" }, ...parts);
const shareDrawing = (share) => effect( element("svg:rect", { class: "upper", x: 0, y: 4, width: 120 * share, height: 8 }));

// A bar to each side of zero, by how far it moves the number at its two limits.
function effectDrawing(by, reach) {
  const bar = (kind, y, at) => element("svg:rect", { class: kind, x: 60 + Math.min(0, (58 * at) / reach), y, width: Math.abs((58 * at) / reach), height: 6 });
  return effect(bar("lower", 1.5, by.at_lower), bar("upper", 8.5, by.at_upper), element("svg:line", { x1: 60, x2: 60, y1: 0, y2: 16 }));
}

const contributorCell = (of, shared, limits) => element("td", { class: "name" }, contributorName(of, shared), element("small", {}, shared ? "at 3 sigma" : limits.get(of) ?? ""));
const contributorName = (of, shared) => (shared ? `what ${of} shares` : of);

// All that contributes a thousandth of some number's variance, with each number that it does so to: first what has the largest share of
// what is missed most often.
function contributorsOf(responses) {
  const found = new Map(), weight = (part) => part.share * (1 - metOf(part.response));
  const order = (a, b) => weight(b) - weight(a) || b.share - a.share;
  for (const response of responses)
    response.contributions.forEach(({ of, share }, k) => {
      const effect = response.effects[k], id = `${effect.shared} ${of}`;
      if (!found.has(id)) found.set(id, { of, shared: effect.shared, parts: [] });
      if (share >= dust) found.get(id).parts.push({ response, share, effect });
    });
  const all = [...found.values()];
  for (const each of all) each.parts.sort(order);
  const kept = all.filter((each) => each.parts.length).sort((a, b) => order(a.parts[0], b.parts[0]));
  return { kept, dropped: all.filter((each) => !each.parts.length) };
}

function contributorTable(kept, limits) {
  const headings = [["Contributor"], ["Most of"], ["Share", "num"], ["Of its variance"], ["At the lower limit", "num"], ["At the upper limit", "num"], ["And of"]];
  const rows = kept.map(({ of, shared, parts }) => {
    const [{ response, share, effect }, ...others] = parts;
    const more = others.slice(0, mostOthers).map((part) => `${part.response.name} ${percent(part.share)}`);
    if (others.length > mostOthers) more.push(`and ${others.length - mostOthers} more`);
    return element("tr", {},
      contributorCell(of, shared, limits),
      cell("Most of", "wide", element("a", { class: "row-button", href: `#number-${response.index}` }, response.name)),
      cell("Share", "num", percent(share)),
      cell("Of its variance", "", shareDrawing(share)),
      cell("At the lower limit", "num", withUnit(change(response, effect.at_lower), response.unit)),
      cell("At the upper limit", "num", withUnit(change(response, effect.at_upper), response.unit)),
      cell("And of", "whole", more.join(", ") || "\u2013"));
  });
  return tableOf("What contributes", headings, rows);
}

function contributors(responses, answer, section) {
  const { kept, dropped } = contributorsOf(responses), limits = new Map(answer.tolerances.map((tolerance) => [tolerance.of, limitsOf(tolerance)]));
  if (!kept.length) return section("What moves them", "No tolerance changes any of these numbers.");
  const names = dropped.map(({ of, shared }) => contributorName(of, shared)), shown = names.slice(0, 5).join(", ") + (names.length > 5 ? ", \u2026" : "");
  const left = names.length ? ` Left out, with less than 0.1\u00a0% of every number\u2019s variance: ${shown} (${names.length}).` : "";
  return section("What moves them", `Worst first: by the share of what is missed most often.${left}`, contributorTable(kept, limits));
}

const capabilities = { cp: "Cp", cpk: "Cpk" };

// Predictions, the search and the samples, a row each.
function numbersTable(r) {
  const { linear, second_order: second, sampled } = r, judged = isJudged(r), capable = ["cp", "cpk"].filter((key) => sampled?.[key]);
  const small = (text) => element("small", {}, text), told = (si, digits) => (si === undefined ? "\u2013" : amount(r, si, digits));
  const found = (extreme) => (extreme && extreme.value !== null ? [amount(r, extreme.value), extreme.settled ? null : small("ended early")] : ["\u2013"]);
  const row = (name, { mean, standard_deviation: sigma }, least, most, yieldOf, indices = {}) => element("tr", {}, element("td", {}, name),
    cell("Mean", "num", told(mean)), cell("Sigma", "num", told(sigma)), cell("Least", "num", ...least), cell("Largest", "num", ...most), judged ? cell("Yield", "num wide", yieldOf) : null,
    ...capable.map((key) => cell(capabilities[key], "num", indices[key] ? `${number(indices[key].value, 3)} \u00b1 ${number(indices[key].error, 2)}` : "\u2013")));
  const rows = [row("linear prediction", linear, [told(linear.worst_least, 3)], [told(linear.worst_most, 3)], yieldWords(linear.yield))];
  if (second) rows.push(row("second order", second, ["\u2013"], ["\u2013"], second.yield ? yieldWords(second.yield) : "not known, far from normal"));
  if (r.least_found || r.most_found) rows.push(row("worst cases found by simulations", {}, found(r.least_found), found(r.most_found), "\u2013"));
  if (sampled) rows.push(row("samples", sampled, [told(sampled.least, 4), small(`sample ${sampled.least_sample}`)], [told(sampled.most, 4), small(`sample ${sampled.most_sample}`)], yieldWords(sampled.yield), sampled));
  return tableOf(`Numbers of ${r.name}`, [["By"], ["Mean", "num"], ["Sigma", "num"], ["Least", "num"], ["Largest", "num"], ...(judged ? [["Yield", "num"]] : []), ...capable.map((key) => [capabilities[key], "num"])], rows);
}

function notesOn(r) {
  const { sampled } = r, failure = [r.least_found, r.most_found].find((extreme) => extreme?.failure)?.failure;
  const notes = [];
  if (failure) notes.push(`Within the limits there is one that cannot be simulated: ${failure.reason}.`);
  if (r.is_rough) notes.push("Its derivatives change too much within a standard deviation for a prediction, as where a contact begins.");
  if (sampled && sampled.unexplained > muchUnexplained)
    notes.push(`Predictions miss the samples by ${percent(sampled.unexplained)} of their sigma, most (${amount(r, sampled.farthest_from_prediction)}) in sample ${sampled.farthest_sample}.`, ...r.contacts.map((text) => `In sample ${sampled.farthest_sample}: ${text}.`));
  return notes.length ? element("ul", { class: "plain-list" }, ...notes.map((text) => element("li", {}, text))) : null;
}

// What each tolerance alone, at its limits, moves it by: the one that moves it farthest first.
function tornado(r, limits) {
  const reachOf = ({ effect }) => Math.max(Math.abs(effect.at_lower), Math.abs(effect.at_upper));
  const all = r.contributions.map((c, k) => ({ ...c, effect: r.effects[k] })).filter((each) => reachOf(each) > 0).sort((a, b) => reachOf(b) - reachOf(a));
  if (!all.length) return element("p", { class: "section-intro" }, "No tolerance changes it.");
  const kept = all.filter((each, k) => k === 0 || each.share >= dust).slice(0, mostBars), reach = reachOf(kept[0]), unit = r.unit ? ` [${r.unit}]` : "";
  const rows = kept.map((each) => element("tr", {},
    contributorCell(each.of, each.effect.shared, limits),
    cell("At the lower limit", "num", change(r, each.effect.at_lower)),
    cell("It moves", "drawing", effectDrawing(each.effect, reach)),
    cell("At the upper limit", "num", change(r, each.effect.at_upper)),
    cell("Share", "num", percent(each.share))));
  const table = tableOf(`What each tolerance, alone at its limits, moves ${r.name} by`, [["What moves it"], [`At the lower limit${unit}`, "num"], ["It moves"], [`At the upper limit${unit}`, "num"], ["Share of the variance", "num"]], rows);
  if (kept.length < all.length) table.append(element("p", { class: "section-intro" }, `${plural(all.length - kept.length, "tolerance moves", "tolerances move")} it less.`));
  return table;
}

function ofResponse(r, data, limits, section) {
  const unit = r.unit, judged = isJudged(r), inUnit = (values) => Float64Array.from(values, (v) => v / r.scale), { tolerances } = data.answer;
  const figures = element("div", { class: "figures" }), values = inUnit(r.values);
  const made = section(r.name, `${amount(r, r.nominal)} as drawn${r.required ? `, required ${r.required}` : ""}.`, numbersTable(r), notesOn(r) ?? "", tornado(r, limits), figures);
  made.id = `number-${r.index}`;
  const bounds = [["at least", r.lower], ["at most", r.upper]].filter(([, v]) => v !== null).map(([name, v]) => ({ name, kind: "limit", value: v / r.scale }));
  const drawn = [{ name: "as drawn", kind: "drawn", value: r.nominal / r.scale }, ...(r.sampled ? [{ name: "mean", kind: "mean", value: r.sampled.mean / r.scale }] : [])];
  const bins = histogram(figures, { name: r.name, unit, values: values.filter((v) => !Number.isNaN(v)), predicted: inUnit(r.predicted), predictedName: r.second_order ? "second-order prediction" : "linear prediction", marks: [...drawn, ...bounds] });
  const first = tolerances.findIndex(({ of }) => of === r.contributions.find((c, k) => !r.effects[k].shared && c.sensitivity !== 0)?.of), xs = data.deviations[first];
  if (xs && r.sampled) scatter(figures, { name: r.name, unit, xName: tolerances[first].of, xUnit: tolerances[first].unit, xs, ys: values, met: r.met, numbers: data.samples, marks: bounds, judged });
  return bins;
}

function toleranceTable(tolerances) {
  const grouped = tolerances.some((tolerance) => tolerance.group);
  const rows = tolerances.map((t) => element("tr", {},
    element("td", {}, t.of), cell("Stated", "", ...wholeWords(t.stated)), cell("Limits", "num", limitsOf(t)), cell("Distribution", "", t.distribution),
    cell("Sigma", "num", withUnit(number(t.standard_deviation, 4), t.unit)), grouped ? cell("Shares with", "", t.group ?? "\u2013") : null));
  return tableOf("Tolerances", [["Of"], ["Stated"], ["Limits", "num"], ["Distribution"], ["Sigma", "num"], ...(grouped ? [["Shares with"]] : [])], rows);
}

function failureTable(failed) {
  const rows = failed.slice(0, mostFailures).map(({ sample, reason }) => element("tr", {}, element("td", {}, `sample ${sample}`), cell("Why", "whole", reason)));
  const table = tableOf("Samples that could not be made or simulated", [["Sample"], ["Why"]], rows);
  if (failed.length > rows.length) table.append(element("p", { class: "section-intro" }, `${failed.length - rows.length} more are in the answer of --json.`));
  return table;
}

// Answers the bins of each number's histogram, in the answer's order.
export function showTolerances(data, section) {
  const { answer } = data, responses = worstFirst(responsesOf(data)), limits = new Map(answer.tolerances.map((t) => [t.of, limitsOf(t)])), bins = [];
  if (responses.length) {
    section("All at a glance", "Worst first. Each has its own part below, in this order.", atAGlance(responses, answer.samples.count > 0));
    contributors(responses, answer, section);
    for (const r of responses) bins[r.index] = ofResponse(r, data, limits, section);
  }
  if (answer.failed.length) section("Samples that could not be made or simulated", "They count as misses of every requirement.", failureTable(answer.failed));
  section("Tolerances", "What deviates, by how much.", toleranceTable(answer.tolerances));
  section("As text", null, element("details", {}, element("summary", {}, "All of it as text"), element("pre", {}, data.text)));
  return { bins };
}
