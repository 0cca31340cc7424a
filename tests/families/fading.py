#!/usr/bin/env python3
"""Diodes whose currents fade away and never end, in steps that get longer all the while.

usage: fading.py PROGRAM

Capacitors equalise through diodes and resistors: each current is a sum of falling exponentials, positive for
ever, and after t = 0 nothing happens. A step that lasts for many time constants follows them within what it
may be off by, but not with the right sign.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

TOLERANCES = [10.0 ** -k for k in range(3, 11)]
TWO = "c1 a 0 1u ic=10\nr1 a b 1k\nd1 b c\nc2 c 0 {}\n"
BESIDE = ("r1 k1 n1 9.6k\nc1 n1 n2 600n ic=8.5\nc2 n2 0 200n ic=-7.6\nd1 0 k1\nr2 n2 m1 3.6k\nr3 m1 m2 380\n"
          "c3 m2 m3 190n ic=-8.1\nr4 m3 0 1.9k\nd2 m3 0\n")
CIRCUITS = {**{f"two, {c} F": TWO.format(c) for c in ("100n", "1u", "7u")}, "beside a resistor": BESIDE}
STOPS = "8m", "17m", "40m"


def main():
    program = sys.argv[1]
    checker = Checker("fading")
    for name, cards in CIRCUITS.items():
        for stop in STOPS:
            for tolerance in some_of(TOLERANCES):
                case = f"{name}, {stop}, {tolerance}"
                netlist = f"fading\n{cards}.tran 10u {stop} uic\n.end\n"
                result = run(program, netlist, method=None, tolerance=tolerance)
                if checker.check(result.status == 0, f"{case}: {result.stderr}"):
                    late = [event for event in result.report["events"] if event["time"] > 0]
                    checker.check(not late, f"{case}: {len(late)} events, the first at {late[:1]}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
