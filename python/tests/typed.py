"""What mypy is shown: calls as a user writes them, with the types that they have."""

import numpy as np
from numpy.typing import NDArray

import nearmiss as nm

vertices, faces = nm.read_mesh("mesh.ply")
pairs: NDArray[np.uint32] = nm.self_intersections(vertices, faces)
toi: float | None = nm.time_of_impact(vertices, vertices, faces)
found: nm.Contacts = nm.near(vertices, faces, 0.1)
detector = nm.Detector(nm.Scene(nm.Body(vertices, faces, kind="rigid")), nm.Continuous(tolerance=1e-6), nm.Device("cpu"))
found = detector.frame({0: (nm.Pose(), nm.Pose(translation=(0, 0, 1)))})
times: NDArray[np.float64] = found.toi
bad: int = found.hash  # type: ignore[assignment]
