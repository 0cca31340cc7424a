#!/usr/bin/env python3
"""A capacitor of 15 nF behind a diode of 1 mohm: rounding of 100 V is a current that no step mends.

usage: lever.py PROGRAM

The current of some 0.1 mA is a difference of voltages over the resistance, so the last digit of these is 1e-7 of
it. It is followed, behind a transient of 15 ps, in a few hundred steps, and not in as many as it takes to look
at that digit every nanosecond.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

NETLIST = """lever
v1 in 0 sin(20.4 110 60 0 0 90)
c1 in out 15n
d1 0 out di
r1 out 0 833.3k
.model di d(ron=1m roff=51k)
.tran 20u 25m
.end
"""
TOLERANCES = 1e-6, 1e-7, 1e-8, 1e-9, 1e-10
MOST_STEPS = 1000


def main():
    program = sys.argv[1]
    checker = Checker("lever")
    for tolerance in some_of(TOLERANCES):
        result = run(program, NETLIST, method=None, tolerance=tolerance)
        if checker.check(result.status == 0, f"{tolerance}: {result.stderr}"):
            steps = result.report["work"]["steps"]
            checker.check(steps <= MOST_STEPS, f"{tolerance}: {steps} steps")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
