// SPDX-License-Identifier: MIT
// dist/index.html -> ../template.html: the page, with the hash of its sources, by which the tests tell whether it is older than they are.
import { createHash } from "node:crypto";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";

const folder = new URL(".", import.meta.url);
const names = ["finish.mjs", "index.html", "package-lock.json", "vite.config.js"];
for (const name of readdirSync(new URL("src/", folder))) names.push("src/" + name);

// SHA-256 over the files' names and contents, by name: tests/design/report/template_check does the same.
const hash = createHash("sha256");
for (const name of names.sort()) {
  const text = readFileSync(new URL(name, folder));
  hash.update(`${name} ${text.length}\n`).update(text);
}

const page = readFileSync(new URL("dist/index.html", folder), "utf8");
const marker = "@FETTLE_REPORT_DATA@";
if (page.split(marker).length !== 2) throw new Error(`the page must have ${marker} once`);
if (/\b(?:src|href)="(?!#|data:)/.test(page.replace(/<script[\s\S]*?<\/script>/g, ""))) throw new Error("the page asks for another file");
const sources = `<meta name="sources" content="${hash.digest("hex")}">`;
// What it holds of others, with their licences.
const licences = ["three", "uplot"].map((name) => `${name}\n${readFileSync(new URL(`node_modules/${name}/LICENSE`, folder), "utf8").trim()}`);
const made = page.replace("</title>", "</title>\n    " + sources).replace("<html", () => `<!--\n${licences.join("\n\n")}\n-->\n<html`);
writeFileSync(new URL("../template.html", folder), made);
console.log(`template.html: ${Math.round(made.length / 1000)} kB`);
