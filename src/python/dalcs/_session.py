"""One netlist read and run once by libdalcs: handles, options, Ctrl-C."""

from __future__ import annotations

import ctypes
import difflib
import math
import os
import signal
import threading
from typing import Any, Callable, Dict, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _library as c
from ._errors import OptionError, error_of
from ._names import no_such

Netlist = Union[str, "os.PathLike[str]"]
Window = Union[bool, Tuple[float, float]]
Number = Union[float, str]  # a str as in netlists: "4.7k"
Exchange = Callable[[float, Mapping[str, float], Dict[str, float]], Optional[float]]
OWN_OPTIONS = frozenset(("at", "exchange", "frequencies", "initial", "losses", "progress", "rows", "seed", "sensitivities",
                         "values"))  # of Circuit.run


def number_of(value: Number, name: str = "value") -> float:
    """A number, or the one that a text such as "2.2u" is in a netlist; `name` is what gets it."""
    if np.ndim(value) > 0:
        raise TypeError(f"{name}={value!r}: a run takes one value; sweep() takes lists of them")
    if not isinstance(value, str):
        try:
            return float(value)
        except TypeError:
            raise TypeError(f"{name}={value!r} is no number") from None
    number = ctypes.c_double(math.nan)
    if c.lib.dalcs_parse_number(value.encode(), ctypes.byref(number)) != c.OK:
        raise ValueError(f"{value!r} is no number of a netlist, such as 4.7k or 2.2u")
    return number.value


def _options_like(name: str) -> list[str]:
    """Names of options that are similar to this one."""
    known = sorted(c.OPTIONS | OWN_OPTIONS)
    return ([option for option in known if option.startswith(name) or name.startswith(option)]
            or difflib.get_close_matches(name, known, 1))


@c.Progress
def _pulse(_user, _time, _stop):  # type: ignore[no-untyped-def]
    """Lets Python run now and then, and with it the handlers of signals."""
    return c.OK


class Tables:
    """The rows of a run in C's memory, freed with the last array that looks at them."""

    def __init__(self, handle: ctypes.c_void_p) -> None:
        self.handle = handle

    def __del__(self) -> None:
        c.lib.dalcs_tables_destroy(self.handle)

    def __len__(self) -> int:
        return int(c.lib.dalcs_tables_count(self.handle))

    def __iter__(self):  # type: ignore[no-untyped-def]
        for index in range(len(self)):
            yield c.lib.dalcs_tables_get(self.handle, index).contents


class Session:
    """A netlist, read; raises what is wrong with it."""

    def __init__(self, netlist: Netlist, dialect: Optional[str] = None, losses: Window = False,
                 asks: Sequence[Callable[[Any], int]] = (), seed: Optional[int] = None) -> None:
        self.handle = ctypes.c_void_p()
        self._check(c.lib.dalcs_session_create(ctypes.byref(self.handle)))
        self._check(c.lib.dalcs_session_keep_netlist(self.handle))
        if dialect is not None:
            self._check(c.lib.dalcs_session_set_dialect(self.handle, dialect.encode()))
        if seed is not None:
            self._check(c.lib.dalcs_session_set_seed(self.handle, float(seed)))
        for ask in asks:  # what need not be in the netlist
            self._check(ask(self.handle))
        if losses is not False:
            begin, end = (math.nan, math.nan) if losses is True else losses
            self._check(c.lib.dalcs_session_ask_losses(self.handle, begin, end))
        if isinstance(netlist, str) and "\n" in netlist:
            text = netlist.encode()
            self._check(c.lib.dalcs_session_read_text(self.handle, b"netlist", text, len(text)))
        else:
            self._check(c.lib.dalcs_session_read_file(self.handle, os.fsencode(netlist)))

    def __del__(self) -> None:
        c.lib.dalcs_session_destroy(self.handle)

    def __reduce__(self) -> Any:
        raise TypeError("a result is memory of libdalcs, which cannot be copied or sent to another process: "
                        "send its arrays, its report, or to_pandas()")

    def _check(self, status: int) -> None:
        if status != c.OK:
            raise error_of(status, self.messages())

    def messages(self) -> list[str]:
        """All so far, oldest first, each with its level, as the program prints them."""
        count = c.lib.dalcs_session_n_messages(self.handle)
        return [c.lib.dalcs_session_message(self.handle, index, None).decode("utf-8", "replace")
                for index in range(count)]

    def names(self, call: Callable[[Any, int], Optional[bytes]]) -> list[str]:
        """All names that a call gives by index."""
        found: list[str] = []
        while (name := call(self.handle, len(found))) is not None:
            found.append(name.decode("utf-8", "replace"))
        return found

    def set_values(self, values: Mapping[str, Number]) -> None:
        for name, value in values.items():
            try:
                self._check(c.lib.dalcs_session_set_value(self.handle, name.encode(), number_of(value, name)))
            except OptionError as error:
                meant = _options_like(name)
                if "hint: " in str(error) or not meant:
                    raise
                hint = f"\n  hint: did you mean the option {meant[0]!r}?"
                raise OptionError(error.status, [*error.messages[:-1], error.messages[-1] + hint]) from None

    def set_states(self, states: Mapping[str, Number]) -> None:
        for name, value in states.items():
            self._check(c.lib.dalcs_session_set_state(self.handle, name.encode(), number_of(value, name)))

    def _values(self, call: Callable[..., Optional[bytes]], *arguments: int) -> dict[str, float]:
        """All names and values that a call gives by index."""
        found: dict[str, float] = {}
        value, index = ctypes.c_double(math.nan), 0
        while (name := call(self.handle, *arguments, index, ctypes.byref(value))) is not None:
            found[name.decode("utf-8", "replace")] = value.value
            index += 1
        return found

    def drawn(self) -> dict[str, float]:
        """What random functions gave in the circuit that was read or run last."""
        return self._values(c.lib.dalcs_session_drawn)

    def steps(self) -> list[dict[str, float]]:
        """What .step and .mc set in each step; none: an empty list."""
        self._check(c.lib.dalcs_session_apply_values(self.handle))
        found: list[dict[str, float]] = []
        while step := self._values(c.lib.dalcs_session_step_parameter, len(found)):
            found.append(step)
        return found

    def cancel(self) -> None:
        """May be called in any thread, and in a handler of a signal."""
        c.lib.dalcs_session_cancel(self.handle)

    def document(self, call: Callable[..., int], *arguments: Any) -> str:
        """The JSON that a call writes."""
        text = ctypes.c_char_p()
        self._check(call(self.handle, *arguments, ctypes.byref(text)))
        return (text.value or b"").decode()

    def run(self, options: "Options", progress: Optional[Callable[[float, float], Any]],
            keeps_rows: bool, exchange: Optional[Exchange] = None) -> Optional[Tables]:
        """The rows, if they are kept."""
        failure: list[BaseException] = []
        coupled = None if exchange is None else _exchanging(exchange, failure)
        if coupled is not None:
            self._check(c.lib.dalcs_session_couple(self.handle, coupled, None))
        tell = _pulse if progress is None else _told(progress, failure)
        handle = ctypes.c_void_p()

        def call() -> int:
            if not keeps_rows and progress is None:
                return int(c.lib.dalcs_session_run(self.handle, options.handle, _SILENT))
            return int(c.lib.dalcs_session_run_tables(self.handle, options.handle, tell, None,
                                                      ctypes.byref(handle)))

        status = _interruptibly(self, call)
        tables = Tables(handle) if handle else None
        if failure:
            raise failure[0]
        if status != c.OK:
            error = error_of(status, self.messages(), self.report() if status > 0 else None)
            error.rows = tables
            raise error
        return tables

    def report(self) -> str:
        """JSON by doc/report.schema.json."""
        return self.document(c.lib.dalcs_session_report_json)

    def measurements(self) -> list[Tuple[str, bool, float]]:
        """Name, whether it is one of .step, and the value of each; NaN where nothing was found."""
        found: list[Tuple[str, bool, float]] = []
        while entry := c.lib.dalcs_session_measurement(self.handle, len(found)):
            m = entry.contents
            found.append((m.name.decode("utf-8", "replace"), m.step is not None,
                          m.value if m.found else math.nan))
        return found


_SINK = c.Sink(progress=ctypes.cast(_pulse, ctypes.c_void_p))
_SILENT = ctypes.addressof(_SINK)


def _told(progress: Callable[[float, float], Any], failure: list[BaseException]) -> Any:
    @c.Progress
    def tell(_user, time, stop):  # type: ignore[no-untyped-def]
        try:
            progress(time, stop)
        except BaseException as error:  # pylint: disable=broad-except
            failure.append(error)
            return c.E_CANCELLED
        return c.OK
    return tell


def _exchanging(exchange: Exchange, failure: list[BaseException]) -> Any:
    names: list[str] = []
    inputs: list[str] = []

    @c.Exchanging
    def call(_user, pointer):  # type: ignore[no-untyped-def]
        e = pointer.contents
        try:
            if not e.value:
                names[:] = [e.name[k].decode("utf-8", "replace") for k in range(e.n_signals)]
                inputs[:] = [e.input[k].decode("utf-8", "replace") for k in range(e.n_inputs)]
            read = dict(zip(names, e.value[:e.n_signals])) if e.value else {}
            given = dict(zip(inputs, e.given[:e.n_inputs]))
            again = exchange(e.time, read, given)
            unknown = given.keys() - set(inputs)
            if unknown:
                raise no_such("external source", min(unknown), inputs)
            for k, name in enumerate(inputs):
                e.given[k] = given[name]
            e.next = math.inf if again is None else again
        except BaseException as error:  # pylint: disable=broad-except
            failure.append(error)
            return c.E_CANCELLED
        return c.OK
    return call


def _interruptibly(session: Session, call: Callable[[], int]) -> int:
    """Ctrl-C while C runs: the run ends, then comes what Ctrl-C would have done.

    A handler that raised inside a callback of ctypes would be printed and forgotten.
    """
    if threading.current_thread() is not threading.main_thread():
        return call()
    caught: list[Tuple[int, Any]] = []

    def on_signal(number: int, frame: Any) -> None:
        caught.append((number, frame))
        session.cancel()

    usual = signal.signal(signal.SIGINT, on_signal)
    try:
        status = call()
    finally:
        signal.signal(signal.SIGINT, usual)
    if caught and callable(usual):
        usual(*caught[0])
    return status


CHOICES = {"method": ("auto", "radau", "lobatto", "euler"), "stages": ("1", "3", "5", "7", "9"),
           "curve": ("cubics", "lines"), "audit": ("sample", "full", "off")}


class Options:
    """Options of a run by their names; `at` are times in s, `frequencies` those of bode, both ascending."""

    def __init__(self, given: Mapping[str, Any], at: Optional[Sequence[float]] = None,
                 frequencies: Optional[Sequence[float]] = None) -> None:
        self.handle = ctypes.c_void_p()
        self._texts: list[bytes] = []  # the options look at the name of a loop until the run is over
        if c.lib.dalcs_run_options_create(ctypes.byref(self.handle)) != c.OK:
            raise MemoryError
        for name, value in given.items():
            text = ("yes" if value else "no") if isinstance(value, bool) else str(value)
            if isinstance(value, (float, np.floating)):
                text = repr(float(value))
            self._texts.append(text.encode())
            if c.lib.dalcs_run_options_set(self.handle, name.encode(), self._texts[-1]) != c.OK:
                hint = f"\n  hint: its values are {', '.join(CHOICES[name])}" if name in CHOICES else ""
                raise OptionError(c.E_OPTION, [f"error: {text!r} is no value of the option {name}{hint}"])
        if at is not None:
            self.times = np.ascontiguousarray(at, dtype=float)
            address = self.times.ctypes.data if self.times.size else None
            c.lib.dalcs_run_options_set_times(self.handle, address, self.times.size)
        if frequencies is not None:
            self.frequencies = np.ascontiguousarray(frequencies, dtype=float)
            if self.frequencies.ndim != 1 or self.frequencies.size == 0:
                raise ValueError("frequencies are a list of at least one, in Hz")
            c.lib.dalcs_run_options_set_frequencies(self.handle, self.frequencies.ctypes.data,
                                                    self.frequencies.size)

    def __del__(self) -> None:
        c.lib.dalcs_run_options_destroy(self.handle)
