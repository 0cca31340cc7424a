#!/usr/bin/env python3
"""Runs a netlist as it is and checks what its own header promises.

usage: expectations.py PROGRAM NETLIST

The header's lines are read by people and by this test; VALUE is an expression, times take suffixes:
  * expect: SIGNAL at TIME = VALUE +- TOLERANCE
  * expect: mean|max|min SIGNAL from TIME to TIME = VALUE +- TOLERANCE
  * expect: start ELEMENT = VALUE +- TOLERANCE              the state just after t = 0
  * expect: charge|flux ELEMENT = VALUE +- TOLERANCE        the impulse at t = 0
  * expect: loss at 0 = VALUE +- TOLERANCE                  the energy that the jump costs
"""

import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

SUFFIX = {"": 1.0, "k": 1e3, "m": 1e-3, "u": 1e-6, "n": 1e-9}


def seconds(text):
    number, suffix = re.fullmatch(r"([-+0-9.e]+?)([kmun]?)", text).groups()
    return float(number) * SUFFIX[suffix]


def window(result, signal, start, stop):
    slack = 1e-9 * result.time[-1]
    return [(t, x) for t, x in zip(result.time, result.column(signal))
            if start - slack <= t <= stop + slack]


def mean(points):
    area = sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in zip(points, points[1:]))
    return area / (points[-1][0] - points[0][0])


def measured(result, what):
    words = what.split()
    if words[0] == "start":
        return result.report["start"][words[1]]
    if words[0] in ("charge", "flux"):
        return result.impulse(words[1], words[0])
    if words[0] == "loss":
        return result.loss(seconds(words[2]))
    if words[0] in ("mean", "max", "min"):
        points = window(result, words[1], seconds(words[3]), seconds(words[5]))
        return mean(points) if words[0] == "mean" else {"max": max, "min": min}[words[0]](
            x for _, x in points)
    return result.at(words[0], seconds(words[2]))


def main():
    program, path = sys.argv[1], pathlib.Path(sys.argv[2])
    checker = Checker(path.stem)
    promises = re.findall(r"^\* expect: (.*) = (.*) \+- (.*)$", path.read_text(), re.M)
    checker.check(promises, "the header promises nothing")
    result = run(program, path, method=None)
    if checker.check(result.status == 0, f"exit {result.status}: {result.stderr}"):
        certificate = result.report["certificate"]
        worst, where = certificate["worst"], certificate["where"]
        # Steps on sparse factors are as good as the factors of a complex matrix.
        checker.check(worst <= (2e-12 if where == "stages" else 2e-13),
                      f"certificate {worst:.2e} ({where})")
        names = {"__builtins__": {}, **vars(math)}
        for what, value, tolerance in promises:
            checker.close(measured(result, what), float(eval(value, names)), float(tolerance), what)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
