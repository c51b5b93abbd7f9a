"""A collision manager for trimesh, in place of the one that needs FCL.

    manager = nearmiss.trimesh.CollisionManager()          # as trimesh.collision.CollisionManager()
    nearmiss.trimesh.install()                             # for trimesh.collision itself, scene_to_collision too

`pip install trimesh`; python-fcl is not needed. Meshes are surfaces, also convex ones: a mesh inside another does not collide with
it. Distances are 0 or more, and depths are not computed.
"""

from typing import NamedTuple

import numpy as np
import trimesh.collision

from . import Body, Detector, Device, PairKind, Pose, Scene
from .replacements import Replacements

__all__ = ["CollisionManager", "ContactData", "install", "uninstall"]

# FCL's distance if there are no two objects.
_NO_DISTANCE = float(np.finfo(float).max)
_EXTERNAL = "__external"
# Scenes of a manager: its own objects, each query from outside, each other manager.
_KEPT = 4
_installed = Replacements()


def install(device=None):
    """Make trimesh.collision use this manager, until `uninstall` or the end of a `with` block.

    - `device`: a nearmiss.Device; default: a GPU if there is one, else the CPU.
    """

    class Manager(CollisionManager):
        __doc__ = CollisionManager.__doc__

        def __init__(self):
            super().__init__(device)

    uninstall()
    _installed.put(trimesh.collision, "CollisionManager", Manager)
    return _installed


def uninstall():
    """Give trimesh its own manager back. Without an installation it does nothing."""
    _installed.undo()


class ContactData(trimesh.collision.ContactData):
    """Contact of two triangles: their faces, a common point, and the normal of a face."""

    @property
    def depth(self):
        """Not computed: raises NotImplementedError."""
        raise NotImplementedError("depth is not computed, got a contact of two surfaces; use its point and normal")


class _Contact(NamedTuple):
    """The fields of fcl.Contact that ContactData reads."""

    b1: int
    b2: int
    pos: np.ndarray
    normal: np.ndarray
    penetration_depth: None = None


class _Nearest(NamedTuple):
    """The fields of fcl.DistanceResult that DistanceData reads."""

    b1: int
    b2: int
    nearest_points: np.ndarray
    min_distance: float


class _Object(NamedTuple):
    """Mesh of a manager, a copy, and its pose."""

    vertices: np.ndarray
    faces: np.ndarray
    pose: Pose

    @staticmethod
    def of(mesh, transform, known=()):
        """The object of a mesh; it shares the copy of a known one with the same mesh."""
        vertices, faces = np.array(mesh.vertices, float), np.array(mesh.faces)
        for other in known:
            if np.array_equal(other.vertices, vertices) and np.array_equal(other.faces, faces):
                return other._replace(pose=_pose(transform))
        # A mesh that cannot be used is refused here, not by later queries.
        Body(vertices, faces, kind="rigid")
        return _Object(vertices, faces, _pose(transform))


class CollisionManager:
    """Named meshes that move, with the methods of trimesh.collision.CollisionManager.

    Meshes may have any shape. Answers are about surfaces: two collide if and only if they share a point, by exact signs.

    - `device`: a nearmiss.Device; default: a GPU if there is one, else the CPU.
    """

    def __init__(self, device=None):
        self._device = device or Device()
        self._objs = {}
        self._worlds = []
        self._external = []

    def add_object(self, name, mesh, transform=None):
        """Add a mesh under a name, or replace the one with that name.

        - `mesh`: a Trimesh, or an object with its `vertices` and `faces`. Later changes of it do not count.
        - `transform`: (4, 4) matrix of a rotation and a translation. Default: the identity.
        """
        self._objs[name] = _Object.of(mesh, transform)

    def remove_object(self, name):
        """Remove a mesh. Raises ValueError for a name that is not in the manager."""
        self._object(name)
        del self._objs[name]

    def set_transform(self, name, transform):
        """Place a mesh by a (4, 4) matrix. Raises ValueError for a name that is not in the manager."""
        self._objs[name] = self._object(name)._replace(pose=_pose(transform))

    def in_collision_single(self, mesh, transform=None, return_names=False, return_data=False):
        """Return whether a mesh collides with any of the manager, a set of the names of these, and a list of ContactData."""
        found, names, contacts = self._collisions(self._with_external(mesh, transform), return_names, return_data)
        return _result(found, (return_names, {name for name, _ in names}), (return_data, contacts))

    def in_collision_internal(self, return_names=False, return_data=False):
        """Return whether any two meshes collide, a set of pairs of names, each sorted, and a list of ContactData."""
        found, names, contacts = self._collisions([self._objs], return_names, return_data)
        return _result(found, (return_names, {tuple(sorted(pair)) for pair in names}), (return_data, contacts))

    def in_collision_other(self, other_manager, return_names=False, return_data=False):
        """Return whether any mesh collides with any of another manager, a set of pairs of names, and a list of ContactData."""
        found, names, contacts = self._collisions([self._objs, other_manager._objs], return_names, return_data)
        return _result(found, (return_names, set(names)), (return_data, contacts))

    def min_distance_single(self, mesh, transform=None, return_name=False, return_data=False):
        """Return the least distance of a mesh from any of the manager, the name of that one, and DistanceData."""
        distance, names, data = self._distance(self._with_external(mesh, transform))
        return _result(distance, (return_name, names[0]), (return_data, data))

    def min_distance_internal(self, name=None, return_names=False, return_data=False):
        """Return the least distance of two meshes, or of the one with a name from all others, their names, and DistanceData."""
        sides = [self._objs]
        if name is not None:
            self._object(name)
            sides = [{name: self._objs[name]}, {other: placed for other, placed in self._objs.items() if other != name}]
        distance, names, data = self._distance(sides)
        return _result(distance, (return_names, names if None in names else tuple(sorted(names))), (return_data, data))

    def min_distance_other(self, other_manager, return_names=False, return_data=False):
        """Return the least distance of a mesh from any of another manager, their names, and DistanceData."""
        distance, names, data = self._distance([self._objs, other_manager._objs])
        return _result(distance, (return_names, names), (return_data, data))

    def _object(self, name):
        if name not in self._objs:
            raise ValueError(f"name must be that of an object of the manager, got {name!r}; add it first")
        return self._objs[name]

    def _with_external(self, mesh, transform):
        """The manager's objects, and those of a mesh from outside."""
        self._external = [_Object.of(mesh, transform, self._external)]
        return [self._objs, {_EXTERNAL: self._external[0]}]

    def _at(self, sides):
        """The world of the objects, at their poses."""
        known = next((world for world in self._worlds if world.is_of(sides)), None) or _World(sides, self._device)
        self._worlds = [known, *(world for world in self._worlds if world is not known)][:_KEPT]
        known.place(sides)
        return known

    def _collisions(self, sides, with_names, with_contacts):
        """Whether any two objects collide, their pairs of names, and their contacts."""
        if _pairs(sides) == 0:
            return False, [], []
        world, names = self._at(sides), [name for side in sides for name in side]
        if not with_contacts:
            found = world.detector.body_pairs() if with_names else world.detector.body_pairs(first=1)
            return len(found) > 0, [tuple(names[body] for body in pair) for pair in found.bodies.tolist()], []
        found = world.detector.discrete()
        pairs = [tuple(names[body] for body in pair) for pair in found.bodies.tolist()]
        contacts = [ContactData(pair, contact) for pair, contact in zip(pairs, world.contacts(found))]
        return len(found) > 0, pairs, contacts

    def _distance(self, sides):
        """The least distance of two objects, their names, and DistanceData."""
        if _pairs(sides) == 0:
            return _NO_DISTANCE, (None, None), None
        found = self._at(sides).detector.distance()
        names = [name for side in sides for name in side]
        pair = tuple(names[body] for body in found.bodies.tolist())
        nearest = _Nearest(*found.triangles.tolist(), found.points.copy(), found.min_distance)
        return found.min_distance, pair, trimesh.collision.DistanceData(pair, nearest)


class _World:
    """Objects on a detector: those of one side among each other, or those of two sides."""

    def __init__(self, sides, device):
        self.sizes, self.objects = [len(side) for side in sides], [placed for side in sides for placed in side.values()]
        scene = Scene()
        for number, side in enumerate(sides):
            group, mask = (1 << number, 2 >> number) if len(sides) == 2 else (1, 1)
            for name, (vertices, faces, pose) in side.items():
                scene.add(Body(vertices, faces, kind="rigid", pose=pose, group=group, mask=mask, name=str(name)))
        self.detector = Detector(scene, device=device)

    def is_of(self, sides):
        """Whether the objects have these meshes, in this order."""
        objects = [placed for side in sides for placed in side.values()]
        same = (own.vertices is other.vertices and own.faces is other.faces for own, other in zip(self.objects, objects))
        return self.sizes == [len(side) for side in sides] and all(same)

    def place(self, sides):
        """Move the objects that have other poses than before."""
        objects = [placed for side in sides for placed in side.values()]
        moved = {body: new.pose for body, (old, new) in enumerate(zip(self.objects, objects)) if new.pose is not old.pose}
        if moved:
            self.detector.update(moved)
        self.objects = objects

    def contacts(self, found):
        """The contact of each row: the middle of the common segment, and the normal of the first face."""
        geometry = self.detector.geometry(found)
        corners = np.empty((len(found), 2, 3, 3))
        for body, placed in enumerate(self.objects):
            row, side = np.nonzero(found.bodies == body)
            matrix = placed.pose.matrix
            corners[row, side] = placed.vertices[placed.faces[found.triangles[row, side]]] @ matrix[:3, :3].T + matrix[:3, 3]
        points = geometry.ends.mean(axis=1)
        for row in np.flatnonzero(geometry.kind == PairKind.OVERLAP):
            points[row] = _middle_of_overlap(*corners[row])
        normals = _normals(corners[:, 0])
        return [_Contact(*row) for row in zip(*found.triangles.T.tolist(), points, normals)]


def _pairs(sides):
    """How many pairs of objects may collide."""
    return len(sides[0]) * (len(sides[0]) - 1) // 2 if len(sides) == 1 else len(sides[0]) * len(sides[1])


def _pose(transform):
    """The pose of a matrix of trimesh."""
    if transform is None:
        return Pose()
    matrix = np.asarray(transform, float)
    if matrix.shape != (4, 4):
        raise ValueError(f"transform must be (4, 4), got {matrix.shape}; pass a homogeneous matrix")
    return Pose.from_matrix(matrix)


def _normals(corners):
    """Unit normals of triangles; zeros of those without an area."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)


def _middle_of_overlap(polygon, triangle):
    """The mean corner of what two triangles of one plane have in common."""
    normal = _normals(triangle[None])[0]
    for start, end in zip(triangle, np.roll(triangle, -1, axis=0)):
        inside = (polygon - start) @ np.cross(normal, end - start)
        clipped = []
        for at, (corner, height) in enumerate(zip(polygon, inside)):
            before, height_before = polygon[at - 1], inside[at - 1]
            if (height >= 0) != (height_before >= 0):
                clipped.append(before + (corner - before) * height_before / (height_before - height))
            if height >= 0:
                clipped.append(corner)
        # By rounding, nothing may be left of a sliver.
        polygon = np.array(clipped) if clipped else polygon
    return polygon.mean(axis=0)


def _result(value, *parts):
    """A value alone, or with the parts that are wanted."""
    wanted = [part for is_wanted, part in parts if is_wanted]
    return (value, *wanted) if wanted else value
