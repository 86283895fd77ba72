// SPDX-License-Identifier: MIT
// Curves: uPlot, with a legend of buttons that tells the values at the instant shown, and a line at that instant.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

import { element } from "./dom.js";
import { indexAt } from "./data.js";
import { number, withUnit } from "./numbers.js";

const colours = {
  light: ["#1f56c4", "#b0582a", "#3f7d5c", "#8a6a10", "#8b4c9c", "#2b7f92", "#a83a55", "#66702a", "#5b6270", "#7a4a2a"],
  dark: ["#8db0ff", "#e59a6c", "#82c39f", "#d9b95b", "#c99ad8", "#72c3d6", "#ee92a6", "#b7c27a", "#b3b9c6", "#cf9d7b"],
};

export const made = [];

const isDark = () => getComputedStyle(document.documentElement).colorScheme === "dark";
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

function axis(side, label, values) {
  return {
    side, label, values, labelSize: label ? 20 : 0, size: side === 3 ? 58 : 34, gap: 4, labelGap: 0,
    stroke: css("--muted"), font: `12px ${css("--font")}`, labelFont: `12px ${css("--font")}`,
    grid: { stroke: css("--line"), width: 1, show: side === 3 }, ticks: { show: false },
  };
}

export class Plot {
  // options: title, unit (of y), x: {label, time?}, lines: [{name, values, dash?, points?, style: "line" | "step"}], bands: [[upper, lower]],
  // log?, zooms?: [{name, log?, yRange?}] to choose among, the first is shown, limits?: [{value, name}]: beyond them it is wrong, height?, stripes?: [{from, to, name}], summary (for those who do not see it), onPick(x)
  constructor(parent, xs, options) {
    this.xs = xs;
    this.options = options;
    this.on = options.lines.map(() => true);
    this.zoom = options.zooms?.[0] ?? options;
    this.holder = element("div", { class: "plot", role: "img" });
    this.caption = element("figcaption");
    this.legend = element("ul", { class: "legend", "aria-label": `Curves of: ${options.title}` });
    this.figure = element("figure", {}, this.caption, this.holder, this.legend);
    this.fillCaption();
    parent.append(this.figure);
    this.make();
    this.observer = new ResizeObserver(() => this.plot.setSize({ width: this.holder.clientWidth, height: this.height() }));
    this.observer.observe(this.holder);
    made.push(this);
  }

  fillCaption() {
    const { title, note, summary } = this.options;
    this.holder.setAttribute("aria-label", `${title}. ${summary ?? ""}`);
    this.caption.replaceChildren(...[element("h3", {}, title), note ? element("span", {}, note) : null, this.zoomButtons()].filter(Boolean));
  }

  // Other curves of the same kind; what was chosen of them stays chosen.
  replace(xs, options) {
    const { name } = this.zoom;
    if (options.lines.length !== this.on.length) this.on = options.lines.map(() => true);
    this.xs = xs;
    this.options = options;
    this.zoom = options.zooms?.find((zoom) => zoom.name === name) ?? options.zooms?.[0] ?? options;
    this.fillCaption();
    this.make();
  }

  remove() {
    this.observer.disconnect();
    this.plot.destroy();
    this.figure.remove();
    made.splice(made.indexOf(this), 1);
  }

  zoomButtons() {
    const { zooms } = this.options;
    if (!zooms) return null;
    const buttons = zooms.map((zoom) => element("button", { type: "button", "aria-pressed": String(zoom === this.zoom), onclick: () => {
      this.zoom = zoom;
      buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(zooms[k] === zoom)));
      this.make();
    } }, zoom.name));
    return element("div", { class: "segments zooms", role: "group", "aria-label": `Scale of: ${this.options.title}` }, ...buttons);
  }

  height() {
    return this.options.height ?? 230;
  }

  colour(i) {
    const list = colours[isDark() ? "dark" : "light"], line = this.options.lines[i];
    return line.muted ? css("--line-strong") : list[(line.colour ?? i) % list.length];
  }

  series(line, i) {
    const stroke = this.colour(i);
    return {
      label: line.name, show: this.on[i], stroke, width: line.edge ? 0.75 : line.dash ? 1.25 : 1.75, dash: line.dash ? [5, 4] : undefined,
      paths: line.style === "step" ? uPlot.paths.stepped({ align: 1 }) : line.style === "dots" ? () => null : uPlot.paths.linear(),
      points: line.points ? { show: true, size: 6, fill: stroke } : { show: false }, spanGaps: false,
    };
  }

  make() {
    const { options, zoom } = this, tick = (plot, values) => values.map((v) => (v === null ? "" : number(v, 6)));
    this.plot?.destroy();
    const bands = (options.bands ?? []).map(([upper, lower]) => ({ series: [upper + 1, lower + 1], fill: `${this.colour(upper)}38` }));
    this.plot = new uPlot({
      width: this.holder.clientWidth || 480, height: this.height(), legend: { show: false },
      cursor: { points: { size: 6 }, drag: { x: true, y: false } },
      scales: { x: { time: false, range: options.xRange }, y: zoom.log ? { distr: 3, range: zoom.yRange } : { range: zoom.yRange } },
      axes: [axis(2, options.x.label, tick), axis(3, options.unit ? `${options.quantity ?? ""} [${options.unit}]`.trim() : options.quantity, tick)],
      series: [{}, ...options.lines.map((line, i) => this.series(line, i))], bands,
      hooks: { drawClear: [(plot) => this.stripes(plot)], draw: [(plot) => this.limits(plot)], setCursor: [(plot) => this.tell(plot.cursor.idx)] },
    }, [this.xs, ...options.lines.map((line) => (zoom.log ? line.values.map((v) => (v === null ? null : Math.max(v, zoom.floor))) : line.values))], this.holder);
    this.plot.over.addEventListener("click", () => {
      if (options.onPick && this.plot.cursor.left >= 0) options.onPick(this.plot.posToVal(this.plot.cursor.left, "x"));
    });
    this.now = options.x.time ? element("div", { class: "now" }) : null;
    if (this.now) this.plot.over.append(this.now);
    this.fillLegend();
    this.setTime(this.time ?? this.xs[0]);
  }

  stripes(plot) {
    const { stripes } = this.options;
    if (!stripes) return;
    const { ctx, bbox } = plot;
    ctx.save();
    stripes.forEach((stripe, k) => {
      if (k % 2 === 0) return;
      const left = Math.max(bbox.left, plot.valToPos(stripe.from, "x", true)), right = Math.min(bbox.left + bbox.width, plot.valToPos(stripe.to, "x", true));
      ctx.fillStyle = `${css("--muted")}14`;
      ctx.fillRect(left, bbox.top, Math.max(0, right - left), bbox.height);
    });
    ctx.restore();
  }

  // What is required, named where it is drawn, and what violates it.
  limits(plot) {
    const { ctx, bbox } = plot, { limits } = this.options, ratio = devicePixelRatio || 1;
    if (!limits?.length) return;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.font = `${12 * ratio}px ${css("--font")}`;
    ctx.textAlign = "right";
    ctx.textBaseline = "alphabetic";
    for (const { value, name } of limits) {
      const y = Math.round(plot.valToPos(value, "y", true));
      ctx.fillStyle = `${css("--bad")}12`;
      ctx.fillRect(bbox.left, y, bbox.width, bbox.top + bbox.height - y);
      ctx.strokeStyle = ctx.fillStyle = css("--bad");
      ctx.lineWidth = 1.25 * ratio;
      ctx.setLineDash([6 * ratio, 4 * ratio]);
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
      const above = y - bbox.top > 20 * ratio;
      ctx.fillText(name, bbox.left + bbox.width - 6 * ratio, above ? y - 5 * ratio : y + 14 * ratio);
    }
    ctx.restore();
  }

  fillLegend() {
    const { lines } = this.options;
    this.told = lines.map(() => element("b"));
    this.legend.replaceChildren(...lines.map((line, i) => {
      if (line.edge) return null;
      const swatch = element("i", { class: line.dash ? "dashed" : null });
      swatch.style.borderTopColor = this.colour(i);
      const button = element("button", { type: "button", "aria-pressed": String(this.on[i]), onclick: () => this.toggle(i, button) }, swatch, element("span", {}, line.name), line.silent ? null : this.told[i]);
      return element("li", {}, button);
    }).filter(Boolean));
  }

  toggle(i, button) {
    const show = !this.on[i], { lines } = this.options;
    lines.forEach((line, k) => {
      if (k !== i && line.with !== i) return;
      this.on[k] = show;
      this.plot.setSeries(k + 1, { show });
    });
    button.setAttribute("aria-pressed", String(show));
  }

  tell(index) {
    const at = index ?? (this.options.x.time ? indexAt(this.xs, this.time ?? 0) : this.xs.length - 1);
    this.options.lines.forEach((line, i) => {
      const text = line.values[at] === null || line.values[at] === undefined ? "" : withUnit(number(line.values[at], 4), this.options.unit);
      if (this.told[i].textContent !== text) this.told[i].textContent = text;
    });
  }

  setTime(t) {
    if (!this.options.x.time) {
      this.tell(null);
      return;
    }
    this.time = t;
    this.now.style.transform = `translateX(${this.plot.valToPos(t, "x")}px)`;
    if (this.plot.cursor.left < 0 || this.plot.cursor.left === undefined) this.tell(null);
  }
}

export const setPlotTime = (t) => made.forEach((plot) => plot.setTime(t));
export const repaintPlots = () => made.forEach((plot) => plot.make());
