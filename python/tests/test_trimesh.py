"""The collision manager for trimesh: trimesh's own tests, and answers against FCL's manager."""

import os
from pathlib import Path

import numpy as np
import pytest

trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed: pip install trimesh")

import trimesh_own_tests as own  # noqa: E402
from trimesh.collision import DistanceData  # noqa: E402

import nearmiss  # noqa: E402
import nearmiss.trimesh  # noqa: E402

CPU = nearmiss.Device("cpu", threads=1)
SEEDS = range(8)


@pytest.fixture(autouse=True)
def own_manager_after_each_test():
    yield
    nearmiss.trimesh.uninstall()


@pytest.fixture
def fcl_manager():
    pytest.importorskip("fcl", reason="FCL is not installed: pip install python-fcl")
    return trimesh.collision.CollisionManager


# trimesh's own tests.


@pytest.mark.skipif("NEARMISS_TRIMESH_TESTS" not in os.environ, reason="NEARMISS_TRIMESH_TESTS names trimesh's tests/test_collision.py")
def test_the_tests_of_trimesh_pass():
    nearmiss.trimesh.install(CPU)
    assert own.run(Path(os.environ["NEARMISS_TRIMESH_TESTS"]).read_text()) == []


PLANTED = """
import generic as g
import fcl
class Test(g.unittest.TestCase):
    def test_one(self):
        for two in (2, 3):
            assert two == 3
    def test_two(self):
        assert fcl is not None and 2 + 2 == 4
        assert g.trimesh.collision.CollisionManager().in_collision_internal() is False
        assert g.get_mesh("unit_cube.STL").is_watertight
    def test_listed(self):
        g.get_mesh("other")
"""


@pytest.mark.parametrize(
    "change, fault",
    [
        (("", ""), None),
        (("2 + 2 == 4", "2 + 2 == 5"), "test_two: Traceback"),
        (("in (2, 3)", "in (3, 3)"), "two == 3 is listed (a reason), and holds"),
        (("assert two == 3", "pass"), "two == 3 is listed, and no test has it"),
        (('"other"', '"unit_cube.STL"'), "test_listed is listed (a reason), and holds"),
        (("def test_listed", "def listed"), "test_listed is listed, and no test has it"),
    ],
)
def test_faults_are_noticed(change, fault, monkeypatch):
    monkeypatch.setattr(own, "LISTED", {"two == 3": "a reason", "test_listed": "a reason"})
    nearmiss.trimesh.install(CPU)
    found = own.run(PLANTED.replace(*change))
    assert found == [] if fault is None else [one.startswith(fault) for one in found] == [True]


# Answers against FCL's manager.


def shapes():
    """Meshes that are not convex, and one that is."""
    yield trimesh.creation.torus(1.0, 0.3, major_sections=12, minor_sections=7)
    yield trimesh.creation.annulus(0.3, 0.7, 0.5, sections=9)
    open_box = trimesh.creation.box((0.8, 0.9, 0.7))
    yield trimesh.Trimesh(open_box.vertices, open_box.faces[:-2], process=False)
    yield trimesh.creation.icosphere(subdivisions=1, radius=0.6)


def placed(seed, count, spread, prefix="0"):
    """Objects at random places: {name: (mesh, matrix)}."""
    random, meshes = np.random.default_rng(seed), list(shapes())
    objects = {}
    for number in range(count):
        matrix = trimesh.transformations.random_rotation_matrix(random.random(3))
        matrix[:3, 3] = spread * random.random(3)
        objects[f"{prefix}{number}"] = meshes[random.integers(len(meshes))], matrix
    return objects


def filled(manager, objects):
    """A manager with these objects."""
    for name, (mesh, matrix) in objects.items():
        manager.add_object(name, mesh)
        manager.set_transform(name, matrix)
    return manager


def ours(objects):
    return filled(nearmiss.trimesh.CollisionManager(CPU), objects)


@pytest.fixture
def theirs(fcl_manager):
    """FCL's manager, in which convex meshes are surfaces too."""

    class Surfaces(fcl_manager):
        def _get_fcl_obj(self, mesh):
            return trimesh.collision.mesh_to_BVH(mesh)

    return lambda objects: filled(Surfaces(), objects)


def test_fcl_sees_a_solid_where_we_see_a_surface(fcl_manager):
    inside = trimesh.creation.icosphere(radius=0.1), np.eye(4)
    around = {"around": (trimesh.creation.box(), np.eye(4))}
    assert filled(fcl_manager(), around).in_collision_single(*inside)
    assert not ours(around).in_collision_single(*inside)


# FCL rounds: its distances differ by this at most.
ROUNDING = 1e-7


@pytest.mark.parametrize("seed", SEEDS)
def test_answers_are_those_of_fcl(seed, theirs):
    first, second = placed(seed, 9, 4.0), placed(seed + 100, 4, 4.0, "other ")
    (mesh, matrix), = placed(seed + 200, 1, 4.0).values()
    managers = [(make(first), make(second)) for make in (ours, theirs)]
    for call in [
        lambda one, _: one.in_collision_internal(return_names=True),
        lambda one, _: one.in_collision_single(mesh, matrix, return_names=True),
        lambda one, other: one.in_collision_other(other, return_names=True),
        lambda one, other: other.in_collision_other(one, return_names=True),
        lambda one, _: one.in_collision_internal(),
        lambda one, _: one.in_collision_single(mesh, matrix),
        lambda one, other: one.in_collision_other(other),
    ]:
        answers = [call(*pair) for pair in managers]
        assert answers[0] == answers[1] and type(answers[0]) is type(answers[1])
    for call in [
        lambda one, _: one.min_distance_internal(),
        lambda one, _: one.min_distance_internal(name="03"),
        lambda one, _: one.min_distance_single(mesh, matrix),
        lambda one, other: one.min_distance_other(other),
    ]:
        answers = [call(*pair) for pair in managers]
        assert type(answers[0]) is float and answers[0] == pytest.approx(answers[1], abs=ROUNDING)


@pytest.mark.parametrize("seed", SEEDS)
def test_nearest_objects_are_those_of_fcl(seed, theirs):
    first, second = placed(seed, 5, 30.0), placed(seed + 100, 5, 30.0, "other ")
    (mesh, matrix), = placed(seed + 200, 1, 30.0).values()
    managers = [(make(first), make(second)) for make in (ours, theirs)]
    wanted = {"return_names": True, "return_data": True}
    for call in [
        lambda one, _: one.min_distance_internal(**wanted),
        lambda one, _: one.min_distance_internal("03", **wanted),
        lambda one, _: one.min_distance_single(mesh, matrix, return_name=True, return_data=True),
        lambda one, other: one.min_distance_other(other, **wanted),
    ]:
        (distance, names, data), (their_distance, their_names, _) = (call(*pair) for pair in managers)
        assert names == their_names and distance == pytest.approx(their_distance, abs=ROUNDING) and distance > 0
        assert isinstance(data, DistanceData) and data.distance == distance
        points = [data.point(name) for name in data.names]
        assert np.linalg.norm(points[0] - points[1]) == pytest.approx(distance, rel=1e-12)


# Laws.


@pytest.mark.parametrize("seed", SEEDS)
def test_answers_do_not_depend_on_history(seed):
    objects, others = placed(seed, 8, 3.0), placed(seed + 50, 8, 3.0)
    manager, fresh = ours(others), ours(objects)
    for answer in (manager.in_collision_internal, manager.min_distance_internal):
        answer()
    for name, (mesh, matrix) in objects.items():
        manager.add_object(name, mesh, matrix)
    for one in (manager, fresh):
        one.remove_object("05")
    with_names = {"return_names": True}
    assert manager.in_collision_internal(**with_names) == fresh.in_collision_internal(**with_names)
    hit, pairs = manager.in_collision_internal(**with_names)
    assert hit and not any("05" in pair for pair in pairs)
    mesh, matrix = objects["05"]
    assert manager.min_distance_single(mesh, matrix, return_name=True) == fresh.min_distance_single(mesh, matrix, return_name=True)
    hits = manager.in_collision_single(mesh, matrix, return_names=True)[1]
    manager.add_object("05", mesh, matrix)
    pairs = {pair for pair in manager.in_collision_internal(**with_names)[1] if "05" in pair}
    assert pairs == {tuple(sorted(("05", name))) for name in hits}


@pytest.mark.parametrize("seed", SEEDS)
def test_a_common_motion_changes_nothing(seed):
    objects = placed(seed, 8, 3.0)
    motion = trimesh.transformations.random_rotation_matrix(np.random.default_rng(seed).random(3))
    motion[:3, 3] = 1, -2, 3
    here, there = ours(objects), ours({name: (mesh, motion @ matrix) for name, (mesh, matrix) in objects.items()})
    assert here.in_collision_internal(return_names=True) == there.in_collision_internal(return_names=True)
    assert here.min_distance_internal("00") == pytest.approx(there.min_distance_internal("00"), abs=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_contacts_are_on_both_faces(seed):
    objects = placed(seed, 8, 2.0)
    objects["twin"] = objects["00"]
    hit, names, contacts = ours(objects).in_collision_internal(return_names=True, return_data=True)
    assert hit and {tuple(sorted(contact.names)) for contact in contacts} == names and ("00", "twin") in names
    for contact in contacts:
        normals = []
        for name in contact.names:
            mesh, matrix = objects[name]
            corners = trimesh.transform_points(mesh.vertices[mesh.faces[contact.index(name)]], matrix)
            nearest = trimesh.triangles.closest_point(corners[None], contact.point[None])[0]
            assert np.linalg.norm(nearest - contact.point) < 1e-9
            normals.append(np.cross(corners[1] - corners[0], corners[2] - corners[0]))
        assert any(np.allclose(contact.normal, normal / np.linalg.norm(normal)) for normal in normals)
    with pytest.raises(NotImplementedError, match="depth is not computed"):
        contacts[0].depth


def test_meshes_are_copied():
    mesh = trimesh.creation.torus(1.0, 0.3)
    manager = ours({"a": (mesh, np.eye(4))})
    before = manager.min_distance_single(mesh, trimesh.transformations.translation_matrix([9, 0, 0]))
    mesh.apply_scale(2)
    assert manager.min_distance_single(mesh, trimesh.transformations.translation_matrix([9, 0, 0])) < before
    assert ours({"a": (mesh, np.eye(4))}).in_collision_single(mesh)


def test_without_two_objects_nothing_is_near():
    mesh, empty = trimesh.creation.box(), ours({})
    for manager in (empty, ours({"a": (mesh, np.eye(4))})):
        assert manager.in_collision_internal(True, True) == (False, set(), [])
        assert manager.min_distance_internal(return_names=True, return_data=True) == (np.finfo(float).max, (None, None), None)
        assert manager.in_collision_other(empty, True) == (False, set())
    assert empty.in_collision_single(mesh) is False and empty.min_distance_single(mesh, return_name=True) == (np.finfo(float).max, None)


def test_trimesh_uses_it_when_installed():
    before = trimesh.collision.CollisionManager
    with nearmiss.trimesh.install(CPU):
        scene = trimesh.Scene([trimesh.creation.torus(1.0, 0.3), trimesh.creation.torus(1.0, 0.3)])
        manager, objects = trimesh.collision.scene_to_collision(scene)
        assert isinstance(manager, nearmiss.trimesh.CollisionManager) and len(objects) == 2
        assert manager.in_collision_internal()
    assert trimesh.collision.CollisionManager is before


def test_refusals_name_the_fault():
    mesh, manager = trimesh.creation.box(), nearmiss.trimesh.CollisionManager(CPU)
    manager.add_object("a", mesh)
    for call in (manager.remove_object, lambda name: manager.set_transform(name, np.eye(4)), manager.min_distance_internal):
        with pytest.raises(ValueError, match="name must be that of an object of the manager, got 'b'"):
            call("b")
    for matrix, fault in [
        (np.eye(3), r"transform must be \(4, 4\), got \(3, 3\)"),
        (np.full((4, 4), np.nan), "NaN"),
        (np.diag([2, 2, 2, 1.0]), "scales by 2"),
    ]:
        for call in [
            lambda m: manager.add_object("b", mesh, m),
            lambda m: manager.set_transform("a", m),
            lambda m: manager.in_collision_single(mesh, m),
        ]:
            with pytest.raises(ValueError, match=fault):
                call(matrix)
    assert list(manager._objs) == ["a"] and manager.in_collision_single(mesh)
    broken = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, np.inf, 0]], [[0, 1, 2]], process=False)
    with pytest.raises(nearmiss.InputError, match="vertex 2"):
        manager.in_collision_single(broken)
    with pytest.raises(AttributeError):
        manager.add_object("c", "a mesh")
