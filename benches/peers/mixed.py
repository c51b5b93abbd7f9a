"""A cloth among many rigid bodies: what it adds to a frame, and what placing everything would cost. See README.md.

    python mixed.py [--bodies N] [--cloth N] [--frames N] [--device cpu|cuda] [--threads N]
                    [--ways WAY ...] [--queries QUERY ...] [--out FILE.csv]

Rows are medians over frames, without the first three of each way. Needs numpy and nearmiss.
"""

import argparse
import csv
import statistics
import sys
import time

import nearmiss
import numpy as np
from balls import bumpy

MESHES, SIDES, SIZES = 10, (43, 22), (0.85, 1.15)
PITCH, STEP, NEAR = 1.1, 0.02, 0.02
WARM = 3
WAYS = ("rigid", "mixed", "placed")
QUERIES = ("discrete", "near", "continuous", "earliest")


def grid(count):
    """Places of bodies in a jittered cube, and its side."""
    side = int(np.ceil(count ** (1 / 3)))
    at = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), -1).reshape(-1, 3)[:count]
    return PITCH * (at + np.random.default_rng(1).uniform(-0.1, 0.1, at.shape)), PITCH * side


def steps(places, frames):
    """Positions and quaternions (x, y, z, w) at both ends of each step."""
    rng = np.random.default_rng(2)
    count = len(places)
    phase, turn, spin = rng.uniform(0, 6.3, (count, 3)), rng.normal(size=(count, 4)), rng.normal(0, STEP, (count, 4))

    def pose(at):
        quaternion = turn + at * spin
        return places + 3 * STEP * np.sin(phase + 0.3 * at), quaternion / np.linalg.norm(quaternion, axis=1)[:, None]

    for frame in range(frames):
        yield pose(frame), pose(frame + 1)


def cloth(triangles, extent):
    """Triangles of a square cloth, and its vertices at a time: it waves through the bodies."""
    side = int(round((triangles / 2) ** 0.5)) + 1
    u, v = np.meshgrid(*[np.linspace(-0.5 * PITCH, extent - 0.5 * PITCH, side)] * 2, indexing="ij")
    a = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1)
    faces = np.concatenate([np.stack([a, a + side, a + side + 1], 1), np.stack([a, a + side + 1, a + 1], 1)])

    def at(time):
        height = 0.5 * extent + 0.4 * np.sin(2.3 * u + 0.1 * time) * np.cos(1.9 * v - 0.07 * time)
        return np.stack([u, v, height], -1).reshape(-1, 3)

    return faces.astype(np.uint32), at


class Way:
    """A scene on a device of its own, in one of the three ways."""

    def __init__(self, way, args, places, extent):
        meshes = [bumpy(seed, SIDES, SIZES) for seed in range(MESHES)]
        which = np.random.default_rng(0).integers(0, MESHES, args.bodies)
        bodies = [nearmiss.Body(*meshes[k], kind="rigid", name=f"ball {at}") for at, k in enumerate(which)]
        self.at = None
        if way != "rigid":
            faces, self.at = cloth(args.cloth, extent)
            bodies.append(nearmiss.Body(self.at(0), faces, kind="deformable", name="cloth"))
        self.device = nearmiss.Device(args.device, **({"threads": args.threads} if args.device == "cpu" else {}))
        self.detector, self.way = nearmiss.Detector(nearmiss.Scene(*bodies), device=self.device), way

    def query(self, name):
        query = nearmiss.Near(NEAR) if name == "near" else getattr(nearmiss, name.capitalize())()
        # A chosen broad phase places all vertices. Without a choice, bodies are instances if they can be.
        return nearmiss.research.configure(query, broad_phase="tiles") if self.way == "placed" else query

    def place(self, frame, start, end):
        poses = [[nearmiss.Pose(q, t) for t, q in zip(*end)] for end in (start, end)]
        inputs = dict(enumerate(zip(*poses)))
        if self.at is not None:
            inputs["cloth"] = (self.at(frame), self.at(frame + 1))
        self.detector.update(inputs)

    def run(self, name, args, places):
        """Rows, hash, and milliseconds on the device and of the caller, frame by frame."""
        query, found = self.query(name), []
        for frame, (start, end) in enumerate(steps(places, args.frames + WARM)):
            self.place(frame, start, end)
            before = time.perf_counter()
            answer = self.detector.query(query)
            wait = (time.perf_counter() - before) * 1e3
            summary = self.detector.summary(answer)
            rows = summary["contacts"] if name != "earliest" else int(summary.get("earliest_toi") is not None)
            found.append((rows, summary["hash"], summary["ms"]["total"], wait))
        return found[WARM:]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--bodies", type=int, default=2000, help="rigid bodies [2000]")
    arguments.add_argument("--cloth", type=int, default=20000, help="triangles of the cloth, about [20000]")
    arguments.add_argument("--frames", type=int, default=20, help="frames that count, of each query [20]")
    arguments.add_argument("--device", choices=("cpu", "cuda"), default="cuda", help="machine [cuda]")
    arguments.add_argument("--threads", type=int, default=2, help="threads of a CPU [2]")
    arguments.add_argument("--ways", nargs="+", choices=WAYS, default=WAYS, help="without, with, everything placed")
    arguments.add_argument("--queries", nargs="+", choices=QUERIES, default=QUERIES, help="queries [all]")
    arguments.add_argument("--out", help="CSV file [standard output]")
    args = arguments.parse_args()
    places, extent = grid(args.bodies)
    told = [["query", "way", "rows", "hash", "device_ms", "wait_ms", "megabytes"]]
    for name in args.queries:
        last = {}
        for way in args.ways:
            own = Way(way, args, places, extent)
            found = own.run(name, args, places)
            rows, last[way] = found[-1][0], [row[1] for row in found]
            device, wait = (statistics.median(row[k] for row in found) for k in (2, 3))
            megabytes = own.device.bytes[1] / 1e6
            told.append([name, way, rows, found[-1][1], f"{device:.3f}", f"{wait:.3f}", f"{megabytes:.1f}"])
        if "mixed" in last and "placed" in last and last["mixed"] != last["placed"]:
            sys.exit(f"{name}: answers differ")
    with open(args.out, "w", newline="") if args.out else sys.stdout as file:
        csv.writer(file, lineterminator="\n").writerows(told)


if __name__ == "__main__":
    main()
