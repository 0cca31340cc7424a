#!/usr/bin/env python3
"""Synchronous rectifiers whose gates are the windings of their transformer.

usage: winding_driven_rectifiers.py PROGRAM

An edge on the primary side turns a winding's voltage: a switch with hysteresis on the other side, and a diode beside it,
are past their limits at the same instant. The switch turns first, for what the one-step problem says of diodes it says
with the switches where they stand. No step falls back to implicit Euler, and the end is that of seven stages at 1e-10.
Of a push-pull stage without a snubber the stray coils put megavolts on a switch of 1 megohm: what follows takes less time
than the run resolves, and the audit allows for that.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from without_euler import compare_ends  # noqa: E402

ALLOWED = 1e-6
OHMS = {"ideal": ("", ""), "real": ("ron=10m roff=1meg", "ron=2m roff=1meg")}
# primary side, input in V, stray coil or k, turns from 1 to each half of the secondary, load in ohm, part of half a period
CASES = [("full", 400, 2e-6, 14.14, 0.3, 0.96), ("full", 48, 1e-7, 2.0, 1.0, 0.9), ("half", 400, 5e-6, 7.0, 0.5, 0.94),
         ("half", 60, 2e-7, 2.5, 2.0, 0.8), ("full", 400, 1e-5, 10.0, 1.0, 0.7)]
# of resistances alone: where a switch is ideal its coil would have no way
CASES += [("push", 24, 0.9999, 1.5, 1.0, 0.9), ("push", 24, 0.999, 1.5, 1.0, 0.9), ("push", 12, 0.99, 0.5, 5.0, 0.8),
          ("push", 48, 0.95, 4.0, 0.1, 0.95), ("push", 24, 0.998, 0.1, 1e3, 0.7)]
PERIOD = 1e-5


def primary(kind, volts, stray, turns):
    coil = 1e-3
    pulse = "v{n} g{n} 0 pulse(0 1 {delay!r} 20n 20n {width!r} 10u)"
    gates = [pulse, pulse]
    side = "l5 s1 ct {half!r}|l6 ct s2 {half!r}".format(half=coil / turns ** 2).split("|")
    if kind == "push":
        cards = [f"v0 p 0 {volts}", f"la p a {coil}", f"lb b p {coil}", "s1 a 0 ga 0 sw", "d1 0 a", "s2 b 0 gb 0 sw", "d2 0 b"]
        return gates, [*cards, *side, f"k1 la lb l5 l6 {stray}"]
    bridge = ["s1 p a ga 0 sw", "d1 a p", "s2 a 0 gb 0 sw", "d2 0 a"]
    if kind == "full":
        bridge += ["s3 p b gb 0 sw", "d3 b p", "s4 b 0 ga 0 sw", "d4 0 b"]
    else:
        bridge += [f"c1 p b 1u ic={volts / 2}", f"c2 b 0 1u ic={volts / 2}"]
    return gates, [f"v0 p0 0 {volts}", "r0 p0 p 10m", *bridge, f"lk a x {stray!r}", f"lp x b {coil!r}", *side, "k1 lp l5 l6 1"]


def netlist(case, ohms):
    if case[0] == "push" and ohms == OHMS["ideal"]:
        return None
    kind, volts, stray, turns, load, duty = case
    gates, cards = primary(kind, volts, stray, turns)
    cards += [gate.format(n="ab"[k], delay=k * PERIOD / 2, width=duty * PERIOD / 2) for k, gate in enumerate(gates)]
    secondary = (volts if kind != "half" else volts / 2) / turns
    threshold = f"vt={secondary / 7!r} vh={secondary / 28!r}"
    cards += ["d5 0 s1", "d6 0 s2", "s5 0 s1 s2 ct sr", "s6 0 s2 s1 ct sr", "lo ct o 2u",
              f"co o 0 470u ic={0.45 * secondary!r}", f"ro o 0 {load}", f".model sw sw(vt=0.5 {ohms[0]})",
              f".model sr sw({threshold} {ohms[1]})", ".tran 50n 100u uic"]
    return "\n".join(["winding-driven rectifier", *cards, ".end", ""])


if __name__ == "__main__":
    sys.exit(compare_ends(sys.argv[1], "winding_driven_rectifiers", CASES, OHMS, netlist,
                          "v(o)", {"tolerance": 1e-10, "stages": 7}, ALLOWED))
