"""One question about one mesh, in one line. A detector that is kept answers frame after frame, and faster."""

import numpy as np
from numpy.typing import NDArray

from ._native import Body, Contacts, Continuous, Detector, Device, Discrete, Earliest, Near
from .arrays import device_of, on_host
from .errors import InputError

__all__ = ["contacts", "near", "self_intersections", "time_of_impact"]


def self_intersections(vertices, faces, *, adjacent: bool = False, device: Device | None = None) -> NDArray[np.uint32]:
    """Which triangles of a mesh share a point with another one, by exact signs: none is missed, none is invented.

    vertices: (n, 3) numbers; float32 and float64 are taken as they are, never rounded. A GPU's array too.
    faces:    (m, 3) integers, the vertices of each triangle.
    adjacent: whether triangles that share a vertex are asked, too: do they share more than that vertex or edge?
    Returns (k, 2) uint32: pairs of triangles, the smaller index first, ascending.

    Triangles that merely touch where the mesh is not welded (two vertices in one place) share that point.
    """
    return _ask(vertices, faces, Discrete(adjacent=adjacent), device).indices


def near(vertices, faces, distance: float, *, device: Device | None = None) -> Contacts:
    """Which vertices and faces, and which edges, of a mesh are within a distance of each other, and where they are nearest.

    vertices, faces: as for self_intersections. distance: a length above 0, in the unit of the vertices.
    Returns Contacts: kind, indices, squared_distances, weights, closest; a row a pair. None is missed; features of a common
    vertex are no pair.
    """
    return _ask(vertices, faces, Near(distance), device)


def contacts(
    t0, t1, faces, *, separation: float = 0.0, tolerance: float | None = None, device: Device | None = None
) -> Contacts:
    """Which features of a mesh meet while its vertices move from t0 to t1 in straight lines, and when: certified.

    t0, t1:     (n, 3) numbers each, as vertices of self_intersections.
    separation: what comes nearer than this is in contact, in the unit of the vertices; 0 for touching.
    tolerance:  how well a time is told: as a length moved. Default: 1e-4 of the mean edge.
    Returns Contacts: kind, indices, toi and toi_upper (bounds of the first time, in [0, 1]), status. None is missed, none is late.
    `starts_crossing` counts the triangle pairs that share a point at the start: those need not have a time.
    """
    return _ask(t0, faces, Continuous(separation=separation, tolerance=tolerance), device, t1)


def time_of_impact(
    t0,
    t1,
    faces,
    *,
    separation: float = 0.0,
    tolerance: float | None = None,
    assume_free: bool = False,
    device: Device | None = None,
) -> float | None:
    """How far a step may go: the first time in [0, 1] at which any two features meet, never late; None if the step is free.

    Raises InputError if triangles cross at the start, unless the first time is 0: no step is free then, though none of their
    features need meet again. assume_free: the start is not checked.
    Other arguments as for contacts.
    """
    query = Earliest(separation=separation, tolerance=tolerance, assume_free=assume_free)
    found = _ask(t0, faces, query, device, t1)
    count = found.starts_crossing
    if count and found.earliest != 0.0:
        pairs = "1 triangle pair crosses" if count == 1 else f"{count} triangle pairs cross"
        raise InputError(
            f"{pairs} at the start of the step, so no part of it is free of contact; "
            "list them by self_intersections(t0, faces), or leave them aside by assume_free=True"
        )
    return found.earliest


def _ask(here, faces, query, device, there=None):
    """Of a mesh that rests here, or moves from here to there."""
    detector = Detector(Body(on_host(here), on_host(faces)), query, device or device_of(here))
    return detector.detect() if there is None else detector.frame({0: (here, there)})
