#!/usr/bin/env python3
"""delay(x, t) of what no state and no diode takes part in: sources, dividers, sources that are controlled, currents.

Such a signal is what sources make of it at any time, so the delayed one is the same earlier: closed forms, at three scales.

usage: delayed_signals.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

EXACT = 1e-9


def pulse(t):
    """2 V from 0.3 to 1.4."""
    return 2.0 if 0.3 <= t < 1.4 else 0.0


def sine(t):
    return math.sin(2 * math.pi * t) if t > 0 else 0.0


def ramps(t):
    """From 0 at 0.2 to 3 at 0.7, to -1 at 1.5."""
    return 0.0 if t < 0.2 else 6 * (t - 0.2) if t < 0.7 else 3 - 5 * (t - 0.7) if t < 1.5 else -1.0


SOURCES = {
    "pulse": ("pulse(0 2 {0.3} 0 0 {1.1} {9})", pulse, (0.3, 1.4)),
    "sine": ("sin(0 1 {per 1})", sine, ()),
    "ramps": ("pwl(0 0 {0.2} 0 {0.7} 3 {1.5} -1)", ramps, ()),
}

# The cards, the factor, and the delay of v(d) in units of time.
CIRCUITS = (
    (["e2 c 0 a 0 1", "b1 d 0 V=delay(v(c),{0.6})"], 1, 0.6),
    (["r2 a c 1", "r3 c 0 3", "b1 d 0 V=delay(v(c),{0.25})"], 0.75, 0.25),
    (["e2 c 0 a 0 2", "b1 d 0 V=delay(3*v(c)-v(a),{0.6})"], 5, 0.6),
    (["r9 a 0 2", "b1 d 0 V=delay(i(v1),{0.4})"], -0.5, 0.4),
    (["r2 a c 1", "r3 c 0 1", "b1 d 0 V=delay(v(a,c),{0.6})"], 0.5, 0.6),
    (["e2 c 0 a 0 1", "b1 p 0 V=delay(v(c),{0.5})", "b2 d 0 V=2*delay(v(p),{0.1})"], 2, 0.6),
    (["g2 0 c a 0 1m", "r2 c 0 4k", "b1 d 0 V=delay(v(c),{0.8})"], 4, 0.8),
    (["f2 0 c v1 1", "r9 a 0 1", "r2 c 0 1", "b1 d 0 V=delay(v(c),{0.6})"], -1, 0.6),
    (["xs a c s", ".subckt s i o", "e1 o 0 i 0 1", ".ends", "b1 0 p I=1m*delay(v(c),{0.3})", "r8 p 0 1k", "e9 d 0 p 0 1"], 1, 0.3),
    (["e2 c 0 a 0 1", "e3 d 0 LAPLACE {v(c)} = {exp(-s*{0.6})}"], 1, 0.6),
)


def scaled(text, unit):
    out, rest = "", text
    while "{" in rest:
        before, rest = rest.split("{", 1)
        word = rest.split("}", 1)[0]
        number = word[4:] if word.startswith("per ") else word
        if not number.replace(".", "", 1).isdigit():
            out += before + "{"
            continue
        rest = rest.split("}", 1)[1]
        out += before + repr(float(number) / unit if word.startswith("per ") else float(number) * unit)
    return out + rest


def check(checker, program, name, cards, factor, delay, unit, loads):
    text, function, jumps = SOURCES[name]
    lines = [f"v1 a 0 {scaled(text, unit)}", *(scaled(card, unit) for card in cards), "r7 d 0 1meg"]
    if loads:
        lines += ["r1 d x 1", f"c1 x 0 {0.3 * unit!r}"]
    at = [(k + 0.5) / 37 * unit for k in range(110)]
    netlist = f"{name}\n" + "\n".join(lines) + f"\n.tran {unit / 50!r} {3 * unit!r}\n"
    done = run(program, netlist, method=None, at=at)
    title = f"{name}, {lines[1:]}"
    if not checker.check(done.status == 0, f"{title}: exit {done.status}: {done.stderr}"):
        return
    for t, found in zip(done.time, done.column("v(d)")):
        since = t / unit - delay
        if all(abs(since - jump) > 1e-6 for jump in jumps):
            wanted = factor * function(since)
            checker.check(abs(found - wanted) <= EXACT * 3 * abs(factor),
                          f"{title}: {found:.10g} V in place of {wanted:.10g} V at {t:g} s")


def main():
    program = sys.argv[1]
    checker = Checker("delayed_signals")
    for k, (cards, factor, delay) in enumerate(CIRCUITS):
        for i, name in enumerate(SOURCES):
            check(checker, program, name, cards, factor, delay, (1.0, 1e-9, 1e3)[(k + i) % 3], (k + i) % 2 == 0)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
