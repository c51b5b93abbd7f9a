// The features of a row: what they are, and how they are drawn when the row is picked.

import * as three from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";

/** Colours of the first feature and of the second, and of the points between them. */
const COLOURS = [0x1456d0, 0xc01590];
const INK = 0x10131a;
/** The order of drawing: lines are above faces, points above lines, nearest points above all. */
const [FACE, LINE, DOT, ABOVE] = [1, 2, 3, 4];

/**
 * Both features of a row. Each is a list of vertices [v], edges [v, w] or faces [v, w, x], by
 * numbers of vertices among those of all bodies.
 */
export function features(scene, row) {
  const face = (at) => [...scene.faces.subarray(3 * at, 3 * at + 3)];
  const bodies = [scene.bodies[row.body_a], scene.bodies[row.body_b]];
  if ("vertex_0" in row) {
    const [a, b, c, d] = [0, 1, 2, 3].map((k) => row[`vertex_${k}`]);
    switch (scene.names.kind[row.kind]) {
      case "vf":
        return [[[a]], [[b, c, d]]];
      case "ee":
        return [[[a, b]], [[c, d]]];
      case "ev":
        return [[[a, b]], [[c]]];
      default:
        return [[[a]], [[b]]];
    }
  }
  if ("tri_a" in row) {
    return [row.tri_a, row.tri_b].map((triangle, k) => [face(bodies[k].firstFace + triangle)]);
  }
  return bodies.map((body) =>
    Array.from({ length: body.faces }, (_, k) => face(body.firstFace + k)),
  );
}

/** Whether a row is one of a triangle, or of its vertices and edges. */
export function isOf(scene, row, triangle) {
  const bodies = [scene.bodies[row.body_a], scene.bodies[row.body_b]];
  if ("vertex_0" in row) {
    const corners = scene.faces.subarray(3 * triangle, 3 * triangle + 3);
    const has = (feature) => feature.flat().every((vertex) => corners.includes(vertex));
    return features(scene, row).some(has);
  }
  if ("tri_a" in row) {
    return [row.tri_a, row.tri_b].some((own, k) => bodies[k].firstFace + own === triangle);
  }
  return bodies.some(
    (body) => triangle >= body.firstFace && triangle < body.firstFace + body.faces,
  );
}

/** Points between the features of a row; none if it has none. */
export function nearest(scene, row, places) {
  if ("weight_0" in row) {
    const ends =
      ["vf", "vv"].includes(scene.names.kind[row.kind])
        ? [[0], [1, 2, 3]]
        : [
            [0, 1],
            [2, 3],
          ];
    const sum = (all) =>
      all.reduce(
        (sum, k) => sum.addScaledVector(places.of(row[`vertex_${k}`]), row[`weight_${k}`]),
        new three.Vector3(),
      );
    return ends.map(sum);
  }
  const end = (of) => new three.Vector3(...["x", "y", "z"].map((axis) => row[`${axis}_${of}`]));
  const points = "x_a" in row ? [end("a"), end("b")] : "x_0" in row ? [end(0), end(1)] : [];
  return points.every((point) => Number.isFinite(point.x)) ? points : [];
}

/** The picked row, in front of everything. */
export class Picked {
  constructor() {
    this.group = new three.Group();
    // Materials and buffers of the last row are given back.
    this.used = [];
  }

  clear() {
    this.group.clear();
    this.used.forEach((one) => one.dispose());
    this.used = [];
  }

  /** Draws the features of a row where they are; returns the middle and the radius of them. */
  draw(scene, row, places) {
    this.clear();
    const own = features(scene, row);
    own.forEach((feature, k) => this.feature(feature, COLOURS[k], places));
    const points = nearest(scene, row, places);
    if (points.length > 0) {
      this.line(points, INK, 2.5, ABOVE);
      this.dots(points, INK, 6, ABOVE);
    }
    const box = new three.Box3();
    const corners = own.flat(2).map((vertex) => places.of(vertex));
    [...corners, ...points].forEach((point) => box.expandByPoint(point));
    return box.getBoundingSphere(new three.Sphere());
  }

  feature(feature, colour, places) {
    const of = (length) => feature.filter((all) => all.length === length);
    const at = (all) => all.flat().map((vertex) => places.of(vertex));
    const [vertices, edges, faces] = [of(1), of(2), of(3)];
    // A body is seen by its faces alone.
    const sides =
      faces.length > 1
        ? []
        : faces.flatMap(([a, b, c]) => [
            [a, b],
            [b, c],
            [c, a],
          ]);
    if (faces.length > 0) {
      this.surface(at(faces), colour);
    }
    if (edges.length + sides.length > 0) {
      this.line(at([...edges, ...sides]), colour, edges.length > 0 ? 5 : 2.5);
    }
    if (vertices.length > 0) {
      this.dots(at(vertices), colour, 14);
    }
  }

  add(object, order) {
    object.frustumCulled = false;
    object.renderOrder = order;
    this.group.add(object);
    this.used.push(object.geometry, object.material);
  }

  surface(points, color) {
    const looks = {
      color,
      side: three.DoubleSide,
      transparent: true,
      opacity: 0.8,
      depthTest: false,
    };
    const geometry = new three.BufferGeometry().setFromPoints(points);
    this.add(new three.Mesh(geometry, new three.MeshBasicMaterial(looks)), FACE);
  }

  line(points, color, linewidth, order = LINE) {
    const geometry = new LineSegmentsGeometry().setPositions(
      points.flatMap((point) => point.toArray()),
    );
    const material = new LineMaterial({ color, linewidth, depthTest: false, transparent: true });
    this.add(new LineSegments2(geometry, material), order);
  }

  dots(points, color, size, order = DOT) {
    const geometry = new three.BufferGeometry().setFromPoints(points);
    const looks = { color, size, sizeAttenuation: false, depthTest: false, transparent: true };
    const material = new three.PointsMaterial(looks);
    // Round.
    material.onBeforeCompile = (shader) => {
      const round = "void main() { if (length(gl_PointCoord - 0.5) > 0.5) discard;";
      shader.fragmentShader = shader.fragmentShader.replace("void main() {", round);
    };
    this.add(new three.Points(geometry, material), order);
  }
}
