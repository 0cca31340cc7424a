"""A circuit of this folder as ngspice gets it, one run of it, and its error.

Everything is in ngspice's favour: sharp devices without series resistance, edges of the gates
centred on the ideal ones, only the compared signals saved, and at each output time the better of
linear and cubic interpolation between ngspice's own time points."""

import bisect
import csv
import dataclasses
import math
import pathlib
import resource
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
import near_ideal  # noqa: E402
import ngspice_batch  # noqa: E402


@dataclasses.dataclass(frozen=True)
class Setting:
    method: str
    reltol: float
    tmax: float  # s
    emission: float  # the diodes' N; the resistance of an ideal switch goes with it
    edge: float = 0.0  # s, width of the gates' edges
    extra: str = ""  # more of .options

    def __str__(self):
        edge = f", edges {self.edge:.3g} s" if self.edge else ""
        extra = f", {self.extra}" if self.extra else ""
        return (f"{self.method}, reltol {self.reltol:.2g}, tmax {self.tmax:.3g} s, "
                f"N {self.emission:.2g}{edge}{extra}")


@dataclasses.dataclass
class Run:
    error: float = math.inf
    worst: str = ""
    seconds: float = math.inf  # of one transient, CPU
    points: int = 0
    reason: str = ""
    timed: bool = False  # seconds are of many runs


class Reference:
    """The rows of reference_values/NAME.csv."""

    def __init__(self, path):
        with open(path, newline="", encoding="utf-8") as file:
            lines = [line for line in file if not line.startswith("#")]
        header, *rows = csv.reader(lines)
        self.names = header[1:]
        columns = list(zip(*[[float(field) for field in row] for row in rows]))
        self.times, self.columns = columns[0], dict(zip(self.names, columns[1:]))
        self.scale = {name: max(abs(value) for value in column if value == value)
                      for name, column in self.columns.items()}


def gate(card, edge):
    """A PULSE with edges of no width, whose new ones are centred on the old. One that starts high
    is turned around: ngspice knows no edge before t = 0."""
    name, plus, minus, _, *numbers = near_ideal.words(card)
    low, high, delay, _, _, width, period = map(near_ideal.number, numbers)
    if delay == 0.0:
        low, high, delay, width = high, low, width, period - width
    values = (low, high, delay - edge / 2, edge, edge, width - edge, period)
    return f"{name} {plus} {minus} pulse({' '.join(repr(value) for value in values)})"


def deck(text, setting, signals, repeat, raw=None):
    """`repeat` runs in one process; what they store is thrown away, but for one that is written."""
    title, cards = near_ideal.logical_lines(text)
    models = near_ideal.read_models(cards)
    lines = [f"* {title}", f".model xmd d(is=1e-14 n={setting.emission!r})"]
    for card in cards:
        words = near_ideal.words(card)
        if card[0] == "d":
            lines.append(f"{words[0]} {words[1]} {words[2]} xmd")
        elif "pulse" in words:
            lines.append(gate(card, setting.edge))
        elif card[0] != ".":
            lines.append(card)
    for name, model in models.items():
        if model.kind == "sw":
            on = model.get("ron") or 0.1 * setting.emission
            lines.append(f".model {name} sw(ron={on!r} roff=1e9 vt={model.get('vt')!r} vh=0)")
    stop = near_ideal.analyses(cards)[1][1]
    saved = sorted({part for name in signals for part in
                    ([f"v({node})" for node in name[2:-1].split(",")] if name[0] == "v"
                     else [name])})
    lines += [f".tran {setting.tmax!r} {stop!r} 0 {setting.tmax!r} uic",
              f".options reltol={setting.reltol!r} method={setting.method} {setting.extra}",
              ".save " + " ".join(saved), ".control"]
    if raw:
        lines += ["run", f"write {raw}"]
    elif repeat:
        lines += [f"repeat {repeat}", "run", "destroy all", "end"]
    return "\n".join(lines + ["quit", ".endc", ".end", ""])


def error(table, reference):
    """(error, worst signal): largest difference over the signal's size."""
    grid = table.column("time")
    worst = (0.0, reference.names[0])
    places = [min(max(bisect.bisect(grid, time), 1), len(grid) - 1) for time in reference.times]
    for name in reference.names:
        column = table.signal(name)
        for time, place, exact in zip(reference.times, places, reference.columns[name]):
            if exact != exact:
                continue
            difference = min(abs(value - exact) for value in
                             interpolations(grid, column, place, time))
            if not difference <= worst[0] * reference.scale[name]:
                worst = (difference / reference.scale[name], name)
    return worst


def interpolations(grid, column, place, time):
    """Linear, and where the points are distinct cubic through two on either side."""
    left, right = grid[place - 1], grid[place]
    part = (time - left) / (right - left) if right > left else 1.0
    yield column[place - 1] * (1 - part) + column[place] * part
    if 2 <= place <= len(grid) - 2:
        t, y = grid[place - 2:place + 2], column[place - 2:place + 2]
        if min(b - a for a, b in zip(t, t[1:])) > 1e-12 * grid[-1]:
            yield sum(y[i] * math.prod((time - t[j]) / (t[i] - t[j]) for j in range(4) if j != i)
                      for i in range(4))


def ngspice(text, folder, timeout):
    """(log, CPU s of the process); the log is None when it took too long."""
    path = folder / "deck.cir"
    path.write_text(text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run([ngspice_batch.NGSPICE, "-n", "-b", path.name], cwd=folder,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=timeout,
                              check=False)
    except FileNotFoundError as missing:
        raise ngspice_batch.NoNgspice from missing
    except subprocess.TimeoutExpired:
        return None, math.inf
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return (done.stdout + done.stderr).decode("utf-8", "replace"), cpu


class Runner:
    """One circuit. ngspice's own `rusage trantime` counts milliseconds on the wall clock, others'
    work on the machine included. So a transient's CPU time is that of a process with many of them,
    less that of a process that reads the same netlist and runs none."""

    def __init__(self, text, reference):
        self.text, self.reference = text, reference
        self.start = min(self._process(Setting("trap", 1e-3, 1.0, 1.0, 1e-9), 0, None, 60)[1]
                         for _ in range(5))

    def _process(self, setting, repeat, raw, timeout):
        """(log, CPU s, what was written)"""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            names = self.reference.names if raw else self.reference.names[:1]
            log, cpu = ngspice(deck(self.text, setting, names, repeat, raw), folder, timeout)
            written = folder / raw if raw else None
            return log, cpu, (ngspice_batch.read_raw(written) if raw and written.exists()
                              else None)

    def run(self, setting, timeout):
        """Once, for the error and a rough time."""
        log, cpu, table = self._process(setting, 1, "out.raw", timeout)
        if log is None:
            return Run(reason=f"no end within {timeout:g} s")
        if table is None or table.column("time")[-1] < self.reference.times[-1]:
            return Run(reason=ngspice_batch.reason_in(log))
        result = Run(seconds=max(cpu - self.start, 1e-4), points=table.n_rows)
        result.error, result.worst = error(table, self.reference)
        return result

    def time(self, setting, guess):
        """CPU s of one transient, from as many as fill a tenth of a second."""
        repeat = min(500, math.ceil(0.1 / max(guess, 2e-4)))
        log, cpu, _ = self._process(setting, repeat, None, 120)
        return math.inf if log is None else (cpu - self.start) / repeat
