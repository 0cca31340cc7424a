#!/usr/bin/env python3
"""Roots of what is 0 on one side, as sqrt(max(x, 0)): steep at 0 from above, and flat below.

A current or a voltage that rises with what it reads, beside one resistor, is where a line meets the function, found here by
bisection. A tank that empties through a hole does so in finite time, and is filled again: a capacitor of C behind a current
k sqrt(v) has sqrt(v) = sqrt(v0) - k t/(2 C), and then 0 (Torricelli). A coil beside a voltage k sqrt(i) is its dual.
Responses at operating points are those of the slopes there.

usage: one_sided_roots.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import rising_element  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402


def root(x, exponent=0.5):
    return math.copysign(abs(x) ** exponent, x)


LAWS = {
    "sqrt(max(X,0))+0.05*X": lambda x: root(max(x, 0)) + 0.05 * x,
    "max(pwrs(X,0.5),0)+0.1*X": lambda x: root(max(x, 0)) + 0.1 * x,
    "sqrt(max(X,0))-sqrt(max(-X,0))": root,
    "3*sqrt(max(X,0))-2*sqrt(max(-X,0))": lambda x: 3 * root(x) if x > 0 else 2 * root(x),
    "cbrt(uramp(X-0.1))-cbrt(uramp(0.1-X))+X": lambda x: root(x - 0.1, 1 / 3) + x,
    "pwr(max(X,0),0.4)": lambda x: max(x, 0) ** 0.4,
    "X>0?sqrt(X):0": lambda x: root(max(x, 0)),
    "min(pwrs(X,0.5),1)+0.1*X": lambda x: min(root(x), 1) + 0.1 * x,
    "max(X,0)**0.8-2*max(-X,0)**0.5": lambda x: x**0.8 if x > 0 else 2 * root(x),
    "sqrt(limit(X,0,0.5))+0.1*X": lambda x: root(min(max(x, 0), 0.5)) + 0.1 * x,
    "uramp(2*cbrt(X)-1)": lambda x: max(2 * root(x, 1 / 3) - 1, 0),
    "min(0.5-pwrs(-X,0.6),1)+X": lambda x: min(0.5 + root(x, 0.6), 1) + x,
}
CASES = [1e-5, 1e-3, 1.0, 1e4]  # of the argument


def check_tank(checker, program, volts, farads, gain):
    """Emptied in T, at rest until 1.5 T, filled with half the first outflow until 2 T."""
    t_empty = 2 * farads * math.sqrt(volts) / gain
    inflow = 0.5 * gain * math.sqrt(volts)
    title = f"a tank of {farads:g} F from {volts:g} V by {gain:g}"
    at = [k * t_empty / 8 for k in range(1, 13)]
    netlist = "\n".join([title, f"C1 1 0 {farads!r} ic={volts!r}", f"B1 1 0 I={gain!r}*sqrt(max(v(1),0))",
                         f"I1 0 1 PULSE(0 {inflow!r} {1.5 * t_empty!r} 0 0 {t_empty!r})",
                         f".tran {t_empty / 100!r} {2 * t_empty!r} uic", ""])
    result = run(program, netlist, method=None, at=[*at, 2 * t_empty], options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    *emptied, filled = result.column("v(1)")
    for t, value in zip(at, emptied):
        checker.close(value, volts * max(1 - t / t_empty, 0) ** 2, 1e-7 * volts, f"{title} at {t:g} s")
    # with y = sqrt(v): 2 C y' = inflow/y - gain, so that t = -2 C (y/gain + inflow/gain^2 ln(1 - gain y/inflow))
    low, high = 0.0, inflow / gain
    for _ in range(100):
        y = 0.5 * (low + high)
        t = -2 * farads * (y / gain + inflow / gain**2 * math.log1p(-gain * y / inflow)) if y < inflow / gain else math.inf
        low, high = (y, high) if t < 0.5 * t_empty else (low, y)
    checker.close(filled, y * y, 1e-6 * volts, f"{title}, filled again")


def check_coil(checker, program, amperes, henries, gain):
    t_empty = 2 * henries * math.sqrt(amperes) / gain
    title = f"a coil of {henries:g} H from {amperes:g} A by {gain:g}"
    at = [k * t_empty / 8 for k in range(1, 13)]
    netlist = "\n".join([title, f"L1 0 1 {henries!r} ic={amperes!r}", f"B1 1 0 V={gain!r}*sqrt(max(i(L1),0))",
                         f".tran {t_empty / 100!r} {1.5 * t_empty!r} uic", ""])
    result = run(program, netlist, method=None, at=at, options=["--audit", "full"])
    if checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        for t, value in zip(at, result.column("i(l1)")):
            checker.close(value, amperes * max(1 - t / t_empty, 0) ** 2, 1e-7 * amperes, f"{title} at {t:g} s")


def check_response(checker, program, volts):
    """Behind 1 ohm, where v + sqrt(v) are those volts: beside the slope 1/(2 sqrt(v)), and below 0 beside none."""
    y = 0.5 * (math.sqrt(1 + 4 * max(volts, 0)) - 1)
    wanted = 2 * y / (2 * y + 1) if volts > 0 else 1.0
    title = f"response at {volts:g} V"
    netlist = "\n".join([title, f"V1 1 0 DC {volts!r} AC 1", "R1 1 2 1", "B1 2 0 I=sqrt(max(v(2),0))",
                         ".ac lin 1 1 1", ""])
    result = run(program, netlist, method=None)
    if checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        checker.close(float(result.rows[0][result.names.index("re(v(2))")]), wanted, 1e-9, title)


def main():
    program = sys.argv[1]
    checker = Checker("one_sided_roots")
    rising_element.check_scales(checker, program, LAWS, CASES, (0.1, 1), 2e-5)
    for volts, farads, gain in some_of([(1.0, 1.0, 1.0), (4.0, 1e-6, 1e-3), (1e-4, 1e-3, 5.0), (900.0, 10.0, 0.2)], 2):
        check_tank(checker, program, volts, farads, gain)
        check_coil(checker, program, volts, farads, gain)
    for volts in (2.0, 0.01, -3.0):
        check_response(checker, program, volts)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
