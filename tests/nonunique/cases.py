#!/usr/bin/env python3
"""Messages and numbers about what a circuit does not determine, in circuits of engineers.

usage: cases.py PROGRAM glpk|no_glpk

Each case lists every signal of the report's nonunique: (lower, upper, because); "time" where it matters.
"""

import math
import pathlib
import random
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import NETLISTS, Checker, kinds_of, run  # noqa: E402

INF = math.inf
MODELS = ".model DI D(Ron=0 Vfwd=0)\n.model SW SW(Ron=0 Vt=0.5)\n.end\n"

TRANSFORMER = """Full-wave rectifier with an ideal transformer, while its source is 0 V
V1 a 0 DC 0
L1 a 0 {n}m
L2 s1 0 1m
L3 0 s2 1m
K12 L1 L2 1
K13 L1 L3 1
K23 L2 L3 1
D1 s1 o DI
D2 s2 o DI
Lf o out 1m ic=4
R out 0 1
.tran 10u 100u uic
"""
BRIDGE = "nothing conducts between a, b and m and the rest: s1, s2, d1, d2, d3 and d4 block"
COILS = "loops of v1, l1, l2, l3, d1 and d2, with perfectly coupled coils"

CASES = {
    "parallel to a short": ("""The current of a diode across a short
I1 0 a DC 1m
D1 a b DI
R0 a b 0
R1 b 0 1k
.op
""", {"i(d1)": (0, INF, "d1 parallel to r0")}),
    "measured, not saved": ("""Two diodes in parallel of which rows have none: their names are in messages all the same
I1 0 a DC 5m
D1 a b DI
D2 a b DI
R1 b 0 1k
.save v(a)
.tran 1m 10m
.meas tran x AVG i(D2)
.meas tran y MAX i(D1)
""", {"i(d1)": (0, 5e-3, "d1 parallel to d2"), "i(d2)": (0, 5e-3, "d1 parallel to d2")}),
    "a formula that measures": ("""A voltage that only .meas names floats
V1 in 0 DC -10
D1 in m DI
D2 m 0 DI
.save v(in)
.op
.tran 1m 10m
.meas tran x AVG v(m)
.meas tran y PARAM='2*x'
.four 100 v(in,m)
""", {"v(m)": (-10, 0, "stack d1-d2 blocks"), "v(in,m)": (-10, 0, "stack d1-d2 blocks")}),
    "parallel to a switch": ("""A closed switch and a diode
S1 c 0 ctl 0 SW ON
V1 ctl 0 1
D2 c 0 DI
I2 0 c DC 2m
.op
""", {"i(s1)": (-INF, 2e-3, "s1 parallel to d2"), "i(d2)": (0, INF, "s1 parallel to d2")}),
    "three in parallel": ("""Three diodes, of which one has Ron and takes no part
I1 0 e DC 3m
D1 e 0 DI
D2 e 0 DI
D3 0 e DI
D4 e 0 DR
.model DR D(Ron=1)
.op
""", {"i(d1)": (0, INF, "d1, d2 and d3 in parallel"), "i(d2)": (0, INF, "d1, d2 and d3 in parallel"),
      "i(d3)": (0, INF, "d1, d2 and d3 in parallel")}),
    "two loops": ("""One diode beside two in series, of which the second is double
I1 0 f DC 1
D1 f 0 DI
D2 f g DI
D3 g 0 DI
D4 g 0 DI
.op
""", {f"i(d{k})": (0, 1, "loops of d1, d2, d3 and d4") for k in (1, 2, 3, 4)}),
    "ring": ("""A ring of five diodes, written in no order
R1 a 0 1
D3 c d DI
D1 a b DI
D5 e a DI
D2 b c DI
D4 d e DI
.op
""", {f"i(d{k})": (0, INF, "loop d3-d4-d5-d1-d2") for k in (1, 2, 3, 4, 5)}),
    "held in a circle": ("""Antiparallel diodes without current hold m, so that x alone floats
V1 in 0 DC 5
D1 m 0 DI
D2 0 m DI
D3 m x DI
D4 x in DI
.op
""", {"v(x)": (0, 5, "stack d3-d4 blocks"), "i(d1)": (0, INF, "d1 antiparallel to d2"),
      "i(d2)": (0, INF, "d1 antiparallel to d2")}),
    "stack": ("""Five diodes that block
V1 in 0 DC -10
D1 in m1 DI
D2 m1 m2 DI
D3 m2 m3 DI
D4 m3 m4 DI
D5 m4 0 DI
.op
""", {f"v(m{k})": (-10, 0, "stack d1-d2-d3-d4-d5 blocks") for k in (1, 2, 3, 4)}),
    "one way": ("""A diode that blocks towards a node that nothing else holds
V1 in 0 DC 5
D1 m in DI
.op
""", {"v(m)": (-INF, 5, "nothing conducts between m and the rest: d1 blocks")}),
    "an open switch": ("""A node between an open switch and a diode
V1 in 0 DC 5
S1 in m 0 0 SW
D1 m 0 DI
.op
""", {"v(m)": (-INF, 0, "nothing conducts between m and the rest: s1 and d1 block")}),
    "capacitors": ("""The middle of two capacitors at an operating point; then they hold it
V1 in 0 DC 5
C1 in m 1u
C2 m 0 1u
.op
.tran 1u 10u
""", {"v(m)": (-INF, INF, "nothing conducts between m and the rest: c1 and c2 block")}),
    "inductors": ("""Inductors in parallel at an operating point
I1 0 a DC 1
L1 a 0 1m
L2 a 0 1m
.op
""", {"i(l1)": (-INF, INF, "l1 parallel to l2"), "i(l2)": (-INF, INF, "l1 parallel to l2")}),
    "held by .ic": ("""The voltage that .ic holds leaves the current of a diode beside it open
V1 a 0 DC 0
D1 a b DI
C1 b 0 1u
R1 b 0 1k
.ic v(b)=0
.tran 1u 10u
""", {"i(v1)": (-INF, 0, "loop v1-.ic-d1"), "i(d1)": (0, INF, "loop v1-.ic-d1")}),
    "starts from nothing": ("""Two diodes share a current that starts at 0 A
I1 0 a PWL(0 0 1m 1m)
D1 a b DI
D2 a b DI
R1 b 0 1k
L1 b 0 1
.tran 1u 1m uic
""", {"i(d1)": (0, "time", "d1 parallel to d2"), "i(d2)": (0, "time", "d1 parallel to d2")}),
    "tied for a while": (NETLISTS / "hard" / "hc26.cir",
                         {"i(d1)": (0, "twice", "loop v1-d2-d1"), "i(d2)": (0, "twice", "loop v1-d2-d1"),
                          "i(v1)": ("twice", 0, "loop v1-d2-d1")}),
    "ties at instants": (NETLISTS / "hard" / "hc25.cir", {}),
    "ill-conditioned": (NETLISTS / "hard" / "hc10.cir", {}),
    "all at rest": ("""A bridge without voltage: all diodes are tied, and nothing is open
V1 a b DC 0
D1 a p DI
D2 b p DI
D3 0 a DI
D4 0 b DI
R1 p 0 1
.op
""", {}),
    "between two parts": ("""A voltage between two nodes that both float
V1 in 0 DC -10
D1 in a DI
D2 a 0 DI
V2 io 0 DC -4
D3 io b DI
D4 b 0 DI
.op
.save v(a,b) v(a)
""", {"v(a,b)": (-10, 4, "stack d3-d4 blocks"), "v(a)": (-10, 0, "stack d1-d2 blocks")}),
    "not passive": ("""Positive feedback through a diode, which blocks at -1 V or conducts at 1 V
E1 e 0 a 0 3
D1 e b DI
R1 b a 1
R2 a 0 1
I1 0 a DC -1
.op
""", {signal: (lower, upper, "2 solutions of a circuit that is not passive")
      for signal, lower, upper in (("v(e)", -3, 3), ("v(a)", -1, 1), ("v(b)", -1, 3),
                                   ("i(e1)", -2, 0), ("i(d1)", 0, 2))}),
    "not passive, beside an integrator": ("""The same while the source of an integrator drives 1 TA
E1 e 0 a 0 3
D1 e b DI
R1 b a 1
R2 a 0 1
I1 0 a DC -1
G2 0 psi a 0 1e12
Rp psi 0 1
.op
""", {signal: (lower, upper, "2 solutions of a circuit that is not passive")
      for signal, lower, upper in (("v(e)", -3, 3), ("v(a)", -1, 1), ("v(b)", -1, 3),
                                   ("i(e1)", -2, 0), ("i(d1)", 0, 2), ("v(psi)", -1e12, 1e12))}),
    "one solution beside an integrator": ("""A diode blocks 20 mV for good: 0.2 mA of its neighbours are nothing beside 10 TA
V1 in 0 PULSE(20 -20 0 0 0 10u 20u)
Rm in a 1k
B2 0 psi I=1e12*v(in,a)
C1 psi 0 1
D1 a out DI
Rr a out 1k
R1 out 0 10
.tran 0.2u 1u uic
""", {}),
    "a core beside an integrator": ("""A core that saturates, its flux by an integrator of 1 V for each uVs
V1 in 0 PULSE(20 -20 0 0 0 10u 20u)
B1 in a I=pwl(v(psi)*1u, -100u, -12.5025, -50u, -2.5m, 50u, 2.5m, 100u, 12.5025)
B2 0 psi I=1e6*v(in,a)
C1 psi 0 1
D1 a out DI
Rr a out 1k
R1 out 0 10
.tran 2u 2m uic
""", {}),
    "before the first switch closes": ("""No current yet: 12 V across two coils are not to be taken for one
V1 in 0 DC 12
V2 g 0 PULSE(0 1 0 10n 10n 2u 10u)
S1 in a g 0 SM
S2 b 0 g 0 SM
D1 a in DF
D2 0 a DF
D3 b in DF
D4 0 b DF
L1 a m 158.9u
L2 m b 31.77m
.model DF D(Ron=0 Vfwd=0.7)
.model SM SW(Ron=1 Vt=0.5)
.tran 10n 4n uic
""", {signal: (-0.7, 12.7, BRIDGE) for signal in ("v(a)", "v(b)", "v(m)")}),
}
COILS_CASES = {
    "transformer": (TRANSFORMER.format(n=1), {
        "i(v1)": (-4, 4, COILS), "i(l1)": (-4, 4, COILS), "i(l2)": (-4, 0, COILS),
        "i(l3)": (0, 4, COILS), "i(d1)": (0, 4, COILS), "i(d2)": (0, 4, COILS)}),
    "transformer 2:1": (TRANSFORMER.format(n=4), {
        "i(v1)": (-2, 2, COILS), "i(l1)": (-2, 2, COILS), "i(l2)": (-4, 0, COILS),
        "i(l3)": (0, 4, COILS), "i(d1)": (0, 4, COILS), "i(d2)": (0, 4, COILS)}),
    "a transistor of a flyback converter": ("""Its diode is across it; the coils on its node carry what they do
V1 a 0 0
L1 a b 1m ic=2
L2 0 s 0.25m
K1 L1 L2 1
S1 b 0 on 0 SW
D1 0 b DI
D2 s o DI
R1 o 0 1k
V2 on 0 1
.tran 1u 10u uic
""", {"i(s1)": (2, INF, "s1 parallel to d1"), "i(d1)": (0, INF, "s1 parallel to d1")}),
    "a thyristor with a diode across it": ("""Switch and valve of the thyristor are one branch beside the diode
V1 a 0 6
V2 g b 1
A1 a b g m
D1 b a DI
R1 b 0 2
.model m gto
.tran 1u 10u uic
""", {"i(a1)": (3, INF, "a1 parallel to d1"), "i(d1)": (0, INF, "a1 parallel to d1")}),
    "a switch behind a diode, and a diode across both": ("""Three elements in a loop: none of them is a part of another
I1 0 a 3
V1 g 0 1
S1 a c g 0 SW
D2 c b DI
D1 b a DI
R1 b 0 2
.tran 1u 10u uic
""", {"i(s1)": (3, INF, "loop s1-d2-d1"), "i(d2)": (3, INF, "loop s1-d2-d1"), "i(d1)": (0, INF, "loop s1-d2-d1")}),
    "a rectifier behind a transformer": ("""Its diodes share the current of a choke, and none of it goes through the winding
I1 a 0 0
R1 a 0 1
L1 a 0 4m
L2 x y 1m
K1 L1 L2 1
D1 x p DI
D2 y p DI
D3 0 x DI
D4 0 y DI
L3 p 0 1m ic=4
.tran 1u 10u uic
""", {f"i({d})": (0, 4, "loop d1-d2-d4-d3") for d in ("d1", "d2", "d3", "d4")}),
}


def bound(wanted, entry):
    """A bound, in terms of the time or of the value where it is only known then. What decays through
    1 ohm and 1 mH is a step of implicit Euler smaller when that method sees it."""
    wanted = {"time": entry["time"], "twice": 2 * entry["value"]}.get(wanted, wanted)
    return wanted / (1 + entry["time"] / 1e-3) if entry["because"] == COILS else wanted


def compare(checker, name, netlist, wanted, program, method):
    text = netlist if isinstance(netlist, pathlib.Path) else netlist + MODELS
    result = run(program, text, method=method, quiet=False)
    what = f"{name} with {method or 'the default'}"
    if not checker.check(result.status == 0, f"{what}: exit {result.status}: {result.stderr}"):
        return None
    found = {entry["signal"]: entry for entry in result.report["nonunique"]}
    if wanted is None:
        return result
    checker.check(set(found) == set(wanted), f"{what}: {sorted(found)}, not {sorted(wanted)}")
    for signal in set(found) & set(wanted):
        entry, (lower, upper, because) = found[signal], wanted[signal]
        for key, value in (("lower", bound(lower, entry)), ("upper", bound(upper, entry))):
            reported = float(entry[key])
            checker.check(reported == value or abs(reported - value) <= 1e-9 * (abs(value) or 1),
                          f"{what}: {key} of {signal} is {reported!r}, not {value!r}")
        checker.check(entry["because"] == because, f"{what}: {entry['because']}, not {because}")
        checker.check(float(entry["lower"]) <= entry["value"] <= float(entry["upper"])
                      or abs(entry["value"]) < 1e-9, f"{what}: {entry}")
        # currents are warnings; voltages, and a switch beside a diode, are notes of fewer words
        warnings = re.findall(r"(?:warning|note): .*not determined: .*", result.stderr)
        brief = because.split(" and the rest: ")[-1]
        checker.check(any(signal in w and brief in w for w in warnings),
                      f"{what}: no message names {signal} and says {brief}: {result.stderr}")
        checker.check(sum(f"{signal} may be" in w for w in warnings) <= 2, result.stderr)
    return result


# The reverse voltage of a diode counts from 0 V, not from its knee, whatever its resistance.
KNEES = {
    "a capacitor behind a diode": ("V1 in 0 700\nR1 in x 1k\nD1 x c DK\nC1 c 0 1u\n", {"v(c)": 700}),
    "a charge pump at rest": ("V1 a 0 5\nR1 a x 1k\nD1 x n DK\nD2 n m DK\nD3 m c DK\nC1 n 0 1u\nC2 m h 1u\n"
                              "C3 c 0 1u\nV2 h 0 5\n", {"v(n)": 5, "v(m)": 5, "v(c)": 5}),
    "the other way round": ("V1 in 0 12\nR1 in x 1k\nD1 c x DK\nC1 c 0 1u\n", {"v(c)": 12}),
}


def compare_knees(checker, program):
    for name, (circuit, wanted) in KNEES.items():
        for resistance in ("0", "1m", "1", "30", "1k", "100k"):
            result = run(program, f"{name}\n{circuit}.model DK D(Ron={resistance} Vfwd=0.7)\n.op\n.end\n", method=None)
            found = {entry["signal"]: entry["value"] for entry in result.report["nonunique"]}
            checker.check(all(abs(found.get(k, math.nan) - v) <= 1e-9 * v for k, v in wanted.items()),
                          f"{name}, Ron={resistance}: {found}, not {wanted}")


COMMUTATION = """A bridge that commutates: for a while all its diodes conduct, though neither at first nor at last
V1 in m SIN(0 118 60)
Rs in s 2
D1 s p DI
D2 m p DI
D3 0 s DI
D4 0 m DI
L1 p q 0.6
R1 q 0 40
Rg m 0 400k
.tran 40u 40m uic
"""


def compare_commutation(checker, program, method):
    """With the source's current i: between max(0, i) and the coil's current less max(0, -i) in d1, and so on."""
    result = run(program, COMMUTATION + MODELS, method=method)
    what = f"commutation with {method or 'the default'}"
    found = {entry["signal"]: entry for entry in result.report["nonunique"]}
    if not checker.check(sorted(found) == ["i(d1)", "i(d2)", "i(d3)", "i(d4)"], f"{what}: {sorted(found)}"):
        return
    least = {name: float(entry["lower"]) for name, entry in found.items()}
    widths = [float(entry["upper"]) - float(entry["lower"]) for entry in found.values()]
    current = 59 * math.sin(2 * math.pi * 60 * found["i(d1)"]["time"])
    checker.check(min(widths) > 1e-3 and max(widths) - min(widths) < 1e-6, f"{what}: widths {widths}")
    checker.check(abs(least["i(d1)"] - max(0, current)) < 1e-4 and abs(least["i(d2)"] - max(0, -current)) < 1e-4,
                  f"{what}: {least} at {current} A")


# Who moves a switch does not decide what is open: gates g and h, high and low, come from sources or from what reads them.
DRIVES = {
    "V sources": "Vg g 0 1\nVh h 0 0\n",
    "E sources": "Vq q 0 2\nEg g 0 q 0 0.5\nEh h 0 q 0 0\n",
    "formulas": "Vq q 0 0.7\nBg g 0 V=max(v(q),1-v(q))+0.3*u(v(q))\nBh h 0 V=min(v(q),0)\n",
    "currents": "Vq q 0 1m\nGg 0 g q 0 1\nRg g 0 1k\nFh 0 h Vq 0\nRh h 0 1k\n",
    "a triangle and a sine": "Vt tri 0 PULSE(0 1 0 25u 25u 1n 60u)\nVr sine 0 SIN(2 0.1 50)\nBg g 0 V=v(sine)-v(tri)\n"
                             "Bh h 0 V=-v(sine)+v(tri)\n",
}
DRIVEN = {
    "a star behind open switches": (1, "V1 a 0 5\nS1 a x h 0 SW\nS2 y 0 h 0 SW\nR1 x n 1\nR2 y n 1\nC1 x y 1u ic=1\n"),
    "a switch across a diode": (1, "I1 0 a 3\nD1 a b DI\nS1 a b g 0 SW\nR1 b 0 2\n"),
    "two switches side by side": (1e-3, "I1 0 a 4m\nS1 a b g 0 SW\nS2 a b g 0 SW\nR1 b 0 2\n"),
    "a diode and a switch in series": (1e3, "V1 a 0 -800\nD1 a m DI\nS1 m b h 0 SW\nR1 b 0 1k\n"),
    "a bridge that blocks": (325, "V1 a b 325\nD1 a p DI\nD2 b p DI\nD3 n a DI\nD4 n b DI\nC1 p n 1m ic=600\nS1 p o h 0 SW\n"
                                  "R1 o n 10\n"),
    "a half of a Vienna rectifier": (700, "V1 s 0 100\nL1 s a 2m ic=0\nD1 a p DI\nD2 n a DI\nS1 a m h 0 SW\nC1 p m 500u ic=350\n"
                                          "C2 m n 500u ic=350\n"),
    "a stack of thousand volts": (1e4, "V1 a 0 9k\nD1 b a DI\nD2 c b DI\nD3 d c DI\nS1 d 0 g 0 SW\n"),
    "what only a switch joins": (1, "V1 a 0 1\nR0 a 0 1\nS1 a x h 0 SW\nL1 x y 1m ic=0\nR1 y z 1\nS2 z 0 h 0 SW\nD1 0 x DI\n"),
    "one loop of a switch and diodes": (2, "I1 0 a 2\nD1 a b DI\nD2 b c DI\nS1 a c g 0 SW\nR1 c 0 1\nD3 b d DI\nR2 d 0 1\n"),
    "micro": (1e-6, "I1 0 a 1u\nS1 a b g 0 SW\nD1 a b DI\nC1 b 0 1p ic=0\nR1 b 0 1Meg\n"),
}


# Of implicit Euler: which values are taken is not the documented choice, the least norm, with every drive.
VALUES_DIFFER = {("micro", "euler")}


def compare_drives(checker, program, method):
    for name, (scale, host) in DRIVEN.items():
        first = None
        for drive, cards in DRIVES.items():
            what = f"{name} by {drive} with {method or 'the default'}"
            result = run(program, f"{what}\n{host}{cards}.tran 1u 20u uic\n{MODELS}", method=method, quiet=False)
            if not checker.check(result.status == 0 and "not passive" not in result.stderr, f"{what}: {result.stderr}"):
                continue
            found = {entry["signal"]: entry for entry in result.report["nonunique"]}
            first = found if first is None else first
            checker.check(found and set(found) == set(first), f"{what}: {sorted(found)}, not {sorted(first)}")
            for signal in set(found) & set(first):
                for key in ("lower", "upper") if (name, method) in VALUES_DIFFER else ("lower", "upper", "value"):
                    got, wanted = float(found[signal][key]), float(first[signal][key])
                    checker.check(got == wanted or abs(got - wanted) <= 1e-9 * scale,
                                  f"{what}: {key} of {signal} is {got!r}, not {wanted!r}")


def compare_many(checker, program):
    """Only so many signals are listed, and a message says how many more there are."""
    n = 600
    text = "Many pairs\n" + "".join(f"I{k} 0 n{k} 1\nD{k}a n{k} 0 DI\nD{k}b n{k} 0 DI\n"
                                    for k in range(n)) + ".op\n" + MODELS
    result = run(program, text, method=None, quiet=False)
    checker.check(len(result.report["nonunique"]) == 1000, f"{len(result.report['nonunique'])}")
    checker.check("1100 more signals are not determined; the report lists the first 1000"
                  in result.stderr, result.stderr[-500:])


def compare_functions(checker, program):
    """Modes of a tangent that the function itself does not have are no answers; those of a latch beside one are."""
    for volts in (2, 300, 900, 1400):
        card = "i=2.2e-15*(exp(abs(v(3))/22)-1)*sgn(v(3))"
        done = run(program, f"a varistor\nb1 3 0 {card}\nr1 n 3 54m\nv1 n 0 {volts}\nr2 n 0 4.4g\n.op\n.end\n", method=None)
        checker.check(done.status == 0 and "not determined" not in done.stderr, f"a varistor at {volts} V: {done.stderr}")
        v = done.column("v(3)")[0]
        checker.close(2.2e-15 * math.expm1(v / 22), (volts - v) / 54e-3, 1e-6 * max((volts - v) / 54e-3, 1e-6), f"its current at {volts} V")
    for card in ("b2 p 0 v=v(q)*v(a)", "b2 p 0 v=exp(v(a))+v(q)", "b2 p 0 v=sqrt(v(a))"):
        done = run(program, f"a latch\nv1 a 0 2\nb1 q 0 v=5*sgn(v(q)+1e-4*v(a)*v(a))\nr1 q 0 1k\n{card}\nr2 p 0 1k\n.op\n.end\n", method=None)
        checker.check(done.status in (0, 4) and "v(q)" in done.stderr and "solutions of a circuit" in done.stderr, f"{card}: {done.stderr}")


def compare_shares(checker, program):
    """What the last stage of a full-wave multiplier gives its load goes by two equal ways of two diodes, one half by each, in any
    order of the elements, and no mode in which they share moves a state elsewhere."""
    for n, seed, load in ((4, 0, "1meg"), (4, 1, "1meg"), (4, 2, "1meg"), (5, 0, "1meg"), (5, 3, "1meg"), (6, 0, "1meg"), (6, 9, "20k")):
        cards = ["v1 a 0 sin(0 100 10k)", "v2 b 0 sin(0 -100 10k)", f"rl s{n} 0 {load}", "v0 s0 0 0"]
        for k in range(n):
            below = [f"{node}{k - 1}" if k > 0 else node for node in "ab"]
            cards += [f"d{k}a s{k} a{k} DI", f"d{k}b s{k} b{k} DI", f"d{k}c a{k} s{k + 1} DI", f"d{k}d b{k} s{k + 1} DI",
                      f"ca{k} {below[0]} a{k} 10n", f"cb{k} {below[1]} b{k} 10n", f"cs{k} s{k} s{k + 1} 10n"]
        random.Random(seed).shuffle(cards)
        what = f"a multiplier of {n} stages, order {seed}"
        done = run(program, "\n".join([what, *cards, ".tran 2u 45u uic", MODELS]), method=None, options=["--tol", "1e-8"])
        if checker.check(done.status == 0, f"{what}: {done.stderr}"):
            checker.check(done.report["work"]["euler_steps"] == 0, f"{what}: steps of implicit Euler")
            current = [done.at(f"i(d{n - 1}{branch})", 40e-6) for branch in "abcd"]
            half = sum(current) / 4
            checker.check(half > 1e-6, f"{what}: {current}")
            for value in current:
                checker.close(value, half, 1e-9 * half, f"{what}: a share of {current}")


def main():
    program, glpk = sys.argv[1:]
    checker = Checker("cases")
    for method in (None, "euler"):
        for name, (netlist, wanted) in kinds_of(CASES.items()):
            compare(checker, name, netlist, wanted, program, method)
        for name, (netlist, wanted) in kinds_of(COILS_CASES.items()):
            if glpk == "glpk":
                compare(checker, name, netlist, wanted, program, method)
            else:
                result = compare(checker, name, netlist, None, program, method)
                checker.check("without GLPK" in result.stderr, result.stderr)
        compare_commutation(checker, program, method)
        compare_drives(checker, program, method)
    compare_many(checker, program)
    compare_functions(checker, program)
    compare_knees(checker, program)
    compare_shares(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
