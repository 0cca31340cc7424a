#!/usr/bin/env python3
"""Rectifiers of an amplifier and two diodes, whose output wakes where the source passes through 0.

usage: precision_rectifiers.py PROGRAM

    in - r1 - m - r2 - y,   u = -A v(m) between rails,   d1 between m and u,   d2 between u and y

A capacitor at y follows u through the diode's Ron, in femtoseconds and less. Where its half-wave begins all voltages are 0,
and the source is known to the rounding of its amplitude, as its time is: no step shortens that. While d2 conducts,
v(y) = -q A v(in) / (A + 1 + q), where q is (r2 | Roff) / r1. Else the capacitor is empty.
"""

import math
import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

MOST_STEPS = 300  # of a period; it were 600 to 720 000


class Rectifier:
    def __init__(self, seed):
        chance = random.Random(seed)
        self.f = 10 ** chance.uniform(1, 5)
        self.volts = chance.choice([0.1, 5.0, 10.0])
        self.gain = 10 ** chance.uniform(3, 4.5)
        self.r1 = chance.choice([1e3, 1e4, 1e5])
        self.r2 = self.r1 * chance.choice([0.5, 1.0, 3.0])
        self.roff = 100 * self.r1 * chance.choice([1, 10])
        self.ron = self.r1 * 10 ** chance.uniform(-7, -6)
        self.farads = chance.choice([5e-4, 1e-3]) / (self.f * self.r1)
        self.sign = chance.choice([1, -1])  # of the half-wave that comes out

    def netlist(self):
        first, second = ("m u", "u y") if self.sign > 0 else ("u m", "y u")
        return (f"a precision rectifier\nv1 in 0 SIN(0 {self.volts} {self.f})\n"
                f"e1 u 0 VALUE={{limit(-{self.gain}*v(m),{-5 * self.volts},{5 * self.volts})}}\n"
                f"r1 in m {self.r1}\nr2 y m {self.r2}\nr3 y 0 {self.r1}\nc1 y 0 {self.farads}\nd1 {first} d\nd2 {second} d\n"
                f".model d D(ron={self.ron} roff={self.roff})\n.tran {0.01 / self.f} {3 / self.f}\n.end\n")

    def output(self, t):
        q = self.r2 * self.roff / (self.r2 + self.roff) / self.r1
        return max(-self.sign * q * self.gain / (self.gain + 1 + q) * self.volts * math.sin(2 * math.pi * self.f * t), 0.0)


def main():
    checker = Checker("precision rectifiers")
    for seed in some_of(range(1, 31)):
        circuit = Rectifier(seed)
        times = [(k + 0.7) / 20 / circuit.f for k in range(60)]
        done = run(sys.argv[1], circuit.netlist(), method=None, at=times)
        if not checker.check(done.status == 0, f"{seed}: {done.stderr}"):
            continue
        off = max(abs(circuit.sign * v - circuit.output(t)) for t, v in zip(times, done.column("v(y)")))
        allowed = circuit.volts * (10 * circuit.ron / circuit.r1 + 3 * circuit.r2 / circuit.roff / circuit.gain + 1e-6)
        checker.check(off <= allowed, f"{seed}: off by {off:.2g} V, allowed are {allowed:.2g} V")
        steps = done.report["work"]["steps"]
        checker.check(steps <= 3 * MOST_STEPS, f"{seed}: {steps} steps")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
