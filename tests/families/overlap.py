#!/usr/bin/env python3
"""A voltage multiplier in which two diodes conduct together for nanoseconds out of 0.26 s.

usage: overlap.py PROGRAM

Behind diodes of 13 mohm capacitors of 100 nF settle within a nanosecond. Where one diode takes over from the
other, both carry something for a few of these, which micro-steps pass over: the diode that ends must do so once.
The number of events of each is that of an exact solution from event to event in 230 digits.
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
EXACT = {"d1": 26, "d2": 26, "d3": 26, "d4": 30}
TOLERANCES = 1e-6, 1e-7, 1e-8, 1e-9


def main():
    program = sys.argv[1]
    checker = Checker("overlap")
    for tolerance in TOLERANCES:
        result = run(program, NETLIST, method=None, tolerance=tolerance)
        if checker.check(result.status == 0, f"{tolerance}: {result.stderr}"):
            elements = [event["element"] for event in result.report["events"] if event["time"] > 0]
            found = {element: elements.count(element) for element in EXACT}
            checker.check(found == EXACT, f"{tolerance}: events {found}, not {EXACT}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
