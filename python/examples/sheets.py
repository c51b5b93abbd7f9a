"""Sheets of triangles, for examples and tests."""

import numpy as np


def grid(n):
    """A unit square of n by n cells: x and y of its (n + 1)^2 vertices, and its 2 n^2 triangles."""
    x, y = (axis.ravel() / n for axis in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    a, b, c, d = i * (n + 1) + j, (i + 1) * (n + 1) + j, i * (n + 1) + j + 1, (i + 1) * (n + 1) + j + 1
    return x, y, np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])


def fold(n, slope):
    """A sheet folded in two whose halves pass through each other along a strip: vertices at two times, and faces.

    slope: how fast one half goes over into the other, across the fold.
    """
    x, y, faces = grid(n)
    half = np.clip(slope * (x - 0.5), -1, 1)
    wave = 0.1 * np.sin(25 * np.abs(x - 0.5)) * np.cos(9 * y)
    gaps = (np.full(y.shape, 0.003), np.clip(0.1 * y - 0.005, -0.003, 0.003))
    t0, t1 = (np.stack([np.abs(x - 0.5), y, wave + half * gap], axis=1) for gap in gaps)
    return t0, t1, faces
