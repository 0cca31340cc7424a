#!/usr/bin/env python3
"""Dual active bridges whose switches have diodes in parallel: steps of Newton's method go in a circle, parts of them do not.

A current has half the resistance in one direction, and the resistance alone wears the magnetising current down, in up to
50 000 periods. The power is that of the closed form V1 V2 d (1 - d)/(2 f L), within what a dead time may add to the shift
and what the resistances take.

usage: to_and_fro.py PROGRAM
"""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

PERIOD, LEAKAGE, FIRST = 20e-6, 20e-6, 400.0
DEAD = 0.12e-6  # s, with the edges
LOST = 0.02

BRIDGES = """dual active bridge
V1 p 0 {first}
V2 s 0 {second}
X1 p a b g1 g2 bridge
X2 s c d g3 g4 bridge
L1 a x {leakage}
L2 x b {magnetising}
L3 c d {magnetising}
K1 L2 L3 1
V3 g1 0 PULSE(0 1 0 10n 10n 9.89u 20u)
V4 g2 0 PULSE(0 1 10u 10n 10n 9.89u 20u)
V5 g3 0 PULSE(0 1 {shift} 10n 10n 9.89u 20u)
V6 g4 0 PULSE(0 1 {{{shift}+10u}} 10n 10n 9.89u 20u)
.subckt bridge p a b g1 g2
S1 p a g1 0 sw
S2 a 0 g2 0 sw
S3 p b g2 0 sw
S4 b 0 g1 0 sw
D1 a p di
D2 0 a di
D3 b p di
D4 0 b di
.ends
.model sw SW Ron=10m Roff=10Meg Vt=0.5
.model di D Ron=10m Roff=10Meg
.save i(V2)
.pss 20u
.end
"""

CASES = [(shift, second, magnetising) for shift in (0.05, 0.15) for second in (300.0, 350.0)
         for magnetising in (2e-3, 20e-3)]
# Between voltages that are alike the current is small in the steady state, and no part of it is large elsewhere: a small
# defect in a period of small currents is not to look larger than a large one in a period of large ones.
CASES += [(shift, FIRST, 2e-3) for shift in (0.02, 0.05)]


def main():
    checker = Checker("to_and_fro")
    for shift, second, magnetising in CASES:
        name = f"{shift} of a period to {second} V, {magnetising} H"
        done = run(sys.argv[1], BRIDGES.format(first=FIRST, second=second, leakage=LEAKAGE,
                                               magnetising=magnetising, shift=shift * PERIOD),
                   method=None)
        if not checker.check(done.status == 0, f"{name}: status {done.status}\n{done.stderr}"):
            continue
        steady = done.report["steady"]
        checker.check(steady["periods"] <= 50, f"{name}: {steady['periods']} periods")
        d = 2 * shift
        most = FIRST * second * PERIOD / (2 * LEAKAGE)
        power = most * d * (1 - d)
        slack = most * (1 - 2 * d) * 2 * DEAD / PERIOD + LOST * power
        found = second * steady["signals"]["i(v2)"]["average"]
        checker.check(abs(found - power) < slack, f"{name}: {found} W, not {power} W")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
