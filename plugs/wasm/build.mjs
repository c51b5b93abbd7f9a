// Makes the page: `node build.mjs NEARMISS.wasm OUT.html`. One file that needs no network.

import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";

const path = (name) => new URL(name, import.meta.url).pathname;
const read = (name) => readFileSync(path(name), "utf8");

async function script(name) {
  const { outputFiles } = await build({
    entryPoints: [path(name)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    // The licence is in the page, once.
    legalComments: "none",
  });
  // No text ends the script that holds it.
  return outputFiles[0].text.replaceAll("</script", "<\\/script");
}

const [program, out] = process.argv.slice(2);
const parts = {
  "/*style*/": read("page/page.css"),
  "/*licence*/": read("node_modules/@bjorn3/browser_wasi_shim/LICENSE-MIT"),
  "<!--program-->": gzipSync(readFileSync(program), { level: 9 }).toString("base64"),
  "/*worker*/": await script("page/worker.js"),
  "/*script*/": await script("page/page.js"),
};
const page = Object.entries(parts).reduce((text, [place, part]) => {
  if (text.split(place).length !== 2) {
    throw new Error(`page.html must have one place for ${place}`);
  }
  return text.replace(place, () => part.trim());
}, read("page/page.html"));
writeFileSync(out, page);
