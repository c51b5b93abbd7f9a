// Places of the vertices at a time of a step. Vertices go straight; those of a body that turns go
// on their arcs.

import { Quaternion, Vector3 } from "three";

/** Quarters of a turn: each is an arc of at most 90 degrees. */
const QUARTERS = 4;

export class Places {
  constructor(scene) {
    this.scene = scene;
    this.now = new Float32Array(3 * scene.size.vertices);
    this.read = new Map();
  }

  /** Places that are stored once, of one body. Those that were used last stay in memory. */
  stored(at, count) {
    const found = this.read.get(at) ?? this.scene.place(at, count);
    this.read.delete(at);
    this.read.set(at, found);
    if (this.read.size > 3 * this.scene.bodies.length + 8) {
      this.read.delete(this.read.keys().next().value);
    }
    return found;
  }

  /** Moves all vertices to a time of a moment. */
  move(moment, time) {
    const { starts, ends, turns } = moment;
    this.scene.bodies.forEach((body, at) => {
      const own = this.now.subarray(3 * body.firstVertex, 3 * (body.firstVertex + body.vertices));
      const from = this.stored(starts[at], body.vertices);
      if (starts[at] === ends[at] || time === 0) {
        own.set(from);
      } else {
        const to = this.stored(ends[at], body.vertices);
        own.forEach((_, k) => (own[k] = from[k] + time * (to[k] - from[k])));
      }
    });
    for (const turn of turns) {
      const body = this.scene.bodies[turn.body];
      const own = this.now.subarray(3 * body.firstVertex, 3 * (body.firstVertex + body.vertices));
      turned(turn, this.stored(starts[turn.body], body.vertices), time, own);
    }
  }

  /** The place of a vertex. */
  of(vertex) {
    return new Vector3().fromArray(this.now, 3 * vertex);
  }
}

/** Turns a body about its pivot, from its places at the start. */
function turned({ pivots, rotations }, from, time, to) {
  const quarter = Math.min(Math.floor(time * QUARTERS), QUARTERS - 1);
  const [before, after, start] = [quarter, quarter + 1, 0].map(
    (at) => new Quaternion(...rotations[at]),
  );
  const turn = before.slerp(after, time * QUARTERS - quarter).multiply(start.invert());
  const [first, last] = pivots.map((pivot) => new Vector3(...pivot));
  const pivot = first.clone().lerp(last, time);
  const point = new Vector3();
  for (let k = 0; k < from.length; k += 3) {
    point.fromArray(from, k).sub(first).applyQuaternion(turn).add(pivot).toArray(to, k);
  }
}
