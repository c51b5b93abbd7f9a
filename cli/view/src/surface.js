// The triangles of all bodies, each with its colour. Every triangle has corners of its own, so that
// colours end at its sides.

import * as three from "three";

export class Surface {
  constructor(scene) {
    this.scene = scene;
    this.shown = scene.bodies.map(() => true);
    const corners = scene.faces.length;
    this.position = new three.BufferAttribute(new Float32Array(3 * corners), 3);
    this.colour = new three.BufferAttribute(new Uint8Array(3 * corners), 3, true);
    const looks = { side: three.DoubleSide, vertexColors: true, flatShading: true };
    // Lines of triangles are drawn in front of the triangles.
    const behind = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
    this.material = new three.MeshLambertMaterial({ ...looks, ...behind });
    const ink = new three.MeshBasicMaterial({
      wireframe: true,
      color: 0x14171f,
      opacity: 0.35,
      transparent: true,
    });
    this.mesh = this.part(three.Mesh, [this.material]);
    this.lines = this.part(three.Mesh, [ink]);
    this.lines.geometry = this.mesh.geometry;
    this.lines.visible = false;
    // Faces of two corners and of one.
    this.rods = this.part(three.LineSegments, new three.LineBasicMaterial({ vertexColors: true }));
    this.points = this.part(
      three.Points,
      new three.PointsMaterial({ vertexColors: true, size: 5, sizeAttenuation: false }),
    );
    this.objects = [this.mesh, this.lines, this.rods, this.points];
    this.show(0, true);
  }

  part(Kind, material) {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", this.position);
    geometry.setAttribute("color", this.colour);
    // Places are within a cube of side 1; a bound that is computed would be old after each move.
    geometry.boundingSphere = new three.Sphere(new three.Vector3(), 2);
    const part = new Kind(geometry, material);
    part.frustumCulled = false;
    return part;
  }

  /** Gives all corners their places. */
  move(places) {
    const { faces } = this.scene;
    const to = this.position.array;
    for (let corner = 0; corner < faces.length; corner++) {
      const from = 3 * faces[corner];
      to[3 * corner] = places[from];
      to[3 * corner + 1] = places[from + 1];
      to[3 * corner + 2] = places[from + 2];
    }
    this.position.needsUpdate = true;
  }

  /** Colours triangles: those of `met` (triangle, colour by turns), the others as their bodies. */
  paint(met) {
    const { colours } = this.scene;
    const to = this.colour.array;
    for (let k = 0; k < to.length; k++) {
      to[k] = colours[3 * Math.floor(k / 9) + (k % 3)];
    }
    for (let k = 0; k < met.length; k += 2) {
      for (let corner = 0; corner < 3; corner++) {
        const colour = [met[k + 1] >> 16, (met[k + 1] >> 8) & 255, met[k + 1] & 255];
        to.set(colour, 9 * met[k] + 3 * corner);
      }
    }
    this.colour.needsUpdate = true;
  }

  /** Shows a body, or hides it. */
  show(at, shown) {
    this.shown[at] = shown;
    const geometry = this.mesh.geometry;
    geometry.clearGroups();
    const rods = [];
    const points = [];
    this.scene.bodies.forEach((body, k) => {
      if (!this.shown[k]) {
        return;
      }
      const last = geometry.groups.at(-1);
      if (last && last.start + last.count === 3 * body.firstFace) {
        last.count += 3 * body.faces;
      } else {
        geometry.addGroup(3 * body.firstFace, 3 * body.faces, 0);
      }
      this.thin(body, rods, points);
    });
    this.rods.geometry.setIndex(rods);
    this.points.geometry.setIndex(points);
  }

  /** Adds the faces of a body that have two corners, or one. */
  thin(body, rods, points) {
    for (let face = body.firstFace; face < body.firstFace + body.faces; face++) {
      const [a, b, c] = this.scene.faces.subarray(3 * face, 3 * face + 3);
      if (a === b && b === c) {
        points.push(3 * face);
      } else if (a === b || b === c || c === a) {
        const first = 3 * face + (a === b ? 1 : 0);
        rods.push(first, first + 1);
      }
    }
  }

  /** Lets the eye through. */
  clear(on) {
    this.material.transparent = on;
    this.material.opacity = on ? 0.3 : 1;
    this.material.depthWrite = !on;
    this.material.needsUpdate = true;
  }
}
