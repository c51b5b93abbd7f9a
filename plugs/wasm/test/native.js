// The native program, which gives the answers to compare with, and the meshes of the tests.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";

/** The folder that plugs/wasm/build.sh has filled. */
export const BUILT = process.env.NEARMISS_WASM ?? assert.fail("NEARMISS_WASM must name a folder");
const NATIVE = process.env.NEARMISS ?? assert.fail("NEARMISS must be the path of the program");

const text = (string) => new TextEncoder().encode(string);

/** Two triangles across each other; line ends as on Windows. */
const CROSSING = `v 0 0 0\r\nv 4 0 0\r\nv 0 4 0\r\nv 1 1 -1\r\nv 1 2 1\r\nv 2 1 1\r\nf 1 2 3\r\nf 4 5 6\r\n`;

/** Both ends of a step of cloth over a ball, as PLY; three frames; and small files of other kinds. */
export function meshes() {
  const { files } = native(["lab", "scene", "draped", "--triangles", "2000", "--out", "mesh"]);
  const [t0, t1] = [0, 1].map((end) => files[`mesh/draped_t${end}.ply`]);
  return {
    "t0.ply": t0,
    "t1.ply": t1,
    "shot/cloth.1001.ply": t0,
    "shot/cloth.1002.ply": t1,
    "shot/cloth.1003.ply": t0,
    "crossing.obj": text(CROSSING),
    "two.stl": text(
      `solid two\n${[
        [0, 0, 0, 4, 0, 0, 0, 4, 0],
        [1, 1, -1, 1, 2, 1, 2, 1, 1],
      ]
        .map((at) => {
          const corner = (k) => `vertex ${at.slice(3 * k, 3 * k + 3).join(" ")}`;
          return `facet normal 0 0 0\nouter loop\n${[0, 1, 2].map(corner).join("\n")}\nendloop\nendfacet\n`;
        })
        .join("")}endsolid two\n`,
    ),
    "broken.ply": t0.slice(0, t0.length - 7),
    "scene.toml": text('[[body]]\nmesh = "t0.ply"\n\n[[body]]\nmesh = "crossing.obj"\nkind = "rigid"\n'),
  };
}

function* below(folder, prefix = "") {
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    if (entry.isDirectory()) {
      yield* below(join(folder, entry.name), `${prefix}${entry.name}/`);
    } else {
      yield [prefix + entry.name, new Uint8Array(readFileSync(join(folder, entry.name)))];
    }
  }
}

/** Runs the native program on files in a folder of their own: the same result as `run` of the package. */
export function native(args, files = {}) {
  const folder = mkdtempSync(join(tmpdir(), "nearmiss-wasm-"));
  try {
    for (const [name, bytes] of Object.entries(files)) {
      mkdirSync(dirname(join(folder, name)), { recursive: true });
      writeFileSync(join(folder, name), bytes);
    }
    const { status, stdout, stderr } = spawnSync(NATIVE, args, { cwd: folder, input: "" });
    const isNew = ([name, bytes]) => !(name in files) || Buffer.compare(bytes, files[name]) !== 0;
    const written = Object.fromEntries([...below(folder)].filter(isNew));
    return { status, stdout: new Uint8Array(stdout), out: `${stdout}`, err: `${stderr}`, files: written };
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}
