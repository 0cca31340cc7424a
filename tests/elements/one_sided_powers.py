#!/usr/bin/env python3
"""Currents that are a power of what is above 0, as max(x, 0)**1.5: beyond the kink the argument is 0, which circuits know to
the rounding of what the kink is the difference of, and the power has no value below.

All circuits of a law are one in units of their own. The reference is the method of Runge and Kutta with small steps.

usage: one_sided_powers.py PROGRAM
"""

import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import runge_kutta  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402

LAWS = {
    "max(X,0)**1.5-max(-X,0)**0.5": lambda x: x**1.5 if x > 0 else -((-x) ** 0.5),
    "max(X,0)**0.5-max(-X,0)**1.5": lambda x: x**0.5 if x > 0 else -((-x) ** 1.5),
    "uramp(X)**1.2-sqrt(uramp(-X))": lambda x: x**1.2 if x > 0 else -math.sqrt(-x),
    "pow(max(X,0),1.5)-pow(max(-X,0),1.5)": lambda x: math.copysign(abs(x) ** 1.5, x),
    "X+max(X-0.5,0)**1.5": lambda x: x + max(x - 0.5, 0.0) ** 1.5,
    "X-max(-X,0)**1.7": lambda x: x - max(-x, 0.0) ** 1.7,
    "max(2*X-0.3,0)**1.5+X": lambda x: max(2 * x - 0.3, 0.0) ** 1.5 + x,
}
VOLTS = [1e-3, 1.0, 1e3]
AMPERES = [1e-3, 200.0]
ROWS = [k * 1e-3 for k in range(1, 41)]
PER_ROW = 400  # steps of the reference

NETLIST = """power of one side
V1 1 0 sin(0 {volt!r} 50)
R1 1 a {ohm!r}
Ra a 0 {{10*{ohm!r}}}
B1 a b I={ampere!r}*({law})
Rb b 0 {ohm!r}
Cb b 0 {{5m/{ohm!r}}}
Ca a 0 {{1m/{ohm!r}}}
.tran 1m 40m
.end
"""


def reference(law):
    """v(a) and v(b), in volts of the source, at the rows."""

    def rates(t, x):
        i = law(3 * (x[0] - x[1]))
        return (math.sin(100 * math.pi * t) - 1.1 * x[0] - i) / 1e-3, (i - x[1]) / 5e-3

    h = ROWS[0] / PER_ROW
    x = [0.0, 0.0]
    rows = []
    for k in range(len(ROWS) * PER_ROW):
        x = runge_kutta.step(rates, k * h, x, h)
        if (k + 1) % PER_ROW == 0:
            rows.append(tuple(x))
    return rows


def look(program, checker, law, volt, ampere, wanted):
    name = f"{law} {volt:g} V {ampere:g} A"
    text = NETLIST.format(volt=volt, ampere=ampere, ohm=volt / ampere, law=law.replace("X", f"(v(a,b)/{volt / 3!r})"))
    result = run(program, text, method=None, at=ROWS, options=["--audit", "full"], environment={"LC_ALL": "C"})
    if not checker.check(result.status == 0, f"{name}: exit {result.status}: {result.stderr}"):
        return
    for column, signal in enumerate(("v(a)", "v(b)")):
        off = max(abs(found / volt - row[column]) for found, row in zip(result.column(signal), wanted))
        checker.check(off <= 1e-5, f"{name}: {signal} is off by {off:.3g}")


def main():
    program = sys.argv[1]
    checker = Checker("one_sided_powers")
    references = {}
    for law, volt, ampere in some_of(list(itertools.product(LAWS, VOLTS, AMPERES)), 3):
        if law not in references:
            references[law] = reference(LAWS[law])
        look(program, checker, law, volt, ampere, references[law])
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
