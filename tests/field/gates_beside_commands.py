#!/usr/bin/env python3
"""Legs of which one switch is on a signal itself and the other on a gate of it: both act at one instant.

usage: gates_beside_commands.py PROGRAM

Between the two a source would be shorted, or a coil cut off. Each circuit is compared with the same one whose second
signal is a formula, 1 - v(clk), instead of gates. Edges are steps, also at t = 0, ramps and curves behind an RC; there
are chains of gates, a flip-flop, both methods and a steady state.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

NEAR = 1e-9
POINTS = 40

CLOCKS = {
    "a step at 0": "va clk 0 pulse(0 1 0 0 0 {on!r} {period!r})",
    "a step later": "va clk 0 pulse(0 1 {late!r} 0 0 {on!r} {period!r})",
    "a ramp": "va clk 0 pulse(0 1 {late!r} {late!r} {late!r} {on!r} {period!r})",
    "a sine": "va clk 0 sin(0.4 1 {hertz!r})",
    "an RC": "va s 0 pulse(0 1 {late!r} 0 0 {on!r} {period!r})\nra s clk 1k\nca clk 0 {farads!r}",
}
GATES = {
    "an inverter": "a2 clk 0 0 0 0 q 0 0 INV",
    "three inverters": "a2 clk 0 0 0 0 g1 0 0 INV\na3 g1 0 0 0 0 g2 0 0 INV\na4 g2 0 0 0 0 q 0 0 INV",
    "a latch": "a3 clk 0 0 0 0 g1 g2 0 BUF\na2 g1 g2 0 0 0 0 q 0 SRFLOP",
    "an output with a resistance": "a2 clk 0 0 0 0 q 0 0 INV rout=10",
}
FORMULA = "bq q 0 V=v(clk) > 0.5 ? 0 : 1"


def buck(volts, ohms, period):
    return (f"vin in 0 {volts!r}\ns1 in sw clk 0 sm\ns2 sw 0 q 0 sm\nl1 sw out {ohms * period * 3!r} ic={volts / ohms!r}\n"
            f"c1 out 0 {5 * period / ohms!r}\nr1 out 0 {ohms!r}\n", "i(l1)", "v(out)")


def boost(volts, ohms, period):
    return (f"vin in 0 {volts!r}\nl1 in sw {ohms * period * 3!r}\ns1 sw 0 clk 0 sm\ns2 sw out q 0 sm\n"
            f"c1 out 0 {20 * period / ohms!r} ic={volts!r}\nr1 out 0 {ohms!r}\n", "i(l1)", "v(out)")


def bridge(volts, ohms, period):
    return (f"vin in 0 {volts!r}\ns1 in a clk 0 sm\ns2 a 0 q 0 sm\ns3 in b q 0 sm\ns4 b 0 clk 0 sm\n"
            f"l1 a m {ohms * period!r} ic={-volts / ohms!r}\nr1 m b {ohms!r}\n", "i(l1)", "v(a,b)")


def current_fed(volts, ohms, period):
    """Its dual: a current source that must have a way, and a capacitor that must not be shorted."""
    return (f"iin 0 in {volts / ohms!r}\ns1 in 0 q 0 sm\ns2 in a clk 0 sm\n"
            f"c1 a 0 {period / ohms!r} ic={volts!r}\nr1 a 0 {ohms!r}\n", "i(s2)", "v(a)")


CIRCUITS = (buck, boost, bridge, current_fed)
SIZES = ((12.0, 3.0, 1e-5), (600.0, 40.0, 2e-4), (1.5, 1e3, 1e-6))


def netlist(name, circuit, clock, gates, size):
    volts, ohms, period = size
    cards, *signals = circuit(*size)
    clock = CLOCKS[clock].format(on=0.37 * period, late=0.11 * period, period=period, hertz=1 / period,
                                 farads=0.05e-3 * period)
    return f"{name}\n{cards}{clock}\n{gates}\n.model sm sw(vt=0.5)\n", signals


class Legs(Checker):
    def look_at(self, circuit, clock, gates, size, method=None):
        name = f"{circuit.__name__}, {clock}, {gates}, {size[0]:g} V"
        stop = 8.13 * size[2]
        times = [stop * (k + 0.37) / POINTS for k in range(POINTS)]
        values = []
        for cards in (GATES[gates], FORMULA):
            text, signals = netlist(name, circuit, clock, cards, size)
            done = run(sys.argv[1], f"{text}.tran {stop / 10!r} {stop!r} uic\n.end\n", at=times if method is None else None,
                       method=method, step=size[2] / 200 if method else None)
            if not self.check(done.status == 0 and "interrupts" not in done.stderr, f"{name}: {done.stderr}"):
                return
            values.append([done.column(s) for s in signals])
        for signal, found, wanted in zip(signals, *values):
            size_of = max(map(abs, wanted))
            off = max(abs(f - w) for f, w in zip(found, wanted)) / size_of
            self.check(len(found) == len(wanted) and off <= NEAR, f"{name}: {signal} is off by {off:.2g}")

    def steady(self, size):
        ends = []
        for cards in (GATES["an inverter"], FORMULA):
            text, (_, signal) = netlist("steady", buck, "a step at 0", cards, size)
            done = run(sys.argv[1], f"{text}.pss period={size[2]!r}\n.end\n", method=None)
            if not self.check(done.status == 0, f"steady, {size[0]:g} V: {done.stderr}"):
                return
            ends.append(done.column(signal)[-1])
        self.check(abs(ends[0] - ends[1]) <= NEAR * size[0], f"steady, {size[0]:g} V: {ends}")


def main():
    legs = Legs("gates_beside_commands")
    cases = [(c, clock, gates, size) for c in CIRCUITS for clock in CLOCKS for gates in GATES for size in SIZES]
    for case in some_of(cases[::3]):
        legs.look_at(*case)
    for circuit in (buck, boost, bridge):
        legs.look_at(circuit, "a step later", "an inverter", SIZES[0], "euler")
    for size in SIZES:
        legs.steady(size)
    return legs.finish()


if __name__ == "__main__":
    sys.exit(main())
