// The data of the page: one JSON object, and arrays in base64. Everything is checked when it is
// read, so that a damaged page says so.

const SIZES = { u8: Uint8Array, u32: Uint32Array, f32: Float32Array, f64: Float64Array };

function wrong(id, what) {
  throw new Error(`${id} ${what}; write the page again`);
}

/** The text of a part of the page. */
function text(id) {
  const part = document.getElementById(id);
  return part ? part.textContent : wrong(id, "is missing");
}

/** An array of numbers, which are little-endian. */
function array(id, type, length) {
  let bytes;
  try {
    bytes = Uint8Array.from(atob(text(id)), (letter) => letter.charCodeAt(0));
  } catch {
    wrong(id, "is not base64");
  }
  const Numbers = SIZES[type];
  const found = bytes.length / Numbers.BYTES_PER_ELEMENT;
  if (!Number.isInteger(found) || (length !== undefined && found !== length)) {
    wrong(id, `has ${bytes.length} bytes, not those of ${length} numbers`);
  }
  return new Numbers(bytes.buffer);
}

/** Refuses an index that is not below `end`. */
function below(id, indices, end) {
  const bad = indices.find((index) => index >= end);
  if (bad !== undefined) {
    wrong(id, `has the index ${bad}, and there are ${end}`);
  }
}

/** The bodies with their first vertex and face among those of all. */
function placed(bodies) {
  let [vertex, face] = [0, 0];
  for (const body of bodies) {
    body.firstVertex = vertex;
    body.firstFace = face;
    vertex += body.vertices;
    face += body.faces;
  }
  return { vertices: vertex, faces: face };
}

/** A step or frame: its rows and its coloured triangles. */
class Moment {
  constructor(scene, at) {
    Object.assign(this, scene.moments[at]);
    this.scene = scene;
    this.at = at;
    if (this.reason !== undefined) {
      this.rows = 0;
      return;
    }
    const { words, numbers } = scene.columns;
    this.words = array(`words-${at}`, "u32", this.rows * words.length);
    this.numbers = array(`numbers-${at}`, "f64", this.rows * numbers.length);
    // A triangle and its colour, 0xRRGGBB, by turns.
    this.met = array(`met-${at}`, "u32");
    below(
      `met-${at}`,
      this.met.filter((_, k) => k % 2 === 0),
      scene.size.faces,
    );
    words.forEach((name, k) => this.check(name, k, words.length));
  }

  /** Checks a column: a body, a triangle, a vertex or a name. */
  check(name, k, width) {
    const { bodies, names, size } = this.scene;
    const end = (row) => {
      if (name.startsWith("body_")) return bodies.length;
      if (name === "tri_a") return bodies[this.words[row * width]].faces;
      if (name === "tri_b") return bodies[this.words[row * width + 1]].faces;
      return name.startsWith("vertex_") ? size.vertices : (names[name]?.length ?? Infinity);
    };
    for (let row = 0; row < this.rows; row++) {
      const word = this.words[row * width + k];
      if (word >= end(row)) {
        below(`words-${this.at}, ${name}`, [word], end(row));
      }
    }
  }

  /** A row as an object, a property a column. */
  row(at) {
    const { words, numbers } = this.scene.columns;
    const row = {};
    words.forEach((name, k) => (row[name] = this.words[at * words.length + k]));
    numbers.forEach((name, k) => (row[name] = this.numbers[at * numbers.length + k]));
    return row;
  }

  /** A column of numbers. */
  column(name) {
    const { numbers } = this.scene.columns;
    const k = numbers.indexOf(name);
    return (row) => this.numbers[row * numbers.length + k];
  }
}

/** Reads the scene. Arrays of a moment, and places, are read when they are needed. */
export function read() {
  const scene = JSON.parse(text("scene"));
  if (scene.format !== 1) {
    wrong("scene", `has the format ${scene.format}`);
  }
  scene.size = placed(scene.bodies);
  const { vertices, faces } = scene.size;
  scene.faces = array("faces", "u32", 3 * faces);
  below("faces", scene.faces, vertices);
  scene.colours = array("colours", "u8", 3 * faces);
  scene.moment = (at) => new Moment(scene, at);
  scene.place = (at, count) => {
    const places = array(`places-${at}`, "f32", 3 * count);
    return places.every(Number.isFinite)
      ? places
      : wrong(`places-${at}`, "has a number that is not finite");
  };
  return scene;
}
