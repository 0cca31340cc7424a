#!/usr/bin/env python3
"""Kinks of functions that are 1e4 to 1e17 elsewhere in the same run: min(exp(x), 3) of an x that reaches 30.

x is the voltage of a capacitor, which is linear. What the source gives is the formula of that voltage, in each row.

usage: held_functions.py PROGRAM
"""

import pathlib
import sys
from math import cosh, exp, sinh

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

KILO = ("1k", "10n", "1k", 2e-3)
# V, 1/s of the source; R, C, R2 and the end of the run; the formula, and the function of x
CASES = [
    (30e-6, "1k", KILO, "1e-6*min(exp(1e6*X),3)", lambda x: 1e-6 * min(exp(1e6 * x), 3)),
    (25.0, "200k", ("50", "1n", "1k", 1e-5), "min(exp(X)+X,2)", lambda x: min(exp(x) + x, 2)),
    (60.0, "1k", ("1", "10u", "1k", 2e-3), "limit(X**3,-1,1)+0.1*X", lambda x: max(-1, min(x**3, 1)) + 0.1 * x),
    (20.0, "1k", KILO, "limit(sinh(X),-3,3)+0.2*X", lambda x: max(-3, min(sinh(x), 3)) + 0.2 * x),
    (20.0, "1k", KILO, "max(exp(-2*X)+1,3)-0.2*X", lambda x: max(exp(-2 * x) + 1, 3) - 0.2 * x),
    (19.0, "1k", KILO, "exp(-2*min(X,-0.35))", lambda x: exp(-2 * min(x, -0.35))),
    (300.0, "1k", ("10", "1u", "1k", 2e-3), "min(X*X*X*X,2)-0.001*X", lambda x: min(x**4, 2) - 0.001 * x),
    (50.0, "1k", KILO, "max(-2,min(2,X*X*X*X*X*X*X*X*X))+0.01*X", lambda x: max(-2, min(2, x**9)) + 0.01 * x),
    (25.0, "60", ("1k", "100n", "1k", 3.2e-2), "limit(cosh(X),1.5,20)", lambda x: max(1.5, min(cosh(x), 20))),
    (1e3, "1k", KILO, "min(1e3/((X-3)*(X-3)+1e-3),20)", lambda x: min(1e3 / ((x - 3) ** 2 + 1e-3), 20)),
    (30.0, "1k", KILO, "min(abs(exp(X)-5),3)", lambda x: min(abs(exp(x) - 5), 3)),
    (30.0, "1k", KILO, "min(exp(max(X,-X)),40)", lambda x: min(exp(abs(x)), 40)),
    (30.0, "1k", KILO, "min(uramp(sinh(X)-1),3)", lambda x: min(max(sinh(x) - 1, 0), 3)),
    (30.0, "1k", KILO, "min(1/(1+exp(-X)),0.9)", lambda x: min(1 / (1 + exp(-x)), 0.9)),
    (30.0, "1k", KILO, "min(exp(X),4)*X", lambda x: min(exp(x), 4) * x),
    (30.0, "1k", KILO, "if(exp(X)>40,2,0.5)*X", lambda x: (2 if exp(x) > 40 else 0.5) * x),
]

NETLIST = """a function that is held
V1 a 0 SIN({offset!r} {volt!r} {frequency})
R1 a b {parts[0]}
C1 b 0 {parts[1]} ic=0
B1 o 0 V={formula}
R2 o p {parts[2]}
C2 p 0 100n ic=0
.tran {step!r} {parts[3]!r} uic
.end
"""
# No row lies at a kink.
N_ROWS = 97


def look(program, checker, volt, frequency, parts, formula, function):
    text = NETLIST.format(offset=volt / 300, volt=volt, frequency=frequency, parts=parts,
                          formula=formula.replace("X", "v(b)"), step=parts[3] / 100)
    rows = [(k + 1) * parts[3] / N_ROWS for k in range(N_ROWS - 1)]
    outcome = run(program, text, method=None, at=rows, options=["--audit", "full"], environment={"LC_ALL": "C"})
    if not checker.check(outcome.status == 0, f"{formula}: exit {outcome.status}: {outcome.stderr}"):
        return
    wanted = [function(x) for x in outcome.column("v(b)")]
    off = max(abs(a - b) for a, b in zip(outcome.column("v(o)"), wanted))
    size = max(abs(a) for a in wanted)
    checker.check(off <= 1e-9 * size, f"{formula}: v(o) is off by {off:.3g} of {size:.3g}")


def main():
    program = sys.argv[1]
    checker = Checker("held_functions")
    for case in some_of(CASES, 1):
        look(program, checker, *case)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
