// The eye. Parallel lines stay parallel, as in the pictures of `nearmiss picture`.

import * as three from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

/** How much of the window the bodies take. */
const FILLED = 0.9;
/** Distance of the eye, beyond the scene, whose places are within a cube of side 1. */
const AWAY = 4;
/** Most of a window that picked features take, and the least length that fills one. */
const CLOSE = 0.2;
const LEAST = 1e-5;

export class Eye {
  constructor(canvas, { view, up }, changed) {
    this.camera = new three.OrthographicCamera();
    this.camera.near = 0;
    this.camera.far = 2 * AWAY;
    this.camera.up.fromArray(up);
    this.camera.position.fromArray(view).setLength(AWAY);
    // Light from the upper left, in front.
    const lamp = new three.DirectionalLight(0xffffff, 1.7);
    lamp.position.set(-0.45, 0.75, 0.65);
    this.camera.add(lamp, lamp.target);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxZoom = 1 / LEAST;
    this.controls.addEventListener("change", changed);
    // Width by height, and half the height that the window shows.
    this.aspect = 1;
    this.half = 1;
  }

  /** Takes the sides of the window. */
  resize(width, height) {
    this.aspect = width / height;
    const [half, wide] = [this.half, this.half * this.aspect];
    Object.assign(this.camera, { top: half, bottom: -half, left: -wide, right: wide });
    this.camera.updateProjectionMatrix();
  }

  /** Shows all of a surface, from the same direction. */
  fit({ position, mesh }) {
    const { camera, controls } = this;
    camera.updateMatrixWorld();
    const [right, up, back] = [0, 1, 2].map((k) =>
      new three.Vector3().setFromMatrixColumn(camera.matrixWorld, k),
    );
    const box = new three.Box3();
    const point = new three.Vector3();
    for (const { start, count } of mesh.geometry.groups) {
      for (let corner = start; corner < start + count; corner++) {
        point.fromBufferAttribute(position, corner);
        box.expandByPoint(new three.Vector3(point.dot(right), point.dot(up), point.dot(back)));
      }
    }
    if (box.isEmpty()) {
      return;
    }
    const [middle, sides] = [box.getCenter(new three.Vector3()), box.getSize(new three.Vector3())];
    const target = new three.Vector3();
    [right, up, back].forEach((axis, k) => target.addScaledVector(axis, middle.getComponent(k)));
    camera.zoom = 1;
    this.half = Math.max(LEAST, sides.y, sides.x / this.aspect) / (2 * FILLED);
    this.look(target);
  }

  /** Shows a sphere, in the middle. */
  approach({ center, radius }) {
    this.camera.zoom = this.half / (Math.max(radius, LEAST) / CLOSE);
    this.look(center);
  }

  /** Moves the eye so that a point is in the middle. */
  look(at) {
    const { camera, controls } = this;
    const back = camera.position.clone().sub(controls.target).setLength(AWAY);
    controls.target.copy(at);
    camera.position.copy(at).add(back);
    this.resize(this.aspect, 1);
    controls.update();
  }

  /** Turns the eye about the upward axis, by an angle. */
  turn(angle) {
    const { camera, controls } = this;
    camera.position
      .sub(controls.target)
      .applyAxisAngle(camera.up.clone().normalize(), angle)
      .add(controls.target);
    controls.update();
  }
}
