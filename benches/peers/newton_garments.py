"""Near pairs of garments by Newton on the CPU and by nearmiss, pair by pair. See README.md.

    python newton_garments.py FOLDER [--out FILE.csv]

FOLDER has dress-knife_t0.ply and multilayer_t0.ply. Both programs leave out the same neighbours.
"""

import argparse
import csv
import sys
from importlib.metadata import version
from pathlib import Path

import nearmiss
import newton
import numpy as np
import warp as wp

MESHES = ["dress-knife_t0", "multilayer_t0"]
# Of squared lengths of edges, in square metres.
DEFAULT, PRECISE = 1e-5, 1e-12
# In metres: pairs this near to the radius may be in or out, as Newton's distances are f32.
ROUNDING = 1e-6


def edges_of(faces):
    """Edges as nearmiss numbers them: rows of the larger and the smaller vertex, ascending."""
    ends = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)[:, ::-1]
    return np.unique(ends, axis=0)


def keys(pairs, count):
    """One number for each pair."""
    pairs = np.asarray(pairs, np.int64).reshape(-1, 2)
    return pairs[:, 0] * count + pairs[:, 1]


def lost(ours, distances, theirs, radius):
    """Which of our pairs they lack, those within rounding of the radius excepted."""
    assert len(np.unique(ours)) == len(ours) == len(distances)
    return ~np.isin(ours, theirs) & (distances < radius - ROUNDING)


def check_of_the_check():
    """A pair that is taken out is named, and one at the radius is not."""
    ours, distances = np.arange(4), np.array([0, 0.5, 0.9, 1])
    assert lost(ours, distances, np.array([0, 2, 9]), 1).tolist() == [False, True, False, False]
    assert not lost(ours, distances, ours, 1).any()


class Garment:
    """A mesh, its near pairs by nearmiss, and a model of Newton."""

    def __init__(self, path):
        self.vertices, faces = nearmiss.read_mesh(path)
        self.faces = faces.astype(np.int64)
        self.edges = edges_of(self.faces)
        lengths = np.linalg.norm(
            np.diff(self.vertices[self.edges].astype(float), axis=1)[:, 0], axis=1
        )
        self.squared_lengths, self.radius = lengths**2, lengths.mean() / 2

        self.detector = nearmiss.Detector(
            nearmiss.Body(self.vertices, faces), device=nearmiss.Device("cpu")
        )
        # Newton's default leaves out features that an edge joins.
        self.detector.exclude(0, ring=2)
        found = self.detector.near(self.radius)
        features = np.stack([found.feature_a, found.feature_b], axis=1).astype(np.int64)
        is_face = found.kind == nearmiss.Kind.VERTEX_FACE
        self.pairs = {
            "vf": (keys(features[is_face], len(self.faces)), found.distances[is_face]),
            "ee": (keys(features[~is_face], len(self.edges)), found.distances[~is_face]),
        }
        self.edge_pairs = features[~is_face]

        builder = newton.ModelBuilder()
        builder.add_cloth_mesh(
            pos=wp.vec3(),
            rot=wp.quat_identity(),
            scale=1.0,
            vel=wp.vec3(),
            density=0.1,
            vertices=self.vertices.tolist(),
            indices=faces.ravel().tolist(),
        )
        self.model = builder.finalize(device="cpu")
        ends = np.sort(self.model.edge_indices.numpy()[:, 2:4].astype(np.int64), axis=1)[:, ::-1]
        ours, theirs = keys(self.edges, len(self.vertices)), keys(ends, len(self.vertices))
        assert np.array_equal(ours, np.sort(theirs)), "Newton has other edges"
        self.number = np.searchsorted(ours, theirs)  # of an edge of Newton

    def by_newton(self, **settings):
        """Pairs that Newton stores as keys by kind, and the longest lists."""
        pipeline = newton.CollisionPipeline(self.model, broad_phase="nxn")
        pipeline.init_soft_self_contact(margin=self.radius, gap=0.0, **settings)
        contacts, state = pipeline.contacts(), self.model.state()
        pipeline.collide(state, contacts, soft_self_contact=True)
        data = contacts.soft_self_contact_data

        def stored(kind):
            counts = getattr(data, f"{kind}_count").numpy()
            offsets = getattr(data, f"{kind}_offsets").numpy()
            pairs = getattr(data, kind).numpy().reshape(-1, 2)
            used = np.minimum(counts, np.diff(offsets))
            row = np.repeat(np.arange(len(counts)), used)
            place = np.arange(len(row)) - np.repeat(np.cumsum(used) - used, used)
            return pairs[offsets[row] + place], counts

        vertex_faces, vertex_counts = stored("vertex_colliding_triangles")
        edge_edges, edge_counts = stored("edge_colliding_edges")
        edge_edges = np.sort(self.number[edge_edges], axis=1)  # each pair is listed from both sides
        return {
            "vf": keys(vertex_faces, len(self.faces)),
            "ee": np.unique(keys(edge_edges, len(self.edges))),
            "longest": (int(vertex_counts.max()), int(edge_counts.max())),
        }


def by_setting(garment):
    """What Newton finds by setting: defaults, longer buffers, a smaller epsilon, and both."""
    precise = {"edge_edge_parallel_epsilon": PRECISE}
    short = [garment.by_newton(**settings) for settings in ({}, precise)]
    vertex, edge = (max(counts) for counts in zip(*(found["longest"] for found in short)))
    print(f"  longest lists: {vertex} of a vertex, {edge} of an edge")
    room = {"vertex_buffer_pre_alloc": vertex, "edge_buffer_pre_alloc": edge}
    long = [garment.by_newton(**room, **settings) for settings in ({}, precise)]
    names = ["defaults", "smaller epsilon", "longer buffers", "both"]
    return dict(zip(names, short + long))


def compare(name, garment):
    """A row for each setting."""
    print(f"{name}: {len(garment.faces)} triangles, radius {1e3 * garment.radius:.3f} mm")
    is_short = garment.squared_lengths <= DEFAULT
    print(f"  edges that the default treats as points: {is_short.mean():.1%}")
    for setting, found in by_setting(garment).items():
        row = {"scene": name, "setting": setting}
        for kind, (ours, distances) in garment.pairs.items():
            missing = lost(ours, distances, found[kind], garment.radius)
            row |= {
                kind: len(ours),
                f"{kind}_lost": int(missing.sum()),
                f"{kind}_lost_percent": round(100 * float(missing.mean()), 1),
                f"{kind}_not_ours": len(np.setdiff1d(found[kind], ours)),
                f"{kind}_at_the_radius": int((distances >= garment.radius - ROUNDING).sum()),
            }
        # `missing` is that of edges.
        short = is_short[garment.edge_pairs[missing]].any(axis=1)
        nearest = round(1e3 * float(distances[missing].min()), 4) if missing.any() else ""
        row |= {"lost_with_a_short_edge": int(short.sum()), "nearest_lost_mm": nearest}
        print("  " + ", ".join(f"{key} {value}" for key, value in row.items() if key != "scene"))
        yield row


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="folder of the meshes")
    parser.add_argument("--out", type=Path, help="write the rows to this CSV file")
    arguments = parser.parse_args()
    check_of_the_check()
    wp.config.quiet = True
    programs = ["newton", "warp-lang", "nearmiss"]
    print(
        ", ".join(
            f"{name} {nearmiss.__version__ if name == 'nearmiss' else version(name)}"
            for name in programs
        )
    )
    rows = [
        row for name in MESHES for row in compare(name, Garment(arguments.folder / f"{name}.ply"))
    ]
    if arguments.out:
        with open(arguments.out, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    return 0


if __name__ == "__main__":
    sys.exit(main())
