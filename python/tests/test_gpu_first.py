"""The contacts at the earliest time on a GPU, in a graph of torch: bit by bit those of the host.

Run as a program it prints what they cost: microseconds of a launched graph without and with them.
"""

import numpy as np
import pytest
from test_first_on_device import falling, listed
from test_gpu import draped, stream  # noqa: F401, a fixture

import nearmiss as nm

torch = pytest.importorskip("torch")
pytestmark = pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU")


def recorded(detector, ends, query, stream, first_contacts):  # noqa: F811
    """A graph of a submission, once the detector is prepared."""
    detector.prepare({0: ends}, [query], first_contacts=first_contacts)
    graph = torch.cuda.CUDAGraph()
    with torch.cuda.graph(graph, stream=stream):
        detector.submit()
    return graph


def shown(answer):
    """The status, and the rows in order of their names."""
    numpy = lambda array: torch.from_dlpack(array).cpu().numpy().copy()  # noqa: E731
    status, rows = numpy(answer.status), []
    if status[2]:
        return status, rows
    names = ("feature_a", "feature_b", "toi", "toi_upper")
    for edges, (count, columns) in enumerate(zip(status, answer.lists)):
        rows += [(edges, *row) for row in zip(*(numpy(columns[name])[:count].tolist() for name in names))]
    return status, sorted(rows)


def cases():
    """A folding sheet in steps of a tenth, and tips that land together, one by one, and not at all."""
    t0, t1, faces = draped(60)
    yield faces, [(t0 + 0.1 * k * (t1 - t0), t0 + 0.1 * (k + 1) * (t1 - t0)) for k in range(10)]
    ends = []
    for heights in ([0.5] + [1.25] * 2999, [1.25] * 3000, [5.0] * 3000, [0.0, 1.0] * 1500):
        start, faces = falling(heights)
        ends.append((start, start - [0, 0, 2] * (np.arange(len(start)) > 3)[:, None]))
    yield faces, ends


def test_first_contacts_in_a_graph_are_those_of_the_host(stream):  # noqa: F811
    for query in (nm.Earliest(), nm.Earliest(min_separation=1e-3)):
        for faces, frames in cases():
            body = nm.Body(frames[0][0], faces)
            detector, cpu = nm.Detector(body, device=nm.Device(stream=stream)), nm.Detector(body, device=nm.Device("cpu"))
            ends = tuple(torch.from_numpy(end).cuda() for end in frames[0])
            graph, counts = None, []
            for frame in frames:
                for to, points in zip(ends, frame):
                    to.copy_(torch.from_numpy(points))
                while True:
                    if graph is None or not detector.is_prepared:
                        graph = recorded(detector, ends, query, stream, True)
                    graph.replay()
                    status, rows = shown(detector.on_device(query))
                    first = detector.collect(query)
                    if not status[2]:
                        break
                cpu.update({0: frame})
                wanted = cpu.query(query)
                assert first.toi == wanted.toi
                assert rows == listed(cpu.first_contacts(wanted))
                counts.append(len(rows))
            assert sum(counts) > 0, (query, counts)


def timed(graph, stream, launches=200):  # noqa: F811
    """Median microseconds of a launched graph."""
    begin, end = torch.cuda.Event(enable_timing=True), torch.cuda.Event(enable_timing=True)
    took = []
    for _ in range(launches):
        begin.record(stream)
        graph.replay()
        end.record(stream)
        end.synchronize()
        took.append(1e3 * begin.elapsed_time(end))
    return float(np.median(took[launches // 10 :]))


def main():
    torch.zeros(1, device="cuda")
    stream = torch.cuda.Stream()  # noqa: F811
    with torch.cuda.stream(stream):
        t0, t1, faces = draped(300)
        apart, sheet = t0 + [0, 0, 1e-3], t0 + 0.6 * (t1 - t0)
        tips, tip_faces = falling([1.25] * 20_000)
        low = tips - [0, 0, 2] * (np.arange(len(tips)) > 3)[:, None]
        scenes = [
            ("a folding sheet, 180,000 triangles", faces, (sheet, t1)),
            ("the same, nothing meets", faces, (t0, apart)),
            ("20,000 tips land at once", tip_faces, (tips, low)),
        ]
        print(f"{torch.cuda.get_device_name()}, median microseconds of a launched graph")
        for name, faces, points in scenes:
            for separation in (0.0, 1e-4):
                query = nm.Earliest(min_separation=separation)
                took = []
                for first_contacts in (False, True):
                    body = nm.Body(points[0], faces)
                    detector = nm.Detector(body, device=nm.Device(stream=stream))
                    ends = tuple(torch.from_numpy(end).cuda() for end in points)
                    took.append(timed(recorded(detector, ends, query, stream, first_contacts), stream))
                    status = torch.from_dlpack(detector.on_device(query).status).cpu().numpy()
                print(f"{name}, separation {separation}: {took[0]:.0f}, with them {took[1]:.0f}; {status[:2].sum()} rows")


if __name__ == "__main__":
    main()
