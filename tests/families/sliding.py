#!/usr/bin/env python3
"""A switch that opens what closes it, in a converter whose coil a diode takes over, without hysteresis.

usage: sliding.py PROGRAM

At the current that the switch asks for it would open and close without end; what is left is that
current, without a ripple (Filippov 1988, chapter 2). Nothing jumps: a diode is there, and the coil's current may not
be lost.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

CURRENT = 0.5

NETLIST = """a buck converter whose switch opens at {current} A
Vin in 0 5
S1 in sw c 0 SWM
.model SWM SW(VT=0.5 RON=0.1{more})
D1 0 sw DI
.model DI D
L1 sw out 10u
Rs out o2 0.1
Vo o2 0 2
Bc c 0 V=1-10*v(out,o2)
.tran 0.1u 100u uic
"""


def main():
    checker = Checker("sliding")
    for more in "", " ROFF=1Meg":
        for tolerance in "1e-4", "1e-6", "1e-9":
            what = f"Roff{more or ' none'}, tol {tolerance}"
            r = run(sys.argv[1], NETLIST.format(current=CURRENT, more=more),
                    options=["--method", "auto", "--tol", tolerance])
            if not checker.check(r.status == 0, f"{what}: {r.stderr}"):
                continue
            late = [i for t, i in zip(r.time, r.column("i(l1)")) if t > 10e-6]
            checker.close(max(late), CURRENT, 1e-4 * CURRENT, f"{what}: the largest current")
            checker.close(min(late), CURRENT, 1e-4 * CURRENT, f"{what}: the smallest current")
            checker.close(sum(late) / len(late), CURRENT, 1e-4 * CURRENT, f"{what}: its mean")
            checker.check(r.report["jumps"] == [], f"{what}: {len(r.report['jumps'])} jumps")
            checker.check("Vh=" in r.stderr, f"{what}: nobody says what would help: {r.stderr}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
