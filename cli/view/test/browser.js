// A page in headless Chromium, as a reader has it: opened from disk, seen by screenshots.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { PNG } from "pngjs";
import puppeteer from "puppeteer-core";

/** Width of the window next to the canvas, as page.css has it. */
const ASIDE = 440;
/** The canvas in the tests. */
export const SIZE = [620, 500];

export const folder = mkdtempSync(join(tmpdir(), "nearmiss-view-"));
export const file = (name) => join(folder, name);

let browser;

export async function start() {
  browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
    protocolTimeout: 600_000,
  });
}

export async function stop() {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}

/** Runs the program. */
export function nearmiss(...args) {
  assert(process.env.NEARMISS, "NEARMISS must be the path of the program");
  return execFileSync(process.env.NEARMISS, args, {
    encoding: "utf8",
    stdio: ["ignore", "pipe", "pipe"],
  });
}

/** Writes a mesh; its path. */
export function obj(name, text) {
  writeFileSync(file(name), text);
  return file(name);
}

/** Two triangles across each other, and one to their right. */
export const CROSSING = `v -3 0 -3
v 3 0 -3
v 0 0 3
v -1 -1 0
v 1 -1 0
v 0 1 0
v 9 0 -3
v 15 0 -3
v 12 0 3
f 1 2 3
f 4 5 6
f 7 8 9
`;

/** Writes a page by `nearmiss view`; its path. */
export function written(name, ...args) {
  const out = file(name);
  nearmiss("view", ...args, "--backend", "cpu", "--out", out);
  return out;
}

/** An open page, with all faults and all files that it has requested. */
export class Opened {
  constructor(page) {
    Object.assign(this, { page, faults: [], requests: [] });
    page.on("console", (message) => message.type() === "error" && this.faults.push(message.text()));
    page.on("pageerror", (error) => this.faults.push(String(error)));
    page.on("request", (request) => this.requests.push(request.url()));
  }

  static async open(path, [width, height] = SIZE) {
    const page = await browser.newPage();
    await page.setViewport({ width: width + ASIDE, height });
    const opened = new Opened(page);
    await page.goto(`file://${path}`, { timeout: 300_000 });
    await opened.drawn();
    return opened;
  }

  /** Waits until the page has drawn. */
  async drawn() {
    await this.page.evaluate(
      () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
    );
  }

  /** The pixels of the canvas, as they are drawn for the state of the page. */
  async shot() {
    const url = await this.page.evaluate(async () => {
      // The page draws again, before this goes on in the same frame.
      document.getElementById("edges").dispatchEvent(new Event("change"));
      await new Promise(requestAnimationFrame);
      return document.getElementById("canvas").toDataURL();
    });
    return PNG.sync.read(Buffer.from(url.split(",")[1], "base64"));
  }

  /** Whether the window shows these pixels; on a busy machine that takes a while. */
  async shows(shot) {
    const clip = { x: 0, y: 0, width: shot.width, height: shot.height };
    for (let left = 20; left > 0; left--) {
      const window = PNG.sync.read(Buffer.from(await this.page.screenshot({ clip })));
      if (differing(window, shot) === 0) {
        return true;
      }
    }
    return false;
  }

  text(selector) {
    return this.page.$eval(selector, (element) => element.textContent);
  }

  /** Moves a slider. */
  async slide(id, value) {
    await this.page.$eval(
      `#${id}`,
      (slider, value) => {
        slider.value = value;
        slider.dispatchEvent(new Event("input"));
      },
      value,
    );
  }

  async click(selector) {
    await this.page.$eval(selector, (element) => element.click());
  }

  /** Closes a page that has had no fault. */
  async close() {
    assert.deepEqual(this.faults, []);
    assert.equal(await this.page.$eval("#fault", (fault) => fault.hidden), true);
    await this.page.close();
  }
}

const PAPER = [246, 247, 249];

/** Whether two colours are the same but for light and rounding. */
const near = (a, b, by) => a.every((part, k) => Math.abs(part - b[k]) <= by);

/** The places of all pixels of a kind. */
export function where({ data }, is) {
  const found = new Set();
  for (let k = 0; k < data.length; k += 4) {
    if (is([data[k], data[k + 1], data[k + 2]])) {
      found.add(k / 4);
    }
  }
  return found;
}

export const isBody = (pixel) => !near(pixel, PAPER, 3);
export const isRed = ([r, g, b]) => r > 2.5 * g && r > 2.5 * b;
/** The first feature of a picked row, and the second. */
export const isBlue = ([r, g, b]) => b > 1.6 * g && b > 2.5 * r;
export const isPurple = ([r, g, b]) => r > 3 * g && b > 2.5 * g;

/** How much of two sets of pixels is common to both: 1 if they are equal. */
export function common(a, b) {
  const both = [...a].filter((pixel) => b.has(pixel)).length;
  return both / (a.size + b.size - both);
}

/** How many pixels differ. */
export function differing(a, b) {
  assert.equal(a.data.length, b.data.length);
  return where(a, () => true).size - same(a, b);
}

function same(a, b) {
  let count = 0;
  for (let k = 0; k < a.data.length; k += 4) {
    count += near([...a.data.subarray(k, k + 3)], [...b.data.subarray(k, k + 3)], 2) ? 1 : 0;
  }
  return count;
}
