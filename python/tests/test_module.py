"""The module itself: its stubs, its documentation, its threads, and the program beside it."""

import ast
import copy
import inspect
import json
import os
import pickle
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from shapes import sheet

import nearmiss as nm
from nearmiss import _native

STUBS = ast.parse((Path(_native.__file__).parent / "_native.pyi").read_text())


def stubs():
    """Of every class its names and what they take; None of a property."""
    for node in STUBS.body:
        if isinstance(node, ast.ClassDef):
            members = {}
            for member in node.body:
                if isinstance(member, ast.FunctionDef):
                    of = member.args
                    taken = None if member.decorator_list else [a.arg for a in of.posonlyargs + of.args + of.kwonlyargs][1:]
                    members[member.name] = taken
            yield node.name, members


def test_stubs_tell_what_there_is():
    told = dict(stubs())
    classes = {name: kind for name, kind in vars(_native).items() if inspect.isclass(kind)}
    assert set(told) == set(classes)
    for name, kind in classes.items():
        public = {n for n in vars(kind) if not n.startswith("_")}
        assert {n for n in told[name] if not n.startswith("_")} == public, name
        for member, taken in told[name].items():
            if taken is None or member.startswith("__"):
                continue
            signature = [p for p in inspect.signature(getattr(kind, member)).parameters if p != "self"]
            assert signature == taken, (name, member)


def test_everything_has_its_documentation():
    for name in nm.__all__:
        thing = getattr(nm, name)
        if name == "__version__":
            continue
        assert thing.__doc__, name
        if thing.__module__ == "nearmiss":
            for member, value in vars(thing).items():
                if not member.startswith("_") and not isinstance(value, int):
                    assert value.__doc__, f"{name}.{member}"


CHOICES = [
    "Discrete()",
    "Discrete(adjacent=True, broad='tree')",
    "Discrete(solver='moller', order='median')",
    "Continuous()",
    "Continuous(tolerance=1e-06, separation=0.25, budget=7, solver='certified-f64', bv='aabb', rebuild='never')",
    "Continuous(solver='cubic-f32')",
    "Earliest(separation=1.0)",
    "Near(distance=0.5, broad='tiles')",
    "Distance()",
    "Pose(rotation=[0.0, 0.0, 0.0, 1.0], translation=[0.0, 0.0, 0.0])",
    "Pose(rotation=[0.0, 0.0, 1.0, 0.0], translation=[1.0, 2.0, 3.5])",
]


@pytest.mark.parametrize("text", CHOICES)
def test_what_is_written_is_made_again(text):
    made = eval(f"nm.{text}")
    assert repr(made) == text
    copies = [eval(f"nm.{text}"), copy.copy(made), copy.deepcopy(made)]
    copies += [pickle.loads(pickle.dumps(made, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)]
    for other in copies:
        assert other == made and hash(other) == hash(made) and repr(other) == text and type(other) is type(made)


def test_what_differs_is_not_equal():
    made = [eval(f"nm.{text}") for text in CHOICES]
    for i, one in enumerate(made):
        assert [one == other for other in made] == [i == j for j in range(len(made))]
        assert one != CHOICES[i] and len({*made}) == len(made)
    assert nm.Continuous(tolerance=-0.0, separation=-0.0) == nm.Continuous(tolerance=0.0)
    assert hash(nm.Continuous(tolerance=-0.0)) == hash(nm.Continuous(tolerance=0.0))


@pytest.mark.parametrize("kind", ["deformable", "rigid", "static"])
def test_a_body_is_made_again(kind):
    vertices, faces = sheet(4, lambda x, y: np.sin(9 * x))
    own = None if kind == "static" else True
    choices = dict(kind=kind, self_collision=own, environment=3, group=5, mask=~2, name="a rag")
    for points in [vertices, vertices.astype(float) / 3]:
        body = nm.Body(points, faces, **choices)
        for other in [copy.deepcopy(body), pickle.loads(pickle.dumps(body))]:
            (_, mesh, told), (_, again, retold) = (one.__reduce__()[1] for one in (body, other))
            assert told == retold == {**choices, "mask": 0xFFFFFFFD} and repr(other) == repr(body)
            assert [a.dtype for a in again] == [points.dtype, np.uint32]
            assert all(np.array_equal(a, b) for a, b in zip(mesh, again)) and np.array_equal(again[0], points)
    assert pickle.loads(pickle.dumps(nm.Body(vertices, faces, environment=None))).__reduce__()[1][2]["environment"] is None


def test_other_threads_run_while_a_frame_is_computed():
    vertices, faces = sheet(150, lambda x, y: 0.02 * np.sin(60 * x))
    detector = nm.Detector(nm.Body(vertices, faces), nm.Near(0.02), nm.Device("cpu", threads=1))
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    other = threading.Thread(target=tick)
    other.start()
    begin = time.perf_counter()
    for _ in range(5):
        detector.detect()
    end = time.perf_counter()
    done.set()
    other.join()
    during = [t for t in ticks if begin < t < end]
    assert len(during) > 10 * (end - begin)
    assert max(np.diff(during)) < 0.5 * (end - begin)


def test_threads_take_turns_at_one_detector():
    vertices, faces = sheet(40, lambda x, y: 0.02 * np.sin(60 * x))
    detector = nm.Detector(nm.Body(vertices, faces), nm.Near(0.03))
    wanted, told = detector.detect().hash, []
    threads = [threading.Thread(target=lambda: told.append(detector.frame({0: vertices}).hash)) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert told == [wanted] * 8


@pytest.mark.parametrize("threads", [1, 2])
def test_detectors_of_many_threads_share_a_device(threads):
    vertices, faces = sheet(40, lambda x, y: 0.02 * np.sin(60 * x))
    device, told = nm.Device("cpu", threads=threads), []
    wanted = nm.near(vertices, faces, 0.03, device=nm.Device("cpu")).hash

    def ask():
        try:
            detector = nm.Detector(nm.Body(vertices, faces), nm.Near(0.03), device)
            for _ in range(5):
                told.append(detector.frame({0: vertices}).hash)
                detector.geometry(detector.detect())
                told.append(detector.prepare({0: vertices}).hash)
                detector.submit()
                np.from_dlpack(detector.on_device().status)
                told.append(detector.collect().hash)
                detector.add(nm.Body(vertices + 9, faces))
                detector.remove(1)
        except Exception as error:
            told.append(error)

    others = [threading.Thread(target=ask) for _ in range(4)]
    for other in others:
        other.start()
    for other in others:
        other.join(60)
    assert told == [wanted] * 60 and not any(other.is_alive() for other in others)


@pytest.mark.skipif("NEARMISS_PROGRAM" not in os.environ, reason="NEARMISS_PROGRAM names the command line program")
def test_the_program_gives_the_same_answer(tmp_path):
    program, name = os.environ["NEARMISS_PROGRAM"], "draped"
    frames = [tmp_path / f"{name}_{end}.ply" for end in ("t0", "t1")]
    run = lambda *args: subprocess.run([program, *map(str, args)], check=True, capture_output=True, text=True).stdout
    run("lab", "scene", name, "--triangles", 2000, "--out", tmp_path)
    told = json.loads(run("detect", *sorted(tmp_path.glob("*.ply")), "--json"))
    (t0, faces), (t1, _) = (nm.read_mesh(path) for path in sorted(tmp_path.glob("*.ply")))
    found = nm.contacts(t0, t1, faces)
    assert (found.hash, len(found)) == (told["hash"], told["contacts"]) and len(found) > 0, frames
