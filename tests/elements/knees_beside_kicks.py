#!/usr/bin/env python3
"""Knees of formulas beside what is far larger: the formula's value against the formula of the rows.

usage: knees_beside_kicks.py PROGRAM

A coil that a switch of Roff cuts off throws a voltage of 1e7 to 1e10 V, and then a diode begins to conduct a leak, which a
formula reads times a gain. Its knees are where the leak begins, so that the knee's argument grows from exactly 0: by less
than the tolerance of the kick's volts, and by all of what the formula gives. A cable of 40 or 90 sections makes the part
large, where steps are on factors and no map tells what a guard is off by.
"""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # noqa: E402

CASES = ((500, 50, 1e8, 84, 50, 1e-3, 0.25), (3000, 300, 1e7, 20, 400, 1e-2, 0.3), (12, 1, 1e9, 1e6, 1e4, 1e-6, 0.1),
         (325, 10, 1e8, 1000, 50, 2e-3, 0.2))


def limit(a, low, high):
    return max(low, min(high, a))


FORMULAS = {
    "min(1,max(0,{k}*i(v5)))": lambda x, v: limit(x, 0, 1),
    "abs({k}*i(v5))": lambda x, v: abs(x),
    "limit({k}*i(v5),-1,2)*2": lambda x, v: 2 * limit(x, -1, 2),
    "max(0,{k}*i(v5))-min(0,2*{k}*i(v5))": lambda x, v: max(0, x) - min(0, 2 * x),
    "table({k}*i(v5),-1,-1,0,0,1,3)": lambda x, v: -1 if x < -1 else min(x, 0) + 3 * limit(x, 0, 1),
    "max(0,1m*v(y))": lambda x, v: max(0, 1e-3 * v),
    "1-min(1,max(0,{k}*i(v5)))+max(0,v(y)*0.1m)": lambda x, v: 1 - limit(x, 0, 1) + max(0, v * 1e-4),
    "min(1,max(0,{k}*i(v5)-max(0,{k}*i(v5)-2)))": lambda x, v: limit(x - max(0, x - 2), 0, 1),
}


def cards(case, formula, sections):
    volts, ohms, roff, gain, frequency, henries, load = case
    period = 1 / frequency
    cable = [f"RC{k} {'n1' if k == 0 else f'q{k - 1}'} q{k} 100" for k in range(sections)]
    return ["a knee beside a kick", f"V1 in 0 SIN(0 {volts} {frequency})", f"R0 in n1 {ohms * 1e-3}", f"R1 n1 a {ohms}",
            f"L1 a b {henries}", "S2 b 0 h 0 SK", f"Vh h 0 PULSE(1 0 {0.2 * period} 1n 1n {0.1 * period} {period})",
            "V5 n1 x 0", "D1 x y D", "S1 y z g 0 SK", f"Rz z 0 {ohms * load}",
            f"Vg g 0 PULSE(0 1 {1.8 * period} 1n 1n {0.01 * period} {period})", f"B1 k 0 V={{{formula.format(k=gain)}}}",
            "R9 k 0 1k", *cable, f"CC q{sections - 1} 0 1n", ".model D D(ron=0)", f".model SK SW(ron=0 roff={roff} vt=0.5)",
            ".save v(k) v(y) i(v5) v(b)", f".tran {period / 200} {3 * period}", ".end"]


# A coil's valves that cut it off, and beside them valves that stay closed by comparisons of their currents.
VALVES = """comparisons beside a kick
V1 s 0 SIN(0 1000 50)
L1 s a 0.6m
R1 a b 70m
R2 b 0 60
L0 b 0 70m
L2 b t 21m
D1 t x1 D
Vs1 x1 y1 0
S1 y1 0 l1 0 MOS
B1 l1 0 V=v(g1)+u(i(Vs1)-1m)
Rl1 l1 0 1.4k
D2 0 x2 D
Vs2 x2 y2 0
S2 y2 t l2 0 MOS
B2 l2 0 V=v(g2)+u(i(Vs2)-1m)
Rl2 l2 0 1.4k
D3 w x3 D
Vs3 x3 y3 0
S3 y3 0 l3 0 MOS
B3 l3 0 V=v(g)+u(i(Vs3)-{amperes})
Rl3 l3 0 1.4k
D4 0 x4 D
Vs4 x4 y4 0
S4 y4 w l4 0 MOS
B4 l4 0 V=v(g)+u(i(Vs4)-{amperes})
Rl4 l4 0 1.4k
Vg1 g1 0 PULSE(0 1 7m 1u 1u 200u 20m)
Vg2 g2 0 PULSE(0 1 17m 1u 1u 200u 20m)
C1 b u 100u
L3 u w 0.3m
Vg g 0 PULSE(0 1 {at} 1u 1u 50m 200m)
.model MOS SW(Ron=20m Roff=1e12 Vt=0.5)
.model D D(Ron=20m Roff=1e12 Vfwd=0.7)
.tran 100u 70m uic
.end
"""


def compare_valves(checker, program):
    """A comparison changes when its sides are equal, beside whatever kick."""
    for at, amperes in (("40m", 1e-3), ("20m", 1e-3), ("30m", 1e-2), ("60m", 1e-3), ("20m", 1e-2)):
        what = f"valves at {at}, {amperes} A"
        done = dalcs_program.run(program, VALVES.format(at=at, amperes=amperes), method=None, options=["--audit", "off"])
        if not checker.check(done.status == 0, f"{what}: {done.stderr}"):
            continue
        rows = list(zip(*(done.column(name) for name in ("v(l3)", "v(g)", "i(vs3)", "v(l4)", "i(vs4)"))))
        worst = max([abs(amps - amperes) for latch, gate, amps, *_ in rows if (latch - gate > 0.5) != (amps > amperes)] +
                    [abs(row[4] - amperes) for row in rows if (row[3] - row[1] > 0.5) != (row[4] > amperes)] + [0.0])
        checker.check(worst < 1e-8, f"{what}: a comparison is off by {worst} A")
        checker.check(max(abs(v) for v in done.column("v(t)")) > 1e5, f"{what}: there is no kick")


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("knees_beside_kicks")
    every = itertools.product(enumerate(CASES), FORMULAS.items(), (1, 40, 90))
    for (number, case), (formula, value), sections in dalcs_program.some_of(list(every), 1):
        what = f"{number}, {sections} sections: {formula}"
        done = dalcs_program.run(program, "\n".join(cards(case, formula, sections)) + "\n", method=None)
        if not checker.check(done.status == 0, f"{what}: {done.stderr}"):
            continue
        rows = list(zip(done.column("v(k)"), done.column("i(v5)"), done.column("v(y)")))
        largest = max(abs(row[0]) for row in rows)
        worst = max(abs(given - value(case[3] * amperes, volts)) for given, amperes, volts in rows)
        checker.check(worst <= 1e-6 * largest, f"{what}: off by {worst} of {largest}")
        checker.check(max(map(abs, done.column("v(b)"))) > 1e4 * case[0], f"{what}: there is no kick")
    compare_valves(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
