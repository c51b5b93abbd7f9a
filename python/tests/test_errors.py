"""Refusals: what they are called, and what their sentence names."""

import os
import signal
import warnings

import numpy as np
import pytest
from shapes import sheet, two_triangles

import nearmiss as nm

V, F = two_triangles()
CPU = nm.Device("cpu", threads=1)


def detector(query=None):
    return nm.Detector(nm.Body(V, F, name="the two"), query or nm.Continuous(), CPU)


NAN = np.full((6, 3), np.nan, np.float32)

def geometry(query):
    asked = detector(query)
    return asked.geometry(asked.detect())


REFUSED = [
    (lambda: nm.Near(0), nm.InvalidArgumentError, "a distance of 0"),
    (lambda: nm.Near(np.nan), nm.InvalidArgumentError, "a distance of NaN"),
    (lambda: nm.Continuous(separation=-1), nm.InvalidArgumentError, "separation"),
    (lambda: nm.Continuous(solver="exact"), nm.InvalidArgumentError, '"certified"'),
    (lambda: nm.Earliest(solver="cubic-f64", separation=1), nm.InvalidArgumentError, "cubic-f64"),
    (lambda: nm.Discrete(solver="certified"), nm.InvalidArgumentError, '"moller"'),
    (lambda: nm.Discrete(solver="moller", adjacent=True), nm.InvalidArgumentError, "adjacent"),
    (lambda: nm.Discrete(broad="octree"), nm.InvalidArgumentError, '"tree", "tiles"'),
    (lambda: nm.Discrete(broad="tree", order="median"), nm.InvalidArgumentError, "order of tiles for trees"),
    (lambda: nm.Device("gpu"), nm.InvalidArgumentError, '"cuda"'),
    (lambda: nm.Device("cpu", gpu=0), nm.InvalidArgumentError, "threads for a CPU"),
    (lambda: nm.Device(gpu=0, stream=1), nm.InvalidArgumentError, "a stream is of the GPU"),
    (lambda: nm.Device(stream="mine"), nm.InvalidArgumentError, "a stream of type str"),
    (lambda: nm.Body(V, F, kind="soft"), nm.InvalidArgumentError, '"rigid"'),
    (lambda: nm.Body(V[:, :2], F, name="flat"), nm.InvalidArgumentError, "vertices of flat of shape [6, 2]"),
    (lambda: nm.Body(V.astype(complex), F), nm.InvalidArgumentError, "complex128"),
    (lambda: nm.Body(V, F.astype(float)), nm.InvalidArgumentError, "three vertex indices"),
    (lambda: nm.Body(V, [[0, 1, -1]]), nm.InputError, "a mesh: face 0 corner 2 names vertex -1"),
    (lambda: nm.Body(V, [[0, 1, 6]]), nm.InputError, "corner 2 names vertex 6"),
    (lambda: nm.Body(NAN, F, name="nothing"), nm.InputError, "nothing: vertex 0 has x = NaN"),
    *(
        (lambda name=name, value=value: nm.Body(V, F, **{name: value}), nm.InvalidArgumentError, f"{name} = {value!r}; give an integer from")
        for name, value in [("mask", 2**32), ("mask", -(2**40)), ("mask", "x"), ("group", 1.5), ("environment", -1), ("environment", 2**80)]
    ),
    (lambda: nm.Continuous(budget=-1), nm.InvalidArgumentError, "budget = -1; give an integer from 1"),
    (lambda: nm.Earliest(budget=0), nm.InvalidArgumentError, "budget = 0; give an integer from 1"),
    (
        lambda: nm.Detector(nm.Body(V, F), nm.Continuous(budget=9, solver="certified-f32"), CPU),
        nm.InvalidArgumentError,
        "a budget of boxes for certified-f32 without a separation",
    ),
    (lambda: nm.Continuous(tolerance=-1), nm.InvalidArgumentError, "tolerance = -1; give a length from 0"),
    (lambda: nm.Earliest(tolerance=np.nan), nm.InvalidArgumentError, "tolerance = NaN; give a length from 0"),
    (lambda: nm.Continuous(separation=np.inf), nm.InvalidArgumentError, "separation = inf; give a length from 0"),
    (lambda: nm.Device(gpu=-1), nm.InvalidArgumentError, "gpu = -1; give an integer from 0"),
    (lambda: nm.Device("cuda", threads=2), nm.InvalidArgumentError, "threads of a GPU, which takes none"),
    (lambda: nm.Device("cpu", threads=0), nm.InvalidArgumentError, "threads = 0; give an integer from 1 to 1024"),
    (lambda: nm.Device("cpu", threads=-1), nm.InvalidArgumentError, "threads = -1; give"),
    (lambda: nm.Device("cpu", threads=1025), nm.InvalidArgumentError, "threads = 1025; give"),
    (lambda: nm.Scene([nm.Body(V, F)]), nm.InvalidArgumentError, "a scene of <class 'list'>; give bodies: Scene(a, b), or Scene(*bodies)"),
    (lambda: nm.Detector([nm.Body(V, F)], nm.Discrete(), CPU), nm.InvalidArgumentError, "Detector(Scene(*bodies), query)"),
    (lambda: detector().frame({1: V}), nm.InvalidArgumentError, "body 1, which is not in the scene"),
    (lambda: detector().frame({0: V[:3]}), nm.NearmissError, "3"),
    (lambda: detector().frame({0: (V, NAN)}), nm.InputError, "NaN"),
    (lambda: detector().frame({0: (V, [[np.inf] * 3] * 6)}), nm.InputError, "inf"),
    (lambda: detector().frame({0: nm.Pose()}), nm.InvalidArgumentError, "the two"),
    (lambda: detector().frame({0: (V, nm.Pose())}), nm.InvalidArgumentError, "of type object"),
    (lambda: nm.Pose(rotation=(1, 2, 3)), nm.InvalidArgumentError, "a rotation of 3 numbers"),
    (lambda: nm.Pose(rotation=5), nm.InvalidArgumentError, "a rotation of shape []; give 4"),
    (lambda: nm.Pose(translation=[[0, 0, 1]]), nm.InvalidArgumentError, "a translation of shape [1, 3]; give 3"),
    (lambda: nm.Pose(translation="abc"), nm.InvalidArgumentError, "a translation of type <U3"),
    (lambda: nm.Pose(translation=(0, np.nan, 0)), nm.InputError, "NaN"),
    (lambda: nm.Pose(rotation=(1, 1, 1, 1)), nm.InputError, "the pose [1.0, 1.0, 1.0, 1.0]"),
    (lambda: nm.Pose(translation=(0, 0, 1e200)), nm.InputError, "2^480"),
    (lambda: detector().frame({-1: V}), nm.InvalidArgumentError, "body -1, which is no number of one"),
    (lambda: detector().frame({"0": V}), nm.InvalidArgumentError, "body '0', which is no number of one"),
    (lambda: detector().frame({0: [V, V]}), nm.InvalidArgumentError, "of shape [2, 6, 3]; give rows of three: shape (n, 3); both ends"),
    (lambda: detector().frame({0: [nm.Pose(), nm.Pose()]}), nm.InvalidArgumentError, "a list of poses; give both ends"),
    (lambda: detector().frame([V]), nm.InvalidArgumentError, "inputs of type <class 'list'>; give a dictionary"),
    (lambda: detector().prepare(V), nm.InvalidArgumentError, "inputs of type <class 'numpy.ndarray'>"),
    (lambda: detector().detect().distances, nm.InvalidArgumentError, "contacts in time"),
    (lambda: detector(nm.Discrete()).detect().toi, nm.InvalidArgumentError, "triangle pairs"),
    (lambda: detector(nm.Earliest()).detect().indices, nm.InvalidArgumentError, "one time"),
    (lambda: geometry(nm.Discrete()), nm.InvalidArgumentError, "a discrete query, which has no pairs of features; use"),
    (lambda: geometry(nm.Earliest()), nm.InvalidArgumentError, "an earliest query, which has no pairs of features; use"),
    (lambda: geometry(nm.Distance()), nm.InvalidArgumentError, "a distance query, which has no pairs of features; read"),
    (lambda: detector(nm.Near(1)).detect().earliest, nm.InvalidArgumentError, "near pairs"),
    (lambda: detector().submit(), nm.InvalidArgumentError, "prepare"),
    (lambda: detector().prepare({0: V.tolist()}), nm.InvalidArgumentError, "arrays that stay"),
    (lambda: nm.read_mesh("no such file.ply"), nm.InputError, "no such file.ply"),
]


@pytest.mark.parametrize("wrong", REFUSED, ids=lambda wrong: wrong[2] or None)
def test_what_is_wrong_is_named(wrong):
    call, kind, text = wrong
    with pytest.raises(kind) as told:
        call()
    assert text in str(told.value)


def test_classes_say_who_must_act():
    assert issubclass(nm.InputError, ValueError) and issubclass(nm.OutOfMemory, MemoryError)
    assert all(issubclass(kind, nm.NearmissError) for kind in [nm.InvalidArgumentError, nm.DeviceError, nm.Bug])


def test_the_same_fault_is_of_one_class_wherever_it_is_given():
    """Data is InputError, an argument is InvalidArgumentError; by hand, in a scene, in a frame."""
    for bad in [-1, 6, 2**40, -(2**40)]:
        for make in [lambda: nm.Body(V, [[0, 1, bad]]), lambda: nm.self_intersections(V, np.array([[0, bad, 1]]))]:
            with pytest.raises(nm.InputError, match=f"names vertex {bad}"):
                make()
    for bad in [np.nan, np.inf, 1e200]:
        points = V.astype(float)
        points[0, 1] = bad
        for make in [
            lambda: nm.Body(points, F),
            lambda: detector().frame({0: points}),
            lambda: detector().frame({0: (V, points)}),
            lambda: nm.Pose(translation=(0, bad, 0)),
            lambda: nm.self_intersections(points, F),
        ]:
            with pytest.raises(nm.InputError):
                make()
    for call in [lambda: nm.Body(V[:, :2], F), lambda: detector().frame({5: V}), lambda: nm.Near(np.nan)]:
        with pytest.raises(nm.InvalidArgumentError):
            call()


@pytest.mark.parametrize("query", [nm.Discrete(), nm.Continuous(), nm.Earliest(), nm.Near(1), nm.Distance()])
def test_a_scene_without_bodies_answers_nothing(query):
    asked = nm.Detector(nm.Scene(), query, CPU)
    for ask in [asked.detect, asked.frame, lambda: asked.frame({}), lambda: asked.prepare({})]:
        found = ask()
        assert len(found) == 0
        assert asked.summary(found)["contacts"] == 0
    asked.submit()
    assert len(asked.collect()) == 0
    asked.rebuild(), asked.plan()
    for _ in range(2):
        asked.add(nm.Body(V, F, kind="rigid"))
    wanted = nm.Detector(nm.Scene(*[nm.Body(V, F, kind="rigid")] * 2), query, CPU)
    assert asked.detect().hash == wanted.detect().hash


def test_a_mesh_that_lacks_a_part_of_its_file_warns(tmp_path):
    corners = "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\n"
    path = tmp_path / "mesh.obj"
    for lines, count, text in [
        ("f 1 2 3 4\n", 2, "1 face was cut as a fan around the first corner; the first: face 0, with 4 corners, crosses itself"),
        ("f 1 2 3\nf 1 2\nf 1\n", 1, "2 faces were left out; the first: line 6"),
        ("f 1 2 3\nl 1 2\n", 1, "1 line was not read; the first: line 6"),
        ("f 1 2 3\nfoo\n", 1, "1 line was skipped; the first: line 6"),
    ]:
        path.write_text(corners + lines)
        with pytest.warns(nm.MeshWarning) as told:
            _, faces = nm.read_mesh(path)
        assert len(faces) == count and len(told) == 1
        assert str(told[0].message).startswith(f"{path}: {text}")
        with pytest.raises(nm.InputError):
            nm.read_mesh(path, strict=True)
    path.write_bytes(b"\xef\xbb\xbf" + corners.encode() + b"f 1 2 3\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(nm.read_mesh(path)[0]) == len(nm.read_mesh(path, strict=True)[0]) == 4


def test_nothing_moves_where_a_frame_is_refused():
    asked = detector(nm.Discrete())
    before = asked.detect().hash
    with pytest.raises(nm.InputError):
        asked.frame({0: NAN})
    assert asked.detect().hash == before and asked.frame().hash == before


def test_other_bodies_answer_as_before_where_a_frame_is_refused():
    vertices, faces = sheet(10, lambda x, y: np.sin(30 * x) * 0.05)
    scene = nm.Scene(nm.Body(vertices, faces), nm.Body(vertices + 0.01, faces))
    asked, wanted = nm.Detector(scene, nm.Near(0.05)), nm.Detector(scene, nm.Near(0.05))
    bad = vertices + 0.02
    bad[7, 1] = np.nan
    with pytest.raises(nm.InputError, match="vertex 7 has y"):
        asked.frame({1: bad})
    found = asked.frame({0: vertices + 0.001})
    assert len(found) > 0 and found.hash == wanted.frame({0: vertices + 0.001}).hash


def test_a_scene_is_filled_after_its_first_frame():
    vertices, faces = sheet(10, lambda x, y: np.sin(30 * x) * 0.05)
    asked = nm.Detector(nm.Scene(nm.Body(vertices, faces)), nm.Near(0.05))
    assert len(asked.frame({0: vertices + 0.01})) == 0
    asked.add(nm.Body(vertices, faces))
    assert len(asked.detect()) > 0


def test_geometry_of_other_bodies_is_refused():
    vertices, faces = sheet(10, lambda x, y: np.sin(30 * x) * 0.05)
    found = nm.near(vertices, faces, 0.3)
    assert len(found) > 0
    with pytest.raises(nm.InvalidArgumentError):
        detector(nm.Near(0.3)).geometry(found)


def moves():
    """What moves bodies, or may."""
    yield lambda asked: asked.frame({0: V + np.float32([5, 5, 5])})
    yield lambda asked: asked.frame()
    yield lambda asked: asked.prepare({0: V.copy()})
    yield lambda asked: asked.add(nm.Body(V, F))
    yield lambda asked: asked.replace(0, nm.Body(V + 1, F))
    yield lambda asked: (asked.add(nm.Body(V, F)), asked.remove(0))


@pytest.mark.parametrize("move", list(moves()))
def test_contacts_of_before_are_refused(move):
    asked = detector(nm.Near(1))
    found = asked.detect()
    for _ in range(2):
        assert len(asked.geometry(found)) == len(found) == asked.summary(found)["contacts"]
        asked.detect()
        asked.rebuild()
        asked.plan()
    move(asked)
    for ask in [asked.geometry, asked.summary]:
        with pytest.raises(nm.InvalidArgumentError, match="contacts that were found before"):
            ask(found)
    again = asked.detect()
    assert len(asked.geometry(again)) == len(again)


def test_contacts_of_a_submission_are_of_it():
    asked = detector(nm.Near(1))
    here = V.copy()
    found = asked.prepare({0: here})
    assert len(asked.geometry(found)) == len(found)
    here[3:, 2] += 0.25
    asked.submit()
    with pytest.raises(nm.InvalidArgumentError, match="found before"):
        asked.geometry(found)
    later = asked.collect()
    assert len(asked.geometry(later)) == len(later) == asked.summary(later)["contacts"]


def test_contacts_of_another_detector_are_refused():
    found = detector(nm.Near(1)).detect()
    other = detector(nm.Near(1))
    for ask in [other.geometry, other.summary]:
        with pytest.raises(nm.InvalidArgumentError, match="contacts of another detector"):
            ask(found)


def test_no_gpu_says_so():
    try:
        device = nm.Device("cuda")
    except nm.DeviceError as error:
        assert "CPU" in str(error)
    else:
        assert device.backend == "cuda" and device.gpu == 0


@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
def test_a_forked_process_is_told():
    own = detector()
    own.detect()
    child = os.fork()
    if child == 0:
        # Where it waits for ever this ends it.
        signal.alarm(60)
        try:
            own.detect()
        except nm.InvalidArgumentError as error:
            os._exit(0 if "spawn" in str(error) else 2)
        finally:
            os._exit(1)
    assert os.waitpid(child, 0)[1] == 0
