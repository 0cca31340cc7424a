#!/usr/bin/env python3
"""Continuous piecewise-linear sources that ngspice and dalcs both read as they are: the same signals,
within what ngspice's tolerances leave.

usage: functions_against_ngspice.py PROGRAM TOOLS
"""

import bisect
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, sys.argv[2])
import ngspice_batch  # noqa: E402
from dalcs_program import Checker, run  # noqa: E402

SKIPPED = 77  # what meson takes for "skipped"

FUNCTIONS = """functions of voltages
V1 a 0 SIN(0 3 1k)
V2 b 0 SIN(0.5 2 700)
R1 a 0 10
R2 b 0 4
B1 o1 0 V=abs(v(a)) - 0.5*v(b)
B2 o2 0 V=max(v(a),v(b)) + min(v(a),1)
B3 o3 0 V=uramp(v(a)-1) + u2(v(b))
B4 0 o4 I=max(min(2*v(a,b),4),-3)
R4 o4 0 1
B5 o5 0 V=pwl(v(a), -2,-1, -1,0.5, 0,0, 1,1.5, 2,4)
B6 o6 0 V=v(a) > 1 ? 2*v(a)-1 : v(a)
E7 o7 0 VALUE={max(abs(v(a)), abs(v(b))) - 2*i(V1)}
E8 o8 0 TABLE {v(a)} = (-2,-1) (-1,0.5) (0,0) (1,1.5) (2,4)
B9 o9 0 V=sin(6283.185307179586*time)*cos(1000*time) + 500*time
B10 o10 0 V=max(v(a), min(v(b), abs(v(a)-v(b)) - 1))
.tran 2u 5m 0 0.2u
.end
"""

FEEDBACK = """an op-amp with rails, an inductor with friction and a saturating current
V1 in 0 SIN(0 5 1k)
R1 in n 1k
R2 n out 3k
C2 n 0 1n
B1 out 0 V=max(-10,min(10,-1e4*v(n)))
L1 in x 1m
R3 x y 10
B2 y 0 V=max(-2,min(2,50*i(L1)))
B3 z 0 I=max(-1m,min(1m,v(z)/1k)) - 2m*sin(6283.185307179586*time)
C3 z 0 0.2u
.tran 1u 4m 0 0.1u
.end
"""


def at(times, values, t):
    """Between two points."""
    k = min(max(bisect.bisect_left(times, t), 1), len(times) - 1)
    part = (t - times[k - 1]) / (times[k] - times[k - 1])
    return values[k - 1] + part * (values[k] - values[k - 1])


def compare(checker, program, netlist, signals, stop, tolerance):
    title = netlist.splitlines()[0]
    # not between the rows of .tran, where ngspice's own steps are longer than what happens
    ours = run(program, netlist, method=None, options=["--fill", "none"])
    if not checker.check(ours.status == 0, f"{title}: {ours.stderr}"):
        return
    with tempfile.TemporaryDirectory() as folder:
        theirs = ngspice_batch.run(netlist, pathlib.Path(folder), stop, 120)
    if not checker.check(theirs.table is not None, f"{title}: ngspice: {theirs.reason}"):
        return
    times = theirs.table.column("time")
    for signal in signals:
        values = theirs.table.signal(signal)
        scale = max(abs(value) for value in values)
        worst = max(abs(x - at(times, values, t)) / scale
                    for t, x in zip(ours.time, ours.column(signal)))
        checker.check(worst <= tolerance, f"{title}: {signal} is off by {worst:.2e} of its scale")


def main():
    checker = Checker("functions_against_ngspice")
    program = sys.argv[1]
    try:
        compare(checker, program, FUNCTIONS, [f"v(o{k})" for k in (1, 2, 3, 4, 5, 6, 7, 9, 10)],
                5e-3, 1e-3)
        # ngspice rounds the corners of a TABLE by a hundredth of its range.
        compare(checker, program, FUNCTIONS, ["v(o8)"], 5e-3, 2e-2)
        compare(checker, program, FEEDBACK, ["v(n)", "v(y)", "i(l1)", "v(z)"], 4e-3, 2e-3)
        # Behind a gain of 1e4 an error of v(n) is as many times larger.
        compare(checker, program, FEEDBACK, ["v(out)"], 4e-3, 5e-3)
    except ngspice_batch.NoNgspice:
        print("ngspice is not installed")
        return SKIPPED
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
