"""Submissions of rigid bodies by arrays of poses: those of the same poses one by one. On a GPU in a graph of torch."""

import numpy as np
import pytest
from shapes import ball

import nearmiss as nm

COUNT = 24


def heap(device, kind="rigid"):
    """Balls, and one that is fixed."""
    points, faces = ball(8)
    bodies = [nm.Body(points, faces, kind=kind, name=f"ball {k}") for k in range(COUNT)]
    return nm.Detector(nm.Scene(*bodies, nm.Body(points, faces, kind="fixed", name="fixed")), device=device)


def poses(rng, scale=1.8):
    """Positions and quaternions of all balls at both ends of a step."""
    start = rng.uniform(-scale, scale, (COUNT, 3))
    quaternions = rng.normal(size=(COUNT, 4))
    other = quaternions + 0.1 * rng.normal(size=(COUNT, 4))
    unit = lambda q: q / np.linalg.norm(q, axis=1, keepdims=True)
    return start, unit(quaternions), start + 0.2 * rng.normal(size=(COUNT, 3)), unit(other)


def queries():
    return [nm.Discrete(), nm.Near(0.02), nm.BodyPairs(), nm.BodyDistances(0.05), nm.Continuous()]


def names():
    return [f"ball {k}" for k in range(COUNT)]


def same_as(own, judge, arrays, wanted):
    """Compare each collected answer with that of a detector that gets the poses from the host."""
    judge.update_poses(names(), arrays[0], arrays[1], end_positions=arrays[2], end_quaternions=arrays[3])
    rows = 0
    for query in wanted:
        found, expected = own.collect(query), judge.query(query)
        assert found.hash == expected.hash and len(found) == len(expected), query
        rows += len(found)
    return rows


def test_arrays_of_poses_are_submitted():
    rng = np.random.default_rng(3)
    own, judge = heap(nm.Device("cpu")), heap(nm.Device("cpu"))
    arrays = [np.ascontiguousarray(array) for array in poses(rng)]
    for query in queries():
        own.prepare_poses(names(), arrays[0], arrays[1], [query], end_positions=arrays[2], end_quaternions=arrays[3])
        for _ in range(2):
            for array, new in zip(arrays, poses(rng)):
                array[:] = new
            if not own.is_prepared:
                own.prepare_poses(range(COUNT), *arrays[:2], [query], end_positions=arrays[2], end_quaternions=arrays[3])
            own.submit()
            assert same_as(own, judge, arrays, [query]) > 0


def test_bodies_that_touch_are_listed_on_the_device():
    rng = np.random.default_rng(4)
    own = heap(nm.Device("cpu"))
    positions, quaternions = poses(rng)[:2]
    pairs, near = nm.BodyPairs(), nm.BodyDistances(0.1)
    own.prepare_poses(names(), positions, quaternions, [pairs, near])
    own.submit()
    touch, close = own.on_device(pairs), own.on_device(near)
    assert touch.entries == "body pairs" and close.entries == "nearest triangles" and not touch.is_ordered
    count = lambda answer: int(np.from_dlpack(answer.status)[0])
    bodies = np.from_dlpack(touch.lists[0]["bodies"])[: count(touch)]
    expected = own.collect(pairs)
    assert sorted(map(tuple, bodies.tolist())) == list(map(tuple, expected.bodies.tolist())) != []
    own.prepare_poses(names(), positions, quaternions, [pairs, near])
    own.submit()
    close = own.on_device(near)
    distances = np.from_dlpack(close.lists[0]["distances"])[: count(close)].copy()
    found = own.collect(near)
    assert len(found) > len(expected) and np.array_equal(np.sort(distances), np.sort(found.distances))


def test_arrays_that_cannot_be_read_in_place_are_refused():
    own = heap(nm.Device("cpu"))
    positions, quaternions = poses(np.random.default_rng(5))[:2]
    for wrong, said in [
        ((names(), positions.tolist(), quaternions), "read in place"),
        ((names(), positions[:, ::-1], quaternions), "read in place"),
        ((names(), positions[:-1], quaternions), "rows"),
        ((names()[:-1] + ["fixed"], positions, quaternions), "fixed"),
        ((names()[:-1] + ["ball 99"], positions, quaternions), "ball 99"),
        ((names()[:-1] + names()[:1], positions, quaternions), "second time"),
    ]:
        with pytest.raises(nm.NearmissError, match=said):
            own.prepare_poses(*wrong, [nm.Discrete()])
        assert not own.is_prepared
    bad = quaternions.copy()
    own.prepare_poses(names(), positions, bad, [nm.BodyPairs()])
    bad[7] *= 1.1
    own.submit()
    with pytest.raises(nm.InputError, match="ball 7"):
        own.collect(nm.BodyPairs())


def test_a_graph_of_arrays_of_poses():
    torch = pytest.importorskip("torch")
    if not torch.cuda.is_available():
        pytest.skip("no GPU")
    rng = np.random.default_rng(6)
    torch.zeros(1, device="cuda")
    stream = torch.cuda.Stream()
    with torch.cuda.stream(stream):
        own, judge = heap(nm.Device(stream=stream)), heap(nm.Device("cpu"))
        arrays = [torch.from_numpy(array).cuda() for array in poses(rng)]
        graph, rows, frame = None, 0, 0
        while frame < 8:
            here = poses(rng)
            for array, new in zip(arrays, here):
                array.copy_(torch.from_numpy(new))
            if graph is None or not own.is_prepared:
                own.prepare_poses(names(), *arrays[:2], queries(), end_positions=arrays[2], end_quaternions=arrays[3])
                graph = torch.cuda.CUDAGraph()
                with torch.cuda.graph(graph, stream=stream):
                    own.submit()
            graph.replay()
            status = torch.from_dlpack(own.on_device(nm.BodyPairs()).status).cpu().numpy()
            touch = torch.from_dlpack(own.on_device(nm.BodyPairs()).lists[0]["bodies"]).cpu().numpy()[: status[0]]
            judge.update_poses(names(), *here[:2], end_positions=here[2], end_quaternions=here[3])
            if not status[2]:
                expected = judge.query(nm.BodyPairs()).bodies
                assert sorted(map(tuple, touch.tolist())) == list(map(tuple, expected.tolist()))
            rows += same_as(own, judge, here, queries())
            frame += 1
        assert rows > 1000
