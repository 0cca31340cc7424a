#!/usr/bin/env python3
"""Thyristors without a holding current, and with one of 1e-7 of their current: the same waveforms.

usage: thyristors_without_holding.py PROGRAM [FIRST-LAST]

The first ones open where their diodes end the current, the others where it has fallen to Ih. Rectifiers, controllers, bridges,
GTOs and resonant pulses that come back through a diode, a resistor or a coil are drawn at random, from 1 V and 1 A to 1 kV.
"""

import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SAME = 1e-5  # of the largest value: the end of a current at 1e-7 of it comes sooner
TIMES = [(k + 0.31) * 3e-4 for k in range(199)]
KINDS = ("half wave", "freewheel", "charger", "controller", "bridge", "three phases", "resonant", "gto")


def drawn(draw, low, high):
    return 10 ** draw.uniform(low, high)


def gate(name, reference, delay, width):
    return f"vg{name} g{name} {reference} pulse(0 1 {delay!r} 0 0 {width!r} 0.02)\n"


def circuit(kind, draw):
    """Its cards, what is looked at, and its current."""
    volts, ohms = drawn(draw, 0, 3), drawn(draw, 0, 2)
    henry = ohms / 314 * drawn(draw, -1.5, 0.7)
    at, width = draw.uniform(0.05, 0.45) * 0.02, draw.uniform(0.02, 0.2) * 0.02
    source = f"v1 a 0 sin(0 {volts!r} 50)\n"
    load = f"l1 b c {henry!r}\nr1 c 0 {ohms!r}\n"
    one, other = gate(1, "b", at, width), gate(2, "a", at + 0.01, width)
    if kind in ("half wave", "freewheel", "gto"):
        model = "gt" if kind == "gto" else "th"
        text = source + f"a1 a b g1 b {model}\n" + ("" if kind == "half wave" else "d1 0 b dd\n") + load + one
    elif kind == "charger":
        text = source + f"l1 a s {henry / 30!r}\na1 s b g1 b th\nc1 b 0 {drawn(draw, 0, 1.5) / 314 / ohms!r}\nr1 b 0 {ohms!r}\n" + one
    elif kind == "controller":
        text = source + "a1 a b g1 b th\na2 b a g2 a th\n" + load + one + other
    elif kind == "bridge":
        text = (f"v1 p q sin(0 {volts!r} 50)\nrg q 0 1\na1 p b g1 b th\na2 q b g2 b th\na3 n p g3 p th\na4 n q g4 q th\n"
                f"l1 b c {henry!r}\nr1 c n {ohms!r}\nrn n 0 1meg\n" + one + gate(2, "b", at + 0.01, width)
                + gate(3, "p", at + 0.01, width) + gate(4, "q", at, width))
    elif kind == "three phases":
        text = ""
        for k in range(3):
            first = (at + 0.02 * k / 3) % 0.02
            text += (f"v{k} s{k} 0 sin(0 {volts!r} 50 0 0 {-120 * k})\na1{k} s{k} b{k} g1{k} b{k} th\na2{k} b{k} s{k} g2{k} s{k} th\n"
                     f"l{k + 1} b{k} c{k} {henry!r}\nr{k} c{k} y {ohms!r}\n"
                     + gate(f"1{k}", f"b{k}", first, width) + gate(f"2{k}", f"s{k}", (first + 0.01) % 0.02, width))
    else:
        w = drawn(draw, 3, 4)
        back = draw.choice(["d1 c b dd\n", f"d1 c e dd\nre e b {ohms * 1e-6!r}\n", f"d1 c e dd\nle e b {ohms / w * 1e-6!r}\n", ""])
        text = (f"v1 a 0 {volts!r}\nl1 a b {ohms / w!r}\na1 b c g1 c th\n{back}c1 c f {1 / w / ohms!r}\nr1 f 0 {ohms / 20!r}\n"
                f"r2 c 0 {ohms * 20!r}\n" + gate(1, "c", at, width))
    return text, volts / ohms


def look_at(checker, program, seed):
    kind = KINDS[seed % len(KINDS)]
    text, ampere = circuit(kind, random.Random(seed))
    waves = []
    for holding in ("", f"ih={ampere * 1e-7!r}"):
        models = f".model th thyristor({holding})\n.model gt gto({holding})\n.model dd D(ron=0)\n.tran 0.1m 60m\n.end\n"
        done = run(program, f"{kind} {seed}\n{text}{models}", at=TIMES, method=None)
        if not checker.check(done.status == 0, f"{kind} {seed} {holding}: {done.stderr}"):
            return
        waves.append(done.column("i(l1)"))
    largest = max(map(abs, waves[1])) or ampere  # none flows where the gate comes too late
    off = max(abs(a - b) for a, b in zip(*waves))
    checker.check(off <= SAME * largest and math.isfinite(off), f"{kind} {seed}: off by {off / largest:.2g} of the largest current")


def main():
    checker = Checker("thyristors_without_holding")
    first, _, last = (sys.argv[2] if len(sys.argv) > 2 else "0-79").partition("-")
    for seed in some_of(range(int(first), int(last or first) + 1), 3):
        look_at(checker, sys.argv[1], seed)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
