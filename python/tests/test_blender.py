"""The extension for Blender, in Blender: selections against Blender's own search and other queries.

Blender is the package bpy. The package of the extension is installed by Blender itself.
"""

import importlib.util
import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from shapes import soup

import nearmiss

bpy = pytest.importorskip("bpy", reason="Blender is not installed: pip install bpy")

import bmesh  # noqa: E402
from mathutils.bvhtree import BVHTree  # noqa: E402

FOLDER = Path(__file__).parent.parent / "blender"
SQUARE = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0]], float)
WALL = np.array([[1, 1, -1], [1, 5, -1], [1, 5, 1], [1, 1, 1]], float)
"""Crosses the square, in its middle."""


@pytest.fixture(scope="module", autouse=True)
def extension():
    spec = importlib.util.spec_from_file_location("nearmiss_blender", FOLDER / "__init__.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.register()
    yield module
    module.unregister()


@pytest.fixture(autouse=True)
def empty_file():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def add(name, vertices, faces, mesh=None):
    """An object of the scene, selected and active."""
    if mesh is None:
        mesh = bpy.data.meshes.new(name)
        faces = [list(map(int, face)) for face in faces]
        mesh.from_pydata(np.asarray(vertices).tolist(), [], faces)
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(thing)
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    return thing


def squares(name="mesh", wall=WALL):
    """A mesh of two quads."""
    return add(name, np.concatenate([SQUARE, wall]), [[0, 1, 2, 3], [4, 5, 6, 7]])


def select(**options):
    """The lines of the report; the mesh is in edit mode after it."""
    assert bpy.ops.mesh.nearmiss_select(**options) == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH"
    assert tuple(bpy.context.tool_settings.mesh_select_mode) == (False, False, True)
    return bpy.context.window_manager.nearmiss.report.splitlines()


def selected(thing):
    """Selected faces, as edit mode has them; vertices and edges are those of the faces."""
    rows = bmesh.from_edit_mesh(thing.data)
    faces = [face for face in rows.faces if face.select]
    assert {v for v in rows.verts if v.select} == {v for face in faces for v in face.verts}
    assert {e for e in rows.edges if e.select} == {e for face in faces for e in face.edges}
    return [face.index for face in faces]


def random_mesh(seed, sides=3, size=0.8):
    """Polygons in space that share no vertex, each in a plane."""
    vertices, _ = soup(60, seed, size)
    if sides == 4:
        corners = vertices.reshape(-1, 3, 3)
        fourth = corners[:, [0]] + corners[:, [2]] - corners[:, [1]]
        vertices = np.concatenate([corners, fourth], axis=1).reshape(-1, 3)
    return vertices.astype(np.float32), np.arange(len(vertices)).reshape(-1, sides)


def blender_pairs(vertices, faces):
    """Pairs of faces that cross, by the search of Blender; faces share no vertex."""
    tree = BVHTree.FromPolygons(np.asarray(vertices).tolist(), faces.tolist())
    return {tuple(sorted(pair)) for pair in tree.overlap(tree) if pair[0] != pair[1]}


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("sides", [3, 4])
def test_crossing_faces_are_those_that_blender_finds(seed, sides):
    vertices, faces = random_mesh(seed, sides)
    thing = add("soup", vertices, faces)
    pairs = blender_pairs(vertices, faces)
    found = sorted({face for pair in pairs for face in pair})
    assert len(pairs) > 20 and len(found) > 20
    lines = select()
    assert selected(thing) == found
    assert lines == [f"{len(pairs)} crossing pairs", f"soup: {len(found)} faces"]


@pytest.mark.parametrize("wrong", ["polygon_index", "value", "vertices"])
def test_a_wrong_column_is_noticed(extension, monkeypatch, wrong):
    right = extension.column

    def column(rows, name, *shape):
        return np.roll(right(rows, name, *shape), name == wrong, axis=0)

    monkeypatch.setattr(extension, "column", column)
    vertices, faces = random_mesh(0, size=0.4)
    thing = add("soup", vertices, faces)
    select()
    pairs = blender_pairs(vertices, faces)
    assert selected(thing) != sorted({face for pair in pairs for face in pair})


@pytest.mark.parametrize("seed", range(5))
def test_several_objects_are_tested_where_they_are_in_the_world(seed):
    random = np.random.default_rng(seed)
    things, all_vertices = [], []
    for number in range(3):
        vertices, faces = random_mesh(10 * seed + number)
        thing = add(f"soup {number}", vertices, faces)
        thing.location, thing.rotation_euler = random.normal(0, 0.3, 3), random.normal(0, 2, 3)
        thing.scale = random.uniform(0.5, 2, 3)
        bpy.context.view_layer.update()
        things.append(thing)
        all_vertices.append([thing.matrix_world @ v.co for v in thing.data.vertices])
    everything = np.array(sum(all_vertices, []))
    pairs = blender_pairs(everything, np.arange(len(everything)).reshape(-1, 3))
    found = np.array(sorted({face for pair in pairs for face in pair}))
    assert select(others=True)[0] == f"{len(pairs)} crossing pairs"
    for number, thing in enumerate(things):
        assert selected(thing) == (found[found // 60 == number] % 60).tolist()


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("distance", [0.02, 0.06])
def test_near_faces_are_those_whose_distance_is_small(seed, distance):
    vertices, faces = random_mesh(seed, size=0.4)
    scene = nearmiss.Scene()
    for face in faces:
        scene.add(nearmiss.Body(vertices[face].astype(float), [[0, 1, 2]], kind="rigid"))
    apart = nearmiss.Detector(scene, device=nearmiss.Device("cpu")).body_distances(distance)
    thing = add("soup", vertices, faces)
    select(test="NEAR", distance=distance)
    assert selected(thing) == np.unique(apart.bodies).tolist()
    crossing = len(np.unique(apart.bodies[apart.distances == 0]))
    assert crossing < len(selected(thing))


def test_a_distance_is_one_of_the_world():
    thing = squares(wall=WALL + [0, 0, 1.25])
    assert select(test="NEAR", distance=0.26) and selected(thing) == [0, 1]
    assert select(test="NEAR", distance=0.24) and selected(thing) == []
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.scale = 2, 2, 2
    assert select(test="NEAR", distance=0.49) and selected(thing) == []
    assert select(test="NEAR", distance=0.51) and selected(thing) == [0, 1]


def test_a_face_that_is_pierced_far_from_its_border_is_near():
    thing = add("needle", [*(100 * SQUARE), *WALL[:3]], [[0, 1, 2, 3], [4, 5, 6]])
    thing.data.vertices[4].co = thing.data.vertices[5].co = 100, 80, -20
    thing.data.vertices[5].co.x += 1
    thing.data.vertices[6].co = 100, 80, 20
    select(test="NEAR", distance=0.01)
    assert selected(thing) == [0, 1]


def test_touching_is_a_choice():
    thing = squares(wall=WALL + [0, 0, 1])
    assert select() == ["0 crossing pairs", "mesh: 0 faces"] and selected(thing) == []
    assert select(test="TOUCHING") == ["1 crossing or touching pair", "mesh: 2 faces"]
    assert selected(thing) == [0, 1]


def test_neighbours_that_are_folded_on_each_other_touch():
    thing = add("fold", [[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 1, 0]], [[0, 1, 2], [0, 3, 1]])
    select(test="TOUCHING")
    assert selected(thing) == [0, 1]


def test_polygons_have_the_triangles_of_all_their_corners():
    turn = np.linspace(0, 2 * np.pi, 33)[:-1]
    disc = np.stack([3 * np.cos(turn), 3 * np.sin(turn), 0 * turn], axis=1)
    # A star is concave: a wall in a notch does not cross it.
    star = disc * np.where(np.arange(32) % 2, 0.3, 1)[:, None] + [9, 0, 0]
    notch = (disc[1] * 0.9 + [9, 0, 0]) + [[0, 0, -1], [0.01, 0, -1], [0, 0, 1]]
    inside = [[-1, 0, -1], [-1.1, 0, -1], [-1, 0, 1]]
    faces = [list(range(32)), list(range(32, 64)), [64, 65, 66], [67, 68, 69]]
    thing = add("polygons", np.concatenate([disc, star, notch, inside]), faces)
    assert select()[0] == "1 crossing pair"
    assert selected(thing) == [0, 3]


def simple_subdivision(thing):
    modifier = thing.modifiers.new("subdivision", "SUBSURF")
    modifier.subdivision_type, modifier.levels = "SIMPLE", 3


def array_far_away(thing):
    modifier = thing.modifiers.new("array", "ARRAY")
    modifier.use_relative_offset, modifier.use_constant_offset = False, True
    modifier.count, modifier.constant_offset_displace = 4, (90, 0, 0)


@pytest.mark.parametrize("modify", [simple_subdivision, array_far_away])
@pytest.mark.parametrize("seed", range(3))
def test_faces_of_modifiers_lead_to_their_sources(modify, seed):
    thing = add("soup", *random_mesh(seed, 4))
    select()
    alone = selected(thing)
    bpy.ops.object.mode_set(mode="OBJECT")
    modify(thing)
    select()
    assert selected(thing) == alone and 10 < len(alone)


def test_what_only_modifiers_make_cross_is_found():
    thing = add("wall", WALL, [[0, 1, 2, 3]])
    assert select()[0] == "0 crossing pairs"
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.data.vertices[0].co.x = -1
    modifier = thing.modifiers.new("mirror", "MIRROR")
    modifier.use_mirror_merge = False
    assert select() == ["1 crossing pair", "wall: 2 faces"]
    assert selected(thing) == [0]


def test_faces_without_a_source_are_counted():
    thing = squares()
    modifier = thing.modifiers.new("remesh", "REMESH")
    modifier.mode, modifier.voxel_size = "VOXEL", 0.2
    modifier = thing.modifiers.new("array", "ARRAY")
    modifier.relative_offset_displace = (0.1, 0, 0)
    line = re.fullmatch(r"mesh: ([\d,]+) faces, \1 that cannot be selected", select()[1])
    assert len(line[1]) > 1 and selected(thing) == []


def test_hidden_faces_are_counted_and_stay_hidden():
    thing = squares()
    thing.data.polygons[1].hide = True
    assert select() == ["1 crossing pair", "mesh: 2 faces, 1 hidden"]
    assert selected(thing) == [0]
    assert [face.hide for face in bmesh.from_edit_mesh(thing.data).faces] == [False, True]


def test_changes_of_edit_mode_count():
    thing = squares()
    select()
    rows = bmesh.from_edit_mesh(thing.data)
    for vertex in rows.verts[4:]:
        vertex.co.z += 9
    bmesh.update_edit_mesh(thing.data)
    assert select()[0] == "0 crossing pairs" and selected(thing) == []


def test_objects_that_are_not_tested_have_no_face_selected():
    other, thing = squares("other"), squares("mesh")
    for polygon in other.data.polygons:
        polygon.select = True
    assert select() == ["1 crossing pair", "mesh: 2 faces"]
    assert selected(thing) == [0, 1]
    assert other.mode == "EDIT" and selected(other) == []


def test_objects_may_share_a_mesh():
    first = squares("first", WALL + [9, 0, 0])
    second = add("second", None, None, first.data)
    second.location = -9, 0, 0
    bpy.context.view_layer.update()
    # The wall of the second crosses the square of the first.
    lines = select(others=True)
    assert lines == ["1 crossing pair", "second: 1 face", "first: 1 face"]
    assert selected(second) == [0, 1]


def test_surfaces_of_curves_are_tested_too():
    thing = squares(wall=WALL + [0, 0, 9])
    bpy.ops.curve.primitive_bezier_circle_add(location=(1, 0, 0))
    curve = bpy.context.object
    curve.data.bevel_depth = 0.1
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing
    lines = select(others=True)
    assert re.fullmatch(r"BézierCircle: (\d+) faces, \1 that cannot be selected", lines[2])
    assert selected(thing) == [0] and curve.mode == "OBJECT"


def test_nothing_is_left_in_the_mesh():
    thing = squares()
    thing.data.attributes.new("nearmiss_source", "FLOAT", "POINT")
    before = {each.name for each in thing.data.attributes}
    assert select()[0] == "1 crossing pair"
    bpy.ops.object.mode_set(mode="OBJECT")
    after = {each.name for each in thing.data.attributes}
    assert all(name.startswith(".select") for name in after ^ before)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize(
    ("height", "distance", "message"),
    [
        (np.nan, 1, "mesh: vertex 3 has . = NaN"),
        (0, 0, "distance must be above 0, got 0"),
    ],
)
def test_a_refusal_is_reported_and_changes_nothing(mode, height, distance, message):
    thing = squares()
    count = len(thing.data.attributes)
    thing.data.vertices[3].co.z = height
    bpy.ops.object.mode_set(mode=mode)
    with pytest.raises(RuntimeError, match=message):
        bpy.ops.mesh.nearmiss_select(test="NEAR", distance=distance)
    assert thing.mode == mode
    bpy.ops.object.mode_set(mode="OBJECT")
    assert len(thing.data.attributes) == count


def test_meshes_without_faces_have_none_selected():
    thing = add("points", SQUARE, np.zeros((0, 3), int))
    for test in ("CROSSING", "TOUCHING", "NEAR"):
        assert select(test=test)[1] == "points: 0 faces" and selected(thing) == []


def test_without_an_active_mesh_the_operator_is_off():
    assert not bpy.ops.mesh.nearmiss_select.poll()
    bpy.ops.object.light_add()
    assert not bpy.ops.mesh.nearmiss_select.poll()
    thing = squares()
    assert bpy.ops.mesh.nearmiss_select.poll()
    bpy.ops.object.mode_set(mode="SCULPT")
    assert not bpy.ops.mesh.nearmiss_select.poll()
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.hide_set(True)
    assert not bpy.ops.mesh.nearmiss_select.poll()


# The packed file, installed by a Blender without anything else.

pack = runpy.run_path(str(FOLDER / "pack.py"))["pack"]
INSTALL = """
import importlib.machinery, sys
file, user = sys.argv[1:]

class Installed:
    # nearmiss of this environment does not count.
    def find_spec(name, path=None, target=None):
        if name == "nearmiss":
            folders = [folder for folder in sys.path if folder.startswith(user)]
            found = importlib.machinery.PathFinder.find_spec(name, folders)
            return found or sys.exit("no nearmiss")

sys.meta_path.insert(0, Installed)
import bpy
assert bpy.ops.extensions.package_install_files(
    filepath=file, repo="user_default", enable_on_install=True) == {"FINISHED"}
bpy.ops.mesh.primitive_monkey_add()
assert bpy.ops.mesh.nearmiss_select() == {"FINISHED"}
print(bpy.context.window_manager.nearmiss.report)
"""


def installed(packed, user):
    """What a Blender prints that installs a file, and has no other nearmiss."""
    return subprocess.run(
        [sys.executable, "-c", INSTALL, packed, user],
        env={**os.environ, "BLENDER_USER_RESOURCES": str(user)},
        capture_output=True,
        text=True,
    )


@pytest.mark.skipif("NEARMISS_WHEEL" not in os.environ, reason="NEARMISS_WHEEL names a wheel")
def test_blender_installs_the_packed_file(tmp_path):
    packed = pack([Path(os.environ["NEARMISS_WHEEL"])], tmp_path)
    done = installed(packed, tmp_path / "user")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "62 crossing pairs\nSuzanne: 52 faces" in done.stdout


def test_a_packed_file_without_a_wheel_is_noticed(tmp_path):
    done = installed(pack([], tmp_path), tmp_path / "user")
    assert done.returncode != 0 and "no nearmiss" in done.stderr
