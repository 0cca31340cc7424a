#!/usr/bin/env python3
"""Diodes whose voltage comes up to 0 at each peak of a sine, and no farther.

usage: touching.py PROGRAM

Without a load a capacitor is charged once, and from then on each peak touches what it was charged to. Whether an
error leaves it a little above or below, nothing happens: the diode has opened once.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

CIRCUITS = {
    "peak detector": ("V1 in 0 SIN(0 10 50)\nD1 in out\nC1 out 0 10u\n", 5e-3, 1.0),
    "clamp": ("V1 in 0 SIN(0 10 50)\nC1 in out 10u\nD1 out 0\n", 5e-3, 1.0),
    "divider": ("V1 in 0 SIN(0 3.1 100k)\nC1 in m 2.786n\nC2 m 0 2.857n\nD1 m 0\n", 2.5e-6, 2e-3),
}
TOLERANCES = [f"1e-{k}" for k in range(3, 11)]


def main():
    program = sys.argv[1]
    checker = Checker("touching")
    for name, (circuit, opens, stop) in CIRCUITS.items():
        for tolerance in some_of(TOLERANCES):
            result = run(program, f"{name}\n{circuit}.tran {stop / 1e3} {stop} uic\n.end\n", method=None,
                         tolerance=tolerance)
            case = f"{name}, {tolerance}"
            if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
                continue
            events = result.report["events"]
            checker.check(len(events) == 1, f"{case}: {len(events)} events")
            checker.check(abs(events[0]["time"] - opens) <= 1e-6 * stop, f"{case}: at {events[0]['time']}")
            checker.check(result.report["work"]["euler_steps"] == 0, f"{case}: steps of Euler")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
