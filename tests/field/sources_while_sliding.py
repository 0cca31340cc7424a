#!/usr/bin/env python3
"""Sources and formulas go on while a comparator holds the state: all that moves then is in no state, and is resolved all the same.

usage: sources_while_sliding.py PROGRAM

A segment was as long as its states allow. Where a threshold holds all of them, a polynomial went through more than half of a
period of a sine, and through kinks of formulas: 2 % off, which the audit found. All is held to closed forms, and to numbers of
one-step problems.
"""

import itertools
import math
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # pylint: disable=wrong-import-position,import-error

HELD = 0.6  # of a volt of the source
# In volts, amperes and seconds of the circuit's own: what is beside the comparator, its height over 4, the other current.
KINDS = {
    "a height that bends": ("", "(1+abs(v(p)/{volt}))", lambda v: 0.0),
    "a height that bends beside its level": ("", "(1+max(v(p)/{volt},0.3))", lambda v: 0.0),
    "a fixed height": ("", "1", lambda v: 0.0),
    "a diode": ("d1 p q\nrq q a {ohm}\n", "1", lambda v: max(v - HELD, 0.0)),
    "a source between limits": ("bq q 0 v={{limit(v(p),{volt}/-2,{volt})}}\nrq q a {ohm}\n", "1",
                                lambda v: min(max(v, -0.5), 1.0) - HELD),
}
WAVES = {
    "sin(0 {{2*{volt}}} {{0.12/{second}}})": lambda t: 2 * math.sin(0.24 * math.pi * t),
    "sin(0 {{2*{volt}}} {{0.02/{second}}})": lambda t: 2 * math.sin(0.04 * math.pi * t),
    "pwl(0 0 {{7*{second}}} {{1.5*{volt}}} {{19*{second}}} {{-{volt}}} {{26*{second}}} {{2*{volt}}})": lambda t: (
        1.5 * t / 7 if t < 7 else 1.5 - 2.5 * (t - 7) / 12 if t < 19 else 3 * (t - 19) / 7 - 1),
}
UNITS = [(1.0, 5e-4, 1e-3), (4e3, 30.0, 1e-6), (1e-3, 1e5, 2.0)]  # V, ohm, s
ROWS = [1.3 + 0.617 * k for k in range(38)]
MOST_PROBLEMS = 200000

NETLIST = """A comparator that holds a capacitor while its source goes on
v1 p 0 {wave}
r0 p a {ohm}
c0 a 0 {{0.05*{second}/{ohm}}} ic={{0.6*{volt}}}
b0 a 0 i={{4*{volt}/{ohm}*sgn(v(a)-0.6*{volt})*{height}}}
rl a 0 {{3*{ohm}}}
{beside}.save v(a) i(b0)
.tran {second} {{25*{second}}} uic
.end
"""


def look(program, checker, kind, wave, units):
    volt, ohm, second = units
    beside, height, other = KINDS[kind]
    name = f"{kind}, {wave}, {volt} V"
    words = {"volt": volt, "ohm": ohm, "second": second}
    netlist = NETLIST.format(wave=wave.format(**words), beside=beside.format(**words), height=height.format(**words), **words)
    result = run(program, netlist, method=None, at=[second * t for t in ROWS], options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return
    problems = result.report["work"]["osnsp"]
    checker.check(problems <= MOST_PROBLEMS, f"{name}: {problems} one-step problems")
    for t, a, i in zip(ROWS, result.column("v(a)"), result.column("i(b0)")):
        v = WAVES[wave](t)
        wanted = v - HELD - HELD / 3 + other(v)
        checker.check(abs(a / volt - HELD) <= 1e-9, f"{name}: v(a) is {a!r} at {t}")
        checker.check(abs(i * ohm / volt - wanted) <= 2e-6, f"{name}: i(b0) is {i * ohm / volt!r} at {t}, not {wanted!r}")


def bend(program, checker, frequency):
    """Where the height bends just behind the start of a segment no node of it shows the side before."""
    volt, ohm, second = UNITS[1]
    words = {"volt": volt, "ohm": ohm, "second": second}
    height = KINDS["a height that bends"][1].format(**words)
    netlist = NETLIST.format(wave=f"sin(0 {{2*{volt}}} {{{frequency}/{second}}})", beside="", height=height, **words)
    result = run(program, netlist, method=None, options=["--audit", "full"])
    checker.check(result.status == 0, f"a height that bends, {frequency} in {second} s: {result.stderr}")


def main():
    program = sys.argv[1]
    checker = Checker("sources_while_sliding")
    for k in range(200 if os.environ.get("DALCS_TEST_SHORT") != "1" else 20):
        bend(program, checker, 0.1289 + 0.0001 * k if k < 20 else 0.109 + 0.0001 * k)
    for case in some_of(list(itertools.product(KINDS, WAVES, UNITS)), 3):
        look(program, checker, *case)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
