// SPDX-License-Identifier: MIT
// Elements. Names come from users: they are text, never markup.

export const byId = (id) => document.getElementById(id);

// element("p", { class: "lead", onclick: f }, "text", child, ...)
export function element(tag, attributes = {}, ...children) {
  const made = tag === "svg" || tag.startsWith("svg:")
    ? document.createElementNS("http://www.w3.org/2000/svg", tag.replace("svg:", "")) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null && child !== undefined && child !== ""));
  return made;
}

// Words that a line's end does not cut at their hyphens.
export const wholeWords = (text) => text.split(" ").flatMap((word, k) => [k ? " " : "", element("span", { class: "word" }, word)]);

export const reducedMotion = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

export function announce(text) {
  byId("announce").textContent = text;
}
