"""From ipctk: its step size, its set of near pairs and its distance, and the same by nearmiss, side by side.

    pip install ipctk nearmiss && python from_ipctk.py [cells a side, default 60]

Exits with 1 if the two differ by more than both promise.
"""

import sys

import ipctk
import numpy as np
from sheets import fold
from side_by_side import Table

import nearmiss

cells = int(sys.argv[1]) if len(sys.argv) > 1 else 60
# Column by column, as ipctk takes them.
vertices, there, faces = map(np.asfortranarray, fold(cells, 0.6 * cells))
faces = faces.astype(np.int32)
table = Table("ipctk", "nearmiss")

# The safe step.
mesh = ipctk.CollisionMesh(vertices, ipctk.edges(faces), faces)
# As near to the time of impact as possible: the default is four fifths of it.
ccd = ipctk.TightInclusionCCD(tolerance=1e-6, conservative_rescaling=0.9999)
# One detector for all queries.
detector, earliest = nearmiss.Detector(nearmiss.Body(vertices, faces)), nearmiss.Earliest(tolerance=1e-9)
theirs, ours = table.row(
    "step size",
    lambda: ipctk.compute_collision_free_stepsize(mesh, vertices, there, narrow_phase_ccd=ccd),
    lambda: detector.step({0: (vertices, there)}, earliest).toi,
)
# Neither is late, and ipctk is the more careful one.
table.agree("step size, within a thousandth of the step", 0 < theirs <= ours <= theirs + 1e-3)
# A step without a contact. ipctk does not check the start; nearmiss counts the triangles that cross there.
step = (vertices, vertices + 0.01 * ours * (there - vertices))
free, ours_free = table.row(
    "does nothing meet in a hundredth of it",
    lambda: ipctk.is_step_collision_free(mesh, *step),
    lambda: detector.step({0: step}, earliest).toi is None,
)
table.agree("nothing meets in a hundredth of it", free and ours_free)
found = detector.step({0: step}, earliest)
crossing = ipctk.has_intersections(mesh, vertices)
table.agree("whether the start is free", crossing == (found.starts_crossing > 0) and found.is_free == (not crossing))

# Features nearer than dhat. ipctk lists the nearest vertices, edges and faces, once each. nearmiss lists vertex/face and edge/edge
# pairs, with their nearest parts. Not 0.006: the halves are just so far apart, and rounding decides at the bound itself.
dhat = 0.0065
near = nearmiss.Near(dhat)
collisions = ipctk.NormalCollisions()


def by_ipctk():
    collisions.build(mesh, vertices, dhat)
    return len(collisions.vv_collisions) + len(collisions.ev_collisions) + len(collisions.ee_collisions) + len(collisions.fv_collisions)


_, found = table.row("near pairs", by_ipctk, lambda: detector.step({0: vertices}, near))
at = detector.geometry(found)


def closest(vertices, signed_weights):
    """The vertices of the nearest parts of both features, of a row."""
    sides = [v for v, w in zip(vertices, signed_weights) if w > 0], [v for v, w in zip(vertices, signed_weights) if w < 0]
    return frozenset(map(frozenset, sides))


def of_ipctk():
    """The same of ipctk. It keeps two edges that are nearly parallel as edges."""
    edges, of_faces = mesh.edges, mesh.faces
    names = ["EA0_EB0", "EA0_EB1", "EA1_EB0", "EA1_EB1", "EA_EB0", "EA_EB1", "EA0_EB", "EA1_EB", "EA_EB"]
    kinds = {getattr(ipctk, name): name.split("_") for name in names}
    for c in collisions.vv_collisions:
        yield frozenset({frozenset({c.vertex0_id}), frozenset({c.vertex1_id})})
    for c in collisions.ev_collisions:
        yield frozenset({frozenset({c.vertex_id}), frozenset(edges[c.edge_id].tolist())})
    for c in collisions.ee_collisions:
        sides = zip(kinds[c.dtype], (edges[c.edge0_id].tolist(), edges[c.edge1_id].tolist()))
        yield frozenset(frozenset(edge if len(part) == 2 else [edge[int(part[2])]]) for part, edge in sides)
    for c in collisions.fv_collisions:
        yield frozenset({frozenset({c.vertex_id}), frozenset(of_faces[c.face_id].tolist())})


theirs, ours = set(of_ipctk()), {closest(*row) for row in zip(at.vertices.tolist(), at.signed_weights.tolist())}
table.agree(f"the same {len(ours)} pairs of closest features (ipctk {len(theirs)})", theirs == ours and len(ours) > 100)

least, distance = table.row(
    "least distance",
    lambda: collisions.compute_minimum_distance(mesh, vertices) ** 0.5,
    lambda: detector.query(near).min_distance,
)
table.agree("least distance", abs(least - distance) < 1e-12)
table.end()
