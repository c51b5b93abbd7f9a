"""Pairs of features that are excluded have no rows; all others stay."""

import numpy as np
import pytest

import nearmiss as nm

CPU = nm.Device("cpu")
SIDE = 6


def sheet(jitter, seed):
    """A crumpled sheet of squares, each cut into two triangles."""
    corners = np.stack(np.meshgrid(np.arange(SIDE + 1), np.arange(SIDE + 1)), -1).reshape(-1, 2) / SIDE
    flat = np.column_stack([corners, np.zeros(len(corners))])
    first = (np.arange(SIDE)[:, None] * (SIDE + 1) + np.arange(SIDE)).ravel()
    faces = np.concatenate(
        [np.stack([first, first + 1, first + SIDE + 1], 1), np.stack([first + 1, first + SIDE + 2, first + SIDE + 1], 1)]
    )
    return flat + np.random.default_rng(seed).uniform(-jitter, jitter, flat.shape), faces, flat


VERTICES, FACES, FLAT = sheet(0.2, 1)
OTHER = sheet(0.2, 2)[0]
NEAR = nm.Near(0.1)


def scene():
    return nm.Scene(nm.Body(VERTICES, FACES, name="cloth"), nm.Body(OTHER, FACES, name="shirt"))


def features(answer):
    """The rows of near pairs with the vertices of both features, as (row, body, vertices, face or None, ...)."""
    edges = sorted({tuple(sorted(pair, reverse=True)) for x, y, z in FACES.tolist() for pair in [(x, y), (y, z), (z, x)]})
    for body, kind, a, b in zip(answer.bodies.tolist(), answer.kind.tolist(), answer.feature_a.tolist(), answer.feature_b.tolist()):
        row = (*body, kind, a, b)
        if kind == nm.Kind.VERTEX_FACE:
            yield row, body, ([a], None), (FACES[b].tolist(), b)
        else:
            yield row, body, (list(edges[a]), None), (list(edges[b]), None)


def hops():
    """Edges between any two vertices."""
    count = len(VERTICES)
    between = np.full((count, count), count)
    np.fill_diagonal(between, 0)
    for x, y, z in FACES.tolist():
        for p, q in [(x, y), (y, z), (z, x)]:
            between[p, q] = between[q, p] = 1
    for by in range(count):
        between = np.minimum(between, between[:, by : by + 1] + between[by : by + 1, :])
    return between


def rows(answer):
    return [row for row, *_ in features(answer)]


def less(whole, drops):
    return [row for row, bodies, one, other in features(whole) if not drops(bodies, one, other)]


WHOLE = nm.Detector(scene(), device=CPU).query(NEAR)


def check(drops, exclude):
    """A scene and a detector with these exclusions have the rows that are not dropped."""
    made = scene()
    exclude(made)
    detector = nm.Detector(scene(), device=CPU)
    detector.query(NEAR)
    exclude(detector)
    wanted = less(WHOLE, drops)
    assert 0 < len(wanted) < len(WHOLE)
    for one in (nm.Detector(made, device=CPU), detector):
        assert rows(one.query(NEAR)) == wanted


@pytest.mark.parametrize("ring", [2, 3])
def test_a_ring(ring):
    between = hops()

    def drops(bodies, one, other):
        return bodies == [0, 0] and between[np.ix_(one[0], other[0])].min() < ring

    check(drops, lambda of: of.exclude("cloth", ring=ring))


def test_ring_one_is_left_out_already():
    detector = nm.Detector(scene(), device=CPU)
    detector.exclude(0, ring=1)
    assert rows(detector.query(NEAR)) == rows(WHOLE)


@pytest.mark.parametrize("pairs", [[(0, 9), (20, 3), (9, 9)], np.array([[4, 5], [40, 41]], np.uint8)])
def test_pairs_of_vertices(pairs):
    wanted = {tuple(pair) for pair in np.asarray(pairs).tolist()}

    def drops(bodies, one, other):
        if bodies not in ([0, 1], [1, 0]):
            return False
        cloth, shirt = (one, other) if bodies == [0, 1] else (other, one)
        return any((p, q) in wanted for p in cloth[0] for q in shirt[0])

    check(drops, lambda of: of.exclude_pairs("cloth", "shirt", pairs))
    made = scene()
    made.exclude_pairs("shirt", 0, np.asarray(pairs)[:, ::-1])
    assert made.excluded_pairs(0, 1).tolist() == sorted(map(list, wanted))
    made.exclude_pairs(0, 1, [])
    assert made.excluded_pairs(1, 0).shape == (0, 2)


def test_faces_take_no_part():
    dead = {3, 4, 5, 39, 40}
    live = [face for index, face in enumerate(FACES.tolist()) if index not in dead]

    def drops(bodies, one, other):
        def is_out(body, feature):
            vertices, face = feature
            return body == 1 and (face in dead or not any(set(vertices) <= set(corners) for corners in live))

        return is_out(bodies[0], one) or is_out(bodies[1], other)

    check(drops, lambda of: of.exclude("shirt", faces=sorted(dead)))


def test_nearer_at_rest():
    detector = nm.Detector(scene(), device=CPU)
    detector.exclude("cloth", within=0.4, rest=FLAT)
    left = rows(detector.query(NEAR))
    # Squares are 1 / 6 wide: pairs within two squares at rest are left out, farther ones are not.
    between = hops()
    for row, bodies, one, other in features(WHOLE):
        if bodies == [0, 0]:
            apart = np.linalg.norm(FLAT[one[0]][:, None] - FLAT[other[0]], axis=2).min()
            assert row not in left or apart > 0.4
            assert row in left or apart < 0.4 + 1 / 3
        else:
            assert row in left
    assert len(left) < len(WHOLE) and between.max() > 3
    # By default the body rests where it is: everything near now is left out.
    detector.exclude("cloth", within=0.11)
    assert rows(detector.query(NEAR)) == less(WHOLE, lambda bodies, *_: bodies == [0, 0])
    detector.exclude("cloth")
    assert rows(detector.query(NEAR)) == rows(WHOLE)


def test_a_replaced_body_is_told_again():
    detector = nm.Detector(scene(), device=CPU)
    detector.exclude("cloth", ring=2)
    detector.exclude_pairs(0, 1, [(0, 0)])
    detector.replace("cloth", nm.Body(VERTICES, FACES, name="cloth"))
    assert len(detector.excluded_pairs(0, 1)) == 0
    assert rows(detector.query(NEAR)) == rows(WHOLE)


WRONG = [
    (lambda of: of.exclude(7, ring=2), "body 7 is not in the scene"),
    (lambda of: of.exclude("cloth", ring=0), "ring of neighbours of cloth must be at least 1, got 0"),
    (lambda of: of.exclude("cloth", ring=-1), "ring"),
    (lambda of: of.exclude("cloth", within=-0.5), "at rest of cloth must be finite and at least 0, got -0.5"),
    (lambda of: of.exclude("cloth", within=float("inf")), "got inf"),
    (lambda of: of.exclude("cloth", rest=FLAT), "rest without within"),
    (lambda of: of.exclude("cloth", within=0.1, rest=FLAT[1:]), "has 48 positions, and the body 49 vertices"),
    (lambda of: of.exclude("cloth", faces=[72]), "face 72 of cloth cannot be excluded: it has 72 faces"),
    (lambda of: of.exclude("cloth", faces=[-1]), "faces have index -1"),
    (lambda of: of.exclude("cloth", faces=[0.5]), "faces of type"),
    (lambda of: of.exclude_pairs("cloth", "leg", [(0, 0)]), 'no body is named "leg"'),
    (lambda of: of.exclude_pairs(0, 1, [(0, 49)]), "vertex 49 of shirt cannot be excluded: it has 49 vertices"),
    (lambda of: of.exclude_pairs(0, 0, [(4, 4)]), "(4, 4) of cloth is a vertex with itself"),
    (lambda of: of.exclude_pairs(0, 1, [(0, 1, 2)]), "pairs of shape [1, 3]"),
]


@pytest.mark.parametrize("wrong, text", WRONG)
def test_what_cannot_be_excluded_is_named(wrong, text):
    detector, made = nm.Detector(scene(), device=CPU), scene()
    for one in (detector, made):
        with pytest.raises(nm.InvalidArgumentError) as raised:
            wrong(one)
        assert text in str(raised.value)
    assert rows(detector.query(NEAR)) == rows(WHOLE)
    assert rows(nm.Detector(made, device=CPU).query(NEAR)) == rows(WHOLE)


def test_queries_that_cannot_obey_are_refused():
    detector = nm.Detector(scene(), device=CPU)
    detector.exclude("cloth", ring=2)
    for query in (nm.Distance(), nm.BodyPairs(), nm.BodyDistances(0.1)):
        with pytest.raises(nm.InvalidArgumentError, match="cannot leave out pairs of features"):
            detector.query(query)
    assert len(detector.query(NEAR)) > 0
