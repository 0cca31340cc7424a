#!/usr/bin/env python3
"""Products with a root that is 0 for a while: nothing flows from the start on, and that is an answer.

usage: roots_times_factors.py PROGRAM

sqrt(max(v, 0)) times another factor, as a voltage across a resistor and as a current into a capacitor, against its own
values and their integral. Where the root rests at 0 the line of the product is all that is left of it."""

import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SPAN = 1e-3
# v(a) from and to; v(d) is -1
RAMPS = [(-1.0, 1.0), (-5.0, 3.0), (-1e-3, 1.0), (-300.0, 200.0)]
FORMULAS = {
    "sqrt(max(v(a),0))*v(a)": lambda a: math.sqrt(max(a, 0.0)) * a,
    "v(a)*sqrt(max(v(a),0))*2": lambda a: 2.0 * math.sqrt(max(a, 0.0)) * a,
    "sqrt(max(v(a),0))*v(a)*v(a)": lambda a: math.sqrt(max(a, 0.0)) * a * a,
    "sqrt(max(v(a),0))*v(d)*v(a)": lambda a: -math.sqrt(max(a, 0.0)) * a,
    "sqrt(max(v(a),0))*abs(v(a)+v(d))": lambda a: math.sqrt(max(a, 0.0)) * abs(a - 1.0),
    "v(a)*ln(1+sqrt(max(v(a),0)))": lambda a: a * math.log(1.0 + math.sqrt(max(a, 0.0))),
    "v(a)*max(v(a),0)**0.3": lambda a: a * max(a, 0.0) ** 0.3,
    "v(a)*sqrt(max(v(a)+v(d)/4,0))": lambda a: a * math.sqrt(max(a - 0.25, 0.0)),
}
LOADS = {"a voltage": ("b1 c 0 v=@\nr1 c 0 {ohms}", ".meas tran found find v(c) at=0.9m"),
         "a current": ("b1 0 c i=@\nc1 c 0 {farads} ic=0", ".meas tran found find v(c) at=1m")}
SIZES = [{"ohms": 1.0, "farads": 1e-3}, {"ohms": 4.7e3, "farads": 1e-6}]


def integral(f, low, high):
    """By Gauss's rule of 3 points on pieces that are finer towards the start of the root."""
    total, pieces = 0.0, 4000
    for start, end in ((0.0, 0.25), (0.25, 1.0), (1.0, high)):
        if end <= start:
            continue
        for k in range(pieces):
            a = start + (end - start) * (k / pieces) ** 3
            b = start + (end - start) * ((k + 1) / pieces) ** 3
            for at, weight in ((-math.sqrt(0.6), 5 / 9), (0.0, 8 / 9), (math.sqrt(0.6), 5 / 9)):
                total += 0.5 * weight * (b - a) * f(0.5 * (a + b) + 0.5 * at * (b - a))
    return total * SPAN / (high - low)


def main():
    checker = Checker("roots_times_factors")
    cases = itertools.product(FORMULAS.items(), RAMPS, LOADS.items(), SIZES)
    for (formula, f), (low, high), (load, (cards, measure)), size in some_of(list(cases)):
        what = f"{formula} from {low} to {high}, {load}, {size['ohms']} ohm"
        text = "\n".join(["t", f"v1 a 0 pwl(0 {low} 1m {high})", "v2 d 0 -1",
                          cards.format(**size).replace("@", formula), measure, ".tran 50u 1m uic", ".end", ""])
        outcome = run(sys.argv[1], text, method="auto")
        if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr[-300:]}"):
            continue
        wanted = f(low + 0.9 * (high - low)) if load == "a voltage" else integral(f, low, high) / size["farads"]
        scale = max(abs(wanted), abs(high))
        checker.close(outcome.report["measurements"][0]["value"], wanted, 2e-6 * scale, what)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
