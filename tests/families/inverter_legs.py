#!/usr/bin/env python3
"""Inverters with any number of legs: the currents of coils in closed form, and rectifiers behind filters.

usage: inverter_legs.py PROGRAM [MOST_SWITCHES]

A leg is two switches with a diode across each, of which a sine above or below a triangle closes one. So its output is
at one rail or the other, whatever its current does. The loads R and L of all legs meet in a star that nothing else
is connected to; a single leg has its load to half the supply. Between two commands each current is an exponential.

Or each leg has a filter, L C L with its capacitor in the star, and all of them one rectifier. The star makes the sum of
the capacitors' currents 0 in every mode. So no mode leaves the states free, and after each command and each event they
have to be where the mode allows. What tells that is a part of the map that a step has anyhow: with another map for it
there were half as many again.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import IS_LONG, Checker, run  # noqa: E402

SUPPLY, DEPTH, PERIOD, OF_SINE, STOP = 600.0, 0.8, 1e-4, 50.0, 8e-3
RESISTANCE, INDUCTANCE = 10.0, 5e-3
MODELS = {"ideal": ".model sp sw(vt=0 vh=0)\n.model di d",
          "with Ron": ".model sp sw(ron=1m roff=1meg vt=0 vh=0)\n.model di d(ron=1m roff=1meg)"}
# What is allowed by default of a current, over its largest value, and what 1 mOhm beside 10 Ohm makes of it.
TOLERANCES = {"ideal": 1e-9, "with Ron": 3e-4}
# Factorizations for each mode of six switches with Ron: 3.8, and 4.7 where a map gives the jump of the states.
MOST_FACTORED = 4.2


def phase(leg, legs):
    return 2 * math.pi * leg / legs + 0.1


def coil(k, star):
    return [f"r{k} h{k} m{k} {RESISTANCE!r}", f"l{k} m{k} {star} {INDUCTANCE!r}"]


def rectifier(node):
    return [f"dc_{node} {node} o di", f"dd_{node} m {node} di"]


def filter_of(k, star):
    return [f"l{k} h{k} f{k} 1m", f"c{k} f{k} {star} 10u", f"lb{k} f{k} g{k} 0.2m", *rectifier(f"g{k}")]


def inverter(legs, models, loads):
    star = "s" if legs > 1 else "half"
    lines = ["inverter", MODELS[models], f"vd p 0 {SUPPLY!r}",
             f"vt t 0 pulse(-1 1 0 {PERIOD / 2!r} {PERIOD / 2!r} 1f {PERIOD!r})"]
    if legs == 1:
        lines += [f"vh half 0 {SUPPLY / 2!r}"]
    if loads is filter_of:
        lines += ["co o m 100u", "ro o m 50"] + (rectifier(star) if legs == 1 else [])
    for k in range(legs):
        degrees = -math.degrees(phase(k, legs))
        lines += [f"vr{k} r{k} 0 sin(0 {DEPTH} {OF_SINE!r} 0 0 {degrees!r})",
                  f"sa{k} p h{k} r{k} t sp", f"sb{k} h{k} 0 t r{k} sp",
                  f"da{k} h{k} p di", f"db{k} 0 h{k} di", *loads(k, star)]
    return "\n".join(lines + [f".tran 1u {STOP!r} uic", ""])


def excess(leg, legs, t):
    """The sine over the triangle, whose flat top of 1 fs is of no length here."""
    place = math.fmod(t, PERIOD) / PERIOD
    triangle = 4 * place - 1 if place < 0.5 else 3 - 4 * place
    return DEPTH * math.sin(2 * math.pi * OF_SINE * t - phase(leg, legs)) - triangle


def commands(legs):
    """(time, leg, whether the upper switch closes): one in each half of a period, where the triangle is steeper than any
    sine."""
    found = []
    for leg in range(legs):
        for half in range(round(2 * STOP / PERIOD)):
            low, high = half * PERIOD / 2 * (1 + 1e-15), (half + 1) * PERIOD / 2 * (1 - 1e-15)
            for _ in range(60):
                middle = (low + high) / 2
                is_before = (excess(leg, legs, middle) > 0) == (half % 2 == 0)
                low, high = (middle, high) if is_before else (low, middle)
            found.append((low, leg, half % 2 == 1))
    return found


def exact(legs, at):
    """[leg][time]: each current goes to its limit, the voltage across its load over R."""
    upper = [excess(leg, legs, 1e-12) > 0 for leg in range(legs)]
    current = [0.0] * legs
    columns = [[] for _ in range(legs)]
    now = 0.0
    events = [(t, None, None) for t in at] + commands(legs)
    for t, leg, closes in sorted(events, key=lambda event: event[0]):
        star = SUPPLY * sum(upper) / legs if legs > 1 else SUPPLY / 2
        decay = math.exp(-(t - now) * RESISTANCE / INDUCTANCE)
        for k in range(legs):
            limit = (SUPPLY * upper[k] - star) / RESISTANCE
            current[k] = limit + (current[k] - limit) * decay
        now = t
        if leg is None:
            for k in range(legs):
                columns[k].append(current[k])
        else:
            upper[leg] = closes
    return columns


def check_coils(checker, program, switches, models):
    legs = switches // 2
    case = f"{switches} switches, {models}"
    at = [STOP * (k + 0.382) / 200 for k in range(200)]
    result = run(program, inverter(legs, models, coil), at=at, method=None, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
        return
    wanted = exact(legs, at)
    scale = max(abs(i) for column in wanted for i in column)
    worst = max(abs(a - b) for k in range(legs)
                for a, b in zip(result.column(f"i(l{k})"), wanted[k])) / scale
    print(f"{case}: {worst:.1e}, {result.report['work']['steps']} steps")
    checker.check(worst <= TOLERANCES[models], f"{case}: off by {worst:.1e} of the largest current")


def count_modes(events):
    """What follows upon the times of events: how many different sets of pairs are on."""
    on, modes, time = set(), set(), 0.0
    for event in events:
        if event["time"] > time:
            modes.add(frozenset(on))
        time = event["time"]
        (on.add if event["state"] == "on" else on.discard)(event["element"])
    return len(modes | {frozenset(on)})


def check_filters(checker, program, switches, models):
    case = f"{switches} switches, {models}, rectifier"
    result = run(program, inverter(switches // 2, models, filter_of), method=None, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{case}: {result.stderr}"):
        return
    work = result.report["work"]
    modes = count_modes(result.report["events"])
    factored = work["factorizations"] / modes
    print(f"{case}: {work['steps']} steps, {modes} modes, {factored:.1f} factorizations for each")
    if (switches, models) == (6, "with Ron"):
        checker.check(factored <= MOST_FACTORED, f"{case}: {factored:.1f} factorizations for each mode")


def main():
    program = sys.argv[1]
    most = int(sys.argv[2]) if sys.argv[2:] else 36 if IS_LONG else 12
    checker = Checker("inverter legs")
    for models in MODELS:
        for switches in (n for n in (2, 6, 12, 36) if n <= most):
            check_coils(checker, program, switches, models)
            check_filters(checker, program, switches, models)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
