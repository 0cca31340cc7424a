#!/usr/bin/env python3
"""Resistances that a formula takes smoothly through many decades, as models of switches do.

usage: smooth_switches.py PROGRAM

A resistance R(v) by a gate is a product with its current, a conductance is a product with its voltage, and both are the
same element. They are compared with each other at the rows, and once the gate rests with a resistor of that value. Steps
are counted: what was rounded by the largest resistance took attoseconds, and implicit Euler in the place of accurate
steps.

A circuit without a solution has none where functions only read it."""

import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# the logarithm of the resistance as a function of the gate's voltage: at 0 V and at 1 V
LAWS = {
    "a power of ten": "pwr(10,{a}+({b})*v(g))",
    "an exponential": "exp(({a}+({b})*v(g))*2.302585092994046)",
    "an exponential of a square": "exp(({a}+({b})*v(g)*v(g))*2.302585092994046)",
}
DECADES = {"3 to -3": (3, -3), "6 to -3": (6, -3), "9 to -3": (9, -3), "5 to 0": (5, 0), "-1 to -4": (-1, -4)}
CIRCUITS = {
    "RC at 10 V": (10.0, "rl o 0 10\ncl o 0 1u", 10.0, 1e-6),
    "RC at 1 kV": (1e3, "rl o 0 100\ncl o 0 0.2u", 100.0, 0.2e-6),
    "RC at 10 mV": (1e-2, "rl o 0 50\ncl o 0 0.5u", 50.0, 0.5e-6),
}
GATE = "vg g 0 pulse(0 1 1u {edge} {edge} 4u 10u)"
EDGES = ["1n", "100n"]

# In the first a negative conductance of 1/80k asks for 77 V where the diode conducts, and for a current against it where it
# is at 0.7 V; the second loses one volt in two at each turn of a loop whose diode conducts backwards; the third is cut.
UNSOLVABLE = {
    "a negative conductance beside a diode": "v1 n1 0 -3\nr3 a n1 80k\nix n1 a 1m\nfx a n1 v1 2\nda a b dm\nl1 b 0 1m\n"
                                             ".model dm D(ron=0.1 vfwd=0.7 roff=1meg)",
    "a loop of current": "v1 n1 0 100\nr1 n1 b 1m\nr5 b a 10\nfx 0 a v1 2\nd6 c a\nr3 c b 0.04\nr7 a m 7\nv7 m 0 0.3",
    "a source into diodes that block": "i1 0 a 1m\nd1 0 a\nr2 b 0 1k\nv2 b 0 2",
}
READERS = ["v(a)*v(b)", "tanh(v(a)/10)", "sqrt(abs(v(b))+1)", "v(a)**2", "exp(v(b)/100)", "atan(v(a))*v(b)",
           "v(b)/(1+v(a)**2)", "ln(2+abs(v(a)))"]


def check_unsolvable(checker):
    for (what, circuit), scale in itertools.product(UNSOLVABLE.items(), (1e-3, 1.0, 1e3)):
        for one, two in some_of(list(itertools.combinations(READERS, 2)), 4):
            readers = "\n".join(f"b{k} o{k} 0 v={{{scale}*({f})}}\nr{k}o o{k} 0 1k" for k, f in enumerate((one, two)))
            outcome = run(sys.argv[1], f"{what}\n{circuit}\n{readers}\n.op\n.end\n", method=None, options=("--audit", "off"))
            checker.check(outcome.status == 1 and "no solution" in outcome.stderr,
                          f"{what}, {scale} {one}, {two}: {outcome.status} {outcome.stderr}")


def outcome_of(volts, load, part, edge):
    text = "\n".join(["switches", f"v1 a 0 {volts!r}", GATE.format(edge=edge), part, load, ".tran 50n 9u", ".end", ""])
    return run(sys.argv[1], text, method=None)


def main():
    checker = Checker("smooth_switches")
    check_unsolvable(checker)
    cases = itertools.product(LAWS.items(), DECADES.items(), CIRCUITS.items(), EDGES)
    for (law, formula), (decades, (high, low)), (circuit, (volts, load, ohms, farads)), edge in some_of(cases):
        what = f"{law}, {decades}, {circuit}, {edge}"
        resistance = formula.format(a=high, b=low - high)
        conductance = formula.format(a=-high, b=high - low)
        by_r = outcome_of(volts, load, f"r1 a o r={{{resistance}}}", edge)
        by_g = outcome_of(volts, load, f"b1 a o i={{v(a,o)*{conductance}}}", edge)
        if not checker.check(by_r.status == 0 and by_g.status == 0, f"{what}: {by_r.stderr}{by_g.stderr}"):
            continue
        work = by_r.report["work"]
        checker.check(work["euler_steps"] == 0 and work["steps"] < 1500, f"{what}: {work}")
        for t in (0.5e-6, 1.5e-6, 4.9e-6, 5.05e-6, 6e-6, 9e-6):
            checker.close(by_r.at("v(o)", t), by_g.at("v(o)", t), 1e-8 * volts, f"{what}: v(o) at {t}")
        # from the middle of a state of rest to its end: one resistor, one time constant
        for first, last, r in ((2e-6, 4.9e-6, 10.0 ** low), (6e-6, 9e-6, 10.0 ** high)):
            rest = volts * ohms / (ohms + r)
            tau = farads * ohms * r / (ohms + r)
            wanted = rest + (by_r.at("v(o)", first) - rest) * math.exp(-(last - first) / tau)
            checker.close(by_r.at("v(o)", last), wanted, 1e-8 * volts, f"{what}: v(o) from {first} to {last}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
