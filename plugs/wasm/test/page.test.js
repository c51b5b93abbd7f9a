// The page: meshes are dropped on it, and it shows what the native program writes.

import assert from "node:assert/strict";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, dirname, join } from "node:path";
import { after, before, test } from "node:test";
import puppeteer from "puppeteer-core";
import { BUILT, meshes, native } from "./native.js";

const PAGE = join(BUILT, "nearmiss.html");
/** Longest run, in milliseconds: a busy machine of two cores. */
const LONG = 300_000;
const files = meshes();
const folder = mkdtempSync(join(tmpdir(), "nearmiss-page-"));
let browser;

before(async () => {
  for (const [name, bytes] of Object.entries(files)) {
    mkdirSync(dirname(join(folder, name)), { recursive: true });
    writeFileSync(join(folder, name), bytes);
  }
  browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    protocolTimeout: LONG,
  });
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** An open page; faults in its console, and requests, are kept. */
class Opened {
  static async open(path = PAGE) {
    const opened = new Opened();
    Object.assign(opened, { page: await browser.newPage(), faults: [], requests: [] });
    const { page, faults, requests } = opened;
    page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
    page.on("pageerror", (error) => faults.push(String(error)));
    page.on("request", (request) => requests.push(request.url()));
    await page.goto(`file://${path}`);
    return opened;
  }

  /** Drops files on the page, as a hand does: by the events of a drag with these files. */
  async drop(...names) {
    const all = names.map((name) => ({
      name: basename(name),
      data: Buffer.from(files[name]).toString("base64"),
    }));
    await this.page.evaluate((all) => {
      const dragged = new DataTransfer();
      for (const { name, data } of all) {
        const bytes = Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0));
        dragged.items.add(new File([bytes], name));
      }
      for (const kind of ["dragover", "drop"]) {
        document.body.dispatchEvent(
          new DragEvent(kind, { dataTransfer: dragged, bubbles: true, cancelable: true }),
        );
      }
    }, all);
  }

  /** Chooses files by the button. */
  async choose(...names) {
    const input = await this.page.$("#choose");
    await input.uploadFile(...names.map((name) => join(folder, name)));
  }

  async set(id, value) {
    await this.page.$eval(`#${id}`, (part, value) => (part.value = value), value);
  }

  async click(selector) {
    await this.page.$eval(selector, (part) => part.click());
  }

  text(selector = "#text") {
    return this.page.$eval(selector, (part) => part.textContent);
  }

  /** Waits until the run has ended; its text. */
  async ended() {
    await this.page.waitForFunction(
      () => document.getElementById("stop").disabled && document.getElementById("text").textContent,
      { timeout: LONG },
    );
    return this.text();
  }

  /** A file that the run has written. */
  async written(name) {
    const data = await this.page.evaluate(async (name) => {
      const link = [...document.querySelectorAll("#written a")].find((a) => a.download === name);
      const bytes = new Uint8Array(await (await fetch(link.href)).arrayBuffer());
      return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
    }, name);
    return Buffer.from(data, "base64");
  }

  /** The page of `view` that is shown. */
  async shown() {
    const element = await this.page.waitForSelector("#result:not([hidden])");
    const frame = await element.contentFrame();
    await frame.waitForFunction(() => document.querySelector("#title")?.textContent);
    return frame;
  }

  async close() {
    assert.deepEqual(this.faults, []);
    assert.deepEqual(this.requests.filter((url) => !/^(file|data|blob):/.test(url)), []);
    await this.page.close();
  }
}

/** The page of the native program, with the name that the browser's files have. */
function viewed(args, given) {
  return native(["view", ...args, "--out", "view.html"], given).files["view.html"];
}

for (const name of ["t0.ply", "crossing.obj", "two.stl"]) {
  test(`${name} is dropped: the page of the native program, byte by byte`, async () => {
    const opened = await Opened.open();
    await opened.drop(name);
    const text = await opened.ended();
    assert.match(text, new RegExp(`^\\$ nearmiss view ${name} --out view.html\n`));
    const bytes = await opened.written("view.html");
    assert.equal(Buffer.compare(bytes, viewed([name], { [name]: files[name] })), 0);
    const frame = await opened.shown();
    assert.match(await frame.$eval("#title", (title) => title.textContent), /discrete query/);
    assert.equal(await frame.$eval("#fault", (fault) => fault.hidden), true);
    await opened.close();
  });
}

test("both ends of a step are chosen; hash and rows are those of the native program", async () => {
  const opened = await Opened.open();
  await opened.choose("t1.ply", "t0.ply");
  await opened.ended();
  const frame = await opened.shown();
  assert.match(await frame.$eval("#title", (title) => title.textContent), /continuous query/);
  await opened.set("command", "detect");
  await opened.set("options", "--json --min-separation 1e-3 --out 'my rows.csv'");
  await opened.click("#run");
  const text = await opened.ended();
  const args = ["detect", "t0.ply", "t1.ply", "--json", "--min-separation", "1e-3", "--out", "rows.csv"];
  const own = native(args, { "t0.ply": files["t0.ply"], "t1.ply": files["t1.ply"] });
  const hash = (text) => /"hash":"([0-9a-f]{16})"/.exec(text)[1];
  assert.equal(hash(text), hash(own.out));
  assert.equal(Buffer.compare(await opened.written("my rows.csv"), own.files["rows.csv"]), 0);
  await opened.close();
});

test("several files are bodies of one scene", async () => {
  const opened = await Opened.open();
  await opened.set("as", "bodies");
  await opened.set("options", "--discrete");
  await opened.drop("t0.ply", "crossing.obj");
  await opened.ended();
  const frame = await opened.shown();
  const bodies = await frame.$$eval("#bodies label", (all) => all.map((one) => one.textContent));
  assert.equal(bodies.length, 2);
  assert.match(bodies.join(), /crossing.*t0|t0.*crossing/);
  await opened.close();
});

test("a file is left out, and the rest is run again", async () => {
  const opened = await Opened.open();
  await opened.drop("t0.ply", "crossing.obj");
  assert.match(await opened.ended(), /exit status 3/, "two bodies are no step");
  await opened.click("#files button[title='leave out t0.ply']");
  await opened.click("#run");
  assert.match(await opened.ended(), /^\$ nearmiss view crossing.obj --out view.html\n/);
  await opened.shown();
  await opened.close();
});

test("a file with a fault is reported, and the page goes on", async () => {
  const opened = await Opened.open();
  await opened.drop("broken.ply");
  const text = await opened.ended();
  const said = native(["view", "broken.ply", "--out", "view.html"], files).err;
  assert(text.includes(said), text);
  assert.match(text, /exit status 3/);
  await opened.set("options", "--near");
  await opened.click("#example");
  assert.match(await opened.ended(), /exit status 2/);
  await opened.set("options", "");
  await opened.click("#example");
  assert.match(await opened.ended(), /view.html: 1 step/);
  await opened.shown();
  await opened.close();
});

test("a run is stopped", async () => {
  const opened = await Opened.open();
  await opened.set("options", "--triangles 3000000");
  await opened.click("#example");
  await opened.page.waitForSelector("#stop:not([disabled])");
  await opened.click("#stop");
  assert.match(await opened.ended(), /stopped\n$/);
  await opened.set("options", "");
  await opened.click("#example");
  assert.match(await opened.ended(), /view.html: 1 step/);
  await opened.close();
});

test("a page with a damaged program says so", async () => {
  const page = readFileSync(PAGE, "utf8");
  const start = page.indexOf('id="program">') + 'id="program">'.length;
  const damaged = `${page.slice(0, start + 4000)}AAAA${page.slice(start + 4004)}`;
  assert.notEqual(damaged, page);
  writeFileSync(join(folder, "damaged.html"), damaged);
  const opened = await Opened.open(join(folder, "damaged.html"));
  const fails = () => document.getElementById("note").textContent.startsWith("The program does not start: ");
  await opened.page.waitForFunction(fails, { timeout: LONG });
  await opened.click("#example");
  assert.doesNotMatch(await opened.ended(), /view.html: /);
  assert.deepEqual(opened.faults, []);
  await opened.page.close();
});
