"""The barrier energy of IPC in torch: its value, and its gradient by autograd and by hand.

    pip install nearmiss torch && python barrier_torch.py

The nearest points of a pair are at fixed weights to first order: the distance is least there. So
the gradient of a distance is `signed_weights` times the normal, and autograd needs no more.
"""

import sys

import torch
from sheets import fold

import nearmiss

DHAT = 0.0065


def barrier(detector, x):
    """Energy of all pairs nearer than DHAT, differentiable in x; and its gradient by hand."""
    detector.update({0: x.detach().numpy()})
    at = detector.geometry(detector.near(DHAT))
    vertices = torch.from_numpy(at.vertices.astype("int64"))
    weights, normals = (torch.from_numpy(array.copy()) for array in (at.signed_weights, at.normals))
    distance = (weights[..., None] * x[vertices]).sum(dim=1).norm(dim=1)
    energy = -((distance - DHAT) ** 2 * torch.log(distance / DHAT)).sum()
    # By hand: the derivative by the distance, times that of the distance.
    d = distance.detach()
    slope = -2 * (d - DHAT) * torch.log(d / DHAT) - (d - DHAT) ** 2 / d
    force = weights[..., None] * (slope[:, None] * normals)[:, None]
    gradient = torch.zeros_like(x).index_add_(0, vertices.ravel(), force.flatten(0, 1))
    return energy, gradient.detach()


def errors(cells=20):
    """The energy, and errors of autograd: against the gradient by hand, and against differences."""
    vertices, _, faces = fold(cells, 0.6 * cells)
    detector = nearmiss.Detector(nearmiss.Body(vertices, faces))
    x = torch.from_numpy(vertices).requires_grad_()
    energy, by_hand = barrier(detector, x)
    (by_autograd,) = torch.autograd.grad(energy, x)
    way = torch.from_numpy(vertices).sin()  # any direction
    step = 1e-6 * way
    there, back = (barrier(detector, x.detach() + side * step)[0] for side in (1, -1))
    slope = (by_autograd * way).sum()
    difference = (there - back) / 2e-6
    return (
        float(energy.detach()),
        float((by_autograd - by_hand).norm() / by_hand.norm()),
        float(abs(difference / slope - 1)),
    )


if __name__ == "__main__":
    energy, by_hand, by_differences = errors()
    print(f"energy {energy:.6g}; errors {by_hand:.1e} by hand, {by_differences:.1e} by differences")
    sys.exit(not (energy > 0 and by_hand < 1e-12 and by_differences < 1e-4))
