"""Parts of a submitted answer on a GPU: in a graph of torch, bit by bit those of the host."""

import numpy as np
import pytest
from test_gpu import draped, stream  # noqa: F401, a fixture

import nearmiss as nm

torch = pytest.importorskip("torch")
pytestmark = pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU")


def test_parts_of_an_answer_on_the_device(stream):  # noqa: F811
    """Geometry, least numbers and rows by feature in a graph: those of the host, bit by bit."""
    t0, t1, faces = draped(60)
    names = ["vertex", "edge", "face", "corner"]
    detector = nm.Detector(nm.Body(t0, faces), device=nm.Device(stream=stream))
    here, there = (torch.from_numpy(end).cuda() for end in (t0, t0))
    queries = [nm.Near(0.01), nm.Continuous()]
    far = torch.from_numpy(t1).cuda()
    graph, compared = None, 0
    for frame in range(12):
        here.copy_(there)
        there.lerp_(far, 0.1)
        if graph is None or not detector.is_prepared:
            detector.prepare({0: (here, there)}, queries, geometry=True, least_by_vertex=True, grouped=names)
            graph = torch.cuda.CUDAGraph()
            with torch.cuda.graph(graph, stream=stream):
                detector.submit()
        graph.replay()
        parts = []
        for query in queries:
            answer = detector.on_device(query)
            numpy = lambda array: torch.from_dlpack(array).cpu().numpy().copy()
            geometry = {name: numpy(column) for name, column in answer.geometry.items()}
            groups = {name: [numpy(array) for array in both] for name, both in answer.grouped.items()}
            parts.append((geometry, numpy(answer.least_by_vertex), groups, numpy(answer.status)))
        for query, (geometry, least, groups, status) in zip(queries, parts):
            found = detector.collect(query)
            if status[2]:
                break
            wanted, count = detector.geometry(found), len(found)
            assert status[:2].sum() == count
            for name in ("vertices", "signed_weights", "points", "normals", "distances"):
                assert np.array_equal(geometry[name][:count], getattr(wanted, name)), (query, name)
                assert not geometry[name][count:].any(), (query, name)
            assert np.array_equal(least, detector.least_by_vertex(found, 0))
            for name in names:
                begins, rows = detector.grouped(found, 0, name)
                own_begins, own_rows = groups[name]
                assert np.array_equal(own_begins, begins) and np.array_equal(own_rows[: len(rows)], rows)
                assert (own_rows[len(rows) :] == -1).all()
            compared += count
    assert compared > 1000
