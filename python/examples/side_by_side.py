"""The same queries of two libraries, a row a query."""

import statistics
import sys
import time


class Table:
    """Values and times of two libraries, and whether they agree."""

    def __init__(self, theirs, ours):
        self.failed = []
        print(f"{'':42} {theirs:>28} {ours:>28}")

    def row(self, what, theirs, ours, times=5):
        """Run both, print the last values and the medians of the milliseconds, and return the values."""
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
        """Print whether both agree."""
        print(f"  {'agree' if yes else 'DISAGREE'}: {what}")
        if not yes:
            self.failed.append(what)

    def end(self):
        """Exit with 1 if they did not agree."""
        sys.exit(1 if self.failed else 0)
