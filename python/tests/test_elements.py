"""Edges of no face and points, and the caller's numbers of edges."""

import pickle

import numpy as np
import pytest

import nearmiss as nm

CPU = nm.Device("cpu")
KINDS = nm.Kind.VERTEX_FACE, nm.Kind.EDGE_EDGE, nm.Kind.EDGE_VERTEX, nm.Kind.VERTEX_VERTEX


def random_threads(seed, count=40):
    """Vertices at both ends of a step, a few faces, threads and points."""
    rng = np.random.default_rng(seed)
    start = rng.random((4 * count, 3))
    faces = np.arange(3 * (count // 3)).reshape(-1, 3)
    threads = np.arange(count, 2 * count)
    return start, start + rng.normal(0, 0.1, start.shape), faces, np.stack([threads[:-1], threads[1:]], axis=1), np.arange(2 * count, 4 * count)


def segment_distance(p, q, r, s):
    """The least distance of two segments, from points on a fine net of each: never too small."""
    t = np.linspace(0, 1, 41)
    one = p + t[:, None] * (q - p)
    other = r + t[:, None] * (s - r)
    return np.linalg.norm(one[:, None] - other[None], axis=2).min()


def test_threads_and_points_come_near():
    start, _, faces, edges, points = random_threads(1)
    near = nm.Detector(nm.Body(start, faces, edges=edges, points=points), device=CPU).near(0.1)
    assert set(near.kind) == set(KINDS)
    rows = {kind: near.kind == kind for kind in KINDS}
    pairs = {kind: list(zip(near.feature_a[own].tolist(), near.feature_b[own].tolist())) for kind, own in rows.items()}
    used = np.concatenate([faces.ravel(), np.unique(edges), points])
    others = sorted({tuple(sorted((p, q))) for p in points for q in used if p != q})
    both = [(p, q) for p, q in others if np.linalg.norm(start[p] - start[q]) <= 0.1]
    assert pairs[nm.Kind.VERTEX_VERTEX] == both
    ends = [edges[edge] for edge in range(len(edges))]
    wanted = []
    for at, (a, b) in enumerate(ends):
        along = start[b] - start[a]
        for vertex in used:
            if vertex in (a, b):
                continue
            t = np.clip((start[vertex] - start[a]) @ along / (along @ along), 0, 1)
            if np.linalg.norm(start[a] + t * along - start[vertex]) <= 0.1:
                wanted.append((at, vertex))
    assert pairs[nm.Kind.EDGE_VERTEX] == wanted
    own = [(a, b) for a, b in pairs[nm.Kind.EDGE_EDGE] if b < len(edges)]
    for i in range(len(edges)):
        for j in range(i + 1, len(edges)):
            if not set(ends[i]) & set(ends[j]) and segment_distance(*start[ends[i]], *start[ends[j]]) <= 0.1:
                assert (i, j) in own


def test_a_step_of_threads_is_safe():
    start, end, faces, edges, points = random_threads(2)
    detector = nm.Detector(nm.Body(start, faces, edges=edges, points=points), device=CPU)
    detector.update({0: (start, end)})
    found = detector.continuous(min_separation=0.05)
    assert set(found.kind) == set(KINDS)
    geometry = detector.geometry(found)
    rows = found.kind == nm.Kind.EDGE_VERTEX
    assert (geometry.vertices[rows, 2] == geometry.vertices[rows, 3]).all()
    assert (np.sort(geometry.vertices[rows, :2]) == np.sort(edges[found.feature_a[rows]])).all()
    assert np.allclose(geometry.signed_weights.sum(axis=1), 0, atol=1e-12)
    assert detector.earliest(min_separation=0.05).toi == found.toi.min()


def test_numbers_are_those_of_the_list():
    low = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 1], [9, 1, 1], [9, 2, 1]], float)
    faces = [[0, 1, 2], [3, 4, 5]]
    plain = nm.Detector(nm.Body(low, faces), device=CPU).near(2)
    numbers = [[4, 5], [0, 1], [5, 3], [2, 1], [3, 4], [0, 2]]
    by_list = nm.Detector(nm.Body(low, faces, edges=numbers), device=CPU).near(2)
    table = np.array([[1, 0], [2, 0], [2, 1], [4, 3], [5, 3], [5, 4]])

    def named(found, edges):
        rows = zip(found.kind.tolist(), found.feature_a.tolist(), found.feature_b.tolist())
        edges = [frozenset(edge) for edge in np.asarray(edges).tolist()]
        return {frozenset([edges[a], edges[b]]) if kind == nm.Kind.EDGE_EDGE else (a, b) for kind, a, b in rows}

    assert named(plain, table) == named(by_list, numbers) and len(plain) > 3


def test_a_body_of_points_needs_no_face():
    rng = np.random.default_rng(4)
    dots = rng.random((100, 3))
    detector = nm.Detector(nm.Body(dots, np.empty((0, 3), int), points=np.arange(100)), device=CPU)
    found = detector.near(0.1)
    wanted = np.argwhere(np.triu(np.linalg.norm(dots[:, None] - dots[None], axis=2) <= 0.1, 1))
    assert np.array_equal(np.stack([found.feature_a, found.feature_b], axis=1), wanted) and len(wanted) > 3
    starts, rows = detector.grouped(found, 0, "vertex")
    assert starts[-1] == 2 * len(wanted) == len(rows)


@pytest.mark.parametrize(
    ("given", "error", "text"),
    [
        ({"edges": [[0, 9]]}, nm.InputError, "edge 0 names vertex 9, but there are 3"),
        ({"edges": [[1, 1]]}, nm.InputError, "edge 0 has vertex 1 at both ends"),
        ({"edges": [[0, -1]]}, nm.InputError, "row 0 has index -1"),
        ({"edges": [0, 1]}, nm.InvalidArgumentError, "of shape"),
        ({"edges": [[0.5, 1]]}, nm.InvalidArgumentError, "of type"),
        ({"points": [3]}, nm.InputError, "point 0 names vertex 3"),
        ({"points": [[0, 1]]}, nm.InvalidArgumentError, "of shape"),
    ],
)
def test_bad_lists_are_refused_by_name(given, error, text):
    with pytest.raises(error, match=text) as raised:
        nm.Body([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], name="cloth", **given)
    assert "cloth" in str(raised.value)


def test_a_body_is_pickled_with_its_lists():
    body = nm.Body([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [], edges=[[2, 0]], points=[1])
    copy = pickle.loads(pickle.dumps(body))
    assert copy.edges.tolist() == [[2, 0]] and copy.points.tolist() == [1] and copy.face_count == 0


def test_lines_and_points_of_files_are_edges_and_points(tmp_path):
    path = tmp_path / "hair.obj"
    path.write_text("v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 0.5\nv 1 1 3\nv 1 1.2 2\nf 1 2 3\nl 4 5\np 6\n")
    vertices, faces, edges, points = nm.read_mesh(path, elements=True)
    assert (faces.tolist(), edges.tolist(), points.tolist()) == ([[0, 1, 2]], [[3, 4]], [5])
    near = nm.Detector(nm.Body(vertices, faces, edges=edges, points=points), device=CPU).near(0.5)
    assert near.kind.tolist() == [nm.Kind.VERTEX_FACE, nm.Kind.EDGE_VERTEX]
    # Two arrays have the same elements as faces, so that nothing is lost.
    vertices, faces = nm.read_mesh(path)
    assert faces.tolist() == [[0, 1, 2], [4, 3, 3], [5, 5, 5]]
    assert len(nm.Detector(nm.Body(vertices, faces), device=CPU).near(0.5)) >= 2


def test_an_index_that_no_vertex_has_is_an_input_error():
    corners = np.zeros((3, 3))
    for lists in [{"points": [1, -1]}, {"edges": [[0, 1], [0, -1]]}, {"edges": [[0, 1], [0, 2**32]]}]:
        with pytest.raises(nm.InputError, match="row 1 has index"):
            nm.Body(corners, [[0, 1, 2]], **lists)
