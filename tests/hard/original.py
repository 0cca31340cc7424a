#!/usr/bin/env python3
"""Checks every entry of tests/hard/original.json with either method.

usage: original.py PROGRAM

The file is the table that came with the cases, byte by byte; expected.json says more about the same
cases. Its kinds, and how well they must hold:
  rcp         just after t = 0: x_NAME state to 1e-12, q_NAME charge and f_NAME flux to 1e-9
  be          the value at time t of implicit Euler with step h, to 1e-12
  tran        the value at time t, tol off with implicit Euler and step h; the default method gives
              it to its tolerance of 1e-6
  diff        a signed sum at time t, implicit Euler with step h, to 1e-12
  range       of the operating point: the interval of the report, to 1e-9, which the value is in; a
              signal that the report does not list has its value for an interval
  infeasible  exit status 1, and the report's time is at most t
  multi       the value at the end is one of those listed, and a warning says it is not unique
  hmax        implicit Euler below and above the largest step that leaves its problems one solution
Relative to the value, or where it is 0 to the largest of its kind (at least 1 mV or mA). A kind
without a method here, or an entry that nothing was checked of, is a failure.
"""

import json
import math
import pathlib
import re
import sys

from hard_case import CERTIFIED, EXACT, NETLISTS, HardCase
from dalcs_program import run

STATE = 1e-12      # relative, just after t = 0
IMPULSE = 1e-9
INTERVAL = 1e-9
DEFAULT = 1e-6     # the default tolerance
SLACK = 1e-12      # s
NOTHING = 1e-3     # V, A: the least scale of a value that is 0
BELOW, ABOVE = 0.99, 1.01  # of the largest step


class Original(HardCase):
    """One case; what is of implicit Euler alone runs with `euler` alone."""

    def run(self, step=None, grid=None):
        key = (self.method, step, grid)
        if key not in self.runs:
            at = None if grid is None else [k * grid for k in range(round(self.stop() / grid) + 1)]
            at = at and [min(t, self.stop()) for t in at]
            self.runs[key] = self.accepted(f"{self.method}, step {step}", step=step, at=at,
                                           method=self.method)
        return self.runs[key]

    def euler(self, entry):
        self.method = "euler"
        return self.run(entry["h"], entry["h"])

    def both(self):
        for self.method in ("euler", None):
            yield self.run()

    def be(self, entry):
        result = self.euler(entry)
        size = abs(entry["val"]) or max(result.scale(entry["q"]), NOTHING)
        self.checker.close(result.at(entry["q"], entry["t"]), entry["val"], EXACT * size,
                           f"{entry['q']} at {entry['t']}")

    diff = be

    def tran(self, entry):
        self.checker.close(self.euler(entry).at(entry["q"], entry["t"]), entry["val"], entry["tol"],
                           f"{entry['q']} at {entry['t']}, euler")
        times = sorted({entry["t"]} | {self.stop() * k / 200 for k in range(201)})
        result = self.accepted("the default method", at=times, method=None)
        largest = max(abs(value) for value in result.column(entry["q"]))
        self.checker.close(result.at(entry["q"], entry["t"]), entry["val"], DEFAULT * largest,
                           f"{entry['q']} at {entry['t']}, the default method")

    def rcp(self, entry):
        kind, element = entry["q"].split("_", 1)
        for result in self.both():
            if kind == "x":
                found = result.report["start"][element]
                others = [abs(state["before"]) for jump in result.report["jumps"]
                          for state in jump["states"].values()]
                tolerance = STATE
            else:
                found = result.impulse(element, {"q": "charge", "f": "flux"}[kind])
                others = [abs(e["val"]) for e in self.entries if e["q"].startswith(kind)]
                tolerance = IMPULSE
            size = abs(entry["val"]) or max(others + [NOTHING])
            self.checker.close(found, entry["val"], tolerance * size,
                               f"{entry['q']} after t = 0, {self.method or 'the default method'}")

    def range(self, entry):
        low, high = (float(bound) for bound in entry["val"])
        for result in self.both():
            value = result.column(entry["q"])[-1]
            listed = [n for n in result.report["nonunique"] if n["signal"] == entry["q"]]
            self.checker.check(len(listed) <= 1, f"{entry['q']} is listed {len(listed)} times")
            found = listed[0] if listed else {"lower": value, "upper": value}
            for bound, wanted in (("lower", low), ("upper", high)):
                size = abs(wanted) if 0.0 < abs(wanted) < math.inf else result.scale(entry["q"])
                self.checker.check(
                    float(found[bound]) == wanted or
                    abs(float(found[bound]) - wanted) <= INTERVAL * size,
                    f"{bound} bound of {entry['q']} = {found[bound]}, not {wanted}, "
                    f"{self.method or 'the default method'}")
            slack = EXACT * result.scale(entry["q"])
            self.checker.check(low - slack <= value <= high + slack,
                               f"{entry['q']} = {value!r} is outside [{low}, {high}]")

    def infeasible(self, entry):
        for method in ("euler", None):
            result = run(self.program, self.netlist, method=method)
            self.checker.check(result.status == 1 and result.output is None,
                               f"exit {result.status}, or an output file was left")
            refused = result.report.get("infeasible") if result.report else None
            if self.checker.check(refused, "the report has no key 'infeasible'"):
                self.checker.check(refused["time"] <= entry["t"] + SLACK,
                                   f"refused at {refused['time']}, not by {entry['t']}")

    def multi(self, entry):
        for result in self.both():
            value = result.column(entry["q"])[-1]
            error = min(abs(value - wanted) for wanted in entry["val"])
            self.checker.check(error <= EXACT, f"{entry['q']} = {value!r}, not in {entry['val']}")
            self.checker.check(re.search(r"warning:.*not (unique|determined)", result.stderr),
                               f"no warning says that the solution is not unique: {result.stderr}")

    def first_step(self, step, initial):
        """One step of implicit Euler from another initial value of hc36."""
        text = self.netlist.read_text().replace("ic=1\n", f"ic={initial}\n")
        self.checker.check(text.count(f"ic={initial}\n") == 1, "the netlist has no ic=1 any more")
        return run(self.program, text, step=step)

    def hmax(self, entry):
        """Of (1 - h) x' = x + h lambda, x' >= 0, lambda >= 0: from x = 1 one solution below the
        largest step, none above; from x = -1 one below, two above."""
        below, above = BELOW * entry["val"], ABOVE * entry["val"]
        result = self.first_step(below, "1")
        if self.checker.check(result.status == 0, f"refused at h = {below}: {result.stderr}"):
            wanted = 1.0 / (1.0 - below)
            self.checker.close(result.at("v(1)", below), wanted, EXACT * wanted, "v(1)")
        result = self.first_step(above, "1")
        self.checker.check(result.status == 1 and "infeasible" in (result.report or {}),
                           f"exit {result.status} above the largest step, where no solution exists")
        result = self.first_step(below, "-1")
        if self.checker.check(result.status == 0, f"refused from -1 V: {result.stderr}"):
            self.checker.close(result.at("v(1)", below), 0.0, EXACT, "v(1) from -1 V")
            self.checker.close(result.at("i(d1)", below), 1.0 / below, EXACT / below, "i(d1)")
        result = self.first_step(above, "-1")
        if self.checker.check(result.status == 0, f"refused from -1 V: {result.stderr}"):
            found = result.at("v(1)", above), result.at("i(d1)", above)
            solutions = (0.0, 1.0 / above), (1.0 / (above - 1.0), 0.0)
            self.checker.check(any(abs(found[0] - v) <= EXACT * max(1.0, v) and
                                   abs(found[1] - i) <= EXACT for v, i in solutions),
                               f"v(1), i(d1) = {found}, which is none of {solutions}")

    def finish(self):
        for entry in self.entries:
            before = self.checker.checks
            getattr(self, entry["kind"])(entry)
            self.checker.check(self.checker.checks > before, f"nothing was checked of {entry}")
        return self.checker.finish()


def main():
    entries = json.loads(pathlib.Path(__file__).with_name("original.json").read_text())
    cases = sorted({entry["case"] for entry in entries})
    netlists = sorted(path.stem for path in (NETLISTS / "hard").glob("*.cir"))
    failed = 0
    if cases != netlists or not cases:
        print(f"FAIL netlists/hard has {netlists}, the table {cases}")
        failed = 1
    for case in cases:
        of_case = [entry for entry in entries if entry["case"] == case]
        try:
            failed |= Original(sys.argv[1], case, of_case).finish()
        except SystemExit:
            failed = 1
    return failed


if __name__ == "__main__":
    sys.exit(main())
