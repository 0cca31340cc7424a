"""Many runs of one netlist, and the table of them."""

from __future__ import annotations

import itertools
import os
from typing import Any, Callable, Dict, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Type, Union

import numpy as np
from numpy.typing import NDArray

from . import _library as c
from ._errors import Cancelled, Error, OptionError
from ._html import table_of
from ._names import find
from ._result import Result
from ._session import OWN_OPTIONS, Number, number_of
from ._workers import Processes, Threads

MOST_SHOWN = 20  # runs, in Jupyter

Grid = Union[Mapping[str, Sequence[Number]], Sequence[Mapping[str, Number]]]


def _points_of(grid: Grid) -> List[Dict[str, float]]:
    if isinstance(grid, Mapping):
        names = list(grid)
        points = [dict(zip(names, values)) for values in itertools.product(*grid.values())]
    else:
        points = [dict(point) for point in grid]
    return [{name: number_of(value, name) for name, value in point.items()} for point in points]


def _grid_of(grid: Optional[Grid], options: Dict[str, Any]) -> Grid:
    """The grid with what stands among the options as a list: sweep(netlist, rload=[5, 10])."""
    own = {name: value for name, value in options.items()
           if name not in c.OPTIONS | OWN_OPTIONS and np.ndim(value) > 0}
    for name in own:
        del options[name]
    if grid is not None and not isinstance(grid, Mapping):
        if own:
            raise TypeError("a list of points holds all values: " + ", ".join(own) + " cannot stand beside it")
        return grid
    whole = {**(grid or {}), **own}
    if grid is None and not own:
        raise TypeError('sweep() needs values: sweep(netlist, {"r1": [1e3, 2e3]}) or sweep(netlist, r1=[1e3, 2e3])')
    return whole


class Sweep:
    """A table with one row a run: parameters, what was kept, and "error", which is "" where all is well.

    points    the values of each run
    errors    the exceptions, by the number of their run
    sweep["rload"], sweep["vavg"]   columns, [n]; NaN where a run failed
    """

    def __init__(self, points: Sequence[Mapping[str, float]], kept: Sequence[Any]) -> None:
        self.points = list(points)
        self.errors = {k: value for k, value in enumerate(kept) if isinstance(value, Exception)}
        given = [value if isinstance(value, Mapping) else {} for value in kept]
        self.columns: Dict[str, NDArray[Any]] = {}
        for rows in (self.points, given):
            for name in dict.fromkeys(name for row in rows for name in row):
                self.columns[name] = _column_of([row.get(name, np.nan) for row in rows])
        self._keeps_nothing = len(self.errors) < len(self.points) and not any(given)
        self.columns["error"] = np.array([_message_of(self.errors.get(k))
                                          for k in range(len(self.points))], dtype=object)

    def __len__(self) -> int:
        return len(self.points)

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __getitem__(self, name: str) -> NDArray[Any]:
        column: NDArray[Any] = self.columns[name] if name in self.columns else find("column", name, self.columns)
        return column

    def to_pandas(self) -> Any:
        """A pandas.DataFrame, one row a run."""
        import pandas  # pylint: disable=import-outside-toplevel
        return pandas.DataFrame(self.columns)

    def _parameters(self) -> List[str]:
        return list(dict.fromkeys(name for point in self.points for name in point))

    def _causes(self) -> List[str]:
        """Parameters, but for the number of the run."""
        return [name for name in self._parameters() if name != "run"]

    def hist(self, name: str, bins: int = 30, ax: Any = None) -> Any:
        """Draws a histogram of a column with matplotlib, what failed left out; returns the axes."""
        import matplotlib.pyplot as plt  # pylint: disable=import-outside-toplevel
        axes = plt.subplots()[1] if ax is None else ax
        value = np.asarray(self[name], dtype=float)
        axes.hist(value[np.isfinite(value)], bins=bins)
        axes.set_xlabel(name)
        axes.set_ylabel("runs")
        return axes

    def effects(self, name: str) -> Dict[str, float]:
        """How far a column moves with each parameter from end to end of its values, the largest first.

        The slope of the least-squares plane through all runs that are well, times the range of the
        parameter: of runs in which everything varies at once, and of grids.
        """
        well = [k for k in range(len(self)) if k not in self.errors and np.isfinite(self[name][k])]
        varying = [p for p in self._causes() if np.ptp(np.asarray(self[p], dtype=float)[well]) > 0.0]
        if len(well) <= len(varying):
            raise ValueError(f"{len(well)} runs with {name!r} are too few for {len(varying)} parameters")
        columns = [np.asarray(self[p], dtype=float)[well] for p in varying]
        scaled = [(column - column.mean()) / np.ptp(column) for column in columns]
        plane = np.column_stack([np.ones(len(well)), *scaled])
        slopes = np.linalg.lstsq(plane, np.asarray(self[name], dtype=float)[well], rcond=None)[0][1:]
        return dict(sorted(((p, float(slope)) for p, slope in zip(varying, slopes)),
                           key=lambda item: -abs(item[1])))

    def tornado(self, name: str, ax: Any = None) -> Any:
        """Draws effects() as bars with matplotlib, the largest on top; returns the axes."""
        import matplotlib.pyplot as plt  # pylint: disable=import-outside-toplevel
        axes = plt.subplots()[1] if ax is None else ax
        effects = self.effects(name)
        axes.barh(list(effects)[::-1], list(effects.values())[::-1])
        axes.axvline(0.0, color="black", linewidth=0.8)
        axes.set_xlabel(f"change of {name} over the range of the parameter")
        return axes

    def to_xarray(self) -> Any:
        """An xarray.Dataset: over the grid, if all combinations were run, else over the number of the run."""
        import xarray  # pylint: disable=import-outside-toplevel,import-error
        names = self._parameters()
        frame = self.to_pandas()
        if names and len(frame.drop_duplicates(names)) == len(frame) == int(
                np.prod([frame[name].nunique() for name in names])):
            return frame.set_index(names).to_xarray()
        frame.index.name = "run"
        return xarray.Dataset.from_dataframe(frame)

    def _repr_html_(self) -> str:
        """In Jupyter: the runs, of many the first."""
        shown = range(min(len(self), MOST_SHOWN))
        return table_of(repr(self), list(self), [[self[name][k] for name in self] for k in shown])

    def __repr__(self) -> str:
        nothing = "; nothing was kept: write .meas into the netlist, or give each=" if self._keeps_nothing else ""
        return f"<sweep of {len(self)} runs, {len(self.errors)} failed: {', '.join(self.columns)}{nothing}>"


def _message_of(error: Optional[Exception]) -> str:
    if isinstance(error, Error):
        return error.message
    return "" if error is None else f"{type(error).__name__}: {error}"


def _column_of(values: List[Any]) -> NDArray[Any]:
    if all(isinstance(value, (int, float, np.number)) for value in values):
        return np.array(values)
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column


class Crew(NamedTuple):
    """Who makes the runs of a sweep, and what is kept of each."""

    workers: Optional[int]
    isolate: Optional[bool]
    each: Optional[Callable[[Result], Any]]
    done: Optional[Callable[[int, int], Any]]

    def workers_of(self, options: Mapping[str, Any]) -> "Type[Threads] | Type[Processes]":
        """Functions of the caller may write into its memory, which threads share."""
        calls = self.each is not None or any(options.get(name) is not None for name in ("progress", "exchange"))
        alone = self.isolate if self.isolate is not None else hasattr(os, "fork") and not calls
        return Processes if alone else Threads


def _table_of(run: Callable[..., Result], points: List[Dict[str, float]], crew: Crew,
              options: Mapping[str, Any], takes_drawn: bool) -> Sweep:
    """run(k, ...) is point k, to which what was drawn in it may belong."""
    asked = dict(options)
    kind = crew.workers_of(asked)
    if crew.each is None:
        asked = {"rows": False, "record": False, **asked}
    told = asked.pop("progress", None)

    def progress(time: float, stop: float) -> None:
        if all_of_them.is_stopped():
            raise Cancelled(c.E_CANCELLED, ())
        if told is not None:
            told(time, stop)

    def task(index: int) -> Any:
        result = run(index, progress=progress, **asked)
        kept = result.measures if crew.each is None else crew.each(result)
        point = {**points[index], **(result.drawn if takes_drawn else {})}
        return point, dict(kept) if isinstance(kept, Mapping) else {"value": kept}

    all_of_them = kind(task, len(points), crew.done)
    workers = len(os.sched_getaffinity(0)) if crew.workers is None else crew.workers
    try:
        all_of_them.run(min(workers, len(points)))
    except BaseException as end:
        setattr(end, "sweep", _sweep_of(points, all_of_them.kept))  # what is there is not lost
        raise
    table = _sweep_of(points, all_of_them.kept)
    if points and all(isinstance(table.errors.get(k), OptionError) for k in range(len(points))):
        raise table.errors[0]  # a name that there is not: a mistake of the call and not of a variant
    return table


def _sweep_of(points: List[Dict[str, float]], ended: List[Any]) -> Sweep:
    """Of each run that went well there are its point, with what was drawn, and what is kept of it."""
    well = [isinstance(value, tuple) for value in ended]
    return Sweep([value[0] if good else point for point, value, good in zip(points, ended, well)],
                 [value[1] if good else value for value, good in zip(ended, well)])


def sweep_of(run: Callable[..., Result], grid: Optional[Grid], crew: Crew, options: Mapping[str, Any]) -> Sweep:
    """What Circuit.sweep does, by this function that runs one point."""
    asked = dict(options)
    points = _points_of(_grid_of(grid, asked))
    fixed = dict(asked.pop("values", None) or {})
    return _table_of(lambda index, **more: run({**fixed, **points[index]}, **more), points, crew, asked, False)


def variants_of(run: Callable[..., Result], points: List[Dict[str, float]], crew: Crew,
                options: Mapping[str, Any]) -> Sweep:
    """What Circuit.variants does: point k is step k of the netlist, and gets what was drawn."""
    return _table_of(lambda index, **more: run(only=index + 1, **more), points, crew, options, True)
