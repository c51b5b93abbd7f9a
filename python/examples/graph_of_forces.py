"""Repulsive forces of a sheet on itself, on a GPU, in a graph of torch: see docs/for/gpu.md."""

import numpy as np
import torch
import nearmiss

DHAT = 0.005
side = np.linspace(0, 1, 61)
x, y = (axis.ravel() for axis in np.meshgrid(side, side, indexing="ij"))
at = (np.arange(60)[:, None] * 61 + np.arange(60)).ravel()
faces = np.concatenate([np.stack([at, at + 61, at + 62], 1), np.stack([at, at + 62, at + 1], 1)])
folded = np.stack([abs(x - 0.5), y, 0.1 * np.sin(25 * x)], 1)


def views(detector):
    """The geometry of the rows and the status, as tensors that share the detector's memory."""
    answer = detector.on_device(near)
    geometry = {name: torch.from_dlpack(column) for name, column in answer.geometry.items()}
    return geometry, torch.from_dlpack(answer.status)


def add_forces(geometry):
    """A spring of length DHAT along each pair's shortest connection. Unused rows weigh nothing."""
    push = geometry["normals"] * (DHAT - geometry["distances"]).clamp_min(0)[:, None]
    parts = geometry["signed_weights"][..., None] * push[:, None]
    force.zero_()
    force.index_add_(0, geometry["vertices"].ravel(), parts.flatten(0, 1))


torch.zeros(1, device="cuda")                              # torch makes the CUDA context
stream = torch.cuda.Stream()                               # not the default stream
with torch.cuda.stream(stream):
    position = torch.from_numpy(folded).cuda()
    force = torch.zeros_like(position)
    detector = nearmiss.Detector(nearmiss.Body(folded, faces), device=nearmiss.Device(stream=stream))
    near = nearmiss.Near(DHAT)
    graph, frame = None, 0
    while frame < 100:
        if graph is None or not detector.is_prepared:
            detector.prepare({0: position}, [near], geometry=True)     # the array stays; write into it
            geometry, status = views(detector)
            detector.submit()
            add_forces(geometry)                           # once, so that torch loads its kernels
            stream.synchronize()
            graph = torch.cuda.CUDAGraph()
            with torch.cuda.graph(graph, stream=stream):
                detector.submit()
                add_forces(geometry)
        graph.replay()
        if int(status[2]):                                 # a buffer was too short: rows are missing
            detector.collect(near)                         # grows it; the detector is unprepared
            continue
        position.add_(force, alpha=0.1)
        frame += 1
    print(f"{float(force.norm(dim=1).max()):.4f}")
