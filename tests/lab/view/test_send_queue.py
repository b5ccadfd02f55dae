"""The experiment does not wait for the window."""

from multiprocessing import Pipe

import pytest

from lab.view.send_queue import SendQueue

LARGE = bytes(10**6)  # more than a pipe holds


def test_the_experiment_continues_while_nobody_reads_and_the_newest_frame_arrives():
    here, there = Pipe()
    queue = SendQueue(there)
    queue.send("message", LARGE)
    for k in range(100):
        queue.send("frame", (k, LARGE), newest=True)
    queue.send("message", "at last")
    found = [here.recv() for _ in range(3)]
    queue.finish()
    assert [word for word, _ in found] == ["message", "frame", "message"]
    assert found[1][1][0] == 99
    assert found[2][1] == "at last"
    assert not here.poll()


def test_replaceable_messages_arrive_once_and_all_others_always():
    here, there = Pipe()
    queue = SendQueue(there)
    queue.send("message", LARGE)  # which the pipe is full of
    queue.send("message", "kept")
    for k in range(50):
        queue.send("message", k, newest=True)
        queue.send("frame", k, newest=True)
    found = [here.recv() for _ in range(4) if here.poll(10.0)]
    queue.finish()
    assert found[1:] == [("message", "kept"), ("message", 49), ("frame", 49)]
    assert not here.poll()


def test_the_queue_ends_with_the_window():
    here, there = Pipe()
    queue = SendQueue(there)
    here.close()
    queue.send("message", LARGE)
    queue._thread.join()
    with pytest.raises(BrokenPipeError):
        queue.send("message", LARGE)
    queue.finish()
