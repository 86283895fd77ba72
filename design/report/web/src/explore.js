// SPDX-License-Identifier: MIT
// The page of an exploration: two chosen numbers of each design against each other, all of them side by side, and the design that is chosen.
import { canvasChart, css, endTexts, frame, nearest, rule, shadeOf, span } from "./chart.js";
import { Designs } from "./designs.js";
import { announce, byId, element } from "./dom.js";
import { number, plural, raised, withUnit } from "./numbers.js";
import { cell, rangeDrawing, requiredWords, status, tableOf } from "./tables.js";

const named = (designs, k) => (designs.columns[k].unit ? `${designs.names[k]} [${raised(designs.columns[k].unit)}]` : designs.names[k]);
const told = (column, v) => withUnit(number(v), column.unit);
const violates = (column, v) => column.group === "constraint" && ((column.lower !== null && v < column.lower) || (column.upper !== null && v > column.upper));

// A list of columns to choose from, by kind.
function chooser(label, designs, chosen, none, onChange) {
  const groups = [["objective", "Objective"], ["term", "Terms of the objective"], ["constraint", "Requirements"], ["parameter", "Parameters"], ["violation", "Largest violation"]];
  const select = element("select", { onchange: () => onChange(select.value === "" ? null : Number(select.value)) }, none ? element("option", { value: "" }, none) : null,
    ...groups.map(([group, name]) => {
      const options = designs.of(group).map(({ k }) => element("option", { value: k, selected: k === chosen }, named(designs, k)));
      return options.length ? element("optgroup", { label: name }, ...options) : null;
    }));
  return element("label", { class: "field" }, label, select);
}

function scatter(parent, designs) {
  let place, front = null;
  const point = (i) => {
    const x = designs.value(designs.x, i), y = designs.value(designs.y, i);
    return Number.isFinite(x) && Number.isFinite(y) ? [place.x(x), place.y(y)] : null;
  };
  const all = designs.list.map((_, i) => i);
  const chart = canvasChart(parent, 400, (c, width, height) => {
    const cx = designs.columns[designs.x], cy = designs.columns[designs.y], [x0, x1] = span(cx.values), [y0, y1] = span(cy.values);
    const arrow = cy.better < 0 ? "  better \u2193" : cy.better > 0 ? "  better \u2191" : "", side = cx.better < 0 ? "  \u2190 better" : cx.better > 0 ? "  better \u2192" : "";
    place = frame(c, width, height, [x0, x1], [y0, y1], named(designs, designs.x) + side, named(designs, designs.y) + arrow);
    for (const [column, axis] of [[cx, "x"], [cy, "y"]])
      if (column.group === "constraint") [column.lower, column.upper].filter((v) => v !== null).forEach((v) => rule(c, place, axis, v));
    front = designs.front();
    if (front?.length > 1) {
      c.strokeStyle = css("--accent");
      c.lineWidth = 1.5;
      c.beginPath();
      front.map(point).forEach(([x, y], n, list) => {
        if (n === 0) c.moveTo(x, y);
        else {
          c.lineTo(x, list[n - 1][1]);
          c.lineTo(x, y);
        }
      });
      c.stroke();
      c.lineWidth = 1;
    }
    const shade = designs.shade === null ? null : designs.columns[designs.shade], [s0, s1] = shade ? span(shade.values, 0) : [0, 1], isBest = new Set(front ?? []);
    const order = [...all].sort((i, j) => Number(designs.wanted(i)) - Number(designs.wanted(j)));
    for (const i of order) {
      const p = point(i);
      if (!p) continue;
      const wanted = designs.wanted(i), v = shade?.values[i];
      c.globalAlpha = wanted ? 1 : 0.35;
      c.beginPath();
      c.arc(...p, isBest.has(i) ? 5 : 3.5, 0, 7);
      if (designs.list[i].met || shade) {
        c.fillStyle = !wanted ? css("--line-strong") : shade ? (Number.isFinite(v) ? shadeOf((v - s0) / (s1 - s0 || 1)) : css("--line-strong")) : css("--accent");
        c.fill();
      } else {
        c.strokeStyle = css("--muted");
        c.stroke();
      }
    }
    c.globalAlpha = 1;
    const chosen = point(designs.chosen);
    if (chosen) {
      c.strokeStyle = css("--ink");
      c.lineWidth = 2;
      c.beginPath();
      c.arc(...chosen, 9, 0, 7);
      c.stroke();
    }
  });
  const at = (event) => {
    const box = chart.canvas.getBoundingClientRect();
    return nearest(all.filter((i) => designs.wanted(i) || !designs.onlyMet), point, event.clientX - box.left, event.clientY - box.top, 14);
  };
  chart.canvas.addEventListener("click", (event) => {
    const i = at(event);
    if (i >= 0) designs.choose(i);
  });
  chart.canvas.addEventListener("pointermove", (event) => {
    const i = at(event);
    chart.canvas.style.cursor = i >= 0 ? "pointer" : "default";
    chart.canvas.title = i < 0 ? "" : `design ${i + 1}: ${[designs.x, designs.y].map((k) => `${designs.names[k]} ${told(designs.columns[k], designs.value(k, i))}`).join(", ")}`;
  });
  designs.listeners.push(chart.repaint);
  return { front: () => front };
}

const mostAxes = 14;

// A name in lines of its words, as wide as the axes are apart; the whole of it, for axes may differ in any word.
function labelLines(c, name, wide) {
  if (c.measureText(name).width <= wide) return [name];
  const fits = (text) => c.measureText(text).width < wide;
  const lines = name.split(" ").reduce((rows, word) => {
    const last = rows[rows.length - 1];
    return last === undefined || !fits(`${last} ${word}`) ? [...rows, word] : [...rows.slice(0, -1), `${last} ${word}`];
  }, []);
  return lines.length <= 6 ? lines : [...lines.slice(0, 3), "\u2026", ...lines.slice(-2)];
}

function parallel(parent, designs) {
  const shown = designs.columns.map((column, k) => ({ column, k })).filter(({ column, k }) => column.group !== "violation" && designs.varies(k) && !(column.group === "term" && designs.of("term").length === 1)).slice(0, mostAxes);
  if (shown.length < 2) return;
  const room = { left: 20, right: 20, top: 56, bottom: 28 };
  const axes = shown.map(({ column, k }) => ({ column, k, span: span(column.values, 0) }));
  let width = 0, height = 0, dragged = null;
  const across = (n) => room.left + 40 + (n * (width - room.left - room.right - 80)) / (axes.length - 1);
  const upward = (axis, v) => room.top + (height - room.top - room.bottom) * (1 - (v - axis.span[0]) / (axis.span[1] - axis.span[0] || 1));
  const valueAt = (axis, y) => axis.span[0] + (axis.span[1] - axis.span[0]) * Math.min(1, Math.max(0, 1 - (y - room.top) / (height - room.top - room.bottom)));
  const all = designs.list.map((_, i) => i);
  const trace = (c, i) => {
    c.beginPath();
    let begun = false;
    axes.forEach((axis, n) => {
      const v = axis.column.values[i];
      if (!Number.isFinite(v)) {
        begun = false;
        return;
      }
      if (begun) c.lineTo(across(n), upward(axis, v));
      else c.moveTo(across(n), upward(axis, v));
      begun = true;
    });
    c.stroke();
  };
  const chart = canvasChart(parent, 360, (c, w, h) => {
    [width, height] = [w, h];
    // Between its neighbours, and within the picture.
    const wide = (n) => Math.min((width - 120) / (axes.length - 1), 2 * Math.min(across(n), width - across(n)));
    const labels = axes.map((axis, n) => labelLines(c, named(designs, axis.k), wide(n)));
    room.top = 28 + 14 * Math.max(2, ...labels.map((lines) => lines.length));
    const shade = designs.shade === null ? null : designs.columns[designs.shade], [s0, s1] = shade ? span(shade.values, 0) : [0, 1];
    for (const wanted of [false, true]) {
      c.globalAlpha = wanted ? Math.max(0.25, Math.min(0.8, 40 / all.length)) : 0.15;
      for (const i of all.filter((each) => designs.wanted(each) === wanted)) {
        const v = shade?.values[i];
        c.strokeStyle = !wanted ? css("--line-strong") : shade && Number.isFinite(v) ? shadeOf((v - s0) / (s1 - s0 || 1)) : css("--accent");
        trace(c, i);
      }
    }
    c.globalAlpha = 1;
    c.strokeStyle = css("--ink");
    c.lineWidth = 2.25;
    trace(c, designs.chosen);
    c.lineWidth = 1;
    axes.forEach((axis, n) => {
      const x = across(n), range = designs.ranges.get(axis.k), { column } = axis;
      c.strokeStyle = css("--muted");
      c.beginPath();
      c.moveTo(x, room.top);
      c.lineTo(x, height - room.bottom);
      c.stroke();
      if (column.group === "constraint") {
        c.strokeStyle = css("--bad");
        for (const v of [column.lower, column.upper].filter((each) => each !== null && each >= axis.span[0] && each <= axis.span[1])) {
          c.beginPath();
          c.moveTo(x - 7, upward(axis, v));
          c.lineTo(x + 7, upward(axis, v));
          c.stroke();
        }
      }
      if (range) {
        c.fillStyle = `${css("--accent")}40`;
        c.fillRect(x - 7, upward(axis, range[1]), 14, Math.max(2, upward(axis, range[0]) - upward(axis, range[1])));
      }
      c.textAlign = "center";
      c.fillStyle = css("--muted");
      const [low, high] = endTexts(axis.span);
      c.fillText(high, x, room.top - 6);
      c.fillText(low, x, height - room.bottom + 16);
      c.fillStyle = css("--ink");
      labels[n].forEach((row, r, list) => c.fillText(row.trim(), x, room.top - 22 - 14 * (list.length - 1 - r), Math.max(40, wide(n) - 4)));
    });
  });
  const place = (event) => {
    const box = chart.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const axisAt = (x) => axes.findIndex((_, n) => Math.abs(across(n) - x) < 14);
  chart.canvas.style.touchAction = "pan-y";
  chart.canvas.addEventListener("pointerdown", (event) => {
    const { x, y } = place(event), n = axisAt(x);
    if (n < 0) return;
    dragged = { axis: axes[n], from: y };
    chart.canvas.setPointerCapture(event.pointerId);
  });
  chart.canvas.addEventListener("pointermove", (event) => {
    const { x, y } = place(event);
    chart.canvas.style.cursor = axisAt(x) >= 0 ? "ns-resize" : "default";
    if (!dragged || Math.abs(y - dragged.from) < 4) return;
    const ends = [valueAt(dragged.axis, dragged.from), valueAt(dragged.axis, y)].sort((p, q) => p - q);
    designs.ranges.set(dragged.axis.k, ends);
    designs.tell();
  });
  chart.canvas.addEventListener("pointerup", (event) => {
    const { x, y } = place(event);
    if (dragged && Math.abs(y - dragged.from) < 4 && designs.ranges.delete(dragged.axis.k)) designs.tell();
    else if (!dragged) {
      const n = axes.reduce((best, _, k) => (Math.abs(across(k) - x) < Math.abs(across(best) - x) ? k : best), 0);
      const i = nearest(all.filter((each) => designs.wanted(each)), (each) => [across(n), upward(axes[n], axes[n].column.values[each])], across(n), y, 12);
      if (i >= 0) designs.choose(i);
    }
    dragged = null;
  });
  designs.listeners.push(chart.repaint);
}

// The numbers of the chosen design.
function chosenTables(designs) {
  const i = designs.chosen, parameters = designs.of("parameter"), results = [...designs.of("objective"), ...designs.of("term"), ...designs.of("constraint")];
  const bounded = (column) => column.lower !== null && column.upper !== null;
  const left = tableOf("Parameters of the design chosen", [["Parameter"], ["Value", "num"], ["Between its bounds"]], parameters.map(({ column }) => element("tr", {},
    element("td", {}, column.name), cell("Value", "num", told(column, column.values[i])),
    cell("Between its bounds", "", bounded(column) ? rangeDrawing({ start: column.values[i], end: column.values[i], lower: column.lower, upper: column.upper }) : "\u2013"))));
  const right = tableOf("What it reaches", [["Reached"], ["Value", "num"], ["Required", "num"]], results.map(({ column, k }) => element("tr", {},
    element("td", {}, designs.names[k]), cell("Value", violates(column, column.values[i]) ? "num bad" : "num", told(column, column.values[i])),
    cell("Required", "num", column.group === "constraint" && (column.lower !== null || column.upper !== null) ? requiredWords({ required_lower: column.lower, required_upper: column.upper, unit: column.unit }) : "\u2013"))));
  return [element("div", {}, left), element("div", {}, right)];
}

// What the best are ordered by, and which parameters their table leaves out.
function bestWords(designs) {
  const order = designs.list.some((design) => design.met) ? "By the objective, those first that meet every requirement." : "No design meets every requirement: these are ordered by their largest violation, the least first.";
  const shown = freeParameters(designs), left = designs.of("parameter").filter(({ k }) => !shown.some((each) => each.k === k)).map(({ column }) => column.name);
  if (!left.length) return order;
  const names = left.length <= 3 ? left.join(", ") : `${left.slice(0, 3).join(", ")}, ...`;
  return `${order} Left out of the table: ${plural(left.length, "parameter")} (${names}); the design chosen shows all.`;
}

const freeParameters = (designs) => designs.of("parameter").filter(({ k }) => designs.varies(k)).slice(0, 5);

function bestTable(designs) {
  const objective = designs.of("objective")[0].column, free = freeParameters(designs);
  const rows = designs.bestFirst().slice(0, 10).map((i) => element("tr", { "data-design": i },
    element("td", {}, element("button", { type: "button", class: "row-button", onclick: () => designs.choose(i) }, `design ${i + 1}`)),
    cell("Objective", "num", number(objective.values[i])),
    ...free.map(({ column }) => cell(column.name, "num", told(column, column.values[i]))),
    cell("Verdict", "", status(designs.list[i].met ? "met" : "not met"))));
  return tableOf("The best designs", [["Design"], ["Objective", "num"], ...free.map(({ column }) => [column.name, "num"]), ["Verdict"]], rows);
}

// motion: of the parts, or null. Answers null where there are no designs.
export function showExploration(data, section, motion) {
  if (!data.designs.length) {
    section("Designs", "There are no designs in this file.");
    return null;
  }
  const designs = new Designs(data), plot = element("div", { class: "chart", role: "img" }), all = element("div", { class: "chart", role: "img" });
  const frontWords = element("p", { class: "section-intro", "aria-live": "polite" }), chosen = element("div", { class: "figures" }), chosenWords = element("p", { class: "section-intro" });
  const only = element("input", { type: "checkbox", checked: designs.onlyMet, onchange: () => designs.set({ onlyMet: only.checked }) });
  const controls = element("div", { class: "controls" },
    chooser("Across", designs, designs.x, null, (x) => designs.set({ x })), chooser("Up", designs, designs.y, null, (y) => designs.set({ y })),
    chooser("Colour", designs, null, "none", (shade) => designs.set({ shade })), element("label", { class: "field" }, only, "only designs that meet every requirement"));
  section("Designs", "Each dot is a design: full where it meets every requirement. A click shows it.", controls, plot, frontWords);
  const drawn = scatter(plot, designs);
  const clear = element("button", { type: "button", class: "quiet", onclick: () => {
    designs.ranges.clear();
    designs.tell();
  } }, "Clear all ranges");
  section("All numbers at once", "Each line is a design. Drag along an axis to keep those within a range, in the picture above too; red marks what is required.", all, clear);
  parallel(all, designs);
  section("The design chosen", null, chosenWords, chosen);
  section("The best", bestWords(designs), bestTable(designs));
  const update = () => {
    const i = designs.chosen, design = designs.list[i], objective = designs.of("objective")[0].column;
    const verdict = `${design.met ? "It meets every requirement" : design.reason ? design.reason : "It does not meet every requirement"}.`.replace("..", ".");
    chosenWords.textContent = `Design ${i + 1} of ${designs.list.length}, ${Number.isFinite(objective.values[i]) ? `objective ${number(objective.values[i])}` : design.status}. ${verdict}${motion && design.view === null ? " Its parts are not in this page, which has those of the best designs." : ""}`;
    chosen.replaceChildren(...chosenTables(designs));
    for (const row of document.querySelectorAll("tr[data-design]")) row.classList.toggle("chosen", Number(row.dataset.design) === i);
    plot.setAttribute("aria-label", `${designs.names[designs.y]} against ${designs.names[designs.x]} of ${plural(designs.list.length, "design")}`);
    const front = designs.front();
    frontWords.textContent = front === null ? "No front: one of the two axes has no better side. Objectives, their terms and one-sided requirements have." : `On the line: ${plural(front.length, "design")} that no other one beats in both.`;
    clear.hidden = designs.ranges.size === 0;
    if (motion) motion.showDesign(design.view === null ? null : data.views[design.view].name, `design ${i + 1}`);
    announce(`Design ${i + 1}`);
  };
  designs.listeners.push(update);
  all.setAttribute("aria-label", "All numbers of all designs, side by side");
  update();
  return { designs, front: drawn.front };
}
