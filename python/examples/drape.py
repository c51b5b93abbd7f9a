"""A cloth above a ball: meshes, springs and checks, for the examples that drape it."""

import numpy as np
from sheets import grid

RADIUS = 0.25
STEP = 0.01  # seconds
GRAVITY = 9.81
FRICTION = 0.3
DAMPING = 2.0  # a second
BENDING = 2e-3  # compliance of springs over two cells, seconds squared
# In cells, below the distance of opposite parts of a cell: a flat cloth has no near pairs.
THICKNESS, REACH = 0.15, 0.25
OPENING = 0.2  # of the thickness: how far a pair that is too near is moved apart in a step
PART_OF_THE_WAY = 0.9  # to a contact, so that the next step does not start with it
ATTEMPTS = 8  # to limit a vertex, before it rests in a step


def iterations(cells):
    """Iterations of a step: with more cells a pull takes more of them to cross the cloth."""
    return 20 * max(1, round(cells / 75))


def ball(levels=4):
    """A ball round the origin, an octahedron whose triangles are cut in four: vertices, faces."""
    vertices = np.concatenate([np.eye(3), -np.eye(3)])
    faces = np.array(
        [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    )
    for _ in range(levels):
        sides = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        edges, number = np.unique(sides, axis=0, return_inverse=True)
        (a, b, c), (ab, bc, ca) = faces.T, len(vertices) + number.reshape(-1, 3).T
        vertices = np.concatenate([vertices, vertices[edges].sum(axis=1)])
        vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
        faces = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    return RADIUS * vertices, faces


def cloth(cells):
    """A square of side 1 above the ball, a little off its centre and wavy: vertices, faces."""
    x, y, faces = grid(cells)
    height = RADIUS + 0.12 + 0.01 * np.sin(7 * x + 3 * y)
    return np.stack([x - 0.48, y - 0.51, height], axis=1), faces


def springs(cells):
    """Springs: lists of (vertex pairs, compliance). Within a list no two share a vertex."""
    number = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    for i, j in [(1, 0), (0, 1), (1, 1), (1, -1), (2, 0), (0, 2)]:
        first = number[: cells + 1 - i, max(-j, 0) : cells + 1 - max(j, 0)]
        pairs = np.stack([first, first + i * (cells + 1) + j], axis=-1)
        along = np.arange(len(first))[:, None] // i if i else np.arange(first.shape[1])[None] // j
        for parity in (0, 1):
            chosen = np.broadcast_to(along % 2 == parity, first.shape)
            yield pairs[chosen], BENDING if max(i, j) == 2 else 0.0


class Log:
    """Figures of each frame, and the checks at the end."""

    def __init__(self):
        self.crossing, self.limited, self.kinetic, self.energy = [], [], [], []

    def frame(self, height, speed, limited, crossing):
        """Add a frame: mean height, speed (RMS), share of limited vertices, crossing pairs."""
        self.kinetic.append(speed**2 / 2)
        self.energy.append(GRAVITY * height + speed**2 / 2)
        self.limited.append(limited)
        self.crossing.append(crossing)

    def faults(self, x, crossing):
        """Faults of the whole run, by name; x: positions at the end, crossing: pairs there."""
        last = slice(-len(self.energy) // 10, None)
        rise = np.diff(self.energy).max()
        checks = {
            "triangles cross": max([crossing, *self.crossing]) == 0,
            "energy rises": self.energy[-1] < self.energy[0] - GRAVITY * 0.1
            and rise < 0.01 * self.energy[0],
            "the cloth has not come to rest": max(self.kinetic[last]) < 0.01 * max(self.kinetic),
            "the cloth is frozen": max(self.limited[last]) < 0.01,
            "the cloth is not on the ball": RADIUS < x[:, 2].max() < 1.2 * RADIUS,
            "the cloth does not hang": x[:, 2].min() < -0.5 * RADIUS,
        }
        return [fault for fault, is_good in checks.items() if not is_good]

    def summary(self):
        """One line: frames, energy, limited vertices."""
        return (
            f"{len(self.energy)} frames; "
            f"energy {self.energy[0]:.3f} to {self.energy[-1]:.3f} J/kg, "
            f"kinetic at most {max(self.kinetic):.3f}, at the end {self.kinetic[-1]:.1e}; "
            f"limited vertices at most {max(self.limited):.1%}, at the end {self.limited[-1]:.1%}"
        )
