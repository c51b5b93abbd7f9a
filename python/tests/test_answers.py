"""Answers: known ones, and those of judges that share nothing with what they judge."""

import gc
import itertools
from fractions import Fraction

import numpy as np
import pytest
from shapes import sheet, soup, two_triangles

import nearmiss as nm


def sign(a, b, c, d):
    """On which side of the plane of a, b, c the point d is: exactly."""
    a, b, c, d = ([Fraction(float(x)) for x in point] for point in (a, b, c, d))
    u, v, w = ([p[k] - a[k] for k in range(3)] for p in (b, c, d))
    value = sum(w[k] * (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]) for k in range(3))
    return (value > 0) - (value < 0)


def crosses(p, q, triangle):
    """Whether a segment crosses a triangle; nothing lies in a plane of another."""
    a, b, c = triangle
    if sign(a, b, c, p) == sign(a, b, c, q):
        return False
    return len({sign(p, q, a, b), sign(p, q, b, c), sign(p, q, c, a)}) == 1


def crossing(vertices, faces):
    """Pairs of triangles without a common vertex of which an edge of one crosses the other."""
    triangles = vertices[faces]
    for i, j in itertools.combinations(range(len(faces)), 2):
        pair = (triangles[i], triangles[j]), (triangles[j], triangles[i])
        if any(crosses(one[k], one[(k + 1) % 3], other) for one, other in pair for k in range(3)):
            yield i, j


def test_two_triangles_cross():
    pairs = nm.self_intersections(*two_triangles())
    assert pairs.tolist() == [[0, 1]] and pairs.dtype == np.uint32
    apart = two_triangles()[0] + np.array([0, 0, 0]) * 1.0
    apart[3:, 2] += 5
    assert nm.self_intersections(apart, two_triangles()[1]).shape == (0, 2)


@pytest.mark.parametrize("seed", range(3))
def test_exact_signs_agree(seed):
    vertices, faces = soup(60, seed, 0.6)
    wanted = sorted(crossing(vertices, faces))
    assert len(wanted) > 5
    assert nm.self_intersections(vertices, faces).tolist() == [list(pair) for pair in wanted]


def test_the_judge_can_fail():
    vertices, faces = soup(60, 0, 0.6)
    wanted = sorted(crossing(vertices, faces))
    moved = vertices.copy()
    i, j = wanted[0]
    moved[faces[i]] += 10
    assert (i, j) not in list(crossing(moved, faces)) and sorted(crossing(moved, faces)) != wanted


def distance_to_triangle(p, triangle):
    """By dense weights: never below the true distance, and above it by a hundredth of the longest edge at most."""
    n = 100
    u, v = (axis.ravel() / n for axis in np.meshgrid(np.arange(n + 1), np.arange(n + 1)))
    u, v = u[u + v <= 1], v[u + v <= 1]
    points = np.stack([1 - u - v, u, v], axis=1) @ triangle
    return np.linalg.norm(points - p, axis=1).min()


def test_near_vertices_and_faces():
    vertices, faces = soup(40, 7, 0.4)
    reach, error = 0.05, 0.4 * 3**0.5 / 100
    found = nm.near(vertices, faces, reach)
    of_faces = found.kind == nm.Kind.VERTEX_FACE
    rows = zip(found.feature_a[of_faces].tolist(), found.feature_b[of_faces].tolist())
    listed = dict(zip(rows, found.distances[of_faces]))
    for vertex, face in itertools.product(range(len(vertices)), range(len(faces))):
        if vertex in faces[face]:
            assert (vertex, face) not in listed
            continue
        sampled = distance_to_triangle(vertices[vertex], vertices[faces[face]])
        if sampled <= reach:
            assert abs(listed[vertex, face] - sampled) <= error
        elif sampled > reach + error:
            assert (vertex, face) not in listed
    assert len(listed) > 20


def test_near_points_are_where_the_weights_say():
    vertices, faces = soup(40, 7, 0.4)
    detector = nm.Detector(nm.Body(vertices, faces))
    found = detector.near(0.05)
    at = detector.geometry(found)
    corners = vertices[at.vertices] * at.weights[:, :, None]
    first = np.where(found.kind == nm.Kind.VERTEX_FACE, 1, 2)
    own = np.arange(4)[None, :] < first[:, None]
    points = np.stack([(corners * own[:, :, None]).sum(1), (corners * ~own[:, :, None]).sum(1)], axis=1)
    assert np.allclose(points, at.points, atol=1e-12)
    assert np.allclose(np.linalg.norm(points[:, 0] - points[:, 1], axis=1), found.distances, atol=1e-12)
    assert np.allclose(np.linalg.norm(at.normals, axis=1), 1)
    # The same weights in both answers, and with signs.
    assert np.allclose(found.weights, at.weights, atol=1e-12)
    assert np.array_equal(at.signed_weights, np.where(own, at.weights, -at.weights))
    gaps = (vertices[at.vertices] * at.signed_weights[:, :, None]).sum(1)
    assert np.allclose(gaps, at.points[:, 0] - at.points[:, 1], atol=1e-12)
    assert set(found.kind.tolist()) == {nm.Kind.VERTEX_FACE, nm.Kind.EDGE_EDGE}


def test_triangles_meet_in_their_segments():
    vertices, faces = two_triangles()
    # A third one stands on the first.
    vertices = np.vstack([vertices, [[0.5, 0.5, 0], [1.5, 0.5, 0], [0.5, 0.5, 2]]]).astype(np.float32)
    faces = np.vstack([faces, [[6, 7, 8]]])
    detector = nm.Detector(nm.Body(vertices, faces))
    found = detector.discrete()
    at = detector.geometry(found)
    assert found.triangles.tolist() == [[0, 1], [0, 2]] and len(at) == 2
    assert at.kind.tolist() == [nm.PairKind.CROSSING, nm.PairKind.SEGMENT]
    assert at.ends.shape == (2, 2, 3) and at.ends[:, :, 2].tolist() == [[0, 0], [0, 0]]
    assert sorted(at.ends[0, :, 0].tolist()) == [1, 1.5] and sorted(at.ends[1, :, 0].tolist()) == [0.5, 1.5]
    assert at.errors.tolist() == [1.5 / 2**53, 0] and at.parts.shape == (2, 2, 2)
    # The ends of the second are corners 0 and 1 of its triangle, inside the first.
    assert sorted(at.parts[1].tolist()) == [[0, 4], [0, 5]]
    curves = detector.curves(found)
    assert (len(curves), curves.starts.tolist(), curves.is_closed.tolist()) == (1, [0, 2], [False])
    assert curves.points.tolist() == at.ends[0].tolist()
    assert (curves.rows.tolist(), curves.groups.tolist(), curves.row_groups.tolist()) == ([0], [0], [0, -1])
    only = detector.discrete(only_crossing=True)
    assert only.triangles.tolist() == [[0, 1]] and not only.is_free
    assert nm.self_intersections(vertices, faces, only_crossing=True).tolist() == [[0, 1]]
    with pytest.raises(nm.InvalidArgumentError):
        detector.curves(detector.near(0.1))


def test_an_overlap_has_no_ends():
    vertices = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, 0], [5, 1, 0], [1, 5, 0]])
    detector = nm.Detector(nm.Body(vertices, [[0, 1, 2], [3, 4, 5]]))
    at = detector.geometry(detector.discrete())
    assert at.kind.tolist() == [nm.PairKind.OVERLAP] and np.isnan(at.ends).all()
    assert at.parts.tolist() == [[[255, 255], [255, 255]]] and len(detector.discrete(only_crossing=True)) == 0


def test_every_corner_has_its_owner():
    vertices, faces = soup(40, 7, 0.4)
    scene = nm.Scene(nm.Body(vertices, faces), nm.Body(vertices + 0.01, faces))
    detector = nm.Detector(scene)
    found = detector.near(0.05)
    at = detector.geometry(found)
    assert at.owner.shape == (len(found), 4) and len(np.unique(at.owner)) == 2
    places = np.stack([vertices, vertices + 0.01])[at.owner, at.vertices]
    gaps = (places * at.signed_weights[:, :, None]).sum(1)
    assert np.allclose(gaps, at.points[:, 0] - at.points[:, 1], atol=1e-12)
    is_a = at.signed_weights > 0
    of_a = [set(row[own].tolist()) for row, own in zip(at.owner, is_a)]
    assert all(bodies <= {a} for bodies, a in zip(of_a, found.bodies[:, 0].tolist()))


def test_a_fall_is_told_in_time_and_never_late():
    t1, faces = two_triangles()
    t0 = t1.copy()
    t0[3:, 2] += 2
    found = nm.contacts(t0, t1, faces, tolerance=1e-9)
    assert found.kind.tolist() == [nm.Kind.VERTEX_FACE]
    assert (found.feature_a.tolist(), found.feature_b.tolist()) == ([3], [0])
    assert found.status.tolist() == [nm.Status.CERTIFIED]
    assert found.toi[0] <= 0.5 <= found.toi_upper[0] and found.toi_upper[0] - found.toi[0] < 1e-8
    assert found.earliest_toi == found.toi[0] == nm.time_of_impact(t0, t1, faces, tolerance=1e-9)
    assert nm.time_of_impact(t0, t0, faces) is None
    # Half a unit sooner with a separation of half a unit: a quarter of the step.
    assert abs(nm.time_of_impact(t0, t1, faces, min_separation=0.5) - 0.25) < 1e-4


def test_what_crosses_at_the_start_is_counted():
    crossing, faces = two_triangles()
    apart = crossing.copy()
    apart[3:, 2] += 5
    for query in [nm.Continuous, nm.Earliest]:
        for start, pairs in [(crossing, 1), (apart, 0)]:
            detector = nm.Detector(nm.Body(start, faces))
            found = detector.step({0: (start, start)}, query())
            assert (found.earliest_toi if query is nm.Continuous else found.toi) is None
            assert (found.starts_crossing, found.is_free) == (pairs, pairs == 0)
            summary = detector.summary(found)
            assert summary["starts_crossing"] == pairs
            told = [note for note in summary["notes"] if "1 triangle pair meets at the start" in note]
            assert len(told) == pairs
        assumed = nm.Detector(nm.Body(crossing, faces)).query(query(assume_free=True))
        assert (assumed.starts_crossing, assumed.is_free) == (None, False)
        assert query(assume_free=True) != query() and "assume_free=True" in repr(query(assume_free=True))
    detector = nm.Detector(nm.Body(crossing, faces))
    assert not detector.discrete().is_free and detector.distance().is_free
    with pytest.raises(nm.InputError, match="1 triangle pair crosses at the start"):
        nm.time_of_impact(crossing, crossing, faces)
    assert nm.time_of_impact(crossing, crossing, faces, assume_free=True) is None
    assert nm.time_of_impact(apart, apart, faces) is None
    assert nm.contacts(crossing, crossing, faces).starts_crossing == 1


def test_the_count_is_that_of_the_discrete_query():
    t0, faces = soup(80, 3, 0.5)
    t1 = t0 + 0.25 * np.cos(9 * t0)
    listed = len(nm.self_intersections(t0, faces))
    assert listed > 20 and listed != len(nm.self_intersections(t1, faces))
    assert nm.contacts(t0, t1, faces).starts_crossing == listed


def test_bodies_meet_as_they_say():
    vertices, faces = sheet(8)
    ground = nm.Body(vertices, faces, kind="fixed", name="ground")
    scene = nm.Scene(ground)
    box = scene.add(nm.Body(vertices, faces, kind="rigid"))
    other = scene.add(nm.Body(vertices, faces, kind="rigid", environment=1))
    assert len(scene) == 3 and scene.bodies == [0, box, other]
    detector = nm.Detector(scene)
    assert detector.bodies == scene.bodies
    up, down = nm.Pose(translation=(0.01, 0.01, 1)), nm.Pose(translation=(0.01, 0.01, -1))
    detector.update({box: (up, down), other: (up, down)})
    found = detector.continuous()
    assert len(found) > 0 and np.unique(np.sort(found.bodies), axis=0).tolist() == [[0, box]]
    assert np.all(np.abs(found.toi - 0.5) < 1e-3)
    detector.remove(box)
    assert len(detector.continuous()) == 0
    detector.replace(0, nm.Body(vertices, faces, kind="fixed", environment=1))
    assert len(detector.step({other: (up, down)}, nm.Continuous())) == len(found)


def test_a_mask_is_its_low_bits():
    vertices, faces = two_triangles()
    for mask, meets in [(~1, 0), (-2, 0), (0xFFFFFFFE, 0), (~2, 1), (-1, 1)]:
        scene = nm.Scene(nm.Body(vertices[:3], faces[:1], group=1), nm.Body(vertices[3:], faces[:1], mask=mask))
        assert len(nm.Detector(scene).discrete()) == meets


def test_the_nearest_bodies():
    vertices, faces = sheet(4)
    scene = nm.Scene(nm.Body(vertices, faces, kind="fixed"), nm.Body(vertices, faces, kind="rigid"))
    detector = nm.Detector(scene)
    turned = nm.Pose(rotation=(0, 0, np.sin(0.5), np.cos(0.5)), translation=(0, 0, 0.75))
    detector.update({1: turned})
    found = detector.distance()
    assert found.min_distance == 0.75 and found.bodies.tolist() == [0, 1] and found.is_free
    assert np.linalg.norm(found.points[0] - found.points[1]) == pytest.approx(0.75)
    corners = vertices[faces[found.triangles[0]]]
    assert np.allclose(found.weights[0] @ corners, found.points[0])
    # The nearest features say the same.
    assert detector.near(0.8).min_distance == pytest.approx(0.75) and detector.near(0.7).min_distance is None
    alone = nm.Detector(nm.Body(vertices, faces)).distance()
    values = [alone.min_distance, alone.bodies, alone.triangles, alone.weights, alone.points]
    assert values == [None] * 5 and alone.is_free


CHOICES = [
    {}, {"broad_phase": "tree"}, {"bounding_volume": "aabb", "broad_phase": "tiles"}, {"bounding_volume": "obb"},
    {"rebuild": "manual"}, {"solver": "certified-f64", "broad_phase": "tree"},
]


def test_answers_stay_the_same_however_candidates_are_found():
    vertices, faces = soup(300, 3)
    there = vertices + 0.1 * np.sin(10 * vertices[:, ::-1])
    detector = nm.Detector(nm.Body(vertices, faces))
    detector.update({0: (vertices, there)})
    for query in [nm.Discrete(), nm.Near(0.02)]:
        choices = [choices for choices in CHOICES if "solver" not in choices]
        hashes = {detector.query(nm.research.configure(query, **choices)).hash for choices in choices}
        assert len(hashes) == 1, query
    hashes = {detector.query(nm.research.configure(nm.Continuous(), **choices)).hash for choices in CHOICES[:5]}
    assert len(hashes) == 1
    first = {detector.query(nm.research.configure(nm.Earliest(), **choices)).toi for choices in CHOICES[:5]}
    assert len(first) == 1


def test_a_solver_that_can_be_wrong_says_so():
    t1, faces = two_triangles()
    t0 = t1.copy()
    t0[3:, 2] += 2
    detector = nm.Detector(nm.Body(t0, faces))
    query = nm.research.configure(nm.Continuous(), solver="cubic-f64")
    found = detector.step({0: (t0, t1)}, query)
    assert found.status.tolist() == [nm.Status.UNVERIFIED] and found.query == query
    assert detector.continuous().status.tolist() == [nm.Status.CERTIFIED]


def test_figures():
    vertices, faces = soup(300, 3)
    detector = nm.Detector(nm.Body(vertices, faces), device=nm.Device("cpu"))
    found = detector.near(0.02)
    told = detector.summary(found)
    assert told["contacts"] == len(found) and told["hash"] == found.hash and told["candidates"] == found.candidates
    plan = detector.plan(nm.Near(0.02))
    assert sum(buffer["bytes"] for buffer in plan["buffers"]) == detector.device.bytes[0] > 0
    assert found.undecided >= 0 and repr(found) == f"<nearmiss.NearPairs: {len(found)} rows>"
    assert found.query == nm.Near(0.02)


def test_self_collision_is_the_default_of_deformable_bodies():
    crossed = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0.2, 0.2, -1], [0.2, 0.3, 1], [5, 5, 1]], np.float32)
    faces = [[0, 1, 2], [3, 4, 5]]
    far = crossed[:3] + 90
    for choices, expected in [
        ({}, 1), ({"self_collision": None}, 1), ({"self_collision": True}, 1), ({"self_collision": False}, 0),
        ({"kind": "rigid"}, 0), ({"kind": "rigid", "self_collision": True}, 1), ({"kind": "fixed"}, 0),
    ]:
        body, other = nm.Body(crossed, faces, **choices), nm.Body(far, faces[:1])
        assert len(nm.Detector(nm.Scene(body, other)).discrete()) == expected, choices
        assert len(nm.Detector(body).discrete()) == expected, choices
    with pytest.raises(nm.InvalidArgumentError, match="of a rug, which is"):
        nm.Body(crossed, faces, kind="fixed", self_collision=True, name="a rug")


def test_a_scene_that_a_detector_has_is_not_changed():
    vertices, faces = sheet(4, lambda x, y: 0 * x)
    scene = nm.Scene(nm.Body(vertices, faces))
    first = nm.Detector(scene)
    nm.Detector(scene)
    for change in [lambda: scene.add(nm.Body(vertices, faces)), lambda: scene.remove(0)]:
        with pytest.raises(nm.InvalidArgumentError, match="a scene after a detector has copied it"):
            change()
    assert first.add(nm.Body(vertices, faces)) == 1 and first.bodies == [0, 1]


def test_a_frame_in_motion_has_two_ends_and_a_far_turn_a_caveat():
    bar = np.array([[-2, 0, 0], [2, 0, 0], [0, 0.5, 0]], np.float32)
    ground = nm.Body(bar - [0, 0, 9], [[0, 1, 2]], kind="fixed")
    scene = nm.Scene(nm.Body(bar, [[0, 1, 2]], kind="rigid"), ground, nm.Body(bar + [0, 0, 9], [[0, 1, 2]]))
    for query in [nm.Continuous(), nm.Earliest()]:
        detector = nm.Detector(scene)
        for inputs in [{2: bar}, {0: nm.Pose()}, {0: nm.Pose(), 2: bar}]:
            with pytest.raises(nm.InvalidArgumentError, match="no body of the frame has two ends"):
                detector.step(inputs, query)
            detector.update(inputs)
            with pytest.raises(nm.InvalidArgumentError, match="no body of the frame has two ends"):
                detector.query(query)
            assert len(detector.discrete()) == 1
        assert detector.step({0: (nm.Pose(), nm.Pose()), 2: bar}, query).caveats == []
        half = np.radians(90) / 2
        turned = nm.Pose((0, 0, np.sin(half), np.cos(half)))
        assert not any("turns" in caveat for caveat in detector.step({0: (nm.Pose(), turned)}, query).caveats)
        found = detector.step({0: nm.PoseStep(nm.Pose(), turned, straight=True)}, query)
        assert len(found.caveats) == 1 and "body 0 turns by 90.0 degrees" in found.caveats[0]
        assert not any("turns" in caveat for caveat in detector.step({}, query).caveats)
        assert detector.tolerance == detector.largest_tolerance > 0


def test_columns_are_fields_of_the_rows_and_outlive_the_answer():
    vertices, faces = soup(60, 0, 0.6)
    answer = nm.Detector(nm.Body(vertices, faces)).query(nm.Near(0.1))
    columns = {name: getattr(answer, name) for name in ("kind", "bodies", "feature_a", "squared_distances", "closest")}
    row = columns["kind"].strides[0]
    assert len(answer) > 20 and row == 48 and {column.strides[0] for column in columns.values()} == {row}
    starts = [column.__array_interface__["data"][0] for column in columns.values()]
    assert max(starts) - min(starts) < row, "fields of one row"
    copies = {name: column.copy() for name, column in columns.items()}
    del answer
    gc.collect()
    others = [np.full(1000, 7.0) for _ in range(1000)]
    assert len(others) == 1000 and all((columns[name] == copies[name]).all() for name in columns)
    with pytest.raises(ValueError):
        columns["kind"].flags.writeable = True
    none = nm.Detector(nm.Body(vertices[:3], faces[:1])).query(nm.Discrete())
    assert none.triangles.shape == none.bodies.shape == (0, 2)
