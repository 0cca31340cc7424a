#!/usr/bin/env python3
"""A source that floats behind diodes until it drives a current through them, with resistors that lead nowhere.

usage: floating_islands.py PROGRAM

Two diodes in series close the circuit of a ramp and a coil through ground. Up to the forward voltage of one nothing
flows: the only conductances are those of resistors that lead nowhere, and what the digits of their voltages make of
currents is no current, of neither sign. From then on i = slope (t - t0)^2 / (2 L), up to the ramp's end.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

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
    return checker.finish()


sys.exit(main())
