#!/usr/bin/env python3
"""Bridges of four thyristors into a coil, a capacitor and a resistor: the mean of the rectified voltage.

usage: single_phase_bridges.py PROGRAM

A thyristor is a diode with a switch, which a formula keeps closed while its current is above the holding current. All
are ideal, so that what opens the bridge takes the current from the coil: an impulse of flux, which the mean counts.
The reference steps the two circuits there are, that of a conducting bridge and that of an open one, by the classical
method of Runge and Kutta, and bisects where the current reaches what holds it.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

PERIOD, PEAK, STOP, FROM, GATE = 20e-3, 325.0, 80e-3, 60e-3, 1e-3
STEP = 10e-6  # (STEP / sqrt(L C))^4 is below 1e-9 at the smallest coil and capacitor below


def netlist(coil, capacitor, load, delay, gain):
    first, second = delay, delay + PERIOD / 2
    pulse = f"0 0 {GATE!r} {PERIOD!r}"
    return "\n".join([
        "four thyristors",
        ".subckt thyristor a k g", "d1 a m", "vs m n 0", "s1 n k u 0 latch",
        f"b1 u 0 v=v(g)+min(1,max(0,{gain!r}*i(vs)))", ".model latch sw(vt=0.5 vh=0.1)", ".ends",
        f"v1 a 0 sin(0 {PEAK!r} {1 / PERIOD!r})",
        f"vg1 g1 0 pulse(0 1 {first!r} {pulse})", f"vg2 g2 0 pulse(0 1 {second!r} {pulse})",
        "x1 a p g1 thyristor", "x2 n 0 g1 thyristor", "x3 0 p g2 thyristor", "x4 n a g2 thyristor",
        f"l2 p q {coil!r}", f"c2 q n {capacitor!r}", f"r1 q n {load!r}",
        f".tran 50u {STOP!r} uic", f".meas tran vd avg v(p,n) from={FROM!r} to={STOP!r}", ".end", ""])


class Bridge:
    """Current of the coil, voltage of the capacitor, and the integral of the rectified voltage from FROM on."""

    def __init__(self, coil, capacitor, load):
        self.coil, self.capacitor, self.load = coil, capacitor, load
        self.i, self.v, self.flux = 0.0, 0.0, 0.0

    def stepped(self, t, h, side):
        """Behind h, with the pair of `side` conducting."""
        def slope(t, i, v):
            return (side * PEAK * math.sin(2 * math.pi * t / PERIOD) - v) / self.coil, (i - v / self.load) / self.capacitor
        i, v = self.i, self.v
        a = slope(t, i, v)
        b = slope(t + h / 2, i + h / 2 * a[0], v + h / 2 * a[1])
        c = slope(t + h / 2, i + h / 2 * b[0], v + h / 2 * b[1])
        d = slope(t + h, i + h * c[0], v + h * c[1])
        return tuple(x + h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]) for k, x in enumerate((i, v)))

    def conduct(self, t, h, side, held):
        """Conducts for h, or until the current is what holds it; returns for how long."""
        low, high = 0.0, h
        if self.stepped(t, h, side)[0] < held:
            while high - low > 1e-15:
                middle = (low + high) / 2
                if self.stepped(t, middle, side)[0] < held:
                    high = middle
                else:
                    low = middle
        self.i, self.v = self.stepped(t, high, side)
        if t >= FROM - STEP / 2:
            phase = [2 * math.pi * x / PERIOD for x in (t, t + high)]
            self.flux += side * PEAK * PERIOD / (2 * math.pi) * (math.cos(phase[0]) - math.cos(phase[1]))
        return high

    def cut(self, t):
        """The bridge opens: the coil's flux is an impulse against the rectified voltage."""
        self.flux -= self.coil * self.i if t >= FROM else 0.0
        self.i = 0.0

    def rest(self, t, h):
        tau = self.load * self.capacitor
        before, self.v = self.v, self.v * math.exp(-h / tau)
        self.flux += tau * (before - self.v) if t >= FROM - STEP / 2 else 0.0


def gate(t, delay):
    """The side whose gates are on just after t, else 0."""
    for side, first in ((1, delay), (-1, delay + PERIOD / 2)):
        if t >= first - 1e-12 and (t - first + 1e-12) % PERIOD < GATE:
            return side
    return 0


def mean(coil, capacitor, load, delay, held):
    bridge, t, side = Bridge(coil, capacitor, load), 0.0, 0
    grid = [n * STEP for n in range(1, round(STOP / STEP) + 1)]
    for end in grid:
        while end - t > 1e-13:
            on = gate(t, delay)
            if side == 0 and on * PEAK * math.sin(2 * math.pi * t / PERIOD) > bridge.v:
                side = on
            if side == 0:
                bridge.rest(t, end - t)
                t = end
            else:
                t += bridge.conduct(t, end - t, side, -math.inf if on == side else held)
                if bridge.i <= held * (1 + 1e-9) and on != side:
                    bridge.cut(t)
                    side = 0
    return bridge.flux / (STOP - FROM)


CASES = [  # coil, capacitor, load, delay, gain of the latch: it holds 0.4 V / gain
    (10e-3, 1e-3, 20.0, 3.33e-3, 100.0),
    (10e-3, 1e-3, 20.0, 3.33e-3, 1.0),
    (2e-3, 100e-6, 50.0, 5e-3, 10.0),
    (50e-3, 20e-6, 300.0, 2.5e-3, 40.0),
    (1e-3, 2e-3, 5.0, 7e-3, 4.0),
    (5e-3, 470e-6, 1000.0, 6e-3, 4000.0),
]


def main():
    checker = Checker("single_phase_bridges")
    for coil, capacitor, load, delay, gain in some_of(CASES):
        what = f"{coil:g} H, {capacitor:g} F, {load:g} ohms, {delay:g} s, held by {0.4 / gain:g} A"
        outcome = run(sys.argv[1], netlist(coil, capacitor, load, delay, gain), method=None)
        if checker.check(outcome.status == 0, f"{what}: {outcome.stderr}"):
            wanted = mean(coil, capacitor, load, delay, 0.4 / gain)
            checker.close(outcome.report["measurements"][0]["value"], wanted, 1e-9 * PEAK, f"{what}: the mean")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
