#!/usr/bin/env python3
"""States that a diode or a switch holds at 0 while a source drives a current past them.

usage: held_states.py PROGRAM

A capacitor under a conducting diode, a coil behind a blocking one: the state is 0, exactly, whatever the source does, and
what answers the source is the diode alone. Its current (or reverse voltage) is the source's, and it changes sides where
that passes 0. No step may be taken by implicit Euler.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

MODELS = ".model dd d(ron=0)\n.model leaky d(roff=10k)\n.model sw sw(ron=0 vt=0.5)"
LOCATED = 1e-11  # of the stop time


def sine(amplitude, frequency):
    return f"sin(0 {amplitude!r} {frequency!r})"


# cards, the stop time, the element and its side, the times at which it comes to that, (signal, formula)
def clamped_capacitor(amplitude, frequency, farads, ohms, model="dd"):
    period = 1 / frequency
    return ([f"i1 n 0 {sine(amplitude, frequency)}", f"c1 n 0 {farads!r}", f"d1 n 0 {model}", f"r1 n 0 {ohms!r}"],
            3.4 * period, "d1", "off", [k * period for k in (1, 2, 3)],
            ("i(d1)", lambda t: -amplitude * math.sin(2 * math.pi * frequency * t), "on"))


def blocked_coil(amplitude, frequency, henries, ohms):
    period = 1 / frequency
    return ([f"v1 n 0 {sine(amplitude, frequency)}", f"l1 n m {henries!r}", "d1 m k dd", f"r1 k 0 {ohms!r}"],
            3.4 * period, "d1", "on", [k * period for k in (1, 2, 3)],
            ("v(k,m)", lambda t: -amplitude * math.sin(2 * math.pi * frequency * t), "off"))


def stack(amplitude, frequency, farads):
    """One source through three, of which the middle one is turned around."""
    period = 1 / frequency
    return ([f"i1 c 0 {sine(amplitude, frequency)}", f"c1 a 0 {farads!r}", "d1 a 0 dd", "r1 a 0 10",
             f"c2 b a {3 * farads!r}", "d2 a b dd", "r2 b a 10", f"c3 c b {0.1 * farads!r}", "d3 c b dd", "r3 c b 10"],
            2.4 * period, "d3", "off", [period, 2 * period],
            ("i(d3)", lambda t: -amplitude * math.sin(2 * math.pi * frequency * t), "on"))


def falling_pulse(amplitude, unit, farads, henries):
    """A ramp down takes the diode's current to 0; the capacitor and the coil beside it never move."""
    return ([f"i1 n1 0 pulse(0 {amplitude!r} 0 0 {11 * unit!r} {33 * unit!r} {110 * unit!r})", f"c2 n1 0 {farads!r} ic=0",
             f"l3 n1 0 {henries!r} ic=0", "d4 0 n1 leaky"],
            300 * unit, "d4", "off", [44 * unit, 154 * unit, 264 * unit],
            ("i(d4)", lambda t: amplitude * max(0.0, min(1.0, (44 - t / unit % 110) / 11)), "on"))


def shorted_capacitor(amplitude, frequency, farads):
    """By a switch that opens at a peak of the current."""
    period = 1 / frequency
    return ([f"vg g 0 pulse(1 0 {2.25 * period!r} 0 0 1e3 2e3)", f"i1 0 n {sine(amplitude, frequency)}", f"c1 n 0 {farads!r}",
             "s1 n 0 g 0 sw", "r1 n 0 1k", "d1 0 q dd", f"c2 q 0 {farads!r}", "r2 q n 50"],
            2.6 * period, "s1", "off", [2.25 * period],
            ("i(s1)", lambda t: amplitude * math.sin(2 * math.pi * frequency * t), "on"))


CASES = {
    "5 uF, 3 kHz, as it was seen": clamped_capacitor(1.0, 3e3, 5e-6, 10.0),
    "100 pF, 1 MHz": clamped_capacitor(1e-3, 1e6, 100e-12, 300.0),
    "1 mF, 50 Hz, 100 A": clamped_capacitor(100.0, 50.0, 1e-3, 0.2),
    "20 mF, 1 Hz": clamped_capacitor(2.0, 1.0, 20e-3, 5.0),
    "a leak": clamped_capacitor(1.0, 10e3, 0.2e-6, 20.0, "leaky"),
    "a coil, 1 mH": blocked_coil(10.0, 1e3, 1e-3, 3.0),
    "a coil, 20 H": blocked_coil(325.0, 50.0, 20.0, 3e3),
    "a coil, 5 nH": blocked_coil(1.0, 100e6, 5e-9, 2.0),
    "three in series": stack(1.0, 3e3, 4.7e-6),
    "three in series, small": stack(1e-6, 200e3, 1e-9),
    "a ramp, as it was seen": falling_pulse(0.26, 1e-6, 2.4e-6, 0.13e-3),
    "a ramp, slow": falling_pulse(40.0, 1e-3, 1e-3, 2.0),
    "a ramp, fast": falling_pulse(1e-3, 1e-9, 10e-12, 1e-6),
    "a switch": shorted_capacitor(1.0, 1e3, 1e-6),
    "a switch, fast": shorted_capacitor(0.1, 5e6, 20e-12),
}


def judge(checker, name, cards, stop, element, side, times, held):
    signal, formula, holding = held
    text = "\n".join([name, *cards, MODELS, f".tran {stop / 400!r} {stop!r} uic", ".end", ""])
    outcome = run(sys.argv[1], text, method=None, options=["--fill", "none"])
    if not checker.check(outcome.status == 0, f"{name}: {outcome.stderr[:300]}"):
        return
    work = outcome.report["work"]
    checker.check(work["euler_steps"] == 0, f"{name}: {work['euler_steps']} steps by euler")
    events = [e for e in outcome.report["events"] if e["element"] == element]
    found = [e["time"] for e in events if e["state"] == side]
    if checker.check(len(found) == len(times), f"{name}: {element} {side} at {found}, not {times}"):
        for a, b in zip(found, times):
            checker.close(a, b, LOCATED * stop, f"{name}: {element} {side}")
    largest = max(abs(formula(stop * k / 997)) for k in range(997))
    moments = iter(sorted((e["time"], e["state"]) for e in events))
    coming, state = next(moments, (math.inf, "")), {"on": "off", "off": "on"}.get(events[0]["state"]) if events else holding
    for t, value in zip(outcome.time, outcome.column(signal)):
        while t > coming[0]:
            state, coming = coming[1], next(moments, (math.inf, ""))
        if state == holding and t != coming[0]:
            checker.close(value, formula(t), 1e-9 * largest, f"{name}: {signal} at {t!r}")


def main():
    checker = Checker("held_states")
    for name, case in CASES.items():
        judge(checker, name, *case)
    return checker.finish()


sys.exit(main())
