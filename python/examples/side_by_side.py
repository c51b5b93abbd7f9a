"""Two libraries asked the same, a row a question."""

import statistics
import sys
import time

import numpy as np


class Table:
    """Values and times of two libraries, and whether they agree."""

    def __init__(self, theirs, ours):
        self.failed = []
        print(f"{'':42} {theirs:>28} {ours:>28}")

    def row(self, what, theirs, ours, times=5):
        """Asks both, prints the last values and the medians of the milliseconds, and returns the values."""
        values, cells = [], []
        for ask in (theirs, ours):
            taken = []
            for _ in range(times):
                begin = time.perf_counter()
                value = ask()
                taken.append(1e3 * (time.perf_counter() - begin))
            shown = len(value) if hasattr(value, "__len__") else f"{value:.7g}" if isinstance(value, float) else value
            values.append(value)
            cells.append(f"{shown} in {statistics.median(taken):.2f} ms")
        print(f"{what:42} {cells[0]:>28} {cells[1]:>28}")
        return values

    def agree(self, what, yes):
        """What both must agree on."""
        print(f"  {'agree' if yes else 'DISAGREE'}: {what}")
        if not yes:
            self.failed.append(what)

    def end(self):
        """Exits with 1 where they did not agree."""
        sys.exit(1 if self.failed else 0)


def fold(n):
    """A sheet folded in two whose halves pass through each other along a strip: vertices at two times, and faces."""
    x, y = (axis.ravel() / n for axis in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    half = np.clip(0.6 * n * (x - 0.5), -1, 1)
    wave = 0.1 * np.sin(25 * np.abs(x - 0.5)) * np.cos(9 * y)
    ends = [wave + half * gap for gap in (np.full(y.shape, 0.003), np.clip(0.1 * y - 0.005, -0.003, 0.003))]
    t0, t1 = (np.stack([np.abs(x - 0.5), y, z], axis=1) for z in ends)
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    a, b, c, d = i * (n + 1) + j, (i + 1) * (n + 1) + j, i * (n + 1) + j + 1, (i + 1) * (n + 1) + j + 1
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])
    return np.asfortranarray(t0), np.asfortranarray(t1), np.asfortranarray(faces.astype(np.int32))
