"""The contacts at the earliest time in the memory of the device: those of `first_contacts`, bit by bit."""

import numpy as np
import pytest

import nearmiss as nm

CPU = nm.Device("cpu")


def falling(heights):
    """A floor of two triangles and tetrahedra above it, the tip of each at its height."""
    wide = 2.0 * len(heights) + 9
    points = [[-1, -1, 0], [wide, -1, 0], [-1, 9, 0], [wide, 9, 0]]
    faces = [[0, 1, 2], [2, 1, 3]]
    for i, z in enumerate(heights):
        x, first = 2.0 * i, len(points)
        points += [[x, 1, z], [x + 1, 1, z + 1], [x, 2, z + 1], [x - 0.5, 0.5, z + 1]]
        faces += [[first + k for k in face] for face in ([0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2])]
    return np.array(points, float), np.array(faces)


def shown(answer):
    """Rows on the device: whether of edges, both features, both times, in order of their names."""
    status = np.from_dlpack(answer.status)
    rows = []
    for edges, (count, columns) in enumerate(zip(status, answer.lists)):
        a, b, toi, upper = (
            np.from_dlpack(columns[name])[:count] for name in ("feature_a", "feature_b", "toi", "toi_upper")
        )
        rows += [(edges, *row) for row in zip(a.tolist(), b.tolist(), toi.tolist(), upper.tolist())]
    return status, sorted(rows)


def listed(contacts):
    """Rows of an answer of one body, in the same order."""
    edges = (contacts.kind != nm.Kind.VERTEX_FACE).astype(int)
    columns = (edges, contacts.feature_a, contacts.feature_b, contacts.toi, contacts.toi_upper)
    return sorted(zip(*(column.tolist() for column in columns)))


def test_rows_of_each_submission_are_those_of_the_host():
    ends = {"all": [1.25] * 1500, "one": [1.25] * 1499 + [0.5], "none": [5.0] * 1500, "start": [0.0, 1.0] * 750}
    start, faces = falling(ends["one"])
    end, query = start.copy(), nm.Earliest()
    detector = nm.Detector(nm.Body(start, faces), device=CPU)
    host = nm.Detector(nm.Body(start, faces), device=CPU)
    detector.prepare({0: (start, end)}, [query], first_contacts=True)
    shorts, counts = 0, []
    for name in ("one", "all", "none", "start", "all"):
        start[:] = falling(ends[name])[0]
        end[:] = start
        end[4:, 2] -= 2
        while True:
            if not detector.is_prepared:
                detector.prepare({0: (start, end)}, [query], first_contacts=True)
            detector.submit()
            status, rows = shown(detector.on_device(query))
            first = detector.collect(query)
            if not status[2]:
                break
            shorts += 1
            assert not detector.is_prepared
        host.update({0: (start.copy(), end.copy())})
        wanted = host.earliest()
        assert first.toi == wanted.toi
        assert rows == listed(host.first_contacts(wanted))
        counts.append(len(rows))
    assert counts[0::2] == [1, 0, counts[1]] and counts[1] > 1400 and counts[3] == 750 and shorts == 1


def test_other_parts_are_of_these_rows():
    start, faces = falling([0.5, 1.0, 0.5])
    end, query = start - [0, 0, 2] * (np.arange(len(start)) > 3)[:, None], nm.Earliest()
    detector = nm.Detector(nm.Body(start, faces), device=CPU)
    detector.prepare({0: (start, end)}, [query], geometry=True, least_by_vertex=True, first_contacts=True)
    detector.submit()
    answer = detector.on_device(query)
    status, rows = shown(answer)
    least = np.from_dlpack(answer.least_by_vertex)
    weights = np.from_dlpack(answer.geometry["signed_weights"])
    assert status[:3].tolist() == [2, 0, 0] and {row[1] for row in rows} == {4, 12}
    assert np.isfinite(least[[4, 12]]).all() and np.isinf(least[8])
    assert np.abs(weights[:2]).sum() == pytest.approx(4) and not weights[2:].any()
    detector.prepare({0: (start, end)}, [query])
    detector.submit()
    status, rows = shown(detector.on_device(query))
    assert not rows and not status[:2].any() and np.from_dlpack(detector.on_device(query).earliest) > 0


def test_what_has_none_is_refused():
    start, faces = falling([0.5])
    end = start - 1
    detector = nm.Detector(nm.Body(start, faces), device=CPU)
    with pytest.raises(nm.InvalidArgumentError, match="need an earliest query, got continuous, near"):
        detector.prepare({0: (start, end)}, [nm.Continuous(), nm.Near(0.1)], first_contacts=True)
    several = nm.MultiDetector(nm.Body(start, faces), devices=[CPU, CPU])
    with pytest.raises(nm.InvalidArgumentError, match="several devices"):
        several.prepare({0: (start, end)}, [nm.Earliest()], first_contacts=True)


def test_a_fault_in_the_rows_is_noticed():
    """A pair at the time that is dropped, and a later one that is kept."""
    start, faces = falling([0.5, 1.0, 0.5])
    end = start - [0, 0, 2] * (np.arange(len(start)) > 3)[:, None]
    host = nm.Detector(nm.Body(start, faces), device=CPU)
    host.update({0: (start, end)})
    right, every = listed(host.first_contacts(host.earliest())), listed(host.continuous())
    later = next(row for row in every if row not in right)
    assert len(right) == 2 and right != right[1:] and right != sorted([*right, later])
