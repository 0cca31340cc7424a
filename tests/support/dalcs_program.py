"""Runs the dalcs program for the tests and reads back what it wrote."""

import csv
import functools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NETLISTS = ROOT / "netlists"
IS_LONG = os.environ.get("DALCS_TEST_SHORT") != "1"  # as by hand and with tools/test --long


class Run:
    """The outcome of one `dalcs run`."""

    def __init__(self, status, stderr, output, report):
        self.status = status
        self.stderr = stderr
        self.output = output  # the CSV as bytes, None when there is none
        self.report = report  # the parsed report, None when there is none

    @functools.cached_property
    def names(self):
        return next(csv.reader(self.output.decode("utf-8").splitlines())) if self.output else []

    @functools.cached_property
    def rows(self):
        """Read when asked for: many tests only compare what was written."""
        lines = (self.output or b"").decode("utf-8").splitlines()
        return [[float(field) for field in line.split(",")] for line in lines[1:]]

    @functools.cached_property
    def columns(self):
        """By name; where two signals have one name, the first."""
        return dict(reversed(list(zip(self.names, map(list, zip(*self.rows)) if self.rows else [[] for _ in self.names]))))

    @property
    def time(self):
        return self.column("time")

    def column(self, name):
        """One signal over all rows; also v(a,b) and signed sums such as i(d1)-i(d3)."""
        if name in self.names:
            return self._plain(name)
        terms = re.findall(r"([+-]?)((?:time)|[vi]\([^()]*\))", name)
        if "".join(sign + signal for sign, signal in terms) != name:
            raise ValueError(f"cannot read the signal {name}")
        total = [0.0] * len(self.rows)
        for sign, signal in terms:
            for place, value in enumerate(self._plain(signal)):
                total[place] += -value if sign == "-" else value
        return total

    def _plain(self, name):
        if name in self.names:
            return self.columns[name]
        pair = re.fullmatch(r"v\(([^,()]+),([^,()]+)\)", name)
        if pair:
            first, second = (self._node(node) for node in pair.groups())
            return [a - b for a, b in zip(first, second)]
        raise KeyError(f"no signal {name} among {', '.join(self.names)}")

    def _node(self, node):
        return [0.0] * len(self.rows) if node == "0" else self._plain(f"v({node})")

    def at(self, name, time):
        """The value at a time of the grid; the right-hand side at a discontinuity."""
        best = min(range(len(self.rows)), key=lambda k: (abs(self.rows[k][0] - time), -k))
        if abs(self.rows[best][0] - time) > 1e-9 * max(abs(time), self.rows[-1][0]):
            raise ValueError(f"no row at {time}")
        return self.column(name)[best]

    def scale(self, name):
        """The largest voltage or current of the run, by the unit of `name`."""
        return self._largest["v(" if "v(" in name else "i("]

    @functools.cached_property
    def _largest(self):
        return {kind: self._largest_of(kind) for kind in ("v(", "i(")}

    def _largest_of(self, kind):
        chosen = [column for signal, column in self.columns.items() if signal.startswith(kind) and column]
        return max((max(max(column), -min(column)) for column in chosen), default=0.0)

    def impulse(self, element, key, time=0.0):
        """Sum of an element's impulses at one time; key is 'charge' or 'flux'. 0 without a jump."""
        return sum(jump["impulses"].get(element, {}).get(key, 0.0)
                   for jump in self.report.get("jumps", []) if jump["time"] == time)

    def loss(self, time=0.0):
        return sum(jump["energy_lost"] for jump in self.report.get("jumps", [])
                   if jump["time"] == time)


def run(program, netlist, step=None, at=None, options=(), report=True, environment=None,
        method="euler", tolerance=None, stages=None, quiet=True):
    """Runs a netlist (a path, or text) and returns a Run. `at` lists the output times.

    method None leaves the choice to the program, as tolerance None and stages None do."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        if "\n" in str(netlist):
            path = folder / "circuit.cir"
            path.write_text(netlist)
        else:
            path = pathlib.Path(netlist)
        output, saved_report = folder / "out.csv", folder / "report.json"
        command = [program, "run", str(path), "-o", str(output)]
        command += ["--quiet"] if quiet else []
        if method is not None:
            command += ["--method", method]
        if tolerance is not None:
            command += ["--tol", repr(float(tolerance))]
        if stages is not None:
            command += ["--stages", str(stages)]
        if report:
            command += ["--report", str(saved_report)]
        if step is not None:
            command += ["--step", repr(float(step))]
        if at is not None:
            (folder / "at.txt").write_text("".join(f"{t!r}\n" for t in at))
            command += ["--at", str(folder / "at.txt")]
        done = subprocess.run(command + list(options), stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False,
                              env={**os.environ, **(environment or {})})
        if done.returncode < 0:
            raise AssertionError(f"{path.name}: ended by signal {-done.returncode}\n{done.stderr}")
        return Run(done.returncode, done.stderr,
                   output.read_bytes() if output.exists() else None,
                   json.loads(saved_report.read_text()) if saved_report.exists() else None)


def some_of(cases, n=3):
    """Of cases that differ by numbers alone one in n, spread evenly whatever period the order of the cases has, and the
    first; all in a long run, and by hand. Where DALCS_TEST_SOME is larger, as in .ci/run for sanitizers, one in so
    many: what these look for shows in few of them as in all. With n = 1 these alone take fewer."""
    part = 1.0 / max(1 if IS_LONG else n, int(os.environ.get("DALCS_TEST_SOME", "1")))
    return [case for k, case in enumerate(cases) if k * 0.6180339887498949 % 1.0 < part]  # the golden section


def kinds_of(cases):
    """Of cases of different kinds all; one in four where DALCS_TEST_SOME is set, as in .ci/run for sanitizers, which
    run each test at one commit in four: DALCS_TEST_TURN, the number of commits, says which."""
    cases = list(cases)
    if len(cases) < 4 or "DALCS_TEST_SOME" not in os.environ:
        return cases
    return cases[int(os.environ.get("DALCS_TEST_TURN", "0")) // 4 % 4::4]


class Checker:
    """Counts what fails, and says it."""

    def __init__(self, name):
        self.name = name
        self.checks = 0
        self.failures = 0

    def check(self, condition, message):
        self.checks += 1
        if not condition:
            self.failures += 1
            print(f"FAIL {self.name}: {message}")
        return condition

    def close(self, found, wanted, tolerance, what):
        error = abs(found - wanted)
        return self.check(error <= tolerance,  # a NaN fails
                          f"{what} = {found!r}, not {wanted!r}: off by {error:.3e}, "
                          f"allowed {tolerance:.3e}")

    def finish(self):
        """The exit status: 0 when something was checked and nothing failed."""
        print(f"{self.name}: {self.checks} checks, {self.failures} failed")
        return 0 if self.checks > 0 and self.failures == 0 else 1
