"""nearmiss in programs of ipctk: candidates against ipctk's brute force, steps against proven bounds, and refusals."""

from collections import Counter

import numpy as np
import pytest

ipctk = pytest.importorskip("ipctk", reason="ipctk is not installed: pip install ipctk")

from ipctk_judge import LISTS, Undecided, comes_within, features, numbers  # noqa: E402
from ipctk_scenes import scene  # noqa: E402

import nearmiss  # noqa: E402
import nearmiss.ipctk  # noqa: E402

CPU = nearmiss.Device("cpu", threads=1)
SEEDS = range(6)
# A candidate of ours may be farther than the distance of `build` by its slack.
SLACK = 1e-5


@pytest.fixture(autouse=True)
def own_calls_after_each_test():
    yield
    nearmiss.ipctk.uninstall()


def in_space(vertices):
    return np.pad(vertices, ((0, 0), (0, 3 - vertices.shape[1])))


def lists_of(broad_phase, mesh, positions, radius):
    """All lists of candidates of a broad phase, as sets of numbers."""
    broad_phase.can_vertices_collide = mesh.can_collide
    broad_phase.build(*positions, mesh.edges, mesh.faces, radius)
    found = {name: numbers(name, getattr(broad_phase, f"detect_{name}_candidates")()) for name in LISTS}
    broad_phase.clear()
    return found


def missing(ours, theirs, mesh, positions, radius):
    """Pairs of ipctk's lists that ours lack although they come within the distance of `build`, and how many pairs ours lack."""
    t0, t1 = in_space(positions[0]), in_space(positions[-1])
    lacking = [(name, pair) for name in LISTS for pair in sorted(theirs[name] - ours[name])]
    near = [one for one in lacking if comes_within(2 * radius, features(*one, mesh.edges, mesh.faces), t0, t1)]
    return near, len(lacking)


@pytest.mark.parametrize("moves", [False, True])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("seed", SEEDS)
def test_no_candidate_is_missing(seed, dim, moves):
    mesh, *positions = scene(seed, dim)
    positions = positions if moves else positions[:1]
    ours, theirs = nearmiss.ipctk.BroadPhase(CPU), ipctk.BruteForce()
    for radius in (0.0, 1e-3, 0.03):
        found, boxes = (lists_of(phase, mesh, positions, radius) for phase in (ours, theirs))
        near, lacking = missing(found, boxes, mesh, positions, radius)
        assert near == [] and lacking > 0
        # No candidate is far: triangles that come near are those of ipctk's boxes, a little larger.
        wider = lists_of(theirs, mesh, positions, radius * (1 + SLACK) + 1e-9)
        for name in LISTS:
            assert name == "edge_face" or found[name] <= wider[name], name
        assert radius < 0.03 or sum(map(len, found.values())) > 10


def test_a_missing_candidate_is_noticed():
    mesh, *positions = scene(1, 3)
    found = lists_of(nearmiss.ipctk.BroadPhase(CPU), mesh, positions, 0.1)
    for name in LISTS:
        for pair in sorted(found[name])[:5]:
            near, lacking = missing({**found, name: found[name] - {pair}}, found, mesh, positions, 0.1)
            # An edge of a triangle that comes near may itself stay away.
            assert lacking == 1 and (near == [(name, pair)] or name == "edge_face"), (name, pair)
        assert len(found[name]) > 0


def filters(mesh):
    """Filters of ipctk that differ, for a mesh of the scenes."""
    count = mesh.num_vertices
    random = np.random.default_rng(count)
    explicit = {(i, j): bool(random.random() < 0.3) for i in range(count) for j in range(i + 1, count) if random.random() < 0.5}
    yield ipctk.make_vertex_patches_filter((np.arange(count) % 3).astype(np.int32))
    yield ipctk.make_static_obstacle_filter(count // 3)
    yield ipctk.make_sparse_filter(explicit, False)
    yield ~ipctk.CollisionFilter()


def candidates_of(mesh, positions, radius, broad_phase):
    """The lists that ipctk builds by a broad phase, those of codimensional features too."""
    found = ipctk.Candidates()
    found.build(mesh, *positions, radius, broad_phase)
    return {name: numbers(name, getattr(found, f"{short}_candidates")) for name, short in zip(LISTS, ("vv", "ev", "ee", "fv"))} | {
        "edge_face": set(),
        "face_face": set(),
    }


@pytest.mark.parametrize("moves", [False, True])
@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("seed", SEEDS)
def test_filters_and_codimensional_features_are_kept(seed, dim, moves):
    mesh, *positions = scene(seed, dim)
    positions, radius = positions if moves else positions[:1], 0.05
    ours, theirs = nearmiss.ipctk.BroadPhase(CPU), ipctk.BruteForce()
    sizes = []
    for kept in [ipctk.CollisionFilter(), *filters(mesh)]:
        mesh.can_collide = kept
        found = candidates_of(mesh, positions, radius, ours)
        assert missing(found, candidates_of(mesh, positions, radius, theirs), mesh, positions, radius)[0] == []
        wider = candidates_of(mesh, positions, radius * (1 + SLACK) + 1e-9, theirs)
        assert all(found[name] <= wider[name] for name in LISTS)
        sizes.append(sum(map(len, found.values())))
    assert sizes[-1] == 0 and min(sizes[1:-1]) < sizes[0]


def collisions(mesh, vertices, dhat, dmin, kind, phase):
    """Everything that ipctk makes of the candidates of a step at rest."""
    found = ipctk.NormalCollisions()
    found.use_area_weighting = True
    found.collision_set_type = kind
    found.build(mesh, vertices, dhat, dmin, phase)
    weights = Counter()
    for c in found.vv_collisions:
        weights[("vertex_vertex", *sorted((c.vertex0_id, c.vertex1_id)))] += c.weight
    for c in found.ev_collisions:
        weights[("edge_vertex", c.edge_id, c.vertex_id)] += c.weight
    for c in found.ee_collisions:
        weights[("edge_edge", *sorted((c.edge0_id, c.edge1_id)))] += c.weight
    for c in found.fv_collisions:
        weights[("face_vertex", c.face_id, c.vertex_id)] += c.weight
    # Weights that cancel are gone in one run and rows of weight 0 in another: ipctk adds them up a thread.
    rows = [(*pair, round(weight, 12)) for pair, weight in sorted(weights.items()) if abs(weight) > 1e-12]
    return rows, found.compute_minimum_distance(mesh, vertices)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("seed", SEEDS)
def test_collisions_are_those_of_ipctk(seed, dim):
    mesh, vertices, _ = scene(seed, dim)
    sets, phase = ipctk.NormalCollisions, nearmiss.ipctk.BroadPhase(CPU)
    for kind in (sets.IPC, sets.IMPROVED_MAX_APPROX, sets.OGC):
        for dhat, dmin in [(0.1, 0.0), (0.07, 0.03)]:
            theirs = collisions(mesh, vertices, dhat, dmin, kind, ipctk.BruteForce())
            assert collisions(mesh, vertices, dhat, dmin, kind, phase) == theirs and len(theirs[0]) > 5


@pytest.mark.parametrize("dim", [2, 3])
def test_intersections_are_those_of_ipctk(dim):
    answers = []
    for seed in range(40):
        mesh, vertices, _ = scene(seed, dim, size=0.05 if dim == 2 else 0.3)
        answers.append(ipctk.has_intersections(mesh, vertices, ipctk.BruteForce()))
        assert ipctk.has_intersections(mesh, vertices, nearmiss.ipctk.BroadPhase(CPU)) == answers[-1], seed
    assert 3 <= sum(answers) <= 37


# Steps.


def least_pairs(mesh, t0, t1, kept):
    """Pairs of ipctk's features that may meet in a step, of those that a filter keeps."""
    mesh.can_collide = kept
    found = candidates_of(mesh, (t0, t1), 0.1, ipctk.BruteForce())
    return [features(name, pair, mesh.edges, mesh.faces) for name in LISTS for pair in found[name]]


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("seed", SEEDS)
def test_steps_are_safe_and_end_at_a_contact(seed, dim):
    unscaled = ipctk.TightInclusionCCD(conservative_rescaling=1 - 1e-12)
    for scale in (0.02, 1.0):
        mesh, t0, t1 = scene(seed, dim, size=0.12)
        t1 = np.asfortranarray(t0 + scale * (t1 - t0))
        for kept in [ipctk.CollisionFilter(), ipctk.make_vertex_patches_filter((np.arange(mesh.num_vertices) % 3).astype(np.int32))]:
            pairs, ends = least_pairs(mesh, t0, t1, kept), (in_space(t0), in_space(t1))
            for min_distance in (0.0, 0.01):
                with nearmiss.ipctk.install(CPU):
                    step = ipctk.compute_collision_free_stepsize(mesh, t0, t1, min_distance, narrow_phase_ccd=unscaled)
                    default = ipctk.compute_collision_free_stepsize(mesh, t0, t1, min_distance)
                    free = ipctk.is_step_collision_free(mesh, t0, t1, min_distance)
                assert 0 <= step <= 1 and free == (step == 1)
                assert default == 1 if free else default == pytest.approx(0.8 * step, rel=1e-9)
                if step > 0:
                    assert not any(comes_within(min_distance, pair, *ends, end=step * (1 - 1e-6)) for pair in pairs)
                if not free:
                    assert any(comes_within(min_distance + 2e-5, pair, *ends, end=min(1.0, step + 1e-9)) for pair in pairs)


def test_a_late_step_is_noticed():
    mesh, t0, t1 = scene(3, 3, size=0.12)
    pairs = least_pairs(mesh, t0, t1, ipctk.CollisionFilter())
    with nearmiss.ipctk.install(CPU):
        step = ipctk.compute_collision_free_stepsize(mesh, t0, t1) / 0.8
    assert 0 < step < 1
    assert any(comes_within(1e-9, pair, t0, t1, end=step + 1e-3) for pair in pairs)


@pytest.mark.parametrize("dim", [2, 3])
def test_steps_of_candidates_are_of_their_pairs(dim):
    """Without the candidates of the first contact a step is longer; without any it is whole."""
    mesh, t0, t1 = scene(2, dim, size=0.12)
    found, fewer = ipctk.Candidates(), ipctk.Candidates()
    found.build(mesh, t0, t1, 0.0, ipctk.BruteForce())
    names = ["ev_candidates"] if dim == 2 else ["ee_candidates", "fv_candidates"]
    with nearmiss.ipctk.install(CPU):
        step = found.compute_collision_free_stepsize(mesh, t0, t1)
        assert step == ipctk.compute_collision_free_stepsize(mesh, t0, t1) < 1
        assert not found.is_step_collision_free(mesh, t0, t1)
        steps = {step}
        for name in names:
            # ipctk's threads list candidates in any order, so the first contact may be at either end.
            for keep in range(0, len(getattr(found, name)), 3):
                for part in (slice(keep, None), slice(keep)):
                    setattr(fewer, name, getattr(found, name)[part])
                    steps.add(fewer.compute_collision_free_stepsize(mesh, t0, t1))
            setattr(fewer, name, [])
        assert min(steps) == step and len(steps) > 1
        assert fewer.compute_collision_free_stepsize(mesh, t0, t1) == 1 and fewer.is_step_collision_free(mesh, t0, t1)


def test_planes_are_kept():
    mesh, t0, _ = scene(0, 3, size=0.01)
    t1 = np.asfortranarray(t0 - [0, 0, 3])
    mesh.planes = [ipctk.Hyperplane(np.array([0, 0, 1.0]), np.array([0, 0, -1.0]))]
    wanted = ipctk.compute_collision_free_stepsize(mesh, t0, t1)
    listed = ipctk.Candidates()
    listed.build(mesh, t0, t1, 0.0, ipctk.BruteForce())
    with nearmiss.ipctk.install(CPU):
        assert ipctk.compute_collision_free_stepsize(mesh, t0, t1) == wanted == listed.compute_collision_free_stepsize(mesh, t0, t1) < 1
        assert not ipctk.is_step_collision_free(mesh, t0, t1) and not listed.is_step_collision_free(mesh, t0, t1)


def test_a_step_from_a_small_gap_is_not_stuck():
    """Two triangles much nearer than the default tolerance part."""
    t0 = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1e-9], [1, 0, 1e-9], [0, 1, 1e-9]], order="F")
    t1 = t0.copy(order="F")
    t1[3:, 2] = 1
    faces = np.array([[0, 1, 2], [3, 4, 5]], np.int32, order="F")
    mesh = ipctk.CollisionMesh(t0, ipctk.edges(faces), faces)
    with nearmiss.ipctk.install(CPU):
        assert ipctk.compute_collision_free_stepsize(mesh, t0, t1) == 1 and ipctk.is_step_collision_free(mesh, t0, t1)
        assert 0 < ipctk.compute_collision_free_stepsize(mesh, t1, np.asfortranarray(t0 - (t1 - t0))) < 0.8


# The installation.


def own_calls():
    builders = (ipctk.Candidates, ipctk.NormalCollisions, ipctk.SmoothCollisions)
    steps = ("compute_collision_free_stepsize", "is_step_collision_free")
    calls = [(ipctk, "has_intersections"), *((kind, "build") for kind in builders)]
    return [getattr(*call) for call in calls + [(owner, name) for owner in (ipctk, ipctk.Candidates) for name in steps]]


def test_calls_are_given_back():
    before = own_calls()
    with nearmiss.ipctk.install(CPU):
        nearmiss.ipctk.install(CPU)
        assert not any(one is other for one, other in zip(before, own_calls()))
    assert own_calls() == before
    nearmiss.ipctk.uninstall()
    with pytest.raises(KeyError):
        with nearmiss.ipctk.install(CPU):
            raise KeyError
    assert own_calls() == before


class Counting(ipctk.BroadPhase):
    """A broad phase without candidates that counts its uses."""

    uses = 0

    def name(self):
        return "counting"

    def build(self, *args):
        self.uses += 1
        super().build(*args)

    def _none(self):
        return []

    detect_edge_edge_candidates = detect_face_vertex_candidates = detect_edge_face_candidates = _none
    detect_vertex_vertex_candidates = detect_edge_vertex_candidates = _none


@pytest.mark.parametrize("replace_named", [False, True])
def test_named_phases_are_kept_or_replaced(replace_named):
    mesh, t0, t1 = scene(0, 3)
    found, own, phase = ipctk.Candidates(), ipctk.Candidates(), Counting()
    own.build(mesh, t0, 0.05, ipctk.BruteForce())
    with nearmiss.ipctk.install(CPU, replace_named=replace_named):
        found.build(mesh, t0, 0.05)
        assert len(found.ee_candidates) < len(own.ee_candidates)
        for build in (lambda: found.build(mesh, t0, 0.05, phase), lambda: found.build(mesh, t0, 0.05, broad_phase=phase)):
            build()
            assert (len(found.ee_candidates) > 0) == replace_named
        collisions, smooth = ipctk.NormalCollisions(), ipctk.SmoothCollisions()
        for call in [
            lambda: collisions.build(mesh, t0, 0.01, broad_phase=phase),
            lambda: smooth.build(mesh, t0, ipctk.SmoothContactParameters(0.01, 0.1, 0.1, 2), False, phase),
            lambda: ipctk.has_intersections(mesh, t0, phase),
            lambda: ipctk.compute_collision_free_stepsize(mesh, t0, t1, broad_phase=phase),
            lambda: ipctk.is_step_collision_free(mesh, t0, t1, 0.0, phase),
        ]:
            before = phase.uses
            call()
            assert (phase.uses == before) == replace_named
        collisions.build(own, mesh, t0, 0.01)
        collisions.build(mesh, t0, 0.01, 0.0, None)
        smooth.build(mesh, t0, ipctk.SmoothContactParameters(0.01, 0.1, 0.1, 2))


# Traps and refusals.


def test_arrays_may_change_after_build():
    mesh, t0, _ = scene(4, 3)
    wanted = lists_of(nearmiss.ipctk.BroadPhase(CPU), mesh, [t0], 0.02)
    phase, arrays = nearmiss.ipctk.BroadPhase(CPU), [np.array(a, order="F") for a in (t0, mesh.edges, mesh.faces)]
    phase.build(vertices=arrays[0], edges=arrays[1], faces=arrays[2], inflation_radius=0.02)
    for array in arrays:
        array[:] = 0
    assert {name: numbers(name, getattr(phase, f"detect_{name}_candidates")()) for name in LISTS} == wanted


def test_edges_that_are_listed_twice():
    t0 = np.asfortranarray([[0, 0, 0], [1, 0, 0], [0, 1, 1e-3], [1, -1, 1e-3], [5, 5, 5.0]])
    edges = np.asfortranarray([[0, 1], [3, 2], [1, 0], [2, 3]], np.int32)
    phase = nearmiss.ipctk.BroadPhase(CPU)
    phase.build(t0, edges, np.zeros((0, 3), np.int32, order="F"), 0.01)
    assert numbers("edge_edge", phase.detect_edge_edge_candidates()) == {(0, 1), (0, 3), (1, 2), (2, 3)}


def test_an_empty_mesh_has_no_candidates():
    none = [np.zeros((0, width), kind, order="F") for width, kind in ((3, float), (2, np.int32), (3, np.int32))]
    phase = nearmiss.ipctk.BroadPhase(CPU)
    phase.build(*none, 0.1)
    assert all(getattr(phase, f"detect_{name}_candidates")() == [] for name in LISTS)


def test_refusals_name_the_fault():
    mesh, t0, t1 = scene(0, 3)
    phase = nearmiss.ipctk.BroadPhase(CPU)
    with pytest.raises(RuntimeError, match="call build first"):
        phase.detect_edge_edge_candidates()
    for radius in (-1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match=f"inflation_radius must be finite and at least 0, got {radius}"):
            phase.build(t0, mesh.edges, mesh.faces, radius)
    for wrong in [("vertices", mesh.edges, mesh.faces, 0.1), (mesh.edges, mesh.faces), (t0, t0, t0, mesh.edges, mesh.faces)]:
        with pytest.raises((TypeError, ValueError)):
            phase.build(*wrong)
    for index in (-1, mesh.num_vertices):
        outside = np.full_like(mesh.faces, index)
        with pytest.raises(IndexError, match=f"faces must name vertices from 0 to {mesh.num_vertices - 1}, got {index}"):
            phase.build(t0, t1, mesh.edges, outside, 0.1)
    looped = np.asfortranarray([[0, 1], [2, 2]], np.int32)
    with pytest.raises(ValueError, match=r"edge 1 has one vertex at both ends, got \[2, 2\]"):
        ipctk.Candidates().build(ipctk.CollisionMesh(t0, looped), t0, 0.1, phase)
    broken = t0.copy(order="F")
    broken[3, 1] = np.nan
    with pytest.raises(nearmiss.InputError, match="vertex 3"):
        ipctk.Candidates().build(mesh, broken, 0.1, phase)
    with nearmiss.ipctk.install(CPU):
        with pytest.raises(ValueError, match="min_distance must be finite and at least 0, got -1"):
            ipctk.compute_collision_free_stepsize(mesh, t0, t1, -1)
        with pytest.raises(ValueError, match=f"vertices_t1 must have a row for each of {mesh.num_vertices} vertices, got 3"):
            ipctk.compute_collision_free_stepsize(mesh, t0, t1[:3])
        with pytest.raises(TypeError):
            ipctk.compute_collision_free_stepsize(mesh, t0)


def test_the_judge_says_if_it_cannot_decide():
    at = np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1e-3]])
    with pytest.raises(Undecided):
        comes_within(1e-3 - 1e-13, ([2], [0, 1]), at, at + np.array([[0, 0, 0], [0, 0, 0], [1e-3, 0, 0]]))
