#!/usr/bin/env python3
"""A diode's model with Vrev=0 and Vfwd=0: what conducts both ways alike, within its limits, against the closed form.

usage: both_ways.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

# parameters; on the card; ohm of the load, V, Hz; what the diode is: ohm, and the largest currents
CASES = (
    ("Ron=10 Vrev=0", "", 90, 3, 50, 10, math.inf, math.inf),
    ("Ron=10 Vrev=0 Ilimit=45m revIlimit=45m", "", 10, 3, 50, 10, 45e-3, 45e-3),
    ("Ron=10 Vrev=0 Ilimit=45m revIlimit=30m", "", 10, 3, 1e6, 10, 45e-3, 30e-3),
    ("Ron=10 Vrev=0 revIlimit=30m", "", 10, 3, 50, 10, math.inf, 30e-3),
    ("Ron=2k Rrev=2k Vrev=0 Ilimit=1u revIlimit=2u", "", 1e6, 10, 1e3, 2e3, 1e-6, 2e-6),
    ("Ron=1m Vrev=0 Ilimit=100 revIlimit=100", "", 0.01, 325, 50, 1e-3, 100, 100),
    ("Ron=30 Roff=60 Vrev=0", "", 80, 1, 50, 20, math.inf, math.inf),
    ("Ron=10 Vrev=0 Ilimit=45m revIlimit=30m", "m=2", 5, 3, 50, 5, 90e-3, 60e-3),
    ("Ron=10 Vrev=0", "n=3", 70, 3, 50, 30, math.inf, math.inf),
    ("Ron=0 Vrev=0 Ilimit=1 revIlimit=1", "", 4, 10, 50, 0, 1, 1),
)


# ohms; V forwards and backwards, ohms of both branches, volts of the source
LIMITERS = ((1e3, 1.2, -0.3, 10, 20, 3), (50, 0.85, -0.3, 1, 1, 10), (1e5, 12, -5, 1e3, 0, 40), (2, 400, -300, 0.1, 0.2, 1e3),
            (10, 3e-3, -1e-3, 1, 2, 0.1))


def limiters(checker, program):
    """Vrev below 0: in LTspice's macromodels a diode holds a voltage between -Vrev and Vfwd, both above 0. Rows of a ramp against
    the closed form, and every one against the diode turned around, whose knees are the other way."""
    for load, forward, back, ron, rrev, volts in LIMITERS:
        parameters = f"Ron={ron} Vfwd={forward} Vrev={back} Rrev={rrev}"
        turned = f"Ron={rrev} Vfwd={back} Vrev={forward} Rrev={ron}"
        result = run(program, f"{parameters}\nv1 in 0 pwl(0 {-volts} 1m {volts})\nr1 in a {load}\nd1 a 0 lim\nr2 in b {load}\nd2 0 b mil\n"
                     f".model lim D({parameters})\n.model mil D({turned})\n.tran 7u 1m\n.end\n", method=None)
        if not checker.check(result.status == 0 and "conducts backwards below that" in result.stderr,
                             f"{parameters}: {result.status}\n{result.stderr}"):
            continue
        worst = 0.0
        for v, a, b in zip(result.column("v(in)"), result.column("v(a)"), result.column("v(b)")):
            held = v
            if v > forward:
                held = forward + (v - forward) * ron / (ron + load)
            elif v < -back:
                held = -back + (v + back) * rrev / (rrev + load)
            worst = max(worst, abs(a - held), abs(b - held))
        checker.check(worst < 1e-9 * volts, f"{parameters}: off by {worst} V")


def main():
    program = sys.argv[1]
    checker = Checker("both ways")
    for parameters, on_card, load, volts, hertz, ohms, most, least in CASES:
        name = f"{parameters} {on_card}"
        result = run(program, f"{name}\nv1 a 0 sin(0 {volts} {hertz})\nd1 a b lim {on_card}\nr1 b 0 {load}\n"
                     f".model lim D({parameters})\n.tran {0.01 / hertz} {1.7 / hertz}\n.backanno\n.end\n", method=None)
        if not checker.check(result.status == 0, f"{name}: {result.status}\n{result.stderr}"):
            continue
        rows = list(zip(result.column("v(a)"), result.column("i(d1)"), result.column("v(b)")))
        size = max(abs(i) for _, i, _ in rows)
        worst = max(abs(i - min(max(v / (ohms + load), -least), most)) for v, i, _ in rows)
        checker.check(worst < 1e-9 * size, f"{name}: i(d1) is off by {worst / size:.2g}")
        worst = max(abs(b - load * i) for _, i, b in rows)
        checker.check(worst < 1e-9 * size * load, f"{name}: v(b) is off by {worst} V")
    for wrong in ("Ron=10 Vrev=0 Vfwd=0.6", "Ron=10 Rrev=20 Vrev=0", "Ron=1 Vrev=0 Epsilon=0.1", "Ron=1 Vrev=-1"):
        result = run(program, f"wrong\nv1 a 0 1\nd1 a 0 lim\n.model lim D({wrong})\n.op\n.end\n", method=None)
        checker.check(result.status == 3 and "Vrev must be positive" in result.stderr, f"{wrong}: {result.stderr}")
    limiters(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
