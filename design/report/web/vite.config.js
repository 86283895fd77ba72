// SPDX-License-Identifier: MIT
// One file with everything in it: dist/index.html, which finish.mjs makes into ../template.html.
import { defineConfig } from "vite";
import { viteSingleFile } from "vite-plugin-singlefile";

export default defineConfig({
  plugins: [viteSingleFile()],
  build: { target: "es2022", modulePreload: false, license: false },
});
