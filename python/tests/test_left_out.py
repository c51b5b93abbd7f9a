"""Pairs of bodies that a list leaves out have no rows; all others stay."""

import numpy as np
import pytest
from shapes import soup

import nearmiss as nm

CPU = nm.Device("cpu")
NAMES = ["base", "arm", "hand", "wall"]


def scene(pairs=None):
    """Four bodies around one place, none tested against itself."""
    kinds = ["deformable", "rigid", "rigid", "fixed"]
    bodies = (
        nm.Body(*soup(40, seed, 0.4), kind=kind, name=name, self_collision=False)
        for seed, (kind, name) in enumerate(zip(kinds, NAMES))
    )
    made = nm.Scene(*bodies)
    if pairs is not None:
        made.leave_out(pairs)
    return made


def rows(answer):
    """The rows of an answer, as tuples that begin with both bodies."""
    if isinstance(answer, nm.TrianglePairs):
        columns = [answer.bodies, answer.triangles]
    else:
        columns = [answer.bodies, answer.kind, answer.feature_a, answer.feature_b]
    return list(map(tuple, np.column_stack(columns).tolist()))


def less(whole, pairs):
    """Rows without those of pairs of numbers."""
    left = [set(pair) for pair in pairs]
    return [row for row in whole if set(row[:2]) not in left]


@pytest.mark.parametrize("query", [nm.Discrete(), nm.Near(0.05)])
def test_an_answer_has_all_rows_but_those_of_the_pairs(query):
    whole = rows(nm.Detector(scene(), device=CPU).query(query))
    detector = nm.Detector(scene(), device=CPU)
    detector.query(query)
    for pairs, numbers in [
        ([("base", "arm")], [(0, 1)]),
        ([(2, 1), (1, 2), ("wall", 0)], [(0, 3), (1, 2)]),
        (np.array([[1, 0], [3, 2]]), [(0, 1), (2, 3)]),
        (((name, other) for name in NAMES[:1] for other in NAMES[1:]), [(0, 1), (0, 2), (0, 3)]),
        ([], []),
    ]:
        pairs = list(pairs)
        detector.leave_out(pairs)
        assert detector.left_out == numbers
        found = rows(detector.query(query))
        assert found == less(whole, numbers) and (len(found) < len(whole)) == bool(numbers)
        copied = scene(pairs)
        assert copied.left_out == numbers
        assert rows(nm.Detector(copied, device=CPU).query(query)) == found


def test_a_removed_body_takes_its_pairs_and_a_replaced_one_keeps_them():
    detector = nm.Detector(scene([(0, 1), (1, 2), (0, 3)]), device=CPU)
    detector.replace("wall", nm.Body(*soup(30, 9, 0.4), kind="fixed"))
    assert detector.left_out == [(0, 1), (0, 3), (1, 2)]
    detector.remove("arm")
    assert detector.left_out == [(0, 3)]
    assert detector.add(nm.Body(*soup(30, 8, 0.4), kind="rigid")) == 1
    assert {(0, 1), (1, 2)} <= {row[:2] for row in rows(detector.discrete())}


def test_another_list_ends_a_preparation_and_the_same_does_not():
    detector = nm.Detector(scene([(0, 1)]), device=CPU)
    vertices = np.ascontiguousarray(soup(40, 0, 0.4)[0])
    detector.prepare({0: vertices}, [nm.Discrete()])
    detector.leave_out([(1, 0), (0, 1)])
    assert detector.is_prepared
    before = detector.collect(nm.Discrete())
    assert detector.geometry(before) is not None
    detector.leave_out([(1, 0), (0, 2)])
    assert not detector.is_prepared
    with pytest.raises(nm.InvalidArgumentError, match="prepare"):
        detector.submit()
    detector.prepare({0: vertices}, [nm.Discrete()])
    detector.submit()
    assert rows(detector.collect(nm.Discrete())) == less(rows(before), [(0, 2)])


WRONG = [
    ([(0, 7)], "body 7 is not in the scene"),
    ([(0, "leg")], 'no body is named "leg"'),
    ([(2, 2)], "it is body 2 with itself; set `self_collision`"),
    ([("hand", 2)], "it is body 2 with itself"),
    ([(0, 1, 2)], "pairs must be a list of pairs of bodies, got (0, 1, 2)"),
    ([0, 1], "pairs must be a list of pairs of bodies, got 0"),
    (["ab"], "pairs must be a list of pairs of bodies, got 'ab'"),
    (3, "pairs must be a list of pairs of bodies, got 3"),
    ([(0, 1.5)], "must be body numbers or names, got 1.5"),
]


@pytest.mark.parametrize("pairs, text", WRONG)
def test_a_pair_that_cannot_be_left_out_is_named(pairs, text):
    detector, made = nm.Detector(scene([(0, 1)]), device=CPU), scene([(0, 1)])
    wanted = rows(detector.discrete())
    for one in (detector, made):
        with pytest.raises(nm.InvalidArgumentError) as raised:
            one.leave_out(pairs)
        assert text in str(raised.value) and one.left_out == [(0, 1)]
    assert rows(detector.discrete()) == wanted


def test_a_scene_that_a_detector_has_copied_takes_no_list():
    made = scene()
    nm.Detector(made, device=CPU)
    with pytest.raises(nm.InvalidArgumentError, match="cannot leave out pairs of a scene after a detector has copied it"):
        made.leave_out([(0, 1)])
