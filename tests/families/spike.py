#!/usr/bin/env python3
"""A voltage multiplier of milliohms whose source starts far from 0: a spike of 1e4 A, and milliamperes ever after.

usage: spike.py PROGRAM

Errors of voltages across 13 mohm are amperes where a diode begins to conduct, and die away within nanoseconds.
Those, and the spike, must not hide from then on that a diode's current of a microampere has the wrong sign: all
voltages are those of a run with a far smaller tolerance, over their own largest values, and so are the times of
all events.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import overlap  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402

NETLIST = overlap.NETLIST.replace("overlap", "spike").replace("sin(0 63 50)",
                                                              "sin(26.96 63 50 0 0 45)")
STOP, ROWS = 260e-3, 500
TOLERANCES = 1e-5, 1e-6, 1e-7, 1e-8
SIGNALS = "v(a1)", "v(b1)", "v(a2)", "v(b2)"


def events(result):
    """By element and side, in order: diodes may change sides in the same moment."""
    return sorted((event["element"], event["state"], event["time"]) for event in result.report["events"])


def main():
    program = sys.argv[1]
    checker = Checker("spike")
    at = [STOP * (k + 0.618034) / ROWS for k in range(ROWS)]
    exact = run(program, NETLIST, at=at, method=None, tolerance=1e-10)
    for tolerance in some_of(TOLERANCES):
        result = run(program, NETLIST, at=at, method=None, tolerance=tolerance)
        if not checker.check(result.status == 0 == exact.status, f"{tolerance}: {result.stderr}"):
            continue
        checker.check(result.report["work"]["euler_steps"] == 0, f"{tolerance}: steps of implicit Euler")
        found, wanted = events(result), events(exact)
        if checker.check(len(found) == len(wanted), f"{tolerance}: {len(found)} events, not {len(wanted)}"):
            late = max(abs(a[2] - b[2]) for a, b in zip(found, wanted))
            checker.check(late <= 10 * tolerance * STOP, f"{tolerance}: events are off by {late:.1e} s")
        for signal in SIGNALS:
            column = exact.column(signal)
            error = max(abs(a - b) for a, b in zip(result.column(signal), column)) / max(map(abs, column))
            checker.check(error <= tolerance, f"{tolerance}: {signal} is off by {error:.1e}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
