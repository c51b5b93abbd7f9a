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
