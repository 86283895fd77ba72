// SPDX-License-Identifier: MIT
// Numbers for people. A lower bound is rounded down and an upper one up, so that what is read is proven too.

const none = "\u2013";
const minus = (text) => text.replace("-", "\u2212").replace("e-", "e\u2212");
const isNumber = (x) => typeof x === "number" && Number.isFinite(x);
const isPlain = (exponent) => exponent >= -4 && exponent <= 6;  // is it told without one?

// `digits` significant ones, by `round`; the exponent is told where the number is very small or large.
function rounded(x, digits, round) {
  if (x === 0) return "0";
  const exponent = Math.floor(Math.log10(Math.abs(x)));
  if (!isPlain(exponent)) {
    const mantissa = round((x / 10 ** exponent) * 10 ** (Math.min(digits, 3) - 1)) / 10 ** (Math.min(digits, 3) - 1);
    return `${mantissa}e${exponent}`;
  }
  const decimals = Math.max(0, digits - 1 - exponent);
  return (round(x * 10 ** decimals) / 10 ** decimals).toFixed(decimals);
}

const trimmed = (text) => (text.includes(".") && !text.includes("e") ? text.replace(/0+$/, "").replace(/\.$/, "") : text);

export const number = (x, digits = 5) => (isNumber(x) ? minus(trimmed(rounded(x, digits, Math.round))) : none);
export const lowerBound = (x, digits = 5) => (isNumber(x) ? minus(rounded(x, digits, Math.floor)) : none);
export const upperBound = (x, digits = 5) => (isNumber(x) ? minus(rounded(x, digits, Math.ceil)) : none);

// As many digits as tell it from what is `step` away.
export function numberInSteps(x, step) {
  if (!isNumber(x)) return none;
  if (Math.abs(x) < step / 2) return "0";
  const order = (v) => Math.floor(Math.log10(Math.abs(v)) + 1e-9);
  const exponent = order(x), digits = Math.max(0, Math.min(17, exponent - order(step)));  // after the first
  if (isPlain(exponent)) return minus(trimmed(x.toFixed(Math.max(0, digits - exponent))));
  const [mantissa, power] = x.toExponential(digits).split("e");
  return minus(`${trimmed(mantissa)}e${Number(power)}`);
}

// "mm^2" with its power raised.
export const raised = (unit) => unit.replace("^2", "\u00b2").replace("^3", "\u00b3");
export const withUnit = (text, unit) => (unit && text !== none ? `${text}\u00a0${raised(unit)}` : text);

// A share in percent; one that is not whole is not told as 100 %.
export function percent(share, digits = 2) {
  if (!isNumber(share)) return none;
  const text = number(100 * share, digits);
  return text === "100" && share < 1 ? `>\u00a0${digits > 2 ? 99.99 : 99}\u00a0%` : `${text}\u00a0%`;
}

// As many decimals as tell one step from the next.
export function seconds(t, step = 0.01) {
  const decimals = Math.max(0, Math.min(6, Math.ceil(-Math.log10(step))));
  return `${minus(t.toFixed(decimals))}\u00a0s`;
}

// A text of the program's with numbers: minus signs, and numbers that stay with their units.
export const spaced = (text) => text.replace(/ -(?=\d)/g, " \u2212").replace(/(\d) (?=(?:deg|mm)\b)/g, "$1\u00a0");

export const plural = (n, one, many = one + "s") => `${n}\u00a0${n === 1 ? one : many}`;
