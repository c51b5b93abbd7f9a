// A page with broken data says so, and the tests see it.

import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { CROSSING, file, obj, Opened, start, stop, written } from "./browser.js";

before(start);
after(stop);

/** A page with a fault in its data, by its text. */
function planted(name, change) {
  const text = readFileSync(written("sound.html", obj("sound.obj", CROSSING)), "utf8");
  const faulty = change(text);
  assert.notEqual(faulty, text, `no fault was planted: ${name}`);
  writeFileSync(file("faulty.html"), faulty);
  return file("faulty.html");
}

const blob = (id) => new RegExp(`(<script type="text/plain" id="${id}">)([^<]*)`);
const u32 = (...all) => Buffer.from(Uint32Array.from(all).buffer).toString("base64");

const FAULTS = {
  "places that are cut": (text) =>
    text.replace(blob("places-0"), (_, head, data) => head + data.slice(0, -16)),
  "a place that is no number": (text) =>
    text.replace(blob("places-0"), (_, head, data) => head + "AADAfw" + data.slice(6)),
  "places that are missing": (text) => text.replace('id="places-0"', 'id="places-9"'),
  "faces that are no base64": (text) => text.replace(blob("faces"), "$1?$2"),
  "an index beyond the vertices": (text) =>
    text.replace(blob("faces"), (_, head) => head + u32(0, 1, 2, 3, 4, 9, 6, 7, 8)),
  "a triangle beyond the faces": (text) =>
    text.replace(blob("words-0"), (_, head) => head + u32(0, 0, 0, 3, 0)),
  "a body that is not there": (text) =>
    text.replace(blob("words-0"), (_, head) => head + u32(1, 0, 0, 1, 0)),
  "a kind that has no name": (text) =>
    text.replace(blob("words-0"), (_, head) => head + u32(0, 0, 0, 1, 4)),
  "another number of rows": (text) => text.replace('"rows":1', '"rows":2'),
  "another format": (text) => text.replace('"format":1', '"format":2'),
  "a head that is cut": (text) => text.replace('{"format"', '{"form'),
};

for (const [name, change] of Object.entries(FAULTS)) {
  test(`a page with ${name} says so`, async () => {
    const opened = await Opened.open(planted(name, change));
    assert(opened.faults.length > 0, "no fault in the console");
    assert.match(await opened.text("#fault"), /^This page cannot be shown: .+/);
    await assert.rejects(opened.close());
    await opened.page.close();
  });
}
