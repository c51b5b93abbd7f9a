// The page of `nearmiss view`: bodies that move through frames, and rows whose features are shown.

import * as three from "three";
import { Eye } from "./camera.js";
import { read } from "./data.js";
import { isOf, Picked } from "./features.js";
import { Places } from "./places.js";
import { Rows } from "./rows.js";
import { Surface } from "./surface.js";

/** Views that are drawn to measure the time of one, all around. */
const VIEWS = 36;
/** Milliseconds that a step is played for, and a frame at rest. */
const STEP = 1200;
const FRAME = 250;

const by = (id) => document.getElementById(id);

class View {
  constructor() {
    // Colours are those of the files: no conversion.
    three.ColorManagement.enabled = false;
    this.scene = read();
    this.places = new Places(this.scene);
    this.surface = new Surface(this.scene);
    this.picked = new Picked();
    this.renderer = new three.WebGLRenderer({ canvas: by("canvas"), antialias: true });
    this.renderer.outputColorSpace = three.LinearSRGBColorSpace;
    this.renderer.setClearColor(0xf6f7f9);
    this.eye = new Eye(by("canvas"), this.scene, () => this.draw());
    this.stage = new three.Scene();
    const sky = new three.HemisphereLight(0xffffff, 0xffffff, 1.75);
    this.stage.add(...this.surface.objects, this.picked.group, this.eye.camera, sky);
    this.rows = new Rows(this.scene, (row) => this.pick(row));
    this.controls();
    this.resize();
    this.go(0);
    window.addEventListener("resize", () => this.resize());
  }

  controls() {
    const { moments, bodies, title } = this.scene;
    document.title = title;
    by("title").textContent = title;
    by("moment").max = moments.length - 1;
    by("moment").hidden = moments.length === 1;
    by("time-line").hidden = this.scene.at_rest;
    by("play").hidden = moments.length === 1 && this.scene.at_rest;
    by("moment").oninput = () => this.go(Number(by("moment").value));
    by("time").oninput = () => this.move(Number(by("time").value));
    by("play").onclick = () => (this.playing ? this.stop() : this.play());
    by("fit").onclick = () => this.eye.fit(this.surface);
    by("approach").onclick = () => this.eye.approach(this.sphere);
    by("measure").onclick = () => this.measure();
    by("edges").onchange = () => this.set(() => (this.surface.lines.visible = by("edges").checked));
    by("clear").onchange = () => this.set(() => this.surface.clear(by("clear").checked));
    bodies.forEach((body, at) => this.body(body, at));
    let down;
    by("canvas").addEventListener(
      "pointerdown",
      ({ clientX, clientY }) => (down = [clientX, clientY]),
    );
    by("canvas").addEventListener("click", (event) => {
      // A drag turns the bodies.
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) {
        this.point(event);
      }
    });
    document.addEventListener("keydown", (event) => this.key(event));
  }

  /** A line of the list of bodies. */
  body({ name, faces }, at) {
    const line = document.createElement("label");
    const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: true });
    box.onchange = () => this.set(() => this.surface.show(at, box.checked));
    line.append(box, `${name}: ${faces} ${faces === 1 ? "triangle" : "triangles"}`);
    by("bodies").append(line);
  }

  set(change) {
    change();
    this.draw();
  }

  /** Goes to a step or frame, and to its start. */
  go(at) {
    this.moment = this.scene.moment(at);
    by("moment").value = at;
    const { step, frame, file, reason, remarks } = this.moment;
    const name = `${this.scene.at_rest ? "frame" : "step"} ${frame ?? step}`;
    by("name").textContent = file === undefined ? name : `${name} (${file})`;
    by("remarks").replaceChildren();
    for (const remark of reason === undefined ? remarks : [`not tested: ${reason}`]) {
      by("remarks").append(Object.assign(document.createElement("p"), { textContent: remark }));
    }
    this.unpick();
    this.surface.paint(this.moment.met ?? []);
    this.rows.list(this.moment);
    this.move(0);
  }

  /** Goes to a time of the step. */
  move(time) {
    this.time = time;
    by("time").value = time;
    by("t").textContent = `t = ${time.toFixed(4)}`;
    // A moment that is not tested has no places.
    if (this.moment.reason === undefined) {
      this.places.move(this.moment, time);
      this.surface.move(this.places.now);
      this.first();
    }
    this.show();
    this.draw();
  }

  /** Shows all bodies, when they have places for the first time. */
  first() {
    if (!this.isFitted) {
      this.isFitted = true;
      this.eye.fit(this.surface);
    }
  }

  /** Picks a row; its features are shown at the time of contact. */
  pick(row) {
    this.stop();
    this.row = row;
    by("approach").disabled = row === undefined;
    const toi = row === undefined ? undefined : this.moment.row(row).toi;
    this.move(toi ?? this.time);
  }

  unpick() {
    this.row = undefined;
    by("approach").disabled = true;
  }

  /** Draws the features of the picked row. */
  show() {
    if (this.row === undefined) {
      this.picked.clear();
      return;
    }
    this.sphere = this.picked.draw(this.scene, this.moment.row(this.row), this.places);
  }

  /** Lists the rows of the triangle in a place of the canvas; all rows, if there is none. */
  point({ offsetX, offsetY }) {
    const { clientWidth, clientHeight } = by("canvas");
    const place = new three.Vector2(
      (2 * offsetX) / clientWidth - 1,
      1 - (2 * offsetY) / clientHeight,
    );
    const ray = new three.Raycaster();
    ray.setFromCamera(place, this.eye.camera);
    const hit = ray.intersectObject(this.surface.mesh)[0];
    const rows = hit && this.rowsOf(Math.floor(hit.face.a / 3));
    this.unpick();
    this.show();
    this.rows.list(this.moment, rows);
    if (rows?.length > 0) {
      this.rows.pick(rows[0]);
    }
    this.draw();
  }

  /** The rows of a triangle, and of its vertices and edges. */
  rowsOf(face) {
    const all = Array.from({ length: this.moment.rows }, (_, row) => row);
    return all.filter((row) => isOf(this.scene, this.moment.row(row), face));
  }

  key(event) {
    // Sliders and lists have arrows of their own; boxes and buttons take the space bar.
    const hasArrows = event.target.matches("input[type=range], select");
    const takesSpace = event.target.matches("input, select, button, summary");
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    const go = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (step && !hasArrows) {
      this.rows.step(step);
    } else if (go && !hasArrows) {
      this.go(Math.min(Math.max(this.moment.at + go, 0), this.scene.moments.length - 1));
    } else if (event.key === " " && !takesSpace) {
      by("play").click();
    } else {
      return;
    }
    event.preventDefault();
  }

  play() {
    by("play").textContent = "stop";
    let last;
    const tick = (now) => {
      const passed = now - (last ?? now);
      last = now;
      this.advance(passed);
      this.playing = requestAnimationFrame(tick);
    };
    this.playing = requestAnimationFrame(tick);
  }

  stop() {
    cancelAnimationFrame(this.playing);
    this.playing = undefined;
    by("play").textContent = "play";
  }

  /** Plays on by so many milliseconds. */
  advance(passed) {
    const next = () => this.go((this.moment.at + 1) % this.scene.moments.length);
    if (this.scene.at_rest) {
      this.waited = (this.waited ?? 0) + passed;
      if (this.waited >= FRAME) {
        this.waited = 0;
        next();
      }
    } else if (this.time >= 1) {
      next();
    } else {
      this.move(Math.min(1, this.time + passed / STEP));
    }
  }

  resize() {
    const { clientWidth, clientHeight } = by("stage");
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(Math.max(1, clientWidth), Math.max(1, clientHeight), false);
    this.eye.resize(Math.max(1, clientWidth), Math.max(1, clientHeight));
    this.draw();
  }

  /** Draws before the next frame of the screen, once. */
  draw() {
    this.drawing ??= requestAnimationFrame(() => {
      this.drawing = undefined;
      this.render();
    });
  }

  render() {
    this.renderer.render(this.stage, this.eye.camera);
  }

  /** Draws views all around, and prints the time of one. */
  measure() {
    const gl = this.renderer.getContext();
    const pixel = new Uint8Array(4);
    const drawn = () => {
      this.render();
      // The pixel is there when all is drawn.
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    };
    drawn();
    const begin = performance.now();
    for (let view = 0; view < VIEWS; view++) {
      this.eye.turn((2 * Math.PI) / VIEWS);
      drawn();
    }
    by("measured").textContent = `${((performance.now() - begin) / VIEWS).toFixed(1)} ms a view`;
  }
}

// A fault is shown, and stays in the console.
window.addEventListener("error", ({ message }) => {
  by("fault").textContent = `This page cannot be shown: ${message}`;
  by("fault").hidden = false;
});
new View();
