// Tests a mesh of this folder, and writes its rows: `node rows.js`. The program is here, too.

import { readFile, writeFile } from "node:fs/promises";
import { run } from "nearmiss-wasm";

const program = await WebAssembly.compile(await readFile("nearmiss.wasm"));
const files = { "cloth.ply": await readFile("cloth.ply") };
const args = ["detect", "cloth.ply", "--json", "--out", "rows.csv"];
const { status, out, err, files: written } = await run(program, args, files);
if (status !== 0) throw new Error(err);
const { contacts, hash } = JSON.parse(out);
const rows = written["rows.csv"]; // a Uint8Array
console.log(`${contacts} contacts, hash ${hash}`);
await writeFile("rows.csv", rows);
