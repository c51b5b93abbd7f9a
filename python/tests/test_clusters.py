"""Recipes for clusters, each on this machine: answers are those of one process.

A recipe without its package is skipped, and says so. The script for Slurm is run as Slurm would run
its tasks.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"
PROGRAM = os.environ.get("NEARMISS_PROGRAM")
needs_program = pytest.mark.skipif(PROGRAM is None, reason="NEARMISS_PROGRAM names the program")


def run(*command, **environment):
    """Status, output and errors of a program."""
    done = subprocess.run(
        [str(part) for part in command],
        env={**os.environ, **{name: str(value) for name, value in environment.items()}},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    return done.returncode, done.stdout, done.stderr


# Dask.


def test_frames_over_dask_are_those_of_one_process():
    pytest.importorskip(
        "dask.distributed", reason="Dask is not installed: pip install dask[distributed]"
    )
    status, out, errors = run(sys.executable, EXAMPLES / "frames_dask.py", "--slices", 3)
    assert status == 0, errors
    assert "24 steps" in out and "the answers are those of one process" in out
    assert " 0 contacts" not in out and "3 slices on 2 workers" in out


def test_slices_of_a_film_have_each_step_once():
    pytest.importorskip(
        "dask.distributed", reason="Dask is not installed: pip install dask[distributed]"
    )
    import frames_dask

    for frames in range(1, 12):
        for count in range(1, 14):
            parts = frames_dask.sliced(list(range(frames)), count)
            steps = [step for part in parts for step in zip(part, part[1:])]
            assert steps == [(frame, frame + 1) for frame in range(frames - 1)]
    answers = [("a", 1), ("b", 2)]
    assert frames_dask.differences(answers, answers) == []
    assert frames_dask.differences(answers, [("a", 1), ("c", 2)]) == [
        "step 1: ('b', 2) instead of ('c', 2)"
    ]
    assert frames_dask.differences(answers[:1], answers) == ["1 steps instead of 2"]


def test_frames_of_another_mesh_are_refused(tmp_path):
    pytest.importorskip(
        "dask.distributed", reason="Dask is not installed: pip install dask[distributed]"
    )
    import frames_dask

    files = frames_dask.film(tmp_path, 2)
    lines = Path(files[1]).read_text(encoding="utf-8").splitlines()
    Path(files[1]).write_text("\n".join(lines[:-1]), encoding="utf-8")
    with pytest.raises(ValueError, match="give frames of one mesh"):
        frames_dask.contacts(files, 1e-6)


# Ray.


def test_environments_over_ray_are_those_of_one_detector():
    pytest.importorskip("ray", reason="Ray is not installed: pip install ray")
    status, out, errors = run(sys.executable, EXAMPLES / "environments_ray.py", 13, 2)
    assert status == 0, errors
    assert "13 environments on 2 actors" in out and "the rows are those of one detector" in out
    assert " 0 contacts" not in out


def test_environments_that_differ_are_noticed():
    pytest.importorskip("ray", reason="Ray is not installed: pip install ray")
    import environments_ray as example

    ends = [example.poses(5, step) for step in (2, 3)]
    rows = example.Environments(0, 5, 1).step(*ends)
    assert len(rows) > 10 and example.differences([rows[::-1]], [rows]) == []
    moved = rows.copy()
    moved[3, 5] = np.nextafter(moved[3, 5], 1)
    for wrong in (rows[1:], moved):
        assert len(example.differences([wrong], [rows])) == 1
    # Bodies keep the numbers of the whole.
    own = [tuple(array[6:] for array in end) for end in ends]
    above = example.Environments(2, 3, 1).step(*own)
    assert example.differences([above], [rows[rows[:, :2].max(axis=1) > 6]]) == []


# Slurm.


TOLERANCE = ["--tolerance", "1e-6"]


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """Ten frames of a sheet that folds, and grows: the default tolerance of each task is another."""
    from sheets import fold

    folder = tmp_path_factory.mktemp("film with spaces")
    flat, folded, faces = fold(12, 40)
    files = []
    for frame in range(10):
        files.append(folder / f"sheet.{1001 + frame}.obj")
        with open(files[-1], "w", encoding="utf-8") as rows:
            np.savetxt(rows, (1 + frame) * (flat + frame / 9 * (folded - flat)), "v %.17g %.17g %.17g")
            np.savetxt(rows, faces + 1, "f %d %d %d")
    return files


def task(number, tasks, folder, options, files):
    path = f"{Path(PROGRAM).resolve().parent}:{os.environ['PATH']}"
    command = ["bash", EXAMPLES / "frames_slurm.sh", folder, tasks, *options, "--", *files]
    return run(*command, SLURM_ARRAY_TASK_ID=number, PATH=path)


def merge(folder, steps):
    return run("bash", EXAMPLES / "frames_merge.sh", folder, steps)


@needs_program
@pytest.mark.parametrize(
    ("options", "steps"),
    [
        (TOLERANCE, 9),
        (["--continuous", "--min-separation", "0.001", *TOLERANCE], 9),
        (["--earliest", "--tolerance=1e-6"], 9),
        (["--discrete", "--adjacent"], 10),
        (["--near", "0.01"], 10),
    ],
)
@pytest.mark.parametrize("tasks", [1, 3])
def test_rows_of_slurm_tasks_are_those_of_one_run(tmp_path, film, options, steps, tasks):
    status, _, errors = run(PROGRAM, "detect", *film, *options, "--out", tmp_path / "all.csv")
    assert status == 0, errors
    for number in reversed(range(tasks)):
        status, _, errors = task(number, tasks, tmp_path / "parts", options, film)
        assert status == 0, errors
    status, out, errors = merge(tmp_path / "parts", steps)
    assert status == 0, errors
    expected = (tmp_path / "all.csv").read_text(encoding="utf-8")
    assert out == expected and expected.count("\n") > 5


@needs_program
def test_parts_that_are_missing_or_overlap_are_named(tmp_path, film):
    parts = tmp_path / "parts"
    for number in range(3):
        assert task(number, 3, parts, TOLERANCE, film)[0] == 0
    assert "steps 9 to 10 are missing" in merge(parts, 11)[2]
    assert "STEPS must be 9 as in" in merge(parts, 8)[2]
    for steps in (0, -1, "9 9", "x"):
        assert f"STEPS must be a number of at least 1, got {steps}" in merge(parts, steps)[2]
    (parts / "00000003-00000006.csv").rename(tmp_path / "kept.csv")
    assert "steps 3 to 5 are missing" in merge(parts, 9)[2]
    assert task(0, 2, parts, TOLERANCE, film)[0] == 0
    assert "overlaps another part" in merge(parts, 9)[2]
    (tmp_path / "a-b.csv").touch()
    assert "a-b.csv is no part" in merge(tmp_path, 9)[2]
    assert "steps 0 to 8 are missing" in merge(tmp_path / "none", 9)[2]
    # A task that fails leaves no part.
    broken = [*film[:2], tmp_path / "none.obj", *film[3:]]
    status, _, errors = task(0, 3, tmp_path / "broken", TOLERANCE, broken)
    assert status == 3 and "none.obj" in errors
    assert not list((tmp_path / "broken").glob("*.csv"))


@needs_program
def test_arguments_that_do_not_fit_are_refused(tmp_path, film):
    for number, tasks, options, message in [
        (0, 5, TOLERANCE, "10 files are too few for 5 tasks; use at most 4"),
        (0, 6, ["--discrete"], "10 files are too few for 6 tasks; use at most 5"),
        (3, 3, TOLERANCE, "numbers of tasks must be below 3, got 3"),
        # What is of all frames of a run would be of those of a task.
        (0, 3, [], "steps need --tolerance L"),
        (0, 3, ["--discrete", "--weld"], "weld the files first"),
    ]:
        status, _, errors = task(number, tasks, tmp_path / "parts", options, film)
        assert status == 2 and message in errors
    status, _, errors = run("bash", EXAMPLES / "frames_slurm.sh", "parts")
    assert status == 2 and "it takes a folder and a number of tasks, got 1 arguments" in errors
    assert not (tmp_path / "parts").exists()
