#!/usr/bin/env python3
"""Faults planted into right waveforms, or into the netlist that they are held to: each is found, at its law, its
element and its time, and nothing else is worse.

usage: faults.py PROGRAM"""

import sys
import tempfile

from audit_program import audit, dalcs_program, simulate

RECTIFIER = """rectifier
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 20u
R1 out 0 1k
.tran 20u 40m uic
"""
BRIDGE = """bridge
V1 a b SIN(0 10 50)
D1 a p
D2 b p
D3 0 a
D4 0 b
C1 p 0 100u
R1 p 0 1k
.tran 20u 60m
"""
CHOPPER = """chopper
V1 s 0 12
S1 s x g 0 sw
D1 0 x
L1 x out 100u
C1 out 0 47u
R1 out 0 5
V2 g 0 PULSE(0 1 0 10n 10n 4u 10u)
.model sw SW(Ron=10m Vt=0.5)
.tran 0.1u 200u uic
"""
COUPLED = """two coils and what reads them
V1 in 0 SIN(0 10 1k)
R1 in a 1
L1 a 0 1m
L2 b 0 4m
K1 L1 L2 0.95
R2 b 0 100
C2 b 0 1u
E1 e 0 b 0 2
R3 e 0 1k
B1 l 0 V=limit(v(b), -3, 3)
R4 l 0 1k
.tran 1u 3m
"""
HYSTERESIS = """relay
V1 c 0 SIN(0 1 100)
V2 s 0 10
S1 s out c 0 sw
R1 out 0 10
C1 out 0 10u
.model sw SW(Ron=0.1 Vt=0 Vh=0.4)
.tran 10u 30m
"""
SHARING = """two capacitors meet
C1 a 0 1u ic=10
S1 a c g 0 sw
V1 g 0 PULSE(0 1 0.2m)
D1 c b
C2 b 0 3u ic=2
R1 b 0 100k
.model sw SW(Ron=0 Vt=0.5)
.tran 10u 1m uic
"""
CURRENTS = """currents by sources
I1 0 a SIN(1m 1m 1k)
R1 a 0 1k
V1 a b 0
R2 b 0 2k
F1 0 f V1 3
R3 f 0 100
G1 0 g a 0 2m
R4 g 0 100
H1 h 0 V1 500
R5 h 0 1k
.save v(a) v(b) v(f) v(g) v(h) i(v1) i(h1) i(r1) i(r2) i(r3) i(f1) i(g1) i(i1)
.tran 10u 2m
"""
# no file has the nodes of the products and functions themselves
FUNCTIONS = """products and functions
V1 in 0 SIN(0 2 1k)
B1 x 0 V=v(in)*v(in)+0.5*v(in)
R1 x y 1k
C1 y 0 100n
B2 0 z I=1m*tanh(v(y)+100*i(V1))+1m*abs(v(y))
R2 z 0 1k
E1 p 0 VALUE={exp(v(y)/2)*sqrt(abs(v(x))+1)}
R3 p 0 1k
G1 0 q VALUE={v(p)/(2+v(x)*v(x))*1m}
R4 q 0 1k
R5 in 0 1k
.tran 2u 3m
"""

# elements that are several: their own current is that of all of their parts
TRIAC = """a triac
V1 in 0 SIN(0 48 1k)
R1 in s 0.2
V2 g 0 PULSE(0 1 0.1m 1u 1u 20u 0.5m)
A1 s x g 0 tr
L1 x y 1m
R2 y 0 20
.model tr triac(Vgt=0.5 Ih=2m)
.tran 10u 4m
"""
PARTS = """a coil with parts beside it, and a MOSFET
V1 in 0 12
M1 in g x x nm
V2 g x PULSE(0 10 0 10n 10n 4u 10u)
D1 0 x
L1 x o 100u Rpar=2k Rser=0.1
C1 o 0 47u
R1 o 0 5
.model nm VDMOS(Vto=3 Kp=10)
.tran 0.5u 200u uic
"""

# what is done to the table or the netlist: the law and the element that are then worst
NETLIST_FAULTS = [
    ("amplitude 1 % off", RECTIFIER, ("SIN(0 10", "SIN(0 10.1"), ("BRANCH", "v1")),
    ("frequency 1 % off", RECTIFIER, ("10 50)", "10 50.5)"), ("BRANCH", "v1")),
    ("a capacitor of 10 % more", RECTIFIER, ("20u\nR", "22u\nR"), ("BRANCH", "c1")),
    ("a capacitor of 2 % more", RECTIFIER, ("20u\nR", "20.4u\nR"), ("BRANCH", "c1")),
    ("a resistor of 10 % more", RECTIFIER, ("0 1k", "0 1.1k"), ("BRANCH", "c1")),
    ("a diode turned around", RECTIFIER, ("D1 in out", "D1 out in"), ("KCL", "in")),
    ("a diode turned around", BRIDGE, ("D3 0 a", "D3 a 0"), ("BRANCH", "d3")),
    ("a diode with a threshold", BRIDGE, ("D1 a p", "D1 a p dt\n.model dt D(Vfwd=0.7)"), ("BRANCH", "d1")),
    ("another duty", CHOPPER, ("4u 10u", "5u 10u"), ("BRANCH", "v2")),
    ("another coil", CHOPPER, ("100u\nC", "105u\nC"), ("BRANCH", "l1")),
    ("a switch with more resistance", CHOPPER, ("Ron=10m", "Ron=100m"), ("BRANCH", "s1")),
    ("an inverted switch", CHOPPER, ("S1 s x g 0 sw", "S1 s x 0 g sw"), ("POSITION", "s1")),
    ("another coupling", COUPLED, ("0.95", "0.93"), ("BRANCH", "l2")),
    ("another coil of two", COUPLED, ("L2 b 0 4m", "L2 b 0 4.2m"), ("BRANCH", "l2")),
    ("another gain", COUPLED, ("b 0 2\n", "b 0 2.02\n"), ("BRANCH", "e1")),
    ("another limit", COUPLED, ("-3, 3", "-3, 3.1"), ("BRANCH", "b1")),
    ("another threshold", HYSTERESIS, ("Vt=0 ", "Vt=0.05 "), ("POSITION", "s1")),
    ("less hysteresis", HYSTERESIS, ("Vh=0.4", "Vh=0.3"), ("POSITION", "s1")),
    ("no hysteresis", HYSTERESIS, ("Vh=0.4", ""), ("POSITION", "s1")),
    ("an element too many", BRIDGE, ("R1 p 0 1k", "R1 p 0 1k\nR2 a 0 1k"), ("KCL", "a")),
    ("an element too few", CURRENTS, ("R5 h 0 1k", "*"), ("KCL", "h")),
    ("another charge to begin with", SHARING, ("ic=2", "ic=2.2"), ("KCL", "c, b")),
    ("a current source 1 % off", CURRENTS, ("1m 1m", "1m 1.01m"), ("CURRENT", "i1")),
    ("a gain of F", CURRENTS, ("V1 3", "V1 3.01"), ("CURRENT", "f1")),
    ("a gain of G", CURRENTS, ("0 2m", "0 2.01m"), ("CURRENT", "g1")),
    ("a gain of H", CURRENTS, ("V1 500", "V1 503"), ("BRANCH", "h1")),
    ("another factor of a product", FUNCTIONS, ("v(in)*v(in)", "v(in)*v(in)*1.02"), ("BRANCH", "b1")),
    ("another function", FUNCTIONS, ("tanh(", "sin("), ("KCL", "z")),
    ("another argument", FUNCTIONS, ("100*i(V1)", "110*i(V1)"), ("KCL", "z")),
    ("another exponent", FUNCTIONS, ("exp(v(y)/2)", "exp(v(y)/1.9)"), ("BRANCH", "e1")),
    ("another root", FUNCTIONS, ("+1)}", "+1.1)}"), ("BRANCH", "e1")),
    ("another quotient", FUNCTIONS, ("(2+v(x)", "(2.1+v(x)"), ("KCL", "q")),
    ("a resistor 1 % off", CURRENTS, ("R1 a 0 1k", "R1 a 0 1.01k"), ("CURRENT", "r1")),
]


def check_netlist_faults(checker, program, folder):
    for what, netlist, (old, new), worst in NETLIST_FAULTS:
        table = simulate(program, netlist)
        right = audit(program, folder, netlist, table)
        checker.check(right.status == 0, f"{what}: right waveforms are refused: {right.broken}")
        assert old in netlist, (what, old)
        found = audit(program, folder, netlist.replace(old, new, 1), table)
        if checker.check(found.status == 1, f"{what}: not found"):
            checker.check(found.broken[0] == worst, f"{what}: {found.broken}, not {worst}")


STEEP = """an exponential that is steep only at last
V1 a 0 PWL(0 0 0.9m 0.9 1m 30)
R1 a b 1k
C1 b 0 1n ic=0
B1 o 0 V=min(exp(v(b)),5)+0.1*v(b)
R2 o p 1k
C2 p 0 100n ic=0
.tran 5u 1m uic
.end
"""

POWERS = """two exponentials, both cut off
V1 a 0 PWL(0 -1 1m 1)
R1 a b 1k
C1 b 0 10n ic=-1
B1 o 0 V=min(exp(30*v(b)),2)-min(exp(28*v(b)),1)+v(b)
R2 o p 1k
C2 p 0 1u ic=0
.tran 5u 1m uic
.end
"""

# one number of one row: what, when, by how much, and the laws of which one must be worst
NUDGES = [
    (RECTIFIER, "v(out)", 12e-3, 0.3, [("BRANCH", "c1"), ("BRANCH", "d1")]),
    (RECTIFIER, "v(in)", 12e-3, 0.3, [("BRANCH", "v1")]),
    (RECTIFIER, "i(d1)", 21e-3, 5e-3, [("KCL", "in"), ("BRANCH", "c1"), ("CURRENT", "d1")]),
    (RECTIFIER, "i(d1)", 12e-3, -5e-3, [("KCL", "in"), ("CURRENT", "d1")]),
    (RECTIFIER, "i(v1)", 5e-3, 5e-3, [("KCL", "in")]),
    (TRIAC, "i(a1)", 2.2e-3, 0.05, [("KCL", "s"), ("KCL", "x"), ("KCL", "x, terminal(a1) and 2 more")]),
    (PARTS, "i(m1)", 101e-6, 0.05, [("KCL", "in"), ("KCL", "x")]),
    (PARTS, "i(l1)", 101e-6, 0.05, [("KCL", "x"), ("KCL", "o"), ("KCL", "terminal(m1)")]),
    (CHOPPER, "i(l1)", 101e-6, 0.1, [("BRANCH", "l1"), ("KCL", "x")]),
    (CHOPPER, "v(x)", 101e-6, 0.5, [("BRANCH", "s1"), ("POSITION", "s1")]),
    (CHOPPER, "v(x)", 106e-6, 0.5, [("BRANCH", "d1"), ("CURRENT", "d1")]),
    (CHOPPER, "v(g)", 106e-6, 1.0, [("BRANCH", "v2"), ("POSITION", "s1")]),
    (COUPLED, "i(l2)", 1.3e-3, 0.02, [("BRANCH", "l2"), ("BRANCH", "l1"), ("BRANCH", "c2")]),
    (COUPLED, "v(l)", 1.3e-3, 0.1, [("BRANCH", "b1"), ("KCL", "l")]),
    (CURRENTS, "i(g1)", 1e-3, 1e-4, [("KCL", "g"), ("CURRENT", "g1")]),
    (STEEP, "v(o)", 0.4e-3, 0.03, [("KCL", "o"), ("BRANCH", "b1")]),
    (POWERS, "v(o)", 0.2e-3, 0.02, [("KCL", "o"), ("BRANCH", "b1")]),
]


def check_nudges(checker, program, folder):
    for netlist, signal, time, amount, worst in NUDGES:
        table, at = simulate(program, netlist).nudged(signal, time, amount)
        found = audit(program, folder, netlist, table)
        what = f"{signal} at {at} of {netlist.splitlines()[0]}"
        if checker.check(found.status == 1, f"{what}: not found"):
            first = found.answer["laws"][0]
            checker.check(found.broken[0] in worst, f"{what}: {found.broken}")
            checker.check(first["from"] <= at <= first["to"] or first["to"] == at,
                          f"{what}: told of {first['from']} .. {first['to']}")


def check_signs(checker, program, folder):
    for netlist, signal, laws in (
            (RECTIFIER, "i(d1)", [("KCL", "in"), ("CURRENT", "d1"), ("BRANCH", "d1")]),
            (CHOPPER, "i(l1)", [("KCL", "x"), ("BRANCH", "l1")]),
            (CURRENTS, "i(r1)", [("CURRENT", "r1")]), (CURRENTS, "i(v1)", [("KCL", "b"), ("CURRENT", "f1")])):
        found = audit(program, folder, netlist, simulate(program, netlist).scaled(signal, -1.0))
        checker.check(found.status == 1 and found.broken[0] in laws, f"-{signal}: {found.broken}")


def check_lost_command(checker, program, folder):
    """The rows of a run in which one pulse of the gate closed no switch."""
    lossy = CHOPPER.replace("S1 s x g 0 sw", "S1 s x h 0 sw\n"
                            "B3 h 0 V=(time > 95u) & (time < 105u) ? 0 : v(g)")
    found = audit(program, folder, CHOPPER, simulate(program, lossy).without("v(h)", "i(b3)"))
    checker.check(found.status == 1 and found.broken[0] == ("POSITION", "s1"),
                  f"a lost command: {found.broken}")
    law = found.law("POSITION", "s1")
    checker.check(law is not None and 100e-6 <= law["since"] <= 100.2e-6, f"a lost command: {law}")


def check_missing_output(checker, program, folder):
    """An output that the file lacks is what its element makes of what the file has: what it feeds is checked."""
    for output, old, new in (("E1 e 0 a 0 2", "0 a 0 2", "0 a 0 2.1"), ("B1 e 0 V=v(a)*v(a)", "v(a)*v(a)", "v(a)*v(a)*1.1")):
        netlist = f"a filter behind an output\nV1 a 0 SIN(0 3 1k)\n{output}\nR1 e f 1k\nC1 f 0 100n\n" \
                  ".save v(a) v(f)\n.tran 2u 3m\n"
        table = simulate(program, netlist)
        right = audit(program, folder, netlist, table)
        missing = ("BRANCH", output[:2].lower())
        checker.check(right.status == 0 and list(right.not_asked) == [missing], f"{output}: {right.text}")
        found = audit(program, folder, netlist.replace(old, new), table)
        checker.check(found.status == 1 and found.broken == [("BRANCH", "c1")], f"{new}: {found.text}")


def check_sees(checker, program, folder):
    """What is said to be noticed is: a capacitor or coil that is off by a fifth more is, by half of it is not."""
    for netlist, old, form, element in ((RECTIFIER, "20u\nR", "{:.9g}u\nR", "c1"),
                                        (CHOPPER, "100u\nC", "{:.9g}u\nC", "l1")):
        table = simulate(program, netlist)
        sees = audit(program, folder, netlist, table).law("BRANCH", element)["sees"]
        checker.check(0.0 < sees < 0.02, f"{element} sees {sees}")
        value = float(old.split("u")[0])
        for part, broken in ((1.2, True), (0.5, False)):
            made = netlist.replace(old, form.format(value * (1.0 + part * sees)))
            found = audit(program, folder, made, table)
            checker.check((("BRANCH", element) in found.broken) == broken, f"{element} by {part} of {sees}")


def check_jumps(checker, program, folder):
    table = simulate(program, SHARING)
    right = audit(program, folder, SHARING, table)
    checker.check(right.status == 0, f"a jump: {right.broken}")
    jump = next(k for k, row in enumerate(table.rows) if row[0] == table.rows[k + 1][0] == 2e-4)
    wrong = table.copy()
    for row in wrong.rows[jump + 1:]: # as if a tenth of the charge had gone
        for name in ("v(a)", "v(b)", "v(c)"):
            row[table.index(name)] *= 0.9
    found = audit(program, folder, SHARING, wrong)
    first = found.answer["laws"][0]
    checker.check(found.status == 1 and first["law"] == "KCL" and first["to"] == 2e-4 and first["unit"] == "C",
                  f"charge that a jump loses: {found.broken}")


def main(program):
    checker = dalcs_program.Checker("planted faults")
    with tempfile.TemporaryDirectory() as folder:
        check_netlist_faults(checker, program, folder)
        check_nudges(checker, program, folder)
        check_signs(checker, program, folder)
        check_lost_command(checker, program, folder)
        check_missing_output(checker, program, folder)
        check_sees(checker, program, folder)
        check_jumps(checker, program, folder)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
