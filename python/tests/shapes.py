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
