#!/usr/bin/env python3
"""A source that floats behind diodes until it drives a current through them, with resistors that lead nowhere.

usage: floating_islands.py PROGRAM

Two diodes in series close the circuit of a ramp and a coil through ground. Up to the forward voltage of one nothing
flows: the only conductances are those of resistors that lead nowhere, and what the digits of their voltages make of
currents is no current, of neither sign. From then on i = slope (t - t0)^2 / (2 L), up to the ramp's end.

Then bridges of diodes in series with switches, with or without latches, on sources in a star. While nothing conducts the
star floats, and to each switch leads a leak of megohms to gigohms beside its milliohms to ohms: every law holds in each.
"""

import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# the ramp's height and time, the forward voltage, the coil, resistors that lead nowhere, their node; the return path
CASES = {
    "as it was seen": (1.0, 7e-9, 0.7, 0.4e-3, [109.71096057568845, 105.0], "n1", "diode"),
    "one resistor": (1.0, 7e-9, 0.7, 0.4e-3, [1e3], "n1", "diode"),
    "on the other side": (1.0, 7e-9, 0.7, 0.4e-3, [47.0, 1e6], "n2", "diode"),
    "behind the source": (5.0, 1e-6, 0.6, 1e-6, [220.0, 330.0], "s0", "diode"),
    "milliohms": (5.0, 1e-3, 1.4, 1e-3, [1e-3], "n1", "diode"),
    "megohms": (400.0, 20e-6, 2.5, 0.1, [1e6, 2.2e6, 4.7e6], "n1", "diode"),
    "a slow one": (12.0, 2.0, 3.0, 10.0, [10.0, 10.0], "n1", "diode"),
    "a small one": (1e-3, 1e-9, 0.2e-3, 1e-9, [50.0, 75.0], "n1", "diode"),
    "no second diode": (1.0, 7e-9, 0.7, 0.4e-3, [109.71096057568845, 105.0], "n1", "ground"),
    "a resistor to ground": (10.0, 1e-6, 0.7, 10e-6, [33.0, 330.0], "n1", "wire"),
}


def netlist(name, height, rise, forward, henries, resistors, node, back):
    cards = [f"v8 s0 n1 pulse(0 {height!r} 0 {rise!r} 0 1e3 2e3)", f"l9 s0 n2 {henries!r} ic=0", "d7 0 n1 md2",
             "d1 n1 0 md1" if back != "wire" else "d1 n1 0 md1\nrg n2 0 0",
             "d2 n2 0 md1" if back == "diode" else "r2 n2 0 0" if back == "ground" else "d2 n2 0 md1"]
    cards += [f"rx{k} x{k} {node} {ohms!r}" for k, ohms in enumerate(resistors)]
    return "\n".join([name, *cards, ".model md1 d(ron=0)", f".model md2 d(vfwd={forward!r})", ".save i(l9) i(d7)",
                      f".tran {rise / 100!r} {rise!r} uic", ".end", ""])


# seeds of bridges that were refused at the start or where a diode was on neither side, and others
BRIDGES = (1, 10, 29, 36, 38, 52, 56, 100, 103, 104)


def valve(cards, side, anode, cathode, latch, pulse):
    cards += [f"vm{side} {anode} t{side} 0", f"d{side} t{side} u{side} dx", f"s{side} u{side} {cathode} g{side} 0 sx"]
    if latch is None:
        cards.append(f"vg{side} g{side} 0 {pulse}")
    else:
        cards += [f"vg{side} f{side} 0 {pulse}", f"b{side} g{side} 0 v=v(f{side})+min(1,max(0,{latch!r}*i(vm{side})))"]


def bridge(seed):
    draw = random.Random(seed)
    phases = draw.choice((2, 3, 4, 6))
    volts, hertz = 10 ** draw.uniform(-3, 3.5), 10 ** draw.uniform(0, 5)
    leak, ohms = 10 ** draw.uniform(6, 11), 10 ** draw.uniform(-3, 2)
    latch = 1e3 * ohms / volts if draw.random() < 0.5 else None
    cards = [f"bridge {seed}"]
    for k in range(phases):
        cards.append(f"v{k} s{k} n sin(0 {volts:.6g} {hertz:.6g} 0 0 {360 * k / phases + draw.uniform(0, 30):.5g})")
        cards.append(f"r{k} s{k} a{k} {ohms * draw.uniform(0.5, 2):.12g}")
        for side, ends in enumerate(((f"a{k}", "p"), ("m", f"a{k}"))):
            pulse = f"pulse(0 1 {draw.uniform(0.1, 0.9) / hertz:.6g} 0 0 {0.1 / hertz:.6g} {1 / hertz:.6g})"
            valve(cards, f"{k}{side}", *ends, latch, pulse)
    cards.append(f"rl p q {100 * ohms:.6g}")
    coil = draw.random() < 0.7
    cards.append(f"l1 q m {100 * ohms / hertz * draw.uniform(0.01, 1):.6g}" if coil else f"rm q m {ohms:.6g}")
    cards.append(f"rg m 0 {10 ** draw.uniform(-2, 8):.6g}")
    cards.append(f".model dx d(vfwd={draw.choice((0, 0.7, 1e-3 * volts)):.4g} ron={draw.choice((0, 1e-3)):g})")
    cards.append(f".model sx sw(vt=.5 vh=.1 ron={draw.choice((0, 1e-3, 1e-2))} roff={leak:.6g})")
    return "\n".join([*cards, f".tran {0.01 / hertz:.6g} {2.2 / hertz:.6g} uic", ".end", ""])


def look_at_bridges(checker):
    for seed in some_of(BRIDGES, 1):
        outcome = run(sys.argv[1], bridge(seed), method=None, options=["--audit", "full"])
        if checker.check(outcome.status == 0, f"bridge {seed}: {outcome.stderr[:300]}"):
            euler = outcome.report["work"]["euler_steps"]
            checker.check(euler == 0, f"bridge {seed}: {euler} steps by euler")


def main():
    checker = Checker("floating_islands")
    for name, (height, rise, forward, henries, resistors, node, back) in CASES.items():
        outcome = run(sys.argv[1], netlist(name, height, rise, forward, henries, resistors, node, back), method=None)
        if not checker.check(outcome.status == 0, f"{name}: {outcome.stderr[:300]}"):
            continue
        euler = outcome.report["work"]["euler_steps"]
        checker.check(euler == 0, f"{name}: {euler} steps by euler")
        start = rise * forward / height
        events = [(e["time"], e["element"], e["state"]) for e in outcome.report["events"]]
        # a diode without current may be on either side
        found = [t for t, element, state in events if element == "d7"]
        if checker.check(len(found) == 1, f"{name}: {events}"):
            checker.close(found[0], start, 1e-11 * rise, f"{name}: d7 closes")
        most = height / rise * (rise - start) ** 2 / (2 * henries)
        for t, coil, diode in zip(outcome.time, outcome.column("i(l9)"), outcome.column("i(d7)")):
            wanted = height / rise * max(0.0, t - start) ** 2 / (2 * henries)
            checker.close(coil, wanted, 1e-8 * most, f"{name}: i(l9) at {t!r}")
            checker.close(diode, wanted, 1e-8 * most, f"{name}: i(d7) at {t!r}")
    look_at_bridges(checker)
    return checker.finish()


sys.exit(main())
