// SPDX-License-Identifier: MIT
// How long does a report take to open, and how many pictures a second does it play? Ten parts of 5,000 triangles, 1,000 poses, in headless
// Chromium with software rendering, in a window of 800 x 600, and with a picture of 800 x 600 in a larger one. Prints JSON, with the processor
// time that drawing took, of which a busy machine gives less. The parts are tori that roll; the page is design/report/template.html.
//   (cd design/report/web && npm ci) && node tests/benchmarks/report_benchmark.mjs [CHROMIUM]
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
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
// Processor time of the process that draws [ms].
function drawingTime() {
  let total = 0;
  for (const process of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      if (!readFileSync(`/proc/${process}/cmdline`, "utf8").includes("--type=gpu-process")) continue;
      const fields = readFileSync(`/proc/${process}/stat`, "utf8").split(") ")[1].split(" ");
      total += 10 * (Number(fields[11]) + Number(fields[12]));
    } catch {}  // it has ended
  }
  return total;
}

async function played(page) {
  const before = drawingTime();
  const [frames, seconds] = await page.evaluate(() => new Promise((resolve) => {
    const { motion } = window.fettleReport, first = motion.viewer.drawn, began = performance.now();
    motion.play();
    setTimeout(() => {
      motion.pause();
      resolve([motion.viewer.drawn - first, (performance.now() - began) / 1000]);
    }, 4000);
  }));
  const round = (x) => Math.round(10 * x) / 10;
  return { frames_per_second: round(frames / seconds), processor_milliseconds_per_frame: round((drawingTime() - before) / frames) };
}

const result = { file_bytes: statSync(file).size, load: Number(readFileSync("/proc/loadavg", "utf8").split(" ")[0]), open_milliseconds: [] };
const context = await browser.newContext({ viewport: { width: 800, height: 600 }, offline: true });
await (await context.newPage()).goto("about:blank");  // the browser itself is awake
let page;
for (let n = 0; n < 3; ++n) {
  page = await context.newPage();
  const began = performance.now();
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction(() => window.fettleReport?.motion?.viewer.drawn > 0, undefined, { polling: 5 });
  await page.screenshot({ clip: { x: 0, y: 0, width: 8, height: 8 } });  // it has been shown
  result.open_milliseconds.push(Math.round(performance.now() - began));
}
await page.evaluate(() => document.getElementById("viewport").scrollIntoView({ block: "center", behavior: "instant" }));
await page.waitForTimeout(500);
result.window = await played(page);
await page.setViewportSize({ width: 1100, height: 900 });
await page.evaluate(() => {
  const port = document.getElementById("viewport");
  Object.assign(port.style, { width: "800px", height: "600px" });
  document.getElementById("motion").style.gridTemplateColumns = "800px auto";
  port.scrollIntoView({ behavior: "instant" });
});
await page.waitForTimeout(500);
result.picture = await played(page);
console.log(JSON.stringify(result));
await browser.close();
rmSync(folder, { recursive: true });
