"""Answers: known ones, and those of judges that share nothing with what they judge."""

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
    listed = {tuple(row): d for row, d in zip(found.indices[of_faces].tolist(), found.distances[of_faces])}
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
    detector = nm.Detector(nm.Body(vertices, faces), nm.Near(0.05))
    found = detector.detect()
    at = detector.geometry(found)
    corners = vertices[at.vertices] * at.weights[:, :, None]
    first = np.arange(4)[None, :] < at.first[:, None]
    points = np.stack([(corners * first[:, :, None]).sum(1), (corners * ~first[:, :, None]).sum(1)], axis=1)
    assert np.allclose(points, at.points, atol=1e-12)
    assert np.allclose(np.linalg.norm(points[:, 0] - points[:, 1], axis=1), found.distances, atol=1e-12)
    assert np.allclose(np.linalg.norm(at.normals, axis=1), 1)
    by_kind = {nm.Kind.VERTEX_FACE: 1, nm.Kind.EDGE_EDGE: 2}
    assert at.first.tolist() == [by_kind[kind] for kind in found.kind.tolist()]


def test_a_fall_is_told_in_time_and_never_late():
    t1, faces = two_triangles()
    t0 = t1.copy()
    t0[3:, 2] += 2
    found = nm.contacts(t0, t1, faces, tolerance=1e-9)
    assert found.kind.tolist() == [nm.Kind.VERTEX_FACE] and found.indices.tolist() == [[3, 0]]
    assert found.status.tolist() == [nm.Status.CERTIFIED]
    assert found.toi[0] <= 0.5 <= found.toi_hi[0] and found.toi_hi[0] - found.toi[0] < 1e-8
    assert found.earliest == found.toi[0] == nm.time_of_impact(t0, t1, faces, tolerance=1e-9)
    assert nm.time_of_impact(t0, t0, faces) is None
    # Half a unit sooner with a separation of half a unit: a quarter of the step.
    assert abs(nm.time_of_impact(t0, t1, faces, separation=0.5) - 0.25) < 1e-4


def test_bodies_meet_as_they_say():
    vertices, faces = sheet(8)
    ground = nm.Body(vertices, faces, kind="static", name="ground")
    scene = nm.Scene(ground)
    box = scene.add(nm.Body(vertices, faces, kind="rigid"))
    other = scene.add(nm.Body(vertices, faces, kind="rigid", environment=1))
    assert len(scene) == 3 and scene.bodies == [0, box, other]
    detector = nm.Detector(scene, nm.Continuous())
    up, down = nm.Pose(translation=(0.01, 0.01, 1)), nm.Pose(translation=(0.01, 0.01, -1))
    found = detector.frame({box: (up, down), other: (up, down)})
    assert len(found) > 0 and np.unique(found.bodies, axis=0).tolist() == [[0, box]]
    assert np.all(np.abs(found.toi - 0.5) < 1e-3)
    detector.remove(box)
    assert len(detector.detect()) == 0
    detector.replace(0, nm.Body(vertices, faces, kind="static", environment=1))
    assert len(detector.frame({other: (up, down)})) == len(found)


def test_a_mask_is_its_low_bits():
    vertices, faces = two_triangles()
    for mask, meets in [(~1, 0), (-2, 0), (0xFFFFFFFE, 0), (~2, 1), (-1, 1)]:
        scene = nm.Scene(nm.Body(vertices[:3], faces[:1], group=1), nm.Body(vertices[3:], faces[:1], mask=mask))
        assert len(nm.Detector(scene, nm.Discrete()).detect()) == meets


def test_the_nearest_bodies():
    vertices, faces = sheet(4)
    scene = nm.Scene(nm.Body(vertices, faces, kind="static"), nm.Body(vertices, faces, kind="rigid"))
    detector = nm.Detector(scene, nm.Distance())
    turned = nm.Pose(rotation=(0, 0, np.sin(0.5), np.cos(0.5)), translation=(0, 0, 0.75))
    found = detector.frame({1: turned})
    assert found.distance == 0.75 and found.distances.tolist() == [0.75] and found.bodies.tolist() == [[0, 1]]
    assert np.linalg.norm(found.points[0, 0] - found.points[0, 1]) == pytest.approx(0.75)
    corners = vertices[faces[found.indices[0, 0]]]
    assert np.allclose(found.weights[0, 0] @ corners, found.points[0, 0])


def test_answers_stay_the_same_however_candidates_are_found():
    vertices, faces = soup(300, 3)
    there = vertices + 0.1 * np.sin(10 * vertices[:, ::-1])
    hashes = set()
    for choices in [{}, {"broad": "tree"}, {"order": "median"}, {"bv": "aabb", "broad": "tiles"}, {"rebuild": "never"}]:
        detector = nm.Detector(nm.Body(vertices, faces), nm.Continuous(**choices))
        hashes.add(detector.frame({0: (vertices, there)}).hash)
    assert len(hashes) == 1


def test_figures():
    vertices, faces = soup(300, 3)
    detector = nm.Detector(nm.Body(vertices, faces), nm.Near(0.02))
    found = detector.detect()
    told = detector.summary(found)
    assert told["contacts"] == len(found) and told["hash"] == found.hash and told["candidates"] == found.candidates
    plan = detector.plan()
    assert sum(buffer["bytes"] for buffer in plan["buffers"]) == detector.device.bytes[0] > 0
    assert found.unresolved >= 0 and "Near" not in repr(found) and "near pairs" in repr(found)
