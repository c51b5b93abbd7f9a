"""Features that are near at the start of a step may rest, slide and part."""

import pickle

import numpy as np
import pytest

import nearmiss as nm

CPU = nm.Device("cpu")
FLOOR = np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], float)
SHEET = np.array([[0, 0, 0.001], [1, 0, 0.001], [0, 1, 0.001]])


def detector(way, dtype=float):
    scene = nm.Scene(nm.Body(FLOOR.astype(dtype), [[0, 1, 2]], kind="fixed"))
    sheet = scene.add(nm.Body(SHEET.astype(dtype), [[0, 1, 2]]))
    made = nm.Detector(scene, device=CPU)
    made.update({sheet: (SHEET.astype(dtype), (SHEET + way).astype(dtype))})
    return made


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("way, toi", [([0, 0, 0], None), ([2, 0, 0], None), ([0, 1, 0.5], None), ([0, 0, -1e-4], 0.0)])
def test_a_sheet_rests_slides_parts_and_sinks(way, toi, dtype):
    made = detector(way, dtype)
    assert made.earliest(min_separation=0.01).toi == 0.0
    assert made.earliest(min_separation=0.01, approaching=True).toi == toi
    found = made.continuous(min_separation=0.01, approaching=True)
    assert (len(found) == 0) == (toi is None)
    assert found.undecided == 0


def test_what_begins_apart_is_as_ever():
    made = detector([0, 0, -0.0005])
    plain, chosen = (made.continuous(min_separation=0.0007, tolerance=1e-9, approaching=on) for on in (False, True))
    assert len(plain) == 3 and np.array_equal(plain.toi, chosen.toi)
    assert np.allclose(plain.toi, 0.6, atol=1e-3)


def test_queries_have_the_choice():
    query = nm.Earliest(min_separation=0.01, approaching=True)
    assert query == pickle.loads(pickle.dumps(query)) != nm.Earliest(min_separation=0.01)
    assert "approaching=True" in repr(query)
    assert detector([0, 0, 1]).query(query).toi is None
    assert nm.Continuous(approaching=True) != nm.Continuous()


def test_a_body_that_may_turn_is_refused():
    turning = nm.PoseStep(nm.Pose(), nm.Pose(rotation=[0, 0, 0.6, 0.8]))
    scene = nm.Scene(nm.Body(FLOOR, [[0, 1, 2]], kind="fixed"))
    sheet = scene.add(nm.Body(SHEET, [[0, 1, 2]], kind="rigid", name="sheet"))
    made = nm.Detector(scene, device=CPU)
    made.update({sheet: turning})
    with pytest.raises(nm.InvalidArgumentError, match="approaching cannot be tested in this step: .*sheet.* may turn"):
        made.earliest(approaching=True)
    assert made.earliest(min_separation=0.01).toi == 0.0
