"""The examples that simulate: nothing crosses, the cloth comes to rest, and each fault is named."""

import subprocess
import sys
from pathlib import Path

import cloth_xpbd
import drape
import numpy as np
import pytest

CELLS, FRAMES = 20, 250


def intersects(faces, x):
    """Whether ipctk finds an intersection in a mesh."""
    ipctk = pytest.importorskip("ipctk")
    faces = np.asfortranarray(faces, dtype=np.int32)
    x = np.asfortranarray(x)
    return ipctk.has_intersections(ipctk.CollisionMesh(x, ipctk.edges(faces), faces), x)


def with_ball(faces, x):
    """The cloth and the ball as one mesh."""
    ball, ball_faces = drape.ball()
    return np.concatenate([faces, ball_faces + len(x)]), np.concatenate([x, ball])


def test_springs_of_a_list_share_no_vertex():
    for cells in (2, 5, 8):
        every = [pairs for pairs, _ in drape.springs(cells)]
        assert all(len(np.unique(pairs)) == pairs.size for pairs in every)
        rows = np.concatenate(every)
        assert len(np.unique(np.sort(rows, axis=1), axis=0)) == len(rows)
        assert len(rows) == 2 * cells * (cells + 1) + 2 * cells**2 + 2 * (cells - 1) * (cells + 1)


def test_a_ball_is_closed_and_round():
    vertices, faces = drape.ball()
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    assert len(np.unique(sides, axis=0)) == len(sides)
    assert np.array_equal(np.unique(sides, axis=0), np.unique(sides[:, ::-1], axis=0))
    assert np.allclose(np.linalg.norm(vertices, axis=1), drape.RADIUS)
    assert np.linalg.det(vertices[faces]).min() > 0


@pytest.fixture(scope="module")
def numpy_cloth():
    return cloth_xpbd.run(CELLS, FRAMES)


def test_a_cloth_comes_to_rest_and_crosses_nothing(numpy_cloth):
    cloth, log, faults = numpy_cloth
    print(log.summary())
    assert faults == [] and len(log.crossing) == FRAMES
    assert max(log.limited) > 0  # the contacts did limit a step
    assert not intersects(*with_ball(cloth.faces, cloth.x))


def test_a_cloth_without_limits_crosses(numpy_cloth):
    """With neither use of the detector it falls through the ball, and both judges say so."""
    cloth, log, faults = cloth_xpbd.run(CELLS, 25, repel=False, guard=False)
    assert "triangles cross" in faults
    assert intersects(*with_ball(cloth.faces, cloth.x))


def test_a_cloth_that_nothing_pushes_apart_freezes():
    """Limits alone: gaps shrink from step to step, and steps end at their start."""
    cloth, log, faults = cloth_xpbd.run(CELLS, FRAMES, repel=False)
    assert "the cloth is frozen" in faults and "triangles cross" not in faults
    assert not intersects(*with_ball(cloth.faces, cloth.x))


def test_the_program_exits_with_its_faults():
    program = Path(cloth_xpbd.__file__)
    done = subprocess.run(
        [sys.executable, program, "8", "10"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 1 and "the cloth does not hang" in done.stderr
    assert done.stdout.startswith("128 triangles, ")


@pytest.mark.parametrize(
    "fault, change",
    [
        ("triangles cross", lambda log, x: log.crossing.__setitem__(7, 1)),
        ("energy rises", lambda log, x: log.energy.__setitem__(-1, log.energy[0])),
        ("energy rises", lambda log, x: log.energy.__setitem__(200, log.energy[0] + 0.1)),
        (
            "the cloth has not come to rest",
            lambda log, x: log.kinetic.__setitem__(-1, max(log.kinetic)),
        ),
        ("the cloth is frozen", lambda log, x: log.limited.__setitem__(-1, 1.0)),
        ("the cloth is not on the ball", lambda log, x: x.__isub__([0, 0, drape.RADIUS])),
        (
            "the cloth does not hang",
            lambda log, x: x.__imul__([1, 1, 1e-3]).__iadd__([0, 0, drape.RADIUS]),
        ),
    ],
)
def test_a_fault_is_named(numpy_cloth, fault, change):
    cloth, log, _ = numpy_cloth
    planted, x = drape.Log(), cloth.x.copy()
    for name, column in vars(log).items():
        setattr(planted, name, list(column))
    change(planted, x)
    assert planted.faults(x, 0) == [fault]


def test_the_cloth_of_torch(numpy_cloth):
    torch = pytest.importorskip("torch")
    torch.set_num_threads(1)  # its threads spin, which takes minutes on a machine with other work
    import cloth_torch

    cloth, log, faults = cloth_torch.run(CELLS, FRAMES)
    print(log.summary())
    assert faults == [] and len(log.crossing) == FRAMES and max(log.limited) > 0
    x = cloth.x[: cloth.own].numpy()
    assert not intersects(*with_ball(numpy_cloth[0].faces, x))
    # The same scene and the same physics: the first frames agree, before rounding grows.
    one, other = cloth_xpbd.Cloth(CELLS), cloth_torch.Cloth(CELLS, "cpu")
    for _ in range(15):
        assert one.frame()[1] == other.frame()[1] == 0
    assert torch.allclose(torch.from_numpy(one.x), other.x[: other.own], atol=1e-9)


def test_a_barrier_in_torch():
    pytest.importorskip("torch")
    import barrier_torch

    energy, by_hand, by_differences = barrier_torch.errors()
    assert energy > 0 and by_hand < 1e-12 and by_differences < 1e-4
