"""How far apart two meshes are: nearmiss beside Coal, FCL and parry3d, judged in rational numbers. See README.md.

    python peers.py [--nearmiss PROGRAM] [--parry PROGRAM] [--repeat N] [--out FILE.md]
"""

import argparse
import itertools
import json
import statistics
import subprocess
import sys
import tempfile
import time
import tomllib
from importlib.metadata import version
from pathlib import Path

import coal
import fcl
import numpy as np

import judge
import scenes
import verdict

HERE = Path(__file__).resolve().parent


def timed(action):
    start = time.perf_counter()
    value = action()
    return (time.perf_counter() - start) * 1e3, value


def median(action, repeat):
    """The median of the times, and the last value."""
    runs = [timed(action) for _ in range(repeat)]
    return statistics.median(t for t, _ in runs), runs[-1][1]


def answer(name, distance, build, refit, query):
    return {"name": name, "distance": distance, "build": build, "refit": refit, "query": query}


def ask_coal(meshes, repeat):
    rows = [(np.array(v, dtype=np.float64), np.array(t, dtype=np.int64)) for v, t in meshes]

    def build():
        models = []
        for vertices, triangles in rows:
            model = coal.BVHModelOBBRSS()
            model.beginModel(len(triangles), len(vertices))
            model.addVertices(vertices)
            model.addTriangles(triangles)
            model.endModel()
            models.append(model)
        return models

    built, models = timed(build)
    places = []
    for vertices, _ in rows:
        place = coal.StdVec_Vec3s()
        place.extend(list(vertices))
        places.append(place)

    def refit():
        for model, place in zip(models, places):
            model.beginReplaceModel()
            model.replaceSubModel(place)
            model.endReplaceModel(True, True)

    refitted, _ = median(refit, repeat)
    here, request = coal.Transform3s(), coal.DistanceRequest()
    one, other = models
    query, distance = median(lambda: coal.distance(one, here, other, here, request, coal.DistanceResult()), repeat)
    return [answer("Coal", float(distance), built, refitted, query)]


def ask_fcl(meshes, repeat):
    rows = [(np.array(v, dtype=np.float64), np.array(t, dtype=np.int64)) for v, t in meshes]

    def build():
        objects = []
        for vertices, triangles in rows:
            model = fcl.BVHModel()
            model.beginModel(len(triangles), len(vertices))
            model.addSubModel(vertices, triangles)
            model.endModel()
            objects.append(fcl.CollisionObject(model))
        return objects

    built, objects = timed(build)
    query, distance = median(lambda: fcl.distance(*objects, fcl.DistanceRequest(), fcl.DistanceResult()), repeat)
    return [answer("FCL", float(distance), built, None, query)]


def ask_parry(program, files, repeat):
    said = subprocess.run([program, *files, str(repeat)], check=True, capture_output=True, text=True).stdout
    return [{"refit": None, **json.loads(line)} for line in said.splitlines()]


def ask_nearmiss(program, files, repeat):
    """Both as meshes that may deform, then as rigid bodies."""
    rigid = Path(files[0]).parent / "rigid.toml"
    rigid.write_text("".join(f"[[body]]\nmesh = {Path(file).name!r}\nkind = \"rigid\"\n" for file in files))
    rows = []
    kinds = [("", [files[0], "--with", files[1]]), (" rigid", [str(rigid)])]
    for (kind, given), threads in itertools.product(kinds, ("1", "2")):
        command = [program, "detect", *given, "--distance", "--backend", "cpu", "--json"]
        command += ["--threads", threads, "--repeat", str(repeat)]
        told = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        ms = told["ms"]
        rows.append(
            answer(
                f"**nearmiss{kind}**, {threads} thread" + "s" * (threads != "1"),
                told["nearest"]["distance"],
                None if kind else ms["construct"],
                ms["fit"] + ms["refit"],
                ms["traverse"] + ms["narrow"],
            )
        )
    return rows


def ask_all(args, folder, name, one, other, known):
    """The squared distance, and everyone's answer."""
    truth, _ = judge.least_squared(one, other)
    if known is not None and truth != known:
        sys.exit(f"{name}: the judge says {truth}, the formula {known}")
    files = [str(folder / "a.ply"), str(folder / "b.ply")]
    for file, mesh in zip(files, (one, other)):
        scenes.write_ply(file, mesh)
    meshes = (one, other)
    rows = ask_nearmiss(args.nearmiss, files, args.repeat) + ask_coal(meshes, args.repeat)
    rows += ask_fcl(meshes, args.repeat) + ask_parry(args.parry, files, args.repeat)
    return truth, rows


def parry():
    """The version that is built."""
    packages = tomllib.loads((HERE / "parry/Cargo.lock").read_text())["package"]
    return next(package["version"] for package in packages if package["name"] == "parry3d")


def told(ms):
    return "–" if ms is None else f"{ms:.3g}" if ms < 100 else f"{ms:,.0f}"


def table(lines, head, rows):
    lines += ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    lines += ["| " + " | ".join(row) + " |" for row in rows] + [""]


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--nearmiss", default=HERE.parents[1] / "target/release/nearmiss")
    arguments.add_argument("--parry", default=HERE / "parry/target/release/nearmiss-peer-parry")
    arguments.add_argument("--repeat", type=int, default=5)
    arguments.add_argument("--out", type=Path)
    args = arguments.parse_args()
    times, values, names = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes.large():
            truth, rows = ask_all(args, Path(folder), *scene)
            print(scene[0], float(verdict.root(truth)), file=sys.stderr)
            for at, row in enumerate(rows):
                label = f"{scene[0]}, {float(verdict.root(truth)):.9g}" if at == 0 else ""
                said = verdict.of(row["distance"], truth)
                times.append([label, row["name"], told(row["build"]), told(row["refit"]), told(row["query"]), said])
        for scene in scenes.hard():
            truth, rows = ask_all(args, Path(folder), *scene)
            rows = [row for row in rows if not row["name"].endswith(", 1 thread")]
            names = [row["name"].split(",")[0] if "nearmiss" in row["name"] else row["name"] for row in rows]
            values.append([scene[0], f"{float(verdict.root(truth)):.4g}"] + [verdict.of(r["distance"], truth) for r in rows])
            print(*values[-1], file=sys.stderr)
    lines = [f"Written by `peers.py --repeat {args.repeat}`: Coal {coal.__version__}, FCL {version('python-fcl')}, parry3d {parry()}.", ""]
    lines += ["Milliseconds of both meshes: `build` once, `refit` and `query` the median.", ""]
    table(lines, ["scene, distance", "", "build", "refit", "query", "off by"], times)
    table(lines, ["scene", "distance", *names], values)
    text = "\n".join(lines).rstrip()
    if args.out:
        args.out.write_text(text + "\n")
    else:
        print(text)


if __name__ == "__main__":
    main()
