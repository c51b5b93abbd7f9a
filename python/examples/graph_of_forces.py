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
    """The answer as tensors that share the detector's memory."""
    answer = detector.on_device(near)
    assert len(answer.lists) == 1                          # vf rows, then ee rows
    rows = {name: torch.from_dlpack(column) for name, column in answer.lists[0].items()}
    return rows, torch.from_dlpack(answer.status), torch.from_dlpack(answer.edges).long()


def corners(rows, status, edges):
    """Vertices and weights of both features; shapes are fixed, unused rows weigh nothing."""
    row = torch.arange(len(rows["feature_a"]), device=edges.device)
    is_face, is_used = (row < status[0])[:, None], (row < status[0] + status[1])[:, None]
    first, second = (rows[name].long().where(is_used[:, 0], 0) for name in ("feature_a", "feature_b"))
    u, v = rows["at"].where(is_used, 0).unbind(1)
    one, zero = torch.ones_like(u), torch.zeros_like(u)
    edge_a, edge_b = edges[first % len(edges)], edges[second % len(edges)]
    a = torch.where(is_face, first[:, None].expand(-1, 2), edge_a)
    b = torch.where(is_face, triangles[second % len(triangles)], torch.cat([edge_b, edge_b[:, 1:]], 1))
    weights = torch.where(is_face, torch.stack([one, zero, u + v - 1, -u, -v], 1),
                          torch.stack([1 - u, u, v - 1, -v, zero], 1))
    return torch.cat([a, b], 1), weights * is_used


def add_forces(rows, status, edges):
    """A spring of length DHAT along each pair's shortest connection."""
    vertices, weights = corners(rows, status, edges)
    gap = (weights[..., None] * position[vertices]).sum(1)
    length = gap.norm(dim=1, keepdim=True).clamp_min(1e-12)
    push = gap / length * (DHAT - length).clamp_min(0)
    force.zero_()
    force.index_add_(0, vertices.ravel(), (weights[..., None] * push[:, None]).flatten(0, 1))


torch.zeros(1, device="cuda")                              # torch makes the CUDA context
stream = torch.cuda.Stream()                               # not the default stream
with torch.cuda.stream(stream):
    position = torch.from_numpy(folded).cuda()
    triangles = torch.from_numpy(faces).cuda()
    force = torch.zeros_like(position)
    detector = nearmiss.Detector(nearmiss.Body(folded, faces), device=nearmiss.Device(stream=stream))
    near = nearmiss.Near(DHAT)
    graph, frame = None, 0
    while frame < 100:
        if graph is None or not detector.is_prepared:
            detector.prepare({0: position}, [near])        # the array stays; write into it
            answer = views(detector)
            detector.submit()
            add_forces(*answer)                            # once, so that torch loads its kernels
            stream.synchronize()
            graph = torch.cuda.CUDAGraph()
            with torch.cuda.graph(graph, stream=stream):
                detector.submit()
                add_forces(*answer)
        graph.replay()
        if int(answer[1][2]):                              # a buffer was too short: rows are missing
            detector.collect(near)                         # grows it; the detector is unprepared
            continue
        position.add_(force, alpha=0.1)
        frame += 1
    print(f"{float(force.norm(dim=1).max()):.4f}")
