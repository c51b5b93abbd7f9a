"""Queries of one mesh, in one line. A detector that is kept is faster from the second query on."""

import numpy as np
from numpy.typing import NDArray

from ._native import Body, Contacts, Detector, Device, NearPairs
from .arrays import device_of, on_host
from .errors import InputError

__all__ = ["contacts", "near", "self_intersections", "time_of_impact"]


def self_intersections(
    vertices, faces, *, adjacent: bool = False, only_crossing: bool = False, device: Device | None = None
) -> NDArray[np.uint32]:
    """Return the pairs of triangles of a mesh that share a point, by exact signs.

    No pair is missed, none is invented. Touching counts. Two indices at one place are two vertices: triangles on both sides of
    such a seam share that point.

    - `vertices`: (n, 3) numbers. float32 and float64 are used as they are, never rounded. Arrays of a GPU work too.
    - `faces`: (m, 3) integers from 0, the vertices of each triangle.
    - `adjacent`: also test triangles with a common vertex, for points beyond that vertex or edge.
    - `only_crossing`: leave out triangles that touch without crossing.
    - `device`: default: the GPU of the array, else Device().

    Returns (k, 2) uint32: pairs of triangles, the smaller index first, ascending.
    Raises InputError for vertices that are not finite and for indices without a vertex.
    """
    return _detector(vertices, faces, device).discrete(adjacent=adjacent, only_crossing=only_crossing).triangles


def near(vertices, faces, distance: float, *, device: Device | None = None) -> NearPairs:
    """Return the vertex/face and edge/edge pairs of a mesh within a distance, and their nearest points.

    No pair is missed. Features with a common vertex are left out.

    - `vertices`, `faces`, `device`: as of self_intersections.
    - `distance`: a length above 0, in the unit of the vertices.

    Returns NearPairs, a row a pair: kind, feature_a, feature_b, distances, weights, closest.
    """
    return _detector(vertices, faces, device).near(distance)


def contacts(
    t0, t1, faces, *, min_separation: float = 0.0, tolerance: float | None = None, device: Device | None = None
) -> Contacts:
    """Return the features of a mesh that meet while its vertices move in straight lines, with certified times.

    No contact is missed, and none is late. Triangles that already cross at the start need not have a row: `starts_crossing`
    counts them.

    - `t0`, `t1`: (n, 3) numbers each, vertices at the start and at the end of the step.
    - `faces`, `device`: as of self_intersections.
    - `min_separation`: features that come this near count as contacts, a length of at least 0. Default 0: touching.
    - `tolerance`: accuracy of times, as a length. Default: 1e-4 of the mean edge.

    Returns Contacts, a row a pair: kind, feature_a, feature_b, toi and toi_upper in [0, 1], status.
    """
    detector = _detector(t0, faces, device)
    detector.update({0: (t0, t1)})
    return detector.continuous(min_separation=min_separation, tolerance=tolerance)


def time_of_impact(
    t0,
    t1,
    faces,
    *,
    min_separation: float = 0.0,
    tolerance: float | None = None,
    assume_free: bool = False,
    device: Device | None = None,
) -> float | None:
    """Return the safe part of a step: the time in [0, 1] of the first contact, or None if nothing meets.

    The time is never late.

    - `assume_free`: skip the check of the start.
    - Other arguments: as of contacts.

    Raises InputError if triangles cross at the start, unless the time is 0: then no step is safe.
    """
    detector = _detector(t0, faces, device)
    detector.update({0: (t0, t1)})
    first = detector.earliest(min_separation=min_separation, tolerance=tolerance, assume_free=assume_free)
    count = first.starts_crossing
    if count and first.toi != 0.0:
        pairs = "1 triangle pair crosses" if count == 1 else f"{count} triangle pairs cross"
        raise InputError(
            f"{pairs} at the start of the step, so no part of it is free of contact; "
            "list them by self_intersections(t0, faces), or skip the check by assume_free=True"
        )
    return first.toi


def _detector(vertices, faces, device):
    """A detector of one mesh, on a device that can read its vertices."""
    return Detector(Body(on_host(vertices), on_host(faces)), device=device or device_of(vertices))
