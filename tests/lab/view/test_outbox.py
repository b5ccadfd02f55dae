"""The experiment does not wait for the window."""

from multiprocessing import Pipe

import pytest

from lab.view.outbox import Outbox

LARGE = bytes(10**6)  # more than a pipe holds


def test_the_experiment_continues_while_nobody_reads_and_the_newest_frame_arrives():
    here, there = Pipe()
    outbox = Outbox(there)
    outbox.send("message", LARGE)
    for k in range(100):
        outbox.send("frame", (k, LARGE), newest=True)
    outbox.send("message", "at last")
    found = [here.recv() for _ in range(3)]
    outbox.finish()
    assert [word for word, _ in found] == ["message", "frame", "message"]
    assert found[1][1][0] == 99
    assert found[2][1] == "at last"
    assert not here.poll()


def test_replaceable_messages_arrive_once_and_all_others_always():
    here, there = Pipe()
    outbox = Outbox(there)
    outbox.send("message", LARGE)  # which the pipe is full of
    outbox.send("message", "kept")
    for k in range(50):
        outbox.send("message", k, newest=True)
        outbox.send("frame", k, newest=True)
    found = [here.recv() for _ in range(4) if here.poll(10.0)]
    outbox.finish()
    assert found[1:] == [("message", "kept"), ("message", 49), ("frame", 49)]
    assert not here.poll()


def test_the_outbox_ends_with_the_window():
    here, there = Pipe()
    outbox = Outbox(there)
    here.close()
    outbox.send("message", LARGE)
    outbox._thread.join()
    with pytest.raises(BrokenPipeError):
        outbox.send("message", LARGE)
    outbox.finish()
