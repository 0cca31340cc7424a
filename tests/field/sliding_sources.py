#!/usr/bin/env python3
"""A jump times a quantity of its own, in a loop without a state: at the jump neither side of the switch of the product agrees
with its control, and the product is what holds the control at the jump, between both sides. Beside one resistor and a
source the answer is where a line meets the graph, found here by bisection, also where the product has smooth functions of
the other quantity; of a capacitor it is 0 while the product can carry the current.

usage: sliding_sources.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, kinds_of, run, some_of  # noqa: E402
from rising_element import meet  # noqa: E402

AT = [k / 16 for k in range(1, 33)]  # s


def sign(x):
    return 1 if x > 0 else -1


LAWS = {  # of X, what the element reads, and of Y, another voltage
    "sgn(X)*Y": lambda x, y, t: sign(x) * y,
    "sgn(X)*Y+X": lambda x, y, t: sign(x) * y + x,
    "u(X)*Y": lambda x, y, t: y if x > 0 else 0,
    "X>0?Y:-0.5*Y": lambda x, y, t: y if x > 0 else -0.5 * y,
    "sgn(X)*(1+0.5*sin(9*time))": lambda x, y, t: sign(x) * (1 + 0.5 * math.sin(9 * t)),
    "sgn(X-0.3*Y)*Y": lambda x, y, t: sign(x - 0.3 * y) * y,
    "sgn(X)*abs(Y-1)": lambda x, y, t: sign(x) * abs(y - 1),
    "sgn(X)*Y**2": lambda x, y, t: sign(x) * y * y,
    "sgn(X)*exp(Y-1)": lambda x, y, t: sign(x) * math.exp(y - 1),
    "u(X)*sqrt(Y)": lambda x, y, t: math.sqrt(y) if x > 0 else 0,
    "X>0?Y**2:-(Y**3)": lambda x, y, t: y ** 2 if x > 0 else -y ** 3,
    "sgn(X-0.3*Y)*tanh(Y)": lambda x, y, t: sign(x - 0.3 * y) * math.tanh(y),
    "sgn(X)*(1+0.5*sin(Y))+X": lambda x, y, t: sign(x) * (1 + 0.5 * math.sin(y)) + x,
}
CASES = [1.0, 1e-3, 100.0]  # of X


def check(checker, program, text, scale, is_current):
    title = f"{text} as a {'current' if is_current else 'voltage'}, {scale:g}"
    reads = "v(1)" if is_current else "i(b1)"
    law = text.replace("X", f"({reads}/{scale!r})").replace("Y", "v(2)")
    ohms = 10 * scale if is_current else 0.1 / scale
    cards = (f"I1 0 1 SIN(0.1 2 1)\nB1 1 0 I={law}\nR1 1 0 {ohms!r}" if is_current else
             f"V1 3 0 SIN(0.1 2 1)\nB1 1 0 V={law}\nR1 3 1 {ohms!r}")
    netlist = f"{title}\n{cards}\nV2 2 0 SIN(1 0.5 3)\nR2 2 0 1\n.save {reads}\n.tran 0.0625 2\n"
    result = run(program, netlist, method=None, at=AT, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    for t, value in zip(AT, result.column(reads)):
        y = 1 + 0.5 * math.sin(6 * math.pi * t)
        wanted = scale * meet(lambda x: LAWS[text](x, y, t), 0.1 + 2 * math.sin(2 * math.pi * t), 0.1)
        checker.close(value, wanted, 1e-4 * scale, f"{title} at {t:g} s")
    steps = result.report["work"]["euler_steps"]
    checker.check(steps < 100, f"{title}: {steps} steps of implicit Euler")


def check_words(checker, program):
    """Where no side has an answer, one may lie between them: that there is none is not shown."""
    result = run(program, "no side\nV1 3 0 0.1\nB1 1 0 V=sgn(i(b1))*(v(2)+0.2*abs(i(b1)))\nR1 3 1 0.1\nV2 2 0 1\nR2 2 0 1\n.op\n",
                 method=None)
    checker.check(result.status == 0 or "no solution exists" not in result.stderr, f"words: {result.stderr}")


TWO_CLAMPS = """a clamp that is a switch and one that is a jump
v1 p 0 sin({u} {u} {f})
r0 p n0 218.8
c0 n0 0 {c0}
rr0 n0 m0 0.219
cc0 m0 0 {c1}
rx0 n0 n1 231
s0 n0 0 n0 0 m0
.model m0 sw(vt={vs} ron=0.2188)
r1 p n1 2676
c1 n1 0 {c2}
b1 n1 0 i={{{g}*u(v(n1)-{vb})*abs(v(p))/{u}}}
.tran {step} {stop} uic
.end
"""


def check_contradictions(checker, program):
    """In no step is a jump of a formula on the side of its argument that it is not on: right, or refused."""
    for volts, time in ((5e3, 1.0), (5.0, 1e-3)):
        netlist = TWO_CLAMPS.format(u=volts, f=1 / time, c0=1.481e-4 * time, c1=1.481e-3 * time, c2=1.433e-4 * time,
                                    vs=0.4416 * volts, vb=0.4028 * volts, g=1.4946e-3 * volts, step=1e-3 * time, stop=0.136 * time)
        result = run(program, netlist, method=None)
        name = f"two clamps, {volts} V, {time} s"
        if result.status == 0:
            at = dict(zip(result.names, result.rows[-1]))
            checker.check(abs(at["v(n0)"] - 0.4416 * volts) < 1e-6 * volts and abs(at["v(n1)"] - 0.4028 * volts) < 1e-6 * volts,
                          f"{name}: {at}")
        else:
            checker.check("commutator(b1)" in result.stderr, f"{name}: {result.stderr}")


def main():
    program = sys.argv[1]
    checker = Checker("sliding_sources")
    check_words(checker, program)
    check_contradictions(checker, program)
    for text in kinds_of(LAWS):
        for scale in some_of(CASES):
            for is_current in (True, False):
                check(checker, program, text, scale, is_current)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
