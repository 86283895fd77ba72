// SPDX-License-Identifier: MIT
// How long does a report take to open, and how many pictures a second does it play? Ten parts of 5,000 triangles, 1,000 poses, in headless
// Chromium with software rendering, a picture of 800 x 600. Prints JSON. The parts are tori that roll; the page is design/report/template.html.
//   (cd design/report/web && npm ci) && node tests/benchmarks/report_benchmark.mjs [CHROMIUM]
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const { chromium } = await import(new URL("../../design/report/web/node_modules/playwright-core/index.mjs", import.meta.url));
const parts = 10, around = 100, across = 25, poses = 1000, step = 0.005;

const packed = (kind, array) => ({ [kind]: Buffer.from(array.buffer).toString("base64") });

function torus(big, small) {
  const vertices = new Float32Array(3 * around * across), triangles = new Uint32Array(6 * around * across);
  for (let i = 0, v = 0, t = 0; i < around; ++i) {
    for (let j = 0; j < across; ++j) {
      const u = (2 * Math.PI * i) / around, w = (2 * Math.PI * j) / across, r = big + small * Math.cos(w);
      vertices.set([r * Math.cos(u), r * Math.sin(u), small * Math.sin(w)], 3 * v++);
      const a = i * across + j, b = ((i + 1) % around) * across + j, c = ((i + 1) % around) * across + ((j + 1) % across), d = i * across + ((j + 1) % across);
      triangles.set([a, b, c, a, c, d], t);
      t += 6;
    }
  }
  return { vertices: packed("f32", vertices), triangles: packed("u32", triangles), edges: packed("u32", new Uint32Array(0)) };
}

function body(i) {
  const numbers = new Float32Array(7 * poses);
  for (let k = 0; k < poses; ++k) {
    const angle = k * 0.02 * (1 + 0.1 * i);
    numbers.set([45 * (i % 5), 45 * Math.floor(i / 5), 4 * Math.sin(angle), Math.sin(angle / 2), 0, 0, Math.cos(angle / 2)], 7 * k);
  }
  return { name: `part ${i}`, type: "dynamic", mesh: i, poses: packed("f32", numbers) };
}

const data = {
  format: 1, program: "0", command: null, kind: "simulate", name: "benchmark", folder: "", description: null, up: [0, 0, 1], status: "ok", message: null, least: 1,
  motion: true, step, steps: poses - 1, duration: step * (poses - 1), notices: [], requirements: [], parameters: [], limits: [], pairs: [], pair_count: 0,
  margins: null, history: null, series: [], series_note: null, meshes: Array.from({ length: parts }, (_, i) => torus(14 + 0.3 * i, 6)),
  views: [{ name: "after", every: 1, times: packed("f64", Float64Array.from({ length: poses }, (_, k) => step * k)), bodies: Array.from({ length: parts }, (_, i) => body(i)) }],
};

const folder = mkdtempSync(join(tmpdir(), "fettle_benchmark_")), file = join(folder, "report.html");
const template = readFileSync(new URL("../../design/report/template.html", import.meta.url), "utf8");
writeFileSync(file, template.replace("@FETTLE_REPORT_DATA@", () => JSON.stringify(data)));

const browser = await chromium.launch({
  executablePath: process.argv[2] ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const context = await browser.newContext({ viewport: { width: 1100, height: 1034 }, offline: true });
await (await context.newPage()).goto("about:blank");  // the browser itself is awake
const opened = [];
let page;
for (let n = 0; n < 3; ++n) {
  page = await context.newPage();
  const began = performance.now();
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => window.fettleReport?.motion?.viewer.drawn > 0, undefined, { polling: 5 });
  await page.screenshot({ clip: { x: 0, y: 0, width: 8, height: 8 } });  // it has been shown
  opened.push(Math.round(performance.now() - began));
}
const size = await page.evaluate(() => {
  const port = document.getElementById("viewport");
  Object.assign(port.style, { width: "800px", height: "600px" });
  document.getElementById("motion").style.gridTemplateColumns = "800px auto";
  port.scrollIntoView();
  return [port.clientWidth, port.clientHeight];
});
await page.waitForTimeout(500);
const rate = await page.evaluate(() => new Promise((resolve) => {
  const { motion } = window.fettleReport, frames = motion.viewer.drawn, began = performance.now();
  motion.play();
  setTimeout(() => {
    motion.pause();
    resolve((1000 * (motion.viewer.drawn - frames)) / (performance.now() - began));
  }, 4000);
}));
console.log(JSON.stringify({ file_bytes: statSync(file).size, open_milliseconds: opened, picture: size, frames_per_second: Math.round(10 * rate) / 10 }));
await browser.close();
rmSync(folder, { recursive: true });
