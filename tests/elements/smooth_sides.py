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
import rising_element  # noqa: E402
from dalcs_program import Checker  # noqa: E402


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


def main():
    program = sys.argv[1]
    checker = Checker("smooth_sides")
    rising_element.check_scales(checker, program, LAWS, CASES, (0.1, 1), 2e-5)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
