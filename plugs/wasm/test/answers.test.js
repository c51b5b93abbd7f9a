// The program gives the answers of the native one: status, text and files, byte by byte.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { test } from "node:test";
import { WASI } from "node:wasi";
import { run } from "../src/nearmiss.js";
import { BUILT, meshes, native } from "./native.js";

const program = await WebAssembly.compile(readFileSync(join(BUILT, "nearmiss.wasm")));
const files = meshes();

/** Text without times, bytes, names of machines and ways of a system to say no. */
const still = (text) =>
  text
    .replace(/[\d.]+ m?s, [\d.]+ MB/g, "")
    .replace(/"ms":{[^}]*}|"device":"[^"]*"|"bytes":\d+/g, "")
    .replace(/\(os error \d+\)/g, "");

/** What differs between two results; undefined if nothing does. */
function difference(a, b) {
  if (a.status !== b.status) return `status ${a.status} and ${b.status}: ${a.err} ${b.err}`;
  if (still(a.out) !== still(b.out)) return `output ${a.out} and ${b.out}`;
  if (still(a.err) !== still(b.err)) return `errors ${a.err} and ${b.err}`;
  const names = [a, b].map((one) => Object.keys(one.files).sort().join());
  if (names[0] !== names[1]) return `files ${names[0]} and ${names[1]}`;
  const alike = (name) =>
    name.endsWith(".json")
      ? still(`${Buffer.from(a.files[name])}`) === still(`${Buffer.from(b.files[name])}`)
      : Buffer.compare(a.files[name], b.files[name]) === 0;
  return Object.keys(a.files).find((name) => !alike(name));
}

const STEP = ["t0.ply", "t1.ply"];
const QUESTIONS = [
  ["detect", ...STEP, "--out", "rows.csv"],
  ["detect", ...STEP, "--json"],
  ["detect", ...STEP, "--out", "rows.csv.gz"],
  ["detect", ...STEP, "--earliest", "--first-contacts", "--json"],
  ["detect", ...STEP, "--min-separation", "1e-3", "--json"],
  ["detect", "t0.ply", "--near", "0.01", "--out", "rows.json"],
  ["detect", "t0.ply", "--discrete", "--bounding-volume", "obb", "--json"],
  ["detect", "crossing.obj", "--out", "rows.vtp", "--out-mesh", "painted.ply"],
  ["detect", "two.stl", "--out", "deep/rows.csv"],
  ["detect", "shot/*.ply", "--discrete", "--out", "film.csv"],
  ["detect", "scene.toml", "--discrete", "--json"],
  ["detect", "scene.toml", "--distance", "--json"],
  ["detect", "--scene", "soup-moving", "--triangles", "3000", "--continuous", "--json"],
  ["view", ...STEP, "--out", "view.html"],
  ["picture", ...STEP, "--out", "picture.png"],
  ["check", "crossing.obj"],
  ["check", "t0.ply"],
  // Faults: the same words and the same exit status.
  ["detect", "broken.ply"],
  ["detect", "nothing.ply"],
  ["detect", "t0.ply", "--near", "-1"],
  ["detect", "t0.ply", "--out", "t0.ply"],
  ["detect", "t0.ply", "--backend", "cuda"],
  ["detect", "-"],
];

for (const args of QUESTIONS) {
  test(`nearmiss ${args.join(" ")}`, async () => {
    const ours = await run(program, args, files);
    assert.equal(difference(ours, native(args, files)), undefined);
  });
}

test("the package has the version of the program", async () => {
  const { version } = JSON.parse(readFileSync(new URL("../package.json", import.meta.url), "utf8"));
  assert.equal((await run(program, ["--version"])).out, `nearmiss ${version}\n`);
});

test("a result that differs is noticed", async () => {
  const args = ["detect", ...STEP, "--out", "rows.csv"];
  const right = await run(program, args, files);
  const rows = right.files["rows.csv"].slice();
  assert(rows.length > 1000 && right.status === 0);
  rows[500] ^= 1;
  const faults = [
    { status: 1 },
    { out: right.out.replace(/\d/, "x") },
    { err: "a word" },
    { files: {} },
    { files: { "rows.csv": rows } },
  ];
  for (const fault of faults) {
    assert.notEqual(difference({ ...right, ...fault }, right), undefined);
  }
  assert.equal(difference(right, right), undefined);
});

test("another host of WASI gives the same, in a folder of the disk", async () => {
  const folder = mkdtempSync(join(tmpdir(), "nearmiss-wasi-"));
  try {
    for (const name of STEP) writeFileSync(join(folder, name), files[name]);
    const nearmiss = async (...args) => {
      const host = new WASI({
        version: "preview1",
        args: ["nearmiss", ...args],
        preopens: { ".": folder },
        returnOnExit: true,
      });
      return host.start(await WebAssembly.instantiate(program, host.getImportObject()));
    };
    const { files: expected } = native(["detect", ...STEP, "--out", "rows.csv"], files);
    const rows = () => readFileSync(join(folder, "rows.csv"));
    writeFileSync(join(folder, "rows.csv"), "old\n");
    assert.equal(await nearmiss("detect", ...STEP, "--out", "rows.csv"), 0);
    assert.equal(Buffer.compare(rows(), expected["rows.csv"]), 0);
    // A file that is read is not written over, by any of its names.
    for (const name of ["t0.ply", "./t0.ply", "././t0.ply"]) {
      assert.equal(await nearmiss("detect", "t0.ply", "--out-mesh", name), 2, name);
      assert.equal(Buffer.compare(readFileSync(join(folder, "t0.ply")), files["t0.ply"]), 0, name);
    }
    assert.deepEqual(readdirSync(folder).sort(), ["rows.csv", "t0.ply", "t1.ply"]);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});

test("the example finds the rows of the native program", () => {
  const folder = mkdtempSync(join(tmpdir(), "nearmiss-example-"));
  try {
    writeFileSync(join(folder, "nearmiss.wasm"), readFileSync(join(BUILT, "nearmiss.wasm")));
    writeFileSync(join(folder, "cloth.ply"), files["t0.ply"]);
    const example = new URL("../examples/rows.js", import.meta.url).pathname;
    const said = execFileSync(process.execPath, [example], { cwd: folder, encoding: "utf8" });
    const args = ["detect", "t0.ply", "--json", "--out", "rows.csv"];
    const own = native(args, files);
    const { contacts, hash } = JSON.parse(own.out);
    assert.equal(said, `${contacts} contacts, hash ${hash}\n`);
    const rows = readFileSync(join(folder, "rows.csv"));
    assert.equal(Buffer.compare(rows, own.files["rows.csv"]), 0);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});

test("all kernels are right to the bit", async () => {
  const { status, out, err } = await run(program, ["selftest", "--triangles", "500", "--cases", "10"]);
  assert.equal(status, 0, out + err);
  assert.match(out, /CPU, 1 thread/);
});

test("a file that is there is replaced, and the others are not returned", async () => {
  const old = { ...files, "rows.csv": new TextEncoder().encode("old\n") };
  const { files: written } = await run(program, ["detect", ...STEP, "--out", "rows.csv"], old);
  assert.deepEqual(Object.keys(written), ["rows.csv"]);
  assert.equal(new TextDecoder().decode(old["rows.csv"]), "old\n", "the caller's bytes stay");
});

test("text is passed on as it is printed", async () => {
  const texts = { out: "", err: "" };
  const printed = { out: (text) => (texts.out += text), err: (text) => (texts.err += text) };
  const { out, err, stdout } = await run(program, ["detect", "broken.ply"], files, printed);
  assert.deepEqual(texts, { out, err });
  assert(err.startsWith("nearmiss: broken.ply"), err);
  assert.equal(stdout.length, 0);
});

test("standard output is there as bytes", async () => {
  const args = ["detect", ...STEP, "--out", "-"];
  const { stdout } = await run(program, args, files);
  assert.equal(Buffer.compare(stdout, native(args, files).stdout), 0);
});

for (const name of ["/t0.ply", "../t0.ply", "a//b.ply", "./t0.ply", ""]) {
  test(`the name "${name}" is refused`, async () => {
    await assert.rejects(run(program, ["detect", name], { [name]: files["t0.ply"] }), /relative names/);
  });
}

test("a file that is a folder too is refused", async () => {
  const both = { a: files["t0.ply"], "a/b.ply": files["t0.ply"] };
  await assert.rejects(run(program, ["detect", "a"], both), /a is a file and a folder/);
  const turned = { "a/b.ply": files["t0.ply"], a: files["t0.ply"] };
  await assert.rejects(run(program, ["detect", "a"], turned), /a is a file and a folder/);
});

test("a scene that exceeds the memory is an error, and no half answer", async () => {
  const args = ["--scene", "identical", "--triangles", "24000", "--broad-phase", "tree"];
  const { status, err, files: written } = await run(program, ["detect", ...args, "--out", "rows.csv"]);
  assert.equal(status, 4, err);
  const [, asked, free] = err.match(/: (\d+) bytes were needed and (\d+) were free;/).map(Number);
  assert(asked >= (24000 * 23999 * 8) / 2 && free < asked, err);
  assert.deepEqual(written, {});
});
