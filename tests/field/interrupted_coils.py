#!/usr/bin/env python3
"""A switch opens, its coil's current goes to a diode, and that takes the switch's control a little above its threshold.

usage: interrupted_coils.py PROGRAM

A share of the voltage across a series resistance of the diode reaches the comparator, as by the amplifier of a control. For
a moment the switch contradicts its own control, and then the ramp has gone on. The current of the coil has to go on through
the diode: it is a straight line, and behind the switch an exponential.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

OFF = 0.6  # of the period, where the ramp has come to the threshold
SIZES = ((1e-6, 5.0, 1.0), (1e-5, 400.0, 20.0), (1e-4, 48.0, 0.01), (1e-2, 600.0, 300.0))  # s, V, A


# Each: cards, voltage of the coil while the switch conducts and from then on without resistance, what the comparator reads.
def boost(volts, henry, ampere, ohm):
    return ([f"l1 in sw {henry!r} ic={ampere!r}", "s1 sw 0 c 0 sz", "d1 sw out", f"re out x {ohm!r}", f"vo x 0 {3 * volts!r}"],
            volts, -2 * volts, f"v(out)-{3 * volts!r}")


def buck(volts, henry, ampere, ohm):
    return (["s1 in sw c 0 sz", f"rd 0 d {ohm!r}", "d1 d sw", f"l1 sw out {henry!r} ic={ampere!r}", f"vo out 0 {0.4 * volts!r}"],
            0.6 * volts, -0.4 * volts, "-v(d)")


def buck_boost(volts, henry, ampere, ohm):
    return (["s1 in sw c 0 sz", f"l1 sw 0 {henry!r} ic={ampere!r}", "d1 out sw", f"re x out {ohm!r}", f"vo 0 x {volts!r}"],
            volts, -volts, f"-v(out)-{volts!r}")


def flyback(volts, henry, ampere, ohm):
    return ([f"l1 in sw {henry!r} ic={ampere!r}", "s1 sw 0 c 0 sz", f"l2 0 s {henry!r}", "k1 l1 l2 1", "d1 s out",
             f"re out x {ohm!r}", f"vo x 0 {volts!r}"], volts, -volts, f"v(out)-{volts!r}")


def relay(volts, henry, ampere, ohm):
    return ([f"l1 in sw {henry!r} ic={ampere!r}", "s1 sw 0 c 0 sz", "d1 sw k", f"rk k in {ohm!r}"], volts, 0.0, f"v(k)-{volts!r}")


class Interrupted(Checker):
    def one(self, circuit, share, period, volts, ampere, part):
        henry, ohm = period * volts / (0.1 * ampere), part * volts / ampere
        cards, before, behind, reads = circuit(volts, henry, ampere, ohm)
        name = f"{circuit.__name__}, {share}, {volts} V, {part}"
        coils = "i(l1)+i(l2)" if circuit is flyback else "i(l1)"
        text = "\n".join([name, f"vin in 0 {volts!r}", f"vtri tri 0 pulse(0 1 0 {period!r} 0 0 {period!r})",
                          f"b1 c 0 v={OFF}-v(tri)+{share}*({reads})/{volts!r}", *cards, ".model sz sw(ron=0 vt=0)",
                          f".tran {period / 50!r} {period!r} uic", f".meas tran end find '{coils}' at={0.999 * period!r}", ".end", ""])
        outcome = run(sys.argv[1], text, method=None, options=("--audit", "full"))
        if not self.check(outcome.status == 0, f"{name}: {outcome.stderr}"):
            return
        rest = behind / ohm
        peak = ampere + before / henry * OFF * period
        wanted = rest + (peak - rest) * math.exp(-ohm / henry * (0.999 - OFF) * period)
        got = outcome.report["measurements"][0].get("value")
        self.check(got is not None and abs(got - wanted) <= (1e-6 + share) * ampere, f"{name}: {got} A, not {wanted} A")



def main():
    c = Interrupted("interrupted coils")
    for circuit in boost, buck, buck_boost, flyback, relay:
        for share in 1e-7, 1e-5, 1e-3:
            for period, volts, ampere in SIZES:
                for part in 1e-3, 0.05:
                    c.one(circuit, share, period, volts, ampere, part)
    return c.finish()


if __name__ == "__main__":
    sys.exit(main())
