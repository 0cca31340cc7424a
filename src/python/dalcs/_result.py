"""What a run gave: rows as NumPy arrays, events, measurements, the report."""

from __future__ import annotations

import functools
import json
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _library as c
from ._html import table_of
from ._names import Measures, no_such
from ._sensitivities import Sensitivities
from ._session import Session, Tables


class _Memory:
    """C's memory as NumPy takes it; keeps its owner."""

    def __init__(self, owner: Tables, address: int, shape: Tuple[int, ...], kind: str) -> None:
        self.owner = owner
        self.__array_interface__ = {"version": 3, "data": (address, False), "shape": shape,
                                    "typestr": kind}


def _array(owner: Tables, address: Optional[int], shape: Tuple[int, ...], kind: str) -> NDArray[Any]:
    if not address or 0 in shape:
        return np.empty(shape, dtype=kind)
    return np.asarray(_Memory(owner, address, shape, kind))


def _texts(pointer: Any, count: int) -> Tuple[str, ...]:
    return tuple(pointer[k].decode("utf-8", "replace") for k in range(count))


def _scale_label(scale: str) -> str:
    return {"time": "time (s)", "frequency": "frequency (Hz)"}.get(scale, scale)


class Table:
    """The rows of one analysis, n of them, m signals.

    analysis    "op", "tran", "dc", "ac" or "pss"
    t           [n] the scale: times in s, or what `scale` says
    scale       "time", "frequency" (Hz), or the source that .dc sweeps
    names       m names in the order of the columns, "v(out)", "i(d1)"
    units       unit of each name: "V", "A", "" ...
    values      [n, m] V and A; complex after .ac
    parameters  what .step set, by name

    table["v(out)"] is one column, [n]. Times ascend; two rows of the same time are the two sides of a
    discontinuity. Arrays are views of the memory of the run, not copies.
    """

    def __init__(self, owner: Optional[Tables], row_table: Any) -> None:
        if owner is None or row_table is None:
            self.analysis, self.title, self.scale = "", "", "time"
            self.names: Tuple[str, ...] = ()
            self.units: Dict[str, str] = {}
            self.parameters: Dict[str, float] = {}
            self.t, self.values = np.empty(0), np.empty((0, 0))
            return
        plot, n_rows = row_table.plot, row_table.n_rows
        self.analysis = c.ANALYSES[plot.analysis]
        self.title = plot.title.decode("utf-8", "replace")
        self.scale = plot.scale.decode("utf-8", "replace")
        self.names = _texts(plot.name, plot.n_signals)
        self.units = {name: c.UNITS[plot.unit[k]] for k, name in enumerate(self.names)}
        self.parameters = dict(zip(_texts(plot.parameter, plot.n_parameters),
                                   plot.parameter_value[:plot.n_parameters]))
        self.t = _array(owner, row_table.scale, (n_rows,), "<f8")
        self.values = _array(owner, row_table.value, (n_rows, plot.n_signals),
                             "<c16" if plot.is_complex else "<f8")

    def keys(self) -> Tuple[str, ...]:
        """The names of the signals."""
        return self.names

    def __len__(self) -> int:
        return len(self.t)

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name.lower() in self._column

    @functools.cached_property
    def _column(self) -> Dict[str, int]:
        return {name.lower(): k for k, name in enumerate(self.names)}

    def __getitem__(self, name: str) -> NDArray[Any]:
        """One signal, [n]; the name in any case, and the scale by its own."""
        column = self._column.get(name.lower())
        if column is not None:
            return self.values[:, column]
        if name.lower() == self.scale:
            return self.t
        raise no_such("signal", name, self.names)

    def to_pandas(self) -> Any:
        """A pandas.DataFrame, one column a signal; its index is the scale."""
        import pandas  # pylint: disable=import-outside-toplevel
        index = pandas.Index(self.t, name=self.scale)
        return pandas.DataFrame(np.array(self.values), index=index, columns=list(self.names))

    def to_xarray(self) -> Any:
        """An xarray.Dataset, one variable a signal with its unit in attrs; its coordinate is the scale.

        What .step set is in the attrs of the Dataset. Two sides of a discontinuity have the same time.
        """
        import xarray  # pylint: disable=import-outside-toplevel,import-error
        signals = {name: (self.scale, np.array(self.values[:, k]), {"units": self.units[name]})
                   for k, name in enumerate(self.names)}
        told: Dict[str, Any] = {"title": self.title}
        told.update(self.parameters)
        return xarray.Dataset(signals, {self.scale: np.array(self.t)}, told)

    def plot(self, *names: str, ax: Any = None) -> Any:
        """Draws signals, all without names, with matplotlib; returns the axes."""
        import matplotlib.pyplot as plt  # pylint: disable=import-outside-toplevel
        axes = plt.subplots()[1] if ax is None else ax
        chosen = names or self.names
        for name in chosen:
            value = self[name]
            axes.plot(self.t, abs(value) if np.iscomplexobj(value) else value, label=name)
        units = sorted({self.units.get(name.lower(), "") for name in chosen} - {""})
        axes.set_xlabel(_scale_label(self.scale))
        axes.set_ylabel(", ".join(units))
        axes.legend()
        return axes

    def decibels(self, name: str) -> NDArray[Any]:
        """20 log10 of the magnitude of a signal, [n] dB; 0 is -inf."""
        with np.errstate(divide="ignore"):
            return np.asarray(20.0 * np.log10(np.abs(self[name])))

    def phase(self, name: str) -> NDArray[Any]:
        """The phase of a complex signal, [n] degrees, from -180 to 180 at first, and from there on without leaps."""
        return np.asarray(np.degrees(np.unwrap(np.angle(self[name]))))

    def plot_bode(self, *names: str, axes: Any = None) -> Any:
        """Draws complex signals, all without names, in dB and degrees over a logarithmic frequency.

        axes    two of matplotlib, for magnitudes and phases; None: new ones. Returns them
        """
        import matplotlib.pyplot as plt  # pylint: disable=import-outside-toplevel
        above, below = plt.subplots(2, sharex=True)[1] if axes is None else axes
        if not np.iscomplexobj(self.values):
            raise ValueError(f"the rows of {self.analysis or 'no analysis'} are real: plot() draws them")
        for name in names or self.names:
            above.semilogx(self.t, self.decibels(name), label=name)
            below.semilogx(self.t, self.phase(name), label=name)
        above.set_ylabel("dB")
        below.set_ylabel("deg")
        below.set_xlabel(_scale_label(self.scale))
        above.legend()
        return np.array([above, below], dtype=object)

    def __repr__(self) -> str:
        return f"<{self.analysis or 'no'} rows: {len(self)} of {', '.join(self.names)}>"

    def _repr_html_(self) -> str:
        """In Jupyter: the range of each signal, of complex ones that of the magnitude.

        What is less than 1e-9 of a signal's largest value is 0, as in the table on the terminal.
        """
        rows = []
        for k, name in enumerate(self.names if len(self) > 0 else ()):
            column = self.values[:, k]
            size = np.abs(column) if np.iscomplexobj(column) else column
            three = np.array([size.min(), size.max(), size[-1]])
            three[np.abs(three) < 1e-9 * np.abs(size).max()] = 0.0
            rows.append((name, self.units[name], *three.tolist()))
        return table_of(f"{self.analysis or 'no'} rows: {len(self)}", ("signal", "unit", "min", "max", "final"), rows)


class Result(Table):
    """A run. Itself it is the table of the last analysis, of .step the last step.

    tables    all tables, in the order in which they were made
    report    dict, as `dalcs run --report` writes it (doc/report.schema.json)
    """

    def __init__(self, session: Session, tables: Optional[Tables], is_alone: bool = False) -> None:
        found = [] if tables is None else list(tables)
        super().__init__(tables, found[-1] if found else None)
        self._others = [(tables, item) for item in found[:-1]]
        self._session = session  # which keeps what is asked for later
        self._is_alone = is_alone  # one step of several

    @functools.cached_property
    def messages(self) -> Tuple[str, ...]:
        """Notes and warnings, each with its place."""
        return tuple(self._session.messages())

    @functools.cached_property
    def tables(self) -> List[Table]:
        """All tables, this one last."""
        return [Table(owner, item) for owner, item in self._others] + [self]

    def overlay(self, name: str, by: Optional[str] = None, ax: Any = None) -> Any:
        """Draws a signal of all steps of .step or .mc over each other with matplotlib; returns the axes.

        by    the parameter that colours them; None: the first one. A bar beside the axes has its values
        """
        import matplotlib as mpl  # pylint: disable=import-outside-toplevel
        import matplotlib.pyplot as plt  # pylint: disable=import-outside-toplevel
        runs = [table for table in self.tables if table.analysis == self.analysis]
        by = next(iter(self.parameters), "") if by is None else by
        if by not in self.parameters:
            raise no_such("parameter", by, self.parameters)
        axes = plt.subplots()[1] if ax is None else ax
        values = [table.parameters[by] for table in runs]
        widest = max(max(values) - min(values), 1e-300)
        logarithmic = min(values) > 0.0 and max(values) > 30.0 * min(values)
        scale = (mpl.colors.LogNorm if logarithmic else mpl.colors.Normalize)(min(values), min(values) + widest)
        colours = mpl.cm.ScalarMappable(scale, "viridis")
        for table, value in zip(runs, values):
            found = table[name]
            axes.plot(table.t, np.abs(found) if np.iscomplexobj(found) else found,
                      color=colours.to_rgba(value), linewidth=1.0)
        axes.set_xlabel(_scale_label(self.scale))
        axes.set_ylabel(f"{name} ({self.units[name.lower()]})")
        axes.figure.colorbar(colours, ax=axes, label=by)
        return axes

    @functools.cached_property
    def report(self) -> Dict[str, Any]:
        """What the run did: work, certificate, audit, states, energies. SI units."""
        return dict(json.loads(self._session.report()))

    @functools.cached_property
    def events(self) -> NDArray[Any]:
        """Diodes and switches that changed sides: fields time (s), element, on. [n_events]"""
        rows = [(e["time"], e["element"], e["state"] == "on") for e in self.report["events"]]
        width = max((len(row[1]) for row in rows), default=1)
        return np.array(rows, dtype=[("time", "f8"), ("element", f"U{width}"), ("on", "?")])

    @property
    def jumps(self) -> List[Dict[str, Any]]:
        """States that changed at once: time (s), states (V, A), impulses (C, Wb), energy_lost (J)."""
        return list(self.report["jumps"])

    @property
    def losses(self) -> Optional[Dict[str, Any]]:
        """Where the power went (W, J), if the run computed it: run(..., losses=True) or .losses."""
        found = self.report.get("losses")
        return found[-1] if found else None

    @functools.cached_property
    def measures(self) -> Dict[str, Any]:
        """What each .meas gave, by its name in any case; NaN where it found nothing; of .step an array with one for each step."""
        found: Dict[str, List[float]] = {}
        entries = self._session.measurements()
        for name, _, value in entries:
            found.setdefault(name, []).append(value)
        if any(is_step for _, is_step, _ in entries) and not self._is_alone:
            return Measures((name, np.array(values)) for name, values in found.items())
        return Measures((name, values[-1]) for name, values in found.items())

    @functools.cached_property
    def drawn(self) -> Dict[str, float]:
        """What random values of the netlist were in this run (of .step and .mc: the last), by parameter or element."""
        return self._session.drawn()

    @property
    def steady(self) -> Optional[Dict[str, Any]]:
        """Of a steady state: period (s), multipliers, averages and rms values of the signals."""
        return self.report.get("steady")

    @functools.cached_property
    def sensitivities(self) -> Optional[Sensitivities]:
        """Of a steady state: how its measurements follow from values, run(..., sensitivities=True) or .sens."""
        found = self.report.get("sensitivity")
        return None if found is None else Sensitivities(found)
