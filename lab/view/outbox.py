"""What the experiment tells the window, sent by a thread of its own: grains do not wait until somebody looks."""

import threading
from collections import deque
from multiprocessing.connection import Connection


class Outbox:
    """Pairs of a word and what belongs to it, in their order; of some only the newest counts, and older ones go.

    `finish` waits until all is sent. Raises BrokenPipeError once the window is gone.
    """

    def __init__(self, pipe: Connection) -> None:
        self._pipe, self._pairs, self._changed = pipe, deque(), threading.Condition()
        self._finished = False
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def send(self, word: str, what: object, newest: bool = False) -> None:
        """Have a pair sent; of those whose `newest` counts an older one that still waits is dropped."""
        if not self._thread.is_alive():
            raise BrokenPipeError
        with self._changed:
            if newest:
                self._pairs = deque(pair for pair in self._pairs if pair[0] != word or not pair[2])
            self._pairs.append((word, what, newest))
            self._changed.notify()

    def finish(self) -> None:
        """Nothing more comes."""
        with self._changed:
            self._finished = True
            self._changed.notify()
        self._thread.join()

    def _serve(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._pairs or self._finished)
                if not self._pairs:
                    return
                word, what, _ = self._pairs.popleft()
            try:
                self._pipe.send((word, what))
            except (BrokenPipeError, ConnectionResetError):
                return
