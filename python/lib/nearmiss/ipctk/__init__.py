"""nearmiss in programs of ipctk (IPC Toolkit): a broad phase, and step sizes.

    import ipctk
    import nearmiss.ipctk

    collisions.build(mesh, vertices, dhat, broad_phase=nearmiss.ipctk.BroadPhase())   # for one call
    nearmiss.ipctk.install()                                                          # for all calls of the program

`pip install ipctk`, 1.6 or later. Candidates are features that come near, found by exact queries. Step sizes are proven: nothing
meets before them.
"""

from .broad_phase import BroadPhase
from .installed import install, uninstall

__all__ = ["BroadPhase", "install", "uninstall"]
