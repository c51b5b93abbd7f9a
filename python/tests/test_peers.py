"""The comparison with Coal and FCL runs as it is written, and all programs count the same."""

import csv
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("coal")
pytest.importorskip("fcl")
SCRIPT = Path(__file__).parents[2] / "benches" / "peers" / "bodies.py"


def difference(rows):
    """The first question to which two programs have another count. Coal's count of triangles is left
    out: it differs a little."""
    first = {}
    for row in rows:
        is_coal_of_triangles = row["program"].startswith("Coal") and row["question"] == "crossing triangles"
        if not row["count"] or is_coal_of_triangles:
            continue
        count, distances = first.setdefault(row["question"], (row["count"], row["distances"]))
        if row["count"] != count or (distances and abs(float(row["distances"]) - float(distances)) > 1e-8):
            return row["question"]
    return None


def test_programs_count_alike(tmp_path):
    out = tmp_path / "bodies.csv"
    subprocess.run(
        [sys.executable, str(SCRIPT), "--bodies", "60", "--frames", "3", "--threads", "2", "--out", str(out)],
        check=True,
        timeout=120,
    )
    with out.open() as file:
        rows = list(csv.DictReader(file))
    questions = {row["question"] for row in rows} - {"pairs of boxes"}
    assert questions == {"poses", "touching", "crossing triangles", "distances within 0.02", "distances within 0.1"}
    answered = {(row["question"], row["program"]) for row in rows}
    assert sorted((*pair, order) for pair in answered for order in ("in a row", "in turns")) == sorted(
        (row["question"], row["program"], row["order"]) for row in rows
    )
    assert any(row["program"].startswith("nearmiss") and float(row["count"] or 0) > 0 for row in rows)
    assert difference(rows) is None
    for question in questions - {"poses"}:
        planted = [dict(row) for row in rows]
        last = [row for row in planted if row["question"] == question and row["program"].startswith("nearmiss")][-1]
        last["count"] = f"{float(last['count']) + 1:.2f}"
        assert difference(planted) == question
