#!/usr/bin/env python3
"""What .ac around an orbit refuses, and why; .ac of switches that follow a clock, without an orbit.

usage: refusals.py PROGRAM
"""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

BUCK = """A buck converter
Vin in 0 12
Vctl ctl 0 DC 0.4%s
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 50u
C1 out 0 20u
R1 out 0 2
.model sm SW(Ron=0 Vt=0)
"""
AC = ".ac dec 5 10 40k\n"
PEAK = """Peak current without slope compensation at D = 0.6
Vin in 0 10
S1 in sw cmp 0 latch
D1 0 sw
L1 sw a 20u
Vs a out 0
C1 out 0 200u
R1 out 0 1
Hs x1 0 Vs -0.1
Vc x2 x1 DC 0.66 AC 1
Vclk cmp x2 PULSE(0 10 0 0 0 50n 10u)
.model latch SW(Ron=0 Vt=2.5 Vh=2.5)
"""


class Case:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.checker = dalcs_program.Checker("refusals")

    def run(self, netlist, verb, options):
        (self.folder / "c.cir").write_text(netlist)
        (self.folder / "c.csv").unlink(missing_ok=True)
        return subprocess.run([self.program, verb, "c.cir", "-o", "c.csv", *options], cwd=self.folder,
                              capture_output=True, text=True, check=False)

    def refuses(self, netlist, status, *words, verb="run", options=()):
        done = self.run(netlist, verb, options)
        self.checker.check(done.returncode == status, f"{netlist}: status {done.returncode}, {done.stderr}")
        self.checker.check(not (self.folder / "c.csv").exists(), f"{netlist}: it has rows")
        for word in words:
            self.checker.check(word in done.stderr, f"{netlist}: nothing of {word!r} in {done.stderr!r}")

    def takes(self, netlist, *words, verb="run", options=()):
        done = self.run(netlist, verb, options)
        said = done.stderr + done.stdout
        self.checker.check(done.returncode == 0, f"{netlist}: {said}")
        for word in words:
            self.checker.check(word in said, f"{netlist}: nothing of {word!r} in {said!r}")


def commanded(case):
    """.ac of switches that follow a clock: never zeros without a word."""
    words = ("'s1' switches with 'vtri' in time", "add .pss", "'dalcs bode'")
    case.refuses(BUCK % " AC 1" + AC, 3, *words)
    case.refuses(BUCK % " AC 1" + AC + ".tran 1u 1m uic\n", 3, *words)
    case.refuses(PEAK + AC, 3, "'s1' switches with 'vclk' in time")
    # through a filter the control is no sum of sources
    through = (BUCK % " AC 1").replace("S1 in sw cmp 0", "Rf cmp g 1k\nCf g 0 1p\nS1 in sw g 0")
    case.refuses(through + AC, 3, "'s1' switches with 'vtri' in time")
    case.takes(through + AC + ".pss uic\n", "stable")
    sine = (BUCK % " AC 1").replace("PULSE(0 1 0 10u 0 0 10u)", "SIN(0.5 0.5 100k)")
    case.refuses(sine + AC, 3, "'s1' switches with 'vtri' in time")
    # what does not repeat has an operating point, and so has what switches by hand
    once = (BUCK % " AC 1").replace("PULSE(0 1 0 10u 0 0 10u)", "PULSE(0 1 1m)")
    case.takes(once + AC)
    case.takes("A filter behind a switch\nV1 a 0 SIN(0 1 1k) AC 1\nVg g 0 1\nS1 a b g 0 sm\nR1 b c 1k\nC1 c 0 1n\n"
               ".model sm SW(Vt=0.5)\n" + AC)


def refused(case):
    case.refuses(BUCK % "" + AC + ".pss uic\n", 3, ".ac without a source")
    case.refuses(BUCK % "", 2, "no source has an AC value", "AC 1", verb="bode")
    case.refuses(BUCK % "", 2, "there is no voltage source 'vx'", verb="bode", options=["--loop", "vx"])
    case.refuses(BUCK % "", 2, "there is no voltage source 'r1'", verb="bode", options=["--loop", "r1"])
    case.refuses(BUCK % "", 2, "'Vin' ends at ground", verb="bode", options=["--loop", "Vin"])
    case.refuses(BUCK % " AC 1", 2, "there are no frequencies", verb="bode",
                 options=["--from", "10k", "--to", "1k"])
    case.refuses(BUCK % " AC 1" + ".ac dec 5 10 1k sideband=0.5\n.pss\n", 3, "a sideband is a whole number")
    case.refuses(BUCK % " AC 1", 2, "--sideband", verb="bode", options=["--sideband", "0.5"])
    case.refuses(BUCK % " AC 1" + ".tran 1u 1m uic\n", 2, "--loop is an option of 'dalcs bode'", options=["--loop", "vin"])
    case.refuses(BUCK % " AC 1" + "V9 x 0 SIN(0 1 31415.9265)\nR9 x 0 1\n", 2, "no common period", verb="bode")
    case.refuses("No clock\nV1 a 0 1 AC 1\nR1 a b 1\nC1 b 0 1u\n", 1, "comes to rest", verb="bode")
    case.refuses("Filled\nV1 i 0 PULSE(0 10 0 0 0 4u 10u) AC 1\nR1 i a 10\nC1 a m 1u\nC2 m 0 2u\nI1 0 m 1m\n"
                 ".pss uic\n", 1, "there is no periodic steady state", verb="bode")


def held(case):
    """Sources hold what capacitors store and coils carry: what is left of small signals in them is rounding, at every
    length of the pieces. Other pieces of the program would take minutes for each."""
    for k in range(10):
        volts, store, ohms = 10.0 ** (k - 4), 10.0 ** -(2 + (7 * k) % 11), 10.0 ** ((3 * k) % 8 - 2)
        period = 10.0 ** -((5 * k) % 7 + 1)
        cell = (f"V1 a 0 SIN({volts} {volts / 7} {3 / period!r})\nC1 a 0 {store!r}\nIac 0 a AC 1\n" if k % 2 else
                f"I1 0 a SIN({volts} {volts / 7} {3 / period!r})\nL1 a 0 {store!r}\nI2 0 a AC 1\n")
        load = f"D1 a b\nR1 b 0 {ohms!r}\n" + (f"C2 b 0 {period / ohms!r}\n" if k % 3 else "")
        clock = f"Vg g 0 PULSE(0 1 0 0 0 {0.3 * period!r} {period!r})\nS1 b x g 0 sm\nRx x 0 {ohms!r}\n"
        case.takes(f"Held {k}\n{cell}{load}{clock}.model sm SW(Vt=0.5)\n.pss uic\n"
                   f".ac dec 2 {1e-3 / period!r} {10 / period!r}\n", options=["-q"])


def said(case):
    """The answer around an unstable orbit is one, with a warning."""
    case.takes(PEAK + AC + ".pss uic\n", "the orbit is unstable", "no analyser would show", "two periods")
    case.takes(BUCK % " AC 1", "response  around the orbit of 100 kHz", verb="bode")
    case.takes(BUCK % " AC 1", "sideband -2", verb="bode", options=["--sideband", "-2"])


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        case = Case(program, folder)
        for look in (commanded, refused, held, said):
            look(case)
        return case.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
