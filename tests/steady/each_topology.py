#!/usr/bin/env python3
"""Converters by the names of their topologies: steady state, multipliers, response.

usage: each_topology.py PROGRAM GROUP [NAME]     (groups: topologies.py)

* The steady state against a run at --tol 1e-11 that is as long as its multipliers require.
* The multipliers against differences of runs of one period, from states beside the orbit's; without gates.
* The response against small sines, as gates.py of tests/bode: at fractions of the clock's frequency, above its half, too.
* What has no clock is looked at for its steps and its stability alone; oscillators.py has its period.

The group `inverters` takes some minutes and is not in the suite.
"""

import cmath
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import topologies  # pylint: disable=import-error
from settled import MOST_PERIODS, NEAR, off  # pylint: disable=import-error

MOST_STEPS = 10
FRACTIONS = [(1, 8), (3, 10), (11, 20), (9, 10), (17, 10)]
RESPONSE = 1e-6
MULTIPLIERS = 1e-6


def determinant(columns, shift):
    """Of M - shift, by elimination with pivots."""
    rows = [[complex(value) - (shift if i == k else 0) for k, value in enumerate(row)]
            for i, row in enumerate(zip(*columns))]
    product = 1 + 0j
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda i, k=k: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        product *= rows[k][k] if pivot == k else -rows[k][k]
        for row in rows[k + 1:]:
            factor = row[k] / rows[k][k] if rows[k][k] != 0 else 0
            row[k:] = [a - factor * b for a, b in zip(row[k:], rows[k][k:])]
    return product


def distance(columns, m):
    """How far the next eigenvalue is from m: a step of Newton's method on the characteristic polynomial."""
    near = 1e-4
    value, slope = determinant(columns, m), (determinant(columns, m + near) - determinant(columns, m - near)) / (2 * near)
    return abs(value / slope) if slope != 0 else math.inf


class Look:
    """At one topology."""

    def __init__(self, program, folder, checker, case):
        self.program, self.folder, self.checker, self.case = program, folder, checker, case
        self.body = case.netlist.replace("{S}", f"DC {case.level!r} AC 1")

    def check(self, condition, message):
        return self.checker.check(condition, f"{self.case.name}: {message}")

    def run(self, verb, netlist, *options):
        (self.folder / "c.cir").write_text(f"{self.case.name}\n{netlist}.end\n")
        (self.folder / "c.json").unlink(missing_ok=True)
        done = subprocess.run([self.program, verb, "c.cir", "-q", "-o", "c.csv", "--report", "c.json", *options],
                              cwd=self.folder, capture_output=True, text=True, check=False)
        path = self.folder / "c.json"
        return done, json.loads(path.read_text()) if path.exists() else {}

    def look(self):
        done, report = self.run("steady", self.body + ".pss uic\n")
        if not self.check(done.returncode == 0, done.stderr):
            return
        steady = report["steady"]
        self.check(steady["newton"] <= MOST_STEPS, f"{steady['newton']} Newton steps, {steady['periods']} periods")
        self.check(steady["stable"], f"{steady['verdict']}, {steady['multipliers']}")
        self.settle(steady, report["work"]["cpu_s"])
        if self.case.clock and not re.search(r"^A", self.body, re.M):
            self.differences(steady)
        if self.case.clock and steady["stable"]:
            self.respond()

    def settle(self, steady, cpu):
        """Unless that takes too long, or the circuit has no clock."""
        largest = max([math.hypot(m["re"], m["im"]) for m in steady["multipliers"]], default=0.0)
        periods = 20 if largest < 0.1 else math.ceil(1.3 * math.log(1e-12) / math.log(min(largest, 0.9999999))) + 20
        if periods > MOST_PERIODS or not steady["stable"] or not self.case.clock:
            print(f"{self.case.name}: not run, {periods} periods, {steady['newton']} steps")
            return
        stop = periods * steady["period"]
        done, settled = self.run("run", self.body + f".tran {stop!r} {stop!r} {stop * (1 - 1e-9)!r} uic\n", "--tol", "1e-11",
                                 "--fill", "none")
        if self.check(done.returncode == 0, f"settled: {done.stderr}"):
            worst = off(steady, settled["final"])
            self.check(worst <= NEAR, f"off by {worst:.2g} after {periods} periods")
            print(f"{self.case.name}: {steady['newton']} steps, {periods} periods, off by {worst:.2g}, "
                  f"{settled['work']['cpu_s'] / cpu:.3g} times faster, exact {steady['exact']}")

    def after(self, states, period):
        """The states a period later, in the order of their names."""
        lines = [re.sub(r" IC=\S+", "", line) for line in self.body.splitlines()]
        body = "".join(line + (f" IC={states[line.split()[0].lower()]!r}" if line[0] in "CL" else "") + "\n" for line in lines)
        done, report = self.run("run", body + f".tran {period!r} {period!r} {period * (1 - 1e-9)!r} uic\n", "--tol", "1e-11",
                                "--fill", "none")
        if done.returncode != 0:
            raise RuntimeError(done.stderr)
        return [report["final"][name] for name in states]

    def differences(self, steady):
        """M by central differences of runs, of two lengths, so that their error is of the fourth order."""
        states, columns = steady["states"], []
        for name in states:
            size = max(abs(value) for other, value in states.items() if other[0] == name[0])
            slopes = []
            for step in (1e-5 * size, 5e-6 * size):
                plus, minus = (self.after({**states, name: states[name] + by}, steady["period"]) for by in (step, -step))
                slopes.append([(p - m) / (2 * step) for p, m in zip(plus, minus)])
            columns.append([(4 * fine - coarse) / 3 for coarse, fine in zip(*slopes)])
        for m in steady["multipliers"]:
            away = distance(columns, complex(m["re"], m["im"]))
            self.check(away <= MULTIPLIERS, f"multiplier {m} is off by {away:.2g}")

    def respond(self):
        case = self.case
        asked = [m / n / case.clock for m, n in FRACTIONS]
        cards = f".save {case.signal}\n.pss uic\n.ac list {' '.join(map(repr, asked))}\n"
        done, report = self.run("run", self.body + cards, "--tol", "1e-11")
        if not self.check(done.returncode == 0, f"response: {done.stderr}"):
            return
        self.check(report["response"]["exact"], f"the response is not exact: {done.stderr}")
        rows = [[float(v) for v in line.split(",")] for line in (self.folder / "c.csv").read_text().splitlines()[1:]]
        found = [complex(row[1], row[2]) for row in rows]
        largest = max(map(abs, found))
        for fraction, value in zip(FRACTIONS, found):
            whole, half = self.injected(fraction, case.amplitude), self.injected(fraction, case.amplitude / 2)
            expected = (4 * half - whole) / 3
            away = abs(value - expected) / max(abs(expected), 1e-2 * largest)
            self.check(away <= RESPONSE, f"response at {fraction}: {value}, not {expected}, off by {away:.2g}")

    def injected(self, fraction, amplitude):
        case = self.case
        frequency = fraction[0] / fraction[1] / case.clock
        body = case.netlist.replace("{S}", f"SIN({case.level!r} {amplitude!r} {frequency!r})")
        cards = f".save {case.signal}\n.pss {fraction[1] * case.clock!r} uic\n.four {frequency!r} 1 {case.signal}\n"
        done, report = self.run("run", body + cards, "--tol", "1e-11")
        if not self.check(done.returncode == 0, f"with a sine at {fraction}: {done.stderr}"):
            return math.nan
        part = report["fourier"][0]
        return part["magnitude"][1] * cmath.exp(1j * math.radians(part["phase"][1])) / amplitude


def main():
    program, group = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    checker = dalcs_program.Checker(group)
    with tempfile.TemporaryDirectory() as folder:
        for case in dalcs_program.some_of(topologies.GROUPS[group]()):
            if len(sys.argv) < 4 or sys.argv[3] == case.name:
                try:
                    Look(program, pathlib.Path(folder), checker, case).look()
                except RuntimeError as error:
                    checker.check(False, f"{case.name}: {error}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
