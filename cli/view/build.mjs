// Makes the page without data: `node build.mjs OUT.gz`, or `node build.mjs --check COMMITTED.gz`.
// One file that needs no network: HTML, style, the licence of three.js, and one minified script.

import { build } from "esbuild";
import { createHash } from "node:crypto";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { gunzipSync, gzipSync } from "node:zlib";

const read = (name) => readFileSync(new URL(name, import.meta.url), "utf8");

/** A digest of all sources: cli/tests/cli/view.rs computes the same. */
function digest() {
  const sources = readdirSync(new URL("src", import.meta.url)).map((name) => `src/${name}`);
  const hash = createHash("sha256");
  for (const name of [...sources, "build.mjs", "package-lock.json", "three.LICENSE"].sort()) {
    hash.update(`${name}\n${read(name)}`);
  }
  return hash.digest("hex");
}

async function page() {
  const { outputFiles } = await build({
    entryPoints: [new URL("src/main.js", import.meta.url).pathname],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    // The licence is in the page, once.
    legalComments: "none",
  });
  const licence = read("three.LICENSE");
  if (licence !== read("node_modules/three/LICENSE")) {
    throw new Error("three.LICENSE is not the licence of node_modules/three; copy it");
  }
  const parts = {
    sources: digest(),
    style: read("src/page.css"),
    licence,
    script: outputFiles[0].text,
  };
  const filled = Object.entries(parts).reduce(
    (text, [name, part]) => text.replace(`/*${name}*/`, () => part.trim()),
    read("src/page.html"),
  );
  if (filled.split("<!--data-->").length !== 2) {
    throw new Error("the page must have one place for its data");
  }
  return filled;
}

const [first, second] = process.argv.slice(2);
if (first === "--check") {
  if (gunzipSync(readFileSync(second)).toString("utf8") !== (await page())) {
    console.error(`${second} is not what cli/view/build.sh makes; run it and commit the page`);
    process.exit(1);
  }
} else {
  writeFileSync(first, gzipSync(await page(), { level: 9 }));
}
