"""Rigid bodies: steps and their paths, matrices, arrays of poses, names as keys."""

import numpy as np
import pytest
from shapes import sheet, soup, two_triangles

import nearmiss as nm

V, F = soup(40, 1)
CPU = nm.Device("cpu", threads=1)
NAMES = ["arm", "hand", "base"]
QUARTER = nm.Pose((0, 0, np.sqrt(0.5), np.sqrt(0.5)), (0.1, 0, 0))


def detector(**more):
    """Three rigid bodies of one mesh, and a sheet through them."""
    bodies = [nm.Body(V, F, kind="rigid", name=name, **more) for name in NAMES]
    vertices, faces = sheet(6, lambda x, y: 0.5 + 0 * x)
    return nm.Detector(nm.Scene(*bodies, nm.Body(vertices, faces, name="cloth")), device=CPU)


def turned(angle, *translation):
    """A pose about the axis (0.6, 0, 0.8)."""
    return nm.Pose((0.6 * np.sin(angle / 2), 0, 0.8 * np.sin(angle / 2), np.cos(angle / 2)), translation or (0, 0, 0))


def hashes(own):
    """Of the answers to all queries."""
    queries = [nm.Discrete(), nm.Continuous(), nm.Earliest(), nm.Near(0.05), nm.Distance()]
    queries += [nm.BodyPairs(), nm.BodyDistances(0.1)]
    return [own.query(query).hash for query in queries]


# A bar sweeps over a peg on its arc; on straight lines it is flattened on the way and does not.
BAR = nm.Body([[-2, 0, 0], [2, 0, 0], [0, 0.1, 0]], [[0, 1, 2]], kind="rigid", name="bar")
PEG = nm.Body([[0, 1.5, -1], [0.02, 1.5, 1], [-0.02, 1.5, 1]], [[0, 1, 2]], kind="fixed", name="peg")
HALF = nm.Pose((0, 0, 1, 0))


def sweep(step):
    return nm.Detector(nm.Scene(BAR, PEG), device=CPU).step({"bar": step}, nm.Continuous())


@pytest.mark.parametrize("step", [
    (nm.Pose(), HALF),
    nm.PoseStep(nm.Pose(), HALF),
    nm.PoseStep.turning(np.eye(4), (0, 0, np.pi)),
    nm.PoseStep.turning(nm.Pose(), (0, 0, np.radians(350))),
])
def test_a_step_turns(step):
    found = sweep(step)
    assert len(found) > 0 and {*map(tuple, found.names)} <= {("bar", "peg"), ("peg", "bar")}


def test_a_straight_step_does_not_turn():
    found = sweep(nm.PoseStep(nm.Pose(), HALF, straight=True))
    assert len(found) == 0 and any("turns by 180.0 degrees" in text for text in found.caveats)
    # Ten degrees back are far from the peg.
    back = nm.Pose((0, 0, np.sin(np.radians(-5)), np.cos(np.radians(5))))
    assert len(sweep((nm.Pose(), back))) == 0


def test_a_step_has_both_ends_and_its_path():
    step = nm.PoseStep(nm.Pose(), QUARTER, pivot=(0, 1, 2))
    assert (step.start, step.end, step.pivot, step.turn, step.straight) == (nm.Pose(), QUARTER, (0, 1, 2), None, False)
    straight = nm.PoseStep(nm.Pose(), QUARTER, straight=True)
    assert straight.straight and straight.pivot == (0, 0, 0) and straight != step
    turn = nm.PoseStep.turning(nm.Pose(), (0, 0, np.pi / 2), (0.25, 0, 0), pivot=(1, 0, 0))
    assert turn.turn == (0, 0, np.pi / 2) and turn.pivot == (1, 0, 0)
    # The pivot moves by a quarter, and the origin of the mesh turns about it.
    assert np.allclose(turn.end.matrix, [[0, -1, 0, 1.25], [1, 0, 0, -1], [0, 0, 1, 0], [0, 0, 0, 1]], atol=1e-15)
    own = detector()
    own.update({0: step})
    assert own.poses(0) == (nm.Pose(), QUARTER) and own.pose("arm") == nm.Pose()
    own.update({})
    assert own.poses("arm") == (QUARTER, QUARTER)


def test_a_pivot_and_a_path_reach_the_query():
    ends = turned(0.1), turned(1.3, 0.1, 0.2, 0)
    steps = [ends, nm.PoseStep(*ends, pivot=(9, 0, 0)), nm.PoseStep(*ends, straight=True)]
    assert len({detector().step({0: step}, nm.Continuous()).hash for step in steps}) == 3
    same = [detector().step({0: step}, nm.Continuous()).hash for step in [ends, nm.PoseStep(*ends)]]
    assert same[0] == same[1]


def test_a_matrix_is_a_pose():
    pose = turned(2.0, 1, -2, 3)
    matrix = pose.matrix
    assert matrix.shape == (4, 4) and matrix.dtype == np.float64 and (matrix[3] == [0, 0, 0, 1]).all()
    back = nm.Pose.from_matrix(matrix)
    assert np.allclose(back.rotation, pose.rotation, atol=1e-15) and back.translation == (1, -2, 3)
    assert nm.Pose.from_matrix(matrix[:3]) == back == nm.Pose.from_matrix(matrix.tolist())
    assert nm.Pose.from_matrix(np.eye(4, dtype=int)) == nm.Pose()
    single = nm.Pose.from_matrix(matrix.astype(np.float32))
    assert np.allclose(single.rotation, pose.rotation, atol=1e-7) and single != back
    far = np.eye(4)
    far[:3, 3] = 0.1, 0.2, 0
    wanted = detector()
    wanted.update({0: back, 1: (back, nm.Pose(translation=far[:3, 3])), 2: nm.PoseStep(back, nm.Pose())})
    for kind in [np.asarray, np.ndarray.tolist, lambda m: m[:3]]:
        own = detector()
        own.update({0: kind(matrix), 1: (kind(matrix), kind(far)), 2: nm.PoseStep(kind(matrix), kind(np.eye(4)))})
        assert hashes(own) == hashes(wanted)
        own.update({1: (back, kind(far))})
        assert own.poses(1) == (back, nm.Pose(translation=far[:3, 3]))


def test_a_body_begins_in_its_pose():
    for pose in [QUARTER, QUARTER.matrix]:
        body = nm.Body(V, F, kind="rigid", pose=pose)
        assert np.allclose(body.pose.matrix, QUARTER.matrix, atol=1e-15)
        assert nm.Detector(body, device=CPU).pose(0) == body.pose
    assert nm.Body(V, F, kind="rigid").pose == nm.Pose() and nm.Body(V, F).pose is None


@pytest.mark.parametrize("kind", [np.float64, np.float32])
def test_arrays_move_many_bodies(kind):
    ids, ends = [2, "arm"], [[turned(0.3, 0.1, 0, 0), turned(-0.4)], [turned(0.5), turned(0.2, 0, 0.3, 0)]]
    columns = [np.array([list(getattr(pose, name)) for pose in of], kind) for of in ends for name in ("translation", "rotation")]
    p0, q0, p1, q1 = columns
    rounded = [[nm.Pose(q, p) for p, q in zip(*pair)] for pair in [(p0, q0), (p1, q1)]]
    own, each = detector(), detector()
    own.update_poses(ids, p0, q0, end_positions=p1, end_quaternions=q1)
    each.update({"base": (rounded[0][0], rounded[1][0]), 0: (rounded[0][1], rounded[1][1])})
    assert hashes(own) == hashes(each)
    assert own.poses("base") == (rounded[0][0], rounded[1][0]) and own.poses(1) == (nm.Pose(), nm.Pose())
    # Others rest, and so do these if no end is given: columns with gaps, lists.
    own.update_poses(np.array([2, 0]), np.repeat(p1, 2, axis=1)[:, ::2], q1.tolist())
    assert own.poses(2) == (rounded[1][0],) * 2 and own.poses(0) == (rounded[1][1],) * 2
    own.update_poses([], np.empty((0, 3)), np.empty((0, 4)))
    assert own.pose(0) == rounded[1][1]


def test_names_are_keys():
    scene = nm.Scene(*(nm.Body(V, F, kind="rigid", name=name) for name in NAMES + ["hand"]))
    assert scene["arm"] == scene.id("arm") == 0 and scene.id("base") == 2
    own = nm.Detector(scene, device=CPU)
    assert [own.name(k) for k in own.bodies] == NAMES + ["hand"] and own.id("arm") == 0
    own.update({"arm": QUARTER, 3: QUARTER})
    assert own.pose("arm") == own.pose(3) == QUARTER != own.pose("base")
    found = own.discrete()
    assert found.names.shape == found.bodies.shape and len(found) > 0
    assert all(own.name(int(body)) == name for body, name in zip(found.bodies.flat, found.names.flat))
    own.replace("arm", nm.Body(V, F, kind="rigid", name="leg"))
    own.remove("base")
    assert own.id("leg") == 0 and own.bodies == [0, 1, 3]
    # Names of an answer are those of its bodies then.
    assert "arm" in found.names and "leg" not in found.names
    assert "leg" in own.discrete().names and "arm" not in own.discrete().names
    assert own.near(0.05).names.shape[1] == 2 and own.distance().names.tolist() == ["leg", "hand"]
    assert own.download_positions("leg") == own.poses("leg")
    scene = nm.Scene(nm.Body(V, F, name="a"), nm.Body(V, F, name="b"))
    scene.remove("a")
    assert scene.bodies == [1]
    lone = nm.Detector(nm.Body(*two_triangles(), kind="rigid", name="lone"), device=CPU)
    assert lone.distance().names is None and lone.discrete().names.shape == (0, 2)


def scaled(row, column, value):
    matrix = np.eye(4)
    matrix[row, column] = value
    return matrix


P, Q = np.zeros((2, 3)), np.tile([0, 0, 0, 1.0], (2, 1))
BAD = Q * [[1], [1.1]]
ARGUMENT, INPUT = nm.InvalidArgumentError, nm.InputError

REFUSED = [
    (lambda own: own.update({0: scaled(0, 0, 2)}), INPUT, "scales by 2, the length of column 0"),
    (lambda own: own.update({0: (np.eye(4), scaled(3, 0, 7))}), INPUT, "has 7 in the last row, column 0"),
    (lambda own: nm.Pose.from_matrix(scaled(0, 1, 0.5)), INPUT, "scales by 1.118"),
    (lambda own: nm.Pose.from_matrix(scaled(2, 2, -1)), INPUT, "mirrors: its determinant is -1"),
    (lambda own: nm.Pose.from_matrix(scaled(1, 1, np.nan)), INPUT, "has NaN in row 1, column 1"),
    (lambda own: nm.Pose.from_matrix(scaled(1, 3, 1e200)), INPUT, "2^480"),
    (lambda own: nm.Pose.from_matrix(np.eye(3)), ARGUMENT, "a matrix of shape [3, 3]; give 4 rows of 4"),
    (lambda own: nm.Pose.from_matrix(np.eye(4, dtype=complex)), ARGUMENT, "complex128"),
    (lambda own: own.update({0: np.eye(3)}), ARGUMENT, "positions for arm, which is rigid; give a rigid body poses"),
    (lambda own: own.update({0: V}), ARGUMENT, "positions for arm, which is rigid; give a rigid body poses"),
    (lambda own: own.update({3: np.eye(4)}), ARGUMENT, "of shape [4, 4]"),
    (lambda own: own.update({3: nm.PoseStep(nm.Pose(), HALF)}), ARGUMENT, "a pose for cloth, which is deformable"),
    (lambda own: nm.PoseStep(nm.Pose(), V), ARGUMENT, "end must be a Pose or a (4, 4) array, got ndarray"),
    (lambda own: nm.PoseStep(nm.Pose(), HALF, pivot=(0, 1)), ARGUMENT, "a pivot of 2 numbers"),
    (lambda own: nm.PoseStep(nm.Pose(), HALF, pivot=(0, 0, np.inf)), INPUT, "about [0.0, 0.0, inf]"),
    (lambda own: nm.PoseStep(nm.Pose(), HALF, pivot=(0, 0, 1), straight=True), ARGUMENT, "a straight step has no pivot"),
    (lambda own: nm.PoseStep.turning(nm.Pose(), (0, 0, 7)), INPUT, "turns by [0.0, 0.0, 7.0]"),
    (lambda own: nm.PoseStep.turning(nm.Pose(), (0, np.nan, 0)), INPUT, "turns by [0.0, NaN, 0.0]"),
    (lambda own: nm.PoseStep.turning(nm.Pose(), (0, 0, 1), (np.nan, 0, 0)), INPUT, "NaN"),
    (lambda own: nm.PoseStep.turning(nm.Pose(), 1), ARGUMENT, "a turn of shape []"),
    (lambda own: nm.Body(V, F, pose=nm.Pose(), name="rag"), ARGUMENT, "pose of rag, which is deformable"),
    (lambda own: nm.Body(V, F, kind="rigid", pose=scaled(0, 0, 3)), INPUT, "scales by 3"),
    (lambda own: own.update_poses([0, 1], P[:1], Q), ARGUMENT, "positions have 1 rows and quaternions 2, for 2 bodies"),
    (lambda own: own.update_poses([0], P, Q), ARGUMENT, "for 1 bodies"),
    (lambda own: own.update_poses([0, 9], P, Q), ARGUMENT, "body 9 is not in the scene"),
    (lambda own: own.update_poses([0, "arm"], P, Q), ARGUMENT, "row 1 names body 0, arm, a second time"),
    (lambda own: own.update_poses([0, "cloth"], P, Q), ARGUMENT, "row 1 names body 3, cloth, which is deformable"),
    (lambda own: own.update_poses([0, "leg"], P, Q), ARGUMENT, 'no body is named "leg"; choose one of "arm", "base"'),
    (lambda own: own.update_poses([0, "base"], P, BAD), INPUT, "row 1, body 2, base: has the pose [0.0, 0.0, 0.0, 1.1]"),
    (lambda own: own.update_poses([0, 1], P, Q, end_positions=P, end_quaternions=BAD), INPUT, "row 1, body 1, hand"),
    (lambda own: own.update_poses([0, 1], P, Q, end_positions=P), ARGUMENT, "end_positions without end_quaternions"),
    (lambda own: own.update_poses([0, 1], P, Q, end_quaternions=Q), ARGUMENT, "end_quaternions without end_positions"),
    (lambda own: own.update_poses([0, 1], P, P), ARGUMENT, "quaternions of shape [2, 3]; give rows of 4"),
    (lambda own: own.update_poses([0, 1], P[0], Q), ARGUMENT, "positions of shape [3]; give rows of 3"),
    (lambda own: own.update_poses(0, P, Q), ARGUMENT, "ids must be a list of bodies, got <class 'int'>"),
    (lambda own: own.update_poses([0, 1.5], P, Q), ARGUMENT, "ids must be body numbers or names, got 1.5"),
    (lambda own: own.update({"leg": nm.Pose()}), ARGUMENT, 'no body is named "leg"'),
    (lambda own: own.update({"arm": nm.Pose(), 0: nm.Pose()}), ARGUMENT, "two inputs for body 0, arm"),
    (lambda own: own.pose("cloth"), ARGUMENT, "body 3, cloth, is not rigid and has no pose"),
    (lambda own: own.name(7), ARGUMENT, "body 7 is not in the scene"),
    (lambda own: own.remove(None), ARGUMENT, "bodies must be body numbers or names, got None"),
    (lambda own: nm.Scene(*[nm.Body(V, F, name="x")] * 2)["x"], ARGUMENT, 'bodies 0, 1 are all named "x"'),
    (lambda own: nm.Scene()["x"], ARGUMENT, "the scene has no bodies"),
]


@pytest.mark.parametrize("wrong", REFUSED, ids=lambda wrong: wrong[2])
def test_what_is_wrong_is_named_and_moves_nothing(wrong):
    call, kind, text = wrong
    own = detector()
    own.update({0: QUARTER})
    before = own.discrete().hash
    with pytest.raises(kind) as told:
        call(own)
    assert text in str(told.value)
    assert own.discrete().hash == before and own.pose(0) == QUARTER
    own.update({"arm": nm.Pose()})
    assert own.pose("arm") == nm.Pose()
