"""The module itself: copies of its values, its threads, and the program with the same answers."""

import copy
import json
import os
import pickle
import subprocess
import threading
import time

import numpy as np
import pytest
from shapes import sheet

import nearmiss as nm

HERE = "Pose(rotation=[0.0, 0.0, 0.0, 1.0], translation=[0.0, 0.0, 0.0])"
THERE = "Pose(rotation=[0.0, 0.0, 0.6, 0.8], translation=[1.0, 2.0, 3.5])"
CHOICES = [
    "Discrete()",
    "Discrete(adjacent=True)",
    "Discrete(only_crossing=True)",
    "Discrete(adjacent=True, only_crossing=True)",
    "configure(Discrete(adjacent=True), broad_phase='tree')",
    "configure(Discrete(), solver='moller', rebuild='manual')",
    "Continuous()",
    "Continuous(tolerance=1e-06, min_separation=0.25, max_iterations=7)",
    "configure(Continuous(tolerance=1e-06, assume_free=True), solver='certified-f64', bounding_volume='aabb', rebuild='manual')",
    "configure(Continuous(), solver='cubic-f32')",
    "Earliest(min_separation=1.0)",
    "configure(Earliest(assume_free=True), solver='cubic-f64', rebuild='auto')",
    "Near(distance=0.5)",
    "configure(Near(distance=0.5), broad_phase='tiles')",
    "Distance()",
    "BodyPairs()",
    "BodyPairs(first=1)",
    "BodyDistances(within=0.0)",
    "BodyDistances(within=0.5)",
    "Pose(rotation=[0.0, 0.0, 0.0, 1.0], translation=[0.0, 0.0, 0.0])",
    "Pose(rotation=[0.0, 0.0, 1.0, 0.0], translation=[1.0, 2.0, 3.5])",
    f"PoseStep({HERE}, {THERE})",
    f"PoseStep({HERE}, {THERE}, pivot=[0.0, 0.5, 1.0])",
    f"PoseStep({HERE}, {THERE}, straight=True)",
    f"PoseStep.turning({HERE}, [0.0, 0.0, 6.0], [0.0, 0.0, 0.0])",
    f"PoseStep.turning({HERE}, [0.1, 0.0, -0.3], [1.0, 0.3, 0.0], pivot=[0.7, 0.1, 0.0])",
]


def made_of(text):
    """The object of a text."""
    return eval(text, {**vars(nm), "configure": nm.research.configure})


@pytest.mark.parametrize("text", CHOICES)
def test_what_is_written_is_made_again(text):
    made = made_of(text)
    assert repr(made) == text
    copies = [made_of(text), copy.copy(made), copy.deepcopy(made)]
    copies += [pickle.loads(pickle.dumps(made, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)]
    for other in copies:
        assert other == made and hash(other) == hash(made) and repr(other) == text and type(other) is type(made)


def test_what_differs_is_not_equal():
    made = [made_of(text) for text in CHOICES]
    for i, one in enumerate(made):
        assert [one == other for other in made] == [i == j for j in range(len(made))]
        assert one != CHOICES[i] and len({*made}) == len(made)
    assert nm.Continuous(tolerance=-0.0, min_separation=-0.0) == nm.Continuous(tolerance=0.0)
    assert hash(nm.Continuous(tolerance=-0.0)) == hash(nm.Continuous(tolerance=0.0))


@pytest.mark.parametrize("kind", ["deformable", "rigid", "fixed"])
def test_a_body_is_made_again(kind):
    vertices, faces = sheet(4, lambda x, y: np.sin(9 * x))
    own = None if kind == "fixed" else True
    there = made_of(THERE) if kind == "rigid" else None
    choices = dict(kind=kind, self_collision=own, environment=3, group=5, mask=~2, name="a rag", pose=there, thickness=0.25)
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
    detector = nm.Detector(nm.Body(vertices, faces), device=nm.Device("cpu", threads=1))
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    other = threading.Thread(target=tick)
    other.start()
    begin = time.perf_counter()
    for _ in range(5):
        detector.near(0.02)
    end = time.perf_counter()
    done.set()
    other.join()
    during = [t for t in ticks if begin < t < end]
    assert len(during) > 10 * (end - begin)
    assert max(np.diff(during)) < 0.5 * (end - begin)


def test_threads_take_turns_at_one_detector():
    vertices, faces = sheet(40, lambda x, y: 0.02 * np.sin(60 * x))
    detector = nm.Detector(nm.Body(vertices, faces))
    wanted, told = detector.near(0.03).hash, []
    ask = lambda: told.append(detector.step({0: vertices}, nm.Near(0.03)).hash)
    threads = [threading.Thread(target=ask) for _ in range(8)]
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
            detector, near = nm.Detector(nm.Body(vertices, faces), device=device), nm.Near(0.03)
            for _ in range(5):
                told.append(detector.step({0: vertices}, near).hash)
                detector.geometry(detector.near(0.03))
                detector.prepare({0: vertices}, [near, nm.Discrete()])
                told.append(detector.collect(near).hash)
                detector.submit()
                np.from_dlpack(detector.on_device(near).status)
                told.append(detector.collect(near).hash)
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
