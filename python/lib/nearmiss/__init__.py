"""Exact collision detection for deforming triangle meshes, on the CPU and on NVIDIA GPUs.

Functions for one mesh:

    self_intersections(vertices, faces)    triangles that cross: (k, 2) indices
    near(vertices, faces, distance)        features within a distance, and their nearest points
    contacts(t0, t1, faces)                features that meet in a step, with certified times
    time_of_impact(t0, t1, faces)          safe part of a step, never late
    read_mesh(path)                        vertices and faces of a mesh file

A detector keeps a scene on a device and answers any number of queries, with one upload of positions:

    detector = nearmiss.Detector(scene)                        # or Detector(body)
    detector.update({cloth: (x0, x1), ball: pose})
    pairs = detector.near(0.01)                                # NearPairs
    first = detector.earliest(min_separation=1e-3)             # FirstContact
    triangles = detector.discrete()                            # TrianglePairs
    every = detector.continuous()                              # Contacts
    nearest = detector.distance()                              # NearestTriangles
    touching = detector.body_pairs()                           # TouchingBodies
    apart = detector.body_distances(0.1)                       # NearestBodies
    answer = detector.step({cloth: (x1, x2)}, nearmiss.Near(0.01))

No contact is missed. Pairs that a solver cannot decide are reported as undecided, and limits of an answer as caveats. After
os.fork() a child process raises InvalidArgumentError: use the "spawn" start method.
"""

from . import research
from ._native import (
    Answer,
    Body,
    BodyDistances,
    BodyPairs,
    Contacts,
    Continuous,
    Curves,
    Detector,
    Device,
    DeviceAnswer,
    DeviceArray,
    Discrete,
    Distance,
    Earliest,
    FirstContact,
    Geometry,
    MultiDetector,
    Near,
    NearestBodies,
    NearestTriangles,
    NearPairs,
    PairGeometry,
    Pose,
    PoseStep,
    Query,
    Scene,
    TouchingBodies,
    TrianglePairs,
    __version__,
    read_mesh,
)
from .errors import (
    Bug,
    DeviceError,
    InputError,
    Interrupted,
    InvalidArgumentError,
    MeshWarning,
    NearmissError,
    OutOfMemory,
)
from .kinds import Closest, Kind, PairKind, Status
from .shortcuts import contacts, near, self_intersections, time_of_impact

__all__ = [
    "Answer",
    "Body",
    "BodyDistances",
    "BodyPairs",
    "Bug",
    "Closest",
    "Contacts",
    "Continuous",
    "Curves",
    "Detector",
    "Device",
    "DeviceAnswer",
    "DeviceArray",
    "DeviceError",
    "Discrete",
    "Distance",
    "Earliest",
    "FirstContact",
    "Geometry",
    "InputError",
    "Interrupted",
    "InvalidArgumentError",
    "Kind",
    "MeshWarning",
    "MultiDetector",
    "Near",
    "NearPairs",
    "NearestBodies",
    "NearestTriangles",
    "NearmissError",
    "OutOfMemory",
    "PairGeometry",
    "PairKind",
    "Pose",
    "PoseStep",
    "Query",
    "Scene",
    "Status",
    "TouchingBodies",
    "TrianglePairs",
    "__version__",
    "contacts",
    "near",
    "read_mesh",
    "research",
    "self_intersections",
    "time_of_impact",
]
