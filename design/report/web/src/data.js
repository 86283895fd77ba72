// SPDX-License-Identifier: MIT
// What the program put into the page: design/report/report_data.hpp says what it holds. Lengths in mm.

const kinds = { f32: Float32Array, f64: Float64Array, u32: Uint32Array };

function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

// {"f32": "base64"} -> Float32Array, and so in everything below.
export function decoded(value) {
  if (value === null || typeof value !== "object") return value;
  if (Array.isArray(value)) return value.map(decoded);
  const keys = Object.keys(value);
  if (keys.length === 1 && kinds[keys[0]]) return new kinds[keys[0]](bytesOf(value[keys[0]]).buffer);
  for (const key of keys) value[key] = decoded(value[key]);
  return value;
}

export function readData() {
  return decoded(JSON.parse(document.getElementById("fettle-report").textContent));
}

// Index of the last of `times` (rising) that is not after t; 0 if there is none.
export function indexAt(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle - 1;
  }
  return low;
}
