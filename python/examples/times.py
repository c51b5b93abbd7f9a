"""What a caller in Python waits for, milliseconds, the median of many frames: a sheet that folds into itself.

    python times.py [cells a side, default 214: 91,592 triangles]
"""

import sys
import time
from statistics import median

import numpy as np
from sheets import fold

import nearmiss as nm


def wait(call, times):
    """The median wait for a call, after two to warm up."""
    taken = []
    for _ in range(times + 2):
        begin = time.perf_counter()
        call()
        taken.append(1e3 * (time.perf_counter() - begin))
    return median(taken[2:])


def main():
    *ends, faces = fold(int(sys.argv[1]) if len(sys.argv) > 1 else 214, 40)
    t0, t1 = (end.astype(np.float32) for end in ends)
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
