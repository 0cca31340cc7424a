"""What went wrong, where, and with which element."""

from __future__ import annotations

import json
import re
import signal
from typing import Any, Optional, Sequence

from . import _library as c

_PLACED = re.compile(r"(?P<file>.*?):(?P<line>\d+):(?P<column>\d+): error: (?P<text>.*)")
_ELEMENT = re.compile(r"[A-Za-z]\w*")


class Error(Exception):
    """A netlist or run that failed.

    message   what a person should read first: the sentence, without its place
    messages  all messages of the run, with places, carets and hints
    file, line, column   the place in the netlist, or None
    element   the element that is to blame, in lower case, or None
    elements  all of those that are
    status    the number of dalcs.h, < 0 or a numerical failure
    result    of a run that ended early: the rows until then, and of .step the steps that did not fail;
              None where there are no rows. Its report tells under "failed_steps" which did
    """

    def __init__(self, status: int, messages: Sequence[str], elements: Sequence[str] = ()) -> None:
        self.status = status
        self.messages = tuple(messages)
        self.elements = tuple(elements)
        self.element: Optional[str] = self.elements[0] if self.elements else None
        self.message: str = c.lib.dalcs_status_text(status).decode()
        self.file: Optional[str] = None
        self.line: Optional[int] = None
        self.column: Optional[int] = None
        self.rows: Any = None  # the library's, for `result`
        self.result: Any = None
        self._take_place()
        super().__init__("\n".join(self.messages) or self.message)

    def _take_place(self) -> None:
        """From the first error among the messages, "file:line:column: error: ..." and the line."""
        for message in self.messages:
            lines = message.split("\n")
            found = _PLACED.match(lines[0])
            if found:
                self.message, self.file = found["text"], found["file"]
                self.line, self.column = int(found["line"]), int(found["column"])
                word = _ELEMENT.match(lines[1]) if len(lines) > 1 else None
                if self.element is None and word:
                    self.element = word[0].lower()
                return
            if lines[0].startswith("error: "):
                self.message = lines[0][len("error: "):]
                return

    def __reduce__(self):  # type: ignore[no-untyped-def]
        return type(self), (self.status, self.messages, self.elements)


class NetlistError(Error):
    """The netlist has errors."""


class OptionError(Error, ValueError):
    """An option, a parameter or an element that there is not, or a value that it cannot have."""


class NoSolution(Error):
    """No solution exists, or none was found that holds; the message names the elements."""


class WrongWaveform(Error):
    """The audit finds a law of the circuit broken in the waveform; the message names it and the time."""


class Cancelled(Error):
    """The run was ended from outside."""


class Crashed(Error):
    """The process that made this run of a sweep died in it.

    exit_status   below 0: of the signal with that number
    """

    def __init__(self, exit_status: int) -> None:
        self.exit_status = exit_status
        told = f"status {exit_status}" if exit_status >= 0 else signal.strsignal(-exit_status)
        why = ", which the system does where memory runs out" if exit_status == -signal.SIGKILL else ""
        super().__init__(c.E_INTERNAL, [f"error: the process of this run ended: {told}{why}"])

    def __reduce__(self):  # type: ignore[no-untyped-def]
        return type(self), (self.exit_status,)


_KINDS = {c.E_NETLIST: NetlistError, c.E_OPTION: OptionError, c.E_CANCELLED: Cancelled,
          c.INFEASIBLE: NoSolution, c.NOT_CONVERGED: NoSolution, c.SINGULAR: NoSolution,
          c.REFUTED: WrongWaveform}


def error_of(status: int, messages: Sequence[str], report: Optional[str] = None) -> Error:
    """The exception for a status of a session with these messages and this report as JSON."""
    elements: Sequence[str] = ()
    if report is not None:
        elements = json.loads(report).get("infeasible", {}).get("elements", ())
    return _KINDS.get(status, Error)(status, messages, elements)
