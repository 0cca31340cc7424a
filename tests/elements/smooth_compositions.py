#!/usr/bin/env python3
"""Functions of functions: a current that rises with its voltage, or a voltage with its current, beside one resistor and a
source that touches 0. The answer is where a line meets the function, found here by bisection.

usage: smooth_compositions.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, kinds_of, run, some_of  # noqa: E402

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


def meet(f, right, r):
    """x with x + r f(x) = right >= 0, f rising and f(0) >= 0."""
    low, high = -abs(right) - 10 * r, abs(right) + 10 * r
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if middle + r * f(middle) < right else (low, middle)
    return 0.5 * (low + high)


def check(checker, program, text, case, is_current):
    amplitude, r = case
    f = LAWS[text]
    at = [k / 16 for k in range(17)]
    x = "(v(1))" if is_current else "(i(b1))"
    law = text.replace("X", x)
    lines = ([f"I1 0 1 SIN({amplitude} {amplitude} 1)", f"B1 1 0 I={law}", f"R1 1 0 {r}"] if is_current else
             [f"V1 2 0 SIN({amplitude} {amplitude} 1)", f"B1 1 0 V={law}", f"R1 2 1 {r}"])
    title = f"{text} as a {'current' if is_current else 'voltage'}, {amplitude:g}, {r:g} ohm"
    result = run(program, "\n".join([title, *lines, ".tran 0.05 1", ""]), method=None, at=at, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    found = result.column("v(1)" if is_current else "i(b1)")
    for t, value in zip(at, found):
        drive = amplitude * (1 + math.sin(2 * math.pi * t))
        wanted = meet(f, drive * r, r) if is_current else meet(f, drive / r, 1 / r)
        scale = 2 * amplitude * (r if is_current else 1 / r)
        checker.close(value, wanted, 1e-6 * scale, f"{title} at {t:g} s")


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
