// SPDX-License-Identifier: MIT
// What a parameter does to a number, by its derivative: in words, with whether that is wanted.
import { number, withUnit } from "./numbers.js";

// About a hundredth of a range, as 1, 2 or 5 times a power of ten.
export function stepOf({ lower, upper }) {
  const rough = Math.abs(upper - lower) / 100 || 0.01, power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((k) => k * power).reduce((best, each) => (Math.abs(Math.log(each / rough)) < Math.abs(Math.log(best / rough)) ? each : best));
}

export const signed = (x, digits = 3) => (x > 0 ? `+${number(x, digits)}` : number(x, digits));

// The number by which a row of requirements is judged: the end of its range that is nearer to what is required. null: not known.
export function judged({ lower, upper, required_lower: low, required_upper: high }) {
  if (lower === null || upper === null) return lower ?? upper;
  return (high ?? Infinity) - upper < lower - (low ?? -Infinity) ? upper : lower;
}

// Which way a requirement is better: 1: more, -1: less, 0: neither. Of an objective less.
export function betterSide(row) {
  if (row.isObjective) return -1;
  const value = judged(row), { required_lower: low, required_upper: high } = row;
  if (low !== null && (high === null || value < low)) return 1;
  if (high !== null && (low === null || value > high)) return -1;
  return 0;
}

// How far a requirement is from what it asks for, beside the size of that; below 0: to spare.
export function lack(row) {
  if (row.lower === null && row.upper === null) return 0;
  const size = Math.max(Math.abs(row.required_lower ?? 0), Math.abs(row.required_upper ?? 0)) || 1;
  return Math.max(row.required_lower === null ? -Infinity : row.required_lower - row.lower, row.required_upper === null ? -Infinity : row.upper - row.required_upper) / size;
}

// {text, tone: "good" | "bad" | ""} of a step of a parameter; `slope`: of the row's number by the parameter's.
export function effectOf(parameter, row, slope) {
  const step = stepOf(parameter), whole = slope * step, isRounding = Math.abs(whole) < 1e-9 * Math.abs(judged(row) ?? 0), change = isRounding ? 0 : whole, side = Math.sign(change) * betterSide(row);
  const word = side > 0 ? ", better" : side < 0 ? ", worse" : "";
  return { text: `+${withUnit(number(step), parameter.unit)}: ${row.name} ${withUnit(signed(change), row.unit)}${word}`, tone: side > 0 ? "good" : side < 0 ? "bad" : "" };
}

// From where to where a number goes by its derivatives as parameters go between their bounds.
export function reachOf(parameters, values, by, value) {
  const ends = parameters.map(({ name, lower, upper }) => [lower, upper].map((bound) => (by[name] ?? 0) * (bound - values[name])));
  return [Math.min, Math.max].map((end) => ends.reduce((sum, pair) => sum + end(...pair), value));
}
