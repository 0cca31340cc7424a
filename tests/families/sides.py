#!/usr/bin/env python3
"""Rows on both sides of an event: what does not jump is the same in both, what jumps is not.

usage: sides.py PROGRAM

A step's polynomials of currents are least exact where it begins, so that a diode that turns on would be printed with
a current below 0, as large as errors may be.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

BRIDGE = """a bridge into a capacitor: nothing jumps
v1 ac1 w sin(0 17 50)
rw w ac2 0.5
d1 ac1 out
d2 ac2 out
d3 0 ac1
d4 0 ac2
c1 out 0 1000u
r1 out 0 50
.tran 20u 100m uic
.save v(out) i(d1) i(d2) i(d3) i(d4)
.end
"""

# The switch adds 1 A to 1 kA, and takes it away.
SWITCH = """a small jump of a large current
v1 a 0 1k
r1 a 0 1
s1 a b g 0 sw
r2 b 0 1k
l1 a c 1
r3 c 0 1k
vg g 0 pulse(0 1 1m 1u 1u 2m 4m)
.model sw sw(ron=0 vt=0.5)
.tran 100u 8m
.save i(v1) v(a)
.end
"""
TOLERANCES = "1e-3", "1e-6", "1e-9"
ROUNDING = 1e-12


def pairs_of_rows(result):
    return [(left, right) for left, right in zip(result.rows, result.rows[1:]) if left[0] == right[0]]


def check_bridge(program, checker, tolerance):
    result = run(program, BRIDGE, method=None, tolerance=tolerance)
    pairs = pairs_of_rows(result)
    times = {event["time"] for event in result.report["events"]}
    checker.check(len(pairs) == len(times) > 8, f"bridge, {tolerance}: {len(pairs)} pairs of rows")
    largest = [max(abs(row[k]) for row in result.rows) for k in range(len(result.names))]
    for left, right in pairs:
        for k in range(1, len(result.names)):
            apart = abs(right[k] - left[k]) / largest[k]
            checker.check(apart <= ROUNDING, f"bridge, {tolerance}: {result.names[k]} jumps by {apart:.1e} "
                                             f"at {left[0]} s")
            least = right[k] / largest[k]
            checker.check(least >= -ROUNDING, f"bridge, {tolerance}: {result.names[k]} is {right[k]:.1e} "
                                              f"at {left[0]} s")


def check_switch(program, checker, tolerance):
    result = run(program, SWITCH, method=None, tolerance=tolerance)
    jumps = [abs(right[1] - left[1]) for left, right in pairs_of_rows(result) if left[0] > 0.0]
    seen = [jump for jump in jumps if jump > 0.0]
    checker.check(len(seen) == 4, f"switch, {tolerance}: jumps {jumps}")
    worst = max((abs(jump - 1.0) for jump in seen), default=0.0)
    checker.check(worst <= 1e-9, f"switch, {tolerance}: off by {worst:.1e}")


def stack(n, period, late):
    """Switches that open one after the other, with their snubbers and leaks, before a coil with a diode across it: as it
    conducts each opening changes its current by a thousandth. It blocked volts before, which is no scale of amperes."""
    cards = ["stack", "v1 a0 0 1.64"]
    for k in range(n):
        a, b = f"a{k}", f"a{k + 1}"
        cards += [f"vg{k} g{k} 0 pulse(0 1 {period * late * (k + 1)!r} 0 0 {0.5 * period!r} {period!r})", f"s{k} {a} {b} g{k} 0 sw",
                  f"d{k} {b} {a} di", f"r{k} {a} {b} {45e6 + 15e6 * k!r}", f"rs{k} {a} s{k} 5k",
                  f"cs{k} s{k} {b} {4e-9 * period * (1 + 0.3 * k)!r}"]
    return "\n".join([*cards, f"l1 a{n} l {5e4 * period!r}", "rl l 0 500k", f"df 0 a{n} di", ".model sw sw(vt=0.5 roff=100meg)",
                      ".model di d", f".tran {period / 50!r} {8 * period!r} uic", ".save i(df)", ".end", ""])


def check_stack(program, checker, n, period, late):
    """Of steps that come back in each period as of those that do not."""
    name = f"stack of {n}, {period} s, {late}"
    ours, exact = (run(program, stack(n, period, late), method=None, tolerance=tolerance, options=["--fill", "none"])
                   for tolerance in (1e-6, 1e-11))
    if not checker.check(ours.status == exact.status == 0, f"{name}: {ours.stderr} {exact.stderr}"):
        return
    wanted = [(left[0], right[1] - left[1]) for left, right in pairs_of_rows(exact) if left[1] > 0.0 and right[1] > 0.0]
    found = [(left[0], right[1] - left[1]) for left, right in pairs_of_rows(ours) if left[1] > 0.0 and right[1] > 0.0]
    largest = max(row[1] for row in exact.rows)
    if checker.check(len(found) == len(wanted) > 0, f"{name}: {len(found)} pairs of rows, not {len(wanted)}"):
        worst = max(abs(a[1] - b[1]) for a, b in zip(found, wanted)) / largest
        checker.check(worst <= 1e-8, f"{name}: i(df) jumps by {worst:.1e} more or less than it does")


def main():
    program = sys.argv[1]
    checker = Checker("sides")
    for case in ((7, 34.6754e-3, 3e-4), (5, 34.6754e-3, 1e-3), (6, 34.6754e-3, 6e-4)):
        check_stack(program, checker, *case)
    for tolerance in some_of(TOLERANCES):
        check_bridge(program, checker, tolerance)
        check_switch(program, checker, tolerance)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
