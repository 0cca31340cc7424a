#!/usr/bin/env python3
"""A peak detector, or a cable of them, that reads the star point of coils: there the voltage jumps as switches act, and the
capacitors follow it at once.

usage: read_coils.py PROGRAM

Coils that end in a star without a neutral have v(y) = sum (v - r i) / l over sum 1 / l, whose currents go on through the
instant. Micro-steps know that voltage within l eps i / h, so that they are off by more the shorter they are; in longer ones
the peak has moved on.
"""

import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402


def netlist(legs, period, sections, volts, ohms):
    """Each leg goes to and fro between two sources."""
    cards = ["star of coils", ".model s sw(ron=0 vt=0.5)", ".model d d(ron=0)"]
    for k, leg in enumerate(legs):
        cards += [f"va{k} a{k} 0 sin(0 {volts} {leg['hertz']!r} 0 0 {leg['degrees']!r})", f"vb{k} b{k} 0 {leg['direct']!r}",
                  f"vg{k} g{k} 0 pulse(0 1 {leg['delay']!r} 0 0 {leg['width']!r} {leg['period']!r})",
                  f"sa{k} a{k} o{k} g{k} 0 s", f"vh{k} h{k} 0 1", f"eh{k} n{k} 0 h{k} g{k} 1", f"sb{k} b{k} o{k} n{k} 0 s",
                  f"l{k} o{k} m{k} {leg['henry']!r} ic=0", f"r{k} m{k} y {leg['ohm']!r}"]
    cards += ["e0 z 0 y 0 1"]
    for k in range(sections):
        before = f"z{k - 1}" if k else "z"
        cards += [f"dz{k} {before} z{k} d", f"rz{k} {before} z{k} {ohms!r}", f"cz{k} z{k} 0 {period / ohms / sections!r}"]
    names = [f"i(l{k})" for k in range(len(legs))]
    cards += [f".save v(y) v(z0) {' '.join(names)}", f".tran {period / 10!r} {5 * period!r} uic", ".end", ""]
    return "\n".join(cards), names


def legs_of(chance, n, period, volts, henries):
    legs = []
    for _ in range(n):
        henry = henries * 10.0 ** chance.uniform(-1, 1)
        own = period * chance.uniform(0.3, 1.7)
        legs.append({"hertz": chance.uniform(0.05, 0.3) / period, "degrees": chance.uniform(0, 360),
                     "direct": volts * chance.uniform(-1, 1), "delay": own * chance.uniform(0.05, 0.9),
                     "width": own * chance.uniform(0.2, 0.8), "period": own, "henry": henry,
                     "ohm": henry / period * 10.0 ** chance.uniform(-2, 0)})
    return legs


def source_at(leg, t, volts):
    """Just behind t, which is an edge of a leg or none."""
    since = (t - leg["delay"]) / leg["period"]
    edges = [0.0, leg["width"] / leg["period"]]
    phase = since - math.floor(since)
    for edge in edges + [1.0]:
        if abs(phase - edge) < 1e-9:
            phase = edge % 1.0
    if since > -1e-9 and phase < edges[1]:
        return volts * math.sin(2 * math.pi * leg["hertz"] * t + math.radians(leg["degrees"]))
    return leg["direct"]


def star_voltage(legs, currents, t, volts):
    weight = sum(1 / leg["henry"] for leg in legs)
    return sum((source_at(leg, t, volts) - leg["ohm"] * i) / leg["henry"] for leg, i in zip(legs, currents)) / weight


def check(checker, program, seed, n, period, volts, henries, sections):
    chance = random.Random(f"coils {seed}")
    legs = legs_of(chance, n, period, volts, henries)
    text, names = netlist(legs, period, sections, volts, 1e3 * henries / period)
    where = f"{n} legs, {sections} sections, {period} s, {volts} V, {henries} H"
    first = run(program, text, method=None, options=("--audit", "full"))
    if not checker.check(first.status == 0, f"{where}: {first.status}: {first.stderr}"):
        return 0
    times = [jump["time"] for jump in first.report["jumps"] if jump["time"] > 0.0 and "cz0" in jump["states"]]
    rows = run(program, text, method=None, at=times, options=("--audit", "off"))
    if not checker.check(rows.status == 0, f"{where}: {rows.status}: {rows.stderr}"):
        return 0
    for k, t in enumerate(times):
        wanted = star_voltage(legs, [rows.column(name)[k] for name in names], t, volts)
        got = next(j for j in first.report["jumps"] if j["time"] == t)["states"]["cz0"]["after"]
        checker.close(got, wanted, 1e-7 * volts, f"{where}: the peak at {t}")
    return len(times)


CASES = [(3, 1e-4, 600.0, 1e-2, 40), (3, 1e-4, 600.0, 1e-2, 1), (2, 1e-6, 12.0, 1e-6, 12), (4, 1.0, 1e4, 1.0, 24),
         (3, 1e-3, 1.0, 1e-3, 3), (5, 1e-5, 325.0, 1.0, 20), (3, 2e-2, 1e-3, 1e-5, 40), (2, 1e-4, 600.0, 10.0, 30)]


def main():
    checker = Checker("read_coils")
    n_jumps = 0
    for seed, case in enumerate(some_of(CASES)):
        n_jumps += check(checker, sys.argv[1], seed, *case)
    # in ever shorter micro-steps rounding of the coils' currents grows, and must not pass for the order of longer ones
    n_jumps += check(checker, sys.argv[1], 3, *CASES[3])
    checker.check(n_jumps > 10, f"only {n_jumps} jumps")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
