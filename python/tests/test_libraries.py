"""Arrays of Warp, torch, JAX and cupy, in and out: the same answers as with numpy.

Here they are on the CPU; test_gpu.py has torch and cupy on a GPU. A test without its library is
skipped, and says so.
"""

import numpy as np
import pytest
from shapes import sheet

import nearmiss as nm

CPU = nm.Device("cpu", threads=1)
DISTANCE = 0.01


def folded(dtype=np.float64):
    """A wavy sheet folded in two: vertices at two times, faces."""
    vertices, faces = sheet(24, lambda x, y: 0.1 * np.sin(25 * x) * np.cos(9 * y))
    there = vertices.copy()
    there[:, 0] = np.abs(there[:, 0] - 0.5)
    return vertices.astype(dtype), there.astype(dtype), faces


def hashes(t0, t1, faces, start, end):
    """Answers with their arrays and with numpy's, of a near and of a continuous query."""
    detector = nm.Detector(nm.Body(t0, faces), device=CPU)
    found = []
    for inputs in [(t0, t1), (start, end)]:
        detector.update({0: inputs[1]})
        near = detector.near(DISTANCE)
        detector.update({0: inputs})
        contacts = detector.continuous()
        assert len(near) > 10 and len(contacts) > 10
        found.append((near.hash, contacts.hash))
    return found


def check_columns(take):
    """Every column of a submission's answer, as `take` reads it, has the numbers of `collect`."""
    t0, t1, faces = folded()
    detector, near = nm.Detector(nm.Body(t0, faces), device=CPU), nm.Near(DISTANCE)
    detector.prepare({0: t1}, [near])
    detector.submit()
    answer = detector.on_device(near)
    counts = take(answer.status)[:2]
    squared = [
        take(table["squared_distances"])[:count] for table, count in zip(answer.lists, counts)
    ]
    features = [take(table["feature_a"])[:count] for table, count in zip(answer.lists, counts)]
    places = [take(table["at"])[:count] for table, count in zip(answer.lists, counts)]
    found = detector.collect(near)
    assert counts.sum() == len(found) > 10
    assert np.array_equal(np.sort(np.concatenate(squared)), np.sort(found.squared_distances))
    assert np.array_equal(np.sort(np.concatenate(features)), np.sort(found.feature_a))
    assert np.concatenate(places).shape == (len(found), 2)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_arrays_of_warp(dtype):
    wp = pytest.importorskip("warp")
    t0, t1, faces = folded(dtype)
    kind = wp.vec3f if dtype == np.float32 else wp.vec3d
    start, end = (wp.array(array, dtype=kind, device="cpu") for array in (t0, t1))
    by_numpy, by_warp = hashes(t0, t1, faces, start, end)
    assert by_numpy == by_warp
    assert nm.near(end, wp.array(faces, dtype=wp.int32, device="cpu"), DISTANCE).hash == by_numpy[0]


def test_a_kernel_of_warp_moves_what_a_submission_reads():
    wp = pytest.importorskip("warp")
    t0, t1, faces = folded()

    @wp.kernel
    def lean(x: wp.array(dtype=wp.vec3d), to: wp.array(dtype=wp.vec3d), part: wp.float64):
        i = wp.tid()
        x[i] = x[i] + part * (to[i] - x[i])

    x, to = (wp.array(array, dtype=wp.vec3d, device="cpu") for array in (t0, t1))
    body, near = nm.Body(t0, faces), nm.Near(DISTANCE)
    detector, judge = nm.Detector(body, device=CPU), nm.Detector(body, device=CPU)
    detector.prepare({0: x.numpy()}, [near])  # the same memory
    counts = []
    for _ in range(6):
        wp.launch(lean, dim=len(t0), inputs=[x, to, wp.float64(0.6)], device="cpu")
        if not detector.is_prepared:
            detector.prepare({0: x.numpy()}, [near])
        detector.submit()
        found = detector.collect(near)
        assert found.hash == judge.step({0: x.numpy().copy()}, near).hash
        counts.append(len(found))
    assert counts[-1] > 10 and len(set(counts)) > 1


def test_answers_as_arrays_of_warp():
    wp = pytest.importorskip("warp")
    check_columns(lambda column: wp.from_dlpack(column).numpy())


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_tensors_of_torch(dtype):
    torch = pytest.importorskip("torch")
    t0, t1, faces = folded(dtype)
    by_numpy, by_torch = hashes(t0, t1, faces, *map(torch.from_numpy, (t0, t1)))
    assert by_numpy == by_torch
    needs_grad = torch.from_numpy(t1).requires_grad_()
    assert nm.near(needs_grad.detach(), torch.from_numpy(faces), DISTANCE).hash == by_numpy[0]


def test_answers_as_tensors_of_torch():
    torch = pytest.importorskip("torch")
    check_columns(lambda column: torch.from_dlpack(column).numpy())


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_arrays_of_jax(dtype):
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        t0, t1, faces = folded(dtype)
        start, end = (jax.numpy.asarray(array) for array in (t0, t1))
        assert start.dtype == dtype
        by_numpy, by_jax = hashes(t0, t1, faces, start, end)
        assert by_numpy == by_jax
        assert nm.near(end, jax.numpy.asarray(faces), DISTANCE).hash == by_numpy[0]


def test_answers_as_arrays_of_jax():
    jax = pytest.importorskip("jax")
    with jax.enable_x64(True):
        # JAX takes no strided array, and a column is one: numpy copies it.
        check_columns(lambda column: np.asarray(jax.numpy.asarray(np.from_dlpack(column))))
        _, t1, faces = folded()
        detector, near = nm.Detector(nm.Body(t1, faces), device=CPU), nm.Near(DISTANCE)
        detector.prepare({0: t1}, [near])
        detector.submit()
        answer = detector.on_device(near)
        assert jax.numpy.from_dlpack(answer.status).shape == (5,)
        assert jax.numpy.from_dlpack(answer.edges).shape == answer.edges.shape
        with pytest.raises(Exception, match="compact"):
            jax.numpy.from_dlpack(answer.lists[0]["feature_a"])


def test_arrays_of_cupy():
    cupy = pytest.importorskip("cupy", reason="cupy is not installed; it needs a GPU")
    try:
        count = cupy.cuda.runtime.getDeviceCount()
    except cupy.cuda.runtime.CUDARuntimeError:
        count = 0
    if count == 0:
        pytest.skip("no GPU: cupy has no arrays on a CPU")
    t0, t1, faces = folded()
    detector = nm.Detector(nm.Body(t0, faces), device=nm.Device(gpu=0))
    detector.update({0: cupy.asarray(t1)})
    assert detector.near(DISTANCE).hash == nm.near(t1, faces, DISTANCE, device=CPU).hash
