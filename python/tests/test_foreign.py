"""What is not as it seems: arrays that lie, arrays that nobody has memory for, and the end of the interpreter."""

import subprocess
import sys

import numpy as np
import pytest
from shapes import two_triangles

import nearmiss as nm

V, F = two_triangles()
CPU = nm.Device("cpu", threads=1)
QUERIES = [nm.Discrete(), nm.Continuous(), nm.Earliest(), nm.Near(1), nm.Distance()]

PREPARED = """
import numpy as np, nearmiss as nm
vertices = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [2, 1, 1]], np.float32)
detector, near = nm.Detector(nm.Body(vertices, [[0, 1, 2], [3, 4, 5]]), device=nm.Device("cpu", threads=1)), nm.Near(1)
detector.prepare({0: vertices}, [near])
detector.submit()
"""


def ended(program):
    """The exit status of a Python of its own that runs it, and what it said."""
    done = subprocess.run([sys.executable, "-c", PREPARED + program], capture_output=True, text=True)
    return done.returncode, done.stderr


@pytest.mark.parametrize(
    "kept",
    [
        "status = np.from_dlpack(detector.on_device(near).status)",
        "capsule = detector.on_device(near).status.__dlpack__(); del detector",
        "import builtins; builtins.kept = [np.from_dlpack(detector.on_device(near).status)]; builtins.kept.append(builtins.kept)",
    ],
)
def test_what_is_kept_to_the_end_ends_nothing(kept):
    assert ended(kept) == (0, "")


def test_the_end_is_seen():
    assert ended("import os; os.abort()")[0] == -6


@pytest.mark.parametrize("query", QUERIES, ids=repr)
def test_every_column_of_the_device_can_be_taken(query):
    scene = nm.Scene(nm.Body(V[:3], F[:1]), nm.Body(V[3:], F[:1]))
    detector = nm.Detector(scene, device=CPU)
    is_at_rest = not isinstance(query, (nm.Continuous, nm.Earliest))
    ends = [V[:3].copy(), V[3:].copy()]
    detector.prepare({k: at if is_at_rest else (at, at) for k, at in enumerate(ends)}, [query])
    detector.submit()
    answer = detector.on_device(query)
    arrays = [answer.status, answer.edges, *(column for table in answer.lists for column in table.values())]
    if isinstance(query, nm.Earliest):
        arrays.append(answer.earliest)
    for array in arrays:
        assert np.from_dlpack(array).shape == array.shape
    # Queries of triangles have no edges.
    assert (answer.edges.shape[0] == 0) == isinstance(query, (nm.Discrete, nm.Distance))


class Liar(np.ndarray):
    """An array that says that it lies elsewhere."""

    @property
    def __array_interface__(self):
        return {"data": (64, False), "shape": self.shape, "typestr": "<f4", "version": 3}


def test_an_array_is_read_where_it_lies():
    liar = V.copy().view(Liar)
    assert liar.__array_interface__["data"][0] == 64
    told = nm.Detector(nm.Body(V, F), device=CPU).step({0: liar}, nm.Near(1))
    assert told.hash == nm.near(V, F, 1, device=CPU).hash


@pytest.mark.parametrize("kind", ["f4", "f8", "i4"])
def test_more_rows_than_a_mesh_may_have(kind):
    many = np.broadcast_to(np.zeros(3, kind), (10**13, 3))
    with pytest.raises(nm.InputError, match="10000000000000 vertices"):
        nm.Body(many, F)
    with pytest.raises(nm.InputError, match="10000000000000 vertices, but .* has 6"):
        nm.Detector(nm.Body(V, F), device=CPU).update({0: many})
    if kind == "i4":
        with pytest.raises(nm.InputError, match="10000000000000 triangles"):
            nm.Body(V, many)


@pytest.mark.parametrize("kind", ["f4", "f8", "i4", "i8"])
def test_more_rows_than_there_is_memory_for(kind):
    resource = pytest.importorskip("resource")
    many = np.broadcast_to(np.zeros(3, kind), (2**30, 3))
    before = resource.getrlimit(resource.RLIMIT_AS)
    with open("/proc/self/statm") as told:
        taken = int(told.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (taken + (1 << 30), before[1]))
    try:
        with pytest.raises(nm.OutOfMemory, match="bytes were needed"):
            nm.Body(V, many) if kind[0] == "i" else nm.Body(many, F)
    finally:
        resource.setrlimit(resource.RLIMIT_AS, before)


class ByInterface:
    """What has the second door alone, and is no array."""

    def __init__(self, **told):
        self.__cuda_array_interface__ = {"data": (4096, False), "shape": (6, 3), "typestr": "<f4", "version": 3, **told}


def test_strides_between_numbers_are_refused():
    detector = nm.Detector(nm.Body(V, F), device=CPU)
    with pytest.raises(nm.InvalidArgumentError, match="a stride of 13 bytes between numbers of 4"):
        detector.update({0: ByInterface(strides=(13, 4))})
    for whole in [None, (16, 4), (2**62, 4)]:
        with pytest.raises(nm.InvalidArgumentError, match="on a GPU, and the detector is on the CPU"):
            detector.update({0: ByInterface(strides=whole)})
