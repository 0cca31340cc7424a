#!/usr/bin/env python3
"""Comparisons of smooth functions: nothing but the instants at which they change shows what their arguments are.

usage: smooth_comparisons.py PROGRAM

The argument is a function of sources, of a product of them, of a phase that is added up, of a capacitor that charges.
Each instant agrees with the root of the exact function. A comparator commands a switch or only shows its output.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

RAMP = "va a 0 PWL(0 0 {stop!r} {top!r})"
SINE = "va a 0 SIN(0 {top!r} {over!r})"
TWO = SINE + "\nvb b 0 SIN(0.2 1 {seven!r})"
CHARGE = "ve e 0 {top!r}\nra e a 1k\nca a 0 {tau!r}\n.ic v(a)=0"
PHASE = "vf f 0 SIN(0.6 0.35 {over!r})\nbp a 0 V=idt({hundred!r}*v(f))"
END = "\n.tran {stop!r} {stop!r} uic\n.end\n"


def ramp(x):
    return lambda t: x["top"] * t / x["stop"]


def sine(x):
    return lambda t: x["top"] * math.sin(2 * math.pi * x["over"] * t)


def charge(x):
    return lambda t: -x["top"] * math.expm1(-t / (1e3 * x["tau"]))


def phase(x):
    w = 2 * math.pi * x["over"]
    return lambda t: x["hundred"] * (0.6 * t + 0.35 * (1 - math.cos(w * t)) / w)


def other(x):
    return lambda t: 0.2 + math.sin(2 * math.pi * x["seven"] * t)


# cards, v(a), its largest value, the comparison, what it compares with 0
CASES = [
    (RAMP, ramp, 20, "abs(sin(v(a)))>0.5", lambda a, b: abs(math.sin(a)) - 0.5),
    (RAMP, ramp, 50, "sin(v(a))>0.3", lambda a, b: math.sin(a) - 0.3),
    (RAMP, ramp, 7, "cos(v(a))*sin(2*v(a))>0.1", lambda a, b: math.cos(a) * math.sin(2 * a) - 0.1),
    (RAMP, ramp, 3, "exp(v(a))>7", lambda a, b: math.exp(a) - 7),
    (SINE, sine, 2, "v(a)*v(a)>1.3", lambda a, b: a * a - 1.3),
    (SINE, sine, 3, "tanh(v(a))<0.9", lambda a, b: 0.9 - math.tanh(a)),
    (SINE, sine, 5, "sin(4*v(a))>-0.2", lambda a, b: math.sin(4 * a) + 0.2),
    (SINE, sine, 1e-3, "exp(1000*v(a))-v(a)>1.5", lambda a, b: math.exp(1000 * a) - a - 1.5),
    (TWO, sine, 2, "v(a)*v(b)>0.4", lambda a, b: a * b - 0.4),
    (TWO, sine, 2, "exp(v(a))>2+v(b)", lambda a, b: math.exp(a) - 2 - b),
    (CHARGE, charge, 5, "v(a)*v(a)>6", lambda a, b: a * a - 6),
    (CHARGE, charge, 9, "sin(v(a))>0.7", lambda a, b: math.sin(a) - 0.7),
    (PHASE, phase, 0, "sin(v(a))>0", lambda a, b: math.sin(a)),
    (PHASE, phase, 0, "cos(v(a))>0.9", lambda a, b: math.cos(a) - 0.9),
]
SWITCH = "\nbg g 0 V={{{what} ? 1 : 0}}\nvs p 0 1\ns1 p o g 0 sw\nro o 0 1k\n.model sw sw(ron=1m roff=1g vt=0.5)"
SHOWN = "\nbg o 0 V={{{what} ? 1 : 0}}\nro o 0 1k"


def roots(f, stop):
    """Times at which f changes its sign, by bisection of small parts."""
    n = 20000
    found = []
    for k in range(n):
        low, high = stop * k / n, stop * (k + 1) / n
        sign = f(low) > 0
        if k > 0 and sign != (f(high) > 0):
            for _ in range(60):
                middle = (low + high) / 2
                low, high = (middle, high) if (f(middle) > 0) == sign else (low, middle)
            found.append(high)
    return found


def check(checker, program, case, stop, shape, options):
    cards, course, top, what, compared = case
    x = {"stop": stop, "top": float(top), "over": 1.6 / stop, "seven": 7.3 / stop, "tau": 4e-4 * stop,
         "hundred": 100 / stop}
    label = f"{what}, {stop} s, {'shown' if shape is SHOWN else 'switch'} {options}"
    a, b = course(x), other(x)
    wanted = roots(lambda t: compared(a(t), b(t)), stop)
    text = "smooth comparison\n" + cards.format(**x) + shape.format(what=what) + END.format(**x)
    result = run(program, text, method=None, options=options)
    if not checker.check(result.status == 0, f"{label}: exit {result.status}: {result.stderr[:200]}"):
        return
    found, before = [], None
    for time, level in zip(result.time, result.column("v(o)")):
        if before is not None and (level > 0.5) != before:
            found.append(time)
        before = level > 0.5
    if not checker.check(len(found) == len(wanted), f"{label}: {len(found)} changes, not {len(wanted)}"):
        return
    for time, right in zip(found, wanted):
        checker.close(time, right, 2e-9 * stop, f"{label}: a change")


def main():
    program = sys.argv[1]
    checker = Checker("smooth comparisons")
    for case in CASES:
        for stop in some_of([1.0, 30e-3, 2e-6]):
            for shape in (SWITCH, SHOWN):
                check(checker, program, case, stop, shape, [])
        for options in some_of([["--stages", "3"], ["--stages", "9"], ["--method", "lobatto"], ["--tol", "1e-11"]]):
            check(checker, program, case, 30e-3, SWITCH, options)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
