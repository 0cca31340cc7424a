#!/usr/bin/env python3
"""A V with Ilimit= and revIlimit=: a multiplier in a box. Its current lies in [-revIlimit, Ilimit], its voltage is the
source's in between, more at the upper limit, less at the lower one.

usage: box.py PROGRAM auto|lobatto

Eleven circuits against closed forms, audited in full, with energies; each again turned over.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

EXACT = 2e-9
TURN = 2 * math.pi


def clip(value, low, high):
    return min(max(value, low), high)


def flat_tops():
    """A sine over a resistor: 10 mA where there is no limit."""
    netlist = "V1 in 0 SIN(0 10 50)\nR1 in a 1k\nVb a 0 0 Ilimit=5m revIlimit=5m\n.tran 1m 20m\n"
    return netlist, *flat_tops_of("i(vb)")


def flat_tops_of(signal):
    """Of a sine that would be 10 mA through 1 kohm: what is cut off at 5 mA, or the voltage that is left."""
    def exact(t):
        i = 0.01 * math.sin(TURN * 50 * t)
        cut = clip(i, -5e-3, 5e-3)
        return {signal: cut if signal[0] == "i" else 1e3 * (i - cut)}
    return [k * 0.7e-3 for k in range(1, 28)], exact


def lopsided():
    netlist = "V1 in 0 SIN(0 10 50)\nR1 in a 1k\nVb a 0 0 Ilimit=5m revIlimit=2m\n.tran 1m 20m\n"
    at = [k * 0.7e-3 for k in range(1, 28)]
    return netlist, at, lambda t: {"i(vb)": clip(0.01 * math.sin(TURN * 50 * t), -2e-3, 5e-3)}


def one_sided():
    netlist = "V1 in 0 SIN(0 10 50)\nR1 in a 1k\nVb a 0 0 revIlimit=2m\n.tran 1m 20m\n"
    at = [k * 0.7e-3 for k in range(1, 28)]
    return netlist, at, lambda t: {"i(vb)": max(0.01 * math.sin(TURN * 50 * t), -2e-3)}


def friction():
    """An LC tank with dry friction of 1 V, as a current through a dual: C and L side by side with a box of 1 A. The
    current of the coil swings about -1 and 1 A, by 2 A less each half-cycle, and stays where it is within the box."""
    netlist = "L1 a 0 1 ic=5.5\nC1 a 0 1 ic=0\nVb a 0 0 Ilimit=1 revIlimit=1\n.tran 10m 15 uic\n"

    def exact(t):
        amplitude, centre, start = 5.5, 1.0, 0.0
        while abs(amplitude) > 1:
            if t <= start + math.pi:
                swing = amplitude - centre
                return {"i(l1)": centre + swing * math.cos(t - start),
                        "v(a)": -swing * math.sin(t - start)}
            amplitude, centre, start = 2 * centre - amplitude, -centre, start + math.pi
        return {"i(l1)": amplitude, "v(a)": 0.0}
    return netlist, [0.5 * k for k in range(1, 30)], exact


def supply():
    """12 V with 1 A into an empty capacitor: a ramp, then 12 V."""
    netlist = "V1 a 0 12 revIlimit=1\nC1 a 0 1m\n.tran 100u 30m uic\n"
    return netlist, [k * 1e-3 for k in range(1, 30) if k != 12], lambda t: {
        "v(a)": min(12.0, 1e3 * t), "i(v1)": -1.0 if t < 12e-3 else 0.0}


def coil_over_the_limit():
    """5 A must go down to 1 A at once, with an impulse of voltage; then L/R."""
    netlist = "L1 a 0 1 ic=5\nR1 a b 1\nVb b 0 0 Ilimit=1 revIlimit=1\n.tran 10m 3 uic\n"
    return netlist, [0.1 * k for k in range(1, 30)], lambda t: {"i(l1)": math.exp(-t)}


def slope_under_friction():
    """A mass m=2 (C) pulled by 3 A against friction of 1 A: dv/dt = 1; by 0.5 A from 2 s on: it stops at 6 s."""
    netlist = ("C1 a 0 2 ic=0\nI1 0 a PULSE(3 0.5 2 0 0 10 20)\nVb a 0 0 Ilimit=1 revIlimit=1\n"
               ".tran 10m 10 uic\n")
    return netlist, [0.25 * k for k in range(1, 40) if k not in (8, 40)], lambda t: {
        "v(a)": t if t < 2 else max(0.0, 2 - (t - 2) * 0.25)}


def by_a_formula():
    """The same box as a source that reads its own voltage."""
    netlist = "V1 in 0 SIN(0 10 50)\nR1 in a 1k\nB1 a 0 I=5m*sgn(v(a))\n.tran 1m 20m\n"
    return netlist, *flat_tops_of("v(a)")


def two_in_series():
    """The narrower box decides."""
    netlist = ("V1 in 0 SIN(0 10 50)\nR1 in a 1k\nVb a b 0 Ilimit=5m revIlimit=5m\nVc b 0 0 Ilimit=3m revIlimit=3m\n"
               ".tran 1m 20m\n")
    at = [k * 0.7e-3 for k in range(1, 28)]
    return netlist, at, lambda t: {"i(vb)": clip(0.01 * math.sin(TURN * 50 * t), -3e-3, 3e-3),
                                   "i(vc)": clip(0.01 * math.sin(TURN * 50 * t), -3e-3, 3e-3)}


def beside_a_resistor():
    """What the box does not take, the resistor does."""
    netlist = ("I1 0 a SIN(0 10m 50)\nVb a 0 0 Ilimit=5m revIlimit=5m\nR1 a 0 100\n.tran 1m 20m\n")

    def exact(t):
        i = 0.01 * math.sin(TURN * 50 * t)
        return {"i(vb)": clip(i, -5e-3, 5e-3), "v(a)": 100 * (i - clip(i, -5e-3, 5e-3))}
    return netlist, [k * 0.7e-3 for k in range(1, 28)], exact


def sixty_in_a_chain():
    """Masses without springs between boxes that a ramp of current overcomes one after the other: node k moves from
    the time on at which its own share of the current, k mA, is passed."""
    n = 60
    lines = [f"I{k} 0 n{k} PWL(0 0 1 0.1)\nVb{k} n{k} 0 0 Ilimit={k}m revIlimit={k}m\nC{k} n{k} 0 1"
             for k in range(1, n + 1)]
    netlist = "\n".join(lines) + "\n.tran 10m 1\n"
    return netlist, [0.0333 * k for k in range(1, 30)], lambda t: {
        f"v(n{k})": 0.05 * max(0.0, t - 0.01 * k) ** 2 for k in (1, 30, 60)}


CASES = [flat_tops, lopsided, one_sided, friction, supply, coil_over_the_limit, slope_under_friction, by_a_formula,
         two_in_series, beside_a_resistor, sixty_in_a_chain]


def turned_over(netlist):
    """Each limited V the other way round, its limits exchanged; its current changes its sign."""
    lines = []
    for line in netlist.splitlines():
        word = line.split()
        if "limit=" in line.lower():
            word[1:4] = [word[2], word[1], f"{-float(word[3]):g}"]
            given = dict(w.lower().split("=") for w in word[4:])
            other = {"ilimit": "revIlimit", "revilimit": "Ilimit"}
            word[4:] = [f"{other[name]}={limit}" for name, limit in given.items()]
        lines.append(" ".join(word))
    return "\n".join(lines) + "\n"


def compare(checker, program, method, case, turned):
    netlist, at, exact = case()
    limited = {w.split()[0].lower() for w in netlist.splitlines() if "limit=" in w.lower()}
    title = f"{case.__name__}{', turned over' if turned else ''}"
    result = run(program, title + "\n" + (turned_over(netlist) if turned else netlist), method=method, at=at,
                 options=["--audit", "full", "--energy"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    for place, signal in enumerate(exact(at[0])):
        wanted = [exact(t)[signal] for t in at]
        sign = -1.0 if turned and signal[2:-1] in limited else 1.0
        scale = max(abs(w) for w in wanted) or 1.0
        worst, time = max((abs(sign * found - w), t) for found, w, t in zip(result.column(signal), wanted, at))
        checker.check(worst <= EXACT * scale, f"{title}: {signal} at {time:g} off by {worst / scale:.1e}")
    energy = result.report["energy"]
    checker.check(energy["diodes"] >= -1e-12, f"{title}: a box gave energy: {energy}")


def main():
    program, method = sys.argv[1:]
    checker = Checker("box")
    for case in CASES:
        for turned in (False, True):
            compare(checker, program, method, case, turned)
    result = run(program, "too much\nI1 0 a 2\nVb a 0 0 Ilimit=1 revIlimit=1\n.tran 1m 1\n", method=method)
    checker.check(result.status == 1 and "no solution exists" in result.stderr and "ilimit(vb)" in result.stderr,
                  f"too much: exit {result.status}: {result.stderr}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
