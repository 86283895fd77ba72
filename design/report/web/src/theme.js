// SPDX-License-Identifier: MIT
// Light, dark, or as the system has it; and paper.
import { byId } from "./dom.js";

const order = ["auto", "light", "dark"];
const shown = { auto: "Colours: auto", light: "Colours: light", dark: "Colours: dark" };
const told = { auto: "as the system has them", light: "light", dark: "dark" };

export const isDark = () => getComputedStyle(document.documentElement).colorScheme === "dark";

export function startTheme(paint) {
  const button = byId("theme"), root = document.documentElement;
  const apply = (choice) => {
    if (choice === "auto") delete root.dataset.theme;
    else root.dataset.theme = choice;
    button.textContent = shown[choice];
    button.setAttribute("aria-label", `Colours: ${told[choice]}. Change`);
    paint(isDark());
  };
  let choice = order.includes(root.dataset.theme) ? root.dataset.theme : "auto";
  button.addEventListener("click", () => {
    choice = order[(order.indexOf(choice) + 1) % order.length];
    try {
      if (choice === "auto") localStorage.removeItem("fettle-theme");
      else localStorage.setItem("fettle-theme", choice);
    } catch {}
    apply(choice);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => choice === "auto" && apply(choice));
  apply(choice);
}

// A page on paper is light, and has a still picture in place of the moving one.
// `viewerNow()`: the picture's, where there is one.
export function startPrinting(viewerNow, repaintPlots) {
  const still = byId("still"), root = document.documentElement;
  byId("print").addEventListener("click", () => window.print());
  let before;
  window.addEventListener("beforeprint", () => {
    before = root.dataset.theme;
    root.dataset.theme = "light";
    const viewer = viewerNow();
    if (viewer) {
      viewer.paint(false);
      still.src = viewer.picture();
      still.hidden = false;
    }
    repaintPlots();
  });
  window.addEventListener("afterprint", () => {
    if (before) root.dataset.theme = before;
    else delete root.dataset.theme;
    still.hidden = true;
    viewerNow()?.paint(isDark());
    repaintPlots();
  });
}
