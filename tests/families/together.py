#!/usr/bin/env python3
"""A bridge whose opposite diodes carry one current and open in the same moment.

usage: together.py PROGRAM

Where it ends, the one that rounding makes the first would leave the other with next to nothing, which leaks of
6.8 Mohm alone take down, late; and their voltages, which begin at 0 and rise as a square of time, with what 55 mohm
beside these leaks round.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

NETLIST = """together
v1 a q sin(0 12 50 0 35.5)
r1 q b 55m
d1 a p di
d2 b p di
d3 0 a di
d4 0 b di
r2 p 0 3.9k
c1 p 0 564.1n
.model di d(ron=54m roff=6.8meg vfwd=0.7)
.tran 76u 76m uic
.end
"""
STOP = 76e-3
TOLERANCES = 1e-6, 1e-8, 1e-9, 1e-10
SAME = 1e-9  # of the stop time


def main():
    program = sys.argv[1]
    checker = Checker("together")
    for tolerance in some_of(TOLERANCES):
        result = run(program, NETLIST, method=None, tolerance=tolerance)
        if not checker.check(result.status == 0, f"{tolerance}: {result.stderr}"):
            continue
        times = {f"d{k}": [event["time"] for event in result.report["events"] if event["element"] == f"d{k}"]
                 for k in range(1, 5)}
        for one, other in ("d1", "d4"), ("d2", "d3"):
            if checker.check(len(times[one]) == len(times[other]) > 0, f"{tolerance}: events {times}"):
                apart = max(abs(a - b) for a, b in zip(times[one], times[other]))
                checker.check(apart <= SAME * STOP, f"{tolerance}: {one} and {other} are {apart:.1e} s apart")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
