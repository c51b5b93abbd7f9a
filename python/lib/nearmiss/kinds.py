"""Numbers in the columns of answers."""

from enum import IntEnum


class Kind(IntEnum):
    """Features of a row: the numbers in `kind`."""

    VERTEX_FACE = 0
    """Feature a is a vertex, feature b a face."""
    EDGE_EDGE = 1
    """Both features are edges."""


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
