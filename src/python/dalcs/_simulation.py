"""A run that goes on step by step: other programs stand still in between."""

from __future__ import annotations

import queue
import threading
from typing import Any, Callable, Dict, Mapping, Optional, Tuple

from ._names import no_such
from ._result import Result
from ._session import Exchange

Turn = Tuple[float, Dict[str, float]]


class _Closed(Exception):
    """Ends the run from within an exchange."""


class Simulation:
    """A run in a thread of its own, which waits until step() is called. Circuit.start() makes it.

    time      s, where it stands
    signals   all signals there by name, V and A, just before `time`; empty at first
    inputs    the values of the external sources
    result    the Result once it has come to its end, else None
    """

    def __init__(self, run: Callable[[Exchange], Result]) -> None:
        self.time = 0.0
        self.signals: Mapping[str, float] = {}
        self.inputs: Dict[str, float] = {}
        self.result: Optional[Result] = None
        self._run = run
        self._failure: Optional[BaseException] = None
        self._given: "queue.Queue[Optional[Turn]]" = queue.Queue()
        self._come: "queue.Queue[bool]" = queue.Queue()
        self._thread = threading.Thread(target=self._work, daemon=True)
        self._thread.start()
        self._wait()

    def _work(self) -> None:
        try:
            self.result = self._run(self._exchange)
        except BaseException as error:  # pylint: disable=broad-except
            self._failure = error
        self._come.put(False)

    def _exchange(self, time: float, signals: Mapping[str, float], inputs: Dict[str, float]) -> float:
        self.time, self.signals, self.inputs = time, signals, dict(inputs)
        self._come.put(True)
        turn = self._given.get()
        if turn is None:
            raise _Closed
        inputs.update(turn[1])
        return turn[0]

    def _wait(self) -> None:
        if self._come.get():
            return
        self._thread.join()
        if self._failure is not None and not isinstance(self._failure, _Closed):
            raise self._failure
        if self.result is not None and len(self.result) > 0:
            self.time = float(self.result.t[-1])
            self.signals = {name: float(self.result[name][-1]) for name in self.result}

    def step(self, until: float, **inputs: float) -> Mapping[str, float]:
        """Goes on to `until` (s) with these values of external sources; gives the signals there.

        Sources that are not named stay as they are. Behind the end of the run it stands at the end, and
        `result` is there.
        """
        if self.result is not None:
            raise ValueError(f"the run has come to its end at {self.time:g} s")
        if not self._thread.is_alive():
            raise ValueError("the run was closed, or has failed")
        if not until > self.time:
            raise ValueError(f"it stands at {self.time:g} s already and cannot go to {until:g} s")
        unknown = inputs.keys() - self.inputs.keys()
        if unknown:
            raise no_such("external source", min(unknown), self.inputs)
        self._given.put((until, {**self.inputs, **inputs}))
        self._wait()
        return self.signals

    def close(self) -> None:
        """Ends the run where it stands."""
        if self._thread.is_alive():
            self._given.put(None)
            self._wait()

    def __enter__(self) -> "Simulation":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()
