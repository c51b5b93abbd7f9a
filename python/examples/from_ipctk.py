"""From ipctk: its step size, its set of near pairs and its distance, and the same by nearmiss, side by side.

    pip install ipctk nearmiss && python from_ipctk.py [cells a side, default 60]

Exits with 1 where the two disagree by more than both promise.
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

# How far may a step go?
mesh = ipctk.CollisionMesh(vertices, ipctk.edges(faces), faces)
# As near to the time of impact as it goes: by default it takes four fifths of it.
ccd = ipctk.TightInclusionCCD(tolerance=1e-6, conservative_rescaling=0.9999)
stepper = nearmiss.Detector(nearmiss.Body(vertices, faces), nearmiss.Earliest(tolerance=1e-9))
theirs, ours = table.row(
    "step size",
    lambda: ipctk.compute_collision_free_stepsize(mesh, vertices, there, narrow_phase_ccd=ccd),
    lambda: stepper.frame({0: (vertices, there)}).earliest,
)
# Neither is late, and ipctk is the more careful one.
table.agree("step size, within a thousandth of the step", 0 < theirs <= ours <= theirs + 1e-3)
# A step along which nothing meets: ipctk does not look at the start, nearmiss counts what crosses
# there.
step = (vertices, vertices + 0.01 * ours * (there - vertices))
free, ours_free = table.row(
    "does nothing meet in a hundredth of it",
    lambda: ipctk.is_step_collision_free(mesh, *step),
    lambda: stepper.frame({0: step}).earliest is None,
)
table.agree("nothing meets in a hundredth of it", free and ours_free)
found = stepper.frame({0: step})
crossing = ipctk.has_intersections(mesh, vertices)
table.agree("whether the start is free", crossing == (found.starts_crossing > 0) and found.is_free == (not crossing))

# Which features are nearer than dhat? ipctk lists vertices, edges and faces as they are closest, once each; nearmiss every
# vertex and face and every two edges, and what is closest of them.
# Not 0.006: the halves lie just so far apart, and at the bound itself roundings decide.
dhat = 0.0065
near = nearmiss.Detector(nearmiss.Body(vertices, faces), nearmiss.Near(dhat))
collisions = ipctk.NormalCollisions()


def by_ipctk():
    collisions.build(mesh, vertices, dhat)
    return len(collisions.vv_collisions) + len(collisions.ev_collisions) + len(collisions.ee_collisions) + len(collisions.fv_collisions)


_, found = table.row("near pairs", by_ipctk, lambda: near.frame({0: vertices}))
at = near.geometry(found)


def closest(first, own, weights):
    """The vertices of what is closest, of either side, by a row of the answer."""
    sides = list(zip(own, weights))
    return frozenset(frozenset(v for v, w in side if w > 0) for side in (sides[:first], sides[first:]))


def of_ipctk():
    """The same of ipctk's, which keeps two edges that are nearly parallel as edges, whatever is closest of them."""
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


theirs, ours = set(of_ipctk()), {closest(*row) for row in zip(at.first.tolist(), at.vertices.tolist(), at.weights.tolist())}
table.agree(f"the same {len(ours)} pairs of closest features (ipctk {len(theirs)})", theirs == ours and len(ours) > 100)

least, distance = table.row(
    "least distance",
    lambda: collisions.compute_minimum_distance(mesh, vertices) ** 0.5,
    lambda: near.detect().distances.min(),
)
table.agree("least distance", abs(least - distance) < 1e-12)
table.end()
