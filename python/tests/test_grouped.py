"""Rows by vertex, edge and face, against the rows' geometry."""

import numpy as np
import pytest

import nearmiss as nm

CPU = nm.Device("cpu")
LOW = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0]], float)


@pytest.fixture
def detector():
    scene = nm.Scene(nm.Body(LOW, [[0, 1, 2]], name="low"))
    scene.add(nm.Body(LOW + [0.5, 0.5, 0.25], [[0, 1, 2]], name="high"))
    return nm.Detector(scene, device=CPU)


@pytest.mark.parametrize("body", [0, 1])
@pytest.mark.parametrize("by", ["vertex", "edge", "face", "corner"])
def test_each_row_is_with_its_features(detector, body, by):
    pairs = detector.near(1.0)
    at = detector.geometry(pairs)
    starts, rows = detector.grouped(pairs, body, by)
    assert starts[0] == 0 and starts[-1] == len(rows)
    of = {(feature, row) for feature in range(len(starts) - 1) for row in rows[starts[feature] : starts[feature + 1]]}
    kind, sides = pairs.kind, ((pairs.bodies[:, 0], pairs.feature_a), (pairs.bodies[:, 1], pairs.feature_b))
    vf = kind == nm.Kind.VERTEX_FACE
    if by == "corner":
        wanted = {(v, row) for row in range(len(pairs)) for v, own in zip(at.vertices[row], at.owner[row]) if own == body}
    else:
        chosen = {"vertex": [(0, vf)], "face": [(1, vf)], "edge": [(0, ~vf), (1, ~vf)]}[by]
        each = ((sides[k][1][row], row) for k, those in chosen for row in np.flatnonzero(those & (sides[k][0] == body)))
        wanted = set(each)
    assert of == wanted and wanted


def test_least_numbers_are_those_of_the_rows(detector):
    pairs = detector.near(1.0)
    at = detector.geometry(pairs)
    for body in (0, "high"):
        own = at.owner == (0 if body == 0 else 1)
        wanted = [pairs.distances[(own & (at.vertices == v)).any(axis=1)].min(initial=np.inf) for v in range(3)]
        assert np.allclose(detector.least_by_vertex(pairs, body), wanted)
    detector.update({"high": (LOW + [0.5, 0.5, 0.25], LOW + [0.5, 0.5, -0.25])})
    contacts = detector.continuous()
    assert np.allclose(detector.least_by_vertex(contacts, "high"), 0.5, atol=1e-3)


def test_what_has_no_such_rows_is_refused(detector):
    pairs = detector.near(1.0)
    with pytest.raises(nm.InvalidArgumentError, match='by is unknown, got "side"; choose one of "vertex"'):
        detector.grouped(pairs, 0, "side")
    with pytest.raises(nm.InvalidArgumentError, match="body 7 is not in the scene"):
        detector.grouped(pairs, 7)
    with pytest.raises(nm.InvalidArgumentError, match="cannot be grouped by vertex"):
        detector.grouped(detector.discrete(), 0, "vertex")
    with pytest.raises(nm.InvalidArgumentError, match="no time and no distance"):
        detector.least_by_vertex(detector.discrete(), 0)


def on_device(query, **parts):
    """The parts of a submitted answer as arrays, the status, the collected answer and its detector."""
    rng = np.random.default_rng(3)
    x0 = rng.random((90, 3)) + np.repeat(rng.random((30, 3)), 3, axis=0)
    x1 = x0 + 0.2 * rng.random((90, 3))
    scene = nm.Scene(nm.Body(x0, np.arange(90).reshape(30, 3)))
    scene.add(nm.Body(LOW / 2, [[0, 1, 2]], kind="fixed"))
    own = nm.Detector(scene, device=CPU)
    own.prepare({0: (x0, x1)}, [query], **parts)
    own.submit()
    answer = own.on_device(query)
    status = np.from_dlpack(answer.status)
    return own, answer, int(status[:2].sum()), own.collect(query)


@pytest.mark.parametrize("query", [nm.Near(0.1), nm.Continuous(), nm.Continuous(min_separation=0.01)])
def test_parts_on_the_device_are_those_of_the_host(query):
    names = ["vertex", "edge", "face", "corner"]
    own, answer, count, found = on_device(query, geometry=True, least_by_vertex=True, grouped=names)
    assert len(found) == count > 20 and list(answer.grouped) == names
    geometry = {name: np.from_dlpack(column) for name, column in answer.geometry.items()}
    wanted, starts = own.geometry(found), answer.starts
    vertices = wanted.vertices + starts[:, 0][wanted.owner]
    # Rows of a CPU are in no order: they are compared by their vertices and weights.
    order = lambda vertices, weights: np.lexsort([*weights.T, *vertices.T])
    mine = order(geometry["vertices"][:count], geometry["signed_weights"][:count])
    theirs = order(vertices, wanted.signed_weights)
    for name in ("signed_weights", "points", "normals", "distances"):
        assert np.array_equal(geometry[name][:count][mine], getattr(wanted, name)[theirs]), name
        assert not geometry[name][count:].any(), name
    assert np.array_equal(geometry["vertices"][:count][mine], vertices[theirs])
    least = np.from_dlpack(answer.least_by_vertex)
    assert np.array_equal(least, np.concatenate([own.least_by_vertex(found, body) for body in (0, 1)]))
    place = np.empty(count, int)
    place[theirs] = mine
    for name in names:
        begins, rows = map(np.from_dlpack, answer.grouped[name])
        groups = [(place[own_rows[a:b]], body) for body in (0, 1) for own_begins, own_rows in [own.grouped(found, body, name)]
                  for a, b in zip(own_begins, own_begins[1:])]
        assert len(groups) == len(begins) - 1
        for feature, (group, _) in enumerate(groups):
            assert np.array_equal(rows[begins[feature] : begins[feature + 1]], np.sort(group)), (name, feature)
        assert (rows[begins[-1] :] == -1).all()


def test_parts_that_were_not_requested_are_absent():
    _, answer, _, _ = on_device(nm.Near(0.1))
    assert answer.geometry is None and answer.least_by_vertex is None and answer.grouped == {}
    _, answer, _, _ = on_device(nm.Discrete(), grouped=["face"])
    assert list(answer.grouped) == ["face"] and answer.geometry is None
    with pytest.raises(nm.InvalidArgumentError, match="geometry of rows in device memory"):
        on_device(nm.Discrete(), geometry=True)
    with pytest.raises(nm.InvalidArgumentError, match="by is unknown"):
        on_device(nm.Near(0.1), grouped=["line"])
