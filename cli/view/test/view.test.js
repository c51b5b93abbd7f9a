// The page of `nearmiss view`: it opens from disk, shows what `nearmiss picture` shows, and every
// control changes what is seen.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { PNG } from "pngjs";
import {
  common,
  CROSSING,
  differing,
  file,
  isBlue,
  isBody,
  isPurple,
  isRed,
  nearmiss,
  obj,
  Opened,
  SIZE,
  start,
  stop,
  where,
  written,
} from "./browser.js";

before(start);
after(stop);

/** A triangle that stands over another, or has passed it. */
const over = (z) =>
  `v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 ${z}\nv 2 1 ${z + 1}\nv 1 2 ${z + 1}\nf 1 2 3\nf 4 5 6\n`;

/** The picture of the program, at the size of the canvas. */
function pictured(...args) {
  const out = file("picture.png");
  nearmiss("picture", ...args, "--backend", "cpu", "--size", SIZE.join("x"), "--out", out);
  return PNG.sync.read(readFileSync(out));
}

test("the page shows what a picture shows, and needs no network", async () => {
  const scene = ["--scene", "draped", "--triangles", "2000", "--discrete"];
  const opened = await Opened.open(written("draped.html", ...scene));
  const [shot, picture] = [await opened.shot(), pictured(...scene)];
  assert(await opened.shows(shot), "the window shows what is drawn");
  assert(differing(shot, picture) > 0, "another picture is noticed");
  assert(common(where(shot, isBody), where(picture, isBody)) > 0.98, "outline");
  assert(common(where(shot, isRed), where(picture, isRed)) > 0.8, "contacts");
  // The picture from another side is another one.
  const other = pictured(...scene, "--view", "1,0,0.2");
  assert(common(where(shot, isBody), where(other, isBody)) < 0.9, "another view");
  assert.deepEqual(
    opened.requests.filter((url) => !/^(file|data):/.test(url)),
    [],
  );
  await opened.close();
});

test("scrubbing moves the bodies as a picture at that time shows them", async () => {
  const scene = [obj("a.obj", over(1)), obj("b.obj", over(-3))];
  const opened = await Opened.open(written("scrub.html", ...scene));
  const shots = [];
  for (const time of [0, 0.3, 1]) {
    await opened.slide("time", time);
    await opened.click("#fit");
    shots.push(await opened.shot());
    const picture = pictured(...scene, "--time", String(time));
    assert(common(where(shots.at(-1), isBody), where(picture, isBody)) > 0.96, `t = ${time}`);
  }
  assert(differing(shots[0], shots[1]) > 500 && differing(shots[1], shots[2]) > 500);
  await opened.close();
});

test("frames of a film have their names, places and rows", async () => {
  const files = [1, 2, 3].map((k) => obj(`film.${k}.obj`, over(3 - k - 0.5)));
  const opened = await Opened.open(written("film.html", ...files, "--discrete"));
  const seen = [];
  for (const at of [0, 1, 2]) {
    await opened.slide("moment", at);
    seen.push([await opened.text("#name"), await opened.text("#count"), await opened.shot()]);
  }
  assert.match(seen[2][0], /^frame 3 \(.*film\.3\.obj\)$/);
  assert.deepEqual(
    seen.map(([, count]) => count),
    ["no rows", "no rows", "1 to 1 of 1"],
  );
  assert(differing(seen[0][2], seen[1][2]) > 500);
  assert.deepEqual(
    seen.map(([, , shot]) => where(shot, isRed).size > 0),
    [false, false, true],
  );
  await opened.page.keyboard.press("ArrowLeft");
  assert.match(await opened.text("#name"), /^frame 2 /);
  await opened.close();
});

test("frames that were passed over are named with the reason", async () => {
  const files = [
    obj("gap.1.obj", "v 0 0\n"),
    obj("gap.2.obj", over(2)),
    obj("gap.3.obj", over(-0.5)),
  ];
  const out = file("gap.html");
  assert.throws(() => nearmiss("view", ...files, "--discrete", "--keep-going", "--out", out));
  const opened = await Opened.open(out);
  assert.match(await opened.text("#remarks"), /^not tested: .*gap\.1\.obj/);
  assert.equal(where(await opened.shot(), isBody).size, 0);
  await opened.slide("moment", 1);
  assert(where(await opened.shot(), isBody).size > 1000);
  await opened.slide("moment", 2);
  assert(where(await opened.shot(), isRed).size > 0);
  await opened.close();
});

/** Every query with rows, and a scene that has some. */
const queries = () => {
  const [a, b] = [obj("q0.obj", over(1)), obj("q1.obj", over(-3))];
  const other = obj("other.obj", "v 1 1 -1\nv 1.2 1 1\nv 1 1.2 1\nf 1 2 3\n");
  const crossing = obj("crossing.obj", CROSSING);
  return {
    discrete: [crossing],
    moller: [crossing, "--solver", "moller"],
    continuous: [a, b],
    near: [a, "--near", "1.5"],
    distance: [a, "--with", other, "--distance"],
    "body-pairs": [a, "--with", other, "--body-pairs"],
    "body-distances": [a, "--with", other, "--body-distances", "3"],
  };
};

for (const name of Object.keys(queries())) {
  test(`a picked row shows both of its features: ${name}`, async () => {
    const opened = await Opened.open(written(`${name}.html`, ...queries()[name]));
    const before = await opened.shot();
    assert.deepEqual([where(before, isBlue).size, where(before, isPurple).size], [0, 0]);
    await opened.click("#rows tbody tr");
    assert.equal(await opened.page.$$eval("tr.picked", (rows) => rows.length), 1);
    const picked = await opened.shot();
    assert(where(picked, isBlue).size > 20 && where(picked, isPurple).size > 20);
    if (name === "continuous") {
      assert.match(await opened.text("#t"), /^t = 0\.2(4|5)/);
    }
    // From near it is larger.
    await opened.click("#approach");
    const all = (shot) => where(shot, isBlue).size + where(shot, isPurple).size;
    assert(all(await opened.shot()) > 0);
    await opened.click("#fit");
    await opened.click("#rows tbody tr.picked");
    const after = await opened.shot();
    assert.deepEqual([where(after, isBlue).size, where(after, isPurple).size], [0, 0]);
    await opened.close();
  });
}

test("a triangle that is clicked lists its rows", async () => {
  const mesh = obj("clicked.obj", CROSSING);
  const opened = await Opened.open(written("clicked.html", mesh, "--view", "0,-1,0"));
  // As a picture places them: 18 wide in nine tenths of the canvas, the middle at x = 6.
  const place = (x, z) => [
    SIZE[0] / 2 + ((x - 6) * 0.9 * SIZE[0]) / 18,
    SIZE[1] / 2 - (z * 0.9 * SIZE[0]) / 18,
  ];
  await opened.page.mouse.click(...place(0, 1.5));
  assert(where(await opened.shot(), isBlue).size > 20, "the pair of the triangle is picked");
  await opened.page.mouse.click(...place(12, -1));
  assert.equal(await opened.text("#count"), "no rows (of 1)");
  assert.equal(where(await opened.shot(), isBlue).size, 0);
  await opened.page.mouse.click(3, 3);
  assert.equal(await opened.text("#count"), "1 to 1 of 1");
  await opened.close();
});

test("rows are listed a hundred at a time, in order or by time", async () => {
  const opened = await Opened.open(
    written("many.html", "--scene", "soup-moving", "--triangles", "400"),
  );
  const cells = (at) =>
    opened.page.$$eval(
      "#rows tbody tr",
      (rows, at) => rows.map(({ cells }) => cells[at].title || cells[at].textContent),
      at,
    );
  const all = Number((await opened.text("#count")).split(" of ")[1]);
  assert(all > 200);
  assert.deepEqual(
    await cells(0),
    Array.from({ length: 100 }, (_, k) => String(k)),
  );
  await opened.click("#after");
  assert.equal((await cells(0))[0], "100");
  await opened.page.select("#order", "toi");
  const head = await opened.page.$$eval("#rows th", (cells) =>
    cells.map((cell) => cell.textContent),
  );
  const times = (await cells(head.indexOf("toi"))).map(Number);
  assert.deepEqual(
    times,
    times.toSorted((a, b) => a - b),
  );
  await opened.page.keyboard.press("Escape");
  await opened.page.$eval("#order", (order) => order.blur());
  await opened.page.keyboard.press("ArrowDown");
  const first = await opened.page.$eval("tr.picked", (row) => row.rowIndex);
  assert.equal(first, 1);
  await opened.close();
});

test("a body that is off is not seen", async () => {
  const scene = [
    obj("left.obj", CROSSING),
    "--with",
    obj("right.obj", CROSSING.replaceAll(" 0 ", " 4 ")),
  ];
  const opened = await Opened.open(written("bodies.html", ...scene, "--view", "1,-2,0.5"));
  const both = where(await opened.shot(), isBody);
  const toggle = (at) => opened.click(`#bodies label:nth-child(${at}) input`);
  await toggle(1);
  const second = where(await opened.shot(), isBody);
  await toggle(2);
  assert.equal(where(await opened.shot(), isBody).size, 0);
  await toggle(1);
  const first = where(await opened.shot(), isBody);
  assert(first.size > 100 && second.size > 100 && common(first, second) < 0.5);
  assert(common(new Set([...first, ...second]), both) > 0.99);
  await toggle(2);
  assert.equal(common(where(await opened.shot(), isBody), both), 1);
  await opened.close();
});

test("the mouse turns the bodies, edges and see-through change them, play moves them", async () => {
  const opened = await Opened.open(
    written("controls.html", obj("c0.obj", over(1)), obj("c1.obj", over(-3))),
  );
  let last = await opened.shot();
  const changes = async (what, change) => {
    await change();
    const now = await opened.shot();
    assert(differing(last, now) > 100, what);
    last = now;
  };
  await changes("edges", () => opened.click("#edges"));
  await changes("see through", () => opened.click("#clear"));
  await changes("a drag", async () => {
    await opened.page.mouse.move(300, 250);
    await opened.page.mouse.down();
    await opened.page.mouse.move(400, 280, { steps: 4 });
    await opened.page.mouse.up();
  });
  await changes("the wheel", async () => {
    await opened.page.mouse.wheel({ deltaY: -500 });
    await opened.drawn();
  });
  await changes("a move", async () => {
    await opened.page.mouse.down({ button: "right" });
    await opened.page.mouse.move(300, 250, { steps: 4 });
    await opened.page.mouse.up({ button: "right" });
  });
  await changes("play", async () => {
    await opened.click("#play");
    await opened.page.waitForFunction(() => document.getElementById("time").value > 0.2);
    await opened.click("#play");
  });
  await changes("all bodies", () => opened.click("#fit"));
  await opened.close();
});

test("a body that turns goes on its arc", async () => {
  obj("bar.obj", "v 1 -0.5 0\nv 5 0 0\nv 1 0.5 0\nf 1 2 3\n");
  obj("ground.obj", "v -5 -5 -1\nv 5 -5 -1\nv 0 5 -1\nf 1 2 3\n");
  const scene = obj(
    "turn.toml",
    `[[body]]
name = "bar </script><b>"
mesh = "bar.obj"
kind = "rigid"
poses = [{}, { turn = [0, 0, 4.71238898038469] }]
[[body]]
name = "ground"
mesh = "ground.obj"
kind = "fixed"
`,
  );
  const opened = await Opened.open(written("turn.html", scene, "--view", "0,0,1", "--up", "0,1,0"));
  assert.match(await opened.text("#bodies"), /bar <\/script><b>: 1 triangle/);
  await opened.click("#bodies label:nth-child(2) input");
  const middle = async (time) => {
    await opened.slide("time", time);
    const pixels = [...where(await opened.shot(), isBody)];
    const mean = (of) => pixels.reduce((sum, pixel) => sum + of(pixel), 0) / pixels.length;
    return [
      mean((pixel) => pixel % SIZE[0]),
      mean((pixel) => -Math.floor(pixel / SIZE[0])),
      pixels.length,
    ];
  };
  const ends = [await middle(0), await middle(1)];
  // The pivot does not move. The bar points along x, then along -y: it has turned by 270 degrees.
  const half = [await middle(1 / 3), await middle(2 / 3)];
  const arm = ends[0][0] - ends[1][0];
  const pivot = [ends[1][0], ends[0][1]];
  const at = ([x, y]) => [x - pivot[0], y - pivot[1]].map((part) => Math.round((10 * part) / arm) / 10 + 0);
  assert.deepEqual([...ends, ...half].flatMap(at), [1, 0, 0, -1, 0, 1, -1, 0]);
  assert(
    half.every(([, , size]) => Math.abs(size / ends[0][2] - 1) < 0.1),
    "it stays rigid",
  );
  await opened.close();
});

test("bodies are seen from above, where up is towards the eye", async () => {
  const mesh = obj("above.obj", over(1));
  const opened = await Opened.open(written("above.html", mesh, "--view", "0,0,1"));
  assert(where(await opened.shot(), isBody).size > 10_000);
  await opened.close();
});

test("rods and points are seen", async () => {
  const mesh = obj("rods.obj", "v 0 0 0\nv 4 0 1\nv 0 4 0\nv 2 2 3\nf 1 2 2\nf 3 2 3\nf 4 4 4\n");
  const opened = await Opened.open(written("rods.html", mesh, "--near", "9"));
  assert(where(await opened.shot(), isBody).size > 200);
  await opened.click("#bodies input");
  assert.equal(where(await opened.shot(), isBody).size, 0);
  await opened.close();
});

test("a hundred thousand triangles are drawn, and the time is printed", async () => {
  const opened = await Opened.open(
    written("large.html", "--scene", "draped", "--triangles", "100000", "--discrete"),
  );
  await opened.click("#measure");
  const printed = await opened.text("#measured");
  assert.match(printed, /^[0-9.]+ ms a view$/);
  const begin = performance.now();
  await opened.slide("moment", 0);
  await opened.drawn();
  const shown = (performance.now() - begin).toFixed(0);
  console.log(`100,000 triangles, drawn by software: ${printed}; a frame is shown in ${shown} ms`);
  await opened.close();
});
