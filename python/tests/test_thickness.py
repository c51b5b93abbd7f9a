"""A thickness adds the radii of both features to a distance."""

import pickle

import numpy as np
import pytest

import nearmiss as nm

CPU = nm.Device("cpu")
FACES = [[0, 1, 2]]
LOW = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float)


def detector(below, above, height=1.0):
    scene = nm.Scene(
        nm.Body(LOW, FACES, name="low", thickness=below),
        nm.Body(LOW + [0, 0, height], FACES, name="high", thickness=above),
    )
    return nm.Detector(scene, device=CPU)


def rows(answer):
    return list(zip(answer.kind.tolist(), answer.bodies.tolist(), answer.feature_a.tolist(), answer.feature_b.tolist()))


def test_one_radius_a_body_is_a_longer_distance():
    thick, thin = detector(0.25, 0.5), detector(0.0, 0.0)
    assert len(thin.near(0.75)) == 0 and len(thin.near(1.0)) == 15
    assert rows(thick.near(0.25)) == rows(thin.near(1.0))
    assert len(thick.near(0.2)) == 0
    # Distances are those of the surfaces without thickness.
    assert thick.near(0.25).min_distance == 1.0


def test_a_radius_of_a_vertex_counts_at_its_points_alone():
    found = detector(0.25, np.array([0.25, 0.25, 0.75], np.float32)).near(0)
    # Both vertices 2, and both edges that end there, which have the numbers 1 and 2.
    vertices = [(nm.Kind.VERTEX_FACE, bodies, 2, 0) for bodies in ([0, 1], [1, 0])]
    assert rows(found) == vertices + [(nm.Kind.EDGE_EDGE, [0, 1], a, b) for a in (1, 2) for b in (1, 2)]
    assert len(detector(0.25, 0.75).near(0)) == 15


def test_a_step_ends_at_the_thickness():
    scene = nm.Scene(
        nm.Body(LOW, FACES, name="low", kind="fixed"), nm.Body(LOW + [0, 0, 2.0], FACES, name="high", thickness=0.5)
    )
    own = nm.Detector(scene, device=CPU)
    own.update({"high": (LOW + [0, 0, 2.0], LOW + [0, 0, 0.25])})
    first = own.earliest()
    assert first.toi == pytest.approx(1.5 / 1.75, abs=1e-3) and first.toi <= 1.5 / 1.75
    assert own.earliest(min_separation=0.25).toi == pytest.approx(1.25 / 1.75, abs=1e-3)


def test_bodies_with_one_and_without_are_in_one_step():
    falling = {"a": (LOW + [0, 0, 4.0], LOW), "b": (LOW + [0, 0, 8.0], LOW + [0, 0, 2.25])}

    def step(thickness, **how):
        bodies = [nm.Body(end[0], FACES, name=name, thickness=thickness.get(name, 0)) for name, end in falling.items()]
        own = nm.Detector(nm.Scene(nm.Body(LOW + [0, 0, 2.0], FACES, name="low", kind="fixed"), *bodies), device=CPU)
        own.update(falling)
        return own.continuous(**how), own.earliest(**how)

    (mixed, first), (thin, _) = step({"b": 0.5}), step({})
    (thick, _) = step({"b": 0.5}, min_separation=1e-300)

    def timed(answer, of_b):
        return [row for row in zip(rows(answer), answer.toi.tolist()) if (2 in row[0][1]) == of_b]

    # Without a thickness pairs touch, with one they come within it.
    assert timed(mixed, False) == timed(thin, False) and len(timed(thin, False)) > 0
    assert timed(mixed, True) == timed(thick, True) and len(timed(mixed, True)) > len(timed(thin, True))
    assert first.toi == min(mixed.toi)


def test_it_can_change_and_is_kept_in_copies():
    own = detector(0.0, 0.0)
    own.set_thickness("low", 0.5)
    own.set_thickness(1, [0.5, 0.5, 0.5])
    assert len(own.near(0)) == 15
    body = nm.Body(LOW, FACES, thickness=[0.0, 0.5, 1.0])
    copy = pickle.loads(pickle.dumps(body))
    assert np.array_equal(copy.thickness, [0.0, 0.5, 1.0]) and nm.Body(LOW, FACES).thickness == 0.0


def test_what_is_no_length_is_refused_and_nothing_changes():
    own = detector(0.25, 0.25)
    before = own.near(0.5).hash
    for bad, says in [
        (-1.0, "must be from 0 to 2\\^60, got -1"),
        (float("nan"), "got NaN"),
        ([0.0, 1.0], "2 radii for 3 vertices"),
        ([0.0, -1.0, 0.0], "vertex 1, must be"),
        ([[0.0]], "of shape"),
        ("thick", "of type"),
    ]:
        with pytest.raises(nm.InvalidArgumentError, match=says):
            own.set_thickness("low", bad)
        with pytest.raises(nm.InvalidArgumentError, match=says):
            nm.Body(LOW, FACES, thickness=bad)
    with pytest.raises(nm.InvalidArgumentError):
        own.set_thickness("nobody", 1.0)
    assert own.near(0.5).hash == before
    with pytest.raises(nm.InvalidArgumentError, match="distance must be above 0"):
        detector(0.0, 0.0).near(0)
