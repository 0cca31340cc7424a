#!/usr/bin/env python3
"""Circuits in which one diode takes over from another, and how often each does.

usage: overlap.py PROGRAM

In voltage multipliers with diodes of milliohms capacitors of 100 nF settle within a nanosecond, and both diodes
carry something for a few of these, which micro-steps pass over: the diode that ends must do so once. In the second
one an error of a microvolt is 29 uA where a diode begins, a hundredth of its largest current, and backwards. In a
resonant converter that starts the next pair closes behind the last one in some periods, and later in others: what
followed the last time is no reason for a pulse of picoseconds. The number of events of each is that of an exact
solution from event to event in 230 digits.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

NETLIST = """overlap
v1 ac 0 sin(0 63 50)
c1 ac a1 103.2n
c2 0 b1 120n
d1 0 a1 di
d2 a1 b1 di
c3 a1 a2 168n
c4 b1 b2 69.6n
d3 b1 a2 di
d4 a2 b2 di
r1 b2 0 11.67meg
.model di d(ron=13m roff=1.8meg vfwd=0.7 vrev=120)
.tran 260u 260m uic
.end
"""
BACKWARDS = """backwards
v1 ac 0 sin(0 79 60)
c1 ac a1 100n
c2 0 b1 160n
d1 0 a1 di
d2 a1 b1 di
c3 a1 a2 130n
c4 b1 b2 100n
d3 b1 a2 di
d4 a2 b2 di
r1 b2 0 1.967meg
.model di d(ron=32m roff=620k vfwd=0.7 vrev=52)
.tran 183.3u 183.3m uic
.end
"""
RESONANT = """resonant
vin in 0 400
vg1 g1 0 pulse(0 1 0 20n 20n 4.64u 10u)
vg2 g2 0 pulse(0 1 5u 20n 20n 4.64u 10u)
s1 in h g1 0 sm
s2 h 0 g2 0 sm
d1 h in di
d2 0 h di
l1 h x 59u
l2 x y 260u
c1 y 0 70.2n
l3 s1 s2 259.7u
k1 l2 l3 1
d3 s1 o di
d4 s2 o di
d5 0 s1 di
d6 0 s2 di
c2 o 0 277.9n ic=200
r1 o 0 194.3
.model sm sw(ron=11m vt=0.5 vh=0)
.model di d(ron=0 vfwd=0)
.tran 210n 210u uic
.end
"""
CASES = (
    (NETLIST, {"d1": 26, "d2": 26, "d3": 26, "d4": 30}, (1e-6, 1e-7, 1e-8, 1e-9)),
    (BACKWARDS, {"d1": 43, "d2": 24, "d3": 22, "d4": 32}, (1e-3, 1e-4, 1e-5, 1e-6)),
    (RESONANT, {"d1": 41, "d2": 42, "d3": 41, "d4": 38, "d5": 38, "d6": 41}, (1e-4, 1e-5, 1e-6, 1e-7)),
)


def main():
    program = sys.argv[1]
    checker = Checker("overlap")
    for netlist, exact, tolerances in CASES:
        for tolerance in tolerances:
            case = f"{netlist.splitlines()[0]}, {tolerance}"
            result = run(program, netlist, method=None, tolerance=tolerance)
            if checker.check(result.status == 0, f"{case}: {result.stderr}"):
                checker.check("wrong sign" not in result.stderr, f"{case}: {result.stderr}")
                elements = [event["element"] for event in result.report["events"] if event["time"] > 0]
                found = {element: elements.count(element) for element in exact}
                checker.check(found == exact, f"{case}: events {found}, not {exact}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
