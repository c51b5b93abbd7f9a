"""The cloth of cloth_xpbd.py on torch. On a GPU its positions never leave the device.

    pip install nearmiss torch
    python cloth_torch.py [cells a side, default 224] [frames, default 400]

Two detectors read the tensors in place: one finds near pairs, one the contacts of a step. Their
answers are tensors too. Only counts come to the host. Exits with 1 if the checks at the end fail.
"""

import contextlib
import sys
import time

import drape
import numpy as np
import torch

import nearmiss


class Watch:
    """A detector with one prepared query, whose rows are tensors."""

    def __init__(self, scene, device, inputs, query):
        self.detector = nearmiss.Detector(scene, device=device)
        self.inputs, self.query = inputs, query
        self.frames = 0

    def rows(self):
        """The geometry of the answer's rows, their times, and the number of crossing pairs."""
        self.frames += 1
        if self.frames % 20 == 0:  # submissions do not rebuild by themselves
            self.detector.rebuild()
        while True:
            if not self.detector.is_prepared:
                self.detector.prepare(self.inputs, [self.query], geometry=True)
            self.detector.submit()
            answer = self.detector.on_device(self.query)
            first, second, short, invalid, crossing = torch.from_dlpack(answer.status).tolist()
            if invalid:
                raise ValueError("a position is not finite; use a shorter step")
            if not short:
                break
            self.detector.collect(self.query)  # a buffer was too short: it grows

        columns = {name: torch.from_dlpack(column) for name, column in answer.geometry.items()}
        rows = {name: column[: first + second] for name, column in columns.items()}
        times = [torch.from_dlpack(table["toi"]) for table in answer.lists if "toi" in table]
        if len(times) == 2:  # on a CPU: vertex/face rows, then edge/edge rows
            times = [torch.cat([times[0][:first], times[1][:second]])]
        return rows, times[0][: first + second] if times else None, crossing


def recorded(work, stream):
    """The work on a stream as one call of a graph; `work` keeps its arrays at their places."""
    work()  # what is made at a first call cannot be recorded
    graph = torch.cuda.CUDAGraph()
    with torch.cuda.graph(graph, stream=stream):
        work()
    return graph.replay


class Cloth:
    """A cloth of springs above a fixed ball. Vertices of the ball follow those of the cloth."""

    def __init__(self, cells, device, stream=None):
        sheet, faces = drape.cloth(cells)
        ball, ball_faces = drape.ball()
        self.own, own = len(sheet), slice(0, len(sheet))
        on_device = lambda array: torch.as_tensor(array, device=device)
        self.x = on_device(np.concatenate([sheet, ball]))
        self.goal, self.v = self.x.clone(), torch.zeros_like(self.x)
        self.inverse_mass = (torch.arange(len(self.x), device=device) < self.own).double()
        self.thickness, reach = drape.THICKNESS / cells, drape.REACH / cells
        self.iterations = drape.iterations(cells)
        self.springs = []
        for pairs, compliance in drape.springs(cells):
            a, b = on_device(pairs).T.contiguous()
            rest = (self.x[a] - self.x[b]).norm(dim=1)
            self.springs.append((a, b, rest, compliance / drape.STEP**2, torch.zeros_like(rest)))
        # Hundreds of small operations on a GPU: recorded once, and started by one call.
        self.relax = recorded(self.relax, stream) if stream else self.relax

        scene = nearmiss.Scene()
        body = scene.add(nearmiss.Body(sheet, faces, name="cloth"))
        scene.add(nearmiss.Body(ball, ball_faces, kind="fixed", name="ball"))
        # The detectors read these: on a CPU through numpy, which shares the memory.
        shared = [array[own] if stream else array[own].numpy() for array in (self.x, self.goal)]
        machine = nearmiss.Device(stream=stream) if stream else nearmiss.Device("cpu")
        self.near = Watch(scene, machine, {body: shared[0]}, nearmiss.Near(reach))
        self.guard = Watch(scene, machine, {body: tuple(shared)}, nearmiss.Continuous())

    def contacts(self):
        """Pairs within reach: vertices, signed weights, normals, and the distances to keep."""
        rows, _, _ = self.near.rows()
        distance = rows["distances"]
        wanted = (distance + drape.OPENING * self.thickness).clamp_max(self.thickness)
        # Features that touch have no side from which they came: they are not pushed.
        normals = rows["normals"] * (distance > 0)[:, None]
        return rows["vertices"].long(), rows["signed_weights"], normals, wanted

    def solve(self, contacts):
        """Set the goal to the wanted end of the step, by XPBD."""
        x = self.goal
        x.copy_(self.x)
        x[: self.own] += drape.STEP * self.v[: self.own]
        x[: self.own, 2] -= drape.GRAVITY * drape.STEP**2
        for *_, multiplier in self.springs:
            multiplier.zero_()
        for _ in range(self.iterations):
            self.relax()
            self.push_apart(x, *contacts)

    def relax(self):
        """Correct the length of each spring of the goal once."""
        x = self.goal
        for a, b, rest, compliance, multiplier in self.springs:
            along = x[a] - x[b]
            length = along.norm(dim=1)
            change = (rest - length - compliance * multiplier) / (2 + compliance)
            multiplier += change
            move = (change / length)[:, None] * along
            x[a] += move
            x[b] -= move

    def push_apart(self, x, vertices, weights, normals, wanted):
        """Move pairs that are nearer than wanted apart, and hold them by friction."""
        apart = (weights[..., None] * x[vertices]).sum(dim=1)
        depth = (wanted - (apart * normals).sum(dim=1)).clamp_min(0)
        slide = apart - (weights[..., None] * self.x[vertices]).sum(dim=1)
        slide -= (slide * normals).sum(dim=1, keepdim=True) * normals
        length = slide.norm(dim=1)
        held = torch.minimum(drape.FRICTION * depth, length) / length.clamp_min(1e-30)
        push = depth[:, None] * normals - held[:, None] * slide
        share = weights * self.inverse_mass[vertices]
        push /= (share * weights).sum(dim=1, keepdim=True)
        # Pushes of a vertex that is in many pairs are averaged.
        count = share.abs() * (depth > 0)[:, None]
        total = torch.zeros_like(self.inverse_mass).index_add_(0, vertices.ravel(), count.ravel())
        moves = (share[..., None] * push[:, None]).flatten(0, 1)
        move = torch.zeros_like(x).index_add_(0, vertices.ravel(), moves)
        x += move / total.clamp_min(1)[:, None]

    def limit(self):
        """Limit each vertex by its contacts, until the step to the goal is free.

        Returns the part of its step that each vertex goes, and the pairs that cross at the start.
        """
        wish, part = self.goal - self.x, self.inverse_mass.clone()
        for attempt in range(sys.maxsize):
            torch.add(self.x, part[:, None] * wish, out=self.goal)
            rows, times, crossing = self.guard.rows()
            vertices = rows["vertices"].long()
            moves = part[vertices] > 0
            if not moves.any():  # what rests cannot pass through
                return part[: self.own], crossing
            way = drape.PART_OF_THE_WAY if attempt < drape.ATTEMPTS else 0.0
            factor = (way * times)[:, None].expand(-1, 4)
            part *= torch.ones_like(part).scatter_reduce_(0, vertices[moves], factor[moves], "amin")

    def frame(self):
        """Move by one step; return the part of it that each vertex goes, and crossing pairs."""
        self.solve(self.contacts())
        part, crossing = self.limit()
        self.v = (self.goal - self.x) / drape.STEP * (1 - drape.DAMPING * drape.STEP)
        self.x.copy_(self.goal)
        return part, crossing


def run(cells, frames, device="cpu"):
    """Run the simulation. Returns the cloth, its figures and the names of faults."""
    is_gpu = torch.device(device).type == "cuda"
    stream = torch.cuda.Stream() if is_gpu else None
    with torch.cuda.stream(stream) if is_gpu else contextlib.nullcontext():
        cloth, log = Cloth(cells, device, stream), drape.Log()
        for _ in range(frames):
            part, crossing = cloth.frame()
            v, height = cloth.v[: cloth.own], cloth.x[: cloth.own, 2].mean()
            speed = (v**2).sum(dim=1).mean().sqrt()
            log.frame(float(height), float(speed), float((part < 1).double().mean()), crossing)
        x = cloth.x[: cloth.own]
        body = cloth.near.detector
        body.update({0: x if is_gpu else x.numpy()})
        return cloth, log, log.faults(x.cpu().numpy(), len(body.discrete()))


if __name__ == "__main__":
    cells, frames = (int(text) for text in (sys.argv[1:] + ["224", "400"][len(sys.argv) - 1 :]))
    device = "cuda" if torch.cuda.is_available() else "cpu"
    begin = time.perf_counter()
    cloth, log, faults = run(cells, frames, device)
    taken = 1e3 * (time.perf_counter() - begin) / frames
    print(f"{2 * cells**2} triangles on {device}, {taken:.1f} ms a frame; {log.summary()}")
    sys.exit("; ".join(faults) or 0)
