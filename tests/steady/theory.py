#!/usr/bin/env python3
"""What `dalcs check` says of periodic steady states, and what `dalcs steady` finds: neither contradicts the other.

usage: theory.py PROGRAM

Where check says that there is one that attracts all trajectories, all multipliers are smaller than 1, and searches from
unlike starts find the same orbit. Where a multiplier is 1 or larger, or there are several orbits, check does not say so.
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

SIX_PULSES = "".join(f"V{k} n{k} 0 SIN(0 100 50 0 0 {-120 * k})\nR{k} n{k} m{k} 1\nL{k} m{k} a{k} 1m\nRp{k} a{k} 0 1k\n"
                     f"D{k} a{k} p\nD{k + 3} q a{k}\n" for k in range(3)) + "Ld p x 10m\nRd x q 20\nRq q 0 1meg\n"

ONE = {
    "half wave": "V1 a 0 SIN(0 10 50)\nR1 a b 1\nD1 b c\nC1 c 0 1m\nR2 c 0 100\n",
    "slow full bridge": "V1 a w SIN(0 17 50)\nRw w b 10\nD1 a out\nD2 b out\nD3 0 a\nD4 0 b\nC1 out 0 100m\nR1 out 0 500\n"
                        "Rb b 0 1meg\n",
    "clipper behind a coil": "V1 a 0 SIN(0 5 1k)\nR1 a b 10\nL1 b c 10m\nR2 c 0 50\nD1 c d\nV2 d 0 1\n",
    "clamp with a drop": "V1 a 0 SIN(0 20 50)\nR1 a b 100\nC1 b 0 10u\nD1 b c dz\nR2 c 0 1\n.model dz D(Vfwd=0.7 Ron=1)\n"
                         "R3 b 0 1k\n",
    "freewheeling coil": "V1 a 0 PULSE(0 10 0 0 0 4u 10u)\nD1 a b\nD2 0 b\nL1 b c 100u\nR1 c 0 2\n",
    "six pulses": SIX_PULSES,
    "filter of second order": "V1 a 0 SIN(0 10 1k)\nR1 a b 1\nL1 b c 1m\nR2 c d 0.1\nC1 d 0 10u\nR3 d 0 100\nD1 d e\nR4 e 0 10\n",
    "doubler": "V1 a 0 SIN(0 10 1k)\nR1 a b 1\nC1 b c 10u\nR2 b c 10k\nD1 0 c\nD2 c d\nC2 d 0 10u\nR3 d 0 1k\n",
    "two sides": "V1 a 0 SIN(0 3 100)\nR1 a b 1k\nC1 b 0 1u\nD1 b c\nR2 c 0 100\nD2 0 b\n",
    "charger": "V1 a 0 SIN(0 20 50)\nR1 a b 5\nD1 b c\nR2 c d 0.1\nC1 d 0 1m\nR3 d 0 50\n",
    "tank of a quality of 10000": "I1 0 b SIN(0 1m 1k)\nL1 b c 1m\nR1 c 0 3m\nC1 b 0 1u\n",
}

# and what steady says of it
OTHERS = {
    "negative resistance": ("V1 s 0 PULSE(-1 1 0 0 0 5u 10u)\nR1 s a 10\nL1 a b 100u\nC1 b 0 1u\nR2 b 0 -9\n", "unstable"),
    "floating charge": ("V1 a 0 SIN(0 1 1k)\nC1 a b 1u\nC2 b 0 1u\n", "not unique"),
    "nothing empties it": ("V1 a 0 SIN(0 10 50)\nR1 a b 1\nD1 b c\nC1 c 0 1m\n", "not unique"),
    "a coil across a source": ("V1 a 0 SIN(0 1 1k)\nL1 a 0 1m\n", "not unique"),
    "tank without losses": ("I1 0 b SIN(0 1m 1k)\nL1 b 0 1m\nC1 b 0 1u\n", "at the border"),
    "filter without losses": ("V1 a 0 SIN(0 1 1k)\nL1 a b 1m\nC1 b 0 1u\nL2 b c 2m\nC2 c 0 3u\n", "at the border"),
    "a comparator that feeds back": ("V1 a 0 SIN(0 1 1k)\nE1 d 0 c 0 3\nR1 d b 1k\nD1 b p\nV2 p 0 10\nD2 n b\nV3 n 0 -10\n"
                                     "R2 b c 1k\nR3 a c 100k\nC1 c 0 10n\n", "stable"),
    "peak current at 0.7": ("Vin in 0 12\nVclk clk 0 PULSE(0 1 0 0 0 0.1u 10u)\nBl u 0 V=2*v(clk)-3*u(i(L1)-5)\n"
                            "S1 in sw u 0 latch\n.model latch SW(Vt=0 Vh=1)\nD1 0 sw\nL1 sw out 40u\nC1 out 0 1m\nR1 out 0 2\n",
                            "unstable"),
}


class Look:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.checker = dalcs_program.Checker("theory")

    def ask(self, verb, netlist, *options):
        (self.folder / "c.cir").write_text(f"* a circuit\n{netlist}.pss uic\n.end\n")
        return subprocess.run([self.program, verb, "c.cir", *options], cwd=self.folder, capture_output=True, text=True,
                              check=False)

    def says_one(self, netlist):
        """Of each part of the circuit that has states."""
        answers = re.findall(r"(?m)^ *periodic +(\S+)", self.ask("check", netlist).stdout)
        return bool(answers) and all(answer == "yes" for answer in answers)

    def steady(self, name, netlist):
        done = self.ask("steady", netlist, "-o", "none", "-q", "--report", "c.json")
        self.checker.check(done.returncode == 0, f"{name}: {done.stderr}")
        return json.loads((self.folder / "c.json").read_text())["steady"]

    def one(self, name, netlist):
        self.checker.check(self.says_one(netlist), f"{name}: check does not say that there is one")
        found = []
        for start in ("", " IC=-3", " IC=40"):
            begun = re.sub(r"(?m)^([CL]\d* .*)$", r"\1" + start, netlist)
            steady = self.steady(name, begun)
            largest = max([math.hypot(m["re"], m["im"]) for m in steady["multipliers"]], default=0.0)
            self.checker.check(steady["stable"] and largest < 1, f"{name}: {steady['verdict']}, {largest}")
            found.append(steady["states"])
        for other in found[1:]:
            off = max(abs(other[x] - found[0][x]) for x in other) / max(map(abs, found[0].values()))
            self.checker.check(off < 1e-8, f"{name}: two starts lead to orbits {off:.2g} apart")

    def other(self, name, netlist, verdict):
        self.checker.check(not self.says_one(netlist), f"{name}: check says that there is one")
        found = self.steady(name, netlist)
        self.checker.check(found["verdict"].startswith(verdict), f"{name}: {found['verdict']}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        look = Look(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(folder))
        for name, netlist in ONE.items():
            look.one(name, netlist)
        for name, (netlist, verdict) in OTHERS.items():
            look.other(name, netlist, verdict)
    return look.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
