"""Calls as a user writes them, with their types, for mypy. It must find the faults too."""

import numpy as np
from numpy.typing import NDArray

import nearmiss as nm

vertices, faces = nm.read_mesh("mesh.ply")
hair, skin, edges, points = nm.read_mesh("hair.obj", elements=True)
pairs: NDArray[np.uint32] = nm.self_intersections(vertices, faces)
toi: float | None = nm.time_of_impact(vertices, vertices, faces)
near: nm.NearPairs = nm.near(vertices, faces, 0.1)
found: nm.Contacts = nm.contacts(vertices, vertices, faces)
detector = nm.Detector(nm.Scene(nm.Body(vertices, faces, kind="rigid")), device=nm.Device("cpu"))
detector.update({0: (nm.Pose(), nm.Pose(translation=(0, 0, 1)))})
moves: dict[str, nm.PoseStep] = {"a mesh": nm.PoseStep(np.eye(4), nm.Pose(), pivot=(0, 0, 1))}
detector.update(moves)
detector.update_poses([0], np.zeros((1, 3)), np.eye(4)[3:])
start, end = detector.poses("a mesh")
matrix: NDArray[np.float64] = detector.pose(0).matrix
first: nm.FirstContact = detector.earliest(min_separation=1e-3)
triangles: nm.TrianglePairs = detector.query(nm.Discrete())
nearest: nm.NearestTriangles = detector.step({0: nm.Pose()}, nm.Distance())
touching: nm.TouchingBodies = detector.query(nm.BodyPairs(first=1))
apart: nm.NearestBodies = detector.body_distances(0.1)
slow: nm.Continuous = nm.research.configure(nm.Continuous(tolerance=1e-6), solver="cubic-f64")
found = detector.query(slow)
near = detector.collect(nm.Near(0.1))
detector.prepare({0: nm.Pose()}, [nm.Near(0.1), nm.Earliest()])
times: NDArray[np.float64] = found.toi
places: nm.Geometry = detector.geometry(found)
meetings: nm.PairGeometry = detector.geometry(triangles)
curves: nm.Curves = detector.curves(triangles)
body = nm.Body(vertices, faces, kind="soft")  # type: ignore[arg-type]
wrong: nm.NearPairs = detector.query(nm.Earliest())  # type: ignore[assignment]
nm.research.configure(nm.Discrete(), broad_phase="octree")  # type: ignore[arg-type]
detector.curves(found)  # type: ignore[arg-type]
nearest.distances  # type: ignore[attr-defined]
bad: int = found.hash  # type: ignore[assignment]
