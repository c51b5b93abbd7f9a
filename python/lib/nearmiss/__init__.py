"""nearmiss: exact collision detection for deformable triangle meshes, on the CPU and on NVIDIA GPUs.

    import nearmiss
    pairs = nearmiss.self_intersections(vertices, faces)      # (k, 2): triangles that cross, exactly
    close = nearmiss.near(vertices, faces, distance=0.01)     # what is within a hundredth, and where
    toi = nearmiss.time_of_impact(t0, t1, faces)              # how far a step may go, never late

What is asked often is asked of a Detector: a Scene of Body objects on a Device, and a query (Discrete, Continuous, Earliest,
Near, Distance). No contact is missed; where a solver cannot tell it says so, and where something ends it raises.
Start processes by spawn: one that was forked after the first call has no threads to compute with, and raises InvalidArgumentError.
"""

from enum import IntEnum

from ._native import (
    Body,
    Contacts,
    Continuous,
    Detector,
    Device,
    DeviceAnswer,
    DeviceArray,
    Discrete,
    Distance,
    Earliest,
    Geometry,
    Near,
    Pose,
    Query,
    Scene,
    __version__,
    read_mesh,
)
from .errors import (
    Bug,
    InvalidArgumentError,
    DeviceError,
    InputError,
    Interrupted,
    MeshWarning,
    NearmissError,
    OutOfMemory,
)
from .shortcuts import contacts, near, self_intersections, time_of_impact


class Kind(IntEnum):
    """Which features meet: the numbers in Contacts.kind."""

    VERTEX_FACE = 0
    """A vertex of the first body, a face of the second."""
    FACE_VERTEX = 1
    """A face of the first body, a vertex of the second."""
    EDGE_EDGE = 2


class Status(IntEnum):
    """How sure an answer is: the numbers in Contacts.status."""

    CONTACT = 0
    """A solver that can be wrong says so."""
    CERTIFIED = 1
    """They meet, proven, first in [toi, toi_upper]."""
    UNDECIDED = 2
    """They come nearer than the tolerance; if they meet, not before toi. Proven as well."""


class Closest(IntEnum):
    """What is nearest of two features: the numbers in Contacts.closest."""

    VERTEX_FACE = 0
    VERTEX_EDGE = 1
    VERTEX_VERTEX = 2
    EDGE_EDGE = 3


__all__ = [
    "Body",
    "Bug",
    "InvalidArgumentError",
    "Closest",
    "Contacts",
    "Continuous",
    "Detector",
    "Device",
    "DeviceAnswer",
    "DeviceArray",
    "DeviceError",
    "Discrete",
    "Distance",
    "Earliest",
    "Geometry",
    "InputError",
    "Interrupted",
    "Kind",
    "MeshWarning",
    "Near",
    "NearmissError",
    "OutOfMemory",
    "Pose",
    "Query",
    "Scene",
    "Status",
    "__version__",
    "contacts",
    "near",
    "read_mesh",
    "self_intersections",
    "time_of_impact",
]
