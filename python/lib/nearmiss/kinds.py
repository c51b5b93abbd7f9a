"""Numbers in the columns of answers."""

from enum import IntEnum


class Kind(IntEnum):
    """Features of a row: the numbers in `kind`."""

    VERTEX_FACE = 0
    """Feature a is a vertex, feature b a face."""
    EDGE_EDGE = 1
    """Both features are edges."""
    EDGE_VERTEX = 2
    """Feature a is an edge of no face, feature b a vertex."""
    VERTEX_VERTEX = 3
    """Both features are vertices, one of them a point: of no face and no edge."""


class PairKind(IntEnum):
    """Way in which two triangles meet: the numbers in `PairGeometry.kind`."""

    CROSSING = 0
    """Their insides share a point, and no plane holds both."""
    POINT = 1
    """They touch in one point."""
    SEGMENT = 2
    """They touch in a segment: an edge is on a face or along an edge."""
    OVERLAP = 3
    """They overlap in one plane, in an area."""


class Status(IntEnum):
    """Certainty of a row: the numbers in `status`."""

    UNVERIFIED = 0
    """Reported by a solver that can be wrong."""
    CERTIFIED = 1
    """Proven to meet, first within [toi, toi_upper]."""
    UNDECIDED = 2
    """Neither contact nor separation is proven. A contact is not before toi."""


class Closest(IntEnum):
    """Nearest parts of two features: the numbers in `closest`."""

    VERTEX_FACE = 0
    """A vertex and the inside of a face."""
    VERTEX_EDGE = 1
    """A vertex and the inside of an edge."""
    VERTEX_VERTEX = 2
    """Two vertices."""
    EDGE_EDGE = 3
    """The insides of two edges."""
