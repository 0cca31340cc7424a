#!/usr/bin/env python3
"""Circuits that have a solution and were refused: ratios of 1e4 and more between what is in series.

usage: solvable.py PROGRAM

A coil next to a large resistor or a large coil, against closed forms, and thyristors on coils with stray
capacitances, of which the last one is cut off: condensed, KCL loses the digits that the certificate asks for,
and a ray was taken for a proof that there is no solution.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

COIL_AND_RESISTOR = """V SIN, 10 nH and 1 Mohm: the coil is a wire
V1 z 0 SIN(0 15 1000)
L1 z a 10n
R1 a 0 1meg
.tran 6u 3m uic
"""

TWO_COILS = """70 V divided by coils of 1 uH and 40 mH
V1 z 0 70
L1 z a 1u
L2 a 0 40m
.tran 10u 5m uic
"""


CYCLOCONVERTER = """a cycloconverter with one thyristor fired at 10 ms and cut off at 17 ms
Vb b 0 SIN(0 92 50 0 0 -120)
Vc dsc 0 SIN(0 90 50 0 0 -240)
Lsc dsc c 0.0001
Spa a ipa gpa 0 sw
Dpa ipa o dm
Rqpa ipa o 53
Vggpb gpb 0 PWL(0 0 0.01 0 0.01 1 0.017 1 0.017 0)
Spb b ipb gpb 0 sw
Dpb ipb o dm
Rqpb ipb qpb 20
Dnb inb b dm
Cqnb qnb b 3e-10
Rqnb inb qnb 9
Spc c qpc gpc 0 sw
Cqpc qpc o 3e-09
Snc o inc gnc 0 sw
Dnc inc c dm
Rqnc inc qnc 3
Ll o 0 0.14
.model sw SW(VT=0.5 VH=0)
.model dm D(Ron=0.2 Roff=2e+05)
.tran 4.096e-05 0.02048
"""


def main():
    program = sys.argv[1]
    checker = Checker("solvable")
    for tolerance in "1e-6", "1e-9":
        options = {"method": "auto", "tolerance": float(tolerance)}
        r = run(program, COIL_AND_RESISTOR, **options)
        if checker.check(r.status == 0, f"coil and resistor: {r.stderr}"):
            for t, v in zip(r.time, r.column("v(a)")):
                if t > 0:
                    checker.close(v, 15 * math.sin(2e3 * math.pi * t), 15 * options["tolerance"], f"v(a) at {t}")
        r = run(program, TWO_COILS, **options)
        if checker.check(r.status == 0, f"two coils: {r.stderr}"):
            rate = 70 / 40.001e-3
            for t, i in zip(r.time, r.column("i(l2)")):
                checker.close(i, rate * t, rate * 5e-3 * options["tolerance"], f"i(l2) at {t}")
        r = run(program, CYCLOCONVERTER, **options)
        checker.check(r.status == 0, f"cycloconverter: {r.stderr}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
