#!/usr/bin/env python3
"""What happens within the resolution of times of an edge or of the start: the audit calls none of it wrong.

usage: at_once.py PROGRAM

A diode that carries a load at rest opens 1e-13 of the run after a switch closes at 0; another opens 5e-20 s behind the edge
that closed a switch. Values are closed forms, of sizes from millivolts to kilovolts and from microseconds to hours.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

ALLOWED = 1e-8

# The diode's share of the voltage; from there the switch takes it away in that share of a time constant.
DROPS = 1e-5, 3e-6, 1e-7

# Flybacks with a leakage inductance, whose clamp opens one or two roundings of the time after an edge: of one period in
# about two hundred. T in s, V, ohms of the switch, coils in H, coupling, and F and ohms of the output and the clamp.
FLYBACKS = {
    "29 us": (28.87e-6, 80.39, 10e-3, 53.57e-6, 482.13e-6, 0.99, 3.4575e-6, 83.5, 12.447e-6, 46.389, 345.75e-12, 7),
    "21 us": (21.34e-6, 69.297, 0.133071, 841.458e-6, 2559.82e-6, 0.98, 192.056e-9, 1111.14, 691.402e-9, 617.301,
              13.9466e-12, 7),
    "88 us": (87.52e-6, 169.021, 9.18187e-3, 192.975e-6, 1376.15e-6, 0.99, 11.4154e-6, 76.6686, 41.0955e-6, 42.5938,
              1.36743e-9, 7),
}


def rests_on_a_diode(checker, name, volts, seconds, drop, share, command):
    """A current goes into a supply through a diode; at 0 a switch takes it, and the capacitor beside it."""
    r, ron = 0.01, 0.1
    amperes = drop * volts / r
    tau = share * seconds
    gate = {"pulse": f"pulse(0 1 0 0 0 {2 * seconds!r})", "pwl": "pwl(0 0 0 1)", "falls": "pulse(1 0 0 0 0 1)"}[command]
    control = "k g" if command == "falls" else "g 0"
    text = "\n".join([name, f"vc cl 0 {volts!r}", f"vg g 0 {gate}", "vk k 0 1", f"ib 0 d {amperes!r}", f"s1 d 0 {control} sw",
                      "d2 d cl dd", f"cd d 0 {tau / ron!r}", f".model sw sw(vt=0.5 ron={ron!r})", f".model dd d(ron={r!r})",
                      ".save v(d)", f".tran {seconds / 20!r} {seconds!r}", ".end", ""])
    times = [0.5 * tau, 2 * tau, 7 * tau]
    for audit in "sample", "full":
        out = run(sys.argv[1], text, method=None, at=times, options=["--audit", audit])
        if checker.check(out.status == 0, f"{name}, {audit}: {out.stderr[:300]}"):
            end = ron * amperes
            forms = [end + (volts * (1 + drop) - end) * math.exp(-t / tau) for t in times]
            off = max(abs(got - form) for got, form in zip(out.column("v(d)"), forms)) / volts
            checker.check(off <= ALLOWED, f"{name}: off by {off:.2g}")


def flyback(checker, name, values):
    period, volts, ron, l1, l2, k, c1, r1, cc, rc, cd, n = values
    text = "\n".join([name, f".model sw sw(vt=0.5 ron={ron!r})", f".model dd d(ron={ron / 10!r})", f"v1 p 0 {volts!r}",
                      f"vg g 0 pulse(0 1 0 0 0 {WIDTHS[name] * period!r} {period!r})", f"l1 p d {l1!r}", f"l2 0 s {l2!r}",
                      f"k1 l1 l2 {k!r}", "s1 d 0 g 0 sw", "d1 s o dd", f"c1 o 0 {c1!r}", f"r1 o 0 {r1!r}", "d2 d cl dd",
                      f"cc cl p {cc!r}", f"rc cl p {rc!r}", f"cd d 0 {cd!r}", f".tran {period / 50!r} {n * period!r}", ".end", ""])
    out = run(sys.argv[1], text, method=None, options=["--audit", "full"])
    checker.check(out.status == 0, f"{name}: {out.stderr[:300]}")
    events = out.report["events"]
    gaps = [b["time"] - a["time"] for a, b in zip(events, events[1:])]
    checker.check(any(0 < gap < 1e-18 for gap in gaps), f"{name}: no events within the resolution of times")


WIDTHS = {"29 us": 0.4, "21 us": 0.5, "88 us": 0.5}


def main():
    checker = Checker("at_once")
    for drop in DROPS:
        for share in 1e-7, 2e-8, 1e-9:
            for k, (volts, seconds) in enumerate(((1e-2, 1e-3), (50.0, 1e-6), (4e3, 1e-2), (50.0, 3600.0))):
                command = ("pulse", "pwl", "falls")[k % 3]
                name = f"{volts:g} V in {seconds:g} s, {drop:g} of it, {share:g}, {command}"
                rests_on_a_diode(checker, name, volts, seconds, drop, share, command)
    for name, values in FLYBACKS.items():
        flyback(checker, name, values)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
