// SPDX-License-Identifier: MIT
// Charts of how a number spreads over its tolerances: a histogram of samples with its prediction and limits, samples over one tolerance.
import { canvasChart, css, frame, nearest, rule, span } from "./chart.js";
import { element } from "./dom.js";
import { number, percent, plural, withUnit } from "./numbers.js";

// What a mark, a bar or a dot is drawn in: by the style sheet's names.
const inks = { drawn: { colour: "--ink", dash: [] }, mean: { colour: "--accent", dash: [2, 3] }, limit: { colour: "--bad", dash: [6, 4] } };
const predictedBins = 60;

// A line of a legend: a swatch of this kind (style.css), and what it stands for.
const key = (kind, words) => element("li", { class: "key" }, element("i", { class: kind }), words);
// Of a mark that the chart, from low to high, does not reach, it says on which side it lies.
const markKey = (mark, unit, [low, high], [below, above]) => {
  const side = mark.value < low ? ` ${below}` : mark.value > high ? ` ${above}` : "";
  return key(`upright ${mark.kind}`, `${mark.name} ${withUnit(number(mark.value), unit)}${side}`);
};

function figureOf(parent, title, summary, keys) {
  const holder = element("div", { class: "chart", role: "img", "aria-label": summary });
  parent.append(element("figure", {}, element("figcaption", {}, element("h3", {}, title)), holder, element("ul", { class: "legend" }, ...keys)));
  return holder;
}

// Marks that are no farther off than the values spread: a chart shows these.
const near = (marks, least, most) => marks.map((mark) => mark.value).filter((v) => v > least - (most - least) && v < most + (most - least));

// Freedman and Diaconis' width, of which there are 8 to 40.
function binCount(sorted) {
  const n = sorted.length, middle = sorted[Math.min(n - 1, Math.floor((3 * n) / 4))] - sorted[Math.floor(n / 4)];
  const width = (2 * middle) / Math.cbrt(n);
  return width > 0 ? Math.min(40, Math.max(8, Math.ceil((sorted[n - 1] - sorted[0]) / width))) : 8;
}

// The share of a distribution below v, of its quantiles: evenly from the least to the largest.
function shareBelow(quantiles, v) {
  const last = quantiles.length - 1;
  if (v < quantiles[0]) return 0;
  if (v >= quantiles[last]) return 1;
  let low = 0, high = last;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (quantiles[middle] <= v) low = middle;
    else high = middle;
  }
  return (low + (v - quantiles[low]) / (quantiles[high] - quantiles[low])) / last;
}

// {from, width, found, wanted: shares by bin}, from low to high.
function binned(sorted, predicted, low, high) {
  const [least, most] = sorted.length ? [sorted[0], sorted[sorted.length - 1]] : [predicted[0], predicted[predicted.length - 1]], spread = most - least;
  const width = spread > 0 ? spread / (sorted.length ? binCount(sorted) : predictedBins) : (high - low) / 20;
  const from = least - (spread > 0 ? 0 : width / 2) - width * Math.ceil((least - low) / width), count = Math.max(1, Math.ceil((high - from) / width));
  const found = new Float64Array(count), wanted = new Float64Array(count);
  for (const v of sorted) found[Math.min(count - 1, Math.floor((Math.min(v, most - 1e-9 * spread) - from) / width))] += 1 / sorted.length;
  if (predicted.length) wanted.forEach((_, k) => (wanted[k] = shareBelow(predicted, from + width * (k + 1)) - shareBelow(predicted, from + width * k)));
  return { from, width, found, wanted };
}

// values: samples that could be simulated; predicted: quantiles of the prediction; either may be empty. marks: [{name, kind, value}].
// Answers the bins; null where there is nothing to draw.
export function histogram(parent, { name, unit, values, predicted, predictedName, marks }) {
  const sorted = Float64Array.from(values).sort(), of = sorted.length ? sorted : predicted;
  if (!of.length) return null;
  const [low, high] = span([of[0], of[of.length - 1], ...near(marks, of[0], of[of.length - 1])]), bins = binned(sorted, predicted, low, high);
  const keys = [sorted.length ? key("box bin", plural(sorted.length, "sample")) : null, predicted.length ? key("curve", predictedName) : null, ...marks.map((mark) => markKey(mark, unit, [low, high], ["\u2190", "\u2192"]))];
  const range = `from ${number(of[0])} to ${withUnit(number(of[of.length - 1]), unit)}`;
  const holder = figureOf(parent, sorted.length ? "How it came out" : "How it comes out, by the prediction", `${name}, ${range}; ${marks.map((mark) => `${mark.name} ${withUnit(number(mark.value), unit)}`).join(", ")}`, keys.filter(Boolean));
  const tallest = 100 * Math.max(...bins.found, ...bins.wanted), at = (k) => bins.from + bins.width * k;
  let place;
  const chart = canvasChart(holder, 270, (c, width, height) => {
    place = frame(c, width, height, [low, high], [0, 1.08 * tallest], unit ? `${name} [${unit}]` : name, `share of ${sorted.length ? "the samples" : "what is made"} [%]`);
    const inside = (v) => Math.min(place.left + place.w, Math.max(place.left, place.x(v)));
    c.fillStyle = css("--accent");
    c.globalAlpha = 0.55;
    bins.found.forEach((share, k) => share > 0 && c.fillRect(inside(at(k)) + 0.5, place.y(100 * share), inside(at(k + 1)) - inside(at(k)) - 1, place.y(0) - place.y(100 * share)));
    c.globalAlpha = 1;
    marks.forEach((mark) => rule(c, place, "x", mark.value, inks[mark.kind].colour, inks[mark.kind].dash));
    if (!predicted.length) return;
    c.strokeStyle = css("--curve");
    c.lineWidth = 1.75;
    c.beginPath();
    bins.wanted.forEach((share, k) => c.lineTo(inside(at(k + 0.5)), place.y(100 * share)));
    c.stroke();
    c.lineWidth = 1;
  });
  chart.canvas.addEventListener("pointermove", (event) => {
    const x = event.clientX - chart.canvas.getBoundingClientRect().left, k = bins.found.findIndex((_, n) => x >= place.x(at(n)) && x < place.x(at(n + 1)));
    const told = k < 0 ? [] : [sorted.length ? percent(bins.found[k]) : "", predicted.length ? `${percent(bins.wanted[k])} predicted` : ""].filter(Boolean);
    chart.canvas.title = k < 0 ? "" : `${told.join(", ")} from ${number(at(k))} to ${withUnit(number(at(k + 1)), unit)}`;
  });
  return bins;
}

const dots = {
  met: (c, [x, y]) => {
    c.moveTo(x + 2.5, y);
    c.arc(x, y, 2.5, 0, 7);
  },
  missed: (c, [x, y]) => {
    c.moveTo(x - 3, y - 3);
    c.lineTo(x + 3, y + 3);
    c.moveTo(x + 3, y - 3);
    c.lineTo(x - 3, y + 3);
  },
  failed: (c, [x, y]) => {
    c.moveTo(x, y - 5);
    c.lineTo(x + 4, y + 3);
    c.lineTo(x - 4, y + 3);
    c.closePath();
  },
};

// Each sample: ys NaN of those that failed, which stand on the lower edge. numbers: what the samples are called.
export function scatter(parent, { name, unit, xName, xUnit, xs, ys, met, numbers, marks, judged }) {
  const kindOf = (i) => (Number.isNaN(ys[i]) ? "failed" : met[i] ? "met" : "missed"), all = Array.from(xs, (_, i) => i);
  const by = { met: [], missed: [], failed: [] };
  for (const i of all) by[kindOf(i)].push(i);
  const known = all.filter((i) => kindOf(i) !== "failed").map((i) => ys[i]), [least, most] = span(known, 0);
  const [low, high] = span([...known, ...near(marks, least, most)]), lower = low - (by.failed.length ? 0.09 * (high - low) : 0), across = span(xs);
  const words = { met: judged ? "met" : "sample", missed: "missed", failed: "could not be made or simulated" };
  const keys = Object.keys(by).filter((kind) => by[kind].length).map((kind) => key(`dot ${kind}`, `${words[kind]} (${by[kind].length})`));
  const holder = figureOf(parent, "By what moves it most", `Samples of ${name} over the deviation of ${xName}: ${Object.keys(by).filter((kind) => by[kind].length).map((kind) => `${by[kind].length} ${words[kind]}`).join(", ")}`, [...keys, ...marks.map((mark) => markKey(mark, unit, [low, high], ["\u2193", "\u2191"]))]);
  let place;
  const point = (i) => [place.x(xs[i]), Number.isNaN(ys[i]) ? place.top + place.h - 6 : place.y(ys[i])];
  const chart = canvasChart(holder, 270, (c, width, height) => {
    place = frame(c, width, height, across, [lower, high], `${xName} [${xUnit ? `${xUnit} ` : ""}from nominal]`, unit ? `${name} [${unit}]` : name);
    marks.forEach((mark) => rule(c, place, "y", mark.value, inks[mark.kind].colour, inks[mark.kind].dash));
    const inkOf = { met: "--accent", missed: "--bad", failed: "--open" };
    for (const kind of Object.keys(by)) {
      c.fillStyle = c.strokeStyle = css(inkOf[kind]);
      c.lineWidth = 1.4;
      c.globalAlpha = kind === "met" ? 0.6 : 1;
      c.beginPath();
      for (const i of by[kind]) dots[kind](c, point(i));
      if (kind === "met") c.fill();
      else c.stroke();
    }
    c.globalAlpha = c.lineWidth = 1;
  });
  chart.canvas.addEventListener("pointermove", (event) => {
    const box = chart.canvas.getBoundingClientRect(), i = nearest(all, point, event.clientX - box.left, event.clientY - box.top, 12);
    chart.canvas.title = i < 0 ? "" : `sample ${numbers[i]}: ${kindOf(i) === "failed" ? words.failed : `${withUnit(number(ys[i]), unit)} with ${withUnit(number(xs[i]), xUnit)}`}`;
  });
}
