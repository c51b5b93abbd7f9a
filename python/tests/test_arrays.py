"""Arrays in and out: whatever holds the numbers, the answer is one."""

import gc
import weakref
from collections import ChainMap
from types import MappingProxyType

import numpy as np
import pytest
from shapes import sheet, soup

import nearmiss as nm
from nearmiss import arrays

CPU = nm.Device("cpu", threads=1)


def forms(array):
    """The same numbers in other memory."""
    padded = np.zeros((len(array), 5), array.dtype)
    padded[:, 1:4] = array
    frozen = array.copy()
    frozen.flags.writeable = False
    misaligned = np.frombuffer(b"x" + array.tobytes(), array.dtype, offset=1).reshape(array.shape)
    return {
        "packed": array.copy(),
        "columns": np.asfortranarray(array),
        "padded": padded[:, 1:4],
        "backwards": array[::-1].copy()[::-1],
        "swapped": array.astype(array.dtype.newbyteorder()),
        "read only": frozen,
        "misaligned": misaligned,
        "a list": array.tolist(),
    }


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_whatever_holds_the_numbers(dtype):
    t0, faces = soup(120, 5, 0.6)
    t0 = t0.astype(dtype)
    t1 = (t0 + 0.1 * np.cos(7 * t0[:, ::-1])).astype(dtype)
    detector = nm.Detector(nm.Body(t0, faces), nm.Continuous(), CPU)
    hashes = {name: detector.frame({0: (a, b)}).hash for (name, a), b in zip(forms(t0).items(), forms(t1).values())}
    assert len(detector.frame({0: (t0, t1)})) > 10
    # A list of floats is one of doubles, which are the same numbers.
    assert len(set(hashes.values())) == 1, hashes


def test_numbers_are_read_and_not_kept():
    vertices, faces = sheet(20)
    detector = nm.Detector(nm.Body(vertices, faces), nm.Near(0.01), CPU)
    here = vertices.copy()
    gone = weakref.ref(here)
    detector.frame({0: here})
    del here
    gc.collect()
    assert gone() is None


def test_rows_of_tuples_are_no_step():
    vertices, faces = sheet(6, lambda x, y: 0.1 * np.sin(9 * x))
    # The numbers of a list are doubles: the same ones.
    rows = tuple(map(tuple, vertices.tolist()))
    assert nm.near(rows, faces, 0.05).hash == nm.near(vertices, faces, 0.05).hash
    assert nm.self_intersections(rows, faces).shape[1] == 2
    there = vertices[:, [1, 0, 2]]
    wanted = nm.contacts(vertices, there, faces)
    assert nm.contacts(rows, tuple(map(tuple, there.tolist())), faces).hash == wanted.hash
    assert nm.time_of_impact(rows, there, faces) == wanted.earliest
    assert len(nm.near(((0, 0, 0), (1, 1, 1)), [], 1.0)) == 0
    for none in [(), []]:
        with pytest.raises(nm.InvalidArgumentError, match="shape .0.; give rows of three"):
            nm.near(none, [], 1.0)


class OfGpu:
    """What says that it lies on a GPU."""

    def __init__(self, number):
        self.__dlpack_device__ = lambda: (2, number)


class WithoutNumber:
    """What has the second door alone."""

    __cuda_array_interface__ = {"version": 3}


def test_a_shortcut_asks_where_an_array_lies(monkeypatch):
    monkeypatch.setattr(arrays, "Device", lambda **told: told)
    assert [arrays.device_of(OfGpu(number)) for number in [0, 1]] == [{"gpu": 0}, {"gpu": 1}]
    assert arrays.device_of(WithoutNumber()) == {"stream": 0}
    assert arrays.device_of(np.zeros((1, 3))) == arrays.device_of([]) == {}


def test_inputs_are_any_mapping():
    vertices, faces = sheet(6, lambda x, y: np.sin(9 * x))
    detector = nm.Detector(nm.Body(vertices, faces), nm.Near(0.05), CPU)
    wanted = detector.frame({0: vertices}).hash
    for inputs in [MappingProxyType({0: vertices}), ChainMap({}, {np.int64(0): vertices})]:
        assert detector.frame(inputs).hash == detector.prepare(inputs).hash == wanted


def test_faces_of_any_integers():
    vertices, faces = sheet(6, lambda x, y: np.sin(9 * x))
    wanted = nm.near(vertices, faces, 0.05).hash
    for kind in ["i2", "u2", "i4", "u4", "i8", "u8", ">i4"]:
        assert nm.near(vertices, faces.astype(kind), 0.05).hash == wanted
    for none in [np.empty((0, 3), int), []]:
        assert len(nm.self_intersections(vertices, none)) == 0


def test_columns_have_their_shapes():
    t0, faces = soup(120, 5, 0.6)
    detector = nm.Detector(nm.Body(t0, faces), nm.Continuous(), CPU)
    for inputs in [(t0, t0 + 0.05 * np.cos(9 * t0)), (t0 + [0, 0, 9],) * 2]:
        found = detector.frame({0: inputs})
        k = len(found)
        shapes = [getattr(found, name).shape for name in ["kind", "bodies", "indices", "toi", "toi_upper", "status"]]
        assert shapes == [(k,), (k, 2), (k, 2), (k,), (k,), (k,)]
        at = detector.geometry(found)
        shapes = [getattr(at, name).shape for name in ["first", "vertices", "weights", "points", "distances", "normals"]]
        assert shapes == [(k,), (k, 4), (k, 4), (k, 2, 3), (k,), (k, 3)] and len(at) == k


def test_a_column_is_made_once():
    t0, faces = soup(120, 5, 0.6)
    detector = nm.Detector(nm.Body(t0, faces), nm.Near(0.05), CPU)
    found = detector.detect()
    at = detector.geometry(found)
    assert found.indices is found.indices and found.weights is found.weights and at.points is at.points
    assert found.indices is not detector.detect().indices
    for column in [found.indices, found.distances, found.weights, at.points, at.first]:
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 1
        column.copy()[0] = 1


def test_a_submission_reads_what_lies_there_when_its_turn_comes():
    t0, faces = sheet(30, lambda x, y: 0.1 * np.sin(9 * x) * np.cos(8 * y))
    t1 = t0.copy()
    body = nm.Body(t0, faces)
    detector = nm.Detector(body, nm.Continuous(), CPU)
    detector.prepare({0: (t0, t1)})
    judge = nm.Detector(body, nm.Continuous(), nm.Device("cpu"))
    random = np.random.default_rng(2)
    met = 0
    for _ in range(20):
        t1[:] = t0 + 0.05 * random.standard_normal(t0.shape)
        if not detector.is_prepared:
            detector.prepare({0: (t0, t1)})
        detector.submit()
        answer = detector.on_device()
        found = detector.collect()
        assert found.hash == judge.frame({0: (t0.copy(), t1.copy())}).hash
        met += len(found)
        if detector.is_prepared:
            counts = np.from_dlpack(answer.status)
            assert counts.shape == (5,) and counts[4] == found.starts_crossing
            assert counts[:3].sum() == len(found)
            times = np.concatenate([np.from_dlpack(l["toi"])[:n] for l, n in zip(answer.lists, counts)])
            assert sorted(times.tolist()) == sorted(found.toi.tolist())
    assert met > 100


def test_an_answer_that_has_moved_is_not_given():
    t0, faces = sheet(10)
    detector = nm.Detector(nm.Body(t0, faces), nm.Near(0.02), CPU)
    assert detector.on_device() is None
    detector.prepare({0: t0})
    detector.submit()
    answer = detector.on_device()
    kept = np.from_dlpack(answer.status)
    detector.frame({0: t0})
    with pytest.raises(nm.InvalidArgumentError, match="asked anew"):
        np.from_dlpack(answer.status)
    del detector, answer
    gc.collect()
    # What was given is the taker's.
    assert kept.tolist()[2:4] == [0, 0]


def test_a_refused_preparation_leaves_the_one_before():
    t0, faces = sheet(10)
    detector = nm.Detector(nm.Body(t0, faces), nm.Near(0.02), CPU)
    here = t0.copy()
    detector.prepare({0: here})
    for wrong in [{0: t0[:5]}, {0: t0.tolist()}, {1: t0}]:
        with pytest.raises(nm.NearmissError):
            detector.prepare(wrong)
    if detector.is_prepared:
        gone = weakref.ref(here)
        del here
        gc.collect()
        assert gone() is not None
        detector.submit()
        detector.collect()


def test_capsules_are_freed_taken_or_not():
    t0, faces = sheet(10)
    detector = nm.Detector(nm.Body(t0, faces), nm.Near(0.02), CPU)
    detector.prepare({0: t0})
    detector.submit()
    for _ in range(1000):
        capsule = detector.on_device().status.__dlpack__()
        assert "dltensor" in repr(capsule)
        del capsule
        np.from_dlpack(detector.on_device().status)
    with pytest.raises(BufferError):
        detector.on_device().status.__dlpack__(copy=True)
    with pytest.raises(AttributeError):
        detector.on_device().status.__cuda_array_interface__


def test_tensors_of_the_host():
    torch = pytest.importorskip("torch")
    t0, faces = sheet(10, lambda x, y: np.sin(20 * x) * 0.05)
    found = nm.near(torch.from_numpy(t0), torch.from_numpy(faces), 0.05)
    assert found.hash == nm.near(t0, faces, 0.05).hash
