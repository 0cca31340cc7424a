#!/usr/bin/env python3
"""Quotients and logarithms of exponentials: a current that rises with its voltage, or a voltage with its current, beside one
resistor and a source of up to 30 times the scale of the exponent, where exp() passes 1e130. The answer is where a line meets
the function, found here by bisection.

usage: smooth_exponentials.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import rising_element  # noqa: E402
from dalcs_program import Checker, run  # noqa: E402


def logistic(x):
    small = math.exp(-abs(x))
    return (small if x < 0 else 1) / (1 + small)


def softplus(x):
    return max(x, 0) + math.log1p(math.exp(-abs(x)))


def bernoulli(x):
    return 1 if x == 0 else 0 if x > 700 else x / math.expm1(x)


LAWS = {
    "1/(1+exp(-X))": logistic,
    "(exp(X)-1)/(exp(X)+1)": lambda x: math.tanh(x / 2),
    "(1-exp(-X))/(1+exp(-X))": lambda x: math.tanh(x / 2),
    "(exp(X)-exp(-X))/(exp(X)+exp(-X))": math.tanh,
    "1-2/(exp(2*X)+1)": math.tanh,
    "3*exp(X)/(2+5*exp(X))": lambda x: 0.6 * logistic(x + math.log(2.5)),
    "(2*exp(X)-1)/(3+exp(X))": lambda x: -1 / 3 + (2 + 1 / 3) * logistic(x - math.log(3)),
    "X/(1-exp(-X))": lambda x: bernoulli(-x),
    "ln(1+exp(X))": softplus,
    "ln(3+2*exp(X))-ln(3)": lambda x: softplus(x + math.log(2 / 3)),
    "log10(exp(X)+exp(-X))+X": lambda x: (softplus(2 * x) - x) / math.log(10) + x,
}
SCALES = [1e-5, 1.0, 1e4]  # of the argument


def check_at_a_pole(checker, program):
    """A line over what is 0 with it has a value there."""
    netlist = "pole\nV1 1 0 1\nB1 2 0 V=(v(1)-1)/(exp((v(1)-1)/2)-1)\nR1 2 0 1\n.op\n"
    result = run(program, netlist, method=None)
    if checker.check(result.status == 0, f"pole: exit {result.status}: {result.stderr}"):
        checker.close(result.column("v(2)")[-1], 2, 1e-9, "(v-1)/(exp((v-1)/2)-1) at 1")


def main():
    program = sys.argv[1]
    checker = Checker("smooth_exponentials")
    rising_element.check_scales(checker, program, LAWS, SCALES, (3, 30), 1e-4)
    check_at_a_pole(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
