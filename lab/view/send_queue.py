"""Messages from the experiment to the window, sent by a separate thread, so that the solver does not wait."""

import threading
from collections import deque
from multiprocessing.connection import Connection


class SendQueue:
    """A queue of messages, pairs of a word and its data, sent in order; some replace older ones of the same word.

    `finish` waits until all are sent. Raises BrokenPipeError once the window is gone.
    """

    def __init__(self, pipe: Connection) -> None:
        self._pipe, self._pairs, self._changed = pipe, deque(), threading.Condition()
        self._finished = False
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def send(self, word: str, what: object, newest: bool = False) -> None:
        """Queue a message; with `newest` an older one of this word that is still waiting is dropped."""
        if not self._thread.is_alive():
            raise BrokenPipeError
        with self._changed:
            if newest:
                self._pairs = deque(pair for pair in self._pairs if pair[0] != word or not pair[2])
            self._pairs.append((word, what, newest))
            self._changed.notify()

    def finish(self) -> None:
        """Send all waiting messages and end the thread."""
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
