#!/usr/bin/env python3
"""Diodes behind kicks of up to 3e10 V, with 3, 5 and 7 stages.

usage: kicked_stages.py PROGRAM

Where a switch interrupts a coil, a diode's voltage is a difference of what the coil's current makes of megohms. What a step
says of it at its start goes with the states as the stages have them there, and few stages are off by more than many. So
each circuit must pass its audit, and give what nine stages give at a tolerance of 1e-10.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

NEAR = 1e-7
PERIODS = 17.3
POINTS = 40
STAGES = (3, 5, 7)


def pulse(k, period):
    """Clocks without a common period."""
    own = period * (1.0 + 0.271 * k)
    return f"pulse(0 1 {0.07 * own * (k + 1)!r} {0.01 * own!r} {0.02 * own!r} {0.4 * own!r} {own!r})"


def head(volts, ohms, kick):
    return (f".model sm sw(ron={1e-3 * ohms!r} roff={kick / volts * ohms!r} vt=0.5)\n"
            f".model dm d(ron={1e-3 * ohms!r})\nvin in 0 {volts!r}\n")


def half_bridges(volts, ohms, period, kick):
    cards = head(volts, ohms, kick)
    for k in range(2):
        cards += (f"sh{k} in m{k} g{k} 0 sm\nd{k} 0 m{k} dm\nr{k} m{k} a{k} {ohms!r}\nsl{k} a{k} x{k} h{k} 0 sm\n"
                  f"l{k} x{k} com {2.0 * ohms * period!r}\nvg{k} g{k} 0 {pulse(2 * k, period)}\n"
                  f"vh{k} h{k} 0 {pulse(2 * k + 1, period)}\n")
    return cards + f"rc com 0 {ohms!r}\n", ["v(com)", "i(l0)", "i(l1)"]


def star(volts, ohms, period, kick):
    """Three coils meet at a resistor."""
    cards = head(volts, ohms, kick)
    for k in range(3):
        cards += (f"s{k} in m{k} g{k} 0 sm\nd{k} 0 m{k} dm\nl{k} m{k} x{k} {(2.0 + k) * ohms * period!r}\n"
                  f"sb{k} x{k} y{k} h{k} 0 sm\nrb{k} y{k} com {0.1 * ohms!r}\nvg{k} g{k} 0 {pulse(k, period)}\n"
                  f"vh{k} h{k} 0 {pulse(k + 3, period)}\n")
    return cards + f"rc com 0 {ohms!r}\n", ["v(com)", "i(l0)", "i(l2)"]


def interrupted_buck(volts, ohms, period, kick):
    """With a capacitor, and a switch between it and the coil."""
    return (head(volts, ohms, kick) +
            f"s1 in a g1 0 sm\nd1 0 a dm\nl1 a b {2.0 * ohms * period!r}\ns2 b c g2 0 sm\nr1 c 0 {ohms!r}\n"
            f"c1 c 0 {3.0 * period / ohms!r}\nv1 g1 0 {pulse(0, period)}\nv2 g2 0 {pulse(1, period)}\n",
            ["v(c)", "i(l1)"])


CIRCUITS = (half_bridges, star, interrupted_buck)
SIZES = ((100.0, 1.0, 1e-5, 1e8), (600.0, 47.0, 1e-3, 3e10), (3.3, 1e3, 1e-7, 1e7), (48.0, 3.0, 1e-4, 1e9))
# What a step of three stages is off by itself at a tolerance of 1e-6 is more than what is looked for.
SKIPPED = ((interrupted_buck, 3),)


class Stages(Checker):
    def look_at(self, circuit, size):
        cards, signals = circuit(*size)
        name = f"{circuit.__name__}, {size[0]:g} V, kick of {size[3]:g} V"
        stop = PERIODS * size[2]
        text = f"{name}\n{cards}.tran {stop / 10!r} {stop!r} uic\n.end\n"
        times = [stop * (k + 0.37) / POINTS for k in range(POINTS)]
        wanted = run(sys.argv[1], text, at=times, method=None, tolerance=1e-10, stages=9)
        if not self.check(wanted.status == 0, f"{name}: {wanted.stderr}"):
            return
        for stages in STAGES:
            if (circuit, stages) in SKIPPED:
                continue
            done = run(sys.argv[1], text, at=times, method=None, stages=stages, options=("--audit", "full"))
            if self.check(done.status == 0, f"{name}, {stages} stages: {done.stderr}"):
                for signal in signals:
                    self.compare(f"{name}, {stages} stages", signal, done, wanted)

    def compare(self, name, signal, done, wanted):
        found, right = done.column(signal), wanted.column(signal)
        off = max(abs(f - w) for f, w in zip(found, right)) / max(map(abs, right))
        self.check(len(found) == len(right) and off <= NEAR, f"{name}: {signal} is off by {off:.2g}")


def main():
    stages = Stages("kicked_stages")
    for case in some_of([(c, size) for c in CIRCUITS for size in SIZES]):
        stages.look_at(*case)
    return stages.finish()


if __name__ == "__main__":
    sys.exit(main())
