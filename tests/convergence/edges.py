#!/usr/bin/env python3
"""Edges of zero width: landed on exactly, with one row for each side. Slopes count in the first row,
and the stop time is the last one.

usage: edges.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

NETLIST = """A square wave on a divider and on an RC
V1 in 0 PULSE(0 6 1m 0 0 1m 3m)
R1 in mid 1k
R2 mid 0 2k
D1 mid 0 DI
R3 in out 1k
C1 out 0 1u
V2 low 0 PULSE(0 -3 1m 0 0 1m 3m)
D2 low x DI
R4 x 0 1k
.model DI D
.tran 100u 8m uic
.end
"""
SLOPE = """A sine on a capacitor
V1 in 0 SIN(0 1 50)
C1 in 0 1m
R1 in 0 1
.tran 0.3m 1m uic
.end
"""
EDGES = [1e-3, 2e-3, 4e-3, 5e-3, 7e-3, 8e-3]  # up, down, up, ...
TAU = 1e-3


def sides(result, edge):
    """The rows at an edge, as indices."""
    return [k for k, t in enumerate(result.time) if abs(t - edge) <= 1e-14]


def main():
    checker = Checker("edges")
    for step in (1e-4, 0.3e-3, 0.7e-4):
        result = run(sys.argv[1], NETLIST, step=step)
        if not checker.check(result.status == 0, f"exit {result.status}: {result.stderr}"):
            continue
        time, source, out = result.time, result.column("v(in)"), result.column("v(out)")
        current, reverse = result.column("i(d1)"), result.column("v(low)")
        checker.check(all(a <= b for a, b in zip(time, time[1:])), "times do not ascend")
        checker.check(abs(time[-1] - 8e-3) <= 1e-14, f"the last time is {time[-1]}")
        for number, edge in enumerate(EDGES[:-1]):
            rows = sides(result, edge)
            if not checker.check(len(rows) == 2 and time[rows[0]] == time[rows[1]],
                                 f"rows at {edge} with step {step}: {[time[k] for k in rows]}"):
                continue
            left, right = rows
            before, after = (0, 6) if number % 2 == 0 else (6, 0)
            checker.close(source[left], before, 1e-14, f"v(in) before {edge}")
            checker.close(source[right], after, 1e-14, f"v(in) after {edge}")
            checker.close(reverse[right], -after / 2, 1e-14, f"v(low) after {edge}")
            checker.close(current[left], before / 1e3, 1e-15, f"i(d1) before {edge}")
            checker.close(current[right], after / 1e3, 1e-15, f"i(d1) after {edge}")
            checker.close(out[right], out[left], 1e-11, f"v(out) across {edge}")
        doubled = sum(1 for a, b in zip(time, time[1:]) if a == b)
        checker.check(doubled <= len(EDGES), f"{doubled} double rows with step {step}")
        # Implicit Euler from row to row; a step that ends on an edge sees the value before it.
        v = out[0]
        if abs(step - 0.3e-3) < 1e-9 or abs(step - 0.7e-4) < 1e-9:  # one row per step
            for k in range(1, len(time)):
                span = time[k] - time[k - 1]
                v = (v + span / TAU * source[k]) / (1 + span / TAU)
                checker.close(out[k], v, 1e-11, f"v(out) at {time[k]} with step {step}")
    result = run(sys.argv[1], SLOPE, step=1e-4)
    if checker.check(result.status == 0, f"exit {result.status}: {result.stderr}"):
        # C dv/dt at 0+: the micro-step of 1e-10 s is off by its square.
        checker.close(result.column("i(v1)")[0], -1e-3 * 2 * math.pi * 50, 1e-12, "i(v1) at 0")
        checker.check([round(t, 9) for t in result.time] == [0, 3e-4, 6e-4, 9e-4, 1e-3],
                      f"rows at {result.time}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
