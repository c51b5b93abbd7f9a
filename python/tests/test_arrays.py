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
    detector = nm.Detector(nm.Body(t0, faces), device=CPU)
    hashes = {}
    for (name, start), end in zip(forms(t0).items(), forms(t1).values()):
        detector.update({0: (start, end)})
        hashes[name] = detector.continuous().hash
    assert len(detector.step({0: (t0, t1)}, nm.Continuous())) > 10
    # A list of floats is one of doubles, which are the same numbers.
    assert len(set(hashes.values())) == 1, hashes


def test_numbers_are_read_and_not_kept():
    vertices, faces = sheet(20)
    detector = nm.Detector(nm.Body(vertices, faces), device=CPU)
    here = vertices.copy()
    gone = weakref.ref(here)
    detector.step({0: here}, nm.Near(0.01))
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
    assert nm.time_of_impact(rows, there, faces) == wanted.earliest_toi
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
    detector, near = nm.Detector(nm.Body(vertices, faces), device=CPU), nm.Near(0.05)
    wanted = detector.step({0: vertices}, near).hash
    for inputs in [MappingProxyType({0: vertices}), ChainMap({}, {np.int64(0): vertices})]:
        detector.update({0: vertices + 1})
        assert detector.step(inputs, near).hash == wanted
        detector.update(inputs)
        assert detector.query(near).hash == wanted
        detector.prepare(inputs, [near])
        detector.submit()
        assert detector.collect(near).hash == wanted


def test_faces_of_any_integers():
    vertices, faces = sheet(6, lambda x, y: np.sin(9 * x))
    wanted = nm.near(vertices, faces, 0.05).hash
    for kind in ["i2", "u2", "i4", "u4", "i8", "u8", ">i4"]:
        assert nm.near(vertices, faces.astype(kind), 0.05).hash == wanted
    for none in [np.empty((0, 3), int), []]:
        assert len(nm.self_intersections(vertices, none)) == 0


def shapes(of, names):
    """The shapes of columns, all of which are numpy arrays."""
    columns = [getattr(of, name) for name in names.split()]
    assert all(isinstance(column, np.ndarray) for column in columns)
    return [column.shape for column in columns]


def test_columns_have_their_shapes():
    t0, faces = soup(120, 5, 0.6)
    detector = nm.Detector(nm.Body(t0, faces), device=CPU)
    for ends in [(t0, t0 + 0.05 * np.cos(9 * t0)), (t0 + [0, 0, 9],) * 2]:
        detector.update({0: ends})
        found, near, crossing = detector.continuous(), detector.near(0.05), detector.discrete()
        k = len(found)
        assert shapes(found, "kind bodies feature_a feature_b toi toi_upper status") == [
            (k,), (k, 2), (k,), (k,), (k,), (k,), (k,)
        ]
        for answer in [found, near]:
            at, k = detector.geometry(answer), len(answer)
            assert shapes(at, "owner vertices weights signed_weights points distances normals") == [
                (k, 4), (k, 4), (k, 4), (k, 4), (k, 2, 3), (k,), (k, 3)
            ] and len(at) == k
        assert shapes(near, "kind bodies feature_a feature_b distances squared_distances weights closest") == [
            (k,), (k, 2), (k,), (k,), (k,), (k,), (k, 4), (k,)
        ]
        k = len(crossing)
        assert shapes(crossing, "bodies triangles") == [(k, 2), (k, 2)]
    two = nm.Detector(nm.Scene(nm.Body(t0, faces), nm.Body(t0 + 3, faces)), device=CPU)
    assert shapes(two.distance(), "bodies triangles weights points") == [(2,), (2,), (2, 3), (2, 3)]


def test_a_column_is_made_once():
    t0, faces = soup(120, 5, 0.6)
    detector = nm.Detector(nm.Scene(nm.Body(t0, faces), nm.Body(t0 + 3, faces)), device=CPU)
    found, nearest = detector.near(0.05), detector.distance()
    at = detector.geometry(found)
    assert found.feature_a is found.feature_a and found.weights is found.weights and at.points is at.points
    assert found.feature_a is not detector.near(0.05).feature_a and nearest.points is nearest.points
    for column in [found.feature_a, found.distances, found.weights, at.points, at.owner, nearest.points]:
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 1
        column.copy()[0] = 1


def test_a_submission_reads_what_lies_there_when_its_turn_comes():
    t0, faces = sheet(30, lambda x, y: 0.1 * np.sin(9 * x) * np.cos(8 * y))
    t1 = t0.copy()
    body = nm.Body(t0, faces)
    detector, every = nm.Detector(body, device=CPU), nm.Continuous()
    detector.prepare({0: (t0, t1)}, [every])
    judge = nm.Detector(body, device=nm.Device("cpu"))
    random = np.random.default_rng(2)
    met = 0
    for _ in range(20):
        t1[:] = t0 + 0.05 * random.standard_normal(t0.shape)
        if not detector.is_prepared:
            detector.prepare({0: (t0, t1)}, [every])
        detector.submit()
        answer = detector.on_device(every)
        found = detector.collect(every)
        assert found.hash == judge.step({0: (t0.copy(), t1.copy())}, every).hash
        met += len(found)
        if detector.is_prepared:
            counts = np.from_dlpack(answer.status)
            assert counts.shape == (5,) and counts[4] == found.starts_crossing
            assert counts[:3].sum() == len(found)
            for name in ["toi", "toi_upper", "feature_a", "feature_b"]:
                column = np.concatenate([np.from_dlpack(l[name])[:n] for l, n in zip(answer.lists, counts)])
                assert sorted(column.tolist()) == sorted(getattr(found, name).tolist())
    assert met > 100


def test_an_answer_that_has_moved_is_not_given():
    t0, faces = sheet(10)
    detector, near = nm.Detector(nm.Body(t0, faces), device=CPU), nm.Near(0.02)
    assert detector.on_device(near) is None
    for change in [
        lambda: detector.step({0: t0}, near), lambda: detector.update({0: t0}), lambda: detector.near(0.01),
        lambda: detector.discrete(), detector.rebuild, lambda: detector.plan(near),
    ]:
        detector.prepare({0: t0}, [near])
        detector.submit()
        answer = detector.on_device(near)
        kept = np.from_dlpack(answer.status)
        change()
        with pytest.raises(nm.InvalidArgumentError, match="the answer on the device is gone"):
            np.from_dlpack(answer.status)
    del detector, answer
    gc.collect()
    # A capsule that was taken belongs to the taker.
    assert kept.tolist()[2:4] == [0, 0]


def test_a_refused_preparation_leaves_the_one_before():
    t0, faces = sheet(10)
    detector, near = nm.Detector(nm.Body(t0, faces), device=CPU), nm.Near(0.02)
    here = t0.copy()
    detector.prepare({0: here}, [near])
    for wrong in [{0: t0[:5]}, {0: t0.tolist()}, {1: t0}]:
        with pytest.raises(nm.NearmissError):
            detector.prepare(wrong, [near])
    if detector.is_prepared:
        gone = weakref.ref(here)
        del here
        gc.collect()
        assert gone() is not None
        detector.submit()
        detector.collect(near)


def test_capsules_are_freed_taken_or_not():
    t0, faces = sheet(10)
    detector, near = nm.Detector(nm.Body(t0, faces), device=CPU), nm.Near(0.02)
    detector.prepare({0: t0}, [near])
    detector.submit()
    for _ in range(1000):
        capsule = detector.on_device(near).status.__dlpack__()
        assert "dltensor" in repr(capsule)
        del capsule
        np.from_dlpack(detector.on_device(near).status)
    with pytest.raises(BufferError):
        detector.on_device(near).status.__dlpack__(copy=True)
    with pytest.raises(AttributeError):
        detector.on_device(near).status.__cuda_array_interface__


def test_tensors_of_the_host():
    torch = pytest.importorskip("torch")
    t0, faces = sheet(10, lambda x, y: np.sin(20 * x) * 0.05)
    found = nm.near(torch.from_numpy(t0), torch.from_numpy(faces), 0.05)
    assert found.hash == nm.near(t0, faces, 0.05).hash
