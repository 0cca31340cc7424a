#!/usr/bin/env python3
"""Measurements whose window begins a few roundings of a time before or behind an edge.

usage: late_windows.py PROGRAM

`from={k*period}` is an edge of the clock up to rounding. Between the two the stretch has one or two times that a double
can hold, and a formula that passes 0 there is all rounding: no audit may take that for a wrong result. The result itself
is that of the window from the edge on.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

FORMULAS = ("v(b)*sin(2*pi*{fast}*time)", "v(b)*sin(2*pi*{fast}*(time-{edge}))", "v(s)", "v(s)*v(b)",
            "(time-{edge})*v(b)", "abs(v(s))", "(time/{period}-3000)*v(s)")
CLOCKS = ((4e-6, 3000), (1e-3, 12), (20e-3, 400), (1e-9, 777))
ROUNDINGS = (-1, -5, -1000)


def netlist(formula, clock, begin):
    period, number = clock
    what = formula.format(fast=repr(3.25 / period), edge=repr(number * period), period=repr(period))
    window = f"from={begin!r} to={(number + 8) * period!r}"
    return (f"window\nv1 a 0 pulse(18 18.18 0 {period / 100!r} {period / 100!r} {period / 2!r} {period!r})\n"
            f"r1 a b 100\nc1 b 0 {period / 30!r}\nv2 s 0 sin(0 18 {1.0 / period!r})\nr2 s 0 1k\n"
            f".tran {period!r} {(number + 8) * period!r} {min(begin, number * period)!r} uic\n.save v(b)\n"
            f".meas tran mean avg {what} {window}\n.meas tran effective rms {what} {window}\n"
            f".meas tran top max {what} {window}\n.end\n")


def measured(done):
    return [entry["value"] for entry in done.report["measurements"]]


def main():
    windows = Checker("late_windows")
    for clock, formula in some_of([(c, f) for c in CLOCKS for f in FORMULAS]):
        edge = clock[0] * clock[1]
        exact = run(sys.argv[1], netlist(formula, clock, edge), method=None)
        for roundings in ROUNDINGS:
            begin = edge
            for _ in range(abs(roundings)):
                begin = math.nextafter(begin, math.copysign(math.inf, roundings))
            done = run(sys.argv[1], netlist(formula, clock, begin), method=None)
            name = f"{formula} from {roundings} roundings beside {clock[1]} periods of {clock[0]}"
            if windows.check(done.status == 0 and exact.status == 0, f"{name}: {done.stderr}"):
                for value, wanted in zip(measured(done), measured(exact)):
                    windows.check(abs(value - wanted) <= 1e-9 * max(measured(exact)), f"{name}: {value}, not {wanted}")
    return windows.finish()


if __name__ == "__main__":
    sys.exit(main())
