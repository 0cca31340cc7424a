#!/usr/bin/env python3
"""A capacitor of 1 pF behind some milliohms at the start of a run of 50 ms: steps of 1e-15 s, where times end.

usage: femtoseconds.py PROGRAM

Below 64 resolutions of time, 3.6e-15 s, a step is shortened only if that will do soon, or if it follows a shorter
one. Implicit Euler, which has no error control, is not asked. The capacitor is charged as the closed form says, and
a rectifier beside it goes on for the rest.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

CASES = (7e-15, 1e-10, 5), (3e-15, 1e-9, None), (2e-15, 1e-9, None), (3e-15, 1e-6, None)  # s, tolerance, stages
BEFORE = -3.0
AFTER = 10.0 * math.sin(math.pi / 4.0)
RESOLUTION = 2.0 ** -49 * 0.0625  # s: two times as near to each other are one


def netlist(tau):
    return f"""femtoseconds
v1 in 0 sin(0 10 50 0 0 45)
r1 in a {tau / 1e-12!r}
c1 a 0 1p ic={BEFORE}
l1 a b 1m
d1 b c di
c2 c 0 100u ic=2
r2 c 0 100
.model di d
.tran 50u 50m uic
.end
"""


def main():
    program = sys.argv[1]
    checker = Checker("femtoseconds")
    times = [k * 1e-15 for k in range(1, 100)]
    for tau, tolerance, stages in CASES:
        case = f"{tau} s, {tolerance}"
        result = run(program, netlist(tau), at=times, method="radau" if stages else None, tolerance=tolerance,
                     stages=stages)
        if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
            continue
        euler_steps = result.report["work"]["euler_steps"]
        checker.check(euler_steps == 0, f"{case}: {euler_steps} steps of implicit Euler")
        for t, v in zip(times, result.column("v(a)")):
            left = (BEFORE - AFTER) * math.exp(-t / tau)
            off = abs(v - (AFTER + left)) / AFTER
            moves = abs(left) / AFTER / tau * RESOLUTION
            checker.check(off <= tolerance + moves, f"{case}: v(a) is off by {off:.1e} at {t} s")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
