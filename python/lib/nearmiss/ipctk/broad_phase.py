"""A broad phase of ipctk whose candidates are found by a detector."""

import ipctk
import numpy as np

from .. import Continuous, Discrete, Near
from .detectors import Detectors

_SMALLEST = np.finfo(float).tiny
# By how much a candidate may exceed the distance of `build`: far more than ipctk's rounding of a distance, of the distance itself
# and of the scene's extent.
_SLACK_OF_DISTANCE, _SLACK_OF_EXTENT = 2.0**-20, 2.0**-40


class BroadPhase(ipctk.BroadPhase):
    """Broad phase of ipctk whose candidates come near, not only their boxes.

    Candidates are the features that come within twice the inflation radius, at rest or anywhere in the step. The boxes of ipctk's
    own broad phases overlap for all of these, and for many others.

    - `device`: a nearmiss.Device; default: a GPU if there is one, else the CPU.
    """

    def __init__(self, device=None):
        super().__init__()
        self.detectors = Detectors(device)
        self.clear()

    def name(self):
        """Return "nearmiss"."""
        return "nearmiss"

    def clear(self):
        """Forget the positions. Detectors are kept for the next frame."""
        super().clear()
        self._built, self._answers = None, {}

    def build(self, *args, **named):
        """Take positions and the mesh: (vertices, edges, faces, radius) or (vertices_t0, vertices_t1, edges, faces, radius)."""
        values = [*args, *(named[name] for name in ("vertices", "vertices_t0", "vertices_t1", "edges", "faces") if name in named)]
        radius = values.pop() if values and np.ndim(values[-1]) == 0 else named.get("inflation_radius", 0.0)
        if not (np.isfinite(radius) and radius >= 0):
            raise ValueError(f"inflation_radius must be finite and at least 0, got {radius}; pass half of the distance")
        # Copies: the arrays may be gone when this returns.
        *positions, edges, faces = values
        positions, edges, faces = [in_space(vertices) for vertices in positions], integers(edges, 2), integers(faces, 3)
        for vertices in positions:
            check("edges", edges, len(vertices))
            check("faces", faces, len(vertices))
        # It checks the number of arguments, and sets the dimension that detect_collision_candidates needs.
        super().build(*args, **named)
        self._built = positions, edges, faces, 2 * float(radius)

    def detect_vertex_vertex_candidates(self):
        """Return pairs of vertices."""
        topology, found = self._near(edges=False, faces=False)
        rows = topology.vertex_vertex(found)
        return self._candidates(ipctk.VertexVertexCandidate, rows, rows[:, :1], rows[:, 1:])

    def detect_edge_vertex_candidates(self):
        """Return pairs of an edge and a vertex."""
        topology, found = self._near(faces=False)
        rows = topology.edge_vertex(found)
        return self._candidates(ipctk.EdgeVertexCandidate, rows, rows[:, 1:], topology.edges[rows[:, 0]])

    def detect_edge_edge_candidates(self):
        """Return pairs of edges."""
        topology, found = self._near()
        rows = topology.edge_edge(found)
        return self._candidates(ipctk.EdgeEdgeCandidate, rows, *(topology.edges[rows[:, side]] for side in (0, 1)))

    def detect_face_vertex_candidates(self):
        """Return pairs of a face and a vertex."""
        topology, found = self._near()
        rows = topology.face_vertex(found)
        return self._candidates(ipctk.FaceVertexCandidate, rows, rows[:, 1:], topology.faces[rows[:, 0]])

    def detect_edge_face_candidates(self):
        """Return pairs of an edge and a face, of triangles that come near or cross."""
        topology, triangles = self._triangles()
        rows = topology.edge_face(triangles)
        return self._candidates(ipctk.EdgeFaceCandidate, rows, topology.edges[rows[:, 0]], topology.faces[rows[:, 1]])

    def detect_face_face_candidates(self):
        """Return pairs of faces that come near or cross."""
        topology, triangles = self._triangles()
        rows = topology.face_face(triangles)
        return self._candidates(ipctk.FaceFaceCandidate, rows, *(topology.faces[rows[:, side]] for side in (0, 1)))

    def _answer(self, query, edges, faces):
        """The topology of a part of the mesh, and the answer to a query of it."""
        if self._built is None:
            raise RuntimeError("the broad phase has no positions, got no call of build since the last clear; call build first")
        positions, all_edges, all_faces, _ = self._built
        key = query, edges, faces
        if key not in self._answers:
            shapes = all_edges if edges else all_edges[:0], all_faces if faces else all_faces[:0]
            topology, detector = self.detectors.at(positions, *shapes)
            self._answers[key] = topology, detector.query(query)
        return self._answers[key]

    def _near(self, edges=True, faces=True):
        positions, _, _, reach = self._built or ([], None, None, 0.0)
        # Numbers that are not finite are refused by the detector, which names the vertex.
        extent = max((np.abs(vertices[np.isfinite(vertices)]).max(initial=0.0) for vertices in positions), default=0.0)
        reach = max(reach + _SLACK_OF_DISTANCE * reach + _SLACK_OF_EXTENT * extent, _SMALLEST)
        query = Near(reach) if len(positions) == 1 else Continuous(min_separation=reach, assume_free=True)
        return self._answer(query, edges, faces)

    def _triangles(self):
        topology, found = self._near()
        return topology, topology.triangles(found, self._answer(Discrete(adjacent=True), True, True)[1])

    def _candidates(self, kind, rows, first, second):
        """Candidates of ipctk, without those of which no vertex may meet any of the other feature's."""
        rows = rows[may_meet(self.can_vertices_collide, first, second)]
        return list(map(kind, *rows.T.tolist()))


def may_meet(can_collide, first, second):
    """Return whether a filter lets any vertex of the one feature meet any of the other's, row by row."""
    may = np.zeros(len(first), bool)
    for a in range(first.shape[1]):
        for b in range(second.shape[1]):
            rest = np.flatnonzero(~may)
            may[rest] = list(map(can_collide, first[rest, a].tolist(), second[rest, b].tolist()))
    return may


def in_space(vertices):
    """Return vertices as (n, 3) float64, a copy; those of a plane at height 0."""
    vertices = np.array(vertices, float, order="C", ndmin=2)
    return np.pad(vertices, ((0, 0), (0, 3 - vertices.shape[1])))


def integers(indices, width):
    """Return indices as (n, width) int64, a copy; also no indices of any shape."""
    return np.array(indices, np.int64).reshape(-1, width)


def check(name, indices, count):
    """Raise IndexError if an index names no vertex."""
    outside = indices[(indices < 0) | (indices >= count)]
    if outside.size:
        raise IndexError(f"{name} must name vertices from 0 to {count - 1}, got {outside[0]}; correct the mesh")
