#!/usr/bin/env python3
"""Integrals of waveforms with impulses: .losses, .meas, .four and the means of an orbit, against closed forms.

usage: impulses.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CLOSE = 1e-9
MODELS = """.model s sw(vt=0.5 ron=0)
"""
CLOCKS = """Vg g 0 pulse(0 1 1m 0 0 2m 4m)
Vq q 0 pulse(1 0 1m 0 0 2m 4m)
"""


class Case:
    def __init__(self, program, checker, netlist, method="auto"):
        self.title = netlist.split("\n", 1)[0]
        self.checker = checker
        self.run = dalcs_program.run(program, netlist + MODELS + (CLOCKS if ".pss" not in netlist else ""), method=method, quiet=True)
        checker.check(self.run.status == 0, f"{self.title}: {self.run.stderr}")
        report = self.run.report if self.run.status == 0 else {}
        self.measured = {m["name"]: m["value"] for m in report.get("measurements", [])}
        losses = report.get("losses", [])
        self.sum = losses[0] if losses else {}
        self.of = {e["element"]: e for e in self.sum.get("elements", [])}
        self.fourier = report.get("fourier", [])
        self.steady = report.get("steady", {}).get("signals", {})

    def close(self, found, wanted, what, size=None):
        allowed = CLOSE * (abs(wanted) if size is None else size)
        if self.checker.check(found is not None, f"{self.title}: no {what}"):
            self.checker.close(found, wanted, allowed, f"{self.title}: {what}")

    def meas(self, name, wanted, size=None):
        self.close(self.measured.get(name), wanted, name, size)

    def loss(self, element, key, wanted, size=None):
        self.close(self.of.get(element, {}).get(key), wanted, f"{key} of {element}", size)

    def none(self, value, what):
        self.checker.check(value is None, f"{self.title}: {what} is {value}, not none")


def two_capacitors(program, checker):
    """5 uC at 1 ms: of the windows from there on, and of no square."""
    for scale in 1e-6, 1.0, 1e6:
        q = 5e-6 * scale
        for first, last, n in ("0", "1m", 0), ("1m", "2m", 1), ("0.5m", "1.5m", 1), ("1.0001m", "2m", 0):
            r = Case(program, checker, f"""two capacitors
C1 a 0 1u ic={10 * scale}
S1 a b g 0 s
C2 b 0 1u
.tran 10u 2m uic
.losses from={first} to={last}
.meas tran q integ i(s1) from={first} to={last}
.meas tran half integ 0.5*i(c2)-i(c1) from={first} to={last}
""")
            r.meas("q", n * q, q)
            r.meas("half", 1.5 * n * q, q)
            length = r.sum["to"] - r.sum["from"]
            r.loss("s1", "i_average", n * q / length, q / length)
            r.loss("c1", "i_average", -n * q / length, q / length)
            if n:
                r.none(r.of["s1"]["i_rms"], "rms")
        checker.check("i_rms" in r.of["s1"] and r.of["s1"]["i_rms"] == 0, f"{r.of['s1']}")


def kinds_of_measurements(program, checker):
    r = Case(program, checker, """kinds of measurements
V1 i 0 3
C1 a 0 1u ic=10
S1 a b g 0 s
C2 b i 1u ic=-3
.tran 10u 2m uic
.meas tran rms rms i(s1)
.meas tran square integ i(s1)*i(s1)
.meas tran sides integ v(a)*i(s1)
.meas tran power integ v(i)*i(v1)
.meas tran magnitude integ abs(i(s1))
.meas tran most max i(s1)
.meas tran trig integ i(s1) trig at=0.5m targ v(b) val=1 rise=1
.meas tran targ integ i(s1) trig v(b) val=1 rise=1 targ at=1.5m
.meas tran when when v(b)=1 rise=1
.meas tran late integ i(s1) from='when-0.1m' to='when+0.1m'
.meas tran later integ i(s1) from='when+0.1m'
.meas tran times integ time*i(s1)
.four 500 i(c2)
""")
    for name in "rms", "square", "sides", "magnitude":
        r.none(r.measured[name], name)
    r.meas("power", 5e-6 * 3)
    r.meas("most", 0.0, 1.0)
    r.meas("trig", 0.0, 5e-6)
    r.meas("targ", 5e-6)
    r.meas("late", 5e-6)
    r.meas("later", 0.0, 5e-6)
    r.meas("times", 5e-9)
    for k, magnitude in enumerate(r.fourier[0]["magnitude"]):
        r.close(magnitude, 2.5e-3 if k == 0 else 5e-3, f"harmonic {k}")
    checker.check("impulse" in r.run.stderr, r.run.stderr)


def pump(program, checker):
    """A capacitor that moves C (V1 - V2) from a source to another in each period."""
    for volt, other, farad, period in (10, 4, 1e-6, 1e-4), (1e3, -2e3, 1e-9, 1e-6), (1e-3, 5e-4, 1e-12, 1e-8):
        q = farad * (volt - other)
        r = Case(program, checker, f"""pump
V1 in 0 {volt}
V2 out 0 {other}
S1 in a c 0 s
S2 a out e 0 s
C1 a 0 {farad} ic={other}
Vc c 0 pulse(1 0 {period / 2} 0 0 {period / 2} {period})
Ve e 0 pulse(0 1 {period / 2} 0 0 {period / 2} {period})
.tran {period} {10 * period} uic
.losses from={period} to={9 * period}
.meas tran in avg i(v1)
.meas tran out avg i(v2) from={period} to={9 * period}
.meas tran power avg v(in)*i(v1) from={period}
.four {1 / period} i(v1)
""")
        r.meas("in", -q / period)
        r.meas("out", q / period)
        r.meas("power", -volt * q / period)
        r.loss("v1", "i_average", -q / period)
        r.loss("v1", "power", -volt * q / period)
        r.loss("s1", "i_average", q / period)
        r.loss("c1", "i_average", 0.0, q / period)
        r.none(r.of["v1"]["i_rms"], "rms")
        r.close(r.sum["balance"], 0.0, "balance", abs(q * volt))
        r.close(r.fourier[0]["magnitude"][0], -q / period, "mean of .four")


def by_implicit_euler(program, checker):
    """Its straight lines through the value of an impulse have another area."""
    r = Case(program, checker, """implicit Euler
C1 a 0 1u ic=10
S1 a b g 0 s
C2 b 0 1u
.tran 10u 2m uic
.losses
.meas tran q integ i(s1)
.meas tran v integ v(b)
""", method="euler")
    r.none(r.measured["q"], "the integral")
    r.loss("s1", "i_average", 2.5e-3)
    r.none(r.of["s1"]["i_rms"], "the rms")
    r = Case(program, checker, """implicit Euler, at an event
I1 0 a 10m
C1 a 0 1u
C2 b 0 3u
S1 a b a 0 r
.model r sw(vt=5 vh=4.5 ron=0)
.tran 5u 2m uic
.losses
""", method="euler")
    r.loss("s1", "jumps", r.sum["switches"])
    r.close(r.sum["switches"], 0.375 * 9.5**2 * 1e-6, "energy of the jump", 1e9 * 0.04 * 34e-6)
    r = Case(program, checker, """implicit Euler, beside it
C1 a 0 1u ic=10
S1 a b g 0 s
C2 b 0 1u
.tran 10u 2m uic
.meas tran v integ v(b)
""", method="euler")
    checker.check(r.measured["v"] is not None, r.run.stderr)


def coils(program, checker):
    """Flux that a switch, a source and a coupled coil take."""
    r = Case(program, checker, """a coil cut off
L1 a 0 1m ic=2
S1 a 0 q 0 s
.tran 10u 3m uic
.losses
.meas tran flux integ v(a)
.meas tran rms rms v(a)
""")
    r.meas("flux", -2e-3)
    r.none(r.measured["rms"], "rms")
    r.loss("s1", "v_average", -2e-3 / 3e-3)
    r.none(r.of["l1"]["v_rms"], "rms of the coil")
    r = Case(program, checker, """two coupled coils cut off
L1 a 0 1m ic=2
L2 b 0 4m ic=1
K1 L1 L2 0.5
S1 a 0 q 0 s
S2 b 0 q 0 s
.tran 10u 3m uic
.meas tran one integ v(a)
.meas tran two integ v(b)
.meas tran sum integ v(a,b)
""")
    r.meas("one", -3e-3)
    r.meas("two", -6e-3)
    r.meas("sum", 3e-3)
    r = Case(program, checker, """a source that steps through a coil
I1 0 a pulse(0 1 1m 0 0 2m 9m)
L1 a 0 1m
R1 a b 1k
C1 b 0 1n
.tran 10u 2m
.meas tran flux integ v(a)
""")
    checker.check(r.measured["flux"] is not None, r.run.stderr)


def sources_that_read(program, checker):
    netlist = """sources that read
C1 a 0 1u ic=10
S1 a b g 0 s
V2 b c 0
C2 c 0 1u
F1 0 d V2 2
C3 d 0 4u
H1 e 0 V2 3
{load}
.tran 10u 2m uic
.meas tran f integ i(f1)
.meas tran h integ v(e)
.meas tran r integ i(r3)
.meas tran c integ i(c1)
"""
    r = Case(program, checker, netlist.format(load="R3 e 0 1k"))
    r.meas("f", 1e-5)
    r.meas("h", 1.5e-5)
    r.meas("r", 1.5e-8)
    r.meas("c", -5e-6)
    r = Case(program, checker, """work of a source that reads an impulse
C1 a 0 1u ic=10
S1 a b g 0 s
V2 b c 0
C2 c 0 1u
F1 0 d V2 2
C3 d 0 4u
.tran 10u 2m uic
.losses
""")  # 10 uC into 4 uF, of which no part is lost; 5 uC from 10 V to 5 V
    r.loss("f1", "jumps", -12.5e-6)
    r.loss("s1", "jumps", 25e-6)
    r.close(r.sum["balance"], 0.0, "balance", 25e-6)
    r = Case(program, checker, netlist.format(load="R3 e f 1k\nR4 f 0 1k"))  # a divider: not told, no guess
    r.none(r.measured["r"], "i(r3)")
    r.meas("c", -5e-6)


def starts(program, checker):
    r = Case(program, checker, """a jump at the start
V1 a 0 10
C1 a 0 1u ic=3
L1 b 0 1m ic=2
I1 0 b 1
.tran 10u 1m uic
.losses
.meas tran q integ i(c1)
.meas tran f integ v(b)
.meas tran later integ i(c1) from=1u
.meas tran work integ v(a)*i(v1)
""")
    r.meas("work", -7e-5)
    r.meas("q", 7e-6)
    r.meas("f", -1e-3)
    r.meas("later", 0.0, 7e-6)
    r.loss("v1", "i_average", -7e-3)
    r.loss("i1", "v_average", 1.0)
    r = Case(program, checker, """an edge at the start
V1 a 0 pulse(0 10 0 0 0 1 2)
C1 a 0 1u
.tran 10u 1m
.losses
.meas tran q integ i(v1)
""")
    r.meas("q", -1e-5)
    r.loss("c1", "i_average", 1e-2)


def passed_over(program, checker):
    """Jumps before a window that begins with one: they are of no window."""
    for first in 2, 3, 5:
        r = Case(program, checker, f"""jumps before the window
V1 i 0 1
C1 a 0 1u
S1 a i c 0 s
S2 a 0 e 0 s
Vc c 0 pulse(0 1 0 0 0 0.5m 1m)
Ve e 0 pulse(0 1 0.5m 0 0 0.5m 1m)
.tran 10u 9m uic
.losses from={first}m
.meas tran q integ i(v1) from={first}m
""")
        n = 9 - first
        r.meas("q", -n * 1e-6)
        r.loss("v1", "i_average", -1e-3)
        r.loss("s1", "power", 0.5e-3)
        r.close(r.sum["balance"], 0.0, "balance", 1e-6)


def orbit(program, checker):
    """A pump into a resistor: v of C2 decays by exp(-T/2RC) in each half, with and without C1 beside it."""
    r = Case(program, checker, """an orbit
V1 in 0 10
S1 in a c 0 s
S2 a out e 0 s
C1 a 0 1u
C2 out 0 10u
R1 out 0 1k
Vc c 0 pulse(1 0 50u 0 0 50u 100u)
Ve e 0 pulse(0 1 50u 0 0 50u 100u)
.pss 100u
.losses
.meas pss in avg i(v1)
.meas pss power avg v(in)*i(v1)
.save v(out) i(v1) i(c1) v(in)
""")
    # of one period: v in the middle is u, behind the jump w = (10 C1 + C2 u)/(C1 + C2); then both decay, then C2 alone
    both, alone = math.exp(-50e-6 / 11e-3), math.exp(-50e-6 / 10e-3)
    w = 10 * 1e-6 / 11e-6 / (1 - 10 / 11 * both * alone)
    charge = 1e-6 * (10 - w * both)
    r.meas("in", -charge / 100e-6)
    r.meas("power", -charge / 10e-6)
    r.loss("v1", "i_average", -charge / 100e-6)
    r.loss("c1", "i_average", 0.0, charge / 100e-6)
    r.close(r.steady.get("i(v1)", {}).get("average"), -charge / 100e-6, "average of the orbit")
    r.close(r.steady.get("i(c1)", {}).get("average"), 0.0, "average of i(c1)", charge / 100e-6)
    r.none(r.steady.get("i(v1)", {}).get("rms"), "rms of the orbit")
    r.close(r.steady.get("v(in)", {}).get("rms"), 10.0, "rms beside it")


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("impulses")
    for case in (two_capacitors, kinds_of_measurements, pump, by_implicit_euler, coils, sources_that_read, starts, passed_over, orbit):
        case(program, checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
