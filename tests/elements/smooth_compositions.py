#!/usr/bin/env python3
"""Functions of functions: a current that rises with its voltage, or a voltage with its current, beside one resistor and a
source that touches 0. The answer is where a line meets the function, found here by bisection.

usage: smooth_compositions.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import rising_element  # noqa: E402
from dalcs_program import Checker, kinds_of, some_of  # noqa: E402
from rising_element import cards, meet  # noqa: E402

LAWS = {
    "X/sqrt(1+X*X)": lambda x: x / math.hypot(1, x),
    "X/hypot(1,X)": lambda x: x / math.hypot(1, x),
    "X*(1+X**2)**(-0.5)": lambda x: x / math.hypot(1, x),
    "ln(X+sqrt(X**2+1))": math.asinh,
    "X+X**3/(1+X**2)": lambda x: x + x**3 / (1 + x * x),
    "X**5": lambda x: x**5,
}
# amplitude, ohms
CASES = [(1e-3, 0.01), (1e-3, 1.0), (0.1, 1.0), (0.1, 0.01), (3.0, 1.0), (100.0, 0.01), (1e-3, 100.0), (0.02, 7.0)]


def check(checker, program, text, case, is_current):
    amplitude, r = case
    title = f"{text} as a {'current' if is_current else 'voltage'}, {amplitude:g}, {r:g} ohm"
    lines = [title, *cards(text.replace("X", "(X)"), is_current, f"SIN({amplitude} {amplitude} 1)", r)]
    slope = 1 / r if is_current else r

    def wanted(t):
        return meet(LAWS[text], amplitude * (1 + math.sin(2 * math.pi * t)), slope)

    rising_element.check(checker, program, lines, wanted, 1e-6 * 2 * amplitude / slope)


def main():
    program = sys.argv[1]
    checker = Checker("smooth_compositions")
    for text in kinds_of(LAWS):
        for case in some_of(CASES, 2):
            for is_current in (True, False):
                check(checker, program, text, case, is_current)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
