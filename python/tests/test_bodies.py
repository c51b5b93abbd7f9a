"""Queries of pairs of bodies: their columns, and their agreement with other answers."""

import numpy as np
import pytest
from shapes import soup

import nearmiss as nm

CPU = nm.Device("cpu")


def scene(seed, count=12):
    """Rigid, fixed and deformable bodies around one place, as a list."""
    bodies = []
    for at in range(count):
        vertices, faces = soup(12, seed + at % 4, 0.3)
        kind = ("rigid", "deformable", "rigid", "fixed")[at % 4]
        offset = np.random.default_rng(seed + 100 + at).uniform(-0.7, 0.7, 3)
        bodies.append(nm.Body(vertices + offset, faces, kind=kind, name=f"body {at}"))
    return bodies


def touching(pairs):
    """The pairs of bodies of triangle pairs."""
    return sorted({tuple(row) for row in pairs.bodies.tolist()})


@pytest.mark.parametrize("seed", range(3))
def test_bodies_touch_if_their_triangles_do(seed):
    detector = nm.Detector(nm.Scene(*scene(seed)), device=CPU)
    wanted = touching(detector.discrete())
    found = detector.body_pairs()
    assert 0 < len(wanted) < 60 and found.bodies.tolist() == [list(pair) for pair in wanted]
    assert found.bodies.dtype == np.uint32 and not found.is_free and len(found) == len(wanted)
    assert found.names.tolist() == [[f"body {a}", f"body {b}"] for a, b in wanted]
    for first in (1, 2, 1000):
        assert touching(detector.body_pairs(first=first)) == wanted[:first]


@pytest.mark.parametrize("seed", range(3))
def test_distances_are_those_of_the_nearest_triangles(seed):
    own = scene(seed)
    detector = nm.Detector(nm.Scene(*own), device=CPU)
    near = detector.body_distances(0.2)
    rows = near.bodies.tolist()
    assert rows == sorted(rows) and len(near) > 5
    zero = [tuple(pair) for pair, length in zip(rows, near.distances) if length == 0]
    assert zero == touching(detector.discrete()) and 0 < len(zero) < len(near)
    assert near.min_distance == 0 == detector.distance().min_distance and not near.is_free
    assert near.points.shape == near.weights.shape == (len(near), 2, 3)
    lengths = np.linalg.norm(near.points[:, 0] - near.points[:, 1], axis=1)
    assert np.allclose(lengths, near.distances, atol=1e-12)
    assert np.allclose(near.weights.sum(axis=2), 1)
    for (a, b), triangles, length in zip(rows, near.triangles, near.distances):
        alone = nm.Detector(nm.Scene(own[a], own[b]), device=CPU).body_distances(0.2)
        if len(alone):
            assert alone.distances[0] == length and alone.triangles[0].tolist() == triangles.tolist()
    # A larger limit adds rows and changes none.
    more = detector.body_distances(0.4)
    kept = [row in rows for row in more.bodies.tolist()]
    assert len(more) > len(near) and more.distances[kept].tolist() == near.distances.tolist()
    assert len(detector.body_distances(0)) == len(zero)


def test_without_rows_columns_are_empty():
    detector = nm.Detector(nm.Scene(*scene(1, 1)), device=CPU)
    pairs, near = detector.body_pairs(), detector.body_distances(1.0)
    assert pairs.bodies.shape == (0, 2) and pairs.is_free and len(pairs) == len(near) == 0
    assert near.points.shape == (0, 2, 3) and near.distances.shape == (0,)
    assert near.min_distance is None and near.is_free
