"""The exact distance of two triangle meshes, in rational numbers.

Boxes are searched best first. Their distances are doubles, made less by more than rounding can add; what triangles are apart is
exact. So the search ends when no box is nearer than the best pair, and what it says is the least there is.
"""

import heapq
from fractions import Fraction
from itertools import product


def minus(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def point_segment(p, a, b):
    along, to = minus(b, a), minus(p, a)
    t, whole = dot(to, along), dot(along, along)
    if t <= 0:
        return Fraction(dot(to, to))
    if t >= whole:
        return Fraction(dot(minus(p, b), minus(p, b)))
    return Fraction(dot(to, to) * whole - t * t, whole)


def segment_segment(p, q, a, b):
    d, e, r = minus(q, p), minus(b, a), minus(p, a)
    dd, ee, de, dr, er = dot(d, d), dot(e, e), dot(d, e), dot(d, r), dot(e, r)
    area = dd * ee - de * de
    s, t = de * er - dr * ee, dd * er - de * dr
    if area > 0 and 0 <= s <= area and 0 <= t <= area:
        normal = cross(d, e)
        return Fraction(dot(r, normal) ** 2, area)
    return min(point_segment(p, a, b), point_segment(q, a, b), point_segment(a, p, q), point_segment(b, p, q))


def over(p, face, normal):
    """Is p, seen along the normal, on the face?"""
    return all(dot(cross(minus(face[(i + 1) % 3], face[i]), minus(p, face[i])), normal) >= 0 for i in range(3))


def edges(face):
    return [(face[i], face[(i + 1) % 3]) for i in range(3)]


def pierces(p, q, face, normal):
    """Does the segment go from one side of the plane to the other through the face?"""
    a, b = dot(minus(p, face[0]), normal), dot(minus(q, face[0]), normal)
    if a * b >= 0:
        return False
    # Its point in the plane, times (a - b): the face is scaled alike.
    scale = abs(a - b)
    at = tuple((a * q[k] - b * p[k]) * (1 if a > b else -1) for k in range(3))
    return over(at, [tuple(c * scale for c in v) for v in face], normal)


def triangle_triangle(one, other):
    """Squared, of triangles of integers or fractions."""
    best = min(segment_segment(*e, *f) for e, f in product(edges(one), edges(other)))
    for face, against in ((one, other), (other, one)):
        normal = cross(minus(face[1], face[0]), minus(face[2], face[0]))
        whole = dot(normal, normal)
        if whole == 0:
            continue
        if any(pierces(p, q, face, normal) for p, q in edges(against)):
            return Fraction(0)
        for p in against:
            if over(p, face, normal):
                best = min(best, Fraction(dot(minus(p, face[0]), normal) ** 2, whole))
    return best


class Node:
    __slots__ = ("low", "high", "children", "triangle")

    def __init__(self, boxes, triangles):
        self.low = tuple(min(boxes[t][0][k] for t in triangles) for k in range(3))
        self.high = tuple(max(boxes[t][1][k] for t in triangles) for k in range(3))
        self.children, self.triangle = (), triangles[0]
        if len(triangles) > 1:
            axis = max(range(3), key=lambda k: self.high[k] - self.low[k])
            triangles.sort(key=lambda t: boxes[t][0][axis] + boxes[t][1][axis])
            half = len(triangles) // 2
            self.children = (Node(boxes, triangles[:half]), Node(boxes, triangles[half:]))

    def extent(self):
        return sum(h - l for l, h in zip(self.low, self.high))


def tree(mesh):
    vertices, triangles = mesh
    corners = [[vertices[v] for v in t] for t in triangles]
    boxes = [(tuple(map(min, zip(*c))), tuple(map(max, zip(*c)))) for c in corners]
    return Node(boxes, list(range(len(triangles))))


def apart(one, other):
    """At most the boxes' squared distance. Coordinates are f32: their difference, squared and summed, is off by less than 2^-50."""
    total = 0.0
    for k in range(3):
        gap = max(one.low[k] - other.high[k], other.low[k] - one.high[k], 0.0)
        total += gap * gap
    return total * (1 - 2.0**-49)


def least_squared(one, other, between=triangle_triangle):
    """The least squared distance, a Fraction; and of which triangles."""
    # Powers of two make all coordinates integers, whose sums and products are the fastest exact ones.
    scale = max(Fraction(c).denominator for m in (one, other) for v in m[0] for c in v)
    whole = [[tuple(int(Fraction(c) * scale) for c in v) for v in m[0]] for m in (one, other)]
    roots = tree(one), tree(other)
    heap, count = [(apart(*roots), 0, *roots)], 0
    best, pair = None, None
    while heap:
        bound, _, a, b = heapq.heappop(heap)
        if best is not None and Fraction(bound) >= best:
            break
        if not a.children and not b.children:
            corners = [[points[v] for v in m[1][n.triangle]] for points, m, n in zip(whole, (one, other), (a, b))]
            squared = between(*corners) / scale**2
            if best is None or squared < best:
                best, pair = squared, (a.triangle, b.triangle)
            continue
        if a.children and (not b.children or a.extent() >= b.extent()):
            pairs = [(child, b) for child in a.children]
        else:
            pairs = [(a, child) for child in b.children]
        for next_a, next_b in pairs:
            count += 1
            heapq.heappush(heap, (apart(next_a, next_b), count, next_a, next_b))
    return best, pair
