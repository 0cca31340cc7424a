#!/usr/bin/env python3
"""Formulas with smooth sides that meet, written with a sign, a step or a magnitude: a current that rises with its
voltage, or a voltage with its current, beside one resistor and a source that passes 0 both ways. The answer is where a line
meets the function, found here by bisection.

usage: smooth_sides.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, kinds_of, run, some_of  # noqa: E402


def odd(f):
    return lambda x: math.copysign(f(abs(x)), x)


def rise(x):
    return -math.expm1(-x)


LAWS = {
    "sgn(X)*(1-exp(-abs(X)))": odd(rise),
    "sgn(X)-sgn(X)*exp(-abs(X))": odd(rise),
    "(2*u(X)-1)*(1-exp(-abs(X)))": odd(rise),
    "sgn(X)*ln(1+abs(X))": odd(math.log1p),
    "sgn(X)*ln(abs(X)+sqrt(X**2+1))": math.asinh,
    "sgn(X)*tanh(abs(X))+abs(X)-abs(X)": math.tanh,
    "sgn(X)*X**2": odd(lambda x: x * x),
    "X+u(X-0.3)*(exp(X-0.3)-1)": lambda x: x + math.expm1(max(x - 0.3, 0)),
    "X+u(X)*X**3": lambda x: x + max(x, 0) ** 3,
}
CASES = [1e-6, 1e-3, 1.0, 1e4]  # of the argument


def meet(f, right, slope):
    """x with f(x) + slope x = right, f rising."""
    low, high = -(abs(right) + 10) / slope, (abs(right) + 10) / slope
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if f(middle) + slope * middle < right else (low, middle)
    return 0.5 * (low + high)


def check(checker, program, text, scale, is_current):
    f = LAWS[text]
    at = [k / 16 for k in range(17)]
    law = text.replace("X", f"({'v(1)' if is_current else 'i(b1)'}/{scale!r})")
    lines = (["I1 0 1 SIN(0.1 1 1)", f"B1 1 0 I={law}", f"R1 1 0 {10 * scale!r}"] if is_current else
             ["V1 2 0 SIN(0.1 1 1)", f"B1 1 0 V={law}", f"R1 2 1 {0.1 / scale!r}"])
    title = f"{text} as a {'current' if is_current else 'voltage'}, {scale:g}"
    result = run(program, "\n".join([title, *lines, ".tran 0.05 1", ""]), method=None, at=at, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    found = result.column("v(1)" if is_current else "i(b1)")
    for t, value in zip(at, found):
        wanted = scale * meet(f, 0.1 + math.sin(2 * math.pi * t), 0.1)
        checker.close(value, wanted, 2e-5 * scale, f"{title} at {t:g} s")


def main():
    program = sys.argv[1]
    checker = Checker("smooth_sides")
    for text in kinds_of(LAWS):
        for scale in some_of(CASES, 2):
            for is_current in (True, False):
                check(checker, program, text, scale, is_current)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
