"""A program of ipctk that knows nothing of nearmiss: contacts, barrier and step sizes of a cloth that folds through itself.

    pip install ipctk && python ipctk_program.py [cells a side, default 20]

`ipctk_with_nearmiss.py` runs it as it is, with ipctk's own calls and with those of nearmiss.
"""

import sys
import time

import ipctk
import numpy as np
from sheets import fold

cells = int(sys.argv[1]) if len(sys.argv) > 1 else 20
rest, folded, faces = map(np.asfortranarray, fold(cells, 0.6 * cells))
faces = faces.astype(np.int32)
mesh = ipctk.CollisionMesh(rest, ipctk.edges(faces), faces)
dhat = 0.0065
barrier = ipctk.BarrierPotential(dhat, 1e4)
sharp = ipctk.TightInclusionCCD(tolerance=1e-6, conservative_rescaling=0.9999)
results, times = [], {}


def timed(name, call):
    """Run a call, and add its time to those of its name."""
    begin = time.perf_counter()
    value = call()
    times.setdefault(name, []).append(1e3 * (time.perf_counter() - begin))
    return value


for start, end in [(0.0, 0.05), (0.05, 0.1), (0.1, 0.8)]:
    t0, t1 = (np.asfortranarray(rest + part * (folded - rest)) for part in (start, end))
    collisions = ipctk.NormalCollisions()
    timed("collisions", lambda: collisions.build(mesh, t0, dhat))
    candidates = ipctk.Candidates()
    timed("candidates", lambda: candidates.build(mesh, t0, t1))
    results.append({
        "step": (start, end),
        "vertex/vertex": sorted(tuple(sorted((c.vertex0_id, c.vertex1_id))) for c in collisions.vv_collisions),
        "edge/vertex": sorted((c.edge_id, c.vertex_id) for c in collisions.ev_collisions),
        "edge/edge": sorted(tuple(sorted((c.edge0_id, c.edge1_id))) for c in collisions.ee_collisions),
        "face/vertex": sorted((c.face_id, c.vertex_id) for c in collisions.fv_collisions),
        "barrier": barrier(collisions, mesh, t0),
        "candidates": len(candidates.ee_candidates) + len(candidates.fv_candidates),
        "crosses": timed("intersections", lambda: ipctk.has_intersections(mesh, t0)),
        "is free": timed("is free", lambda: ipctk.is_step_collision_free(mesh, t0, t1)),
        "size": timed("step size", lambda: ipctk.compute_collision_free_stepsize(mesh, t0, t1)),
        "sharp size": timed("sharp step size", lambda: ipctk.compute_collision_free_stepsize(mesh, t0, t1, narrow_phase_ccd=sharp)),
    })
    print(f"t = {start}: {len(collisions.ee_collisions)} edge/edge, size {results[-1]['size']:.6f}")
