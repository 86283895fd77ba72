// SPDX-License-Identifier: MIT
// Reports of three small runs in headless Chromium: they load without an error, a warning or a request, say what was reached, play, show the
// gap of a pair, section, hide, compare, print; by mouse and by keyboard; at the width of a phone nothing sticks out.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const { chromium } = await import(process.env.PLAYWRIGHT);
const folder = mkdtempSync(join(tmpdir(), "fettle_report_"));

// A box falls 0.02 mm onto a table that a motor tilts. Its name would end the page's data, and run, if it were taken for markup.
const nasty = `cube</script><img src=x onerror="window.hacked=1">`;
const scene = {
  fettle_scene: 1, description: "A cube on a tilting table.", units: "mm", gravity: [0, 0, -9.81], timestep: 0.005, end_time: 0.1, contact: { dhat: 0.1 },
  bodies: [
    { name: "table", type: "kinematic", shape: { generator: "box", dimensions: { size_x: 60, size_y: 60, size_z: 10 } }, position: [0, 0, -5], prescribed: { ry: { rate: 40 } } },
    { name: nasty, density: 1000, angular_velocity: [20, 10, 0], shape: { generator: "box", dimensions: { size_x: 20, size_y: 12, size_z: 10 } }, position: [3, 1, 5.12] },
    { name: "wall", type: "static", shape: { generator: "box", dimensions: { size_x: 5, size_y: 60, size_z: 60 } }, position: [40, 0, 0] },
  ],
};
const design = {
  fettle_design: 1, scene: "small.scene.json", units: "mm",
  parameters: [
    { name: "height", value: 10, lower: 6, upper: 14, moves: [{ body: nasty, dimension: "size_z" }, { body: nasty, position: [0, 0, 0.5], offset: [0, 0, 0.12] }] },
    { name: "place", value: 3, lower: -5, upper: 20, moves: [{ body: nasty, position: [1, 0, 0] }] },
  ],
  objective: [{ type: "mass", bodies: [nasty], weight: 1 }],
  constraints: [
    { type: "clearance", a: nasty, b: "wall", minimum: 15, motion: true },
    { type: "clearance", a: nasty, b: "wall", minimum: 16 },
  ],
  optimiser: { name: "mma", max_evaluations: 6 },
};
writeFileSync(join(folder, "small.scene.json"), JSON.stringify(scene));
writeFileSync(join(folder, "small.design.json"), JSON.stringify(design));

function fettle(...words) {
  try {
    return execFileSync(process.env.FETTLE_PROGRAM, words, { cwd: folder, stdio: ["ignore", "pipe", "pipe"] }).toString();
  } catch (error) {
    if (error.status > 2) throw new Error(`fettle ${words.join(" ")}: ${error.stdout}${error.stderr}`);
    return error.stdout.toString();
  }
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM,
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-sandbox"],
});

// A page, and what it complained of.
async function open(file, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 900 }, offline: true, ...options });
  const page = await context.newPage(), complaints = [];
  page.on("pageerror", (error) => complaints.push(String(error.stack)));
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !/GL Driver Message/.test(message.text()) && complaints.push(message.text()));
  page.on("request", (request) => !/^(file|data|blob):/.test(request.url()) && complaints.push(`asks for ${request.url()}`));
  await page.goto(pathToFileURL(join(folder, file)).href);
  await page.waitForFunction(() => window.fettleReport?.motion?.viewer.drawn > 0);
  return { page, complaints, close: () => context.close() };
}

// What the picture shows.
const shown = (page) => page.evaluate(() => window.fettleReport.motion.viewer.picture());
const differ = (a, b) => a !== b;

async function settled(page) {
  await page.waitForFunction(() => !window.fettleReport.motion.viewer.flight && !window.fettleReport.motion.viewer.asked);
}

async function checkOptimisation() {
  const { page, complaints, close } = await open("opt/report.html", { reducedMotion: "reduce" });
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.match(await page.title(), /^small/);
  assert.match(await page.locator("#reached").innerText(), /^(Optimal|Feasible)/);
  assert.match(await page.locator("#facts").innerText(), /2 of 2/);
  assert.ok((await page.locator("#parts").innerText()).includes(nasty), "names are told as they are");
  assert.match(await page.locator("footer").innerText(), /fettle optimise small\.design\.json --out opt/);

  const first = await shown(page);
  await page.locator("#play").click();
  await page.waitForFunction(() => window.fettleReport.motion.time > 0.01);
  await page.locator("#play").click();
  assert.ok(differ(first, await shown(page)), "playing moves the parts");
  assert.equal(await page.locator("#play").getAttribute("aria-label"), "Play");

  await page.locator("tr[data-pair='0'] button").click();
  await settled(page);
  assert.match(await page.locator("#overlay text").textContent(), /mm$/);
  assert.equal(await page.locator("#overlay line.gap").count(), 1);
  assert.match(await page.locator("#announce").innerText(), /^Shown: .*\smm apart at /);
  const pair = await page.evaluate(() => [window.fettleReport.data.pairs[0].time, window.fettleReport.motion.time]);
  assert.equal(pair[0], pair[1], "at its instant");
  assert.ok(await page.locator("#section").isChecked());
  await page.locator("[data-view=home]").click();
  await settled(page);
  assert.equal(await page.locator("#overlay text").count(), 0);

  const whole = await shown(page);
  await page.locator("#section").check();
  const cut = await shown(page);
  assert.ok(differ(whole, cut), "a section cuts");
  await page.locator("#section-flip").click();
  assert.ok(differ(cut, await shown(page)), "on either side");
  await page.locator("#section").uncheck();
  assert.ok(!differ(whole, await shown(page)), "and is undone");

  await page.locator("#parts input").first().uncheck();
  assert.ok(differ(whole, await shown(page)), "a part is hidden");
  await page.locator("#parts-all").click();
  await page.locator("#explode").fill("0.8");
  assert.ok(differ(whole, await shown(page)), "parts come apart");
  await page.locator("#explode").fill("0");
  for (const mode of ["before", "side", "fade", "after"]) {
    await page.locator(`#compare input[value=${mode}]`).check({ force: true });
    await settled(page);
    assert.equal(differ(whole, await shown(page)), mode !== "after", mode);
  }

  await page.locator("#canvas").focus();
  await page.keyboard.press("ArrowLeft");
  assert.ok(differ(whole, await shown(page)), "keys turn the view");
  await page.locator("#scrub").fill("0");
  await page.locator("#canvas").focus();
  await page.keyboard.press(".");
  assert.ok((await page.evaluate(() => window.fettleReport.motion.time)) > 0, "and step on");

  assert.equal(await page.locator("#sections .uplot canvas").count() >= 6, true, "curves are there");
  assert.ok((await page.pdf({ format: "A4" })).length > 30000, "prints");
  assert.deepEqual(complaints, []);
  await close();
}

async function checkPhone(file) {
  for (const colorScheme of ["light", "dark"]) {
    const { page, complaints, close } = await open(file, { viewport: { width: 390, height: 844 }, colorScheme });
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, "nothing sticks out");
    const paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number));
    assert.equal(paper[0] < 128, colorScheme === "dark");
    const unnamed = await page.evaluate(() => [...document.querySelectorAll("button, input, select, #canvas")].filter((e) =>
      e.offsetParent && !(e.getAttribute("aria-label") || e.labels?.length || e.textContent.trim())).map((e) => e.outerHTML));
    assert.deepEqual(unnamed, [], "every control has a name");
    assert.deepEqual(complaints, []);
    await close();
  }
}

try {
  fettle("optimise", "small.design.json", "--out", "opt", "--quiet");
  await checkOptimisation();
  fettle("simulate", "small.scene.json", "--out", "sim", "--quiet");
  await checkPhone("sim/report.html");
  fettle("clearance", "small.scene.json", "--motion", "--minimum", "1mm", "--out", "fit", "--quiet");
  await checkPhone("fit/report.html");
  assert.ok(readFileSync(join(folder, "sim/report.html")).length < 1.1e6, "small");
  console.log("reports open, play, section and print");
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}
