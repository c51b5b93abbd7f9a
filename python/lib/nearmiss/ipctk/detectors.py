"""Detectors of the meshes that a program of ipctk uses."""

from .. import Body, Detector, Device
from .topology import Topology

# A frame of ipctk has up to three meshes: all features, edges and vertices without faces, vertices alone.
_KEPT = 8


class Detectors:
    """Detectors by their meshes; the latest ones are kept."""

    def __init__(self, device=None):
        self.device = device or Device()
        self._kept = []

    def at(self, positions, edges, faces):
        """Return the topology and the detector of a mesh, at rest at one array of positions or in a step between two."""
        known = next((kept for kept in self._kept if kept[0].is_of(len(positions[0]), edges, faces)), None)
        if known is None:
            topology = Topology(len(positions[0]), edges, faces)
            known = topology, Detector(Body(positions[0], topology.body), device=self.device)
        self._kept = [known, *(kept for kept in self._kept if kept is not known)][:_KEPT]
        known[1].update({0: positions[0] if len(positions) == 1 else tuple(positions)})
        return known
