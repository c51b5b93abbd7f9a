"""The contacts at the earliest time of a step."""

import numpy as np
import pytest

import nearmiss as nm

CPU = nm.Device("cpu")
FLOOR = np.array([[-9, -9, 0], [9, -9, 0], [0, 9, 0]], float)
SHEET = np.array([[0, 0, 1], [1, 0, 2], [0, 1, 1]], float)


def falling(by=3.0):
    scene = nm.Scene(nm.Body(FLOOR, [[0, 1, 2]], kind="fixed", name="floor"))
    sheet = scene.add(nm.Body(SHEET, [[0, 1, 2]], name="sheet"))
    made = nm.Detector(scene, device=CPU)
    made.update({sheet: (SHEET, SHEET - [0, 0, by])})
    return made


def test_the_corners_that_land_first_are_named():
    made = falling()
    first = made.earliest()
    contacts = made.first_contacts(first)
    assert isinstance(contacts, nm.Contacts)
    everything = made.continuous()
    assert set(contacts.toi) == {first.toi}
    assert len(contacts) == (everything.toi == first.toi).sum() < len(everything)
    vertices = contacts.feature_a[contacts.kind == nm.Kind.VERTEX_FACE]
    assert {0, 2} == set(vertices)
    assert contacts.names[0].tolist() == ["sheet", "floor"]
    assert made.geometry(contacts).points.shape[0] == len(contacts)
    assert contacts.starts_crossing == first.starts_crossing == 0


def test_nothing_that_meets_has_no_rows():
    made = falling(by=0.5)
    first = made.earliest()
    assert first.toi is None and len(made.first_contacts(first)) == 0


def test_what_has_none_is_refused():
    made = falling()
    first = made.earliest()
    with pytest.raises(nm.InvalidArgumentError):
        made.first_contacts(made.continuous())
    with pytest.raises(nm.InvalidArgumentError):
        falling().first_contacts(first)
    made.update({1: SHEET})
    with pytest.raises(nm.InvalidArgumentError):
        made.first_contacts(first)
