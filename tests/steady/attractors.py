#!/usr/bin/env python3
"""What a run comes to where no orbit of one period of the clock holds it: of n periods, quasi-periodic, or chaos.

usage: attractors.py PROGRAM

Orbits are compared with long runs, and with what `.pss periods=n` finds. How fast chaos takes two runs apart is known of
maps of a line that are iterated here. Duffing's oscillator does what Jordan and Smith (Nonlinear Ordinary Differential
Equations, chapter 13) say, and the buck converter what Hamill and Deane found.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
from doubling import BUCK  # pylint: disable=wrong-import-position

NEAR = 1e-9


def boost(peak):
    return f"""Vin in 0 10
L1 in sw 1m
S1 sw 0 u 0 latch
D1 sw out
C1 out 0 12u
R1 out 0 20
Vclk clk 0 PULSE(0 1 0 0 0 1u 100u)
Bl u 0 V=2*v(clk)-3*u(i(L1)-{peak})
.model latch SW(Vt=0 Vh=1)
"""


def valley(volts):
    """It opens with the clock and closes where the current has fallen to 2 A: unstable with a duty cycle below 1/2."""
    return f"""Vin in 0 {volts}
Vclk clk 0 PULSE(0 1 0 0 0 100n 10u)
Bl u 0 V=3*u(2-i(L1))-2*v(clk)
S1 in sw u 0 latch
.model latch SW(Vt=0 Vh=1)
D1 0 sw
L1 sw out 22u
C1 out 0 220u
R1 out 0 2
"""


def peak(output):
    """The output is a source: the current at the clock is a map of a line."""
    return f"""V1 in 0 12
Vclk clk 0 PULSE(0 1 0 0 0 0.01u 10u)
Bl u 0 V=2*v(clk)-3*u(i(L1)-5)
S1 in sw u 0 latch
.model latch SW(Vt=0 Vh=1)
D1 0 sw
L1 sw out 40u
V2 out 0 {output!r}
"""


def duffing(force):
    return f"""V1 s 0 SIN(0 {force} {1.2 / (2 * math.pi)!r})
B1 0 y I=v(s)
C1 y 0 1
R1 y 0 {1 / 0.3!r}
B2 y 0 I=v(x)*v(x)*v(x)-v(x)
B3 0 x I=v(y)
C2 x 0 1 IC=0.5
"""


def pi_controlled(zero):
    """Too small a resistance at the zero of the controller: the loop oscillates, and the comparator limits it."""
    return f"""Vin in 0 12
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 47u
C1 out esr 100u
Resr esr 0 0.01
R1 out 0 2.5
Vref ref 0 5
G1 0 ctl ref out 1m
Rz ctl z {zero}
Cz z 0 82n
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
.model sm SW(Ron=0 Vt=0)
"""


def digital(gain):
    """A controller that is late by a period."""
    return f"""Vin in 0 12
Vclk clk 0 PULSE(0 1 0 0 0 1u 10u)
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
Vref ref 0 5
B1 next 0 V=v(sum)+{gain}*(v(ref)-v(out))
A1 next 0 clk 0 0 0 sum 0 SAMPLEHOLD IC=0.4
B2 duty 0 V=v(sum)+0.01*(v(ref)-v(out))
A2 duty 0 clk 0 0 0 held 0 SAMPLEHOLD IC=0.4
A3 held 0 clk 0 0 0 late 0 SAMPLEHOLD IC=0.4
E1 cmp 0 late tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 22u
C1 out esr 100u
Resr esr 0 0.02
R1 out 0 2
.model sm SW(Ron=10m Vt=0)
"""


def forced(volts, ratio):
    """An oscillator of its own beside a sine of about `ratio` times its frequency, which takes it along or does not."""
    hertz = ratio / (2e-3 * math.log(2))
    return f"""Vcc p 0 1
Vd cc c SIN(0 {volts!r} {hertz!r})
Sp p y 0 cc below
Sn y 0 cc 0 above
R1 y c 1k
C1 c 0 1u
.model above SW(Ron=0 Vt=0.5 Vh={1 / 6!r})
.model below SW(Ron=0 Vt=-0.5 Vh={1 / 6!r})
"""


def hysteretic(volts, hertz):
    return f"""Vin in 0 12
Vref r 0 5
Vd d 0 PULSE(0 {volts} 0 0 0 {0.5 / hertz!r} {1 / hertz!r})
Bref ref 0 V=v(r)+v(d)
S1 in sw ref fb mos
D1 0 sw
L1 sw out 22u
C1 out esr 100u
Resr esr 0 100m
R1 out 0 5
Rf out fb 1k
Cf fb 0 1n
.model mos SW(Ron=5m Vt=0 Vh=20m)
"""


def hamill_deane(volts):
    return BUCK.format(volts=volts, card="").replace(".end\n", "")


def sigma_delta(volts):
    """It is late by a part of a period that no period of bits has, and its integrator forgets slowly."""
    return f"""Vx x 0 {volts}
Vclk clk 0 PULSE(0 1 0 0 0 50n 1u)
G1 0 y x d 1m
C1 y 0 1n
R1 y 0 10meg
A1 y 0 0 0 0 0 cmp 0 BUF Ref=0
A2 cmp 0 clk 0 0 0 q 0 DFLOP
B1 d 0 V=2*v(q)-1
"""


def linear(ohms):
    """Nothing limits what a negative resistance drives."""
    return f"V1 s 0 PULSE(-1 1 0 0 0 5u 10u)\nR1 s a 1\nL1 a b 100u\nC1 b 0 1u\nR2 b 0 {ohms}\n"


def endless(tank, current, slope, source):
    """A tank without losses: what drives it is limited, so that the oscillation grows with time, or its square root, without end."""
    return f"{tank}B1 0 x I=limit({slope}*v(x),-{current},{current})\nI1 x 0 {source}\n"


LC = "L1 x 0 1m\nC1 x 0 1u IC=1\n"
SOURCE = "PULSE(0 1m 0 0 0 30u 100u)"
POWER = """V9 in 0 400
L1 in x 1m
C1 x 0 100u
B1 x 0 I=2k/max(v(x),50)
I1 x 0 PULSE(0 1 0 0 0 50u 130u)
"""
SERIES = "V1 a 0 PULSE(-1 1 0 0 0 4u 9u)\nL1 a b 10u\nC1 b c 100n\nB1 c 0 V=limit(-2*i(L1),-0.4,0.4)\n"
BENT = "L1 x 0 Flux=pwl(x,-10,-1.6m,-1,-1m,1,1m,10,1.6m)\nC1 x 0 1u IC=1\n"
VARACTOR = "L1 x 0 1m\nC1 x 0 Q=1u*(x>0?x:2*x)\n"

# name, netlist, what a run comes to (n: an orbit of so many periods)
BESIDE = [
    ("boost, 2 A", boost(2), 2), ("boost, 2.5 A", boost(2.5), 4), ("boost, 3 A", boost(3), "chaos"),
    ("boost, 5.5 A", boost(5.5), "chaos"),
    ("valley, 12 V", valley(12), 2), ("valley, 20 V", valley(20), "chaos"), ("valley, 30 V", valley(30), "chaos"),
    ("Hamill and Deane, 28 V", hamill_deane(28.0), 2), ("Hamill and Deane, 32 V", hamill_deane(32.0), 4),
    ("Hamill and Deane, 33 V", hamill_deane(33.0), "chaos"), ("Hamill and Deane, 35 V", hamill_deane(35.0), "chaos"),
    ("Duffing, 0.28", duffing(0.28), 2), ("Duffing, 0.29", duffing(0.29), 4), ("Duffing, 0.37", duffing(0.37), 5),
    ("Duffing, 0.5", duffing(0.5), "chaos"),
    ("PI, 300 ohm", pi_controlled(300), "quasi-periodic"), ("PI, 600 ohm", pi_controlled(600), 50),
    ("PI, 1300 ohm", pi_controlled(1300), "quasi-periodic"),
    ("digital, 0.01", digital(0.01), "quasi-periodic"), ("digital, 0.02", digital(0.02), "quasi-periodic"),
    ("linear, grows by 1.0005", linear(-99), None), ("linear, grows by 1.5", linear(-9), None),
    ("linear, grows by 1 + 5e-7", linear(-99.999), None),
    ("endless", endless(LC, "1m", 0.01, SOURCE), None), ("endless, weak", endless(LC, "10u", 0.001, SOURCE), None),
    ("endless, a coil that saturates", endless(BENT, "1m", 0.01, SOURCE), None),
    ("endless, a capacitor that bends", endless(VARACTOR, "1m", 0.01, SOURCE), None),
    ("endless, two tanks", endless(LC + "C3 x y 0.1u\nL2 y 0 0.7m\nC2 y 0 1u\n", "1m", 0.01, SOURCE), None),
    ("endless, in series", SERIES, None), ("endless, a constant power", POWER, None),
    ("the same with a loss", endless(LC + "R1 x 0 1k\n", "10m", 0.01, SOURCE), "quasi-periodic"),
]

# no orbit of one period was found
AHEAD = [
    ("taken along, 2", forced(0.05, 2.03), 2), ("taken along, 1.97", forced(0.05, 1.97), 2),
    ("taken along, 3", forced(0.02, 3.02), 3), ("taken along, 2.52", forced(0.05, 2.52), 3),
    ("taken along, 1.618", forced(0.05, 1.618), 7),
    ("not taken along, 2.03", forced(0.02, 2.03), "quasi-periodic"),
    ("not taken along, 1.618", forced(0.02, 1.618), "quasi-periodic"),
    ("hysteretic, 70 kHz", hysteretic("5m", 70e3), "quasi-periodic"),
    ("hysteretic, 100 kHz", hysteretic("20m", 100e3), "chaotic"), ("hysteretic, 300 kHz", hysteretic("30m", 300e3), "chaotic"),
    ("endless, kilowatts", endless("L1 x 0 10\nC1 x 0 1m\n", 2, 0.1, "SIN(0 1 1.13)"), None),
    ("a tank at its resonance", f"L1 x 0 1m\nC1 x 0 {1e3 / (2e4 * math.pi) ** 2!r}\nI1 x 0 SIN(0 1m 10k)\n", None),
    ("sigma-delta, 0.1", sigma_delta(0.1), "fades"), ("sigma-delta, 0.5", sigma_delta(0.5), "fades"),
]


class Look:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.checker = dalcs_program.Checker("attractors")

    def run(self, netlist, card, verb="steady", *options):
        (self.folder / "c.cir").write_text(f"* a converter\n{netlist}{card}\n.end\n")
        (self.folder / "c.json").unlink(missing_ok=True)
        done = subprocess.run([self.program, verb, "c.cir", "-o", "none", "--report", "c.json", *options],
                              cwd=self.folder, capture_output=True, text=True, check=False)
        path = self.folder / "c.json"
        return done, json.loads(path.read_text()) if path.exists() else {}

    def final(self, netlist, stop):
        _, report = self.run(netlist, f".tran {stop!r} {stop!r} {stop * (1 - 1e-9)!r} uic", "run", "--tol", "1e-11",
                             "--fill", "none")
        return report["final"]

    def settled(self, name, netlist, steady, n):
        """A long run is on the orbit, in one of its n periods."""
        one = steady["period"] / n
        factor = max((math.hypot(m["re"], m["im"]) for m in steady["multipliers"]), default=0.0)
        periods = n * (400 + math.ceil(1.3 * math.log(1e-12) / math.log(max(factor, 1e-3))))
        off = math.inf
        for k in range(n if n <= 8 else 0):
            end = self.final(netlist, (periods + k) * one)
            scale = {kind: max(abs(end[x]) for x in end if x[0] == kind) for kind in {x[0] for x in end}}
            off = min(off, max(abs(steady["states"][x] - end[x]) / scale[x[0]] for x in end))
        self.checker.check(n > 8 or off < NEAR, f"{name}: off by {off:.2g} from a run")

    def of_many(self, name, netlist, one, n, growth):
        """periods=n finds the orbit that was told of."""
        done, report = self.run(netlist, f".pss periods={n} uic")
        if not self.checker.check(done.returncode == 0, f"{name}, periods={n}: {done.stderr}"):
            return
        steady = report["steady"]
        factor = max((math.hypot(m["re"], m["im"]) for m in steady["multipliers"]), default=0.0)
        self.checker.check(steady["stable"] and abs(steady["period"] / one / n - 1) < 1e-12, f"{name}: {steady['verdict']}")
        self.checker.check(abs(factor - growth) < 1e-6, f"{name}: {factor}, not {growth}")
        self.settled(name, netlist, steady, n)

    def beside(self, name, netlist, expected):
        done, report = self.run(netlist, ".pss uic")
        if not self.checker.check(done.returncode == 0 and "error" not in done.stderr, f"{name}: {done.stderr}"):
            return
        steady = report["steady"]
        found = steady.get("attractor", {})
        verdict = steady["verdict"]
        self.checker.check(not steady["stable"] and verdict.startswith("unstable"), f"{name}: {verdict}")
        if isinstance(expected, int):
            is_doubled = expected == 2 and steady.get("doubled", {}).get("stable")
            n = 2 if is_doubled else found.get("periods")
            growth = (max((math.hypot(m["re"], m["im"]) for m in steady["doubled"]["multipliers"]), default=0.0)
                      if is_doubled else found.get("growth"))
            if self.checker.check(n == expected and f"periods={n} gives it" in verdict, f"{name}: {verdict}"):
                self.of_many(name, netlist, steady["period"], n, growth)
            return
        self.checker.check(found.get("kind") == expected, f"{name}: {found}, not {expected}")
        self.checker.check("grows by 1 each" not in verdict, f"{name}: {verdict}")
        word = {"chaos": "chaotic", "quasi-periodic": "quasi-periodic"}.get(expected, "grows by")
        self.checker.check(word in verdict, f"{name}: {verdict}")
        if expected == "quasi-periodic":
            self.checker.check(abs(found["growth"] - 1) < 0.03, f"{name}: {found}")

    def ahead(self, name, netlist, expected):
        done, report = self.run(netlist, ".pss uic")
        said = done.stderr
        if not isinstance(expected, int):
            self.checker.check(done.returncode == 1 and "steady" not in report and (expected or "no periodic steady state") in said,
                               f"{name}: {said}")
            self.checker.check(expected or "a run" not in said, f"{name}: {said}")
            return
        if not self.checker.check(done.returncode == 0, f"{name}: {said}"):
            return
        steady = report["steady"]
        hertz = float(re.search(r"SIN\(0 \S+ ([^)]+)\)", netlist)[1])
        n = steady["period"] * hertz
        self.checker.check(abs(n - expected) < 1e-9 and f"{expected} times" in said, f"{name}: {n}, {said}")
        self.checker.check(steady["stable"], f"{name}: {steady['verdict']}")
        self.settled(name, netlist, steady, expected)


def growth_of_line(up, down, periods=200000):
    """From a clock to the next one the current rises to 5 A, and falls; or it does not get there. On average."""
    current, total = 4.3, 0.0
    for _ in range(periods):
        to_peak = (5 - current) / up
        if to_peak < 1:
            current = 5 - down * (1 - to_peak)
            total += math.log(down / up)
        else:
            current += up
    return math.exp(total / periods)


def lines(look):
    for output in (6.3, 6.6, 7.0, 7.5, 8.1, 9.0):
        due = growth_of_line((12 - output) / 4, output / 4)  # A in a period
        done, report = look.run(peak(output), ".pss uic")
        found = report["steady"].get("attractor", {})
        look.checker.check(done.returncode == 0 and found.get("kind") == "chaos", f"{output} V: {report['steady']['verdict']}")
        # a mean over 1024 periods, of which some have a logarithm of 0: a tenth of it, at 6.3 V
        off = abs(math.log(found.get("growth", 1.0)) / math.log(due) - 1)
        look.checker.check(off < 0.15, f"{output} V: grows by {found.get('growth')}, not by {due}")


def differentiated(look):
    """Derivatives of an orbit of two periods by a value are those of differences."""
    measured = ".pss uic\n.meas pss top max v(c)"
    done, report = look.run(forced(0.05, 2.03), measured + "\n.sens r1")
    if not look.checker.check(done.returncode == 0 and "sensitivity" in report, f"sensitivities: {done.stderr}"):
        return
    tops = [look.run(forced(0.05, 2.03).replace("R1 y c 1k", f"R1 y c {ohms!r}"), measured)[1]["measurements"][0]["value"]
            for ohms in (999.9, 1000.1)]
    found = next(entry for entry in report["sensitivity"]["results"] if entry["name"] == "top")
    due = (tops[1] - tops[0]) / 0.2
    value = found["derivatives"]["r1"]
    look.checker.check(abs(value / due - 1) < 1e-4, f"sensitivity: {value}, not {due}")


def stepped(look):
    """Steps of a sweep are not followed: they have orbits alone."""
    netlist = boost(3).replace("Vin in 0 10", ".param v=10\nVin in 0 {v}")
    done, report = look.run(netlist, ".step param v list 10 10.5\n.pss uic")
    look.checker.check(done.returncode == 0 and "attractor" not in report.get("steady", {}), f"steps: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        look = Look(program, pathlib.Path(name))
        for case in dalcs_program.some_of(BESIDE):
            look.beside(*case)
        for case in dalcs_program.some_of(AHEAD):
            look.ahead(*case)
        lines(look)
        differentiated(look)
        stepped(look)
    return look.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
