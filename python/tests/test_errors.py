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


def detector():
    return nm.Detector(nm.Body(V, F, name="the two"), device=CPU)


NAN = np.full((6, 3), np.nan, np.float32)
configure = nm.research.configure


def geometry(query):
    own = detector()
    return own.geometry(own.query(query))


REFUSED = [
    (lambda: nm.Near(-1), nm.InvalidArgumentError, "distance must be finite and at least 0, got -1"),
    (lambda: nm.Near(np.nan), nm.InvalidArgumentError, "distance must be finite and at least 0, got NaN"),
    (lambda: nm.BodyPairs(first=0), nm.InvalidArgumentError, "first must be an integer from 1"),
    (lambda: nm.BodyDistances(-1), nm.InvalidArgumentError, "distance must be finite and at least 0, got -1"),
    (lambda: nm.BodyDistances(np.inf), nm.InvalidArgumentError, "distance must be finite and at least 0, got inf"),
    (lambda: nm.Continuous(min_separation=-1), nm.InvalidArgumentError, "min_separation must be finite and at least 0, got -1"),
    (lambda: configure(nm.Continuous(), solver="exact"), nm.InvalidArgumentError, 'has no solver "exact"; choose one of "certified"'),
    (lambda: configure(nm.Earliest(min_separation=1), solver="cubic-f64"), nm.InvalidArgumentError, '"cubic-f64" takes no'),
    (lambda: configure(nm.Discrete(), solver="certified"), nm.InvalidArgumentError, '"moller"'),
    (lambda: configure(nm.Discrete(adjacent=True), solver="moller"), nm.InvalidArgumentError, "adjacent"),
    (lambda: configure(nm.Discrete(only_crossing=True), solver="moller"), nm.InvalidArgumentError, "cannot tell triangles that cross"),
    (lambda: configure(nm.Discrete(), broad_phase="octree"), nm.InvalidArgumentError, '"tree", "tiles"'),
    (lambda: configure(nm.Distance(), broad_phase="tiles"), nm.InvalidArgumentError, "`tiles` cannot be used with a distance query"),
    (lambda: configure(nm.Near(1), rebuild="often"), nm.InvalidArgumentError, '"auto", "manual"'),
    (lambda: nm.Device("gpu"), nm.InvalidArgumentError, '"cuda"'),
    (lambda: nm.Device("cpu", gpu=0), nm.InvalidArgumentError, "threads for a CPU"),
    (lambda: nm.Device("cpu", memory_limit=0), nm.InvalidArgumentError, "memory_limit must be an integer from 1"),
    (lambda: nm.Device(gpu=0, stream=1), nm.InvalidArgumentError, "gpu or stream for a GPU"),
    (lambda: nm.Device(stream="mine"), nm.InvalidArgumentError, "stream must be a stream of CUDA, got str"),
    (lambda: nm.Body(V, F, kind="soft"), nm.InvalidArgumentError, '"rigid"'),
    (lambda: nm.Body(V[:, :2], F, name="flat"), nm.InvalidArgumentError, "vertices of flat of shape [6, 2]"),
    (lambda: nm.Body(V.astype(complex), F), nm.InvalidArgumentError, "complex128"),
    (lambda: nm.Body(V, F.astype(float)), nm.InvalidArgumentError, "three vertex indices"),
    (lambda: nm.Body(V, [[0, 1, -1]]), nm.InputError, "a mesh: face 0 corner 2 names vertex -1"),
    (lambda: nm.Body(V, [[0, 1, 6]]), nm.InputError, "corner 2 names vertex 6"),
    (lambda: nm.Body(NAN, F, name="nothing"), nm.InputError, "nothing: vertex 0 has x = NaN"),
    *(
        (lambda name=name, value=value: nm.Body(V, F, **{name: value}), nm.InvalidArgumentError, f"{name} must be an integer from")
        for name, value in [("mask", 2**32), ("mask", -(2**40)), ("mask", "x"), ("group", 1.5), ("environment", -1), ("environment", 2**80)]
    ),
    (lambda: nm.Continuous(max_iterations=-1), nm.InvalidArgumentError, "max_iterations must be an integer from 1 to 4294967295, got -1"),
    (lambda: nm.Earliest(max_iterations=0), nm.InvalidArgumentError, "max_iterations must be an integer from 1"),
    (lambda: detector().earliest(max_iterations=0), nm.InvalidArgumentError, "max_iterations must be an integer from 1"),
    (lambda: configure(nm.Continuous(max_iterations=9), solver="certified-f32"), nm.InvalidArgumentError, "certified-f32 without a minimum separation"),
    (lambda: nm.Continuous(tolerance=-1), nm.InvalidArgumentError, "tolerance must be finite and at least 0, got -1"),
    (lambda: nm.Earliest(tolerance=np.nan), nm.InvalidArgumentError, "tolerance must be finite and at least 0, got NaN"),
    (lambda: detector().continuous(tolerance=-1), nm.InvalidArgumentError, "tolerance must be finite and at least 0, got -1"),
    (lambda: nm.Continuous(min_separation=np.inf), nm.InvalidArgumentError, "min_separation must be finite and at least 0, got inf"),
    (lambda: detector().near(0), nm.InvalidArgumentError, "distance must be above 0, got 0, as no body has a thickness"),
    (lambda: nm.Device(gpu=-1), nm.InvalidArgumentError, "gpu must be an integer from 0"),
    (lambda: nm.Device("cuda", threads=2), nm.InvalidArgumentError, 'backend "cuda" takes no threads'),
    (lambda: nm.Device("cpu", threads=0), nm.InvalidArgumentError, "threads must be an integer from 1 to 1024, got 0"),
    (lambda: nm.Device("cpu", threads=-1), nm.InvalidArgumentError, "1024, got -1"),
    (lambda: nm.Device("cpu", threads=1025), nm.InvalidArgumentError, "1024, got 1025"),
    (lambda: nm.Scene([nm.Body(V, F)]), nm.InvalidArgumentError, "bodies must be Body objects, got list; use Scene(a, b), or Scene(*bodies)"),
    (lambda: nm.Detector([nm.Body(V, F)]), nm.InvalidArgumentError, "got list; use Detector(Scene(*bodies))"),
    (lambda: nm.Detector(nm.Body(V, F), nm.Discrete()), TypeError, "positional"),
    (lambda: detector().query(nm.Discrete), TypeError, "Query"),
    (lambda: detector().update({1: V}), nm.InvalidArgumentError, "body 1 is not in the scene"),
    (lambda: detector().update({0: V[:3]}), nm.NearmissError, "3"),
    (lambda: detector().update({0: (V, NAN)}), nm.InputError, "NaN"),
    (lambda: detector().update({0: (V, [[np.inf] * 3] * 6)}), nm.InputError, "inf"),
    (lambda: detector().update({0: nm.Pose()}), nm.InvalidArgumentError, "the two"),
    (lambda: detector().update({0: (V, nm.Pose())}), nm.InvalidArgumentError, "of type object"),
    (lambda: nm.Pose(rotation=(1, 2, 3)), nm.InvalidArgumentError, "a rotation of 3 numbers"),
    (lambda: nm.Pose(rotation=5), nm.InvalidArgumentError, "a rotation of shape []; give 4"),
    (lambda: nm.Pose(translation=[[0, 0, 1]]), nm.InvalidArgumentError, "a translation of shape [1, 3]; give 3"),
    (lambda: nm.Pose(translation="abc"), nm.InvalidArgumentError, "a translation of type <U3"),
    (lambda: nm.Pose(translation=(0, np.nan, 0)), nm.InputError, "NaN"),
    (lambda: nm.Pose(rotation=(1, 1, 1, 1)), nm.InputError, "the pose [1.0, 1.0, 1.0, 1.0]"),
    (lambda: nm.Pose(translation=(0, 0, 1e200)), nm.InputError, "2^480"),
    (lambda: detector().update({-1: V}), nm.InvalidArgumentError, "keys of inputs must be body numbers or names, got -1"),
    (lambda: detector().update({"0": V}), nm.InvalidArgumentError, 'no body is named "0"; choose one of "the two"'),
    (lambda: detector().update({0: [V, V]}), nm.InvalidArgumentError, "of shape [2, 6, 3]; give rows of three: shape (n, 3); both ends"),
    (lambda: detector().update({0: [nm.Pose(), nm.Pose()]}), nm.InvalidArgumentError, "positions of body 0 are a list of poses; give both ends"),
    (lambda: detector().update([V]), nm.InvalidArgumentError, "inputs must be a mapping from body numbers or names, got <class 'list'>"),
    (lambda: detector().prepare(V, [nm.Near(1)]), nm.InvalidArgumentError, "got <class 'numpy.ndarray'>"),
    (lambda: geometry(configure(nm.Discrete(), solver="moller")), nm.InvalidArgumentError, "solver moller, which may share no point; use"),
    (lambda: geometry(nm.Earliest()), nm.InvalidArgumentError, "an earliest query has no pairs of features or triangles; use"),
    (lambda: geometry(nm.Distance()), nm.InvalidArgumentError, "a distance query has no pairs of features or triangles; read"),
    (lambda: detector().submit(), nm.InvalidArgumentError, "prepare"),
    (lambda: detector().prepare({0: V.tolist()}, [nm.Near(1)]), nm.InvalidArgumentError, "cannot be read in place by a submission; give arrays that stay"),
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
            lambda: detector().update({0: points}),
            lambda: detector().update({0: (V, points)}),
            lambda: nm.Pose(translation=(0, bad, 0)),
            lambda: nm.self_intersections(points, F),
        ]:
            with pytest.raises(nm.InputError):
                make()
    for call in [lambda: nm.Body(V[:, :2], F), lambda: detector().update({5: V}), lambda: nm.Near(np.nan)]:
        with pytest.raises(nm.InvalidArgumentError):
            call()


@pytest.mark.parametrize("query", [nm.Discrete(), nm.Continuous(), nm.Earliest(), nm.Near(1), nm.Distance()])
def test_a_scene_without_bodies_answers_nothing(query):
    own = nm.Detector(nm.Scene(), device=CPU)
    for call in [lambda: own.query(query), lambda: own.step({}, query)]:
        found = call()
        assert own.summary(found)["contacts"] == 0
        assert getattr(found, "toi", None) is None or len(found.toi) == 0
    own.prepare({}, [query])
    own.submit()
    assert own.summary(own.collect(query))["contacts"] == 0 and own.on_device(query) is None
    own.rebuild(), own.plan(query)
    for _ in range(2):
        own.add(nm.Body(V, F, kind="rigid"))
    wanted = nm.Detector(nm.Scene(*[nm.Body(V, F, kind="rigid")] * 2), device=CPU)
    assert own.query(query).hash == wanted.query(query).hash


def test_a_mesh_that_lacks_a_part_of_its_file_warns(tmp_path):
    corners = "v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 2 0\n"
    path = tmp_path / "mesh.obj"
    for lines, count, text in [
        ("f 1 2 3 4\n", 2, "1 face was cut as a fan around the first corner; the first: face 0, with 4 corners, crosses itself"),
        ("f 1 2 3\nf 1 2\nf 1\n", 1, "2 faces were left out; the first: line 6"),
        ("f 1 2 3\ncurv 0 1 1 2\n", 1, "1 line was not read; the first: line 6"),
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


def test_nothing_moves_if_an_update_is_refused():
    own = detector()
    before = own.discrete().hash
    for call in [lambda: own.update({0: NAN}), lambda: own.step({0: NAN}, nm.Discrete()), lambda: own.update({0: V + 1, 1: V})]:
        with pytest.raises(nm.NearmissError):
            call()
        assert own.discrete().hash == before == own.step({}, nm.Discrete()).hash


def test_other_bodies_answer_as_before_if_an_update_is_refused():
    vertices, faces = sheet(10, lambda x, y: np.sin(30 * x) * 0.05)
    scene, near = nm.Scene(nm.Body(vertices, faces), nm.Body(vertices + 0.01, faces)), nm.Near(0.05)
    own, wanted = nm.Detector(scene), nm.Detector(scene)
    bad = vertices + 0.02
    bad[7, 1] = np.nan
    with pytest.raises(nm.InputError, match="vertex 7 has y"):
        own.step({1: bad}, near)
    found = own.step({0: vertices + 0.001}, near)
    assert len(found) > 0 and found.hash == wanted.step({0: vertices + 0.001}, near).hash


def test_a_scene_is_filled_after_its_first_query():
    vertices, faces = sheet(10, lambda x, y: np.sin(30 * x) * 0.05)
    own = nm.Detector(nm.Scene(nm.Body(vertices, faces)))
    assert len(own.step({0: vertices + 0.01}, nm.Near(0.05))) == 0
    own.add(nm.Body(vertices, faces))
    assert len(own.near(0.05)) > 0


def test_geometry_of_other_bodies_is_refused():
    vertices, faces = sheet(10, lambda x, y: np.sin(30 * x) * 0.05)
    found = nm.near(vertices, faces, 0.3)
    assert len(found) > 0
    with pytest.raises(nm.InvalidArgumentError):
        detector().geometry(found)


def moves():
    """Calls that move bodies, or may."""
    yield lambda own: own.update({0: V + np.float32([5, 5, 5])})
    yield lambda own: own.step({}, nm.Near(1))
    yield lambda own: own.prepare({0: V.copy()}, [nm.Near(1)])
    yield lambda own: own.add(nm.Body(V, F))
    yield lambda own: own.replace(0, nm.Body(V + 1, F))
    yield lambda own: (own.add(nm.Body(V, F)), own.remove(0))


@pytest.mark.parametrize("move", list(moves()))
def test_answers_of_before_are_refused(move):
    own = detector()
    found = own.near(1)
    for _ in range(2):
        assert len(own.geometry(found)) == len(found) == own.summary(found)["contacts"]
        own.near(0.5), own.discrete(), own.continuous(), own.distance()
        own.rebuild()
        own.plan(nm.Near(1))
        own.download_positions(0)
    move(own)
    for call in [own.geometry, own.summary]:
        with pytest.raises(nm.InvalidArgumentError, match="the answer was found before"):
            call(found)
    again = own.near(1)
    assert len(own.geometry(again)) == len(again)


def test_answers_of_a_submission_are_of_it():
    own, near = detector(), nm.Near(1)
    here = V.copy()
    own.prepare({0: here}, [near])
    found = own.collect(near)
    assert len(own.geometry(found)) == len(found)
    here[3:, 2] += 0.25
    own.submit()
    with pytest.raises(nm.InvalidArgumentError, match="found before"):
        own.geometry(found)
    later = own.collect(near)
    assert len(own.geometry(later)) == len(later) == own.summary(later)["contacts"]


def test_answers_of_another_detector_are_refused():
    found = detector().near(1)
    other = detector()
    for call in [other.geometry, other.summary]:
        with pytest.raises(nm.InvalidArgumentError, match="the answer is of another detector"):
            call(found)


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
    own.continuous()
    child = os.fork()
    if child == 0:
        # This ends it if it waits for ever.
        signal.alarm(60)
        try:
            own.continuous()
        except nm.InvalidArgumentError as error:
            os._exit(0 if "spawn" in str(error) else 2)
        finally:
            os._exit(1)
    assert os.waitpid(child, 0)[1] == 0


def test_what_would_be_lost_in_silence_is_refused():
    corners, faces = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], float), [[0, 1, 2]]
    masked = np.ma.masked_array(corners, mask=corners == 1)
    with pytest.raises(nm.InvalidArgumentError, match="masked numbers"):
        nm.Body(masked, faces)
    assert nm.Body(np.ma.masked_array(corners), faces).vertex_count == 3
    # Arrays that are read in place, too.
    soft, hard = nm.Body(corners, faces), nm.Body(corners + 5, faces, kind="rigid")
    detector = nm.Detector(nm.Scene(soft, hard))
    places, turns = np.ma.masked_array([[0.0, 0.0, 2.0]], mask=True), np.array([[0.0, 0.0, 0.0, 1.0]])
    for call in (
        lambda: detector.update({0: masked}),
        lambda: detector.update({0: (masked, masked)}),
        lambda: detector.update_poses([1], places, turns),
        lambda: detector.prepare_poses([1], places, turns, [nm.Discrete()]),
    ):
        with pytest.raises(nm.InvalidArgumentError, match="masked numbers"):
            call()
    detector.update({0: np.ma.masked_array(corners)})
    with pytest.raises(nm.InvalidArgumentError, match="group is 0"):
        nm.Body(corners, faces, group=0)
    detector = nm.Detector(nm.Body(corners, faces), device=nm.Device("cpu"))
    for answer in [detector.near(1), detector.distance(), detector.earliest]:
        answer = answer() if callable(answer) else answer
        with pytest.raises(nm.InvalidArgumentError, match="without triangle pairs|no pairs of features"):
            detector.curves(answer)
    with pytest.raises(nm.InvalidArgumentError, match="first contacts of the answer to a near query"):
        detector.first_contacts(detector.near(1))
    with pytest.raises(nm.InvalidArgumentError, match="answer to a distance query has no pairs"):
        detector.grouped(detector.distance(), 0)


def test_a_pose_keeps_its_numbers():
    turned = np.array([0.0, 0.0, 0.0, 1.0])
    pose = nm.Pose(turned)
    turned[:] = [1, 0, 0, 0]
    assert pose.rotation == (0, 0, 0, 1) and pose == nm.Pose()
