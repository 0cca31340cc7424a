#!/usr/bin/env python3
"""Capacitances and inductances that are written as functions of the element's own voltage or current.

A constant current charges a capacitor: its voltage is where the integral of the capacitance, taken here by Gauss'
quadrature between the knots, has the charge I t. A constant voltage does the same to a coil. The law is written with
x, with v(a,b), with v(a) - v(b) and turned around, at several scales.

usage: storage_slopes.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

EXACT = 2e-8

# name, text of u = x / unit, the same as a function, where it has knots
LAWS = [
    ("a permeance that saturates", "(u<2)?1:0.99*exp(-10*(u-2))+0.01",
     lambda u: 1 if u < 2 else 0.99 * math.exp(-10 * (u - 2)) + 0.01, [2]),
    ("the other way around", "u>=-1?0.5:0.2*exp(u+1)+0.3", lambda u: 0.5 if u >= -1 else 0.2 * math.exp(u + 1) + 0.3, [-1]),
    ("nested", "u<-1?2:(u>1?0.3*exp(-0.5*(u-1))+0.02:0.5)",
     lambda u: 2 if u < -1 else 0.3 * math.exp(-0.5 * (u - 1)) + 0.02 if u > 1 else 0.5, [-1, 1]),
    ("a condition times a function", "1+0.5*(u>1)*exp(-(u-1)/2)+0.1*atan(u/3)",
     lambda u: 1 + (0.5 * math.exp(-(u - 1) / 2) if u > 1 else 0) + 0.1 * math.atan(u / 3), [1]),
    ("not", "!(u<0.5)?0.1+exp(-u):1+u*u", lambda u: 0.1 + math.exp(-u) if u >= 0.5 else 1 + u * u, [0.5]),
    ("derating", "0.3+0.35*(1-tanh((u-1)/0.6))", lambda u: 0.3 + 0.35 * (1 - math.tanh((u - 1) / 0.6)), []),
    ("a junction", "1/(4+u/0.7)**0.5", lambda u: 1 / math.sqrt(4 + u / 0.7), []),
    ("1/line", "1/(5+u)", lambda u: 1 / (5 + u), []),
    ("roots", "sqrt(4+u)+1/sqrt(4-u)", lambda u: math.sqrt(4 + u) + 1 / math.sqrt(4 - u), []),
    ("a polynomial", "1+0.1*u+0.05*u*u+0.01*u**4", lambda u: 1 + 0.1 * u + 0.05 * u * u + 0.01 * u ** 4, []),
    ("sine and cosine", "1+0.5*sin(3*u)-0.3*cos(u-1)", lambda u: 1 + 0.5 * math.sin(3 * u) - 0.3 * math.cos(u - 1), []),
]

# How the argument is written, of nodes a and b, and what it is in terms of the element's own.
SPELLINGS = [("v(a,b)", 1), ("(v(a)-v(b))", 1), ("(v(b)-v(a))", -1), ("(-v(b)+v(a))", 1), ("v(b,a)", -1),
             ("(v(a)+(-v(b)))", 1)]
UNITS = [(1.0, 1e-6, 1e-3), (48.0, 1e-12, 1e-8), (1e3, 1.0, 1e3)]  # of x, of the law, seconds

NODES, WEIGHTS = zip((-0.9602898564975363, 0.1012285362903763), (-0.7966664774136267, 0.2223810344533745),
                     (-0.5255324099163290, 0.3137066458778873), (-0.1834346424956498, 0.3626837833783620),
                     (0.1834346424956498, 0.3626837833783620), (0.5255324099163290, 0.3137066458778873),
                     (0.7966664774136267, 0.2223810344533745), (0.9602898564975363, 0.1012285362903763))


def integral(law, knots, u):
    """From 0 to u."""
    low, high = min(0.0, u), max(0.0, u)
    ends = [low, *sorted(k for k in knots if low < k < high), high]
    total = 0.0
    for a, b in zip(ends, ends[1:]):
        n = max(4, math.ceil(8 * (b - a)))
        for k in range(n):
            middle, half = a + (k + 0.5) * (b - a) / n, 0.5 * (b - a) / n
            total += half * sum(w * law(middle + half * z) for z, w in zip(NODES, WEIGHTS))
    return math.copysign(1.0, u) * total


def inverse(law, knots, charge):
    low, high = -2.5, 3.5
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if integral(law, knots, middle) < charge else (low, middle)
    return 0.5 * (low + high)


def capacitor(text, spelling, unit, farad):
    formula = text.replace("u", f"({spelling[1] / unit!r}*{spelling[0]})")
    return f"C1 a b c='{farad!r}*({formula})'"


def check_capacitor(checker, program, name, law, spelling, units, sign):
    unit, farad, second = units
    most = 3.0 if sign > 0 else -2.0
    charge = integral(law[2], law[3], most)
    current = charge * unit * farad / second
    at = [k / 9 * second for k in range(1, 10)]
    text = (f"{name}\nI1 0 a {current!r}\n{capacitor(law[1], spelling, unit, farad)}\n"
            f"R1 b 0 {0.1 * unit / abs(current)!r}\n.tran {second / 50!r} {second!r} uic\n")
    result = run(program, text, at=at, method="auto", options=["--audit", "full"])
    title = f"{name} of {spelling[0]} at {unit:g} V, {sign:+d}"
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    for t, a, b in zip(at, result.column("v(a)"), result.column("v(b)")):
        wanted = unit * inverse(law[2], law[3], charge * t / second)
        checker.check(abs(a - b - wanted) <= EXACT * abs(most) * unit,
                      f"{title}: {a - b:.10g} V in place of {wanted:.10g} V at {t:g} s")


def check_coil(checker, program, name, law, units):
    unit, henry, second = units
    flux = integral(law[2], law[3], 3.0)
    volt = flux * unit * henry / second
    at = [k / 9 * second for k in range(1, 10)]
    formula = law[1].replace("u", f"({1 / unit!r}*i(l1))")
    text = f"{name}\nV1 a 0 {volt!r}\nL1 a 0 L='{henry!r}*({formula})'\n.tran {second / 50!r} {second!r} uic\n"
    result = run(program, text, at=at, method="auto", options=["--audit", "full"])
    if not checker.check(result.status == 0, f"coil, {name}: exit {result.status}: {result.stderr}"):
        return
    for t, found in zip(at, result.column("i(l1)")):
        wanted = unit * inverse(law[2], law[3], flux * t / second)
        checker.check(abs(found - wanted) <= EXACT * 3 * unit,
                      f"coil, {name}: {found:.10g} A in place of {wanted:.10g} A at {t:g} s")


def check_refused(checker, program):
    """What has no integral among these, and what is not its own voltage."""
    for formula, wanted in (("1u*exp(-v(a,b)*v(a,b))", "no integral"), ("1u*exp(v(a,b))*tanh(v(a,b))", "no integral"),
                            ("1u*(1+v(a,b)**9*v(b,a)**2)", "no integral"), ("1u/(1+0.1*v(a,b))**2", "no integral"),
                            ("1u/(1+0.1*v(a,b))**1.5", "no integral"), ("1u*(2+tanh(v(a)-v(c)))", "its own voltage only"),
                            ("1u*(2+tanh(v(a)+v(b)))", "its own voltage only"),
                            ("1u*(2+tanh(v(a,c)-v(b)))", "its own voltage only")):
        text = f"refused\nI1 0 a 1m\nC1 a b c='{formula}'\nR1 b 0 1k\nR2 c 0 1\nV1 c 0 1\n.tran 1u 1m uic\n"
        result = run(program, text)
        checker.check(result.status == 3 and wanted in result.stderr,
                      f"{formula}: exit {result.status}, not with '{wanted}': {result.stderr}")


def main():
    program = sys.argv[1]
    checker = Checker("storage_slopes")
    for k, law in enumerate(LAWS):
        for sign in (1, -1):
            check_capacitor(checker, program, law[0], law, SPELLINGS[k % len(SPELLINGS)], UNITS[k % len(UNITS)], sign)
        check_coil(checker, program, law[0], law, UNITS[(k + 1) % len(UNITS)])
    for spelling in SPELLINGS:
        check_capacitor(checker, program, LAWS[0][0], LAWS[0], spelling, UNITS[0], 1)
    check_refused(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
