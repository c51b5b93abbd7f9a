"""On two GPUs: arrays of either, for detectors on one and on both. Skipped, visibly, where there are fewer."""

import numpy as np
import pytest
from test_several import QUERIES, scene

import nearmiss as nm

torch = pytest.importorskip("torch")
pytestmark = pytest.mark.skipif(torch.cuda.device_count() < 2, reason="fewer than two GPUs")


def test_arrays_of_one_gpu_are_read_by_all():
    all, steps = scene()
    one = nm.Detector(scene()[0], device=nm.Device("cpu"))
    one.update(steps)
    several = nm.MultiDetector(all, [nm.Device(gpu=gpu) for gpu in range(2)])
    for gpu in range(2):
        arrays = dict(steps)
        for body in range(2):
            arrays[body] = tuple(torch.tensor(end, device=f"cuda:{gpu}") for end in steps[body])
        several.update({body: step[0] if body < 2 else step for body, step in steps.items()})
        several.update(arrays)
        # They were read.
        for body in range(2):
            arrays[body][1].fill_(float("nan"))
        for query in QUERIES:
            assert several.query(query).hash == one.query(query).hash, (gpu, query)
        with pytest.raises(nm.InputError):
            several.update(arrays)
            several.query(QUERIES[2])
    arrays[0] = tuple(torch.tensor(end, device="cuda:1") for end in steps[0])
    for detector in [
        nm.MultiDetector(scene()[0], [nm.Device(gpu=0)]),
        nm.Detector(scene()[0], device=nm.Device(gpu=0)),
    ]:
        with pytest.raises(nm.InvalidArgumentError, match="on GPU 1, and the detector is on GPU 0"):
            detector.update({0: arrays[0]})
    other = nm.Detector(scene()[0], device=nm.Device(gpu=1))
    other.update({0: arrays[0], 1: steps[1], 2: steps[2]})
    assert other.query(QUERIES[0]).hash == one.query(QUERIES[0]).hash
    mixed = nm.MultiDetector(scene()[0], [nm.Device(gpu=0), nm.Device("cpu")])
    arrays[0] = tuple(torch.tensor(end, device="cuda:0") for end in steps[0])
    with pytest.raises(nm.InvalidArgumentError, match="a GPU and a CPU"):
        mixed.update({0: arrays[0]})


def test_submissions_copy_the_arrays_of_either_gpu():
    all, steps = scene()
    queries = [nm.Discrete(), nm.Continuous(), nm.Earliest(), nm.Near(0.01)]
    one = nm.Detector(scene()[0], device=nm.Device("cpu"))
    streams = [torch.cuda.Stream(device=gpu) for gpu in range(2)]
    several = nm.MultiDetector(all, [nm.Device(stream=stream) for stream in streams])
    several.update({2: steps[2][0]})
    one.update({2: steps[2][0]})
    for gpu in range(2):
        # One body on this GPU, the other on the other.
        places = [f"cuda:{(gpu + body) % 2}" for body in range(2)]
        arrays = {b: tuple(torch.tensor(end, device=places[b]) for end in steps[b]) for b in range(2)}
        torch.cuda.synchronize(0)
        torch.cuda.synchronize(1)
        several.prepare(arrays, queries)
        for frame in range(4):
            moved = {b: tuple(np.array(end) + 0.003 * frame * (1 + k) for k, end in enumerate(steps[b])) for b in range(2)}
            if not several.is_prepared:
                several.prepare(arrays, queries)
            # Behind the copies of the last submission, and in front of those of the next.
            for body in range(2):
                with torch.cuda.stream(streams[(gpu + body) % 2]):
                    for array, end in zip(arrays[body], moved[body]):
                        array.copy_(torch.from_numpy(end).pin_memory(), non_blocking=True)
            several.submit()
            for body in range(2):
                with torch.cuda.stream(streams[(gpu + body) % 2]):
                    for array in arrays[body]:
                        array.fill_(float("nan"))
            one.update(moved)
            for query in queries:
                parts = several.on_device(query) if several.is_prepared else []
                for at, part in enumerate(parts):
                    with torch.cuda.stream(streams[at]):
                        assert torch.from_dlpack(part.status).device.index == at
                assert several.collect(query).hash == one.query(query).hash, (gpu, frame, query)
