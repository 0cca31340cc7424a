#!/usr/bin/env python3
"""Amplifiers that take their output through the dead zone of two diodes within picoseconds: no state jumps.

usage: dead_zone.py PROGRAM

A precision rectifier: its amplifier of one pole has diodes in its feedback. When one of them opens the loop is open until
the output has passed to where the other one closes. That takes far less than a micro-step, and is no jump: the mode in
between leaves every state free (Heemels, Schumacher and Weiland 1999, sec. 4). Each is run with a full audit, tells of no
jump, and gives the rectified sine within what the gain leaves."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# gain, pole s, volts, hertz, ohms of the feedback, rails V
CASES = [(1e5, 3e-6, 2.0, 400.0, 1.0, 5.0), (1e4, 1e-5, 1.0, 50.0, 1e3, 12.0), (1e6, 1e-3, 0.5, 1e3, 1e4, 15.0),
         (1e5, 3e-6, 2e-3, 400.0, 10.0, 0.05), (1e3, 1e-6, 3.0, 1e3, 100.0, 30.0), (1e5, 1e-4, 200.0, 50.0, 1e4, 1e3),
         (3e4, 1e-5, 0.1, 2e4, 1e3, 5.0), (1e6, 1e-2, 4.0, 10.0, 1e5, 15.0), (1e5, 1e-5, 2.0, 1e-2, 1.0, 5.0),
         (2e5, 5e-6, 1.0, 60.0, 1e6, 5.0)]
ARGUMENTS = [(None, None), ("1e-9", None), ("1e-4", None), ("1e-6", 5)]


def netlist(gain, pole, volts, hertz, ohms, rails):
    return f"""precision rectifier
v1 in 0 sin(0 {volts} {hertz})
r1 in n {ohms}
b1 oi 0 v=limit({gain}*(-v(n)), {-rails}, {rails})
r2 oi oj 1k
c1 oj 0 {pole / 1e3!r}
e1 o 0 oj 0 1
d1 o a
r3 a n {ohms}
d2 n o
.tran {0.005 / hertz!r} {2 / hertz!r} uic
.end
"""


def main():
    program = sys.argv[1]
    checker = Checker("dead zone")
    for values, tolerance, stages in some_of([(c, *a) for c in CASES for a in ARGUMENTS]):
        gain, pole, volts, hertz, ohms, _ = values
        case = f"{values}, tolerance {tolerance}, {stages} stages"
        times = [(0.05 + 0.1 * k) / hertz for k in range(20)]
        result = run(program, netlist(*values), at=times, method="radau" if stages else None, tolerance=tolerance,
                     stages=stages, options=["--audit", "full"])
        if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
            continue
        checker.check(not result.report["jumps"], f"{case}: {result.report['jumps'][:1]}")
        # a loop of gain A and a pole is off by 2/A and by how far a sine gets in 2 pole/A
        near = (float(tolerance or 1e-6) + 4 / gain + 8 * hertz * 6.3 * pole / gain) * volts
        source = [result.column("v(in)")[k] for k in range(20)]
        for k, v in enumerate(result.column("v(a)")):
            checker.close(v, max(0.0, -source[k]), near, f"{case}: v(a) at {times[k]} s, {ohms} ohm")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
