"""A program of ipctk, unchanged, with ipctk's own calls and with those of nearmiss, side by side.

    pip install ipctk nearmiss && python ipctk_with_nearmiss.py [cells a side, default 20]

Exits with 1 if sets or steps differ by more than is explained.
"""

import runpy
import statistics
import sys
from pathlib import Path

import ipctk
import numpy as np

import nearmiss.ipctk

PROGRAM = str(Path(__file__).with_name("ipctk_program.py"))
SETS = ["vertex/vertex", "edge/vertex", "edge/edge", "face/vertex"]

own = runpy.run_path(PROGRAM)
with nearmiss.ipctk.install():
    ours = runpy.run_path(PROGRAM)

failed = []
for theirs, mine in zip(own["results"], ours["results"], strict=True):
    print(f"step {theirs['step']}: ipctk, nearmiss")
    for name in theirs:
        shown = [len(one[name]) if name in SETS else one[name] for one in (theirs, mine)]
        print(f"  {name:16} {shown[0]!s:>24} {shown[1]!s:>24}")
    agree = {name: theirs[name] == mine[name] for name in [*SETS, "crosses"]}
    agree["barrier"] = abs(theirs["barrier"] - mine["barrier"]) <= 1e-9 * abs(theirs["barrier"])
    # Ours are pairs that meet in the step, ipctk's are pairs whose boxes overlap.
    agree["candidates"] = mine["candidates"] <= theirs["candidates"]
    # Both end at the first contact. nearmiss is early by its tolerance, ipctk by what it keeps of the distance.
    speed = 2 * (theirs["step"][1] - theirs["step"][0]) * np.linalg.norm(own["folded"] - own["rest"], axis=1).max()
    early = 4 * (1e-4 * ipctk.mean_edge_length(own["rest"], own["rest"], own["mesh"].edges)[0] + 1e-4 * 0.006) / speed
    agree["sharp size"] = 0 < mine["sharp size"] and abs(theirs["sharp size"] - mine["sharp size"]) < early
    # nearmiss keeps a fifth of the time to the first contact, ipctk a fifth of each distance at the start.
    agree["size"] = 0 < mine["size"] < mine["sharp size"] or mine["size"] == mine["sharp size"] == 1
    agree["is free"] = mine["is free"] == (mine["size"] == 1) and mine["is free"] >= theirs["is free"]
    failed += [f"{name} of step {theirs['step']}" for name, agrees in agree.items() if not agrees]

print(f"{'median ms':18} {'ipctk':>24} {'nearmiss':>24}")
for name, taken in own["times"].items():
    print(f"  {name:16} {statistics.median(taken):24.1f} {statistics.median(ours['times'][name]):24.1f}")
for name in failed:
    print(f"DISAGREE: {name}")
sys.exit(1 if failed else 0)
