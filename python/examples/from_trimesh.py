"""From trimesh.collision, which is FCL: a scene of named meshes that move, and the same by nearmiss, side by side.

    pip install trimesh python-fcl nearmiss && python from_trimesh.py [cells a side, default 40]

Exits with 1 if the two differ by more than both promise.
"""

import sys

import numpy as np
import trimesh
from sheets import grid
from side_by_side import Table
from trimesh.collision import CollisionManager

import nearmiss

x, y, faces = grid(int(sys.argv[1]) if len(sys.argv) > 1 else 40)
vertices = np.stack([x - 0.5, y - 0.5, (x - 0.5) ** 2 + (y - 0.5) ** 2], axis=1)
names = ["floor", "lid", "far"]
table = Table("trimesh (FCL)", "nearmiss")

manager = CollisionManager()
for name in names:
    manager.add_object(name, trimesh.Trimesh(vertices, faces, process=False))

scene = nearmiss.Scene(nearmiss.Body(vertices, faces, kind="fixed", name=names[0]))
for name in names[1:]:
    scene.add(nearmiss.Body(vertices, faces, kind="rigid", name=name))
detector = nearmiss.Detector(scene)

for angle, height in [(0.3, 0.05), (3.0, 0.3), (0.3, 0.4), (3.0, 0.9)]:
    print(f"turned by {angle}, raised by {height}")
    poses = {}
    for body, up in [(1, height), (2, height + 3)]:
        matrix = trimesh.transformations.rotation_matrix(angle, [1, 0, 0])
        matrix[:3, 3] = 0.013, 0.017, up
        manager.set_transform(names[body], matrix)
        poses[body] = nearmiss.Pose(rotation=(np.sin(angle / 2), 0, 0, np.cos(angle / 2)), translation=(0.013, 0.017, up))

    def who_meets():
        return sorted(tuple(sorted(names.index(name) for name in pair)) for pair in manager.in_collision_internal(return_names=True)[1])

    theirs, ours = table.row("  bodies that meet", who_meets, lambda: np.unique(detector.step(poses, nearmiss.Discrete()).bodies, axis=0).tolist(), times=3)
    table.agree("bodies that meet", theirs == [tuple(pair) for pair in ours])

    def triangles():
        contacts = manager.in_collision_internal(return_data=True)[1]
        ends = ([(names.index(name), contact.index(name)) for name in contact.names] for contact in contacts)
        return {tuple(sorted(pair)) for pair in ends}

    def ours_of_triangles():
        found = detector.step(poses, nearmiss.Discrete())
        return {((a, i), (b, j)) for (a, b), (i, j) in zip(found.bodies.tolist(), found.triangles.tolist(), strict=True)}

    crossing, ours = table.row("  triangles that cross", triangles, ours_of_triangles, times=3)
    # FCL decides by rounded numbers, nearmiss by exact signs: a few pairs that only touch may differ.
    table.agree(f"triangles that cross, except {len(crossing ^ ours)}", len(crossing ^ ours) <= len(ours) / 1000)
    if not theirs:
        theirs, ours = table.row("  distance", manager.min_distance_internal, lambda: detector.step(poses, nearmiss.Distance()).min_distance, times=3)
        table.agree("distance", abs(theirs - ours) < 1e-7)
table.end()
