"""Many rigid bodies: which touch, and how far apart the near ones are, by nearmiss, Coal and FCL. See README.md.

Each program has all frames in a row, then all programs take each frame in turns, with cold caches.

    python bodies.py [--bodies N] [--frames N] [--threads N] [--out FILE.csv]
"""

import argparse
import csv
import statistics
import sys
import time

import coal
import fcl
import nearmiss
import numpy as np
from balls import bumpy

MESHES = 10
BOX, STEP, WITHIN = 16.0, 0.02, (0.02, 0.1)


def poses(count, frames):
    """Positions and quaternions (x, y, z, w) of all bodies, frame by frame."""
    rng = np.random.default_rng(1)
    place = rng.uniform(0, BOX, (count, 3))
    speed = rng.normal(0, STEP, (count, 3))
    turn = rng.normal(size=(count, 4))
    spin = rng.normal(0, STEP, (count, 4))
    for frame in range(frames):
        quaternion = turn + frame * spin
        yield place + frame * speed, quaternion / np.linalg.norm(quaternion, axis=1)[:, None]


def matrices(quaternions):
    x, y, z, w = quaternions.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.array(rows).transpose(2, 0, 1)


class Coal:
    name = f"Coal {coal.__version__}"

    def __init__(self, meshes, which):
        models = []
        for points, faces in meshes:
            model = coal.BVHModelOBBRSS()
            model.beginModel(len(faces), len(points))
            model.addVertices(points)
            model.addTriangles(faces.astype(np.int64))
            model.endModel()
            model.computeLocalAABB()
            models.append(model)
        self.objects = [coal.CollisionObject(models[k]) for k in which]

    def place(self, places, turns):
        for body, rotation, place in zip(self.objects, turns, places):
            body.setTransform(coal.Transform3s(rotation, place))

    def find_near(self):
        """The pairs of boxes of all questions, which Coal's questions are about."""
        for body in self.objects:
            body.computeAABB()
        boxes = [body.getAABB() for body in self.objects]
        self.low, self.high = np.array([box.min_ for box in boxes]), np.array([box.max_ for box in boxes])
        self.near = {margin: self.pairs(margin) for margin in (0, *WITHIN)}

    def pairs(self, margin):
        """Pairs of bodies whose boxes are within the margin, by numpy."""
        a, b = np.triu_indices(len(self.objects), 1)
        near = ((self.low[a] <= self.high[b] + margin) & (self.low[b] <= self.high[a] + margin)).all(1)
        return list(zip(a[near].tolist(), b[near].tolist()))

    def request(self, contacts, margin=0.0):
        request = coal.CollisionRequest()
        request.num_max_contacts, request.enable_contact = contacts, contacts > 1
        request.security_margin = margin
        return request

    def collides(self, a, b, request):
        result = coal.CollisionResult()
        coal.collide(self.objects[a], self.objects[b], request, result)
        return result.numContacts()

    def touching(self):
        request = self.request(1)
        return sum(self.collides(a, b, request) > 0 for a, b in self.near[0])

    def crossing(self):
        request = self.request(10**7)
        return sum(self.collides(a, b, request) for a, b in self.near[0])

    def distances(self, within):
        """As a careful user does: who is within, then the distance of those that do not touch."""
        near, touches, total = self.request(1, within), self.request(1), 0.0
        count = 0
        for a, b in self.near[within]:
            if self.collides(a, b, near) > 0:
                count += 1
                if self.collides(a, b, touches) == 0:
                    result = coal.DistanceResult()
                    total += coal.distance(self.objects[a], self.objects[b], coal.DistanceRequest(), result)
        return count, total


class Fcl:
    name = "FCL 0.7.0"

    def __init__(self, meshes, which):
        models = []
        for points, faces in meshes:
            model = fcl.BVHModel()
            model.beginModel(len(points), len(faces))
            model.addSubModel(points, faces)
            model.endModel()
            models.append(model)
        self.objects = [fcl.CollisionObject(models[k], fcl.Transform()) for k in which]

    def place(self, places, turns):
        for body, rotation, place in zip(self.objects, turns, places):
            body.setTransform(fcl.Transform(rotation, place))

    def count(self, pairs, contacts):
        request = fcl.CollisionRequest(num_max_contacts=contacts, enable_contact=False)
        return [fcl.collide(self.objects[a], self.objects[b], request, fcl.CollisionResult()) for a, b in pairs]


class Nearmiss:
    def __init__(self, meshes, which, threads):
        bodies = [nearmiss.Body(*meshes[k], kind="rigid", name=str(at)) for at, k in enumerate(which)]
        self.detector = nearmiss.Detector(nearmiss.Scene(*bodies), device=nearmiss.Device("cpu", threads=threads))
        self.bodies = np.arange(len(which), dtype=np.uint32)
        self.name = f"nearmiss, {threads} thread" + "s" * (threads > 1)

    def place(self, places, turns):
        self.detector.update_poses(self.bodies, places, turns)

    def touching(self):
        return len(self.detector.body_pairs())

    def crossing(self):
        return len(self.detector.discrete())

    def distances(self, within):
        found = self.detector.body_distances(within)
        return len(found), float(np.sum(found.distances))


class Clock:
    """Times and answers of all programs."""

    def __init__(self):
        self.times, self.answers = {}, {}

    def time(self, order, question, program, act):
        start = time.perf_counter()
        value = act()
        self.times.setdefault((question, order, program.name), []).append((time.perf_counter() - start) * 1e6)
        self.answers.setdefault((question, order, program.name), []).append(value)

    def frame(self, order, program, places, quaternions, turns, pairs):
        """All questions about one frame. FCL gets Coal's pairs of boxes."""
        own = quaternions if isinstance(program, Nearmiss) else turns
        self.time(order, "poses", program, lambda: program.place(places, own))
        if isinstance(program, Coal):
            self.time(order, "pairs of boxes", program, program.find_near)
        if isinstance(program, Fcl):
            self.time(order, "touching", program, lambda: sum(n > 0 for n in program.count(pairs, 1)))
            self.time(order, "crossing triangles", program, lambda: sum(program.count(pairs, 10**6)))
            return
        self.time(order, "touching", program, program.touching)
        self.time(order, "crossing triangles", program, program.crossing)
        for within in WITHIN:
            self.time(order, f"distances within {within}", program, lambda: program.distances(within))

    def rows(self):
        for (question, order, program), values in sorted(self.times.items(), key=lambda item: item[0][:2]):
            found = self.answers[question, order, program]
            mean = lambda of: statistics.mean(of(value) for value in found)
            count = distance = ""
            if isinstance(found[0], tuple):
                count, distance = f"{mean(lambda v: v[0]):.2f}", f"{mean(lambda v: v[1]):.9g}"
            elif found[0] is not None:
                count = f"{mean(lambda v: v):.2f}"
            # The first frame builds.
            yield [question, order, program, f"{statistics.median(values[1:]):.0f}", count, distance]


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--bodies", type=int, default=200)
    arguments.add_argument("--frames", type=int, default=25)
    arguments.add_argument("--threads", type=int, default=2)
    arguments.add_argument("--out")
    args = arguments.parse_args()
    meshes = [bumpy(seed) for seed in range(MESHES)]
    which = np.random.default_rng(0).integers(0, MESHES, args.bodies)
    threads = sorted({1, args.threads})
    coal = Coal(meshes, which)
    all_of = [Nearmiss(meshes, which, n) for n in threads] + [coal, Fcl(meshes, which)]
    frames = [(places, turns, matrices(turns)) for places, turns in poses(args.bodies, args.frames)]
    pairs = []
    for places, _, turns in frames:
        coal.place(places, turns)
        coal.find_near()
        pairs.append(coal.near[0])
    clock = Clock()
    for program in all_of:
        for frame, near in zip(frames, pairs):
            clock.frame("in a row", program, *frame, near)
    for frame, near in zip(frames, pairs):
        for program in all_of:
            clock.frame("in turns", program, *frame, near)
    with open(args.out, "w", newline="") if args.out else sys.stdout as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(["question", "order", "program", "microseconds", "count", "distances"])
        rows.writerows(clock.rows())


if __name__ == "__main__":
    main()
