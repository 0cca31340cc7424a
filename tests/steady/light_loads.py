#!/usr/bin/env python3
"""Loops whose duty cycle goes to and fro between its limits on the way, most of them at light loads.

usage: light_loads.py PROGRAM

A run of them takes thousands of periods, and steps of Newton's method lead from one limit to the other. The mean of the output
is the reference, as the integrator has no mean input, but for what the amplifier's gain leaves. Both starts lead there.
"""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import from_rest  # noqa: E402
from dalcs_program import Checker, run  # noqa: E402

MOST_STEPS, MOST_PERIODS = 80, 200  # of .pss uic
MOST_FROM_THE_POINT = 900  # periods, those of a search that finds nothing from there among them

BOOST = "L1 in sw {}\nS1 sw 0 cmp 0 sz\nD1 sw out"
SEPIC = "L1 in a {0}\nS1 a 0 cmp 0 sz\nCs a b 4.7u\nRx a bx 5\nCx bx b 22u\nL2 b 0 {0}\nD1 b out"
FLYBACK = "L1 in sw 12u\nS1 sw 0 cmp 0 sz\nL2 0 s 3u\nK1 L1 L2 0.999\nRs in sn 1k\nCs sn sw 100p\nD1 s out"
ZETA = "S1 in a cmp 0 sz\nL1 a 0 {0}\nCs a b 10u\nD1 0 b\nL2 b out {0}"

LOOPS = [
    {"name": "boost, light", "vin": 12, "ref": 24, "t": 2e-6, "most": 1.6, "power": BOOST.format("24u"), "c": "37.5u",
     "r": 480, "gain": 1e5, "r2": 200, "c2": "1.5u", "cp": "30n"},
    {"name": "boost, 5 V, light", "vin": 5, "ref": 12, "t": 10e-6, "most": 1.6, "power": BOOST.format("60u"), "c": "375u",
     "r": 240, "gain": 1e4, "r2": 200, "c2": "7.5u", "cp": "150n"},
    {"name": "boost, type 3, light", "vin": 5, "ref": 12, "t": 10e-6, "most": 1.6, "power": BOOST.format("60u"), "c": "375u",
     "r": 240, "gain": 1e4, "r2": 200, "c2": "7.5u", "cp": "150n", "r3": 500, "c3": "15n"},
    {"name": "boost, type 3", "vin": 5, "ref": 12, "t": 20e-6, "most": 1.6, "power": BOOST.format("120u"), "c": "750u",
     "r": 4, "gain": 1e5, "r2": 200, "c2": "15u", "cp": "300n", "r3": 500, "c3": "30n"},
    {"name": "buck, light", "vin": 48, "ref": 12, "t": 2e-6, "most": 1.9, "power": from_rest.BUCK.format("20u"), "c": "75u",
     "r": 240, "gain": 1e4, "r2": 1e3, "c2": "78n", "cp": "1.6n"},
    {"name": "SEPIC, light", "vin": 12, "ref": 12, "t": 2e-6, "most": 1.6, "power": SEPIC.format("12u"), "c": "75u",
     "r": 240, "gain": 1e4, "r2": 200, "c2": "1.5u", "cp": "30n"},
    {"name": "zeta, light", "vin": 12, "ref": 9, "t": 2e-6, "most": 1.6, "power": ZETA.format("9u"), "c": "100u",
     "r": 180, "gain": 1e4, "r2": 200, "c2": "1.5u", "cp": "30n"},
    {"name": "flyback, light", "vin": 48, "ref": 12, "t": 2e-6, "most": 1.6, "power": FLYBACK,
     "c": "75u", "r": 240, "gain": 1e5, "r2": 200, "c2": "1.5u", "cp": "30n"},
]


def main():
    checker = Checker("light_loads")
    for values in LOOPS:
        starts = [run(sys.argv[1], from_rest.netlist(values, analysis), method=None) for analysis in (".pss uic", ".pss")]
        if not checker.check(all(done.status == 0 for done in starts), f"{values['name']}: {starts[0].stderr}{starts[1].stderr}"):
            continue
        rest, point = (done.report["steady"] for done in starts)
        checker.check(rest["newton"] <= MOST_STEPS and rest["periods"] <= MOST_PERIODS,
                      f"{values['name']}: {rest['newton']} steps, {rest['periods']} periods")
        checker.check(point["periods"] <= MOST_FROM_THE_POINT, f"{values['name']}, from the point: {point['periods']} periods")
        for state, value in rest["states"].items():
            away = abs(value - point["states"][state])
            checker.check(away <= from_rest.NEAR * max(1, abs(value)), f"{values['name']}: {state} is off by {away:.2g}")
        mean = rest["signals"]["v(out)"]["average"]
        checker.check(abs(mean - values["ref"]) <= 20 / values["gain"], f"{values['name']}: {mean} V")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
