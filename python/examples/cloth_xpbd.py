"""An XPBD cloth that falls on a ball and passes through nothing, on numpy.

    pip install nearmiss && python cloth_xpbd.py [cells a side, default 90] [frames, default 400]

Near pairs push surfaces apart. A continuous query then limits each vertex by the first of its own
contacts, until the step is free. Exits with 1 if a check at the end fails.
"""

import sys
import time

import drape
import numpy as np

import nearmiss


class Cloth:
    """A cloth of springs above a fixed ball.

    `repel` and `guard` switch the two uses of the detector off, to show that both are needed.
    """

    def __init__(self, cells, repel=True, guard=True):
        self.x, self.faces = drape.cloth(cells)
        self.v = np.zeros_like(self.x)
        self.repel, self.guard = repel, guard
        ball, ball_faces = drape.ball()
        scene = nearmiss.Scene()
        self.body = scene.add(nearmiss.Body(self.x, self.faces, name="cloth"))
        scene.add(nearmiss.Body(ball, ball_faces, kind="fixed", name="ball"))
        self.detector = nearmiss.Detector(scene)
        self.ball = ball
        # The cloth's vertices, then those of the ball, which have no inverse mass.
        self.inverse_mass = np.repeat([1.0, 0.0], [len(self.x), len(ball)])
        self.thickness, self.reach = drape.THICKNESS / cells, drape.REACH / cells
        self.iterations = drape.iterations(cells)
        self.springs = []
        for pairs, compliance in drape.springs(cells):
            rest = np.linalg.norm(self.x[pairs[:, 0]] - self.x[pairs[:, 1]], axis=1)
            self.springs.append((*pairs.T, rest, compliance / drape.STEP**2))

    def frame(self):
        """Move by one step; return the part of it that each vertex goes, and crossing pairs."""
        contacts = self.contacts() if self.repel else None
        goal = self.solve(contacts)
        there, part, crossing = self.limited(goal)
        self.v = (there - self.x) / drape.STEP * (1 - drape.DAMPING * drape.STEP)
        self.x = there
        return part, crossing

    def contacts(self):
        """Pairs within reach: vertices, signed weights, normals, and the distances to keep."""
        self.detector.update({self.body: self.x})
        at = self.detector.geometry(self.detector.near(self.reach))
        vertices = at.vertices + len(self.x) * (at.owner != self.body)
        # A pair that is too near is moved apart over several steps: a push is a velocity.
        wanted = np.minimum(self.thickness, at.distances + drape.OPENING * self.thickness)
        return vertices, np.ascontiguousarray(at.signed_weights), at.normals.copy(), wanted

    def solve(self, contacts):
        """The wanted end of the step, by XPBD."""
        start = np.concatenate([self.x, self.ball])
        x, own = start.copy(), len(self.x)
        x[:own] += drape.STEP * self.v
        x[:own, 2] -= drape.GRAVITY * drape.STEP**2
        multipliers = [np.zeros(len(rest)) for _, _, rest, _ in self.springs]
        for _ in range(self.iterations):
            for (a, b, rest, compliance), multiplier in zip(self.springs, multipliers):
                along = x[a] - x[b]
                length = np.linalg.norm(along, axis=1)
                change = (rest - length - compliance * multiplier) / (2 + compliance)
                multiplier += change
                move = (change / length)[:, None] * along
                x[a] += move
                x[b] -= move
            if contacts is not None:
                self.push_apart(start, x, *contacts)
        return x[:own]

    def push_apart(self, start, x, vertices, weights, normals, wanted):
        """Move pairs that are nearer than wanted apart, and hold them by friction."""
        # The sum of signed weights times positions leads from one point to the other.
        apart = np.einsum("rv,rvc->rc", weights, x[vertices])
        depth = wanted - np.einsum("rc,rc->r", apart, normals)
        near = depth > 0
        vertices, weights, normals, depth = (
            vertices[near],
            weights[near],
            normals[near],
            depth[near],
        )
        slide = apart[near] - np.einsum("rv,rvc->rc", weights, start[vertices])
        slide -= np.einsum("rc,rc->r", slide, normals)[:, None] * normals
        length = np.linalg.norm(slide, axis=1)
        held = np.minimum(drape.FRICTION * depth, length) / np.maximum(length, 1e-30)
        push = depth[:, None] * normals - held[:, None] * slide
        share = weights * self.inverse_mass[vertices]
        push /= np.einsum("rv,rv->r", share, weights)[:, None]
        # Pushes of a vertex that is in many pairs are averaged.
        index, count = vertices.ravel(), len(x)
        total = np.maximum(np.bincount(index, np.abs(share).ravel(), count), 1)
        for axis in range(3):
            moves = share * push[:, axis, None]
            x[:, axis] += np.bincount(index, moves.ravel(), count) / total

    def limited(self, goal):
        """The step to the goal, each vertex limited by its contacts until the step is free.

        Returns the positions, the part of its step that each vertex goes, and the pairs that cross
        at the start.
        """
        part = np.ones(len(goal))
        if not self.guard:
            return goal, part, 0
        for attempt in range(sys.maxsize):
            there = self.x + part[:, None] * (goal - self.x)
            self.detector.update({self.body: (self.x, there)})
            found = self.detector.continuous()
            at = self.detector.geometry(found)
            vertices = np.where(at.owner == self.body, at.vertices, 0)
            moves = (at.owner == self.body) & (part[vertices] > 0)
            if not moves.any():  # what rests cannot pass through
                return there, part, found.starts_crossing
            way = drape.PART_OF_THE_WAY if attempt < drape.ATTEMPTS else 0.0
            limit = np.ones(len(goal))
            np.minimum.at(limit, vertices[moves], (way * found.toi).repeat(4).reshape(-1, 4)[moves])
            part *= limit


def run(cells, frames, repel=True, guard=True):
    """Run the simulation. Returns the cloth, its figures and the names of faults."""
    cloth, log = Cloth(cells, repel, guard), drape.Log()
    for _ in range(frames):
        part, crossing = cloth.frame()
        speed = np.sqrt((cloth.v**2).sum(axis=1).mean())
        log.frame(cloth.x[:, 2].mean(), speed, (part < 1).mean(), crossing)
    cloth.detector.update({cloth.body: cloth.x})
    return cloth, log, log.faults(cloth.x, len(cloth.detector.discrete()))


if __name__ == "__main__":
    cells, frames = (int(text) for text in (sys.argv[1:] + ["90", "400"][len(sys.argv) - 1 :]))
    begin = time.perf_counter()
    cloth, log, faults = run(cells, frames)
    taken = 1e3 * (time.perf_counter() - begin) / frames
    print(f"{len(cloth.faces)} triangles, {taken:.1f} ms a frame; {log.summary()}")
    sys.exit("; ".join(faults) or 0)
