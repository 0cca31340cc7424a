#!/usr/bin/env python3
"""Sources that drive a capacitor away faster than any exponential: the voltage has no value from a finite time on.

usage: escapes.py PROGRAM

Each run has to end there, with the time and the element, and with rows that follow the closed form until then. None may go
on behind it. The same sources with the other sign bring the voltage back, and are run to the end.
"""

import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SUFFIX = {"": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12}


def exponential(sign, farads, amperes, volts, start):
    """c v' = sign i exp(v / a)."""
    tau = farads * volts / amperes * math.exp(-start / volts)
    return (f"i=-{sign * amperes!r}*exp(v(b)/{volts!r})", tau,
            lambda t: start - volts * math.log(1 - sign * t / tau))


def power(sign, farads, amperes, volts, start, n):
    """c v' = sign i (v / a)^n."""
    tau = farads * start / (n - 1) / (amperes * (start / volts) ** n)
    return (f"i=-{sign * amperes!r}*(v(b)/{volts!r})**{n}", tau,
            lambda t: start * (1 - sign * t / tau) ** (-1 / (n - 1)))


# farads, amperes and volts of the function, volts at the start
SIZES = [(1e-6, 1.0, 1.0, 0.5), (1e-12, 1e-6, 0.1, 0.03), (1.0, 1e3, 30.0, 50.0), (1e-9, 1e-3, 1.0, 2.0)]


def time_of(message):
    found = re.search(r"(?:t = |from t = |at t = )([0-9.e+-]+) ([munp]?)s", message)
    return float(found[1]) * SUFFIX[found[2]] if found else math.nan


def check(checker, program, name, formula, tau, value, farads, start, resistance, escapes):
    stop = 2.0 * tau
    load = f"r1 b 0 {resistance!r}\n" if resistance else ""
    text = (f"{name}\nb1 b 0 {formula}\nc1 b 0 {farads!r} ic={start!r}\n{load}.save v(b)\n"
            f".tran {tau / 20!r} {stop!r} uic\n.end\n")
    result = run(program, text, method=None)
    if escapes:
        checker.check(result.status == 1, f"{name}: {result.status}")
        checker.close(time_of(result.stderr), tau, 1e-3 * tau, f"{name}: the time in {result.stderr[:120]!r}")
        return
    if checker.check(result.status == 0, f"{name}: {result.status}: {result.stderr}"):
        for t, v in zip(result.time, result.column("v(b)")):
            checker.close(v, value(t), 1e-7 * max(abs(start), abs(value(stop))), f"{name}: at {t}")


def main():
    checker = Checker("escapes")
    for farads, amperes, volts, start in some_of(SIZES):
        for resistance in (0.0, 1e9 * volts / amperes):  # one that takes next to nothing
            for sign in (1, -1):
                for kind, (formula, tau, value) in {
                        "exp": exponential(sign, farads, amperes, volts, start),
                        "square": power(sign, farads, amperes, volts, start, 2),
                        "cube": power(sign, farads, amperes, volts, start, 3),
                        "fifth": power(sign, farads, amperes, volts, start, 5)}.items():
                    check(checker, sys.argv[1], f"{kind} {sign} of {farads} F, {amperes} A, {volts} V, {resistance} ohm",
                          formula, tau, value, farads, start, resistance, sign > 0)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
