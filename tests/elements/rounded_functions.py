#!/usr/bin/env python3
"""Currents that are small differences of large functions: 200 A times 1 - exp(-x) at microvolts. What rounding of the
functions leaves in the error of a step is no reason for a shorter step.

The argument is so small that the element is the conductance of its slope at 0: the reference is the run of the same circuit
with a resistor there.

usage: rounded_functions.py PROGRAM
"""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

LAWS = ["sgn(X)*(1-exp(-abs(X)))", "sgn(X)*2*(sqrt(1+abs(X))-1)"]
VOLTS = [1e-6, 1e-3, 1.0]  # of the source at the end of its ramp
AMPERES = [2.0, 200.0]  # of the element, for x = 1, which is 10 V
OHMS = [1e3, 1e6]  # beside the capacitor that it charges
MOST_STEPS = 4000

NETLIST = """current through a large function
V1 1 0 PWL(0 0 1 {volt!r})
R1 1 2 1k
C1 2 0 1u
R4 2 0 10k
{element}
R3 3 0 {ohm!r}
C3 3 0 1m
.tran 0.1 1
.end
"""
ROWS = [k / 10 for k in range(1, 11)]


def look(program, checker, law, volt, ampere, ohm):
    name = f"{law} {volt:g} V {ampere:g} A {ohm:g} ohm"
    x = "(v(2,3)/10)"
    of = {"I": f"B1 2 3 I={ampere!r}*({law.replace('X', x)})", "R": f"RB 2 3 {10 / ampere!r}"}
    outcome = {}
    for kind, element in of.items():
        text = NETLIST.format(volt=volt, ohm=ohm, element=element)
        outcome[kind] = run(program, text, method=None, at=ROWS, options=["--audit", "full"], environment={"LC_ALL": "C"})
        if not checker.check(outcome[kind].status == 0, f"{name}: exit {outcome[kind].status}: {outcome[kind].stderr}"):
            return
    steps = outcome["I"].report["work"]["steps"]
    checker.check(steps <= MOST_STEPS, f"{name}: {steps} steps")
    for signal in ("v(2)", "v(3)"):
        found, wanted = outcome["I"].column(signal), outcome["R"].column(signal)
        off = max(abs(a - b) for a, b in zip(found, wanted))
        size = max(abs(a) for a in wanted)
        checker.check(off <= 1e-5 * size, f"{name}: {signal} is off by {off:.3g} of {size:.3g}")


def main():
    program = sys.argv[1]
    checker = Checker("rounded_functions")
    for case in some_of(list(itertools.product(LAWS, VOLTS, AMPERES, OHMS)), 3):
        look(program, checker, *case)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
