#!/usr/bin/env python3
"""Diodes that have neither voltage nor current for a while, or for an instant: a small signal decides their sides itself.

usage: resting.py PROGRAM

Where it reaches one there is no linear response, and the program says so, with its name. That this is true a small sine
shows: the component at twice its frequency falls with the amplitude, not with its square. Those that only come near to
their other side are named, with the signal that takes them there, which is less than one that an analyser would send. Where it
reaches none, as of a diode across a closed switch without resistance, the response is exact, and that of a small sine.
"""

import cmath
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "steady"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
from topologies import Topology, gate, square  # pylint: disable=wrong-import-position,import-error

FRACTION = (3, 10)
NEAR = 1e-6
IDEAL = ".model s0 SW(Ron=0 Vt=0.5)\n"
BUCK = "S1 in sw g1 0 s0\nD1 0 sw\nL1 sw out 47u\nC1 out 0 22u\nR1 out 0 4\n"


def doubler(name, load, level=5.0, period=10e-6, store=100e-9, out="10u", edge=0.0):
    return Topology(name, "Vin in 0 {S}\n" + square("ck", 0.0, level, period, 0.5, 0.0, edge) + f"D1 in a\nC1 ck a {store!r}\n"
                    f"D2 a out\nC2 out 0 {out}\n{load}\n", level, 1e-4 * level, period, "v(out)")


def reached():
    """Topologies, and which diodes rest."""
    yield doubler("doubler", "R1 out 0 10k"), "d1 d2"
    yield doubler("doubler, load of a current", "I1 out 0 1m"), "d1 d2"
    yield doubler("doubler, kilovolts", "R1 out 0 10meg", 2000.0, 1e-3, 10e-9, "33n"), "d1 d2"
    yield doubler("doubler, picofarads", "I1 out 0 20n", 1.2, 50e-9, 1e-12, "3p"), "d1 d2"
    yield doubler("doubler, edges of 10 ns", "R1 out 0 2k", edge=10e-9), "d1 d2"
    yield doubler("doubler, a filter behind it", "R1 out f 10\nL1 f g 1m\nC3 g 0 4.7u\nR2 g 0 1k", out="1u"), "d1 d2"
    yield Topology("Greinacher", "Vs s 0 {S}\nV1 in s PULSE(-5 5 0 0 0 5u 10u)\nC1 in a 100n\nD1 0 a\nD2 a out\nC2 out 0 1u\n"
                   "R1 out 0 1k\n", 0.0, 1e-3, 10e-6, "v(out)"), "d1 d2"
    yield Topology("Cockcroft-Walton", "Vs s 0 {S}\nV1 in s PULSE(-100 100 0 0 0 0.4m 1m)\nC1 in a 1u\nC2 a b 470n\nD1 0 a\n"
                   "D2 a m\nD3 m b\nD4 b out\nC3 m 0 1u\nC4 out m 330n\nR1 out 0 100k\n", 0.0, 1e-2, 1e-3, "v(out)"), "d1 d2 d3 d4"
    yield Topology("inverting pump", "Vin in 0 {S}\nB1 ck 0 V=v(in)*v(g)\nVg g 0 PULSE(0 1 0 0 0 0.4u 1u)\nC1 ck a 1u\nD1 a 0\n"
                   "D2 b a\nC2 b 0 4.7u\nR1 b 0 150\n", 12.0, 1e-3, 1e-6, "v(b)"), "d1 d2"
    yield Topology("two equal supplies", "Vin in 0 {S}\nVb b 0 24\n" + gate(1, 10e-6, 0, 0.4) + "D5 in x\nD6 b x\n" +
                   BUCK.replace("S1 in", "S1 x") + IDEAL, 24.0, 1e-3, 10e-6, "v(out)"), "d5 d6"
    # one mode all the time: it rests at the top of the pulse, and has 3 V beside it
    yield Topology("peak detector", "Vin in 0 {S}\nVp p in PULSE(0 3 0 0 0 4u 10u)\nD1 p out\nC1 out 0 1u IC=8\nRx in x 1\nCx x 0 1u\n",
                   5.0, 1e-3, 10e-6, "i(vin)"), "d1"
    yield Topology("a rectifier of nothing", "Vz z 0 {S}\n" + square("ck", 0.0, 1.0, 1e-3) + "R9 ck 0 1\nD1 z out\nR1 out 0 1k\n",
                   0.0, 1e-3, 1e-3, "v(out)"), "d1"


def forward(coupling, store, period, level, coil):
    """The coil rings with the capacitor from the clamp back to the clamp, once it is empty."""
    return Topology(f"forward, K = {coupling}", "Vin in 0 {S}\n" + gate(1, period, 0, 0.4) + f"L1 in sw {coil!r}\nL2 s 0 {coil / 4!r}\n"
                    f"K1 L1 L2 {coupling}\nS1 sw 0 g1 0 s0\nCr sw 0 {store}\nDc 0 sw\nD1 s f\nD2 0 f\nLo f out {coil / 25!r}\n"
                    "C1 out 0 100u\nR1 out 0 2\n" + IDEAL, level, 1e-5 * level, period, "v(out)")


def pump(resistance, store):
    return Topology(f"pump, {resistance} and {store}", "Vin in 0 {S}\nVk ck 0 PULSE(0 5 0 0 0 5u 10u)\n"
                    f"R0 ck k {resistance}\nC1 k a {store}\nD1 in a\nD2 a out\nCo out 0 1u\nRo out 0 5k\n", 5.0, 5e-3, 10e-6, "v(out)")


def near():
    """Topologies, and the diode that only comes near to its other side."""
    yield forward(0.9, "220p", 10e-6, 48.0, 1e-3), "dc"
    yield forward(0.97, "1n", 50e-6, 12.0, 3e-3), "dc"
    yield Topology("buck-boost that rings", "Vin in 0 {S}\n" + gate(1, 10e-6, 0, 0.2) + "S1 in sw g1 0 s0\nDb sw in\nL1 sw 0 20u\n"
                   "Cs sw 0 100p\nD1 out sw\nC1 out 0 10u\nR1 out 0 300\n" + IDEAL, 12.0, 1.2e-4, 10e-6, "v(out)"), "db"
    for resistance, store in (("1m", "1u"), ("30", "10n"), ("10", "47n")):
        yield pump(resistance, store), "d1"
    yield Topology("four diodes", "Vin in 0 {S}\n" + square("ck1", 0.0, 5.0, 10e-6) + "E2 ck2 0 VALUE={5-v(ck1)}\nD0 in n0\n" +
                   "".join(f"R{k} ck{1 + k % 2} c{k} 10\nC{k} c{k} n{k} 10n\nD{k + 1} n{k} n{k + 1}\n" for k in range(3)) +
                   "Co n3 0 1u\nRo n3 0 5k\n", 5.0, 5e-3, 10e-6, "v(n3)"), "d0"


def borders():
    """The discontinuous side of the border: the diode ceases to conduct just before the clock."""
    def load(base, beyond):
        return f"C1 out 0 1m\nR1 out 0 {base * (1 + beyond)!r}\n" + IDEAL
    clock = gate(1, 10e-6, 0, 0.4)
    yield Topology("buck", "Vin in 0 {S}\n" + clock + "S1 in sw g1 0 s0\nD1 0 sw\nL1 sw out 10u\n" + load(10 / 3, 2e-4),
                   12.0, 0.0, 10e-6, "v(out)")
    yield Topology("boost, a clock in mid-period", "Vin in 0 {S}\n" + gate(1, 20e-6, 0.3, 0.5) + "L1 in sw 40u\nS1 sw 0 g1 0 s0\nD1 sw out\n" +
                   load(32.0, 1e-4), 24.0, 0.0, 20e-6, "v(out)")
    yield Topology("flyback", "Vin in 0 {S}\n" + gate(1, 2e-6, 0.2, 0.5) + "S1 sw 0 g1 0 s0\nL1 in sw 2u\nL2 0 s 8u\nK1 L1 L2 1\nD1 s out\n" +
                   load(32.0, 5e-4), 48.0, 0.0, 2e-6, "v(out)")
    yield Topology("sepic", "Vin in 0 {S}\n" + clock + "L1 in a 20u\nS1 a 0 g1 0 s0\nCs a b 100u\nRx b xd 1\nCx xd a 1m\nL2 b 0 20u\n"
                   "D1 b out\n" + load(5.556, 1e-4), 12.0, 0.0, 10e-6, "v(out)")
    yield Topology("an edge of the source", "Vin in 0 {S}\nVk k in PULSE(-4 6 1u 0 0 4u 10u)\nL1 k x 10u\nD1 x out\nVo out 0 12.0005\n",
                   12.0, 0.0, 10e-6, "i(vo)")


def not_reached():
    two = "Vin in 0 12\nVo o 0 {S}\n" + gate(1, 10e-6, 0, 0.2) + gate(2, 10e-6, 0.4800001, 0.2)
    yield Topology("the clock of another phase", two + "".join(f"S{k} in x{k} g{k} 0 s0\nD{k} 0 x{k}\nL{k} x{k} m 10u\n" for k in (1, 2)) +
                   "Ro m o 1m\n" + IDEAL, 5.0, 1e-3, 10e-6, "i(vo)")
    ring = forward(0.9, "220p", 10e-6, 48.0, 1e-3)
    yield ring._replace(name="forward with a loss", netlist=ring.netlist + "Rd sw in 10k\n", amplitude=1e-3)
    yield forward(0.7, "68p", 4e-6, 300.0, 2e-3)._replace(amplitude=1e-2)
    two = "Vin in 0 {S}\n" + gate(1, 10e-6, 0, 0.4) + gate(2, 10e-6, 0.4, 0.6)
    yield Topology("diodes across switches", two + BUCK + "Ds sw in\nS2 sw 0 g2 0 s0\n" + IDEAL, 24.0, 1e-3, 10e-6, "v(out)")
    yield Topology("a bridge of them", "Vin in 0 {S}\n" + gate(1, 20e-6, 0, 0.6) + gate(2, 20e-6, 0.6, 0.4) +
                   "".join(f"S{k} {a} {b} g{g} 0 s0\nD{k} {b} {a}\n" for k, a, b, g in
                           ((1, "in", "x", 1), (2, "x", "0", 2), (3, "in", "y", 2), (4, "y", "0", 1))) +
                   "L1 x o 100u\nR1 o y 5\n" + IDEAL, 48.0, 1e-2, 20e-6, "i(l1)")
    yield Topology("two diodes side by side", "Vin in 0 {S}\n" + gate(1, 10e-6, 0, 0.4) + BUCK + "D2 0 sw\n" + IDEAL,
                   24.0, 1e-3, 10e-6, "v(out)")
    yield Topology("a diode that nothing reaches", "Vin in 0 {S}\n" + gate(1, 10e-6, 0, 0.4) + BUCK + "Vz z 0 0\nD9 z y\nR8 y 0 1k\n" +
                   IDEAL, 24.0, 1e-3, 10e-6, "v(out)")
    yield Topology("supplies apart", "Vin in 0 {S}\nVb b 0 23\n" + gate(1, 10e-6, 0, 0.4) + "D5 in x\nD6 b x\n" +
                   BUCK.replace("S1 in", "S1 x") + IDEAL, 24.0, 1e-3, 10e-6, "v(out)")
    yield doubler("doubler with leakage", "R1 out 0 10k\nRa a out 20k")
    # a half and the switch in series with it open by one current, which no signal parts
    line = "Vl a 0 SIN(0 325 50)\nVs b a {S}\nVg g 0 PULSE(0 1 4m 0 0 1m 10m)\n"
    for name, before, model, load in (("a triac", "A1 b o g 0 tr\n", "Voff=1m", "L1 o x 50m\nR1 x 0 60\n"),
                                      ("a triac behind a coil", "Ls b c 1m\nA1 c o g 0 tr\n", "Voff=1m", "L1 o x 50m\nR1 x 0 60\n"),
                                      ("a triac and a capacitor", "Ls b c 1m\nA1 c o g 0 tr\n", "",
                                       "R2 o 0 1k\nC2 o 0 100n\nL1 o x 20m\nR1 x 0 25\n")):
        yield Topology(name, line + before + load + f".model tr triac(Ron=10m {model})\n", 0.0, 1e-2, 0.02, "i(l1)")
    # a voltage that an edge takes to 0.01 V moves with the signal behind the edge alone
    yield Topology("class DE", "Vin d 0 {S}\n" + gate(1, 1e-6, 0, 0.25) + gate(2, 1e-6, 0.5, 0.25) + "S1 d sw g1 0 sm\nD1 sw d\nS2 sw 0 g2 0 sm\n"
                   "D2 0 sw\nCp sw 0 1n\nLr sw r 10u\nCr r o 3.3n\nR1 o 0 15\n.model sm SW(Ron=10m Vt=0.5)\n", 50.0, 0.1, 1e-6, "v(o)")
    # charge passes in an instant through diodes that are open before it and behind it: nothing but the jump tells it
    yield Topology("leaks that open both diodes", "Vin in 0 {S}\n" + square("ck", 0.0, 5.0, 10e-6) +
                   "C1 ck a 100n\nD1 in a\nD2 a out\nC2 out 0 1u\nR1 out 0 20k\nRa a 0 20k\nRb a out 5k\n", 5.0, 1e-3, 10e-6, "v(out)")
    yield Topology("three stages that leak", "Vin in 0 {S}\n" + square("k", 0.0, 3.3, 1e-6) + square("q", 0.0, 3.3, 1e-6, 0.45, 0.52) +
                   "D0 in n0\nC0 k n0 10p\nD1 n0 n1\nC1 q n1 10p\nD2 n1 n2\nC2 k n2 10p\nD3 n2 out\nCo out 0 50p\nI1 out 0 1u\n"
                   "R0 n0 n1 5meg\nR1 n1 n2 5meg\nR2 n2 out 5meg\n", 3.3, 1e-4, 1e-6, "v(out)")


class Look:
    def __init__(self, program, folder, checker):
        self.program, self.folder, self.checker = program, folder, checker

    def run(self, case, source, cards):
        text = case.netlist.replace("{S}", source)
        (self.folder / "c.cir").write_text(f"{case.name}\n{text}.save {case.signal}\n{cards}.end\n")
        done = subprocess.run([self.program, "run", "c.cir", "-q", "-o", "c.csv", "--report", "c.json", "--tol", "1e-11"],
                              cwd=self.folder, capture_output=True, text=True, check=False)
        self.checker.check(done.returncode == 0, f"{case.name}: {done.stderr}")
        return done.stderr, json.loads((self.folder / "c.json").read_text())

    def response(self, case):
        frequency = FRACTION[0] / FRACTION[1] / case.clock
        said, report = self.run(case, f"DC {case.level!r} AC 1", f".pss uic\n.ac list {frequency!r}\n")
        row = [float(v) for v in (self.folder / "c.csv").read_text().splitlines()[1].split(",")]
        return said, report["response"]["exact"], complex(row[1], row[2])

    def injected(self, case, amplitude):
        """Components at the frequency of a sine, and at twice that."""
        frequency = FRACTION[0] / FRACTION[1] / case.clock
        _, report = self.run(case, f"SIN({case.level!r} {amplitude!r} {frequency!r})",
                             f".pss {FRACTION[1] * case.clock!r} uic\n.four {frequency!r} 2 {case.signal}\n")
        part = report["fourier"][0]
        return [part["magnitude"][k] * cmath.exp(1j * math.radians(part["phase"][k])) / amplitude for k in (1, 2)]

    def look_at_reached(self, case, names):
        said, exact, _ = self.response(case)
        self.checker.check(not exact, f"{case.name}: it is called exact")
        self.checker.check("there is no linear response" in said and any(f"'{name}'" in said for name in names.split()),
                           f"{case.name}: {said}")
        if case.signal == "i(vin)":
            return
        twice = [abs(self.injected(case, case.amplitude / k)[1]) for k in (1, 4)]
        self.checker.check(twice[1] > 0.5 * twice[0] > 1e-6, f"{case.name}: linear, {twice}")

    def look_at_near(self, case, name):
        """It is said, and that it is true a sine shows that is larger than that."""
        said, exact, found = self.response(case)
        self.checker.check(not exact and "have this response" in said and f"'{name}' is " in said, f"{case.name}: {exact}, {said}")
        away = abs(self.injected(case, case.amplitude)[0] - found) / abs(found)
        self.checker.check(away > 1e-3, f"{case.name}: {found} is off by {away:.2g} alone")

    def look_at_border(self, case):
        """A sine that is just smaller has this response, and one three times as large another one."""
        said, exact, found = self.response(case)
        told = re.search(r"only signals below (\S+) of .* 'd1' ceases to conduct", said)
        if not self.checker.check(not exact and told, f"{case.name}: {exact}, {said}"):
            return
        reach = float(told.group(1))
        for part, least, most in ((0.45, 0.0, 1e-4), (3.0, 1e-2, math.inf)):
            away = abs(self.injected(case, part * reach)[0] - found) / abs(found)
            self.checker.check(least <= away <= most, f"{case.name}: {found} is off by {away:.2g} at {part} of {reach}")

    def look_at_others(self, case):
        said, exact, found = self.response(case)
        self.checker.check(exact and "linear" not in said and "only signals" not in said, f"{case.name}: {said}")
        whole, half = self.injected(case, case.amplitude)[0], self.injected(case, case.amplitude / 2)[0]
        away = abs(found - (4 * half - whole) / 3) / abs(found)
        self.checker.check(away <= NEAR, f"{case.name}: {found} is off by {away:.2g}")


def main():
    checker = dalcs_program.Checker("diodes that rest")
    with tempfile.TemporaryDirectory() as folder:
        look = Look(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(folder), checker)
        for case, names in reached():
            look.look_at_reached(case, names)
        for case, name in near():
            look.look_at_near(case, name)
        for case in borders():
            look.look_at_border(case)
        for case in not_reached():
            look.look_at_others(case)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
