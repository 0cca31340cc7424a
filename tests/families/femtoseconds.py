#!/usr/bin/env python3
"""A capacitor of 1 pF behind 7 mohm at the start of a run of 50 ms: steps of 1e-15 s, where times end.

usage: femtoseconds.py PROGRAM

Below 64 resolutions of time, 3.6e-15 s, no step is shortened any more. One that follows a shorter step, and is
refused, is as short as that again; implicit Euler, which has no error control, is not asked. The capacitor is
charged as the closed form says, and a rectifier beside it goes on for the rest.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

TAU = 7e-15
BEFORE = -3.0
NETLIST = f"""femtoseconds
v1 in 0 sin(0 10 50 0 0 45)
r1 in a {TAU / 1e-12!r}
c1 a 0 1p ic={BEFORE}
l1 a b 1m
d1 b c di
c2 c 0 100u ic=2
r2 c 0 100
.model di d
.tran 50u 50m uic
.end
"""
TOLERANCE = 1e-10
RESOLUTION = 2.0 ** -49 * 0.0625  # s: two times as near to each other are one


def main():
    program = sys.argv[1]
    checker = Checker("femtoseconds")
    times = [k * 1e-15 for k in range(1, 100)]
    result = run(program, NETLIST, at=times, method="radau", tolerance=TOLERANCE, stages=5)
    if checker.check(result.status == 0, result.stderr):
        euler_steps = result.report["work"]["euler_steps"]
        checker.check(euler_steps == 0, f"{euler_steps} steps of implicit Euler")
        after = 10.0 * math.sin(math.pi / 4.0)
        for t, v in zip(times, result.column("v(a)")):
            left = (BEFORE - after) * math.exp(-t / TAU)
            off = abs(v - (after + left)) / after
            moves = abs(left) / after / TAU * RESOLUTION
            checker.check(off <= TOLERANCE + moves, f"v(a) is off by {off:.1e} at {t} s")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
