"""Times of a caller in Python, the median of many frames in milliseconds: a sheet that folds into itself.

    python times.py [cells a side, default 214: 91,592 triangles]
"""

import sys
import time
from statistics import median

import numpy as np
from sheets import fold

import nearmiss as nm


def wait(call, times):
    """The median time of a call, after two to warm up."""
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
        detector = nm.Detector(nm.Body(t1, faces), device=device)
        rests = isinstance(query, (nm.Discrete, nm.Near))
        given = {0: t1 if rests else (t0, t1)}
        found = detector.step(given, query)
        row = [f"numpy {wait(lambda: detector.step(given, query), times):.3f}"]
        row.append(f"as before {wait(lambda: detector.query(query), times):.3f}")
        if on_gpu:
            ends = tuple(torch.from_numpy(end).cuda() for end in (t0, t1))
            tensors = {0: ends[1] if rests else ends}
            assert detector.step(tensors, query).hash == found.hash
            row.append(f"tensors {wait(lambda: detector.step(tensors, query), times):.3f}")
            detector.prepare(tensors, [query])

            def submitted():
                detector.submit()
                stream.synchronize()

            row.append(f"submitted and waited for {wait(submitted, times):.3f}")
        print(f"{found!r}; {', '.join(row)}")


main()
