#!/usr/bin/env python3
"""Jumps against closed forms, with either method: states, impulses, work, loss; and what is none.

usage: jumps.py PROGRAM auto|euler
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

EXACT = 1e-12  # relative
MODEL = ".model DI D(Ron=0 Vfwd=0)\n"

DIVIDER = """a step of 12 V over 1 uF and 3 uF in series: 9 uC
V1 in 0 PULSE(0 12 1m 0 0 1m 5m)
C1 in a 1u
C2 a 0 3u
R1 a 0 1k
.tran 10u 2m uic
"""

# 12 mA in 2 mH when the switch opens: 24 uWb, 144 nJ.
INTERRUPTED = """a coil cut off
I1 0 a 12m
L1 a b 2m ic=12m
S1 b 0 c 0 sw
Vc c 0 PULSE(5 0 1m 0 0 2m 5m)
S2 a 0 c2 0 sw
Vc2 c2 0 5
.model sw sw(vt=2.5)
.tran 10u 1.5m uic
"""

# 1 fs is far below anything that a run of 2 ms can tell apart from a jump by looking at a step.
FAST = """a transient of 1 fs, which is no jump
V1 in 0 PULSE(0 10 1m 0 0 1m 5m)
R1 in a 1m
C1 a 0 1p
.tran 10u 2m uic
"""

# The same beside a jump: 1 uF at 8 V joins 1 uF at 0 through a diode, 1 pF with 1 mohm follows.
BESIDE = """a jump and a fast transient at once
C1 a 0 1u ic=8
D1 a b DI
C2 b 0 1u
R1 b c 1m
C3 c 0 1p
""" + MODEL + ".tran 1u 1m uic\n"

# Ten cells that all jump at one time, each by itself and the last through the first.
CELLS = "ten at once\n" + "".join(
    f"Ca{k} a{k} 0 {k}u ic={10 * k}\nD{k} a{k} b{k} DI\nCb{k} b{k} 0 1u\nRb{k} b{k} 0 1g\n"
    for k in range(1, 11)) + MODEL + ".tran 1u 1u uic\n"

# The doubler with vertical edges: 10 (1 - 2^-n) V after n rising edges, by 10 uC 2^-n each.
DOUBLER = """Greinacher's doubler, vertical edges
V1 in 0 PULSE(-5 5 1m 0 0 1m 2m)
C1 in a 1u ic=-5
D1 0 a DI
D2 a out DI
C2 out 0 1u
""" + MODEL + ".tran 10u 10.5m uic\n"

# x1' = x2, x2' = lambda, 0 <= lambda _|_ x1 >= 0 from below the floor: it would take a derivative of
# an impulse to get to x = 0.
BALL = """a ball below the floor
C1 1 0 1 ic=-1
G1 0 1 2 0 1
C2 2 0 1 ic=0
E1 3 0 1 0 1
Vs 4 3 0
D1 0 4 DI
F1 0 2 Vs 1
""" + MODEL + ".tran 1m 2 uic\n"


# The same dropped from 1 m: v' = h'' = -1 + lambda. It hits the floor at sqrt(2) s with as many m/s, and
# stays. The mode on the floor has matrices that tend to singular ones as steps get small.
IMPACT = """a ball dropped on an inelastic floor
Cv v 0 1 ic=0
Gh 0 h v 0 1
Ch h 0 1 ic=1
Iv v 0 1
Eh hh 0 h 0 1
D1 0 y DI
Vs y hh 0
Fv 0 v Vs 1
""" + MODEL + ".tran 2m 4 uic\n"


# No jump: 8 V within 1 ns, through the threshold of D2 at 3/8 of it. C0 follows through D0.
EDGE = """an edge of 1 ns into a capacitor
V1 1 0 PULSE(-3 5 0.1m 1n 1u 0.2m 0.45m)
R2 2 0 1.5
R3 3 0 20
C0 2 3 3u
D0 2 0 DI
D2 1 3 DI
""" + MODEL + ".tran 1u 0.2m\n"

# Not passive, and open but for one diode: the mode is singular, and only 1 mA of I6 flows.
OPEN = """a singular mode that states contradict
V1 1 2 DC 5
E0 0 1 0 3 -1.74
R1 4 2 4.521
S2 2 5 ctl 0 SW
R3 5 4 2972
C4 0 2 3.951u
D5 5 2 DO
I6 1 0 1m
D7 3 0 DI
Vctl ctl 0 PULSE(0 5 0.12m 1n 1n 0.1m 0.25m)
.model DO D(Ron=0.01 Roff=1meg)
.model SW SW(vt=2.5 vh=0.5 ron=0.01 roff=1meg)
""" + MODEL + ".tran 1u 0.2m\n"


RATIO = 10 / 3
# A capacitor in series with a switch that opens, and a transformer that no theorem on passive parts covers: in a micro-step
# the voltage of c9 is the difference of two that hold the impulse over its length.
BEHIND_TRANSFORMER = """* series capacitor behind an ideal transformer
V1 in 0 PULSE(-10 10 0 1n 1n 5u 10u)
S1 in s g 0 sw
Vg g 0 PULSE(0 1 0 1n 1n 2.5u 10u)
C9 s p 1u
Lk p 0 10u
A1 p 0 a 0 0 b tr
.model tr transformer(turns=[10 3 3])
D1 a x di
D2 b x di
.model di d
.model sw sw(vt=0.5)
L1 x o 1u
C1 o 0 100u
R1 o 0 10
.tran 0.1u 500u
"""

# Where s1 closes, the 17 uA of a coil behind leaks go on and end within L / Roff = 0.25 ps, beside 1 A in the other coil.
BESIDE_LARGE = """* snubber of a buck
Vin in 0 48
S1 in x g 0 sw
D1 0 x DI
L1 x o 437u ic=1.189
C1 o 0 5.36u ic=24
R1 o 0 20
Cs in y 1.34n
Ds1 y x DI
Ls y z 1.03u
Ds2 z2 z DI
Cr z2 0 1.34n
Ds3 0 z2 DI
Vg g 0 PULSE(0 1 0 27n 27n 5.4u 10.8u)
.model sw SW(Ron=1m Roff=4.142meg Vt=0.5)
.model DI D(Ron=1m Roff=4.142meg Vfwd=0.7)
.tran 0.4u 20u uic
"""

# A current that a leak of Roff takes to V1 / Roff within L / Roff, from a half to twice the shortest step: no jump.
LEAK = """* a switch that leaks opens
V1 in 0 10
S1 in p g 0 sw
Vg g 0 PULSE(0 1 0 1n 1n 2.5u 10u)
.model sw sw(roff={ohms} vt=0.5)
L1 p 0 {henries}
.tran 0.1u 300u
"""

# The same of what a thyristor holds: 0.1 A, which end at 9.99 ms.
LATCH = """* a thyristor that leaks
V1 a 0 SIN(0 325 50)
D1 a w di
Vs w v 0
S1 v b l 0 sw
L1 b c {henries}
R1 c 0 10
Bl l 0 V=v(g)+u(i(Vs)-0.1)
Rl l 0 1k
Vg g 0 PULSE(0 1 4m 2u 2u 2m 20m)
.model sw sw(ron=1m roff={ohms} vt=0.5)
.model di d(ron=1m roff=10meg)
.tran 0.2m 80m uic
"""

# What a source of time is, then what a formula says of it.
FORMULAS = [
    ("V1 p 0 5", "B1 p 0 V=5", "S1 p a g 0 sw\nC1 a 0 1u\nR1 a 0 10"),
    ("V1 p 0 PULSE(3 8 0.1u 0 0 0.4u 1u)", "B1 p 0 V=5*v(g)+3", "C1 p a 1u\nD1 0 a\nD2 a b\nC2 b 0 2u\nR1 b 0 10"),
    ("V1 p n PULSE(0 -5 0.1u 0 0 0.4u 1u)", "B1 p n V=-5*v(g)*v(h)", "Rn n 0 3\nC1 p a 1u\nD1 n a\nR1 a n 10"),
    ("V1 p 0 PULSE(-3.5 3.5 0.1u 0 0 0.4u 1u)", "E1 p 0 VALUE={7*u(v(g)-0.5)-3.5}", "C1 p a 1u\nD1 0 a\nR1 a 0 10"),
    ("V1 p 0 PULSE(0 4 0.1u 0 0 0.4u 1u)", "B9 r 0 V=sin(3e5*2**(time/1m))\nB1 p 0 V=4*v(g)",
     "C1 p a 1u\nD1 0 a\nR1 a 0 10\nC2 b 0 1u"),
    ("I1 0 a 2", "B1 0 a I=2", "S1 a 0 g 0 sw\nL1 a b 1u\nR1 b 0 1"),
    ("V1 p 0 PULSE(0 12 0.1u 0 0 0.4u 1u)", "B1 p 0 V=12*v(g)",
     "C1 p q 1u\nL1 q 0 1m\nL2 s 0 1m\nK1 L1 L2 1\nD1 s o\nC2 o 0 1u\nR1 o 0 100"),
]
CLOCK = """
Vg g 0 PULSE(0 1 0.1u 0 0 0.4u 1u)
Rg g 0 1
Vh h 0 1
Rh h 0 1
.model sw SW(Ron=0 Vt=0.5)
.tran 10n 5u uic
"""


class Jumps:
    def __init__(self, program, method):
        self.program = program
        self.method = method
        self.check = Checker(f"jumps {method}")

    def run(self, netlist):
        result = run(self.program, netlist + ".end\n", method=self.method)
        self.check.check(result.status == 0, f"exit {result.status}: {result.stderr}")
        return result

    def close(self, found, wanted, what):
        self.check.close(found, wanted, EXACT * abs(wanted) if wanted else 1e-18, what)

    def one(self, result):
        jumps = result.report["jumps"]
        self.check.check(len(jumps) == 1, f"{len(jumps)} jumps, not 1")
        return jumps[0]

    def source(self):
        jump = self.one(self.run(DIVIDER))
        self.close(jump["time"], 1e-3, "time")
        self.close(jump["states"]["c1"]["after"], 9.0, "c1")
        self.close(jump["states"]["c2"]["after"], 3.0, "c2")
        self.close(jump["source_work"], 108e-6, "work of the source")
        self.close(jump["energy_lost"], 54e-6, "loss")

    def interruption(self):
        result = self.run(INTERRUPTED)
        jump = self.one(result)
        after = jump["states"]["l1"]["after"]
        self.check.check(after == 0.0, f"{after} A behind the switch")
        self.close(abs(jump["impulses"]["s1"]["flux"]), 24e-6, "flux")
        self.close(jump["energy_lost"], 144e-9, "loss")
        self.check.check("'s1' interrupts the current of 'l1'" in result.stderr and
                         result.stderr.count("warning") == 1, f"warned: {result.stderr}")
        if self.method != "euler":  # where the first row behind a jump shows flux/h
            top = max(abs(v) for v in result.column("v(b)"))
            self.check.check(top < 1e-6, f"v(b) reaches {top} V")

    def formulas(self):
        """A formula of sources is a source: charge and flux pass it, and its work is in the balance."""
        for source, formula, others in FORMULAS:
            plain, other = (self.run(f"t\n{first}\n{others}{CLOCK}").report["energy"] for first in (source, formula))
            size = max(abs(value) for value in plain.values())
            worst = max(abs(other[key] - plain[key]) for key in plain)
            self.check.check(worst <= 1e-9 * size, f"{formula}: {other}, but {plain}")

    def no_jump(self):
        result = self.run(FAST)
        self.check.check(result.report["jumps"] == [], f"{result.report['jumps']}")

    def beside(self):
        result = self.run(BESIDE)
        jump = self.one(result)
        self.close(jump["impulses"]["d1"]["charge"], 4e-6, "charge")
        self.close(jump["states"]["c1"]["after"], 4.0, "c1")
        self.check.check("c3" not in jump["states"], "c3 jumps")

    def many(self):
        jumps = self.run(CELLS).report["jumps"]
        self.check.check(len(jumps) == 10, f"{len(jumps)} jumps, not 10")
        for jump in jumps:
            (name, impulse), = jump["impulses"].items()
            k = int(name[1:])
            self.close(impulse["charge"], 10e-6 * k * k / (k + 1), f"charge of {name}")
            self.close(jump["states"][f"cb{k}"]["after"], 10 * k * k / (k + 1), f"cb{k}")

    def doubler(self):
        jumps = [j for j in self.run(DOUBLER).report["jumps"] if "d2" in j["impulses"]]
        self.check.check(len(jumps) == 5, f"{len(jumps)} rising edges, not 5")
        for n, jump in enumerate(jumps, 1):
            self.close(jump["time"], (2 * n - 1) * 1e-3, f"edge {n}")
            self.close(jump["states"]["c2"]["after"], 10 * (1 - 0.5 ** n), f"v(out) after {n}")
            self.close(jump["impulses"]["d2"]["charge"], 10e-6 * 0.5 ** n, f"charge of edge {n}")

    def derivative(self):
        result = run(self.program, BALL + ".end\n", method=self.method)
        self.check.check(result.status == 1, f"exit {result.status}, not refused")
        self.check.check("derivative of an impulse" in result.stderr, result.stderr)
        self.check.check("c2" in result.report["infeasible"]["elements"],
                         f"{result.report['infeasible']}")

    def impact(self):
        for tolerance in (None, 1e-9, 1e-10, 1e-11) if self.method != "euler" else ():
            result = run(self.program, IMPACT + ".end\n", method=self.method, tolerance=tolerance)
            self.check.check(result.status == 0, f"exit {result.status}: {result.stderr}")
            jump = self.one(result)
            self.check.close(jump["time"], 2 ** 0.5, 1e-11 * 4, "time of the impact")
            self.check.close(jump["impulses"]["d1"]["charge"], 2 ** 0.5, 1e-9, "impulse")
            for signal, wanted in (("v(v)", 0.0), ("v(h)", 0.0), ("i(d1)", 1.0)):
                last = result.column(signal)[-1]
                self.check.close(last, wanted, 1e-9, f"{signal} at rest, tolerance {tolerance}")

    def edge(self):
        result = self.run(EDGE)
        self.check.check(result.report["jumps"] == [], f"{result.report['jumps']}")
        if self.method != "euler":
            self.check.close(result.at("v(3)", 101e-6), 5.0, 1e-6, "v(3) behind the edge")

    def open(self):
        result = self.run(OPEN)
        for signal, wanted in (("i(v1)", 0.0), ("i(e0)", 1e-3)):
            self.check.close(result.column(signal)[-1], wanted, 1e-6, f"{signal} of an open mode")

    def behind_transformer(self):
        """s1 leaves lk to the winding and both diodes: what it and l1 hold together of flux, seen from the winding, stays."""
        jumps = self.run(BEHIND_TRANSFORMER).report["jumps"] if self.method != "euler" else []
        self.check.check(len(jumps) > 30 or self.method == "euler", f"{len(jumps)} behind a transformer")
        for jump in jumps:
            lk, l1 = jump["states"]["lk"], jump["states"]["l1"]
            after = (10.0 * abs(lk["before"]) + RATIO * l1["before"]) / (10.0 + RATIO ** 2)
            for found, wanted in ((abs(lk["after"]), after), (l1["after"], RATIO * after)):
                self.check.check(abs(found - wanted) < 1e-10, f"{found} A behind a transformer, not {wanted}")
            self.check.check("c9" not in jump["states"], "c9, in series with s1, jumps")

    def beside_large(self):
        result = self.run(BESIDE_LARGE)
        if result.status != 0:
            return
        times, current = result.column("time"), result.column("i(ls)")
        twice = [k for k in range(1, len(times)) if 0 < times[k] == times[k - 1]]
        self.check.check(twice or self.method == "euler", "no event")
        for k in twice:
            size = max(abs(current[k]), abs(current[k - 1]))
            self.check.check(abs(current[k] - current[k - 1]) <= 1e-8 * size,
                             f"ls: {current[k - 1]} A, then {current[k]} A at {times[k]} s")

    def leak(self):
        for netlist, ohms, henries, seen, wanted in (
                (LEAK, "1e11", "1u", 5e-6, 1e-10), (LEAK, "1e12", "30u", 5e-6, 1e-11), (LEAK, "1e14", "1m", 5e-6, 1e-13),
                (LATCH, "1e9", "1u", 15e-3, -325e-9), (LATCH, "1e10", "30u", 15e-3, -325e-10),
                (LATCH, "1e12", "1m", 15e-3, -325e-12)):
            result = self.run(netlist.format(ohms=ohms, henries=henries))
            if self.method != "euler" and result.status == 0:
                self.check.check(result.report["jumps"] == [], f"{ohms}: {result.report['jumps']}")
                found = result.at("i(l1)", seen)
                self.check.close(found, wanted, 0.02 * abs(wanted), f"the leak of {ohms}, {henries}")

    def all(self):
        for case in (self.source, self.interruption, self.no_jump, self.beside, self.many,
                     self.doubler, self.derivative, self.impact, self.edge, self.open,
                     self.behind_transformer, self.beside_large, self.leak,
                     self.formulas):
            case()
        return self.check.finish()


if __name__ == "__main__":
    sys.exit(Jumps(*sys.argv[1:]).all())
