"""Does VTK read what `nearmiss detect --out FILE.vtp` writes, and is it what the CSV says?

    NEARMISS=path/to/nearmiss python3 -m unittest vtp_test        needs pyvista
"""
import csv
import os
import subprocess
import tempfile
import unittest

import pyvista

KINDS = ["vf", "ee"]
STATUS = ["unverified", "certified", "undecided"]


def differences(mesh, rows):
    """Where the file of VTK says something else than the rows: a line each."""
    if mesh.n_cells != len(rows) or mesh.n_points != 2 * len(rows):
        return [f"{mesh.n_cells} cells, {mesh.n_points} points, {len(rows)} rows"]
    found, cells = [], mesh.cell_data
    for at in range(mesh.n_cells):
        row = rows[int(cells["row"][at])]
        pairs = [(KINDS[cells["kind"][at]], row["kind"]), (list(cells["bodies"][at]), [int(row["owner_0"]), int(row["owner_3"])])]
        pairs += [(int(cells[name][at]), int(row[name])) for name in ["feature_a", "feature_b"]]
        timed = ["toi", "toi_upper"] if "toi" in cells else []
        pairs += [(float(cells[name][at]), float(row[name])) for name in ["distance", *timed]]
        if timed:
            pairs.append((STATUS[cells["status"][at]], row["status"]))
        of = 2 * int(cells["row"][at])
        for point, side in [(of, "a"), (of + 1, "b")]:
            pairs.append((list(mesh.points[point]), [float(row[f"{axis}_{side}"]) for axis in "xyz"]))
            pairs.append((list(mesh.point_data["normal"][point]), [float(row[f"normal_{axis}"]) for axis in "xyz"]))
        found += [f"cell {at}: {ours} is {theirs} in the CSV" for ours, theirs in pairs if ours != theirs]
    return found


class Vtp(unittest.TestCase):
    def both(self, *question):
        with tempfile.TemporaryDirectory() as folder:
            out = [os.path.join(folder, name) for name in ["a.vtp", "a.csv"]]
            for file, more in zip(out, [[], ["--geometry"]]):
                asked = [os.environ["NEARMISS"], "detect", *question, "--backend", "cpu", "--out", file, *more]
                subprocess.run(asked, check=True, stdout=subprocess.DEVNULL)
            with open(out[1], newline="") as rows:
                return pyvista.read(out[0]), list(csv.DictReader(rows))

    def test_contacts_and_near_pairs_are_read(self):
        for question in [["--scene", "soup-moving", "--triangles", "300"], ["--scene", "soup", "--triangles", "100", "--near", "0.1"]]:
            mesh, rows = self.both(*question)
            self.assertGreater(len(rows), 10, question)
            self.assertEqual(differences(mesh, rows), [], question)

    def test_curves_are_read(self):
        mesh, rows = self.both("--scene", "soup", "--triangles", "300", "--seed", "3")
        self.assertGreater(len(rows), 10)
        crossing = [row for row in rows if row["kind"] == "crossing"]
        segments = int(sum(mesh.get_cell(at).n_points - 1 for at in range(mesh.n_cells)))
        self.assertEqual((segments, len(crossing)), (len(rows), len(rows)))
        for at in range(mesh.n_cells):
            cell = mesh.get_cell(at)
            for from_, to in zip(cell.point_ids, cell.point_ids[1:]):
                row = rows[int(mesh.point_data["row"][from_])]
                ends = {tuple(float(row[f"{axis}_{end}"]) for axis in "xyz") for end in "01"}
                self.assertEqual({tuple(mesh.points[from_]), tuple(mesh.points[to])}, ends)

    def test_a_difference_is_noticed(self):
        mesh, rows = self.both("--scene", "soup-moving", "--triangles", "300")
        for column, value in [("toi", "0.123"), ("feature_a", "9999"), ("x_b", "77"), ("normal_z", "2"), ("status", "none"), ("kind", "tt")]:
            planted = [dict(rows[0], **{column: value}), *rows[1:]]
            self.assertEqual(len(differences(mesh, planted)), 2 if column == "normal_z" else 1, column)
        self.assertEqual(len(differences(mesh, rows[1:])), 1)


if __name__ == "__main__":
    unittest.main()
