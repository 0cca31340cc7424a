"""Circuits with ideal diodes and switches, run by libdalcs.

>>> import dalcs
>>> result = dalcs.run('''Half-wave rectifier
... V1 in 0 SIN(0 10 50)
... D1 in out
... C1 out 0 20u
... R1 out 0 {rload}
... .param rload=1k
... .tran 20u 40m uic
... .meas tran vavg avg v(out)
... ''', rload=2000)
>>> result.t.shape == result["v(out)"].shape
True
>>> print(f"{result['v(out)'].max():.6f} V, {result.measures['vavg']:.4f} V on average")
10.000000 V, 8.0519 V on average
>>> for event in result.events[:2]:
...     print(f"{event['time'] * 1e3:.9f} ms {event['element']} {'on' if event['on'] else 'off'}")
5.252770295 ms d1 off
22.259049507 ms d1 on

Arrays of rows are views of the run's memory. All units are SI.
"""

from __future__ import annotations

import inspect
from typing import Any, Callable, List, Mapping, Optional

from . import _library
from ._circuit import Check, Circuit
from ._equations import System
from ._errors import Cancelled, Crashed, Error, NetlistError, NoSolution, OptionError, WrongWaveform
from ._response import Response
from ._result import Result, Table
from ._sensitivities import Sensitivities
from ._session import Netlist, Number
from ._simulation import Simulation
from ._sweep import Grid, Sweep

__version__: str = _library.lib.dalcs_version().decode()
__all__ = ["Cancelled", "Check", "Circuit", "Crashed", "Error", "NetlistError", "NoSolution", "OptionError", "Response",
           "Result", "Sensitivities", "Simulation", "Sweep", "System", "Table", "WrongWaveform", "bode", "check",
           "envelope", "equations", "run", "steady", "sweep", "variants"]


def run(netlist: Netlist, values: Optional[Mapping[str, Number]] = None, *,
        dialect: Optional[str] = None, **more: Any) -> Result:
    """Circuit(netlist, dialect).run(values, **more)"""
    return Circuit(netlist, dialect).run(values, **more)


def steady(netlist: Netlist, values: Optional[Mapping[str, Number]] = None, *,
           dialect: Optional[str] = None, **more: Any) -> Result:
    """Circuit(netlist, dialect).steady(values, **more)"""
    return Circuit(netlist, dialect).steady(values, **more)


def bode(netlist: Netlist, values: Optional[Mapping[str, Number]] = None, *,
         dialect: Optional[str] = None, **more: Any) -> Response:
    """Circuit(netlist, dialect).bode(values, **more)"""
    return Circuit(netlist, dialect).bode(values, **more)


def envelope(netlist: Netlist, values: Optional[Mapping[str, Number]] = None, *,
             dialect: Optional[str] = None, **more: Any) -> Result:
    """Circuit(netlist, dialect).envelope(values, **more)"""
    return Circuit(netlist, dialect).envelope(values, **more)


def sweep(netlist: Netlist, grid: Optional[Grid] = None, *, workers: Optional[int] = None,
          each: Optional[Callable[[Result], Any]] = None,
          done: Optional[Callable[[int, int], Any]] = None, isolate: Optional[bool] = None,
          dialect: Optional[str] = None, **options: Any) -> Sweep:
    """Circuit(netlist, dialect).sweep(grid, workers=workers, each=each, done=done, isolate=isolate, **options)"""
    return Circuit(netlist, dialect).sweep(grid, workers=workers, each=each, done=done, isolate=isolate, **options)


def variants(netlist: Netlist, values: Optional[Mapping[str, Number]] = None, *,
             dialect: Optional[str] = None, **more: Any) -> Sweep:
    """Circuit(netlist, dialect).variants(values, **more)"""
    return Circuit(netlist, dialect).variants(values, **more)


def check(netlist: Netlist, values: Optional[Mapping[str, Number]] = None, *, step: float = 0.0,
          dialect: Optional[str] = None) -> Check:
    """Circuit(netlist, dialect).check(values, step=step)"""
    return Circuit(netlist, dialect).check(values, step=step)


def equations(netlist: Netlist, values: Optional[Mapping[str, Number]] = None, *,
              form: str = "dalcs", dialect: Optional[str] = None) -> List[System]:
    """Circuit(netlist, dialect).equations(values, form=form)"""
    return Circuit(netlist, dialect).equations(values, form=form)


def _describe() -> None:
    """help(dalcs.run) says what run() takes: as the method of Circuit does."""
    for function in (run, steady, bode, envelope, sweep, variants, check, equations):
        method = getattr(Circuit, function.__name__)
        function.__doc__ = f"{function.__doc__}\n\n{inspect.cleandoc(method.__doc__ or '')}"


_describe()
