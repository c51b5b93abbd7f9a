"""First contacts of ipctk programs in a step, by certified queries."""

import numpy as np

from .. import Kind, Status
from .broad_phase import in_space, integers, may_meet

_WIDTHS = {Kind.VERTEX_FACE: 1, Kind.EDGE_EDGE: 2}


class Steps:
    """First contacts of meshes of ipctk in a step."""

    def __init__(self, detectors):
        self._detectors = detectors

    def first_contact(self, mesh, vertices_t0, vertices_t1, min_distance=0.0, candidates=None):
        """Return a time in [0, 1] before which nothing comes within a distance; None if nothing does in the step.

        - `candidates`: Candidates of ipctk, whose pairs alone count. Default: all pairs that the mesh's filter allows.
        """
        if not (np.isfinite(min_distance) and min_distance >= 0):
            raise ValueError(f"min_distance must be finite and at least 0, got {min_distance}; pass a length in scene units")
        positions = [in_space(vertices) for vertices in (vertices_t0, vertices_t1)]
        for name, vertices in zip(("vertices_t0", "vertices_t1"), positions):
            if len(vertices) != mesh.num_vertices:
                wanted = f"a row for each of {mesh.num_vertices} vertices"
                raise ValueError(f"{name} must have {wanted}, got {len(vertices)}; pass vertices of the mesh")
        edges, faces = integers(mesh.edges, 2), integers(mesh.faces, 3)
        _, detector = self._detectors.at(positions, edges, faces)
        step = {"min_separation": min_distance, "assume_free": True}
        if detector.earliest(**step).toi is None:
            return None
        listed = None if candidates is None else _pairs_of(candidates, edges, faces)
        # Pairs that stay within the default tolerance are undecided: the smallest tolerance decides nearly all of these.
        for tolerance in (None, 0.0):
            found = detector.continuous(tolerance=tolerance, **step)
            counts = _counts(found, detector.geometry(found).vertices, mesh, listed)
            if not counts.any():
                return None
            first = np.flatnonzero(counts)[np.argmin(found.toi[counts])]
            if found.status[first] == Status.CERTIFIED:
                break
        return float(found.toi[first])


def _counts(found, vertices, mesh, listed):
    """Whether a row counts: its pair is listed or, without a list, its features may meet by the mesh's filter."""
    counts = np.zeros(len(found), bool)
    for kind, width in _WIDTHS.items():
        if kind == Kind.EDGE_EDGE and mesh.dim == 2:
            continue  # In a plane, two edges meet where a vertex of one meets the other.
        rows = np.flatnonzero(found.kind == kind)
        first, second = vertices[rows, :width], vertices[rows, width:]
        if listed is None:
            counts[rows] = may_meet(mesh.can_collide, first, second)
        else:
            counts[rows] = [pair in listed for pair in _pairs(first, second)]
    return counts


def _pairs(first, second):
    """Pairs of features, as sets of their vertices."""
    return (frozenset(pair) for pair in zip(map(frozenset, first.tolist()), map(frozenset, second.tolist())))


def _pairs_of(candidates, edges, faces):
    """The pairs of candidates of ipctk."""
    listed = set()
    for rows, of_first, of_second in [
        ([(c.vertex0_id, c.vertex1_id) for c in candidates.vv_candidates], None, None),
        ([(c.edge_id, c.vertex_id) for c in candidates.ev_candidates], edges, None),
        ([(c.edge0_id, c.edge1_id) for c in candidates.ee_candidates], edges, edges),
        ([(c.face_id, c.vertex_id) for c in candidates.fv_candidates], faces, None),
    ]:
        columns = np.array(rows, np.int64).reshape(-1, 2).T
        sides = [ids[:, None] if of is None else of[ids] for ids, of in zip(columns, (of_first, of_second))]
        listed.update(_pairs(*sides))
    return listed
