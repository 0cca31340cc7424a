#!/usr/bin/env python3
"""What each element and source does, against closed forms.

usage: elements.py PROGRAM
"""

import math
import pathlib
import sys
import tempfile
from fractions import Fraction

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

EXACT = 1e-9  # relative, at a tolerance of 1e-11
TURN = 2 * math.pi


class Case:
    """Runs one netlist and compares its signals."""

    def __init__(self, checker, program, netlist, at=None):
        self.checker = checker
        self.title = netlist.splitlines()[0]
        self.result = run(program, netlist, method=None, tolerance=1e-11, at=at)
        checker.check(self.result.status == 0,
                      f"{self.title}: exit status {self.result.status}\n{self.result.stderr}")

    def is_at(self, signal, time, wanted, tolerance=EXACT):
        if self.result.rows:
            self.checker.close(self.result.at(signal, time), wanted, tolerance,
                               f"{self.title}: {signal} at {time:g}")

    def says(self, text):
        self.checker.check(text in self.result.stderr,
                           f"{self.title}: '{text}' is not in\n{self.result.stderr}")


# ---- Operating points ---------------------------------------------------------------------------


def operating_point_balances(checker, program):
    """Microamperes beside 400 V and 0.1 ohm: the answer is refined until the currents of a node balance to six digits."""
    netlist = """a controlled source in a mesh of resistors
v1 n1 0 400
r2 n2 n1 137.8
r3 n3 0 3.854e+05
r4 n4 n3 21.07
r5 n5 n2 466.9
r6 n6 n1 7.967
r7 n7 n5 12.79
r8 n8 n5 0.02365
gx1 n1 n6 n4 n8 0.009008
sa2 n5 n8 n5 n3 s0
ra3 n8 n4 7388
da4 n7 n3 d1
da5 n8 n6 d1
ca6 n8 n2 7.369e-12
ca7 n3 n5 9.709e-10
.model d1 D(ron=0.1 vfwd=0.7 roff=1meg)
.model s0 SW(vt=0.5 ron=1m roff=1meg)
.op
.end
"""
    done = run(program, netlist, method=None, options=("--audit", "off"))
    if checker.check(done.status == 0, f"an operating point: {done.stderr}"):
        v = {name: Fraction(done.at(f"v({name})", 0.0)) for name in ("n3", "n4")}
        left = (v["n4"] - v["n3"]) / Fraction("21.07") + Fraction(done.at("i(da4)", 0.0)) - v["n3"] / Fraction("385400")
        checker.check(abs(left) < 1e-10, f"an operating point: {float(left)} A are lost at n3")


# ---- Couplings ---------------------------------------------------------------------------------

THREE_COILS = """K with three coils
V1 a 0 SIN(0 10 1k)
L1 a 0 1m
L2 b 0 4m
L3 c 0 9m
K1 L1 L2 L3 {factor}
R2 b 0 1g
R3 c 0 1g
.tran 10u 1m
"""


def couplings(checker, program):
    """Without load the other coils see k sqrt(L / L1) of the first one's voltage."""
    for factor in (1.0, 0.5):
        case = Case(checker, program, THREE_COILS.format(factor=factor))
        for node, ratio in (("b", 2.0), ("c", 3.0)):
            case.is_at(f"v({node})", 0.25e-3, factor * 10 * ratio, 1e-4)


# ---- Switches ----------------------------------------------------------------------------------

# The current of Vm rises by 1 A/ms, and falls by as much after 3 ms.
BY_CURRENT = """a switch by a current
I1 0 a PWL(0 0 3m 3 6m 0)
Vm a 0
Vd d 0 1
{switch}
R1 b 0 1
.model {model}
.tran 10u 6m
"""

# Its own current decides: 10 V across 1 mH up to 0.5 A, then 10 ohm more, for good.
OF_ITSELF = """a switch in a loop with what commands it
V1 in 0 10
L1 in a 1m ic=0
Vm a b
R1 b c 10
W1 b c Vm m ON
Rl c 0 10
.model m {model}
.tran 1u 100u uic
"""

BY_VOLTAGE = """a switch by a voltage
V1 c 0 PWL(0 0 3m 3 6m 0)
Vd d 0 1
S1 d b c 0 m
R1 b 0 1
.model {model}
.tran 10u 6m
"""


def switched_on(case, times, closes=1e-6):
    """v(b) is 1 between times[0] and times[1], and 0 else."""
    for edge, before, after in ((times[0], 0, 1), (times[1], 1, 0)):
        case.is_at("v(b)", edge - closes, before)
        case.is_at("v(b)", edge + closes, after)


def around(*times):
    return sorted(t + d for t in times for d in (-1e-6, 1e-6))


def switches(checker, program):
    for switch, model, on, off in (
            ("W1 d b Vm m", "m CSW(It=1 Ih=0.25)", 1.25e-3, 5.25e-3),
            ("W1 d b Vm m OFF", "m CSW(It=2)", 2e-3, 4e-3),
            ("W1 d b Vm m", "m ISWITCH(Ion=2 Ioff=1)", 1.5e-3, 4.5e-3),
            ("W1 d b Vm m", "m ISWITCH(It=1.5 Ih=1)", 2.5e-3, 5.5e-3),
            ("W1 d b Vm m", "m CSW(It=1.25 Ih=0.5)", 1.75e-3, 5.25e-3),
            ("W1 d b Vm m", "m ISWITCH(IHon=2 IHoff=0.5)", 2e-3, 5.5e-3)):
        case = Case(checker, program, BY_CURRENT.format(switch=switch, model=model),
                    around(on, off))
        switched_on(case, (on, off))
    for model, on, off in (("m SW(Vt=1 Vh=0.25)", 1.25e-3, 5.25e-3),
                           ("m SW(Vt=1 Vh=-0.25)", 1e-3, 5e-3),
                           ("m VSWITCH(Von=2 Voff=1)", 1.5e-3, 4.5e-3),
                           ("m VSWITCH", 0.5e-3, 5.5e-3),
                           ("m VSWITCH(Vt=1 Vh=0.25)", 1.25e-3, 5.25e-3),
                           ("m VSWITCH(VHon=2 VHoff=0.5)", 2e-3, 5.5e-3)):
        case = Case(checker, program, BY_VOLTAGE.format(model=model), around(on, off))
        switched_on(case, (on, off))
    # Inverted: on below the middle.
    for netlist, model in ((BY_VOLTAGE, "m VSWITCH(Von=1 Voff=2)"),
                           (BY_CURRENT, "m ISWITCH(Ion=1 Ioff=2)")):
        netlist = netlist.format(model=model, switch="W1 d b Vm m")
        case = Case(checker, program, netlist, around(1.5e-3, 4.5e-3))
        for time, wanted in ((1.499e-3, 1), (1.501e-3, 0), (4.499e-3, 0), (4.501e-3, 1)):
            case.is_at("v(b)", time, wanted)
    case = Case(checker, program, BY_VOLTAGE.format(model="m VSWITCH(VHon=1 VHoff=2)"),
                around(2e-3, 5e-3))
    for time, wanted in ((1.999e-3, 1), (2.001e-3, 0), (4.999e-3, 0), (5.001e-3, 1)):
        case.is_at("v(b)", time, wanted)
    # A closed loop: inverted, the switch opens where the current passes 0.5 A.
    case = Case(checker, program, OF_ITSELF.format(model="ISWITCH(Ion=0 Ioff=1)"))
    case.is_at("i(l1)", 50e-6, 1 - math.exp(-0.5))
    case.is_at("i(l1)", 100e-6, 0.5)


# CONTROL= is a source of its own; nothing of it is recorded.
CONTROLLED = """switches by formulas, {what}
V1 in 0 SIN(0 5 1k)
Vx x 0 SIN(1 2 3k 0 0 90)
Rx x 0 2
{first}
R1 a 0 10
X1 in x b sub
R2 b 0 10
.subckt sub p q r k=0.5
{second}
.model m SW(Ron=1 Roff=1Meg Vt=1 Vh=0.5)
.ends
.model m1 VSWITCH(Ron=1 Roff=1Meg VHon=2 VHoff=-1)
.save v(a) v(b) i(s1) i(x1.s1) v(in)
.tran 10u 2m
"""


def controls(checker, program):
    times = [k * 17e-6 for k in range(1, 110)]
    one = Case(checker, program, CONTROLLED.format(
        what="one card", first="S1 in a m1 ON CONTROL={2*v(in)+4*i(Rx)-1}",
        second="S1 p r m CONTROL={k*v(p,q)+u(v(q)-2.9)}"), times)
    two = Case(checker, program, CONTROLLED.format(
        what="two cards", first="E1 c 0 VALUE={2*v(in)+4*i(Rx)-1}\nS1 in a c 0 m1 ON",
        second="B1 c 0 V={k*v(p,q)+u(v(q)-2.9)}\nS1 p r c 0 m"), times)
    for signal in one.result.names[1:]:
        for t in times:
            one.is_at(signal, t, two.result.at(signal, t), 1e-9)
    checker.check(min(one.result.column("i(s1)")) < -0.05 < 0.4 < max(one.result.column("i(s1)")),
                  "the switch moves")
    every = Case(checker, program, "all\nV1 a 0 1\nS1 a b m CONTROL={v(a)}\nR1 b 0 1\n"
                 ".model m SW(Vt=0.5)\n.tran 1u 10u\n.end\n")
    checker.check(every.result.names == ["time", "v(a)", "v(b)", "i(v1)", "i(s1)"],
                  f"recorded: {every.result.names}")


# ---- Parasitics --------------------------------------------------------------------------------

# What stands on one card, the same on several, and the element's current there.
PARASITICS = (
    ("C1 b 0 1u Rser=2 ic=1", "Rs b x 2\nC1 x 0 1u ic=1", "i(rs)"),
    ("C1 b 0 1u Lser=1u", "Ls b x 1u\nC1 x 0 1u", "i(ls)"),
    ("C1 b 0 1u Rpar=100 Cpar=10n", "Rt b t 0\nC1 t 0 1u\nRp t 0 100\nCp t 0 10n", "i(rt)"),
    ("C1 b 0 1u Rser=2 Lser=1u RLshunt=5 Rpar=100 Cpar=10n m=2 ic=0.5",
     "Rt b t 0\nRs t x 1\nLs x y 0.5u\nRl x y 2.5\nC1 y 0 2u ic=0.5\nRp t 0 50\nCp t 0 20n",
     "i(rt)"),
    ("C1 b 0 C=0 Rpar=100", "Rp b 0 100", "i(rp)"),
    ("L1 b 0 1m Rser=2 ic=10m", "Rs b x 2\nL1 x 0 1m ic=10m", "i(l1)"),
    ("L1 b 0 1m Rser=2 Rpar=200 Cpar=10n m=2 ic=10m",
     "Rt b t 0\nRs t x 1\nL1 x 0 0.5m ic=20m\nRp t 0 100\nCp t 0 20n", "i(rt)"),
    ("L1 b 0 1m Rser=0", "L1 b 0 1m", "i(l1)"),
    ("R1 b 0 100 m=4", "R1 b 0 25", "i(r1)"),
    ("S1 b 0 a 0 m1\n.model m1 SW(Ron=2 Roff=1k Vt=1 Lser=1u Vser=0.6)",
     "Ls b x 1u\nVs x y 0.6\nS1 y 0 a 0 m1\n.model m1 SW(Ron=2 Roff=1k Vt=1)", "i(ls)"),
    ("W1 b 0 V1 m1\n.model m1 ISWITCH(Ron=2 Roff=1k IHon=-0.2 IHoff=-0.1 Vser=-0.6)",
     "Vs b x -0.6\nW1 x 0 V1 m1\n.model m1 ISWITCH(Ron=2 Roff=1k IHon=-0.2 IHoff=-0.1)", "i(w1)"),
    ("Vx b 0 SIN(0 3 20k) Rser=2", "Rs b x 2\nVx x 0 SIN(0 3 20k)", "i(rs)"),
    ("Vx b 0 1 Rser=2 Cpar=1u AC 1", "Rt b t 0\nRs t x 2\nVx x 0 1\nCp t 0 1u", "i(rt)"),
)
AROUND = """parasitics, {current}
V1 a 0 PULSE(0 10 0 1u 1u 20u 50u)
R9 a b 10
{card}
.save v(b) {current}
.tran 1u 100u uic
"""


def many(checker, program):
    """Room for the parts of every card: coils and switches that bring two devices each, and controls."""
    n = 2000
    text = ["many", ".options dialect=ltspice", "V1 a 0 1", ".model m SW(Vt=0.5 Lser=1u Vser=0.25)"]
    text += [f"S{k} a s{k} m CONTROL={{v(a)}}\nR{k} s{k} 0 1" for k in range(n)]
    text += [f"L{k} a l{k} 1u\nRl{k} l{k} 0 1" for k in range(n)]
    case = Case(checker, program, "\n".join(text + [".save v(s7) v(l7)", ".op", ".end"]) + "\n")
    case.is_at("v(s7)", 0, 0.75)
    case.is_at("v(l7)", 0, 1 / 1.001)


def parasitics(checker, program):
    times = [k * 1e-6 for k in range(1, 100, 7)]
    for card, parts, current in PARASITICS:
        own = f"i({card.split()[0].lower()})"
        one = Case(checker, program, AROUND.format(card=card, current=own), times)
        several = Case(checker, program, AROUND.format(card=parts, current=current), times)
        for wanted, found in (("v(b)", "v(b)"), (current, own)):
            if one.result.rows and several.result.rows:
                for t in times:
                    one.is_at(found, t, several.result.at(wanted, t), 1e-8)
    # Only signals that a card names are recorded, and others cost nothing.
    case = Case(checker, program, AROUND.format(card=PARASITICS[3][0], current="all"))
    checker.check(case.result.names == ["time", "v(b)", "v(a)", "i(v1)"],
                  f"recorded: {case.result.names}")


# ---- Controlled sources ------------------------------------------------------------------------

POLY = """{element}
Va a 0 SIN(0 3 1k)
Vb b 0 2
Ra a x 10
Vx x 0 0
Rb b y 4
Vy y 0 0
{element}
R1 o 0 2
.save v(o) i({name})
.tran 10u 1m
"""
# With v(a) = s, v(b) = 2, i(vx) = s/10, i(vy) = 0.5: what the sum is.
SUMS = (
    ("E1 o 0 POLY(1) a 0 5", lambda s: 5),
    ("E1 o 0 POLY(1) (a,0) 1.5 5", lambda s: 1.5 + 5 * s),
    ("E1 o 0 POLY(2) (a,0) (b,0) 0 2 -3", lambda s: 2 * s - 6),
    ("E1 o 0 POLY(2) a 0 b 0 0.5 2 -3 0 0 0", lambda s: 0.5 + 2 * s - 6),
    ("E1 o 0 POLY(3) a 0 b 0 a b 1 2 3 4", lambda s: 1 + 2 * s + 6 + 4 * (s - 2)),
    ("G1 0 o POLY(2) a 0 b 0 0.5 2 -3", lambda s: 0.5 + 2 * s - 6),
    ("G1 0 o POLY(1) a 0 0 0.5", lambda s: 0.5 * s),
    ("F1 0 o POLY(2) Vx Vy 0.25 10 -3", lambda s: 0.25 + s - 1.5),
    ("H1 o 0 POLY(2) Vx Vy 0.25 10 -3", lambda s: 0.25 + s - 1.5),
)


def polynomials(checker, program):
    times = [k * 0.05e-3 for k in range(1, 20)]
    for element, wanted in SUMS:
        name = element.split()[0].lower()
        case = Case(checker, program, POLY.format(element=element, name=name), times)
        is_voltage = name[0] in "eh"
        for t in times:
            value = wanted(3 * math.sin(TURN * 1e3 * t))
            case.is_at("v(o)", t, value if is_voltage else 2 * value)
            case.is_at(f"i({name})", t, -value / 2 if is_voltage else value)


# ---- Sources -----------------------------------------------------------------------------------

SOURCE = """{source}
V1 a 0 {source}
R1 a b 1k
C1 b 0 1n
.tran 10u 10m
"""


def am(t):
    return 1.5 * (2 + math.sin(TURN * 100 * (t - 1e-3))) * math.sin(TURN * 1000 * (t - 1e-3))


def fm(index):
    return lambda t: 0.5 + 2 * math.sin(TURN * 1000 * t + math.radians(20)
                                        + index * math.sin(TURN * 100 * t + math.radians(40)))


def sources(checker, program):
    times = [0.2e-3, 0.7e-3, 1.25e-3, 2.25e-3, 2.31e-3, 2.8e-3, 7.77e-3, 9.9e-3]

    def shape(*values):
        return dict(zip(times, values))

    points = "0 0 1m 1 2m 0.5"
    cases = {
        "AM(1.5 2 100 1k 1m)": {t: am(t) if t > 1e-3 else 0 for t in times},
        "SFFM(0.5 2 1k 3 100 20 40)": {t: fm(3)(t) for t in times},
        "SFFM(0.5 2 1k -40 100 20 40)": {t: fm(-40)(t) for t in times},
        "PULSE(0 1 0.1m 0.1m 0.1m 0.3m 1m 2)": shape(1, 0, 1, 0, 0, 0, 0, 0),
        "PULSE(0 1 0.1m 0 0 0.5m 1m 0)": shape(1, 0, 1, 1, 1, 0, 0, 0),
        "SIN(1 2 100 0 0 0 0.125)": {t: 1 + 2 * math.sin(TURN * min(100 * t, 0.125))
                                     for t in times},
        f"PWL({points}) r=1m td=0.3m": shape(0, 0.4, 0.95, 0.525, 0.995, 0.75, 0.765, 0.7),
        f"PWL REPEAT FOREVER ({points}) ENDREPEAT": shape(0.2, 0.7, 0.875, 0.25, 0.31, 0.8,
                                                           0.615, 0.55),
        f"PWL REPEAT FOR 2 ({points}) ENDREPEAT DC 0": shape(0.2, 0.7, 0.875, 0.25, 0.31, 0.8,
                                                             0.5, 0.5),
        "PWL(0 1 0.5m 1 REPEAT FOREVER 1m 2 +1m 1 ENDREPEAT)":
            shape(1, 1.2, 1.75, 1.25, 1.19, 1.3, 1.73, 1.6),
        "PWL TIME_SCALE_FACTOR=1m VALUE_SCALE_FACTOR=2 (0 0 10 5)": {t: 1e3 * t for t in times},
        "PWL(0 0 +1m 1 +1m 0.5)": shape(0.2, 0.7, 0.875, 0.5, 0.5, 0.5, 0.5, 0.5),
    }
    for source, wanted in cases.items():
        case = Case(checker, program, SOURCE.format(source=source), times)
        for t, value in wanted.items():
            case.is_at("v(a)", t, value, 1e-9)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "Wave.txt"
        for text in ("* time value\n0 0\n1m, 1\r\n; nothing\n2E-3\t500m", f"{points}\n"):
            path.write_text(text)
            for form in (f"PWL file={path}", f'PWL(FILE="{path}")', f'PWL FILE "{path}"'):
                case = Case(checker, program, SOURCE.format(source=form), times)
                case.is_at("v(a)", 1.25e-3, 0.875)
                case.is_at("v(a)", 9.9e-3, 0.5)


# ---- Diodes ------------------------------------------------------------------------------------

CURVE = """diode: {element}, {model}
V1 a 0 PWL(0 -10 20m 10)
{element}
.model m {model}
.tran 10u 20m
"""
VT = 300.15 * 1.380649e-23 / 1.602176634e-19


def idealised(v, ron, roff=math.inf, vfwd=0.0, vrev=math.inf, rrev=None, m=1, n=1):
    """Three lines; Roff lies beside the two others."""
    v /= n
    current = v / roff
    if v > vfwd:
        current += (v - vfwd) / ron
    elif v < -vrev:
        current += (v + vrev) / (ron if rrev is None else rrev)
    return m * current


def tangent(v, saturation, emission, resistance, at):
    """Of N Vt ln(1 + I / IS) + RS I at one current."""
    slope = resistance + emission * VT / (at + saturation)
    start = emission * VT * math.log1p(at / saturation) + resistance * at - slope * at
    return max(0.0, v - start) / slope


FULL = dict(ron=0.1, roff=1e3, vfwd=0.7, vrev=5, rrev=2)
FULL_TEXT = "Ron=0.1 Roff=1k Vfwd=0.7 Vrev=5 Rrev=2"
DIODES = (
    ("D1 a 0 m", "D(Ron=0.1)", lambda v: idealised(v, 0.1)),
    ("D1 a 0 m", f"D({FULL_TEXT})", lambda v: idealised(v, **FULL)),
    ("D1 a 0 m m=3 n=2", f"D({FULL_TEXT})", lambda v: idealised(v, **FULL, m=3, n=2)),
    ("D1 a 0 m 7", f"D({FULL_TEXT} RS=5 CJO=1p)", lambda v: idealised(v, **FULL)),
    ("A1 %gd(a 0) m", f"sidiode({FULL_TEXT})", lambda v: idealised(v, **FULL)),
    ("A1 a 0 m", "sidiode(Ron=0.1)", lambda v: idealised(v, 0.1)),
    ("D1 a 0 m", "D(Ron=0.1 Vfwd=0.5 Epsilon=0.4)", lambda v: idealised(v, 0.1, vfwd=0.7)),
    ("D1 a 0 m", "D(Ron=0.1 Vrev=4 Rrev=2 RevEpsilon=0.4)",
     lambda v: idealised(v, 0.1, vrev=4.2, rrev=2)),
    ("D1 a 0 m", f"D({FULL_TEXT} Ilimit=20)", lambda v: min(idealised(v, **FULL), 20)),
    ("D1 a 0 m", f"D({FULL_TEXT} RevIlimit=1.5)", lambda v: max(idealised(v, **FULL), -1.5)),
    ("D1 a 0 m m=2", f"D({FULL_TEXT} Ilimit=20 RevIlimit=1.5)",
     lambda v: 2 * max(min(idealised(v, **FULL), 20), -1.5)),
    ("D1 a 0 m", "D(IS=1n N=2 RS=0.1)\n.options diodecurrent=1", lambda v: tangent(v, 1e-9, 2, 0.1, 1)),
    ("D1 a 0 m 3 m=2", "D(IS=1n N=2 RS=0.1)\n.options diodecurrent=1", lambda v: tangent(v, 6e-9, 2, 0.1 / 6, 1)),
    ("D1 a 0 m", "D(CJO=1p RS=0.1)\n.options diodecurrent=0.2",
     lambda v: tangent(v, 1e-14, 1, 0.1, 0.2)),
    ("D1 a 0 m", "D(N=0.01 RS=0.1)", lambda v: max(0, v) / 0.1),
    ("D1 a 0 m", "D(RS=0.1 BV=6 IBV=1)\n.options diodecurrent=1",
     lambda v: tangent(v, 1e-14, 1, 0.1, 1) if v > 0
     else min(0.0, v + 6 - VT) / (0.1 + VT)),
)


def diodes(checker, program):
    times = [k * 0.4e-3 for k in range(51)]
    for element, model, law in DIODES:
        case = Case(checker, program, CURVE.format(element=element, model=model), times)
        name = element.split()[0].lower()
        for t in times:
            wanted = law(-10 + 20 * t / 20e-3)
            case.is_at(f"i({name})", t, wanted, 1e-9 * (1 + abs(wanted)))
        if "limit" in model:
            checker.check(case.result.names == ["time", "v(a)", "i(v1)", "i(d1)"],
                          f"recorded: {case.result.names}")


NESTED_CHOICES = """nested choices between numbers, by conditions of different quantities
V1 a 0 PWL(0 -3 1m 3)
V2 b 0 SIN(0 1 1k)
B1 y1 0 V=V(a)>1 ? 5 : (V(b)>0 ? 2 : 0)
B2 y2 0 V=if(V(a)>V(b), 5, if(V(b)>0.5, 2, 0))
B3 y3 0 V=V(a)>1 ? V(b)>0.5 ? 3 : 2 : V(b)>0 ? 1 : 0
B4 y4 0 V={(V(a)>0 ? 2 : 1)*(V(b)>0 ? 3 : 4) - 1}
B5 y5 0 V=V(b)>0 ? (V(a)>-1 && V(a)<1 ? 4 : (V(a)>2 ? 7 : 1)) : (V(a)>V(b) ? -1 : -2)
S1 c c1 control 0 sw
Bs control 0 V=V(a)>1 ? 1 : (V(b)>0.5 ? 1 : 0)
V3 c 0 1
Rc c1 0 1
.model sw SW(Vt=0.5)
.tran 10u 1m
.end
"""


def nested_choices(checker, program):
    case = Case(checker, program, NESTED_CHOICES, at=[k * 1e-5 for k in range(1, 100)])
    for k in range(1, 100):
        time = k * 1e-5
        a, b = 6e3 * time - 3, math.sin(TURN * 1e3 * time)
        if min(abs(a - b), *(abs(a - x) for x in (-1, 0, 1, 2)), abs(b), abs(b - 0.5)) < 1e-3:
            continue
        wanted = {"y1": 5 if a > 1 else 2 if b > 0 else 0,
                  "y2": 5 if a > b else 2 if b > 0.5 else 0,
                  "y3": (3 if b > 0.5 else 2) if a > 1 else 1 if b > 0 else 0,
                  "y4": (2 if a > 0 else 1) * (3 if b > 0 else 4) - 1,
                  "y5": (4 if -1 < a < 1 else 7 if a > 2 else 1) if b > 0
                  else -1 if a > b else -2,
                  "c1": 1 if a > 1 or b > 0.5 else 0}
        for node, value in wanted.items():
            case.is_at(f"v({node})", time, value)


PRODUCTS = """products of what varies and of what has two values
.param vin=3
V1 a 0 SIN(0 10 500)
V2 pwm 0 PULSE(0 1 0 0 0 50u 100u)
V3 tri 0 PULSE(0 1 0 50u 50u 0 100u)
V4 ref 0 {vin/10}
V5 three 0 PULSE(-1 2 10u 1n 1n 30u 80u)
R0 a x 1k
C0 x 0 1u
B1 y1 0 V=V(x)*V(pwm)
B2 y2 0 V=V(pwm)>0.5 ? V(x) : V(a)
B3 y3 0 V=(2*(V(a)>V(tri))-1)*V(x)
B4 y4 0 V=V(tri)<0.3 ? V(x) : (V(tri)<0.6 ? V(a) : 2)
B5 gate 0 V=V(tri)<V(ref) ? 5 : 0
B6 y6 0 V=V(gate)/5*V(x) + V(a)*V(pwm)
B7 y7 0 V=V(three)*I(R0)
E1 y8 0 VALUE={V(gate)*limit(V(x), -1, 1)}
B8 y9 0 V=V(x)*V(ref)
.tran 10u 1m
.end
"""


def products(checker, program):
    case = Case(checker, program, PRODUCTS, at=[k * 3.7e-6 for k in range(1, 270)])
    case.says("as a factor this pulse is a step at the middle of each edge, which lasts up to 1e-09 s")
    for k in range(1, 270):
        time = k * 3.7e-6
        a, x = case.result.at("v(a)", time), case.result.at("v(x)", time)
        phase = time % 1e-4 / 1e-4
        tri = 2 * phase if phase < 0.5 else 2 - 2 * phase
        three = 2 if time > 1e-5 and (time - 1e-5) % 8e-5 < 3e-5 else -1
        near = [tri - 0.3, tri - 0.6, a - tri, phase, phase - 0.5, phase - 1]
        if min(abs(y) for y in near) < 1e-3:
            continue
        pwm, gate = (1 if phase < 0.5 else 0), (5 if tri < 0.3 else 0)
        wanted = {"y1": x * pwm, "y2": x if pwm else a, "y3": x if a > tri else -x,
                  "y4": x if tri < 0.3 else a if tri < 0.6 else 2,
                  "y6": gate / 5 * x + a * pwm, "y7": three * (a - x) / 1e3,
                  "y8": gate * max(-1, min(1, x)), "y9": 0.3 * x}
        for node, value in wanted.items():
            case.is_at(f"v({node})", time, value, 1e-8)


def main():
    checker = Checker("elements")
    for part in (couplings, switches, controls, many, sources, parasitics, diodes, polynomials,
                 nested_choices, products, operating_point_balances):
        part(checker, sys.argv[1])
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
