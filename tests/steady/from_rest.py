#!/usr/bin/env python3
"""Loops with an amplifier whose operating point is kilovolts away, and steps of Newton's method that go in a circle.

In the operating point no switch moves, and the amplifier has its gain times the error at its output. The orbit that is found
then is that of .pss uic. In discontinuous conduction between two limits of the duty cycle steps lead from
one limit to the other and back.

usage: from_rest.py PROGRAM
"""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

NEAR = 1e-9

LOOP = """{name}
Vin in 0 {vin}
Vref ref 0 {ref}
Vtri tri 0 PULSE(0 2 0 {t} 0 0 {t})
B1 lim 0 V=limit(v(ctl),0.02,{most})
E1 cmp 0 lim tri 1
{power}
C1 out e {c}
Re e 0 {esr}
R9 out 0 {r}
Eo o 0 ref inv {gain}
Ro o ctl 100
R1 out inv 10k
R2 inv z {r2}
C2 z ctl {c2}
Cp inv ctl {cp}
{third}
.model sz SW(Ron=10m Vt=0)
.save v(out)
{analysis}
.end
"""

BUCK = "S1 in sw cmp 0 sz\nD1 0 sw\nL1 sw out {}"
LOSSY = "S1 in sw cmp 0 sz\nD1 0 sw\nL1 sw x 22u\nRl x out 20m"
FLYBACK = ("L1 in sw {}\nS1 sw 0 cmp 0 sz\nL2 0 s 10u\nK1 L1 L2 0.999\nRs in sn 1k\nCs sn sw 100p\n"
           "D1 s out")

# From the operating point.
LOOPS = [
    {"name": "buck, heavy", "vin": 12, "ref": 5, "t": 10e-6, "most": 1.9, "power": BUCK.format("42u"), "c": "54u", "r": 1.7,
     "gain": 1e4, "r2": 1e3, "c2": "96n", "cp": "1.9n"},
    {"name": "buck, 48 V", "vin": 48, "ref": 12, "t": 20e-6, "most": 1.9, "power": BUCK.format("200u"), "c": "50u", "r": 4,
     "gain": 1e5, "r2": 1e3, "c2": "200n", "cp": "4n"},
    {"name": "buck, 5 V", "vin": 5, "ref": 1.2, "t": 1e-6, "most": 1.9, "power": BUCK.format("1u"), "c": "125u", "r": 0.4,
     "gain": 1e5, "r2": 1e3, "c2": "20n", "cp": "400p"},
    {"name": "buck, type 3", "vin": 5, "ref": 1.2, "t": 1e-6, "most": 1.9, "power": BUCK.format("1u"), "c": "125u", "r": 24,
     "gain": 1e4, "r2": 1e3, "c2": "71n", "cp": "1.4n", "r3": 500, "c3": "1.2n"},
    {"name": "flyback", "vin": 48, "ref": 12, "t": 1e-6, "most": 1.6, "power": FLYBACK.format("40u"), "c": "37u", "r": 4,
     "gain": 1e4, "r2": 200, "c2": "1.2u", "cp": "25n"},
]

LEADS = "L1 in lw {}\nRl lw sw 60m\nS1 sw 0 cmp 0 sz\n"

# The same; from the operating point the control runs to the limit of its duty cycle, where losses keep the output below the
# reference, and stays there.
HELD = [
    {"name": "boost, held at its limit", "vin": 12, "ref": 30, "t": 10e-6, "most": 1.8, "power": LEADS.format("47u") + "D1 sw out",
     "c": "200u", "r": 7.5, "gain": 1e5, "r2": 40, "c2": "10u", "cp": "100n"},
    {"name": "boost, held, 5 V", "vin": 5, "ref": 12, "t": 2e-6, "most": 1.86, "power": LEADS.format("10u") + "D1 sw out",
     "c": "100u", "r": 12, "gain": 1e5, "r2": 40, "c2": "5u", "cp": "50n"},
    {"name": "sepic, held", "vin": 12, "ref": 15, "t": 10e-6, "most": 1.8,
     "power": LEADS.format("47u") + "Cs sw b 22u\nRx sw bx 2\nCx bx b 100u\nL2 b b2 47u\nRb b2 0 60m\nD1 b out",
     "c": "200u", "r": 4, "gain": 1e5, "r2": 40, "c2": "20u", "cp": "200n"},
    {"name": "flyback, held", "vin": 12, "ref": 20, "t": 10e-6, "most": 1.8,
     "power": LEADS.format("24u") + "L2 0 s 96u\nK1 L1 L2 0.998\nRs lw sn 2k\nCs sn sw 220p\nD1 s out",
     "c": "200u", "r": 5, "gain": 1e5, "r2": 40, "c2": "20u", "cp": "200n"},
]

# .pss uic, and the most Newton steps and periods of it.
CIRCLES = [
    ({"name": "discontinuous, type 3", "vin": 12, "ref": 5, "t": 10e-6, "most": 1.9, "power": LOSSY, "c": "100u",
      "esr": 0.06, "r": 100, "gain": 1e4, "r2": "22k", "c2": "4.7n", "cp": "150p", "r3": 300, "c3": "2.2n"}, 40, 120),
]


def netlist(values, analysis):
    third = f"R3 out y {values['r3']}\nC3 y inv {values['c3']}" if "r3" in values else ""
    return LOOP.format(**{"esr": 0.02, **values}, third=third, analysis=analysis)


def main():
    checker = Checker("from_rest")
    for values in LOOPS + HELD:
        rest = run(sys.argv[1], netlist(values, ".pss uic"), method=None)
        point = run(sys.argv[1], netlist(values, ".pss"), method=None)
        if not checker.check(rest.status == point.status == 0,
                             f"{values['name']}: {rest.status}, {point.status}\n{rest.stderr}\n{point.stderr}"):
            continue
        found, other = (done.report["steady"]["states"] for done in (point, rest))
        for state, value in found.items():
            away = abs(value - other[state])
            checker.check(away <= NEAR * max(1, abs(value)), f"{values['name']}: {state} is off by {away:.2g}")
        mean = point.report["steady"]["signals"]["v(out)"]["average"]
        checker.check(abs(mean - values["ref"]) <= 20 / values["gain"], f"{values['name']}: {mean} V")
    for values, steps, periods in CIRCLES:
        done = run(sys.argv[1], netlist(values, ".pss uic"), method=None)
        if checker.check(done.status == 0, f"{values['name']}: {done.stderr}"):
            steady = done.report["steady"]
            checker.check(steady["newton"] <= steps and steady["periods"] <= periods,
                          f"{values['name']}: {steady['newton']} steps, {steady['periods']} periods")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
