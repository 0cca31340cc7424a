"""Many runs of one netlist, in threads: the library runs outside of the interpreter's lock."""

from __future__ import annotations

import itertools
import os
import threading
from typing import Any, Callable, Dict, Iterator, List, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _library as c
from ._errors import Cancelled, Error, OptionError
from ._names import find
from ._result import Result
from ._session import OWN_OPTIONS, Number, number_of

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


class NotRun(Error):
    """A run that was not begun or not ended: Ctrl-C came before."""

    def __init__(self) -> None:
        super().__init__(c.E_CANCELLED, ["error: not run: the sweep was ended before"])

    def __reduce__(self):  # type: ignore[no-untyped-def]
        return type(self), ()


class _Workers:
    """Threads that take the next run until there is none, or until they are stopped."""

    def __init__(self, task: Callable[[int], Any], count: int, stopped: threading.Event,
                 done: Optional[Callable[[int, int], Any]]) -> None:
        self.task, self.stopped, self.done = task, stopped, done
        self.kept: List[Any] = [NotRun() for _ in range(count)]
        self.failure: Optional[BaseException] = None
        self.next = itertools.count()
        self.moved = threading.Condition()
        self.n_done = 0

    def work(self, tell: Callable[[int], None]) -> None:
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


def _table_of(run: Callable[..., Result], points: List[Dict[str, float]], workers: Optional[int],
              each: Optional[Callable[[Result], Any]], done: Optional[Callable[[int, int], Any]],
              options: Mapping[str, Any], keep: Callable[[int, Result], None]) -> Sweep:
    """run(k, ...) is point k, of which `keep` may write more into the points."""
    asked = dict(options)
    if each is None:
        asked = {"rows": False, "record": False, **asked}
    told = asked.pop("progress", None)
    stopped = threading.Event()

    def progress(time: float, stop: float) -> None:
        if stopped.is_set():
            raise Cancelled(c.E_CANCELLED, ())
        if told is not None:
            told(time, stop)

    def task(index: int) -> Any:
        result = run(index, progress=progress, **asked)
        keep(index, result)
        kept = result.measures if each is None else each(result)
        return kept if isinstance(kept, Mapping) else {"value": kept}

    if workers is None:
        workers = len(os.sched_getaffinity(0))
    crew = _Workers(task, len(points), stopped, done)
    try:
        crew.run(min(workers, len(points)))
    except BaseException as end:
        setattr(end, "sweep", Sweep(points, crew.kept))  # what is there is not lost
        raise
    table = Sweep(points, crew.kept)
    if points and all(isinstance(table.errors.get(k), OptionError) for k in range(len(points))):
        raise table.errors[0]  # a name that there is not: a mistake of the call and not of a variant
    return table


def sweep_of(run: Callable[..., Result], grid: Optional[Grid], workers: Optional[int],
             each: Optional[Callable[[Result], Any]], done: Optional[Callable[[int, int], Any]],
             options: Mapping[str, Any]) -> Sweep:
    """What Circuit.sweep does, by this function that runs one point."""
    asked = dict(options)
    points = _points_of(_grid_of(grid, asked))
    fixed = dict(asked.pop("values", None) or {})
    return _table_of(lambda index, **more: run({**fixed, **points[index]}, **more), points, workers, each,
                     done, asked, lambda index, result: None)


def variants_of(run: Callable[..., Result], points: List[Dict[str, float]], workers: Optional[int],
                each: Optional[Callable[[Result], Any]], done: Optional[Callable[[int, int], Any]],
                options: Mapping[str, Any]) -> Sweep:
    """What Circuit.variants does: point k is step k of the netlist, and gets what was drawn."""
    return _table_of(lambda index, **more: run(only=index + 1, **more), points, workers, each, done, options,
                     lambda index, result: points[index].update(result.drawn))
