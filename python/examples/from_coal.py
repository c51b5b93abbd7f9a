"""From coal (hpp-fcl): collide and distance of rigid meshes, and the same by nearmiss, side by side.

    pip install coal nearmiss && python from_coal.py [cells a side, default 40]

FCL's own Python package takes the same steps by the same names. Exits with 1 if the two differ by more than both promise.
"""

import sys

import coal
import numpy as np
from sheets import grid
from side_by_side import Table

import nearmiss


def bowl(n):
    """A curved sheet."""
    x, y, faces = grid(n)
    return np.stack([x - 0.5, y - 0.5, (x - 0.5) ** 2 + (y - 0.5) ** 2], axis=1), faces


vertices, faces = bowl(int(sys.argv[1]) if len(sys.argv) > 1 else 40)
table = Table("coal", "nearmiss")

model = coal.BVHModelOBBRSS()
model.beginModel(len(faces), len(vertices))
model.addVertices(vertices)
model.addTriangles(faces)
model.endModel()
here = coal.Transform3s()

scene = nearmiss.Scene(nearmiss.Body(vertices, faces, kind="fixed"))
other = scene.add(nearmiss.Body(vertices, faces, kind="rigid"))
detector = nearmiss.Detector(scene)


def place(angle, height):
    """A turn about x and a rise, for both."""
    half = angle / 2
    rotation = np.array([[1, 0, 0], [0, np.cos(angle), -np.sin(angle)], [0, np.sin(angle), np.cos(angle)]])
    there = coal.Transform3s(rotation, np.array([0.013, 0.017, height]))
    return there, nearmiss.Pose(rotation=(np.sin(half), 0, 0, np.cos(half)), translation=(0.013, 0.017, height))


for angle, height in [(0.3, 0.05), (3.0, 0.3), (0.3, 0.4), (3.0, 0.9)]:
    there, pose = place(angle, height)

    def collide():
        result = coal.CollisionResult()
        coal.collide(model, here, model, there, coal.CollisionRequest(coal.CONTACT, 1_000_000), result)
        return sorted({(contact.b1, contact.b2) for contact in result.getContacts()})

    print(f"turned by {angle}, raised by {height}")
    theirs, ours = table.row(
        "  triangles that cross", collide, lambda: detector.step({other: pose}, nearmiss.Discrete()).triangles.tolist(), times=3
    )
    # Coal decides by rounded numbers, nearmiss by exact signs: a few pairs that only touch may differ.
    differ = set(theirs) ^ {tuple(pair) for pair in ours}
    table.agree(f"triangles that cross, except {len(differ)}", len(differ) <= len(ours) / 1000)

    def distance():
        return coal.distance(model, here, model, there, coal.DistanceRequest(), coal.DistanceResult())

    theirs, ours = table.row("  distance", distance, lambda: detector.step({other: pose}, nearmiss.Distance()).min_distance, times=3)
    table.agree("distance", abs(max(theirs, 0) - ours) < 1e-7)
table.end()
