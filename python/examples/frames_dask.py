"""Frames of a film over a Dask cluster: contacts of each step, compared with those of one process.

    pip install nearmiss "dask[distributed]"
    python frames_dask.py [FILE...] [--slices 4] [--scheduler ADDRESS]

Without files it makes a film of a sheet that folds. Without a scheduler it starts a local cluster
of two processes. Exits with 1 if an answer differs.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np
from dask.distributed import Client, LocalCluster
from sheets import fold

import nearmiss


def contacts(files, tolerance):
    """Hash and number of the contacts of each step from one file to the next."""
    # A worker has a core. For one GPU a worker leave the device out.
    device = nearmiss.Device("cpu", threads=1)
    start, faces = nearmiss.read_mesh(files[0])
    detector = nearmiss.Detector(nearmiss.Body(start, faces), device=device)
    answers = []
    for file in files[1:]:
        end, faces_there = nearmiss.read_mesh(file)
        if not np.array_equal(faces, faces_there):
            raise ValueError(
                f"faces of {file} are not those of {files[0]}; give frames of one mesh"
            )
        found = detector.step({0: (start, end)}, nearmiss.Continuous(tolerance=tolerance))
        answers.append((found.hash, len(found)))
        start = end
    return answers


def sliced(files, count):
    """Slices of a film. The last frame of one is the first of the next, so each step is in one."""
    ends = np.linspace(0, len(files) - 1, count + 1).astype(int)
    return [files[a : b + 1] for a, b in zip(ends, ends[1:]) if a < b]


def film(folder, frames):
    """The files of a film of a sheet that folds in two."""
    files = []
    flat, folded, faces = fold(30, 40)
    for frame in range(frames):
        vertices = flat + frame / (frames - 1) * (folded - flat)
        file = Path(folder) / f"sheet.{frame:04}.obj"
        with open(file, "w", encoding="utf-8") as rows:
            np.savetxt(rows, vertices, "v %.17g %.17g %.17g")
            np.savetxt(rows, faces + 1, "f %d %d %d")
        files.append(str(file))
    return files


def differences(answers, expected):
    """A line for each step whose answer differs."""
    if len(answers) != len(expected):
        return [f"{len(answers)} steps instead of {len(expected)}"]
    pairs = enumerate(zip(answers, expected))
    return [
        f"step {step}: {one} instead of {other}" for step, (one, other) in pairs if one != other
    ]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("files", nargs="*", help="frames of one mesh, in order")
    parser.add_argument("--slices", type=int, default=4, help="slices of the film [4]")
    parser.add_argument("--scheduler", help="address of a scheduler whose workers see the files")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        files = arguments.files or film(folder, 25)
        # Processes of their own: threads that share a device take turns.
        cluster = arguments.scheduler or LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None
        )
        with Client(cluster) as client:
            # The default is that of a body's first frame, and each slice begins at another.
            tolerance = nearmiss.Detector(nearmiss.Body(*nearmiss.read_mesh(files[0]))).tolerance
            slices = sliced(files, arguments.slices)
            parts = client.gather(client.map(contacts, slices, tolerance=tolerance))
            workers = len(client.scheduler_info()["workers"])
        answers = [answer for part in parts for answer in part]
        wrong = differences(answers, contacts(files, tolerance))
    rows = sum(count for _, count in answers)
    print(f"{len(answers)} steps, {rows} contacts, {len(parts)} slices on {workers} workers")
    print("\n".join(wrong) or "the answers are those of one process")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
