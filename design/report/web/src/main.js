// SPDX-License-Identifier: MIT
// Puts the report together: data into words, picture, tables and curves, and these to work with each other.
import "./style.css";
import { readData } from "./data.js";
import { repaintCharts } from "./chart.js";
import { announce, byId, element, wholeWords } from "./dom.js";
import { motionPlots, marginPlot, searchPlots } from "./curves.js";
import { showExploration } from "./explore.js";
import { startMotion } from "./motion.js";
import { made as plots, repaintPlots, setPlotTime } from "./plots.js";
import { startStudio } from "./studio.js";
import { costBars, factList, interferenceTable, pairTable, parameterTable, requirementTable, resolutionTable, startTable } from "./tables.js";
import { showTolerances } from "./tolerance.js";
import { isDark, startPrinting, startTheme } from "./theme.js";
import * as words from "./words.js";

function fillVerdict(data) {
  document.title = `${data.name} \u2013 fettle ${data.kind === "studio" ? "studio" : "report"}`;
  byId("name").textContent = data.name;
  byId("kind").textContent = { optimise: "optimisation", simulate: "simulation", clearance: "clearance", explore: "exploration", tolerance: "tolerances", studio: "studio" }[data.kind];
  byId("asked").textContent = words.asked(data);
  const { tone, head, rest } = words.reached(data);
  byId("reached").append(element("strong", { class: `verdict-${tone}` }, head), ` ${rest}`);
  byId("facts").append(...factList(words.facts(data)));
  byId("notices").append(...data.notices.map((text) => element("li", {}, text)));
  if (data.message && !["optimal", "ok", "shown"].includes(data.status)) byId("notices").prepend(element("li", { class: "warn" }, data.message));
}

function section(title, intro, ...children) {
  const id = `section-${byId("sections").children.length}`;
  const made = element("section", { "aria-labelledby": id }, element("h2", { id }, title), intro ? element("p", { class: "section-intro" }, intro) : null, ...children);
  byId("sections").append(made);
  return made;
}

function fillFooter(data) {
  const lines = [];
  if (data.command) lines.push(element("p", {}, "Command: ", element("code", {}, ...wholeWords(data.command))));
  lines.push(element("p", {}, `fettle ${data.program}${data.made_by_other ? `; this page was made by fettle ${data.made_by_other}` : ""}. ${data.kind === "tolerance" ? "Design" : "Folder"}: `, element("code", {}, data.folder || ".")));
  const files = data.files.flatMap((name, k) => [k ? ", " : "", element("a", { href: name, download: name }, name), words.fileWords[name] ? ` (${words.fileWords[name]})` : ""]);
  if (files.length) lines.push(element("p", { id: "files" }, "Beside this page: ", ...files, "."));
  lines.push(element("p", {}, words.provenWords(data)));
  byId("footer").append(...lines);
}

function fillLimits(data) {
  const bounds = data.parameters.filter((p) => p.held === "lower bound" || p.held === "upper bound");
  const costly = data.requirements.some((r) => r.counts);
  if (!data.limits.length && !bounds.length && !costly) return;
  const made = section("What limits the design", costly ? `What each requirement costs, in ${data.repair ? "the squared change" : "the objective"}: how much would be gained if it asked for a little less.` : null);
  if (costly) made.append(costBars(data));
  const lines = [...data.limits, ...bounds.map((p) => `${p.name} is at its ${p.held}.`)];
  if (lines.length) made.append(element("ul", { class: "plain-list" }, ...lines.map((line) => element("li", {}, line))));
}

function fillSections(data, motion) {
  const pick = (t) => motion?.seek(t);
  const show = (k) => motion.show(k);
  show.can = (k) => !!motion && motion.canShow(k);
  if (data.requirements.length) {
    section("Requirements", "Each is judged by these two numbers. Proven ones enclose the true value; computed ones have the error of the time step and of facets. A requirement of a clearance shows its narrowest gap in the picture above.", requirementTable(data, show));
  } else if (data.pairs.length) {
    const shared = data.pairs.filter(words.isShared);
    if (shared.length) section("Interferences", "Two parts share material. Depth: the least move that parts them. A row shows the deepest instant in the picture above.", interferenceTable(data, show));
    if (shared.length === data.pairs.length) return;
    const shown = data.ranges ? " A row shows its worst position in the picture above." : " A row shows its narrowest gap in the picture above.";
    const intro = data.kind === "simulate" ? "The pairs that come nearest to each other, over the continuous path. Contact: near enough to push each other, without touching. A row shows its narrowest gap in the picture above." : `Worst first.${data.pairs.some((pair) => pair.status === "contact") ? " Contact: near enough to push each other, not judged." : ""}${shown}`;
    section("Clearances", data.pair_count > data.pairs.length ? `${intro} ${data.pair_count - data.pairs.length} more pairs are in result.json.` : intro, pairTable(data, show));
  }
  const figures = () => element("div", { class: "figures" });
  if (data.margins) {
    const box = figures();
    byId("sections").lastElementChild?.append(box);
    marginPlot(box, data, pick);
  }
  if (data.resolution) section("How exact these numbers are", words.resolutionIntro(data.resolution), ...resolutionTable(data.resolution));
  if (data.kind === "optimise") {
    fillLimits(data);
    section("Parameters", "The open dot is where it began, the full one where it ended.", parameterTable(data));
  }
  if (data.starts.length) section("Starts", words.startsIntro(data), startTable(data));
  if (data.history?.objective.length > 1) {
    const box = figures();
    section("How it got there", null, box);
    searchPlots(box, data);
  }
  scenarioSection("Quantities", "What the design names, wants and requires at each step of the motion, before a peak or another number is taken of it.", data, motion, (scenario) => scenario.quantities, pick);
  scenarioSection("Forces", data.series_note, data, motion, (scenario) => scenario.series, pick);
}

// One box of figures for each scenario, of which that of the motion in the picture is shown.
function scenarioSection(title, intro, data, motion, chartsOf, pick) {
  const all = data.scenarios ?? [];
  if (!all.some((scenario) => chartsOf(scenario).length)) return;
  const made = section(title, intro);
  const boxes = all.map((scenario) => element("div", { class: "figures" }));
  made.append(...boxes);
  all.forEach((scenario, k) => motionPlots(boxes[k], chartsOf(scenario), pick));
  const show = (shown) => boxes.forEach((box, k) => (box.hidden = k !== shown));
  show(0);
  motion?.onScenario(show);
}

const data = { pairs: [], scenarios: [], notices: [], files: [], ...readData() };
fillVerdict(data);
let motion = null;
function startPicture() {
  byId("motion").hidden = !data.views.length;
  byId("hero").classList.toggle("plain", !data.views.length);
  if (!data.views.length) return;
  try {
    motion = startMotion(data, setPlotTime);
  } catch (error) {
    byId("viewport").replaceChildren(element("p", { class: "offscreen" }, "The picture needs WebGL, which this browser does not offer. Everything else is below."));
    console.warn(String(error));
  }
}
startPicture();
// The motion, where there is a picture; a later picture.
const picture = {
  motion: () => motion,
  start() {
    startPicture();
    motion?.paint(isDark());
    motion?.open();
  },
};
const shown = { explore: () => ({ exploration: showExploration(data, section, motion) }), tolerance: () => ({ tolerances: showTolerances(data, section) }), studio: () => ({ studio: startStudio(data, section, picture) }) }[data.kind] ?? (() => fillSections(data, motion));
const parts = shown() ?? {};
fillFooter(data);
const repaint = () => {
  repaintPlots();
  repaintCharts();
};
startTheme((dark) => {
  motion?.paint(dark);
  repaint();
});
startPrinting(() => motion?.viewer, repaint);
motion?.open();
announce("");
performance.mark("fettle-ready");
window.fettleReport = { data, get motion() { return motion; }, plots, ...parts };
