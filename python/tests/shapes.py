"""Meshes of the tests."""

import numpy as np
from sheets import grid


def two_triangles():
    """One lies, the other stands in it and crosses it: ((6, 3) float32, (2, 3))."""
    vertices = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [2, 1, 1]]
    return np.array(vertices, np.float32), np.array([[0, 1, 2], [3, 4, 5]])


def sheet(n, height=lambda x, y: 0 * x):
    """A square of n by n cells: (((n + 1)^2, 3) float32, (2 n^2, 3))."""
    x, y, faces = grid(n)
    return np.stack([x, y, height(x, y)], axis=1).astype(np.float32), faces


def soup(count, seed, size=0.2):
    """Triangles that share no vertex: ((3 count, 3) float64, (count, 3))."""
    random = np.random.default_rng(seed)
    corners = random.random((count, 1, 3)) + size * (random.random((count, 3, 3)) - 0.5)
    return corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


def ball(rings):
    """Vertices and faces of a unit sphere, by rings and twice as many meridians."""
    around = 2 * rings
    tilt, turn = np.pi * np.arange(1, rings) / rings, 2 * np.pi * np.arange(around) / around
    x, y = np.outer(np.sin(tilt), np.cos(turn)).ravel(), np.outer(np.sin(tilt), np.sin(turn)).ravel()
    belt = np.stack([x, y, np.repeat(np.cos(tilt), around)], 1)
    next_of = np.roll(np.arange(around), -1)
    a = 1 + (around * np.arange(rings - 2)[:, None] + np.arange(around)).ravel()
    b = 1 + (around * np.arange(rings - 2)[:, None] + next_of).ravel()
    first, last = 1 + np.arange(around), 1 + around * (rings - 2) + np.arange(around)
    top = np.stack([np.zeros(around, int), first, first[next_of]], 1)
    end = np.stack([last, np.full(around, 1 + around * (rings - 1)), last[next_of]], 1)
    faces = [top, np.stack([a, a + around, b], 1), np.stack([b, a + around, b + around], 1), end]
    return np.concatenate([[[0, 0, 1]], belt, [[0, 0, -1]]]), np.concatenate(faces)
