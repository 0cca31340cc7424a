#!/usr/bin/env python3
"""A ladder of diodes keeps conducting when its source has left it: its currents die away, and end never.

usage: ladders.py PROGRAM

A sine of 10 V and 1 kHz feeds sections, each a diode, 1 ohm and 1 uF with 10 kohm. All diodes close from
rest; the first opens near the crest, closes in the next period, and opens again. What the others carry
meanwhile equalises their capacitors within some 25 us (8 sections), goes down to 1e-20 A, which no number
tells from nothing, and is positive still: they neither open nor close again, at any tolerance, and the
wave of the next period finds them closed. The reference is an integration by the classical Runge-Kutta
method of 4th order, in steps of 25 ns and cut where the first diode changes sides; halving them changes
it by 3e-12 V.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import runge_kutta  # noqa: E402
from dalcs_program import Checker, run, some_of  # noqa: E402

R, C, LOAD, VOLTS, HERTZ, STOP = 1.0, 1e-6, 1e4, 10.0, 1e3, 2e-3
STEP = 25e-9
ROWS = [50e-6 * k for k in range(1, 40)]
TOLERANCES = ["1e-3", "1e-5", "1e-6", "1e-7", "1e-8", "1e-9", "1e-10"]
REFERENCE = 1e-9  # it is as exact as this, over 10 V


def netlist(n):
    lines = [f"ladder of {n} diodes", f"v1 n0 0 sin(0 {VOLTS:g} {HERTZ:g})"]
    for k in range(1, n + 1):
        lines += [f"d{k} n{k - 1} m{k}", f"r{k} m{k} n{k} {R:g}", f"c{k} n{k} 0 {C:g}",
                  f"rl{k} n{k} 0 {LOAD:g}"]
    return "\n".join([*lines, f".tran 10u {STOP:g} uic", ".end", ""])


def rates(t, v, is_fed):
    source = VOLTS * math.sin(2.0 * math.pi * HERTZ * t)
    current = [(source - v[0]) / R if is_fed else 0.0]
    current += [(a - b) / R for a, b in zip(v, v[1:])] + [0.0]
    return [(current[k] - current[k + 1] - x / LOAD) / C for k, x in enumerate(v)]


def step(t, h, v, is_fed):
    return runge_kutta.step(lambda t, v: rates(t, v, is_fed), t, v, h)


def drop(t, v):
    return VOLTS * math.sin(2.0 * math.pi * HERTZ * t) - v[0]


def integrate(n):
    """Voltages at ROWS, and when the first diode changes sides."""
    v, is_fed, t, found, rows = [0.0] * n, True, 0.0, [], []
    per_row = round(ROWS[0] / STEP)
    for row in range(len(ROWS)):
        for k in range(per_row):
            begin, end = ROWS[0] * row + STEP * k, ROWS[0] * row + STEP * (k + 1)
            t, after = begin, step(begin, end - begin, v, is_fed)
            if end > STEP and (drop(end, after) > 0.0) != is_fed:
                low, high = 0.0, end - begin
                for _ in range(50):
                    middle = 0.5 * (low + high)
                    crossed = (drop(t + middle, step(t, middle, v, is_fed)) > 0.0) != is_fed
                    low, high = (low, middle) if crossed else (middle, high)
                v, t, is_fed = step(t, high, v, is_fed), t + high, not is_fed
                found.append(t)
                after = step(t, end - t, v, is_fed)
            v = after
        rows.append(v)
    return rows, found


def check_events(checker, label, events, exact):
    """Only the first diode opens. *exact: when it changes sides; None: not known."""
    first = [(e["state"], e["time"]) for e in events if e["element"] == "d1"]
    checker.check([state for state, _ in first] == ["off", "on", "off"], f"{label}: d1 {first}")
    others = [e["element"] for e in events if e["element"] != "d1"]
    again = sorted({name for name in others if others.count(name) > 1})
    checker.check(not again, f"{label}: {', '.join(again)} change sides again")
    for (_, found), wanted in zip(first, exact or []):
        checker.close(found, wanted, 1e-7 * STOP, f"{label}: d1")


def main():
    checker = Checker("ladders")
    exact_rows, exact_events = integrate(8)
    for n in (8, 12, 16):
        for tolerance in some_of(TOLERANCES):
            label = f"{n} sections, {tolerance}"
            result = run(sys.argv[1], netlist(n), at=ROWS, method=None, tolerance=tolerance)
            check_events(checker, label, result.report["events"], exact_events if n == 8 else None)
            if n > 8:
                continue
            allowed = VOLTS * max(float(tolerance), REFERENCE)
            for k in (1, 2, 8):
                worst = max(abs(found - row[k - 1])
                            for found, row in zip(result.column(f"v(n{k})"), exact_rows))
                checker.check(worst <= allowed, f"{label}: v(n{k}) off by {worst:.1e} V")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
