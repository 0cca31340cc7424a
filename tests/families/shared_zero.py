#!/usr/bin/env python3
"""Diodes that share a current or a voltage which is 0, so that their mode is singular and their answer is not.

usage: shared_zero.py PROGRAM

Capacitors that each other's diode currents fill (Heemels, Schumacher and Weiland 1999, example 5.11, and its dual with
coils), diodes in parallel, in series, in a ring, bridges at rest. After a jump, or before a source rises, all diodes
are on both sides at once. With all of them closed, or all open, states have no course at all, or one that leaves
something open; with some of them blocked they have one. So implicit Euler has nothing to do here, no step is refused
for want of a solution, and every waveform is exact.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

STOP = 10e-3
AT = [STOP * (k + 0.37) / 50 for k in range(50)]
MOST_STEPS = 16
SCALES = 1.0, 1e-6, 1e-12  # F or H
PULSE = "pulse(0 {} 2m 1u 1u 1m 10m)"


def fed(weights, starts):
    """Each diode's current, times weights, also flows into the other capacitors."""
    lines = []
    for k, start in enumerate(starts):
        lines += [f"C{k} x{k} 0 {{C}} ic={start}", f"Vi{k} 0 a{k} 0", f"D{k} a{k} x{k} di"]
        lines += [f"F{k}_{j} 0 x{j} Vi{k} {weights[j] / weights[k]}" for j in range(len(starts)) if j != k]
    return lines


def linked(starts):
    """Each diode's voltage, copied, is also across the other coils."""
    lines = []
    for k, start in enumerate(starts):
        lines += [f"L{k} c{k}_0 0 {{C}} ic={start}", f"VL{k} d{k} c{k}_{len(starts) - 1} 0", f"Vg{k} g{k} 0 0",
                  f"D{k} g{k} d{k} di"]
        others = [j for j in range(len(starts)) if j != k]
        lines += [f"E{k}_{j} c{k}_{i} c{k}_{i + 1} d{j} g{j} 1" for i, j in enumerate(others)]
    return lines


def bridge(name, source):
    return [f"V{name} {name}1 {name}2 {source}", f"D{name}1 {name}1 p di", f"D{name}2 {name}2 p di",
            f"D{name}3 0 {name}1 di", f"D{name}4 0 {name}2 di"]


def parallel(n):
    return ["C0 x0 0 {C} ic=-1", *(f"D{k} 0 x0 di" for k in range(n))]


def pulled(t):
    """A of a PULSE of 1 A."""
    return min(max((t - 2e-3) / 1e-6, 0), max(min(1, (3.002e-3 - t) / 1e-6), 0))


def fallen(t):
    """V s, its integral."""
    return min(max(t - 2e-3 - 0.5e-6, 0), 1.001e-3)


def rectified(t):
    """A trapezoid of 10 V between 2 ms and 5 ms, held by 10 ms."""
    return 10 * min(max(t - 2e-3, 0) / 1e-3, 1) * math.exp(-max(t - 4e-3, 0) / 10e-3)


def zero(_):
    return 0.0


TRAPEZOID = "pulse(0 10 2m 1m 1m 1m 20m)"
LOADED = ["C0 p 0 1u ic=0", "R0 p 0 10k"]
FREE = {  # of the size of what stores
    "two": (fed([1, 1], [-1, -1]), {"x0": zero, "x1": zero}),
    "two, far": (fed([1, 1], [-100, -100]), {"x0": zero, "x1": zero}),
    "three": (fed([1, 1, 1], [-1, -1, -1]), {"x0": zero, "x1": zero, "x2": zero}),
    "five": (fed([1] * 5, [-3] * 5), {"x0": zero, "x4": zero}),
    "nine": (fed([1] * 9, [-3] * 9), {"x0": zero, "x8": zero}),
    "unequal copies": (fed([1, 2, 4], [-1, -2, -4]), {"x0": zero, "x1": zero, "x2": zero}),
    "one goes farther": (fed([1, 1], [-1, -2]), {"x0": lambda t: 1.0, "x1": zero}),
    "one is above": (fed([1, 1], [-1, 1]), {"x0": zero, "x1": lambda t: 2.0}),
    "two coils": (linked([-1, -1]), {"c0_0": zero, "c1_0": zero}),
    "three coils": (linked([-2, -2, -2]), {"c0_0": zero, "c2_0": zero}),
    "two in parallel": (parallel(2), {"x0": zero}),
    "five in parallel": (parallel(5), {"x0": zero}),
    "in series": (["C0 a 0 {C} ic=1", "D1 a b di", "D2 b c di", "D3 c d di", "C1 d 0 {C} ic=1"],
                  {"a": lambda t: 1.0, "d": lambda t: 1.0}),
    "in series, a jump": (["C0 a 0 {C} ic=1", "D1 a b di", "D2 b c di", "C1 c 0 {C} ic=0"],
                          {"a": lambda t: 0.5, "c": lambda t: 0.5}),
    "a ring beside": (["C0 a 0 {C} ic=-1", "D1 a b di", "D2 b c di", "D3 c a di", "D4 0 a di"], {"a": zero}),
    "a bridge, shorted": (["C0 p 0 {C} ic=-1", "C1 ac1 ac2 {C} ic=1", *bridge("b", "0")], {"p": zero}),
}
DRIVEN = {
    "one is pulled": ([*fed([1, 1], [-1, -1]), f"I0 x0 0 {PULSE.format('1m')}"], "1u",
                      {"x0": zero, "x1": lambda t: 1e-3 * fallen(t) / 1e-6, "i(d0)": lambda t: 1e-3 * pulled(t)}),
    "with resistors": ([*fed([1, 1], [-1, -1]), "R0 x0 0 1k", "R1 x1 0 10"], "1u", {"x0": zero, "x1": zero}),
    "parallel, pulled": ([*parallel(2), f"I0 x0 0 {PULSE.format('1m')}"], "1u",
                         {"x0": zero, "i(d0)": lambda t: 0.5e-3 * pulled(t)}),
    "a bridge at rest": ([*bridge("b", TRAPEZOID), *LOADED], "1u", {"p": rectified}),
    "two bridges at rest": ([*bridge("b", TRAPEZOID), *bridge("c", "pulse(0 4 3m 1m 1m 1m 20m)"), *LOADED], "1u",
                            {"p": rectified}),
    "a small bridge": ([*bridge("b", TRAPEZOID.replace("10 ", "10m ")), "C0 p 0 1p ic=0", "R0 p 0 10g"], "1p",
                       {"p": lambda t: rectified(t) / 1e3}),
}


def check(program, checker, case, lines, size, wanted):
    text = "\n".join(["shared", *lines, ".model di d", f".tran 10u {STOP} uic", ".end", ""])
    result = run(program, text.replace("{C}", f"{size}"), at=AT, method=None)
    if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
        return
    work = result.report["work"]
    checker.check(work["euler_steps"] == 0, f"{case}: {work['euler_steps']} steps by euler")
    checker.check(work["steps"] <= MOST_STEPS, f"{case}: {work['steps']} steps")
    for name, exact in wanted.items():
        signal = name if "(" in name else f"v({name})"
        scale = max(abs(exact(t)) for t in AT)
        for t, found in zip(AT, result.column(signal)):
            if not checker.check(abs(found - exact(t)) <= 1e-6 * scale + 1e-12,
                                 f"{case}: {signal} at {t:.3g} is {found:.9g}, not {exact(t):.9g}"):
                break


def main():
    program = sys.argv[1]
    checker = Checker("shared_zero")
    for name, (lines, wanted) in FREE.items():
        for size in SCALES:
            check(program, checker, f"{name}, {size}", lines, size, wanted)
    for name, (lines, size, wanted) in DRIVEN.items():
        check(program, checker, name, lines, size, wanted)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
