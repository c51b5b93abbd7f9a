"""One detector answers several queries, with one memory and one upload."""

import gc
import weakref

import numpy as np
import pytest
from shapes import sheet, soup
from sheets import fold

import nearmiss as nm

CPU = nm.Device("cpu")
QUERIES = [
    nm.Near(0.02),
    nm.Near(0.11),
    nm.Earliest(),
    nm.Continuous(),
    nm.Continuous(min_separation=0.02, tolerance=1e-3),
    nm.Continuous(min_separation=0.05, assume_free=True),
    nm.Discrete(),
    nm.Discrete(adjacent=True),
    nm.Distance(),
    nm.BodyPairs(),
    nm.BodyPairs(first=1),
    nm.BodyDistances(0.3),
    nm.research.configure(nm.Discrete(), broad_phase="tree"),
]


def bodies(seed):
    """A scene of bodies of every kind around one place."""
    vertices, faces = soup(60, seed, 0.4)
    ball, of_ball = soup(40, seed + 1, 0.4)
    ground, of_ground = soup(50, seed + 2, 0.4)
    fixed = nm.Body(ground, of_ground, kind="fixed")
    return nm.Scene(nm.Body(vertices, faces), nm.Body(ball, of_ball, kind="rigid"), fixed), vertices


def step(random, vertices):
    """The motions of one step."""
    ends = tuple(vertices + 0.2 * random.standard_normal(3) for _ in range(2))
    poses = tuple(nm.Pose(translation=0.2 * random.standard_normal(3)) for _ in range(2))
    return {0: ends, 1: poses}


def difference(found, wanted):
    """How two answers differ, if they do."""
    names = ["query", "hash", "caveats", "is_free", "starts_crossing", "undecided", "toi", "min_distance"]
    for name in names:
        one, other = (getattr(answer, name, None) for answer in (found, wanted))
        if not np.array_equal(one, other):
            return f"{type(found).__name__}.{name}: {one}, alone {other}"
    return None


def life(seed, spoil=lambda detector, query: detector.query(query)):
    """The first answer of a life that differs from that of a new detector; and how many rows there were."""
    random = np.random.default_rng(seed)
    scene, vertices = bodies(10 * seed)
    detector, rows = nm.Detector(scene, device=CPU), 0
    for _ in range(3):
        motions = step(random, vertices)
        detector.update(motions)
        for _ in range(6):
            query = QUERIES[random.integers(len(QUERIES))]
            if random.random() < 0.1:
                detector.rebuild()
            found = spoil(detector, query)
            alone = nm.Detector(scene, device=CPU).step(motions, query)
            rows += len(alone) if hasattr(alone, "__len__") else 1
            if difference(found, alone):
                return rows, difference(found, alone)
    return rows, None


def test_an_answer_does_not_depend_on_earlier_queries():
    rows = 0
    for seed in range(6):
        count, fault = life(seed)
        assert fault is None, f"seed {seed}: {fault}"
        rows += count
    assert rows > 2000


def test_an_answer_that_is_not_its_own_is_named():
    def larger(detector, query):
        return detector.near(0.03) if query == nm.Near(0.02) else detector.query(query)

    def moved(detector, query):
        detector.update({1: nm.Pose()} if isinstance(query, nm.Discrete) else {})
        return detector.query(query)

    for spoil, text in [(larger, "NearPairs.query"), (moved, "hash")]:
        faults = [life(seed, spoil)[1] for seed in range(4)]
        assert any(fault and text in fault for fault in faults), faults


def methods(detector):
    """Each method with the query that it stands for."""
    accuracy = {"tolerance": 1e-6, "min_separation": 0.01, "max_iterations": 999, "assume_free": True}
    yield detector.near(0.02), nm.Near(0.02), nm.NearPairs
    yield detector.discrete(), nm.Discrete(), nm.TrianglePairs
    yield detector.discrete(adjacent=True), nm.Discrete(adjacent=True), nm.TrianglePairs
    yield detector.discrete(only_crossing=True), nm.Discrete(only_crossing=True), nm.TrianglePairs
    yield detector.distance(), nm.Distance(), nm.NearestTriangles
    yield detector.body_pairs(), nm.BodyPairs(), nm.TouchingBodies
    yield detector.body_pairs(first=1), nm.BodyPairs(first=1), nm.TouchingBodies
    yield detector.body_distances(0.3), nm.BodyDistances(0.3), nm.NearestBodies
    yield detector.continuous(), nm.Continuous(), nm.Contacts
    yield detector.continuous(**accuracy), nm.Continuous(**accuracy), nm.Contacts
    yield detector.earliest(), nm.Earliest(), nm.FirstContact
    yield detector.earliest(**accuracy), nm.Earliest(**accuracy), nm.FirstContact


def test_a_method_is_its_query_and_each_query_has_its_answer():
    scene, vertices = bodies(1)
    detector = nm.Detector(scene, device=CPU)
    motions = step(np.random.default_rng(1), vertices)
    detector.update(motions)
    for answer, query, kind in methods(detector):
        assert type(answer) is kind and isinstance(answer, nm.Answer) and answer.query == query
        assert difference(answer, detector.query(query)) is None
        assert difference(answer, nm.Detector(scene, device=CPU).step(motions, query)) is None


def test_an_answer_has_the_columns_of_its_query_alone():
    scene, _ = bodies(1)
    detector = nm.Detector(scene, device=CPU)
    found = detector.near(0.02), detector.discrete(), detector.distance(), detector.continuous(), detector.earliest()
    near, triangles, nearest, contacts, first = found
    for answer, others in [
        (near, ["toi", "triangles", "starts_crossing", "is_free"]),
        (triangles, ["toi", "kind", "feature_a", "distances", "undecided"]),
        (nearest, ["distances", "toi", "kind", "__len__"]),
        (contacts, ["distances", "closest", "weights", "triangles", "min_distance"]),
        (first, ["status", "kind", "bodies", "__len__", "min_distance"]),
    ]:
        assert [name for name in others if hasattr(answer, name)] == []


def cloth():
    """A sheet that folds into itself: a body, and both ends of a step."""
    t0, t1, faces = fold(40, 24.0)
    return nm.Body(t0, faces), (t0, t1)


def three(detector):
    """The queries of every step of a barrier method."""
    return detector.near(1e-3), detector.earliest(), detector.discrete()


def memory(ask_one, ask_all):
    """Device memory of several queries, as a part of that of one."""
    body, ends = cloth()
    held = []
    for ask in (ask_one, ask_all):
        device = nm.Device("cpu")
        kept = ask(body, device, ends)
        held.append(device.bytes[0])
        del kept
    return held[1] / held[0]


def earliest_alone(body, device, ends):
    detector = nm.Detector(body, device=device)
    detector.step({0: ends}, nm.Earliest())
    return detector


def by_one(body, device, ends):
    detector = nm.Detector(body, device=device)
    detector.update({0: ends})
    three(detector)
    return detector


def by_three(body, device, ends):
    detectors = [nm.Detector(body, device=device) for _ in range(3)]
    for detector, query in zip(detectors, [nm.Near(1e-3), nm.Earliest(), nm.Discrete()]):
        detector.step({0: ends}, query)
    return detectors


def test_three_queries_take_at_most_1_3_times_the_memory_of_one():
    assert 1 < memory(earliest_alone, by_one) <= 1.3
    # Detectors of their own take more: the meter sees it.
    assert memory(earliest_alone, by_three) > 1.3


def test_positions_are_uploaded_once_for_any_number_of_queries():
    body, ends = cloth()
    # Not packed, so they are copied.
    ends = tuple(np.asfortranarray(end) for end in ends)
    device = nm.Device("cpu")
    detector = nm.Detector(body, device=device)
    for _ in range(2):
        # Lists grow at first.
        detector.update({0: ends})
        three(detector)
    uploaded = [device.uploaded]
    for ask in [lambda: detector.update({0: ends}), lambda: three(detector), lambda: detector.step({0: ends}, nm.Discrete())]:
        ask()
        uploaded.append(device.uploaded)
    update, queries, again = np.diff(uploaded).tolist()
    assert update >= ends[0].nbytes + ends[1].nbytes and queries == 0 and again == update


def test_numbers_change_and_build_nothing():
    scene, vertices = bodies(3)
    device = nm.Device("cpu")
    detector = nm.Detector(scene, device=device)
    motions = step(np.random.default_rng(3), vertices)
    detector.update(motions)

    def queries(part):
        yield nm.Near(0.2 * part)
        yield nm.Continuous(min_separation=0.1 * part, tolerance=1e-2 * part)
        yield nm.Earliest(min_separation=0.1 * part, max_iterations=int(4096 * part))

    for _ in range(2):
        # The first query in motion takes memory again, with both ends of the step.
        for query in queries(1.0):
            detector.query(query)
    before = detector.builds, device.allocations, device.bytes[0]
    for k in range(1, 8):
        for query in queries(k / 8):
            alone = nm.Detector(scene, device=CPU).step(motions, query)
            assert difference(detector.query(query), alone) is None
    assert (detector.builds, device.allocations, device.bytes[0]) == before
    # A query of another shape takes memory and is built: the counters see it.
    detector.query(nm.research.configure(nm.Near(0.2), broad_phase="tree"))
    after = detector.builds, device.allocations, device.bytes[0]
    assert all(new > old for new, old in zip(after, before))


def test_one_submission_holds_several_queries():
    body, ends = cloth()
    start, end = (np.ascontiguousarray(end) for end in ends)
    detector = nm.Detector(body, device=nm.Device("cpu"))
    queries = [nm.Near(1e-3), nm.Earliest(), nm.Discrete()]
    assert detector.prepare({0: (start, end)}, queries) is None
    assert detector.is_prepared and all(detector.on_device(query) for query in queries)
    assert detector.on_device(nm.Continuous()) is None and detector.on_device(nm.Near(2e-3)) is None
    for k in range(3):
        start[:, 1] *= 0.999
        end[:, 1] *= 0.998
        detector.submit()
        found = [detector.collect(query) for query in queries]
        alone = nm.Detector(body, device=CPU)
        alone.update({0: (start.copy(), end.copy())})
        for query, answer in zip(queries, found):
            assert difference(answer, alone.query(query)) is None, f"step {k}"
        # The answer that was collected first has places still.
        assert len(detector.geometry(found[0])) == len(found[0]) > 0
        if not detector.is_prepared:
            detector.prepare({0: (start, end)}, queries)


def test_answers_are_old_after_the_next_submission():
    body, ends = cloth()
    start, end = (np.ascontiguousarray(end) for end in ends)
    detector = nm.Detector(body, device=nm.Device("cpu"))
    near, every = nm.Near(1e-3), nm.Continuous()
    detector.prepare({0: (start, end)}, [near, every])
    detector.submit()
    first = detector.collect(near)
    # Another query of the same submission; the same one only after a recording ran again.
    assert len(detector.geometry(detector.collect(every))) > 0 and len(detector.geometry(first)) > 0
    again = detector.collect(near)
    for move in [lambda: None, detector.submit]:
        move()
        with pytest.raises(nm.InvalidArgumentError, match="before bodies moved"):
            detector.geometry(first)
    with pytest.raises(nm.InvalidArgumentError, match="before bodies moved"):
        detector.geometry(again)


def test_a_submission_without_a_query_or_with_two_of_one_shape_is_refused():
    body, (start, end) = cloth()
    detector = nm.Detector(body, device=CPU)
    motions = {0: (start.copy(), end.copy())}
    for queries, text in [
        ([], "at least one query"),
        ([nm.Near(1e-3), nm.Earliest(), nm.Near(2e-3)], "two near queries"),
        (nm.Near(1e-3), r"got Near; use \[query\]"),
        ([nm.Near], "got list"),
        ("near", "got str"),
    ]:
        with pytest.raises(nm.InvalidArgumentError, match=text):
            detector.prepare(motions, queries)


def test_positions_come_back():
    vertices, faces = sheet(6)
    body, rigid = nm.Body(vertices, faces), nm.Body(vertices, faces, kind="rigid")
    detector = nm.Detector(nm.Scene(body, rigid, nm.Body(vertices, faces, kind="fixed")), device=CPU)
    ends, poses = (vertices + 1, vertices - 1), (nm.Pose(), nm.Pose(translation=(0, 0, 2)))
    detector.update({0: ends, 1: poses})
    detector.discrete()
    found = detector.download_positions(0)
    assert isinstance(found, tuple) and all(np.array_equal(a, b) for a, b in zip(found, ends))
    assert detector.download_positions(1) == poses
    assert all(np.array_equal(end, vertices) for end in detector.download_positions(2))
    # At rest both are equal: a body that no update names rests where its step ended.
    detector.update({})
    assert all(np.array_equal(end, ends[1]) for end in detector.download_positions(0))
    with pytest.raises(nm.InvalidArgumentError, match="body 3 is not in the scene"):
        detector.download_positions(3)


def test_positions_of_a_submission_come_back_and_end_nothing():
    body, (t0, t1) = cloth()
    start, end = t0.copy(), t1.copy()
    detector, near = nm.Detector(body, device=CPU), nm.Near(1e-3)
    detector.prepare({0: (start, end)}, [near])
    for _ in range(2):
        start *= 1.01
        end *= 0.99
        detector.submit()
        answer = detector.on_device(near)
        found = detector.download_positions(0)
        assert all(np.array_equal(a, b) for a, b in zip(found, (start, end))) and detector.is_prepared
        assert np.from_dlpack(answer.status)[:2].sum() == len(detector.collect(near)) > 0


def test_an_update_keeps_no_array_of_a_cpu():
    vertices, faces = sheet(20)
    detector = nm.Detector(nm.Body(vertices, faces), device=CPU)
    for ask in [lambda: None, lambda: detector.near(0.01)]:
        ask()
        here = vertices + 1
        gone = weakref.ref(here)
        detector.update({0: here})
        here[:] = np.nan
        del here
        gc.collect()
        assert gone() is None and len(detector.near(0.01)) == 0


def test_a_memory_limit_is_kept():
    vertices, faces = sheet(60)
    body = nm.Body(vertices, faces)
    whole = nm.Device("cpu")
    wanted = nm.Detector(body, device=whole).near(0.02).hash
    limit = whole.bytes[1]
    device = nm.Device("cpu", memory_limit=limit)
    assert nm.Detector(body, device=device).near(0.02).hash == wanted and device.bytes[1] <= limit
    with pytest.raises(nm.OutOfMemory):
        nm.Detector(body, device=nm.Device("cpu", memory_limit=10_000)).near(0.02)
