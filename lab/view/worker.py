"""The live experiment in a separate process, so that drawing and simulation do not wait for each other.

The processes exchange messages, pairs of a word and its data. To the experiment: `set` (name, value), `go`, `pace`,
`piece`, `keep` (folder), `end`. From it: `message` (sentence), `settling` (StaticScene of a bed that is not ready yet),
`ready` (StaticScene, the preset's own motion), `frame` (LiveFrame, speed reached), `kept` (folder), `over` (sentence).
"""

import math
import shutil
import signal
import time
from collections.abc import Mapping
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path

from lab.base.errors import LabError
from lab.base.interrupt import SIGNALS, handle_signals
from lab.base.progress import Progress
from lab.preset.find import LoadedPreset, load
from lab.recording import FILE_NAME, Recorder
from lab.recording.ship_end import VERBS
from lab.view.footage import StaticScene
from lab.view.live import Live, LiveFrame, own_motion, steerable
from lab.view.send_queue import SendQueue
from solvers.grains.pressing import UNTOUCHED
from solvers.machine import runtime
from solvers.machine.errors import BadState, Unavailable
from solvers.simulation import Simulation
from solvers.time.schedules import work

PICTURE_INTERVAL = 0.03  # s; shortest time between two frames sent
IDLE = 0.01  # s between checks for messages while paused
GRAIN_STEPS_A_CALL = 100_000  # between checks for messages, some milliseconds


class SentProgress(Progress):
    """Progress sent to the window, with pictures of the bed as it settles."""

    def __init__(self, queue: SendQueue, loaded: LoadedPreset, folder: Path) -> None:
        super().__init__(quiet=True)
        self._queue, self._stage = queue, ""
        self._loaded, self._folder = loaded, folder
        self._watched, self._sent = None, -math.inf

    def start(self, stage: str, total: float | None, cost: float = 0.0) -> None:
        """Begin a stage."""
        super().start(stage, total, cost)
        self._stage = stage
        self._queue.send("message", f"{stage} …")

    def reach(self, done: float) -> None:
        """Send the time reached in the stage."""
        super().reach(done)
        self._queue.send("message", f"{self._stage}: {done:.2f} s", newest=True)

    def watch(self, simulation: Simulation) -> None:
        """Show the grains, without their contacts."""
        if time.monotonic() - self._sent < PICTURE_INTERVAL:
            return
        frame = LiveFrame.of(simulation, simulation.observe(), UNTOUCHED)
        if simulation is not self._watched:
            self._watched = simulation
            top = float(frame.grains["position"][..., 1].max() + 2.0 * simulation.scene.grains.radius.max())
            self._queue.send("settling", StaticScene.of(self._loaded, self._folder, simulation).for_filling(top))
        self._queue.send("frame", (frame, 0.0), newest=True)
        self._sent = time.monotonic()


class Worker:
    """The experiment's end of the pipe."""

    def __init__(self, live: Live, pipe: Connection, queue: SendQueue) -> None:
        self._live, self._pipe, self._queue = live, pipe, queue
        self._going, self._pieces, self._pace, self._ended = False, 0, 1.0, False
        self._changes: list[tuple[str, float]] = []
        self._most = max(1, GRAIN_STEPS_A_CALL // work(live.run.scene))
        self._sent = -math.inf
        self._anchor = (time.monotonic(), live.time)
        self._factor = 0.0

    def serve(self) -> None:
        """Run until the window closes. Raises BadState."""
        self._send()
        while not self._ended:
            self._listen()
            if not (self._going or self._pieces):
                time.sleep(IDLE)
                self._anchor = (time.monotonic(), self._live.time)
                continue
            self._take_piece()

    def _take_piece(self) -> None:
        for name, value in self._changes:
            try:
                self._live.set(name, value)
            except LabError as error:
                self._queue.send("message", str(error))
        self._changes.clear()
        begun = time.monotonic()
        self._live.advance(self._listen, self._most)
        taken = time.monotonic() - begun
        length = self._live.steps_a_piece * self._live.simulation.dt
        self._factor += 0.2 * (length / max(taken, 1e-9) - self._factor)
        self._pieces = max(0, self._pieces - 1)
        if max(self._live.rows.get(kind, [-1.0])[0] for kind in VERBS) >= 0.0:
            self._going = False  # the picture shows how the ship was lost
        if time.monotonic() - self._sent >= PICTURE_INTERVAL or not self._going:
            self._send()
        self._wait()

    def _wait(self) -> None:
        """Wait to keep the requested pace; if the experiment is too slow, restart the clock."""
        wall, model = self._anchor
        due = wall + (self._live.time - model) / self._pace
        if time.monotonic() > due + 0.1:
            self._anchor = (time.monotonic(), self._live.time)
        while self._going and not self._ended and time.monotonic() < due:
            time.sleep(min(IDLE, max(0.0, due - time.monotonic())))
            self._listen()

    def _send(self) -> None:
        self._queue.send("frame", (self._live.frame(), min(self._factor, self._pace)), newest=True)
        self._sent = time.monotonic()

    def _listen(self) -> None:
        while self._pipe.poll():
            word, what = self._pipe.recv()
            if word == "set":
                self._changes.append(what)
            elif word == "go":
                self._going = what
            elif word == "pace":
                self._pace, self._anchor = what, (time.monotonic(), self._live.time)
            elif word == "piece":
                self._pieces += 1
            elif word == "keep":
                self._keep(what)
            else:
                self._ended = True

    def _keep(self, folder: Path) -> None:
        """Copy what was recorded so far into a folder, as a recording that is complete."""
        try:
            self._live.recorder.sync()
            folder.mkdir(parents=True)
            shutil.copy2(self._live.folder / FILE_NAME, folder / FILE_NAME)
            rows = self._live.recorder.rows
            Recorder(folder, samples=rows[0], frames=rows[1]).close()
        except (LabError, OSError) as error:
            self._queue.send("message", f"nothing was kept: {error}")
            return
        self._queue.send("kept", folder)


def serve(pipe: Connection, name: str, overrides: Mapping, folder: Path, cores: int) -> None:
    """Begin the experiment and run it for the window at the other end."""
    for number in set(SIGNALS) - {signal.SIGTERM}:
        signal.signal(number, signal.SIG_IGN)  # the window ends this process when it closes
    runtime.use_cores(cores)
    queue = SendQueue(pipe)
    try:
        _run(name, overrides, folder, pipe, queue)
    except (LabError, BadState, Unavailable) as error:
        queue.send("over", str(error))
    except (EOFError, BrokenPipeError, ConnectionResetError, KeyboardInterrupt):  # the window is gone or ends this
        pass
    queue.finish()


def _run(name: str, overrides: Mapping, folder: Path, pipe: Connection, queue: SendQueue) -> None:
    loaded = load(name, overrides)
    prepared = steerable(loaded)
    with Live(prepared, folder, SentProgress(queue, prepared, folder)) as live:
        handle_signals(patient=True)  # not before: while nothing is recorded, SIGTERM may end it at once
        queue.send("ready", (StaticScene.of(prepared, folder, live.simulation), own_motion(loaded.resolved)))
        try:
            Worker(live, pipe, queue).serve()
        except BadState as error:
            live.close(f"stopped: {error}")
            raise
        live.close()


def begin(name: str, overrides: Mapping, folder: Path) -> tuple[object, Connection]:
    """Start the process; returns it and the window's end of the pipe. One core is left for the pictures."""
    context = get_context("spawn")
    here, there = context.Pipe()
    cores = max(1, runtime.available_cores() - 1)
    process = context.Process(target=serve, args=(there, name, dict(overrides), folder, cores), daemon=True)
    process.start()
    there.close()
    return process, here
