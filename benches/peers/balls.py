"""Balls with bumps, and a heap of them that turns, as a scene file of nearmiss. See README.md.

    python balls.py FOLDER [--bodies N] [--turn RADIANS] [--move LENGTH] [--apart LENGTH]
"""

import argparse
from pathlib import Path

import numpy as np

MESHES = 10


def bumpy(seed, sides=(44, 22), sizes=(0.8, 1.2)):
    """A sphere with bumps, of a diameter in this range: vertices and triangles."""
    rng = np.random.default_rng(seed)
    columns, rows = sides
    u = np.arange(columns) * (2 * np.pi / columns)
    v = np.arange(1, rows) * (np.pi / rows)
    size = 0.5 * rng.uniform(*sizes)
    depth, waves = rng.uniform(0.03, 0.12), rng.integers(2, 6, 2)
    radius = size * (1 + depth * np.outer(np.sin(waves[0] * v), np.cos(waves[1] * u)))
    ring = radius[..., None] * np.stack(
        [np.outer(np.sin(v), np.cos(u)), np.outer(np.sin(v), np.sin(u)), np.outer(np.cos(v), np.ones(columns))], -1
    )
    points = np.concatenate([ring.reshape(-1, 3), [[0, 0, size], [0, 0, -size]]])
    top, bottom = len(points) - 2, len(points) - 1
    at = lambda row, column: row * columns + column % columns
    faces = []
    for column in range(columns):
        faces += [[top, at(0, column), at(0, column + 1)], [bottom, at(rows - 2, column + 1), at(rows - 2, column)]]
        for row in range(rows - 2):
            a, b, c, d = at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)
            faces += [[a, b, c], [a, c, d]]
    return points, np.array(faces, np.uint32)


def heap(count, apart):
    """Places of bodies on a jittered grid, their quaternions (x, y, z, w), and a direction each."""
    rng = np.random.default_rng(7)
    side = int(np.ceil(count ** (1 / 3)))
    cells = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)[:count]
    places = apart * (cells + rng.uniform(-0.3, 0.3, (count, 3)))
    unit = lambda x: x / np.linalg.norm(x, axis=1)[:, None]
    return places, unit(rng.normal(size=(count, 4))), unit(rng.normal(size=(count, 3))), rng


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--bodies", type=int, default=2000)
    arguments.add_argument("--turn", type=float, default=0.1745, help="angle of the step, in radians [0.1745]")
    arguments.add_argument("--move", type=float, default=0.02, help="standard deviation of a step along an axis [0.02]")
    arguments.add_argument("--apart", type=float, default=0.72, help="width of a cell of the grid [0.72]")
    args = arguments.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    for mesh in range(MESHES):
        points, faces = bumpy(mesh)
        lines = ["v {!r} {!r} {!r}".format(*point) for point in points.tolist()]
        lines += ["f {} {} {}".format(*face) for face in (faces.astype(int) + 1).tolist()]
        (args.folder / f"m{mesh}.obj").write_text("\n".join(lines) + "\n")
    places, quaternions, axes, rng = heap(args.bodies, args.apart)
    ends = places + rng.normal(0, args.move, places.shape)
    meshes = rng.integers(0, MESHES, args.bodies)
    rows = zip(meshes, places.tolist(), quaternions.tolist(), ends.tolist(), (args.turn * axes).tolist())
    with (args.folder / "scene.toml").open("w") as file:
        for body, (mesh, place, quaternion, end, turn) in enumerate(rows):
            file.write(f'[[body]]\nname = "b{body}"\nmesh = "m{mesh}.obj"\nkind = "rigid"\n')
            file.write(f"poses = [{{ translation = {place}, rotation = {quaternion} }}, ")
            file.write(f"{{ translation = {end}, turn = {turn} }}]\n")


if __name__ == "__main__":
    main()
