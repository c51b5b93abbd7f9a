"""From libigl: the triangles of a mesh that cross, by its exact test (CGAL) and by nearmiss, side by side.

    pip install libigl nearmiss && python from_libigl.py [cells a side, default 100]

Both decide by exact signs, so they report the same pairs, with and without those that share a vertex. CGAL's test merges vertices
at one place. It leaves out triangles without area and duplicates; there are none here. Exits with 1 if the two differ.
"""

import sys

import igl.copyleft.cgal
import numpy as np
from sheets import fold
from side_by_side import Table

import nearmiss

_, vertices, faces = fold(int(sys.argv[1]) if len(sys.argv) > 1 else 100, slope=6.0)
vertices += 1e-4 * np.random.default_rng(1).standard_normal(vertices.shape)
table = Table("libigl", "nearmiss")


def cgal():
    return igl.copyleft.cgal.remesh_self_intersections(vertices, faces.astype(np.int64), detect_only=True)[2]


def pairs(rows):
    return {tuple(sorted(pair)) for pair in np.asarray(rows).tolist()}


print(f"{len(faces)} triangles")
theirs, ours = table.row("triangles that cross", cgal, lambda: nearmiss.self_intersections(vertices, faces, adjacent=True))
table.agree("triangles that cross", pairs(theirs) == pairs(ours))
apart = {(a, b) for a, b in pairs(theirs) if not set(faces[a]) & set(faces[b])}
table.agree("those without a common vertex", apart == pairs(nearmiss.self_intersections(vertices, faces)))
table.end()
