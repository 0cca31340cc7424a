"""A netlist and what can be computed from it."""

from __future__ import annotations

import json
import math
import re
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence

import ctypes

from . import _library as c
from ._equations import System, systems_of
from ._errors import Error
from ._response import Response
from ._result import Result
from ._session import Exchange, Netlist, Number, Options, Session, Window
from ._simulation import Simulation
from ._sweep import Crew, Grid, Sweep, sweep_of, variants_of


def _asks_of(options: Mapping[str, Any], sensitivities: bool) -> List[Callable[[Any], int]]:
    """Calls that a session needs before it reads a netlist without the matching cards."""
    asks: List[Callable[[Any], int]] = []
    if options.get("steady") or options.get("envelope"):
        asks.append(c.lib.dalcs_session_ask_steady)
    if options.get("bode"):
        asks.append(c.lib.dalcs_session_ask_response)
    if sensitivities:
        asks.append(c.lib.dalcs_session_ask_sensitivities)
    return asks


class Check(Dict[str, Any]):
    """What theory says: a dict (doc/check.schema.json) that shows its summary."""

    def __repr__(self) -> str:
        return f"<check of {self['title']!r}: {' '.join(part['summary'] for part in self['parts'])}>"


class Circuit:
    """A netlist: a path, or its text, which has a newline in it. `dialect`: "ngspice", "ltspice", "xyce"."""

    def __init__(self, netlist: Netlist, dialect: Optional[str] = None) -> None:
        self.netlist = netlist
        self.dialect = dialect

    def _read(self, losses: Window = False, asks: Sequence[Callable[[Any], int]] = (),
              values: Optional[Mapping[str, Number]] = None,
              seed: Optional[int] = None) -> Session:
        session = Session(self.netlist, self.dialect, losses, asks, seed)
        session.set_values(values or {})
        return session

    def run(self, values: Optional[Mapping[str, Number]] = None, *,
            at: Optional[Sequence[float]] = None, losses: Window = False, rows: bool = True,
            seed: Optional[int] = None, sensitivities: bool = False,
            frequencies: Optional[Sequence[float]] = None,
            progress: Optional[Callable[[float, float], Any]] = None,
            exchange: Optional[Exchange] = None, initial: Optional[Mapping[str, Number]] = None,
            **more: Any) -> Result:
        """Runs its .op, .dc, .ac, .pss and .tran.

        values    other values, by name: a parameter of .param, an element ("r1"), "dmod(vfwd)"; a number,
                  or its text as in a netlist: "4.7k"
        at        times of rows in s, ascending, in place of those of .tran
        losses    True: also where the power went; (from, to): in this window, s
        rows      False: events and measurements only
        seed      of random values, in place of the netlist's
        sensitivities, frequencies   of steady() and bode()
        progress  called as progress(time, stop) now and then; what it raises ends the run
        exchange  gives sources with the word EXTERNAL their values: exchange(t, signals, inputs) -> next t.
                  It is called at 0, when `signals` is empty, then at the times (s) that it returns; None:
                  never again. `signals` has all signals by name just before t (V, A); what it writes into
                  the dict `inputs` are the sources' values from t on
        initial   voltages of capacitors (V) and currents of coils (A) by their names, with which .tran starts, as
                  with uic; `report["final"]` of another run goes on where that ended
        more      options as on the command line: tol, method, stages, step (s), fill, curve, compress,
                  audit, energy, record, only (of .step and .mc this run alone, from 1 on), workers
                  (threads of .wcase);
                  any other name is one of `values`

        Raises NetlistError, OptionError, NoSolution, whose `result` has the rows until then. Ctrl-C ends
        the run. A step of .step that fails loses none of the others, which are in that result.
        """
        options: Dict[str, Any] = {"record": True}
        options.update((name, value) for name, value in more.items() if name in c.OPTIONS)
        if not rows and at is None:
            at = ()  # and nothing that is about rows
            options = {name: value for name, value in options.items()
                       if name not in ("fill", "curve", "compress")}
        own = {name: value for name, value in more.items() if name not in c.OPTIONS}
        session = self._read(losses, _asks_of(options, sensitivities), {**(values or {}), **own}, seed)
        session.set_states(initial or {})
        chosen = Options(options, at, frequencies)
        kind = Response if options.get("bode") else Result
        is_alone = bool(options.get("only"))
        try:
            return kind(session, session.run(chosen, progress, rows, exchange), is_alone)
        except Error as error:
            if error.rows:
                error.result = kind(session, error.rows, is_alone)
            raise

    def steady(self, values: Optional[Mapping[str, Number]] = None, *,
               period: Optional[float] = None, **more: Any) -> Result:
        """The periodic steady state: rows of one period, `.steady` says whether it is stable.

        period    s; None: that of .pss, else it follows from the sources
        more      those of run(); sensitivities=True: .sensitivities gives the derivatives of measurements
                  by the values of elements
        """
        if period is not None:
            more["period"] = float(period)
        return self.run(values, steady=True, **more)

    def bode(self, values: Optional[Mapping[str, Number]] = None, *,
             frequencies: Optional[Sequence[float]] = None, start: Optional[float] = None,
             stop: Optional[float] = None, points: Optional[int] = None, loop: Optional[str] = None,
             injection: Optional[str] = None, sideband: Optional[int] = None,
             period: Optional[float] = None, **more: Any) -> Response:
        """The small-signal response around the periodic steady state, of a loop with its margins.

        frequencies  [n] Hz, ascending; None: those of .ac, or
        start, stop  Hz; None: those of .ac, else 1e-4 and 1/2 of the orbit's frequency
        points       in each decade; None: those of .ac, else 20
        loop         the V source in a loop whose gain is computed: all else has no small signal
        injection    "voltage", or "both" where what the loop goes on to takes a current
        sideband     rows are of the components so many of the orbit's frequencies higher
        period       s, of the orbit; None: that of .pss, else it follows from the sources
        more         options and values, as of run()
        """
        asked: Dict[str, Any] = {"bode_from": start, "bode_to": stop, "bode_points": points, "bode_loop": loop,
                                 "bode_injection": injection, "bode_sideband": sideband, "period": period}
        if frequencies is not None and (start, stop, points) != (None, None, None):
            raise TypeError("give frequencies, or start, stop and points, not both")
        given = {name: value for name, value in asked.items() if value is not None}
        found = self.run(values, bode=True, frequencies=frequencies, **given, **more)
        assert isinstance(found, Response)
        return found

    def envelope(self, values: Optional[Mapping[str, Number]] = None, *,
                 stop: Optional[float] = None, **more: Any) -> Result:
        """A slow start, most of whose periods are left out: rows at the beginnings of those that are run.

        stop    s; None: that of .env, else of .tran
        """
        if stop is not None:
            more["envelope_stop"] = float(stop)
        return self.run(values, envelope=True, **more)

    def start(self, values: Optional[Mapping[str, Number]] = None, **options: Any) -> Simulation:
        """A run that goes on step by step, for circuits with EXTERNAL sources; arguments are those of run()."""
        return Simulation(lambda exchange: self.run(values, exchange=exchange, **options))

    def sweep(self, grid: Optional[Grid] = None, *, workers: Optional[int] = None,
              each: Optional[Callable[[Result], Any]] = None,
              done: Optional[Callable[[int, int], Any]] = None, isolate: Optional[bool] = None,
              **options: Any) -> Sweep:
        """Runs of all combinations of values, several at a time.

        grid     {"rload": [5, 10], "c1": [10e-6, 20e-6]}: all combinations, the last name fastest;
                 or a list of dicts, one a run. Lists may also stand by name: sweep(rload=[5, 10])
        workers  how many at a time; None: as many as there are cores. Results do not depend on it
        each     each(result) gives the values to keep: a dict, or one value, which is called "value".
                 None: the measurements, and no rows are made, which is fastest
        done     called as done(how many runs are over, how many there are), in the thread of the caller
        isolate  True: runs are made in processes of their own: one that crashes, or that the system kills
                 where memory runs out, loses none of the others. `each` then sees a copy of the caller's
                 memory, and what it gives is pickled. False: in threads.
                 None: in processes, unless a function is given that may write into the caller's memory
                 (each, progress, exchange)
        options  those of run()

        A run that fails loses none of the others: its row has its message in the column "error".
        Ctrl-C ends all runs; the exception has the table so far in its attribute `sweep`.
        """
        return sweep_of(self.run, grid, Crew(workers, isolate, each, done), options)

    def variants(self, values: Optional[Mapping[str, Number]] = None, *, seed: Optional[int] = None,
                 workers: Optional[int] = None, each: Optional[Callable[[Result], Any]] = None,
                 done: Optional[Callable[[int, int], Any]] = None, isolate: Optional[bool] = None,
                 **options: Any) -> Sweep:
        """The runs of the netlist's .step and .mc, several at a time.

        The table has what is stepped, what random functions gave, and the measurements. Other arguments
        are those of sweep() and run().
        """
        points = self._read(values=values, seed=seed).steps()
        if not points:
            raise ValueError("the netlist has neither .step nor .mc; a .wcase is a part of one run()")
        return variants_of(self.run, points, Crew(workers, isolate, each, done),
                           {**options, "values": values, "seed": seed})

    def check(self, values: Optional[Mapping[str, Number]] = None, *,
              step: float = 0.0) -> Check:
        """What theory says without a run, as `dalcs check --json` (doc/check.schema.json).

        step    s, of the conditions on one step; 0: the netlist's
        """
        session = self._read(values=values)
        return Check(json.loads(session.document(c.lib.dalcs_session_check_json, float(step))))

    def equations(self, values: Optional[Mapping[str, Number]] = None, *,
                  form: str = "dalcs") -> List[System]:
        """The complementarity system of each connected part; form "lcs": z eliminated where it can be."""
        if form not in ("dalcs", "lcs"):
            raise ValueError(f"form is 'dalcs' or 'lcs', not {form!r}")
        session = self._read(values=values)
        return systems_of(session.document(c.lib.dalcs_session_equations_json, c.FORMS[form], 0.0))

    @property
    def parameters(self) -> Dict[str, float]:
        """The parameters of .param outside of subcircuits, with their values."""
        session, found = self._read(), {}
        value = ctypes.c_double(math.nan)
        for name in session.names(c.lib.dalcs_session_parameter_name):
            if c.lib.dalcs_session_parameter(session.handle, name.encode(),
                                             ctypes.byref(value)) == c.OK:
                found[name] = value.value
        return found

    @property
    def elements(self) -> List[str]:
        """The names of the elements, those in subcircuits as "x1.r1"; without parts of them, "rser(l1)"."""
        names = self._read().names(c.lib.dalcs_session_element_name)
        return [name for name in names if re.search(r"(^|[^-])\(", name) is None]

    def __repr__(self) -> str:
        text = str(self.netlist)
        return f"Circuit({text.splitlines()[0] if text else ''!r})"
