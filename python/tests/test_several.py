"""One scene on several devices: the answers of one."""

import threading

import numpy as np
import pytest
from shapes import sheet

import nearmiss
from nearmiss import Continuous, Discrete, Earliest, Near


def soup(count, seed):
    random = np.random.default_rng(seed)
    t0 = (random.random((count, 1, 3)) + random.normal(0, 0.04, (count, 3, 3))).reshape(-1, 3)
    t1 = t0 + random.normal(0, 0.05, t0.shape)
    return t0, t1, np.arange(3 * count).reshape(-1, 3)


def scene(count=400):
    """Two soups that move through each other, and a box that turns."""
    all, steps = nearmiss.Scene(), {}
    for seed in range(2):
        t0, t1, faces = soup(count, seed)
        steps[all.add(nearmiss.Body(t0, faces, name=f"soup {seed}"))] = (t0, t1)
    box = all.add(nearmiss.Body(*sheet(5), name="plate", kind="rigid"))
    steps[box] = (nearmiss.Pose(), nearmiss.Pose([0, 0, np.sin(0.2), np.cos(0.2)], [0, 0, 0.3]))
    return all, steps


def devices(count):
    return [nearmiss.Device("cpu", threads=1) for _ in range(count)]


QUERIES = [Discrete(), Discrete(adjacent=True), Continuous(), Continuous(min_separation=0.002), Earliest(), Near(0.01)]


def same(a, b):
    """Whether two answers are equal, to the bit, in rows and figures."""
    assert type(a) is type(b)
    assert a.caveats == b.caveats
    return a.hash == b.hash


@pytest.mark.parametrize("count", [1, 2, 3])
def test_answers_are_those_of_one_device(count):
    one = nearmiss.Detector(scene()[0], device=nearmiss.Device("cpu"))
    several = nearmiss.MultiDetector(scene()[0], devices(count))
    steps = scene()[1]
    one.update(steps)
    several.update(steps)
    for query in QUERIES:
        a, b = one.query(query), several.query(query)
        assert same(a, b), query
        if not isinstance(query, Earliest):
            assert len(a) > 10
            assert type(one.geometry(a)) is type(several.geometry(b))
        shares = several.shares(query)
        assert len(shares) == count and abs(sum(share["tiles"] for share in shares) - 1) < 1e-9
    first = one.first_contacts(one.earliest())
    assert len(first) > 0 and same(first, several.first_contacts(several.query(Earliest())))
    # Curves, rows by feature and places, too.
    a, b = one.discrete(), several.query(Discrete())
    wanted, curves = one.curves(a), several.curves(b)
    assert len(wanted) > 10
    for column in ["points", "starts", "is_closed", "rows", "groups", "row_groups"]:
        np.testing.assert_array_equal(getattr(wanted, column), getattr(curves, column))
    a, b = one.near(0.01), several.query(Near(0.01))
    for by in ["vertex", "edge", "face", "corner"]:
        for wanted, found in zip(one.grouped(a, 1, by), several.grouped(b, 1, by), strict=True):
            np.testing.assert_array_equal(wanted, found)
    least = several.least_by_vertex(b, "soup 1")
    assert np.isfinite(least).any()
    np.testing.assert_array_equal(one.least_by_vertex(a, 1), least)
    with pytest.raises(nearmiss.InvalidArgumentError, match="of another detector"):
        several.grouped(a, 1)
    a, b = one.geometry(one.near(0.01)), several.geometry(several.query(Near(0.01)))
    for column in ["owner", "vertices", "weights", "points", "normals"]:
        np.testing.assert_array_equal(getattr(a, column), getattr(b, column))


@pytest.mark.parametrize("count", [1, 2, 3])
def test_submissions_are_those_of_one_device(count):
    (all, steps), queries = scene(), [Discrete(), Continuous(), Earliest(), Near(0.01)]
    one = nearmiss.Detector(scene()[0], device=nearmiss.Device("cpu"))
    several = nearmiss.MultiDetector(all, devices(count))
    arrays = {body: tuple(np.array(end) for end in steps[body]) for body in range(2)}
    one.update({2: steps[2][0]})
    several.update({2: steps[2][0]})
    assert several.on_device(Discrete()) is None
    several.prepare(arrays, queries)
    for frame in range(3):
        for start, end in arrays.values():
            start += 0.002 * frame
            end -= 0.001 * frame
        if not several.is_prepared:
            several.prepare(arrays, queries)
        several.submit()
        one.update(arrays)
        for query in queries:
            if several.is_prepared:
                parts = several.on_device(query)
                counts = [int(np.from_dlpack(part.status)[:2].sum()) for part in parts]
                assert len(parts) == count and (isinstance(query, Earliest) or sum(counts) == len(one.query(query)))
            assert same(one.query(query), several.collect(query)), (frame, query)
    # A call that changes the detector ends the preparation, and the answers on the devices.
    several.prepare(arrays, queries)
    several.submit()
    status = several.on_device(Discrete())[-1].status
    assert several.is_prepared and np.from_dlpack(status)[2] == 0
    several.update(arrays)
    assert not several.is_prepared
    with pytest.raises(nearmiss.InvalidArgumentError, match="the answer on the device is gone"):
        np.from_dlpack(status)
    with pytest.raises(nearmiss.InvalidArgumentError, match="not prepared"):
        several.submit()
    with pytest.raises(nearmiss.InvalidArgumentError, match="in place by a submission"):
        several.prepare({0: np.asfortranarray(steps[0][0])}, queries)
    if count > 1:
        with pytest.raises(nearmiss.InvalidArgumentError, match="several devices"):
            several.prepare(arrays, [nearmiss.Distance()])


def test_another_answer_is_noticed():
    several = nearmiss.MultiDetector(scene()[0], devices(2))
    several.update(scene()[1])
    assert not same(several.query(Near(0.01)), several.query(Near(0.011)))


def test_scenes_change_alike():
    one = nearmiss.Detector(scene()[0], device=nearmiss.Device("cpu"))
    several = nearmiss.MultiDetector(scene()[0], devices(2))
    vertices, faces = sheet(6)
    steps = scene()[1]
    changes = [
        lambda d: d.add(nearmiss.Body(vertices + [0, 0, 0.5], faces, name="sheet")),
        lambda d: d.leave_out([("soup 0", "sheet"), (1, 2)]),
        lambda d: d.set_thickness("sheet", 0.02),
        lambda d: d.exclude(0, ring=1),
        lambda d: d.exclude("soup 1", within=0.02),
        lambda d: d.exclude_pairs("soup 0", "soup 1", [[0, 0], [5, 9]]),
        lambda d: d.replace(0, nearmiss.Body(*soup(300, 7)[::2], name="other")),
        lambda d: d.remove("sheet"),
    ]
    seen = set()
    for change in changes:
        change(one), change(several)
        assert one.bodies == several.bodies and one.left_out == several.left_out
        seen.add(several.query(Near(0.01)).hash)
        assert same(one.near(0.01), several.query(Near(0.01)))
        moved = {body: steps[body] for body in (1, 2)}
        question = Continuous(min_separation=0.001)
        assert same(one.step(moved, question), several.step(moved, question))
    assert len(seen) > 5, "changes that change nothing"


def test_a_device_may_be_there_twice():
    device = nearmiss.Device("cpu", threads=1)
    one = nearmiss.Detector(scene()[0], device=device)
    several = nearmiss.MultiDetector(scene()[0], [device, device])
    assert several.devices == [device, device]
    assert same(one.near(0.01), several.query(Near(0.01)))
    assert repr(several) == "<nearmiss.MultiDetector: 3 bodies, 2 devices>"


def test_one_body_is_a_scene():
    t0, t1, faces = soup(300, 3)
    several = nearmiss.MultiDetector(nearmiss.Body(t0, faces), devices(2))
    found = several.step({0: (t0, t1)}, Continuous())
    assert len(found) == len(nearmiss.contacts(t0, t1, faces)) > 0


def refused(call, text, error=nearmiss.InvalidArgumentError):
    with pytest.raises(error, match=text):
        call()


def test_bad_input_is_refused_and_nothing_has_moved():
    refused(lambda: nearmiss.MultiDetector(scene()[0], []), "no device")
    several = nearmiss.MultiDetector(scene()[0], devices(2))
    t0 = scene()[1][0][0]
    several.update({0: t0})
    before = several.query(Near(0.01))
    refused(lambda: several.update({9: t0}), "body 9 is not in the scene")
    refused(lambda: several.update({0: t0[:-1]}), "1199", nearmiss.InputError)
    bad = t0.copy()
    bad[17, 1] = np.nan
    refused(lambda: several.update({0: bad}), "17", nearmiss.InputError)
    refused(lambda: several.update([t0]), "mapping")
    refused(lambda: several.query(Continuous()), "two ends|moves")
    for query in [nearmiss.Distance(), nearmiss.BodyPairs(), nearmiss.BodyDistances(0.1)]:
        refused(lambda query=query: several.query(query), "device")
    refused(lambda: several.leave_out([(0, 0)]), "itself|0")
    refused(lambda: several.set_thickness(0, -1), "thickness")
    refused(lambda: several.exclude(0, ring=0), "ring")
    refused(lambda: several.remove("missing"), "missing")
    assert same(before, several.query(Near(0.01)))


def test_answers_of_other_places_are_refused():
    several = nearmiss.MultiDetector(scene()[0], devices(2))
    other = nearmiss.Detector(scene()[0], device=nearmiss.Device("cpu"))
    before = several.query(Near(0.01))
    several.geometry(before)
    refused(lambda: several.geometry(other.near(0.01)), "another detector")
    refused(lambda: other.geometry(before), "another detector")
    several.update({0: scene()[1][0][1]})
    refused(lambda: several.geometry(before), "before bodies moved")


def test_arrays_are_copied():
    t0, _, faces = soup(300, 3)
    several = nearmiss.MultiDetector(nearmiss.Body(t0, faces), devices(2))
    given = t0.copy()
    several.update({0: given})
    before = several.query(Near(0.01))
    given += np.random.default_rng(1).normal(0, 0.1, given.shape)
    assert same(before, several.query(Near(0.01)))


def test_threads_share_devices_by_turns():
    # In another order for each detector: none waits for the other for ever.
    a, b = devices(2)
    detectors = [nearmiss.MultiDetector(scene(150)[0], both) for both in ([a, b], [b, a], [a, a])]
    expected = detectors[0].query(Near(0.01)).hash
    hashes = []

    def work(detector):
        for _ in range(20):
            hashes.append(detector.query(Near(0.01)).hash)

    threads = [threading.Thread(target=work, args=(detector,)) for detector in detectors]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120)
        assert not thread.is_alive()
    assert hashes == [expected] * 60


def test_an_interrupt_ends_a_call_and_no_other():
    several = nearmiss.MultiDetector(scene()[0], devices(2))
    before = several.query(Near(0.01))
    several.interrupt()
    refused(lambda: several.query(Near(0.01)), "interrupted", nearmiss.Interrupted)
    assert same(before, several.query(Near(0.01)))
