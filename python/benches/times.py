"""What a caller in Python waits for, milliseconds, the median of many frames: a sheet that folds into itself.

    python benches/times.py [cells a side, default 214: 91,592 triangles]
"""

import sys
import time
from statistics import median

import numpy as np

import nearmiss as nm


def fold(n):
    """A sheet folded in two whose halves pass through each other along a strip: vertices at two times, and faces."""
    x, y = (axis.ravel() / n for axis in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    half = np.clip(40 * (x - 0.5), -1, 1)
    wave = 0.1 * np.sin(25 * np.abs(x - 0.5)) * np.cos(9 * y)
    ends = [wave + half * gap for gap in (np.full(y.shape, 0.003), np.clip(0.1 * y - 0.005, -0.003, 0.003))]
    t0, t1 = (np.stack([np.abs(x - 0.5), y, z], axis=1).astype(np.float32) for z in ends)
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    a, b, c, d = i * (n + 1) + j, (i + 1) * (n + 1) + j, i * (n + 1) + j + 1, (i + 1) * (n + 1) + j + 1
    return t0, t1, np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])


def wait(call, times):
    """The median wait for a call, after two to warm up."""
    taken = []
    for _ in range(times + 2):
        begin = time.perf_counter()
        call()
        taken.append(1e3 * (time.perf_counter() - begin))
    return median(taken[2:])


def main():
    t0, t1, faces = fold(int(sys.argv[1]) if len(sys.argv) > 1 else 214)
    device = nm.Device()
    on_gpu = device.backend == "cuda"
    times = 100 if on_gpu else 5
    if on_gpu:
        import torch

        torch.zeros(1, device="cuda")
        stream = torch.cuda.Stream()
        device = nm.Device(stream=stream)
    print(f"{len(faces):,} triangles on {device.name}; milliseconds of the caller")
    for query in [nm.Discrete(), nm.Continuous(), nm.Earliest(), nm.Near(0.25 / 214)]:
        detector = nm.Detector(nm.Body(t1, faces), query, device)
        still = isinstance(query, (nm.Discrete, nm.Near))
        given = {0: t1 if still else (t0, t1)}
        found = detector.frame(given)
        row = [f"numpy {wait(lambda: detector.frame(given), times):.3f}"]
        row.append(f"as before {wait(detector.detect, times):.3f}")
        if on_gpu:
            ends = tuple(torch.from_numpy(end).cuda() for end in (t0, t1))
            lent = {0: ends[1] if still else ends}
            assert detector.frame(lent).hash == found.hash
            row.append(f"tensors {wait(lambda: detector.frame(lent), times):.3f}")
            detector.prepare(lent)

            def submitted():
                detector.submit()
                stream.synchronize()

            row.append(f"submitted and waited for {wait(submitted, times):.3f}")
        print(f"{query!r}: {len(found):,} found; {', '.join(row)}")


main()
