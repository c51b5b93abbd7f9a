"""The scenes again, in Python: the origin of the golden hashes in tests.rs.

    pip install xxhash; python3 host/scene/golden.py

Written from the description of each generator, in the same order of operations (Python's floats are IEEE doubles).
"""
import math
import struct

import xxhash

MASK = (1 << 64) - 1


class Rng:
    def __init__(self, seed):
        self.state = seed

    def unit(self):
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        return ((z ^ (z >> 31)) >> 11) / (1 << 53)

    def point(self, size):
        return [(2.0 * self.unit() - 1.0) * size for _ in range(3)]


def add(p, q):
    return [a + b for a, b in zip(p, q)]


def fingerprint(faces, *frames):
    h = xxhash.xxh3_64()
    for face in faces:
        h.update(struct.pack("<3I", *face))
    for frame in frames:
        for p in frame:
            h.update(struct.pack("<3f", *p))
    return h.intdigest()


def root(x):
    return int(max(1.0, math.floor(math.sqrt(x) + 0.5)))


def cube_root_up(n):
    k = 1
    while k**3 < n:
        k += 1
    return k


def strips(rows):
    for a, b in zip(rows, rows[1:]):
        for i in range(len(a) - 1):
            yield (a[i], a[i + 1], b[i + 1])
            yield (a[i], b[i + 1], b[i])


def grid(cells):
    points, faces = [], []

    def row(y, z, start):
        points.extend([start + i, y, z] for i in range(cells + 1))
        return list(range(len(points) - cells - 1, len(points)))

    faces += strips([row(float(j), 0.0, 0.0) for j in range(cells + 1)])
    for j in range(cells):
        faces += strips([row(j + 0.5, z, 0.25) for z in (-0.5, 0.5)])
    return faces, points


def soup(n, seed, moving):
    rng, size = Rng(seed), 0.75 / cube_root_up(n)
    t0, t1 = [], []
    for _ in range(n):
        centre = [x + 0.5 for x in rng.point(0.5)]
        for _ in range(3):
            p = add(centre, rng.point(size))
            t0.append(p)
            if moving:
                t1.append(add(p, rng.point(0.5 * size)))
    faces = [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(n)]
    return (faces, t0, t1) if moving else (faces, t0)


def sphere(n):
    ids, points, faces = {}, [], []

    def vertex(c):
        if c not in ids:
            ids[c] = len(points)
            length = math.sqrt(float(c[0]) * c[0] + float(c[1]) * c[1] + float(c[2]) * c[2])
            points.append([x / length for x in c])
        return ids[c]

    for octant in range(8):
        sign = [1 - 2 * ((octant >> axis) & 1) for axis in range(3)]

        def face(*corners):
            f = [vertex(tuple(c * s for c, s in zip(corner, sign))) for corner in corners]
            if sign[0] * sign[1] * sign[2] < 0:
                f[1], f[2] = f[2], f[1]
            faces.append(f)

        for i in range(n):
            for j in range(n - i):
                k = n - 1 - i - j
                face((i + 1, j, k), (i, j + 1, k), (i, j, k + 1))
                if k > 0:
                    face((i, j + 1, k), (i + 1, j, k), (i + 1, j + 1, k - 1))
    return points, faces


def balls(count, subdivisions, seed):
    points, triangles = sphere(1 << subdivisions)
    rng, half = Rng(seed), 1.3 * cube_root_up(count)
    faces, t0, t1 = [], [], []
    for _ in range(count):
        centre, step = rng.point(half), rng.point(0.5)
        faces += [[i + len(t0) for i in f] for f in triangles]
        here = [add(p, centre) for p in points]
        t0 += here
        t1 += [add(p, step) for p in here]
    return faces, t0, t1


def wave(x):
    t = x - math.floor(x + 0.5)
    return 8.0 * t * (1.0 - 2.0 * abs(t))


def lies(u, v, lift, lean, stand, turn):
    r = math.sqrt(u * u + v * v)
    if r == 0.0:
        return [0.0, 0.0, 1.0 + lift]
    dx, dy = u / r, v / r
    t = min(0.5 * r, 1.0)
    square = 1.0 + t * t
    part = dy / (abs(dx) + abs(dy))
    around = (part if dy >= 0.0 else 4.0 + part) if dx >= 0.0 else 2.0 - part
    pleat = 6.0 * around + turn
    depth = min(max((r - 1.2) / 1.2, 0.0), 1.0)
    out = 2.0 * t / square + depth * stand * (1.0 + wave(pleat))
    side = -depth * lean * wave(2.0 * pleat)
    height = (1.0 - t * t) / square - 0.5 * max(r - 2.0, 0.0)
    return [dx * out - dy * side, dy * out + dx * side, height + lift]


def draped(triangles):
    f = root(triangles / 80.0)
    cells = max(1.0, triangles / 2.0 - 4.0 * f * f)
    columns = root(cells)
    rows = int(max(1.0, math.floor(cells / columns + 0.5)))
    rng, shake, t0, t1 = Rng(92), 0.05 * 2.0 * 2.8 / columns, [], []
    for row in range(rows + 1):
        for column in range(columns + 1):
            u, v = (2.8 * (2.0 * i / n - 1.0) for i, n in ((column, columns), (row, rows)))
            off = rng.point(shake)
            t0.append(add(lies(u, v, 0.0, 0.11, 0.08, 0.0), off))
            t1.append(add(lies(u, v, -0.02, 0.125, 0.075, 0.1), off))
    faces = list(strips([list(range(r * (columns + 1), (r + 1) * (columns + 1))) for r in range(rows + 1)]))
    points, triangles = sphere(f)
    faces += [[i + len(t0) for i in t] for t in triangles]
    ball = [[0.97 * x for x in p] for p in points]
    t0 += [add(p, [0.0, 0.0, 0.0]) for p in ball]
    t1 += [add(p, [0.0, 0.0, 0.025]) for p in ball]
    return faces, t0, t1


def corners(n, at):
    points = [p for i in range(n) for p in at(i)]
    return [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(n)], points


UNIT = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
for name, body in {
    "balls": balls(31, 1, 7),  # for 1000 triangles
    "draped": draped(1000),
    "grid": grid(16),
    "identical": corners(1000, lambda i: UNIT),
    "line": corners(1000, lambda i: [(i, 1, 0), (i, -1, 1), (i, 0, -1)]),
    "single": corners(1, lambda i: UNIT),
    "soup": soup(1000, 7, False),
    "soup-moving": soup(1000, 7, True),
}.items():
    print(f'("{name}", {len(body[0])}, 0x{fingerprint(*body):016x}),')
