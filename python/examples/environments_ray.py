"""Environments over Ray actors: contacts of each step, compared with those of one detector.

    pip install nearmiss ray
    python environments_ray.py [environments, default 64] [actors, default 2]

Each environment has three boxes that fall and turn above a floor. Exits with 1 if a row differs.
"""

import sys

import numpy as np
import ray

import nearmiss

BOXES = 3
STEPS = 4
CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) - 0.5
CUBE = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1]]
CUBE += [[2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
FLOOR = [[-9, -9, -1], [9, -9, -1], [9, 9, -1], [-9, 9, -1]]
COLUMNS = ("kind", "feature_a", "feature_b", "toi", "toi_upper", "status")


class Environments:
    """A detector of some of the environments. Bodies keep their numbers of the whole."""

    def __init__(self, first, count, threads):
        self.first = first
        scene = nearmiss.Scene()
        scene.add(nearmiss.Body(FLOOR, [[0, 1, 2], [0, 2, 3]], kind="fixed", environment=None))
        self.boxes = [
            scene.add(nearmiss.Body(CORNERS, CUBE, kind="rigid", environment=k // BOXES))
            for k in range(count * BOXES)
        ]
        # For a GPU an actor leave the device out, and give the actor num_gpus=1.
        device = nearmiss.Device("cpu", threads=threads)
        self.detector = nearmiss.Detector(scene, device=device)

    def step(self, start, end):
        """Rows of the contacts between two poses of each box: (bodies and columns) x rows."""
        (positions, quaternions), (end_positions, end_quaternions) = start, end
        self.detector.update_poses(
            self.boxes,
            positions,
            quaternions,
            end_positions=end_positions,
            end_quaternions=end_quaternions,
        )
        found = self.detector.continuous()
        bodies = found.bodies.astype(float)
        bodies[bodies > 0] += self.first * BOXES
        return np.column_stack([bodies, *(getattr(found, name) for name in COLUMNS)])


def poses(environments, step):
    """Positions and quaternions of all boxes at a time."""
    random = np.random.default_rng(7)
    count = environments * BOXES
    positions = random.uniform(-1, 1, (count, 3)) + [0, 0, 2]
    positions[:, 2] -= 0.3 * step**2 / 2
    axes = random.normal(size=(count, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    half = 0.2 * step * random.uniform(-1, 1, (count, 1))
    return positions, np.concatenate([axes * np.sin(half), np.cos(half)], axis=1)


def ordered(rows):
    """Rows in one order: that of their bodies, then of the other columns."""
    return rows[np.lexsort(rows.T[::-1])]


def differences(answers, expected):
    """A line for each step whose rows differ."""
    pairs = enumerate(zip(answers, expected, strict=True))
    return [
        f"step {step}: {len(one)} rows are not the {len(other)} of one detector"
        for step, (one, other) in pairs
        if not np.array_equal(ordered(one), ordered(other))
    ]


def main(environments=64, actors=2):
    ray.init(num_cpus=actors, include_dashboard=False, log_to_driver=False)
    shares = np.array_split(np.arange(environments), actors)
    remote = ray.remote(num_cpus=1)(Environments)
    there = [remote.remote(int(share[0]), len(share), 1) for share in shares]
    here = Environments(0, environments, None)
    answers, expected = [], []
    for step in range(STEPS):
        ends = [poses(environments, step), poses(environments, step + 1)]
        boxes = [slice(share[0] * BOXES, (share[-1] + 1) * BOXES) for share in shares]
        calls = [
            actor.step.remote(*([array[own] for array in end] for end in ends))
            for actor, own in zip(there, boxes)
        ]
        answers.append(np.concatenate(ray.get(calls)))
        expected.append(here.step(*ends))
    ray.shutdown()
    wrong = differences(answers, expected)
    rows = sum(map(len, answers))
    print(f"{STEPS} steps, {environments} environments on {actors} actors, {rows} contacts")
    print("\n".join(wrong) or "the rows are those of one detector")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
