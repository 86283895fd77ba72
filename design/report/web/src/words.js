// SPDX-License-Identifier: MIT
// The verdict in words: what was asked, what was reached, what of it is proven. What is not proven is not told as if it were.
import { Designs } from "./designs.js";
import { lowerBound, number, percent, plural, upperBound, withUnit } from "./numbers.js";

const mm = (text) => withUnit(text, "mm");

// Do its bodies share material?
export const isShared = (pair) => pair.finding === "clash";

// Two proven bounds of a number, as short as they allow.
function range(bounds, unit) {
  if (!bounds || bounds.upper === null) return "";
  const low = lowerBound(bounds.lower, 3), high = upperBound(bounds.upper, 3);
  if (!(bounds.lower > 0)) return `\u2264\u00a0${withUnit(high, unit)}`;
  return low === high ? withUnit(low, unit) : `${low} to ${withUnit(high, unit)}`;
}
export const depthRange = (pair) => range(pair.depth, "mm");
export const volumeRange = (pair) => range(pair.volume, "mm\u00b3");
export const depthWords = (pair) => (depthRange(pair) ? `${depthRange(pair)} deep` : "depth not measured");

export const isTouching = (pair) => pair.finding === "touching";
// "touching over 100 mm^2, accepted".
export function touchWords(pair) {
  const t = pair.touching;
  if (!t) return "touching";
  const over = t.area > 0 || t.at_least ? `over ${t.at_least ? "at least " : ""}${withUnit(number(t.area, 4), "mm\u00b2")}` : "in edges and points";
  return `touching ${over}${t.allowed ? ", accepted" : ""}`;
}
export const acceptWords = (pair) => `if they are meant to touch, --allow-touch ${pair.a}:${pair.b} accepts it`;

export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);
const sentence = (text) => `${capital(text)}.`;

const list = (names) => (names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} and ${names[names.length - 1]}`);
const some = (names, most = 3) => (names.length <= most ? list(names) : `${names.slice(0, most).join(", ")} and ${names.length - most} more`);

// Names of pairs have an "and" of their own.
const somePairs = (names, most = 3) => (names.length <= most ? names.join("; ") : `${names.slice(0, most).join("; ")}; and ${names.length - most} more`);

export function asked(data) {
  if (data.description) return data.description;
  if (data.kind === "studio") return "";
  if (data.kind === "explore") return "An exploration of a design space.";
  if (data.kind === "tolerance") return "What becomes of the design when its parts are made.";
  if (data.kind === "optimise")
    return `Change ${plural(data.parameters.length, "parameter")} so that ${plural(data.requirements.length, "requirement")} ${data.requirements.length === 1 ? "is" : "are"} met and the objective is least.`;
  if (data.ranges) return "Certified clearances over all positions of the joints within their limits, in every combination.";
  if (data.status === "shown") return "A look at the parts.";
  if (data.kind === "clearance") return data.motion ? "Certified clearances over the motion." : "Certified clearances as assembled.";
  return "A simulation of the mechanism.";
}

// What the verdicts on requirements rest on: not every number is proven.
function byWhat(data) {
  const proven = data.requirements.filter((r) => r.proven).length, count = data.requirements.length;
  if (proven === count) return count === 1 ? "by a proven bound" : "by proven bounds";
  if (!proven) return count === 1 ? "by a computed value" : "by computed values";
  return `${proven} by ${proven === 1 ? "a proven bound" : "proven bounds"} and ${count - proven} by ${count - proven === 1 ? "a computed value" : "computed values"}`;
}

const unmet = (data) => data.requirements.filter((r) => !r.met).map((r) => r.name);

// Requirements that are met as simulated, and not with the play of the fits taken up: in which way, and what to do.
function doubts(data) {
  const doubted = data.requirements.filter((r) => r.in_doubt);
  if (!doubted.length) return "";
  const values = list(doubted.map((r) => `${r.name} is ${withUnit(number(r.play_taken_up, 5), r.unit)}`));
  return ` In doubt: with the play of the fits taken up, parts in the middle of them, ${values}, which is not what is required. A real mechanism may do either: put into the scene what decides where its parts lie (gravity, friction, a spring), make the fits tighter, or allow for both.`;
}

function optimised(data) {
  const told = verdict(data), doubt = doubts(data);
  if (!doubt) return told;
  return { tone: told.tone === "good" ? "open" : told.tone, head: told.head.replace(/\.$/, ", in doubt."), rest: told.rest + doubt };
}

// What the terminal says (design/answers/summary.hpp); of an answer that an earlier program left, its status.
function verdict(data) {
  const tone = { optimal: "good", infeasible: "bad", feasible: "open", interrupted: "open" }[data.status] ?? "bad";
  const { sentence: head, why } = data.summary ?? { sentence: sentence(data.status), why: data.why_not_optimal };
  const shared = data.pairs.filter(isShared).length, bad = unmet(data);
  const rest = [
    data.requirements.length && !bad.length ? `Judged ${byWhat(data)}.` : "",
    bad.length ? `Not met: ${some(bad)}.` : "",
    shared ? `${sentence(plural(shared, "interference"))}` : "",
    data.repair ? `The change of the file's values is ${number(data.repair.distance, 3)} of the ranges between their bounds.` : "",
    why ? sentence(why) : "",
  ];
  return { tone, head, rest: rest.filter(Boolean).join(" ") };
}

function simulated(data) {
  switch (data.status) {
    case "ok":
      if (data.message) return { tone: "good", head: "Simulated to the end.", rest: `Surfaces stay at least ${mm(lowerBound(data.least))} apart over the whole continuous path: ${data.message}` };
      return data.least === null
        ? { tone: "good", head: "Simulated to the end.", rest: "No two bodies of it may collide, so that there was nothing to prove." }
        : { tone: "good", head: "Simulated to the end, and proven never to touch.", rest: `Bodies that may collide stay at least ${mm(lowerBound(data.least))} apart over the whole continuous path.` };
    case "not_certified":
      return { tone: "open", head: "Simulated to the end, not proven.", rest: "Every step was solved, but the path between is not certified." };
    case "interrupted":
      return { tone: "open", head: "Interrupted.", rest: "What is shown is as far as it came." };
    default:
      return { tone: "bad", head: { blocked: "Blocked.", not_held: "Not held.", not_converged: "Not converged.", energy_gained: "Energy from nowhere.", joints_part: "Joints part." }[data.status] ?? `${data.status}.`, rest: `It ended after ${plural(data.steps, "step")}.` };
  }
}

function cleared(data) {
  const pairs = data.pairs, required = pairs.filter((p) => p.minimum !== null), where = data.ranges ? "over all positions of the joints" : data.motion ? "over the whole motion" : "as assembled";
  const of = (status) => pairs.filter((p) => p.status === status);
  const names = (rows) => somePairs(rows.map((p) => `${p.a} and ${p.b}`));
  const shared = pairs.filter(isShared), close = of("violated").filter((p) => !isShared(p) && !isTouching(p));
  const against = pairs.filter((p) => isTouching(p) && p.status !== "contact");
  const over = against.length ? `${somePairs(against.map((p) => `${p.a} and ${p.b}${touchWords(p).replace("touching", "")}`))}; ${acceptWords(against[0])}.` : "", touch = over ? ` Touching: ${over}` : "";
  const total = data.pair_count ?? pairs.length;
  const touching = of("contact").filter((p) => p.finding === "touching").length;
  const pushing = of("contact").length - touching, judged = total - pushing - touching;
  const others = (touching ? ` ${plural(touching, "pair touches", "pairs touch")}, as is allowed.` : "")
    + (pushing ? ` The bodies of ${plural(pushing, "pair")} push each other: ${pushing === 1 ? "it is" : "they are"} not judged.` : "");
  switch (data.status) {
    case "shown":
      return { tone: "open", head: data.motion ? "Parts and their motion." : "Parts as assembled.", rest: data.message };
    case "clear":
      return required.length
        ? { tone: "good", head: "Clear, and proven.", rest: `${plural(judged, "pair keeps", "pairs keep")} the required clearance ${where}.${others}` }
        : { tone: "good", head: "No clash, proven.", rest: `The distances of ${plural(total, "pair")} are bounded ${where}; no minimum was asked for.` };
    case "violated":
      if (shared.length) {
        const deep = somePairs(shared.map((p) => `${p.a} and ${p.b}${depthRange(p) ? ` (${depthWords(p)})` : ""}`));
        return { tone: "bad", head: `${plural(shared.length, "interference")} ${where}.`, rest: `${shared.length === 1 ? "Two parts share" : "Parts share"} material: ${deep}.${close.length ? ` Too close: ${names(close)}.` : ""}${touch}` };
      }
      if (!close.length && over) return { tone: "bad", head: "Touching.", rest: `Faces lie on each other ${where}: ${over}` };
      return { tone: "bad", head: "Too close.", rest: `Nearer than required ${where}: ${names(close)}.${touch}` };
    default:
      return { tone: "open", head: "Undecided.", rest: of("undecided").length ? `Not settled ${where}: ${names(of("undecided"))}.${touch}` : "Nothing was judged, or not to the end." };
  }
}

function explored(data) {
  const met = data.designs.filter((design) => design.met).length, all = data.designs.length;
  const without = data.designs.filter((design) => ["unusable", "failed", "lost"].includes(design.status)).length;
  const rest = `${plural(all, "design")} of ${plural(data.columns.filter((c) => c.group === "parameter").length, "parameter")}.${without ? ` ${plural(without, "design has", "designs have")} no numbers: they cannot be built or simulated.` : ""}`;
  if (!met) return { tone: "bad", head: "No design meets every requirement.", rest };
  return { tone: "good", head: `${plural(met, "design meets", "designs meet")} every requirement.`, rest };
}

// The requirement that a design's violation is of, in whose unit it is; null where that is not known, as of one without bounds in the file.
function violatedOf(designs, i) {
  const violation = designs.of("violation")[0].column.values[i];
  const over = ({ column }) => Math.max(column.lower === null ? -Infinity : column.lower - column.values[i], column.upper === null ? -Infinity : column.values[i] - column.upper);
  const found = designs.of("constraint").find((each) => Math.abs(over(each) - violation) <= 1e-3 * violation);
  return found ? { name: found.column.name, unit: found.column.unit } : null;
}

function exploredFacts(data) {
  const rows = [["Designs", String(data.designs.length), "in this file"], ["Meet everything", String(data.designs.filter((d) => d.met).length), "clearances by proven bounds"]];
  if (!data.designs.length) return rows;
  const designs = new Designs(data), [best] = designs.bestFirst(), of = (group) => designs.of(group)[0].column.values[best];
  if (best === undefined) return rows;
  if (data.designs[best].met) rows.push(["Least objective", number(of("objective")), "of those that meet everything"]);
  else rows.push(["Least violation", withUnit(number(of("violation")), violatedOf(designs, best)?.unit), `${violatedOf(designs, best) ? `${violatedOf(designs, best).name} ` : ""}of design ${best + 1}, whose objective is ${number(of("objective"))}`]);
  return rows;
}

// "99.3 % (98.1 % to 99.8 %)": predicted, or counted with its interval.
export const yieldWords = (found) => (found ? percent(found.within, 4) + (found.least === undefined ? "" : ` (${percent(found.least, 4)} to ${percent(found.most, 4)})`) : "\u2013");

// Is something required of a number of a study of tolerances?
export const isJudged = (response) => response.lower !== null || response.upper !== null;

function made(data) {
  const { responses, samples, message } = data.answer;
  if (!responses.length) return { tone: "open", head: "Undecided.", rest: message };
  if (samples.count) {
    const failed = samples.failed ? ` ${plural(samples.failed, "sample")} could not be made or simulated.` : "";
    const rest = `\u2013 a yield of ${yieldWords(samples.yield)} at ${percent(samples.yield.confidence)} confidence.${failed}`;
    return { tone: samples.met === samples.count ? "good" : "open", head: `${samples.met} of ${samples.count} samples meet every requirement`, rest };
  }
  const worst = responses.filter(isJudged).sort((a, b) => a.linear.yield.within - b.linear.yield.within)[0];
  if (!worst) return { tone: "open", head: "No requirement is at stake.", rest: "" };
  return { tone: "open", head: "Predicted, not sampled.", rest: `${worst.name} is met least often: by the linear prediction in ${yieldWords(worst.linear.yield)} of what is made.` };
}

function madeFacts(data) {
  const { tolerances, samples, responses, process } = data.answer, cpk = (r) => r.sampled?.cpk?.value ?? Infinity;
  const rows = [["Tolerances", String(tolerances.length), process ? `process ${process}` : ""]];
  if (samples.count) rows.push(["Samples", String(samples.count), `seed ${samples.seed}`]);
  const least = responses.reduce((best, r) => (cpk(r) < cpk(best) ? r : best), {});
  if (least.name) rows.push(["Least Cpk", number(cpk(least), 3), least.name]);
  const controlled = samples.controlled_yield;
  if (controlled) rows.push(["Yield, prediction as control", percent(controlled.within, 4), `${percent(controlled.least, 4)} to ${percent(controlled.most, 4)}`]);
  return rows;
}

// {tone: "good" | "open" | "bad", head, rest}
export function reached(data) {
  return { optimise: optimised, simulate: simulated, clearance: cleared, explore: explored, tolerance: made, studio: () => ({ tone: "open", head: "Computing \u2026", rest: "" }) }[data.kind](data);
}

// [term, value, small print]
export function facts(data) {
  if (data.kind === "explore") return exploredFacts(data);
  if (data.kind === "tolerance") return madeFacts(data);
  if (data.kind === "studio") return [];
  const rows = [];
  if (data.kind === "optimise" && data.objective.end !== null) {
    rows.push(["Objective", number(data.objective.end), data.objective.start !== null ? `from ${number(data.objective.start)} at the start` : "the start could not be evaluated"]);
    rows.push(["Requirements met", `${data.requirements.filter((r) => r.met).length} of ${data.requirements.length}`, data.requirements.length ? byWhat(data) : ""]);
  }
  const shared = data.pairs.filter(isShared), apart = data.pairs.filter((p) => !isShared(p));
  if (shared.length) {
    const deepest = shared.reduce((most, p) => ((p.depth?.upper ?? 0) > (most.depth?.upper ?? 0) ? p : most));
    rows.push(["Interferences", String(shared.length), deepest.depth ? `the deepest ${depthRange(deepest)}` : "depth not measured", "bad"]);
  }
  const least = data.kind === "simulate" ? data.least : Math.min(...apart.map((p) => p.lower ?? Infinity));
  if (least !== null && Number.isFinite(least)) rows.push(["Least clearance", `\u2265\u00a0${mm(lowerBound(least))}`, data.kind === "simulate" && data.status !== "ok" ? "as far as it is proven" : shared.length || data.pairs.some(isTouching) ? "of the other pairs, proven" : "proven"]);
  if (data.kind === "optimise") rows.push(["Simulations", String(data.evaluations), data.failed ? `${data.failed} of them failed` : "none failed"]);
  else if (data.motion) rows.push(["Motion", `${number(data.duration, 4)}\u00a0s`, plural(data.steps, "step")]);
  if (data.kind === "clearance" && data.status !== "shown") rows.push(["Pairs", String(data.pair_count ?? data.pairs.length), data.ranges ? "over the joints\u2019 ranges" : data.motion ? "over the motion" : "as assembled"]);
  const bodies = data.views[0]?.bodies ?? [], free = bodies.filter((body) => body.type !== "static").length;
  if (data.kind !== "optimise") rows.push(["Parts", String(bodies.length), free ? `${free} of them not fixed` : data.motion ? "all fixed" : "as they lie"]);
  return rows;
}

// What the files beside the page are for.
export const fileWords = {
  "motion.glb": "the animation, for browsers, Blender and slicers",
  "design.final.json": "the design as it ended, to go on from",
  "trajectory.json": "parts and motion, for every other command",
  "result.json": "this answer, for programs",
};

// What is proven, and what is not.
export function provenWords(data) {
  if (data.kind === "tolerance") return "Predictions and samples are computed; nothing here is proven, but the clearance of each sample by itself.";
  if (data.kind === "explore") return "Proven: that a design meets its requirements of clearance is judged by certified bounds; others are judged by computed values. Values in the curves are what was measured; the parts are shown at the start of their motion.";
  if (data.status === "shown") return "Nothing is proven here. Lengths in mm.";
  const where = data.ranges ? "over all positions of the joints within their limits" : data.motion || data.kind === "studio" ? "over the whole continuous motion" : "for the parts as they lie";
  return `Proven: a bound that holds ${where}, of the meshes as stored, rounding included; not a figure from samples. Numbers called computed, pictures and curves of forces are not proofs: they have the error of the time step and of facets. Lengths in mm.`;
}

// The simulations of the check of resolution, by their names in the answer.
const finerRuns = { finer_facets: "with twice the facets", finer_steps: "with half the time step" };
export const finerName = ({ run }) => finerRuns[run] ?? run;
export const resolutionIntro = ({ runs }) => `The final design, simulated once more ${list(runs.map(finerName))}${runs.length > 1 ? ", each by itself" : ""}: an estimate of the error of these numbers, not a bound.`;

// Is a logarithmic scale wanted?
export const spansMuch = (numbers) => Math.min(...numbers) > 0 && Math.max(...numbers) > 100 * Math.min(...numbers);

export function startsIntro(data) {
  const met = data.starts.filter((s) => s.violation !== null && s.violation <= 0).length, total = data.starts.length;
  const same = data.starts.filter((s) => !s.taken && s.away !== null && s.away < 0.01).length;
  const again = same ? ` ${plural(same, "other start")} ended within a hundredth of the ranges of the one that was taken.` : "";
  const shown = data.starts.map((s) => (data.repair ? s.distance : s.objective)).filter((x) => x !== null);
  const scale = spansMuch(shown) ? ", by its logarithm" : "";
  return `${met} of ${plural(total, "start")} met all requirements; the one taken is the first. The dot: its ${data.repair ? "change" : "objective"} between the least and the greatest${scale}, open where requirements are violated. Away: the largest difference of a parameter from the one taken, of its range.${again}`;
}

export const startName = (start) => (start.seed === 0 ? "the file\u2019s values" : `random, seed ${start.seed}`);

// What holds a parameter, as people say it.
export const heldWords = {
  "lower bound": "its lower bound",
  "upper bound": "its upper bound",
  constraints: "requirements",
  stationary: "the objective: least here",
  nothing: "nothing",
};
