"""Those who make the runs of a sweep: threads, or processes of which one may die and lose no run but its own."""

from __future__ import annotations

import contextlib
import itertools
import os
import pickle
import signal
import sys
import threading
from collections import deque
from multiprocessing.connection import Connection, Pipe, wait
from typing import Any, Callable, Deque, Dict, List, NamedTuple, Optional

from . import _library as c
from ._errors import Cancelled, Crashed, Error

Task = Callable[[int], Any]
Done = Optional[Callable[[int, int], Any]]


class NotRun(Error):
    """A run that was not begun or not ended: Ctrl-C came before."""

    def __init__(self) -> None:
        super().__init__(c.E_CANCELLED, ["error: not run: the sweep was ended before"])

    def __reduce__(self):  # type: ignore[no-untyped-def]
        return type(self), ()


class Threads:
    """They take the next run until there is none, or until they are stopped."""

    def __init__(self, task: Task, count: int, done: Done) -> None:
        self.task, self.done = task, done
        self.kept: List[Any] = [NotRun() for _ in range(count)]
        self.stopped = threading.Event()
        self.failure: Optional[BaseException] = None
        self.next = itertools.count()
        self.moved = threading.Condition()
        self.n_done = 0

    def is_stopped(self) -> bool:
        """Are the runs at hand to end?"""
        return self.stopped.is_set()

    def work(self, tell: Callable[[int], None]) -> None:
        """What each thread does."""
        while not self.stopped.is_set():
            index = next(self.next)
            if index >= len(self.kept):
                return
            try:
                self.kept[index] = self.task(index)
            except Exception as error:  # pylint: disable=broad-except
                if not (self.stopped.is_set() and isinstance(error, Cancelled)):
                    self.kept[index] = error
            except BaseException as error:  # pylint: disable=broad-except
                self.failure = self.failure or error
                self.stopped.set()
                return
            with self.moved:
                self.n_done += 1
                count = self.n_done
                self.moved.notify_all()
            tell(count)

    def _in_threads(self, workers: int) -> None:
        threads = [threading.Thread(target=self.work, args=(lambda count: None,), daemon=True)
                   for _ in range(workers)]
        for thread in threads:
            thread.start()
        try:
            told = 0
            while self.done is not None and told < len(self.kept) and not self.stopped.is_set():
                with self.moved:
                    while self.n_done == told and not self.stopped.is_set():
                        self.moved.wait(0.1)
                    told = self.n_done
                self.done(told, len(self.kept))
            for thread in threads:
                thread.join()
        finally:
            self.stopped.set()
            for thread in threads:
                thread.join()

    def run(self, workers: int) -> None:
        """With one worker in this thread, which Ctrl-C interrupts by itself."""
        done = self.done
        if workers > 1:
            self._in_threads(workers)
        else:
            self.work(lambda count: None if done is None else done(count, len(self.kept)))
        if self.failure is not None:
            raise self.failure


def _flush() -> None:
    """What is printed twice where two processes have it unwritten."""
    for stream in sys.stdout, sys.stderr:
        with contextlib.suppress(AttributeError, ValueError, OSError):  # none, closed, full
            stream.flush()


class _Child(NamedTuple):
    """A process that makes one run after the other, as it is told on its pipe."""

    pid: int
    pipe: Connection


class Processes:
    """Copies of this process, by fork: what a run does to their memory, and a crash, stays there."""

    def __init__(self, task: Task, count: int, done: Done) -> None:
        self.task, self.done = task, done
        self.kept: List[Any] = [NotRun() for _ in range(count)]
        self.waiting: Deque[int] = deque(range(count))
        self.running: Dict[_Child, int] = {}
        self.parent = os.getpid()
        self.n_done = 0

    def is_stopped(self) -> bool:
        """In a child: is there nobody left who waits for the run?"""
        return os.getppid() != self.parent

    # ---- In the child ------------------------------------------------------------------------

    def _message_of(self, index: int) -> bytes:
        """What a run gave, or how it failed, and whether that ends the sweep."""
        try:
            return pickle.dumps((self.task(index), False))
        except Exception as error:  # pylint: disable=broad-except
            failure, ends = error, False
        except BaseException as error:  # pylint: disable=broad-except
            failure, ends = error, True  # type: ignore[assignment]
        try:
            message = pickle.dumps((failure, ends))
            pickle.loads(message)
            return message
        except Exception:  # pylint: disable=broad-except
            told = Error(c.E_INTERNAL, [f"error: {type(failure).__name__}: {failure}"])
            return pickle.dumps((told, ends))

    def _serve(self, pipe: Connection) -> None:
        """Never returns, for what stands behind the call is the parent's to do."""
        try:
            while True:
                pipe.send_bytes(self._message_of(pipe.recv()))
                _flush()
        finally:
            os._exit(0)

    # ---- In the parent -----------------------------------------------------------------------

    def _start(self) -> None:
        """One more, with its first run. Ctrl-C is for the parent, which then ends all of them."""
        _flush()
        here, there = Pipe()
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            pid = os.fork()
            if pid == 0:
                for other in self.running:
                    other.pipe.close()
                here.close()
                self._serve(there)
            there.close()
            self._give(_Child(pid, here))
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def _give(self, child: _Child) -> None:
        """The next run, or none: then it ends."""
        if self.waiting:
            self.running[child] = self.waiting.popleft()
            with contextlib.suppress(OSError):  # it is dead: the end of its pipe will tell
                child.pipe.send(self.running[child])
        else:
            self._bury(child)

    def _bury(self, child: _Child) -> int:
        """Its exit status, below 0 the signal that ended it."""
        del self.running[child]
        child.pipe.close()
        return os.waitstatus_to_exitcode(os.waitpid(child.pid, 0)[1])

    @staticmethod
    def _read(message: bytes) -> Any:
        """What a run gave or raised; raises what ends the sweep."""
        try:
            kept, ends = pickle.loads(message)
        except Exception as error:  # pylint: disable=broad-except
            return error
        if ends:
            raise kept
        return kept

    def _take(self, child: _Child) -> None:
        index = self.running[child]
        try:
            message = child.pipe.recv_bytes()
        except (EOFError, OSError):
            message = pickle.dumps((Crashed(self._bury(child)), False))
        self.kept[index] = self._read(message)
        self.n_done += 1
        if child in self.running:
            self._give(child)
        elif self.waiting:
            self._start()

    def _end(self) -> None:
        """What is ready is kept; what runs is killed."""
        for child in list(self.running):
            os.kill(child.pid, signal.SIGKILL)
            with contextlib.suppress(BaseException):  # the one that ends the sweep is under way
                if child.pipe.poll():
                    self.kept[self.running[child]] = self._read(child.pipe.recv_bytes())
            self._bury(child)

    def run(self, workers: int) -> None:
        """All runs; what a child cannot go on with is raised here."""
        try:
            for _ in range(workers):
                self._start()
            while self.running:
                for pipe in wait([child.pipe for child in self.running]):
                    self._take(next(child for child in self.running if child.pipe is pipe))
                if self.done is not None:
                    self.done(self.n_done, len(self.kept))
        finally:
            self._end()
