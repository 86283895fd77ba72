// SPDX-License-Identifier: MIT
// What charts on a canvas of their own need: one that follows its place's size and the colours, ticks, shades of a value.
import { numberInSteps } from "./numbers.js";

export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const charts = [];
export const repaintCharts = () => charts.forEach((chart) => chart.repaint());

// Calls draw(context, width, height) in pixels of the page, now, after repaint(), and whenever its place changes.
export function canvasChart(parent, height, draw) {
  const canvas = document.createElement("canvas");
  parent.append(canvas);
  let asked = 0;
  const repaint = () => {
    asked ||= requestAnimationFrame(() => {
      asked = 0;
      const ratio = Math.min(2, devicePixelRatio || 1), width = parent.clientWidth;
      if (!width) return;
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      canvas.style.height = `${height}px`;
      const context = canvas.getContext("2d");
      context.scale(ratio, ratio);
      context.font = `12px ${css("--font")}`;
      draw(context, width, height);
    });
  };
  new ResizeObserver(repaint).observe(parent);
  charts.push({ repaint });
  return { canvas, repaint };
}

const mostTicks = 50;

// About `count` round numbers from low to high, each {value, text}: with as many digits as tell one from the next.
export function ticks(low, high, count) {
  const rough = (high - low) / count, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((each) => each >= rough) ?? rough, found = [];
  const first = Math.ceil(low / step - 1e-9), more = Math.floor(high / step + 1e-9) - first;
  for (let n = 0; n <= Math.min(more, mostTicks - 1); ++n) {  // counted by n: past 2^53, first + 1 may be first
    const value = (first + n) * step;
    found.push({ value, text: numberInSteps(value, step) });
  }
  return found;
}

// The two ends of an axis, as texts.
export const endTexts = ([low, high]) => [low, high].map((v) => numberInSteps(v, (high - low) / 100));

const leastSpan = 1e-9;  // of the numbers themselves: what differs by less is one number

// Of numbers, with some room; of one alone round it.
export function span(values, room = 0.04) {
  let low = Infinity, high = -Infinity;
  for (const v of values) {
    if (!Number.isFinite(v)) continue;
    low = Math.min(low, v);
    high = Math.max(high, v);
  }
  if (!(low <= high)) return [0, 1];
  const apart = high - low > leastSpan * Math.max(Math.abs(low), Math.abs(high));
  const more = apart ? room * (high - low) : Math.abs(low) * 0.05 || 1;
  return [low - more, high + more];
}

// Draws the axes of a chart of two numbers, with lines at round ones. Answers where values lie: {x(v), y(v), left, top, w, h}.
export function frame(c, width, height, [x0, x1], [y0, y1], xName, yName) {
  const right = 16, top = 26, bottom = 44, up = ticks(y0, y1, 6), left = Math.max(56, ...up.map(({ text }) => 14 + c.measureText(text).width));
  const w = width - left - right, h = height - top - bottom, across = ticks(x0, x1, Math.max(2, w / 90));
  const place = { x: (v) => left + (w * (v - x0)) / (x1 - x0), y: (v) => top + h * (1 - (v - y0) / (y1 - y0)), left, top, w, h };
  c.strokeStyle = css("--line");
  c.fillStyle = css("--muted");
  c.textAlign = "center";
  for (const { value, text } of across) {
    c.fillText(text, Math.min(place.x(value), width - c.measureText(text).width / 2), height - 24);
    line(c, [place.x(value), top], [place.x(value), top + h]);
  }
  c.textAlign = "right";
  for (const { value, text } of up) {
    c.fillText(text, left - 8, place.y(value) + 4);
    line(c, [left, place.y(value)], [left + w, place.y(value)]);
  }
  c.fillText(xName, left + w, height - 6, left + w);
  c.textAlign = "left";
  c.fillText(yName, 0, 14, width);
  return place;
}

function line(c, from, to) {
  c.beginPath();
  c.moveTo(...from);
  c.lineTo(...to);
  c.stroke();
}

// A line across a chart at a value of "x" or "y", where the chart has it: what is required, unless it is told otherwise.
export function rule(c, place, axis, value, colour = "--bad", dash = [6, 4]) {
  const at = place[axis](value), beyond = axis === "x" ? at < place.left || at > place.left + place.w : at < place.top || at > place.top + place.h;
  if (beyond) return;
  c.strokeStyle = css(colour);
  c.setLineDash(dash);
  if (axis === "x") line(c, [at, place.top], [at, place.top + place.h]);
  else line(c, [place.left, at], [place.left + place.w, at]);
  c.setLineDash([]);
}

// Number of the item of `at` (index -> [x, y] in pixels or null) nearest to a point, within `far` pixels; -1: none.
export function nearest(indices, at, x, y, far) {
  let best = -1, least = far * far;
  for (const i of indices) {
    const p = at(i);
    if (!p) continue;
    const d = (p[0] - x) ** 2 + (p[1] - y) ** 2;
    if (d < least) [best, least] = [i, d];
  }
  return best;
}

const ramp = [[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [226, 213, 70]];  // as viridis has it: light for much, any colour vision

export function shadeOf(share) {
  const at = Math.min(0.999, Math.max(0, share)) * (ramp.length - 1), k = Math.floor(at), s = at - k;
  return `rgb(${ramp[k].map((c, i) => Math.round(c + s * (ramp[k + 1][i] - c))).join(" ")})`;
}
