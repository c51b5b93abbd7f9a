"""The judge's known answers, and what it says of a wrong one: `python3 -m unittest judge_test` in this folder."""

import math
import random
import unittest
from fractions import Fraction

import judge
import scenes
import verdict


def brute(one, other):
    """By all pairs, without boxes."""
    corners = [[[tuple(map(Fraction, m[0][v])) for v in t] for t in m[1]] for m in (one, other)]
    return min(judge.triangle_triangle(a, b) for a in corners[0] for b in corners[1])


class Judge(unittest.TestCase):
    def test_what_a_formula_tells(self):
        for name, one, other, known in scenes.hard():
            if known is not None:
                self.assertEqual(judge.least_squared(one, other)[0], known, name)

    def test_boxes_lose_nothing(self):
        for name, one, other, _ in scenes.hard():
            if len(one[1]) * len(other[1]) < 1000:
                self.assertEqual(judge.least_squared(one, other)[0], brute(one, other), name)
        for at in (0.0, 1.9, 2.4):
            one, other = scenes.sphere(3, (0, 0, 0)), scenes.sphere(3, (at, 0.2, 0.1), 0.75)
            self.assertEqual(judge.least_squared(one, other)[0], brute(one, other), at)

    def test_points_of_triangles_are_never_nearer(self):
        random.seed(1)
        for _ in range(300):
            one, other = ([[random.randint(-6, 6) for _ in range(3)] for _ in range(3)] for _ in range(2))
            least = judge.triangle_triangle(one, other)
            self.assertEqual(least, judge.triangle_triangle(other, one))
            # On a lattice of weights some pair of points is nearly as near.
            lattice = [(i, j, 6 - i - j) for i in range(7) for j in range(7 - i)]
            points = [[[sum(w * v[k] for w, v in zip(ws, face)) for k in range(3)] for ws in lattice] for face in (one, other)]
            nearest = min(sum((p - q) ** 2 for p, q in zip(a, b)) for a in points[0] for b in points[1])
            self.assertLessEqual(least, Fraction(nearest, 36))
            # Some point of the lattice is within half a step of an edge from the nearest, on either face.
            step = sum(max(math.dist(v, w) for v in face for w in face) / 6 for face in (one, other))
            self.assertGreaterEqual(math.sqrt(least) + step, math.sqrt(nearest) / 6)

    def test_a_judge_without_piercing_is_found(self):
        def blind(a, b):
            return min(judge.segment_segment(*e, *f) for e in judge.edges(a) for f in judge.edges(b))

        floor, needle = scenes.one((0, 0, 0), (4, 0, 0), (0, 4, 0)), scenes.one((1, 1, -1), (1, 1, 1), (1.5, 1, 1))
        self.assertEqual(judge.least_squared(floor, needle)[0], 0)
        self.assertNotEqual(judge.least_squared(floor, needle, between=blind)[0], 0)


class Verdict(unittest.TestCase):
    def test_each_kind_of_wrong_is_named(self):
        quarter = Fraction(1, 16)
        self.assertEqual(verdict.of(0.25, quarter), "exact")
        self.assertEqual(verdict.of(0.0, Fraction(0)), "exact")
        self.assertEqual(verdict.of(0.0, quarter), "**0**")
        self.assertEqual(verdict.of(1e-9, Fraction(0)), "**1e-09 for 0**")
        self.assertEqual(verdict.of(0.25 * (1 + 2.0**-45), quarter), "2.8e-14")
        self.assertEqual(verdict.of(0.2525, quarter), "**0.01**")
        self.assertEqual(verdict.of(-1.0, quarter), "**-1**")
        self.assertEqual(verdict.of(math.nan, quarter), "**nan**")


if __name__ == "__main__":
    unittest.main()
