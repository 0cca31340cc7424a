#!/usr/bin/env python3
"""Coils with a current at the start that only open switches of up to 1e15 ohm lead on, beside short cables, with uic.

usage: cut_off_at_start.py PROGRAM

The current dies away within L / R, in down to 1e-19 s, and each voltage begins as what R makes of it. Nothing jumps there:
that a step is longer than this is no reason for a state to begin elsewhere.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

NEAR = 1e-6
KICK = 1e12


def pulse(begin, period):
    return f"pulse(0 1 {begin * period!r} {0.01 * period!r} {0.01 * period!r} {0.4 * period!r} {period!r})"


def alone(volts, ohms, period):
    """(cards, where a cable is)"""
    return (f"vin in 0 {volts!r}\ns1 in sw g sw sm\nvg g sw {pulse(0.3, period)}\nl1 sw out {2.0 * ohms * period!r} ic={{i}}\n"
            f"r1 out 0 {ohms!r}\n", "in")


def with_diode(volts, ohms, period):
    return (f"vin in 0 {volts!r}\ns1 in sw g 0 sm\nvg g 0 {pulse(0.3, period)}\nl1 sw out {2.0 * ohms * period!r} ic={{i}}\n"
            f"r1 out 0 {ohms!r}\nd1 x sw dm\nr2 x 0 {ohms!r}\n", "x")


def between_switches(volts, ohms, period):
    return (f"vin in 0 {volts!r}\ns1 in x g x sm\nvg g x {pulse(0.3, period)}\nl1 x out {2.0 * ohms * period!r} ic={{i}}\n"
            f"r1 out sw {ohms!r}\ns2 sw 0 q 0 sm\nvq q 0 {pulse(0.5, period)}\nrs sw 0 {ohms!r}\n", "sw")


CIRCUITS = (alone, with_diode, between_switches)
SIZES = ((1.0, 47.0, 1e-7), (1.0, 1.0, 1e-5), (24.0, 0.1, 1e-3), (1.0, 1e3, 1e-5))
CABLES = ((10, 1e5, 1e-12), (5, 1e3, 1e-9))


class Cut(Checker):
    def look_at(self, circuit, size, cable):
        volts, ohms, period = size
        sections, along, farad = cable
        name = f"{circuit.__name__}, {volts:g} V, {ohms:g} ohm, {sections} sections"
        cards, where = circuit(*size)
        amperes = -volts / ohms if circuit is with_diode else volts / ohms
        for k in range(sections):
            cards += f"rw{k} {where if k == 0 else f'w{k - 1}'} w{k} {along!r}\ncw{k} w{k} 0 {farad!r}\n"
        roff = KICK / volts * ohms
        text = (f"{name}\n.model sm sw(ron={1e-3 * ohms!r} roff={roff!r} vt=0.5)\n.model dm d(ron={1e-3 * ohms!r})\n"
                f"{cards.format(i=repr(amperes))}.tran {0.06 * period!r} {3.0 * period!r} uic\n.end\n")
        done = run(sys.argv[1], text, at=[0.0, 0.1 * period], method=None, options=("--audit", "full"))
        if self.check(done.status == 0, f"{name}: {done.stderr}"):
            at_start = done.column("i(l1)")[0]
            self.check(abs(at_start - amperes) <= NEAR * abs(amperes),
                       f"{name}: i(l1) begins at {at_start:.9g} A, not at {amperes:.9g} A")


def main():
    cut = Cut("cut_off_at_start")
    for case in some_of([(c, size, cable) for c in CIRCUITS for size in SIZES for cable in CABLES]):
        cut.look_at(*case)
    return cut.finish()


if __name__ == "__main__":
    sys.exit(main())
