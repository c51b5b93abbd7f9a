"""Pairs of meshes whose distance is asked: by formula, so that anyone has the same. All coordinates are f32.

A mesh is (vertices, triangles); a scene is (name, mesh, mesh, known): the squared distance where a formula tells it, else None.
"""

import math
import struct
from array import array
from fractions import Fraction


def rounded(x):
    """The f32 nearest to x, as a double."""
    return struct.unpack("<f", struct.pack("<f", x))[0]


def up(x):
    """The next f32 above a positive x."""
    return struct.unpack("<f", struct.pack("<I", struct.unpack("<I", struct.pack("<f", x))[0] + 1))[0]


def mesh(vertices, triangles):
    return [tuple(map(rounded, v)) for v in vertices], [tuple(t) for t in triangles]


def sheet(n, height):
    """n x n squares over the unit square, two triangles each."""
    vertices = [(i / n, j / n, height(i / n, j / n)) for j in range(n + 1) for i in range(n + 1)]
    triangles = []
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i
            triangles += [(a, a + 1, a + n + 1), (a + 1, a + n + 2, a + n + 1)]
    return mesh(vertices, triangles)


def sphere(n, centre, radius=1.0):
    """n bands from pole to pole, 2 n around."""
    around, (x, y, z) = 2 * n, centre
    vertices = []
    for i in range(1, n):
        t = math.pi * i / n
        for j in range(around):
            p = 2 * math.pi * j / around
            vertices.append(
                (x + radius * math.sin(t) * math.cos(p), y + radius * math.sin(t) * math.sin(p), z + radius * math.cos(t))
            )
    vertices += [(x, y, z + radius), (x, y, z - radius)]
    north, south, last = len(vertices) - 2, len(vertices) - 1, (n - 2) * around
    triangles = []
    for i in range(n - 2):
        for j in range(around):
            a, b = i * around + j, i * around + (j + 1) % around
            triangles += [(a, a + around, b), (b, a + around, b + around)]
    for j in range(around):
        triangles += [(north, j, (j + 1) % around), (south, last + (j + 1) % around, last + j)]
    return mesh(vertices, triangles)


def scaled(shape, factor):
    """By a power of two: exact."""
    return [tuple(c * factor for c in v) for v in shape[0]], shape[1]


def one(*corners):
    return mesh(corners, [(0, 1, 2)])


def large():
    """The five scenes whose time is measured."""
    ball = sphere(110, (0, 0, 0))
    lower = sheet(158, lambda x, y: 0.01 * math.sin(20 * x) * math.cos(17 * y))
    upper = sheet(158, lambda x, y: 0.05 + 0.01 * math.sin(23 * x + 1) * math.cos(19 * y))
    gap = Fraction(rounded(0.05))
    yield "wavy sheets", lower, upper, None
    yield "parallel sheets", sheet(158, lambda x, y: 0), sheet(158, lambda x, y: 0.05), gap * gap
    yield "spheres apart", ball, sphere(110, (2.5, 0.3, 0.1)), None
    yield "spheres in each other", ball, sphere(110, (1.5, 0.3, 0.1)), Fraction(0)
    yield "spheres nearly touching", ball, sphere(110, (2.0001, 0, 0)), None


def hard():
    """Few triangles, and an answer that rounding may lose."""
    floor = one((0, 0, 0), (4, 0, 0), (0, 4, 0))
    slope = one((0, 0, 3), (3, 0, 0), (0, 3, 0))
    thin = one((0, 0, 0), (1, 2**-20, 0), (2, 2**-22, 2**-23))
    ball = sphere(12, (0, 0, 0))
    near = sphere(12, (2.001, 0.01, 0.02))
    yield "a vertex on a face", floor, one((1, 1, 0), (2, 1, 1), (1, 2, 1)), Fraction(0)
    yield "a vertex 2^-40 over a face", floor, one((1, 1, 2**-40), (2, 1, 1), (1, 2, 1)), Fraction(1, 2**80)
    yield "a vertex on a sloping face", slope, one((1, 1, 1), (2, 2, 2), (2, 3, 2)), Fraction(0)
    yield "an ulp over a sloping face", slope, one((1, 1, up(1)), (2, 2, 2), (2, 3, 2)), None
    yield "edges that cross in a point", floor, one((2, 2, 0), (3, 3, 1), (3, 3, -1)), Fraction(0)
    yield "edges an ulp apart", floor, one((up(2), up(2), 0), (3, 3, 1), (3, 3, -1)), None
    yield "faces in one plane, side by side", floor, one((5, 0, 0), (5, 4, 0), (9, 0, 0)), Fraction(1)
    yield "faces in one plane, overlapping", floor, one((1, 1, 0), (9, 1, 0), (1, 9, 0)), Fraction(0)
    yield "slivers", thin, one((0.5, 1, 0.1), (1, -1, 0.1), (1, -1.0001, 0.1)), None
    yield "slivers that cross", thin, one((1, 1, -(2**-24)), (1, -1, 2**-21), (1, -1.0001, 2**-21)), None
    yield "a ball in a ball", ball, sphere(12, (0, 0, 0), 0.5), None
    yield "balls a thousandth apart", ball, near, None
    yield "the same, 2^-50 as large", scaled(ball, 2.0**-50), scaled(near, 2.0**-50), None
    yield "the same, 2^50 as large", scaled(ball, 2.0**50), scaled(near, 2.0**50), None
    yield "balls far from the origin", sphere(12, (4096, 0, 0)), sphere(12, (4098.002, 0, 0)), None
    yield "a ball on a large floor", one((-1e5, -1e5, 0), (1e5, -1e5, 0), (0, 1e5, 0)), sphere(12, (0.3, 0.2, 1)), Fraction(0)


def write_ply(path, shape):
    vertices, triangles = shape
    with open(path, "wb") as out:
        out.write(
            f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
            "property float x\nproperty float y\nproperty float z\n"
            f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n".encode()
        )
        out.write(array("f", [c for v in vertices for c in v]).tobytes())
        out.write(b"".join(struct.pack("<B3i", 3, *t) for t in triangles))
