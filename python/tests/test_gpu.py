"""On a GPU: arrays of torch and cupy, answers of the CPU. Skipped, visibly, where there is no GPU or no such library."""

import gc
import runpy
import threading
from pathlib import Path

import numpy as np
import pytest
from shapes import sheet, soup

import nearmiss as nm

torch = pytest.importorskip("torch")
pytestmark = pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU")


def draped(n=60):
    """A sheet that folds into itself: vertices at two times and faces."""
    vertices, faces = sheet(n, lambda x, y: 0.1 * np.sin(25 * x) * np.cos(9 * y))
    folded = vertices.copy()
    folded[:, 0] = np.abs(folded[:, 0] - 0.5)
    return vertices, folded, faces


@pytest.fixture
def stream():
    torch.zeros(1, device="cuda")
    stream = torch.cuda.Stream()
    with torch.cuda.stream(stream):
        yield stream
    stream.synchronize()


def test_one_liners_take_tensors():
    t0, t1, faces = draped()
    on_gpu = [torch.from_numpy(array).cuda() for array in (t0, t1, faces)]
    cpu = nm.Device("cpu")
    assert nm.near(on_gpu[1], on_gpu[2], 0.01).hash == nm.near(t1, faces, 0.01, device=cpu).hash
    found = nm.contacts(*on_gpu)
    assert found.hash == nm.contacts(t0, t1, faces, device=cpu).hash and len(found) > 100
    assert np.array_equal(nm.self_intersections(*on_gpu[1:]), nm.self_intersections(t1, faces, device=cpu))


def test_one_liners_take_tensors_of_another_gpu():
    if torch.cuda.device_count() < 2:
        pytest.skip("one GPU")
    t0, t1, faces = draped()
    on_gpu = [torch.from_numpy(array).to("cuda:1") for array in (t0, t1, faces)]
    cpu = nm.Device("cpu")
    assert torch.cuda.current_device() == 0
    assert nm.near(on_gpu[1], on_gpu[2], 0.01).hash == nm.near(t1, faces, 0.01, device=cpu).hash
    assert nm.contacts(*on_gpu).hash == nm.contacts(t0, t1, faces, device=cpu).hash


def test_a_thousand_frames_without_a_copy_of_positions(stream):
    t0, t1, faces = draped(40)
    body = nm.Body(t0, faces)
    detector, judge = (nm.Detector(body, device=device) for device in (nm.Device(stream=stream), nm.Device("cpu")))
    every = nm.Continuous()
    here, there = (torch.from_numpy(t0).cuda() for _ in range(2))
    far = torch.from_numpy(t1).cuda()
    generator = torch.Generator(device="cuda").manual_seed(1)

    def step():
        """A simulator: no host in it."""
        here.copy_(there)
        part = torch.rand(1, device="cuda", generator=generator) * 0.3
        there.lerp_(far, part).add_(torch.randn(there.shape, device="cuda", generator=generator) * 2e-3)

    step()
    detector.prepare({0: (here, there)}, [every])
    counted, contacts, compared = 0, torch.zeros((), dtype=torch.int64, device="cuda"), 0
    status = None
    for frame in range(1000):
        step()
        if not detector.is_prepared:
            detector.prepare({0: (here, there)}, [every])
            status = None
        detector.submit()
        if status is None:
            status = torch.from_dlpack(detector.on_device(every).status)
        # Counted on the device, by a kernel behind the submission.
        contacts += status[:2].sum()
        if frame % 25 == 0:
            ends = [end.cpu().numpy() for end in (here, there)]
            short = int(status[2])
            found, wanted = detector.collect(every), judge.step({0: tuple(ends)}, every)
            assert found.hash == wanted.hash and len(found) == len(wanted)
            assert short or int(status[:2].sum()) == len(found)
            compared += len(found)
        counted += 1
        if frame % 100 == 99:
            far = far.flip(0).contiguous()
    assert counted == 1000 and compared > 1000 and int(contacts) > compared


def test_frames_move_no_positions_through_the_host(stream):
    t0, t1, faces = draped(100)
    detector, every = nm.Detector(nm.Body(t0, faces), device=nm.Device(stream=stream)), nm.Continuous()
    ends = tuple(torch.from_numpy(end).cuda() for end in (t0, t1))
    wanted = detector.step({0: (t0, t1)}, every).hash
    told = lambda: detector.plan(every)["transfers"]
    for _ in range(3):
        assert detector.step({0: (t0, t1)}, every).hash == wanted
    from_host = told()
    for _ in range(3):
        assert detector.step({0: ends}, every).hash == wanted
    from_device = told()
    total = lambda rows: sum(row["to_device"]["bytes"] for row in rows)
    print(f"bytes to the device a frame: {total(from_host)} from the host, {total(from_device)} of tensors")
    assert total(from_host) >= t0.nbytes + t1.nbytes and total(from_device) < 1000


def test_a_graph_of_torch(stream):
    t0, t1, faces = draped(40)
    body = nm.Body(t0, faces)
    detector, judge = (nm.Detector(body, device=device) for device in (nm.Device(stream=stream), nm.Device("cpu")))
    every = nm.Continuous()
    here, there, far = (torch.from_numpy(end).cuda() for end in (t0, t0, t1))
    detector.prepare({0: (here, far)}, [every])
    detector.prepare({0: (here, there)}, [every])

    def step():
        here.copy_(there)
        there.lerp_(far, 0.1)

    step()
    graph = None
    for frame in range(40):
        if not detector.is_prepared:
            detector.prepare({0: (here, there)}, [every])
            graph = None
        if graph is None:
            stream.synchronize()
            graph = torch.cuda.CUDAGraph()
            with torch.cuda.graph(graph, stream=stream):
                step()
                detector.submit()
        graph.replay()
        wanted = judge.step({0: (here.cpu().numpy(), there.cpu().numpy())}, every)
        assert detector.collect(every).hash == wanted.hash
    assert len(wanted) > 0 or frame


def test_any_layout_and_precision(stream):
    t0, t1, faces = draped(30)
    wanted = nm.near(t1, faces, 0.01, device=nm.Device("cpu"))
    detector, near = nm.Detector(nm.Body(t0, faces), device=nm.Device(stream=stream)), nm.Near(0.01)
    wide = torch.zeros((len(t1), 5), device="cuda")
    wide[:, 1:4] = torch.from_numpy(t1).cuda()
    for tensor in [torch.from_numpy(t1).cuda(), wide[:, 1:4], torch.from_numpy(t1).cuda().double()]:
        assert detector.step({0: tensor}, near).hash == wanted.hash
        detector.update({0: tensor})
        assert detector.query(near).hash == wanted.hash
    for wrong in [wide[:, 1:3], wide[:, 1:4].half(), torch.from_numpy(t1).cuda().T.contiguous().T]:
        with pytest.raises(nm.InvalidArgumentError):
            detector.update({0: wrong})
    with pytest.raises(nm.InputError, match="vertex 7"):
        wide[7, 1] = float("nan")
        detector.step({0: wide[:, 1:4]}, near)
    with pytest.raises(nm.InvalidArgumentError, match="the detector is on the CPU"):
        nm.Detector(nm.Body(t0, faces), device=nm.Device("cpu")).update({0: wide[:, 1:4]})


class ByInterface:
    """An array that has the second door alone."""

    def __init__(self, tensor, **changed):
        self.tensor = tensor
        self.__cuda_array_interface__ = {**tensor.__cuda_array_interface__, **changed}


def test_the_second_door(stream):
    t0, t1, faces = draped(30)
    detector, near = nm.Detector(nm.Body(t0, faces), device=nm.Device(stream=stream)), nm.Near(0.01)
    tensor = torch.from_numpy(t1).cuda()
    wanted = detector.step({0: t1}, near).hash
    assert detector.step({0: ByInterface(tensor)}, near).hash == wanted
    assert detector.step({0: ByInterface(tensor, stream=stream.cuda_stream)}, near).hash == wanted
    with pytest.raises(nm.InvalidArgumentError, match="are of stream 1"):
        detector.update({0: ByInterface(tensor, stream=1)})


def test_what_is_taken_back(stream):
    t0, _, faces = draped(30)
    detector, near = nm.Detector(nm.Body(t0, faces), device=nm.Device(stream=stream)), nm.Near(0.03)
    here = torch.from_numpy(t0).cuda()
    detector.prepare({0: here}, [near])
    detector.submit()
    answer = detector.on_device(near)
    columns = {name: torch.from_dlpack(array) for name, array in answer.lists[0].items()}
    other = torch.cuda.Stream()
    with torch.cuda.stream(other):
        count = int(torch.from_dlpack(answer.status)[:2].sum())
    found = detector.collect(near)
    assert count == len(found) > 0 and columns["feature_a"].ndim == columns["feature_b"].ndim == 1
    if answer.is_ordered:
        for name in ["feature_a", "feature_b", "squared_distances"]:
            assert np.array_equal(columns[name][:count].cpu().numpy(), getattr(found, name))
    # The detector lives as long as what shows its memory.
    kept = weak = columns["feature_a"]
    del detector, answer
    gc.collect()
    assert np.array_equal(kept[:count].cpu().numpy(), found.feature_a) and weak is kept


def test_poses_of_tensors(stream):
    vertices, faces = soup(80, 4, 0.5)
    scene = nm.Scene(nm.Body(vertices, faces, kind="fixed"), nm.Body(vertices, faces, kind="rigid"))
    turn, move = [0.0, 0.0, np.sin(0.1), np.cos(0.1)], [0.1, 0.2, 0.3]
    wanted = nm.Detector(scene, device=nm.Device("cpu")).step({1: nm.Pose(turn, move)}, nm.Discrete())
    detector = nm.Detector(scene, device=nm.Device(stream=stream))
    pose = nm.Pose(*(torch.tensor(x, dtype=torch.float64, device="cuda") for x in (turn, move)))
    assert detector.step({1: pose}, nm.Discrete()).hash == wanted.hash and len(wanted) > 5


def test_rows_of_poses_of_tensors(stream):
    vertices, faces = soup(80, 4, 0.5)
    scene = nm.Scene(*(nm.Body(vertices, faces, kind="rigid", name=f"body {k}") for k in range(3)))
    random = np.random.default_rng(3)
    turns = random.standard_normal((2, 3, 4))
    turns /= np.linalg.norm(turns, axis=2, keepdims=True)
    moves = 0.3 * random.standard_normal((2, 3, 3))
    by_host, detector = nm.Detector(scene, device=nm.Device("cpu")), nm.Detector(scene, device=nm.Device(stream=stream))
    here = lambda array: torch.from_numpy(array).cuda()
    ids = [2, "body 0", 1]
    by_host.update_poses(ids, moves[0], turns[0], end_positions=moves[1], end_quaternions=turns[1])
    detector.update_poses(ids, here(moves[0]), here(turns[0]), end_positions=here(moves[1]), end_quaternions=here(turns[1]))
    for query in [nm.Discrete(), nm.Continuous(), nm.Near(0.05)]:
        assert detector.query(query).hash == by_host.query(query).hash
    assert detector.poses(0) == by_host.poses(0)
    with pytest.raises(nm.InvalidArgumentError, match="positions and quaternions are in different memories"):
        detector.update_poses(ids, here(moves[0]), turns[0])
    with pytest.raises(nm.InvalidArgumentError, match="poses on a GPU turn about the origin of the mesh"):
        nm.PoseStep(*[nm.Pose(here(turns[0][k]), here(moves[0][k])) for k in (0, 1)], pivot=(0, 0, 1))
    with pytest.raises(nm.InvalidArgumentError, match="the body is rigid; give Pose"):
        detector.update({0: here(np.eye(4))})


def test_a_pose_is_one_row(stream):
    vertices, faces = soup(10, 4, 0.5)
    scene = nm.Scene(nm.Body(vertices, faces, kind="fixed"), nm.Body(vertices, faces, kind="rigid"))
    detector = nm.Detector(scene, device=nm.Device(stream=stream))
    turn, move = torch.tensor([[0.0, 0, 0, 1]], device="cuda"), torch.zeros((1, 3), device="cuda")
    detector.step({1: nm.Pose(turn, move)}, nm.Discrete())
    for rows in [0, 2]:
        with pytest.raises(nm.InvalidArgumentError, match=f"a rotation of {rows} rows"):
            detector.update({1: nm.Pose(turn.expand(rows, 4), move)})
        with pytest.raises(nm.InvalidArgumentError, match=f"a translation of {rows} rows"):
            detector.update({1: nm.Pose(turn, move.expand(rows, 3))})


def test_an_answer_that_has_moved_is_not_shown(stream):
    t0, _, faces = draped(10)
    detector, near = nm.Detector(nm.Body(t0, faces), device=nm.Device(stream=stream)), nm.Near(0.02)
    detector.prepare({0: torch.from_numpy(t0).cuda()}, [near])
    detector.submit()
    status = detector.on_device(near).status
    assert status.__cuda_array_interface__["data"][1] is False
    assert torch.as_tensor(status, device="cuda").shape == (5,)
    detector.update({0: t0})
    with pytest.raises(nm.InvalidArgumentError, match="the answer on the device is gone"):
        status.__cuda_array_interface__


def test_arrays_of_cupy(stream):
    cupy = pytest.importorskip("cupy")
    t0, t1, faces = draped(30)
    wanted = nm.contacts(t0, t1, faces, device=nm.Device("cpu"))
    with cupy.cuda.ExternalStream(stream.cuda_stream) as own:
        detector, every = nm.Detector(nm.Body(t0, faces), device=nm.Device(stream=own)), nm.Continuous()
        ends = tuple(cupy.asarray(end) for end in (t0, t1))
        assert detector.step({0: ends}, every).hash == wanted.hash
        detector.prepare({0: ends}, [every])
        detector.submit()
        answer = detector.on_device(every)
        by_dlpack, by_interface = cupy.from_dlpack(answer.status), cupy.asarray(answer.status)
        assert by_dlpack.tolist() == by_interface.tolist() and sum(by_dlpack.tolist()[:2]) == len(wanted)
        detector.collect(every)


def test_frames_beside_a_graph_that_another_thread_records(stream):
    """torch records in CUDA's global mode: whatever waits or takes memory in another thread is refused, but for who says otherwise."""
    t0, t1, faces = draped(30)
    wanted = nm.contacts(t0, t1, faces, device=nm.Device("cpu")).hash
    recording, asked = threading.Event(), threading.Event()
    told = []

    def ask():
        recording.wait()
        try:
            # Opened, made and queried while the other records.
            detector = nm.Detector(nm.Body(t0, faces), device=nm.Device(gpu=0))
            told.extend(detector.step({0: (t0, t1)}, nm.Continuous()).hash for _ in range(3))
        finally:
            asked.set()

    other = threading.Thread(target=ask)
    other.start()
    x = torch.zeros(1000, device="cuda")
    stream.synchronize()
    graph = torch.cuda.CUDAGraph()
    with torch.cuda.graph(graph, stream=stream):
        x += 1
        recording.set()
        asked.wait()
        x += 1
    other.join()
    graph.replay()
    stream.synchronize()
    assert told == [wanted] * 3 and float(x.sum()) == 2000


def test_what_a_refused_frame_left_behind_is_not_answered_of(stream):
    t0, t1, faces = draped(20)
    scene = nm.Scene(nm.Body(t0, faces))
    other = scene.add(nm.Body(t1 + 0.01, faces))
    detector, judge = (nm.Detector(scene, device=device) for device in (nm.Device(stream=stream), nm.Device("cpu")))
    every = nm.Continuous()
    here, there = (torch.from_numpy(array).cuda() for array in (t0, t1))
    bad = there.clone()
    bad[7, 1] = float("nan")
    with pytest.raises(nm.InputError, match="vertex 7 has y"):
        detector.step({0: (here, bad)}, every)
    for asked in [lambda: detector.step({}, every), lambda: detector.step({other: (t1, t1)}, every), detector.continuous]:
        with pytest.raises(nm.InvalidArgumentError, match="name it again"):
            asked()
    wanted = judge.step({0: (t0, t1), other: t1}, every)
    found = detector.step({0: (here, there), other: t1}, every)
    assert found.hash == wanted.hash and len(found) > 100


def test_arrays_of_an_update_are_kept_until_they_are_read(stream):
    t0, t1, faces = draped(40)
    body, near = nm.Body(t0, faces), nm.Near(0.01)
    wanted = nm.Detector(body, device=nm.Device("cpu")).step({0: t1}, near)
    detector = nm.Detector(body, device=nm.Device(gpu=0))
    detector.near(0.01)
    for _ in range(20):
        # On the current stream, which is not the detector's.
        detector.update({0: torch.from_numpy(t1).cuda()})
        spoiled = [torch.full(t1.shape, float("nan"), device="cuda") for _ in range(4)]
        assert detector.query(near).hash == wanted.hash
        del spoiled


def test_three_queries_of_one_submission(stream):
    t0, t1, faces = draped(40)
    body, queries = nm.Body(t0, faces), [nm.Near(0.01), nm.Earliest(), nm.Discrete()]
    detector, judge = (nm.Detector(body, device=device) for device in (nm.Device(stream=stream), nm.Device("cpu")))
    here, there = (torch.from_numpy(end).cuda() for end in (t0, t1))
    detector.prepare({0: (here, there)}, queries)
    for _ in range(5):
        here.lerp_(there, 0.1)
        if not detector.is_prepared:
            detector.prepare({0: (here, there)}, queries)
        detector.submit()
        judge.update({0: (here.cpu().numpy(), there.cpu().numpy())})
        for query in queries:
            assert detector.collect(query).hash == judge.query(query).hash


def test_the_graph_of_forces_of_the_book(capsys):
    runpy.run_path(str(Path(__file__).parents[1] / "examples" / "graph_of_forces.py"))
    assert 0 < float(capsys.readouterr().out) < 1


def test_the_cloth_of_the_book(stream):
    import cloth_torch

    cells, frames = 20, 400
    cloth, log, faults = cloth_torch.run(cells, frames, "cuda")
    assert faults == [] and len(log.crossing) == frames and max(log.limited) > 0
    on_cpu = cloth_torch.Cloth(cells, "cpu")
    again = cloth_torch.Cloth(cells, "cuda", stream)
    for _ in range(15):
        assert on_cpu.frame()[1] == again.frame()[1] == 0
    assert torch.allclose(on_cpu.x, again.x.cpu(), atol=1e-9)
