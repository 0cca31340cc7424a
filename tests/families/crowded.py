#!/usr/bin/env python3
"""Circuits in which much happens at nearly the same time: none may need steps of implicit Euler.

usage: crowded.py PROGRAM closed|flurry|random

closed: two capacitors in parallel start with different voltages, which jump to their mean weighted with the
capacitances, while a source charges both so fast that the jump is small beside what moves in a
micro-step. v(t) = V - (V - v(0+)) exp(-t / (R C)), exactly.

random: circuits that were drawn from R, L, C, diodes and a sine, chosen because they once fell back or
were wrong: diodes without current or voltage beside others that commutate, parallel capacitors,
jumps within transients, small currents that end soon after or together with another event, signs that are
wrong for less than times can be told apart. Without a closed form 7 or 9 stages, with two tolerances, must
agree with 5 stages and a much smaller one; signals that the circuit leaves open do not count.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

PARALLEL = """two capacitors in parallel, charged at once
v1 in 0 10
r1 in a 0.01
c1 a 0 10u ic=-2
c2 0 a 1u ic=1
.tran 1m 64m uic
.end
"""

RANDOM = {
    "two capacitors beside a source": """
v1 s 0 sin(0 100 60 0 0 30)
rs s n1 0.1
r1 n1 0 100
r2 n2 0 100k
r3 n3 0 10k
d1 n1 n2 di
d2 n3 n2 di
d3 n3 n1 di
c4 n1 0 10u ic=-2
c5 0 n2 1u ic=0
c6 0 n1 1u ic=1
l7 n3 n2 10m
r8 n3 0 100
r9 n3 0 10
.model di d
.tran 300u 66m uic
""",
    "a diode at rest beside four": """
v1 s 0 sin(0 100 1k 0 0 90)
rs s n1 1
r1 n1 0 100
r2 n2 0 100k
r3 n3 0 100
r4 n4 0 1k
r5 n5 0 10k
d1 n2 n4 di
d2 n5 0 di
d3 n2 n1 di
d4 n1 0 di
d5 n3 n5 di
c6 n3 n5 1u ic=1
c7 n5 n2 10u ic=-2
l8 n4 n1 1m
l9 n4 n2 10m
r10 n3 0 100
.model di d
.tran 20u 4m uic
""",
    "50 uA beside 100 A": """
v1 s 0 sin(0 10 1k 0 0 90)
rs s n1 0.1
r1 n1 0 100
r2 n2 0 10k
r3 n3 0 100k
r4 n4 0 100
r5 n5 0 100
d1 n5 n3 di
d2 0 n2 di
d3 n1 n5 di
c4 n4 n5 100n ic=1
c5 0 n4 1u ic=1
c6 n5 n2 100n
l7 n1 n5 10m
r8 n5 n2 100
.model di d
.tran 20u 4m uic
""",
    "a switch that leaves 0.1 mA the wrong way, beside 1000 A": """
v1 s 0 sin(0 10 1k)
rs s n1 0.1
r1 n1 0 1k
r2 n2 0 10k
d1 n1 n2 di
d2 n1 n2 di
d3 n1 0 di
c4 n1 n2 100n
vg g 0 pulse(0 1 0 0.1u 0.1u 30u 100u)
s5 s n2 g 0 sm
s6 s 0 g 0 sm
.model sm sw(vt=0.5 vh=0 ron=0.01)
.model di d
.tran 2u 0.8m uic
""",
    "a flank that takes over from 50 nA within 1e-16 s": """
v1 s 0 pulse(-5 10 0 0.1u 0.1u 40u 100u)
rs s n1 1
r1 n1 0 10k
r2 n2 0 10k
d1 n2 n1 di
d2 n2 n1 di
c6 0 n2 10n
l7 n1 0 100u
vg g 0 pulse(0 1 0 0.1u 0.1u 50u 100u)
s8 n2 s g 0 sm
.model sm sw(vt=0.5)
.model di d
.tran 2u 0.8m uic
""",
    "a voltage that dies away between two nodes": """
v1 s 0 sin(1 10 50)
rs s n1 10
r1 n1 0 10k
r2 n2 0 100
r3 n3 0 10k
r4 n4 0 100k
d1 n4 n3 di
d2 n4 n1 di
c3 n1 n2 100n ic=1
l4 n4 n2 1m
l5 0 n2 100u
r6 0 n3 1k
.model di d
.tran 400u 80m uic
""",
    "a choke that is left with a leak of 1 Mohm": """
v1 in 0 5
vg g 0 pulse(0 1 2.6u 20n 20n 10u 20u)
s1 in sw g 0 sm
d1 0 sw di
l1 sw out 30u
c1 out 0 40u
r1 out 0 20
.model sm sw(vt=0.5 roff=1meg)
.model di d
.tran 1u 2.4m uic
""",
}


def closed(program, checker):
    capacitance = 11e-6
    start = (-2 * 10e-6 - 1 * 1e-6) / capacitance
    at = [0.5e-7 * (k + 1) for k in range(40)] + [1e-3, 64e-3]
    exact = [10 - (10 - start) * math.exp(-t / (0.01 * capacitance)) for t in at]
    for tolerance in 1e-6, 1e-9:
        result = run(program, PARALLEL, at=at, method=None, tolerance=tolerance)
        if not checker.check(result.status == 0, f"{tolerance}: {result.stderr}"):
            continue
        worst = max(abs(a - b) for a, b in zip(result.column("v(a)"), exact)) / 10
        print(f"{tolerance}: {worst:.1e}, {result.report['work']['euler_steps']} steps of Euler")
        checker.check(worst <= tolerance, f"{tolerance}: off by {worst:.1e}")
        checker.check(result.report["work"]["euler_steps"] == 0, f"{tolerance}: fell back")


def random(program, checker):
    for name, body in RANDOM.items():
        netlist = name + body + ".end\n"
        stop = float(body.split(".tran ")[1].split()[1].removesuffix("m")) * 1e-3
        at = [stop * (k + 0.37) / 501 for k in range(500)]
        exact = run(program, netlist, at=at, method="radau", stages=5, tolerance=1e-11)
        if not checker.check(exact.status == 0, f"{name}: {exact.stderr}"):
            continue
        for stages, tolerance in (7, 1e-6), (7, 1e-9), (9, 1e-9):
            case = f"{name}, {stages} stages, {tolerance}"
            result = run(program, netlist, at=at, method="radau", stages=stages,
                         tolerance=tolerance)
            if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
                continue
            still_open = {s["signal"] for r in (exact, result) for s in r.report["nonunique"]}
            worst = 0.0
            for signal in set(exact.names) - still_open - {"time"}:
                scale = max(max(map(abs, exact.column(signal))), 1e-5 * exact.scale(signal))
                off = max(abs(a - b) for a, b in zip(exact.column(signal), result.column(signal)))
                worst = max(worst, off / scale)
            print(f"{case}: {worst:.1e}, {result.report['work']['euler_steps']} steps of Euler")
            checker.check(worst <= tolerance, f"{case}: off by {worst:.1e}")
            checker.check(result.report["work"]["euler_steps"] == 0, f"{case}: fell back")


# Switches that cut off a coil on a floating source, and diodes that then carry nothing: rounding of what is 0
# may go to and fro every 2e-13 s.
NOTHING_LEFT = """switches open on a coil, and nothing flows any more
Vac s b SIN(0 50 400)
Rds s ds 0.005
Ls ds a 0.0004
Vgg2 g2 0 PULSE(0 1 0.0014 2e-07 2e-07 3e-05 0.003)
S1 a i1 0 0 sw
D1 i1 q dm
D4 0 b dm
S2 b i2 g2 0 sw
D2 i2 q dm
S3 0 i3 g2 0 sw
D3 i3 a dm
Cj3 i3 a 2e-11
Dfw 0 q dm
Ll q 0 0.03
.model sw SW(VT=0.5)
.model dm D(Vfwd=0.5 Ron=0.01)
.tran 3e-06 0.0015
"""


def flurry(program, checker):
    """The run ends; what the switches cut off is lost at once; nothing flows behind it."""
    result = run(program, NOTHING_LEFT, method="auto")
    if checker.check(result.status == 0, f"flurry: {result.stderr}"):
        events = len(result.report["events"])
        checker.check(events < 20000, f"flurry: {events} events")
        late = [abs(i) for t, i in zip(result.time, result.column("i(ls)")) if t > 1.431e-3]
        checker.check(max(late) < 1e-9, f"flurry: {max(late)} A behind the interruption")


def main():
    program, which = sys.argv[1:]
    checker = Checker(f"crowded {which}")
    {"closed": closed, "flurry": flurry, "random": random}[which](program, checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
