"""Ctrl-C ends a call on the main thread; another thread ends one by Detector.interrupt; nothing stays locked."""

import gc
import os
import signal
import threading
import time

import numpy as np
import pytest
from shapes import soup, two_triangles

import nearmiss as nm

V, F = two_triangles()
# Triangles in one place, all of which meet: a frame takes long.
LONG = np.tile(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32), (3000, 1)), np.arange(9000).reshape(-1, 3)
# Time that a busy machine may add to the promised 0.2 s.
SOON = 2.0


@pytest.fixture(autouse=True)
def heard():
    """Python hears SIGINT. Who runs in the background of a shell ignores it, and would wait for ever."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupted(call):
    """Calls until a SIGINT ends it; seconds since the signal."""
    sent = []

    def send():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.4, send)
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            call()
            pytest.fail("it ended before the signal")
        took = time.monotonic() - sent[0]
    finally:
        timer.join()
    print(f"{took:.3f} s")
    assert took < SOON
    return took


@pytest.mark.parametrize("threads", [1, 2])
def test_a_signal_ends_a_frame(threads):
    v, f = LONG
    detector = nm.Detector(nm.Body(v, f), device=nm.Device("cpu", threads=threads))
    interrupted(lambda: detector.step({0: (v, v + np.float32(0.25))}, nm.Continuous()))
    # In that frame: the same handle, another answer in time.
    detector.replace(0, nm.Body(V, F))
    assert len(detector.continuous()) == len(nm.Detector(nm.Body(V, F), device=detector.device).continuous())


def quick(detector):
    """Short calls: the next one is expected to be short, and runs on the main thread."""
    for _ in range(30):
        detector.discrete()


def long_frame(detector):
    """A frame of a detector of two triangles that takes long."""
    number = detector.add(nm.Body(*LONG))
    return lambda: detector.step({number: (LONG[0], LONG[0] + np.float32(0.25))}, nm.Continuous())


@pytest.mark.parametrize("threads", [1, 2])
def test_a_signal_ends_a_frame_that_was_expected_to_be_short(threads):
    detector = nm.Detector(nm.Body(V, F), device=nm.Device("cpu", threads=threads))
    quick(detector)
    want = detector.discrete()
    frame = long_frame(detector)
    interrupted(frame)
    detector.remove(1)
    assert np.array_equal(detector.discrete().triangles, want.triangles)


def test_a_handler_that_calls_in_the_middle_of_a_short_call_is_refused():
    device = nm.Device("cpu", threads=1)
    detector, other, new = (nm.Detector(nm.Body(V, F), device=device) for _ in range(3))
    elsewhere = nm.Detector(nm.Body(V, F), device=nm.Device("cpu", threads=1))
    quick(detector)
    quick(other)
    frame = long_frame(detector)
    told, answers = [], []

    def handler(*_):
        # Calls of the last one are not known to be short: they run on another thread.
        for same in detector, other, new:
            with pytest.raises(nm.InvalidArgumentError, match="handler called a detector.* call later") as error:
                same.discrete()
            told.append(error)
        answers.append(len(elsewhere.discrete()))
        raise TimeoutError

    before = signal.signal(signal.SIGALRM, handler)
    signal.setitimer(signal.ITIMER_REAL, 0.2)
    try:
        with pytest.raises(TimeoutError):
            frame()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert len(told) == 3 and answers == [1]
    assert [len(each.discrete()) for each in (other, new)] == [1, 1]


def test_a_handler_that_does_not_raise_lets_a_short_call_go_on():
    detector = nm.Detector(nm.Body(V, F), device=nm.Device("cpu", threads=1))
    quick(detector)
    number = detector.add(nm.Body(*soup(4000, 3, 0.5)))
    calls = []
    before = signal.signal(signal.SIGALRM, lambda *_: calls.append(time.monotonic()))
    signal.setitimer(signal.ITIMER_REAL, 0.02, 0.02)
    try:
        answer = detector.continuous()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert calls and len(answer) == len(detector.continuous())
    detector.remove(number)


@pytest.mark.parametrize(
    "call",
    [
        lambda v, f: nm.contacts(v, v + np.float32(0.25), f),
        lambda v, f: nm.time_of_impact(v, v + np.float32(0.25), f, min_separation=0.5, tolerance=1e-6),
    ],
)
def test_a_signal_ends_a_question_in_one_line(call):
    def again():
        while True:
            call(*LONG)

    interrupted(again)


def test_a_signal_ends_who_waits_for_the_device():
    device = nm.Device("cpu", threads=1)
    waiting = nm.Detector(nm.Body(V, F), device=device)
    busy = nm.Detector(nm.Body(*soup(3000, 1, 0.5)), device=device)
    stop, errors = threading.Event(), []

    def frames():
        try:
            while not stop.is_set():
                busy.step({}, nm.Continuous())
        except BaseException as error:  # noqa: BLE001
            errors.append(error)

    thread = threading.Thread(target=frames)
    thread.start()
    try:

        def ask():
            while True:
                waiting.discrete()
                busy.continuous()

        interrupted(ask)
    finally:
        stop.set()
        thread.join()
    assert not errors, "signals are for the main thread"
    assert len(waiting.discrete()) == 1


def test_another_thread_ends_a_frame():
    detector = nm.Detector(nm.Body(*soup(500, 1)), device=nm.Device("cpu"))
    want = detector.discrete()
    timer = threading.Timer(0.3, detector.interrupt)
    timer.start()
    with pytest.raises(nm.Interrupted, match="can be used again"):
        while True:
            detector.discrete()
    timer.join()
    assert np.array_equal(detector.discrete().triangles, want.triangles)
    # None runs: the next one ends.
    detector.interrupt()
    with pytest.raises(nm.Interrupted):
        detector.discrete()
    assert np.array_equal(detector.discrete().triangles, want.triangles)


def test_a_frame_on_another_thread_is_ended_by_the_handle():
    detector = nm.Detector(nm.Body(*LONG), device=nm.Device("cpu"))
    raised = []

    def frame():
        try:
            detector.step({0: (LONG[0], LONG[0] + np.float32(0.25))}, nm.Continuous())
        except nm.Interrupted as error:
            raised.append(error)

    threads = [threading.Thread(target=frame) for _ in range(2)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        time.sleep(0.1)
        detector.interrupt()
    assert len(raised) == 2
    del detector, threads
    gc.collect()


def test_a_refused_frame_leaves_nothing_locked():
    detector = nm.Detector(nm.Body(*soup(20_000, 1)), device=nm.Device("cpu"))
    for _ in range(2):
        with pytest.raises(nm.OutOfMemory, match="at least 2999850000 pairs.* use a smaller distance"):
            detector.near(50.0)
    ended = []
    thread = threading.Thread(target=lambda: ended.append(repr(detector)))
    thread.start()
    thread.join(10)
    assert ended and not thread.is_alive()
    del detector
    gc.collect()


def test_a_signal_ends_reading(tmp_path):
    file = tmp_path / "large.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "f 1 2 3\n" * 2_000_000)

    def read():
        while True:
            nm.read_mesh(file)

    interrupted(read)
