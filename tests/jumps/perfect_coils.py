#!/usr/bin/env python3
"""What is told of coils that are coupled perfectly when something jumps: their currents are no states.

usage: perfect_coils.py PROGRAM

Where a capacitor jumps the currents of such coils are where they were, however steeply they go on. Where one is cut off
the others take over its ampere-turns.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

MODELS = [".model sw sw(vt=0.5)", ".model d d(ron=0)"]
SIZES = (("a converter", 390.0, 54e-6, 1e-5), ("kilovolts", 1e4, 1.0, 1e-2), ("a chip", 1.0, 1e-9, 1e-7))


def jumps_of(c, name, cards, tran):
    outcome = run(sys.argv[1], "\n".join([name, *cards, *MODELS, f".tran {tran}", ".end", ""]), method=None,
                  options=("--audit", "full"))
    c.check(outcome.status == 0, f"{name}: {outcome.stderr}")
    return outcome.report["jumps"] if outcome.status == 0 else []


def half_bridge(c, name, volts, henry, period):
    """A half bridge with a capacitor at its middle, behind it a resonant circuit with a transformer of three windings."""
    farad = (period / 8) ** 2 / henry
    gates = [f"vg{k} g{k} 0 pulse(0 1 {(k - 0.5) * period / 2!r} 0 0 {0.47 * period!r} {period!r})" for k in (1, 2)]
    found = jumps_of(c, f"half bridge, {name}", [
        f"v1 p 0 {volts!r}", *gates, "s1 p a g1 0 sw", "s2 a 0 g2 0 sw", f"ch a 0 {farad / 150!r}", f"cr a x {farad!r}",
        f"lr x y {henry!r}", f"lp y 0 {6 * henry!r}", f"ls1 e 0 {0.01 * henry!r}", f"ls2 0 f {0.01 * henry!r}", "k1 lp ls1 ls2 1",
        "d3 e o d", "d4 f o d", f"co o 0 {1e4 * farad!r}", f"ro o 0 {1e-2 * period / farad!r}"],
        f"{period / 20!r} {5 * period!r}")
    c.check(len(found) > 3, f"half bridge, {name}: {len(found)} jumps")
    for jump in found:
        c.check(list(jump["states"]) == ["ch"], f"half bridge, {name}: at {jump['time']} {jump['states']}")


def flyback(c, name, volts, henry, period):
    """The current of the primary goes over to a secondary with a quarter of its turns while its capacitor meets another."""
    ampere = 0.25 * volts * period / henry
    farad = period * period / henry
    found = jumps_of(c, f"flyback, {name}", [
        f"v1 in 0 {volts!r}", f"lp in a {henry!r}", f"ls 0 b {henry / 16!r}", "k1 lp ls 1",
        f"vg g 0 pulse(1 0 {period / 4!r} 0 0 {period!r})", f"vh h 0 pulse(0 1 {period / 4!r} 0 0 {period!r})", "s1 a 0 g 0 sw",
        "d1 b o d", f"co o 0 {farad!r} ic={volts!r}", "s2 o q h 0 sw", f"cq q 0 {3 * farad!r}"],
        f"{period / 20!r} {0.6 * period!r} uic")
    if not c.check(len(found) == 1 and set(found[0]["states"]) == {"lp", "ls", "co", "cq"}, f"flyback, {name}: {found}"):
        return
    for state, before, after, scale in (("lp", ampere, 0.0, ampere), ("ls", 0.0, 4 * ampere, ampere),
                                        ("co", volts, volts / 4, volts), ("cq", 0.0, volts / 4, volts)):
        c.close(found[0]["states"][state]["before"], before, 1e-9 * scale, f"flyback, {name}: {state} before")
        c.close(found[0]["states"][state]["after"], after, 1e-9 * scale, f"flyback, {name}: {state} after")


def cut_resonant(c, name, volts, henry, period):
    """Switches without a path in their dead time cut a resonant current off; a secondary takes over what magnetises."""
    farad = (period / 6) ** 2 / henry
    gates = [f"vg{k} g{k} 0 pulse(0 1 {(k - 1) * period / 2!r} 0 0 {0.48 * period!r} {period!r})" for k in (1, 2)]
    found = jumps_of(c, f"cut, {name}", [
        f"v1 in 0 {volts!r}", *gates, "s1 in a g1 0 sw", "s2 a 0 g2 0 sw", f"cr a x {farad!r}", f"lr x y {henry!r}",
        f"lm y 0 {5 * henry!r}", f"ls1 e 0 {0.08 * henry!r}", f"ls2 0 f {0.08 * henry!r}", "k1 lm ls1 ls2 1", "d1 e o d", "d2 f o d",
        f"co o 0 {1e4 * farad!r} ic={0.06 * volts!r}", f"ro o 0 {0.05 * henry / period!r}"],
        f"{period / 20!r} {4 * period!r} uic")
    c.check(len(found) == 8, f"cut, {name}: {len(found)} jumps")
    turns = 0.016 ** 0.5
    for jump in found:
        states, label = jump["states"], f"cut, {name}: at {jump['time']}"
        if not c.check({"lr", "lm"} <= set(states), f"{label} {states}"):
            continue
        ampere = abs(states["lr"]["before"])
        magnetises = {side: states["lm"][side] + turns * sum(states[s][side] for s in ("ls1", "ls2") if s in states)
                      for side in ("before", "after")}
        c.close(states["lr"]["after"], 0.0, 1e-9 * ampere, f"{label}: lr after")
        c.close(states["lm"]["after"], 0.0, 1e-9 * ampere, f"{label}: lm after")
        c.close(magnetises["after"], magnetises["before"], 1e-9 * ampere, f"{label}: ampere-turns")


# What follows the jump lasts picoseconds to nanoseconds: a diode opens and leaves the current to its leak; a diode's
# milliohm discharges a capacitor. The audit compares each told current with the waveform on both sides.
BRIEF = {
    "a leak takes over": [
        "v1 p 0 180.387", "va a 0 pulse(0 1 0 0 0 205.2u 456u)", "vb b 0 pulse(0 1 228u 0 0 205.2u 456u)",
        "vc c 0 pulse(0 1 103.4u 0 0 205.2u 456u)", "vd d 0 pulse(0 1 331.4u 0 0 205.2u 456u)", "s1 p x a 0 sw", "d1 x p d",
        "s2 x 0 b 0 sw", "d2 0 x d", "cx x 0 0.27u", "s3 p y c 0 sw", "d3 y p d", "s4 y 0 d 0 sw", "d4 0 y d", "lr x z 0.293u",
        "lp z y 2.574m", "ls1 e 0 1.073m", "ls2 0 f 1.073m", "k1 lp ls1 ls2 1", "d5 e r d", "d6 f r d", "lo r o 83.5u",
        "co o 0 71.9m ic=0", "ro o 0 0.154", ".model sw sw(vt=0.5 roff=1meg)", ".model d d(ron=1m roff=1meg)", ".tran 9u 1.4m uic"],
    "a clamp of milliohms": [
        "v1 in 0 5.235", "va g 0 pulse(0 1 0 55n 55n 36.18u 55.57u)", "vb h 0 pulse(0 1 36.79u 0 0 18.22u 55.57u)", "lp in a 0.972m",
        "ls 0 s 0.557m", "k1 lp ls 1", "s1 a n g 0 sw", "rn n 0 1m", "d1 a k d", "ck k in 2.3u", "rk k in 21", "cx a 0 30.7n",
        "s2 o s h 0 sw", "d2 s o d", "co o 0 172u ic=3.963", "ro o 0 4.48", ".model sw sw(vt=0.5 roff=100meg)", ".model d d(ron=1m)",
        ".tran 1.1u 0.4m uic"],
    "a coupled SEPIC": [
        "v1 in 0 4.607", "va g 0 pulse(0 1 0 0 0 19.87u 40.42u)", "la in a 0.489m", "s1 a 0 g 0 sw", "cs a b 6.75u ic=4.607",
        "lb b 0 0.968m", "d1 b o d", "k1 la lb 1", "co o 0 33.5u", "ro o 0 11.15", ".model sw sw(vt=0.5)",
        ".model d d(ron=1m roff=1meg)", ".tran 0.8u 0.55m uic"],
}


def brief(c):
    for name, cards in BRIEF.items():
        done = run(sys.argv[1], "\n".join([name, *cards, ".end", ""]), method=None, options=["--audit", "full"])
        c.check(done.status == 0, f"{name}: {done.stderr[:300]}")


def main():
    c = Checker("perfect_coils")
    brief(c)
    for size in some_of(SIZES):
        half_bridge(c, *size)
        flyback(c, *size)
        cut_resonant(c, *size)
    return c.finish()


if __name__ == "__main__":
    sys.exit(main())
