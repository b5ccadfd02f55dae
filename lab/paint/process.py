"""A process of its own that paints recordings, one after the other.

It is a plain Python process with two pipes, so that a script that calls the lab needs no guard for it. Jobs go in and
answers come out as lines of JSON. A job has the arguments of `render_recording`. Its answers are {"done": k, "of": n}
after each picture and at last {"made": path} or {"failed": sentence}. The process ends with its input, and in the midst
of a video as soon as nobody hears its answers.
"""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from threading import Thread

from lab.paint.palette import INK

PATIENCE = 10.0  # s that a process has to remove an unfinished video

Heard = SimpleQueue  # of pairs of a Painter and its answer, None if it has ended


class Painter:
    """A painting process; its answers are put into `heard`. cores: of its painting, besides those of ffmpeg.

    silent: without tracebacks, where another process does what this one fails to do. Raises OSError or RuntimeError if
    the system has no room for it.
    """

    def __init__(self, heard: Heard, cores: int, silent: bool = False) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-m", __name__, str(cores)],
            env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL if silent else None,
            text=True,
            process_group=0,  # a Ctrl-C is for this process, which then stops the other
        )
        Thread(target=self._hear, args=(heard,), daemon=True).start()

    @property
    def pid(self) -> int:
        """The number of the process."""
        return self._process.pid

    def paint(self, job: Mapping[str, object]) -> None:
        """Have a recording painted; job: the arguments of `render_recording`, in types that JSON has."""
        with suppress(OSError):  # it has ended, which is heard, too
            self._process.stdin.write(f"{json.dumps(job)}\n")
            self._process.stdin.flush()

    def end(self) -> None:
        """Let the process end after what it has in hand."""
        with suppress(OSError):
            self._process.stdin.close()

    def stop(self) -> None:
        """End the process now, also in the midst of a video, of which nothing stays."""
        self.end()
        self._process.send_signal(signal.SIGTERM)  # nothing happens if it has ended
        self.wait()

    def wait(self) -> None:
        """Wait until the process has ended, and kill it if it does not."""
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _hear(self, heard: Heard) -> None:
        with suppress(ValueError):  # a line that was cut off
            for line in self._process.stdout:
                heard.put((self, json.loads(line)))
        heard.put((self, None))


class Ending:
    """Raises KeyboardInterrupt at the first signal, and again with each picture.

    Python drops what is raised while it frees an object. Without the second, such a process would paint on.
    """

    def __init__(self) -> None:
        self._asked = False
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._receive)

    def _receive(self, *_: object) -> None:
        self._asked = True
        self.heed()

    def heed(self) -> None:
        """Raise KeyboardInterrupt if a signal has come."""
        if self._asked:
            raise KeyboardInterrupt


def serve(cores: int) -> None:
    """Paint what is asked for on the standard input, until it ends."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what libraries print does not get among the answers
    ending = Ending()

    def answer(**words: object) -> None:
        ending.heed()
        print(json.dumps(words), file=answers, flush=True)

    try:
        get_ready(cores)
        for line in sys.stdin:
            _paint(json.loads(line), answer)
    except (KeyboardInterrupt, BrokenPipeError):
        pass
    os._exit(0)  # nothing is left to be written, and nobody hears of a broken pipe


def get_ready(cores: int) -> None:
    """Do what comes before the first picture: import, start Taichi, and load the kernels that most videos need."""
    import numpy as np

    from lab.paint.painter import Camera, paint_grains, paint_strokes, paint_tank
    from lab.paint.video import render_recording  # noqa: F401 (imports all that paints)
    from solvers.machine.errors import Unavailable
    from solvers.machine.runtime import initialise, use_cores

    use_cores(cores)
    with suppress(Unavailable):  # the first job says so
        initialise(fields=False)
        picture, disc = np.zeros((32, 32, 3), np.uint8), np.array([[9.0, 9.0, 5.0, 1.0, 0.0]])
        paint_tank(picture, Camera(1.0, (0.0, 32.0)), np.array([[2.0, 2.0], [20.0, 2.0], [9.0, 20.0]]), 1.0, INK, INK)
        paint_grains(picture, disc, np.array([INK]), np.array([INK]))
        paint_strokes(picture, np.array([[2.0, 2.0, 1.0, 20.0, 20.0, 1.0]]), INK)


def _paint(job: dict[str, object], answer) -> None:
    from lab.base.errors import LabError, os_sentence
    from lab.paint.video import render_recording
    from solvers.machine.errors import Unavailable

    try:
        made = render_recording(**job, progress=lambda done, total: answer(done=done, of=total))
    except (LabError, Unavailable) as error:
        answer(failed=str(error))
    except BrokenPipeError:
        raise
    except OSError as error:
        answer(failed=os_sentence(error))
    except MemoryError:
        answer(failed=f"{Path(job['path'])}: there is not enough memory to paint it.")
    else:
        answer(made=str(made))


if __name__ == "__main__":
    serve(int(sys.argv[1]))
