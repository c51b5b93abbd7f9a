"""On two GPUs: arrays of either, for detectors on one and on both. Skipped, visibly, where there are fewer."""

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
