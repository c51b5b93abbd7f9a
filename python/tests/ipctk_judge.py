"""The judge of the broad phase for ipctk: distances by ipctk's own functions, pair by pair, and their least value in a step."""

import itertools

import ipctk
import numpy as np

# The numbers of both features of a candidate, for each list of candidates.
LISTS = {
    "vertex_vertex": ("vertex0_id", "vertex1_id"),
    "edge_vertex": ("edge_id", "vertex_id"),
    "edge_edge": ("edge0_id", "edge1_id"),
    "face_vertex": ("face_id", "vertex_id"),
    "edge_face": ("edge_id", "face_id"),
    "face_face": ("face0_id", "face1_id"),
}
BY_SIZE = {
    (1, 1): ipctk.point_point_distance,
    (1, 2): ipctk.point_edge_distance,
    (1, 3): ipctk.point_triangle_distance,
    (2, 2): ipctk.edge_edge_distance,
}

# A pair that needs more intervals of time is undecided.
MOST_INTERVALS = 20_000


class Undecided(Exception):
    """A least distance so near to a bound that the judge cannot decide."""


def numbers(name, candidates):
    """Candidates of a list as a set of pairs of numbers; those of two features of one kind ascend."""
    first, second = LISTS[name]
    pairs = ((getattr(c, first), getattr(c, second)) for c in candidates)
    return {tuple(sorted(pair)) if "1" in second else pair for pair in pairs}


def features(name, pair, edges, faces):
    """The vertices of both features of a pair, those of the smaller feature first."""
    vertices = {"vertex": lambda at: [at], "edge": lambda at: edges[at].tolist(), "face": lambda at: faces[at].tolist()}
    return sorted((vertices[kind](at) for kind, at in zip(name.split("_"), pair)), key=len)


def distance(first, second):
    """The distance of two points, segments or triangles."""
    sizes = len(first), len(second)
    if sizes in BY_SIZE:
        return float(np.sqrt(max(0.0, BY_SIZE[sizes](*first, *second))))
    if crosses(first, second) or crosses(second, first):
        return 0.0
    parts = [(point, second) for point in first] + [(point, first) for point in second]
    ends = itertools.product(sides(first), sides(second))
    return min([distance(point[None], other) for point, other in parts if len(other) > 1] + [distance(a, b) for a, b in ends])


def sides(feature):
    """The edges of a segment or of a triangle."""
    return [feature] if len(feature) == 2 else [feature[[a, b]] for a, b in ((0, 1), (1, 2), (2, 0))]


def crosses(edge_or_face, face):
    """Whether an edge of the one crosses the other, a triangle."""
    return len(face) == 3 and any(ipctk.is_edge_intersecting_triangle(*edge, *face) for edge in sides(edge_or_face))


def comes_within(reach, pair, t0, t1, end=1.0):
    """Whether two features come within a distance between t = 0 and `end`, as each point moves in a straight line.

    Distances change by at most the largest speed of both features: an interval of time is settled if its middle is far enough.
    """
    first, second = pair
    speed = max(np.linalg.norm(t1[a] - t0[a] - t1[b] + t0[b]) for a in first for b in second)
    open_intervals, left = [(0.0, end)], MOST_INTERVALS
    while open_intervals:
        (start, stop), left = open_intervals.pop(), left - 1
        middle = 0.5 * (start + stop)
        at = t0 + middle * (t1 - t0)
        gap = distance(at[first], at[second]) - reach
        if gap <= 0:
            return True
        if gap <= 0.5 * (stop - start) * speed:
            if left == 0 or stop - start < 1e-10:
                raise Undecided(f"{pair} at t = {middle}: {gap} beyond {reach}")
            open_intervals += [(start, middle), (middle, stop)]
    return False
