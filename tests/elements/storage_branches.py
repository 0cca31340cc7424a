#!/usr/bin/env python3
"""Charges and fluxes with several branches begin on the one on which their element begins.

A constant current moves a charge from Q(x0), a constant voltage a flux. The argument is known from the inverse of the law
on the branch around x0, found here by bisection between the ends of that branch: poles, or points where the slope is 0.

usage: storage_branches.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

EXACT = 3e-8
PI = math.pi

# name, text of u, the same as a function, where it begins, where it ends, both on one branch
LAWS = [
    ("a pole below", "u-1000/(1+u)", lambda u: u - 1000 / (1 + u), 0.0, 3.0),
    ("a pole above", "u+20/(5-u)", lambda u: u + 20 / (5 - u), 0.0, 3.0),
    ("behind a pole", "u-2/(u-3)", lambda u: u - 2 / (u - 3), 5.0, 9.0),
    ("before a pole", "u-2/(u-3)", lambda u: u - 2 / (u - 3), 1.0, 2.5),
    ("the third branch of tan", "tan(u/2)", lambda u: math.tan(u / 2), 4 * PI - 1, 4 * PI + 2),
    ("the eighth rise of sin", "sin(u)", math.sin, 14 * PI - 0.5, 14 * PI + 1.2),
    ("steep", "u+1e-6*exp(20*u)", lambda u: u + 1e-6 * math.exp(20 * u), 0.9, 1.1),
    ("saturated", "10*tanh(u)+0.01*u", lambda u: 10 * math.tanh(u) + 0.01 * u, -8.0, -6.0),
    ("nested", "(tan(u)+3)**2-u", lambda u: (math.tan(u) + 3) ** 2 - u, PI - 0.5, PI + 0.9),
]
UNITS = [(1.0, 1e-6, 1e-3), (10.0, 1e-12, 1e-8), (1e3, 1e3, 1e3), (1e-3, 1.0, 50.0)]  # of x, of the law, seconds


def inverse(law, value, ends):
    low, high = ends
    rises = law(high) > law(low)
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (law(middle) < value) == rises else (low, middle)
    return 0.5 * (low + high)


def check(checker, program, law, units, is_coil, by_node):
    name, text, f, begin, end = law
    unit, size, second = units
    argument = f"({1 / unit!r}*x)"
    formula = f"{size!r}*({text.replace('u', argument)})"
    rate = (f(end) - f(begin)) * size / second
    at = [k / 8 * second for k in range(1, 9)]
    start = "" if by_node else f" ic={begin * unit!r}"
    card = (f"V1 a 0 {rate!r}\nL1 a 0 flux={formula}{start}" if is_coil
            else f"I1 0 a {rate!r}\nC1 a 0 q={formula}{start}" + (f"\n.ic v(a)={begin * unit!r}" if by_node else ""))
    text = f"{name}\n{card}\n.tran {second / 50!r} {second!r} uic\n"
    result = run(program, text, at=at, method="auto", options=["--audit", "full"])
    title = f"{name}, {'flux' if is_coil else 'charge'} of {size:g} and {unit:g}{', .ic' if by_node else ''}"
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    for t, found in zip(at, result.column("i(l1)" if is_coil else "v(a)")):
        wanted = unit * inverse(f, f(begin) + (f(end) - f(begin)) * t / second, (begin, end))
        if not checker.check(abs(found - wanted) <= EXACT * unit * max(abs(begin), abs(end)),
                             f"{title}: {found:.10g} in place of {wanted:.10g} at {t:g} s"):
            return


def main():
    program = sys.argv[1]
    checker = Checker("storage_branches")
    for k, law in enumerate(LAWS):
        check(checker, program, law, UNITS[k % len(UNITS)], False, False)
        check(checker, program, law, UNITS[(k + 1) % len(UNITS)], False, True)
        check(checker, program, law, UNITS[(k + 2) % len(UNITS)], True, False)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
