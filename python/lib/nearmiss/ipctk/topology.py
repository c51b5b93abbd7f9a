"""Meshes of ipctk as bodies, and rows of answers as features of ipctk."""

import numpy as np

from .. import Kind


class Table:
    """Items by their keys, none, one or many for each key."""

    def __init__(self, keys, items, count):
        order = np.argsort(keys, kind="stable")
        self.items = items[order]
        self.starts = np.searchsorted(keys[order], np.arange(count + 1))

    def join(self, keys):
        """Return for each item of each key the position of the key, and the item."""
        counts = self.starts[keys + 1] - self.starts[keys]
        rows = np.repeat(np.arange(len(keys)), counts)
        first = np.cumsum(counts) - counts
        return rows, self.items[(self.starts[keys] - first)[rows] + np.arange(len(rows))]


class Topology:
    """Edges and faces of ipctk, and the faces of the body that has the same features.

    The body has the faces of the mesh, then edges of no face as [a, b, b], then vertices of neither as [p, p, p].
    """

    def __init__(self, count, edges, faces):
        self.edges, self.faces, self.count = edges, faces, count
        looped = np.flatnonzero(edges[:, 0] == edges[:, 1])
        if len(looped):
            at, end = looped[0], edges[looped[0], 0]
            raise ValueError(f"edge {at} has one vertex at both ends, got [{end}, {end}]; leave it out: a vertex needs no edge")
        ends = faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        is_bare = ~np.isin(self._keys(edges), self._keys(ends))
        self.bare = np.flatnonzero(is_bare)
        is_used = np.zeros(count, bool)
        is_used[faces] = is_used[edges] = True
        self.points = np.flatnonzero(~is_used)
        body = [faces, edges[self.bare][:, [0, 1, 1]], np.repeat(self.points[:, None], 3, axis=1)]
        self.body = np.ascontiguousarray(np.concatenate(body))
        # Edges of a body are numbered by (larger vertex, smaller vertex), ascending.
        corners = self.body[:, [[0, 1], [1, 2], [2, 0]]]
        has_edge = corners[..., 0] != corners[..., 1]
        self._edge_keys, numbers = np.unique(self._keys(corners[has_edge]), return_inverse=True)
        owners = np.nonzero(has_edge)[0]
        self._faces_of_edge = Table(numbers, owners, len(self._edge_keys))
        self._faces_of_vertex = Table(self.body.ravel(), np.repeat(np.arange(len(self.body)), 3), count)
        at = np.searchsorted(self._edge_keys, self._keys(edges))
        self._own_edges = Table(at, np.arange(len(edges)), len(self._edge_keys))
        faces_of_own, own = self._own_edges.join(numbers)
        self._edges_of_face = Table(owners[faces_of_own], own, len(self.body))

    def _keys(self, edges):
        return edges.max(axis=-1).astype(np.int64) * self.count + edges.min(axis=-1)

    def is_of(self, count, edges, faces):
        """Return whether these are the arrays that it was made of."""
        return self.count == count and np.array_equal(self.edges, edges) and np.array_equal(self.faces, faces)

    # Rows of vertices and faces, and of edges and edges, as pairs of features of ipctk.

    def edge_edge(self, found):
        """Return pairs of edges, the smaller number first."""
        rows = _columns(found, Kind.EDGE_EDGE)
        at, first = self._own_edges.join(rows[:, 0])
        back, second = self._own_edges.join(rows[at, 1])
        return np.sort(np.stack([first[back], second], axis=1), axis=1)

    def face_vertex(self, found):
        """Return pairs of a face and a vertex."""
        rows = _columns(found, Kind.VERTEX_FACE)
        return rows[rows[:, 1] < len(self.faces)][:, ::-1]

    def edge_vertex(self, found):
        """Return pairs of an edge of no face and a vertex."""
        rows = _columns(found, Kind.VERTEX_FACE)
        own = rows[:, 1] - len(self.faces)
        is_edge = (own >= 0) & (own < len(self.bare))
        return np.stack([self.bare[own[is_edge]], rows[is_edge, 0]], axis=1)

    def vertex_vertex(self, found):
        """Return pairs of vertices, one of them of no edge and no face, the smaller number first."""
        rows = _columns(found, Kind.VERTEX_FACE)
        own = rows[:, 1] - len(self.faces) - len(self.bare)
        is_point = own >= 0
        return np.unique(np.sort(np.stack([rows[is_point, 0], self.points[own[is_point]]], axis=1), axis=1), axis=0)

    # Triangles, and edges with triangles: features of two that come near, or that cross.

    def triangles(self, found, crossing):
        """Return pairs of faces of the body that come near, or cross at the start."""
        vertex_face, edge_edge = (_columns(found, kind) for kind in (Kind.VERTEX_FACE, Kind.EDGE_EDGE))
        row, of_vertex = self._faces_of_vertex.join(vertex_face[:, 0])
        at, first = self._faces_of_edge.join(edge_edge[:, 0])
        back, second = self._faces_of_edge.join(edge_edge[at, 1])
        near = np.stack([of_vertex, vertex_face[row, 1]], axis=1), np.stack([first[back], second], axis=1)
        return np.unique(np.sort(np.concatenate([*near, crossing.triangles.astype(np.int64)]), axis=1), axis=0)

    def face_face(self, triangles):
        """Return pairs of faces without a common vertex, the smaller number first."""
        rows = triangles[(triangles < len(self.faces)).all(axis=1)]
        return rows[_are_apart(self.faces[rows[:, 0]], self.faces[rows[:, 1]])]

    def edge_face(self, triangles):
        """Return pairs of an edge and a face without a common vertex: edges of the one triangle, and the other one."""
        both = np.concatenate([triangles, triangles[:, ::-1]])
        both = both[both[:, 1] < len(self.faces)]
        row, edge = self._edges_of_face.join(both[:, 0])
        rows = np.unique(np.stack([edge, both[row, 1]], axis=1), axis=0)
        return rows[_are_apart(self.edges[rows[:, 0]], self.faces[rows[:, 1]])]


def _columns(found, kind):
    """The features of the rows of a kind."""
    is_kind = found.kind == kind
    return np.stack([found.feature_a[is_kind], found.feature_b[is_kind]], axis=1).astype(np.int64)


def _are_apart(first, second):
    """Whether two features have no common vertex, row by row."""
    return ~(first[:, :, None] == second[:, None, :]).any(axis=(1, 2))
