#!/usr/bin/env python3
"""Picofarads of diodes beside microfarads: steps grow again once what is fast is over, however it rounds.

usage: small_beside_large.py PROGRAM

Bridges with capacitors across their diodes, and a reservoir behind a resistor, on a common source: while one conducts the
others float, and their picofarads settle within picoseconds. Between two events steps may be as long as the sines allow.
A run of 2 ms takes up to 2000 steps; 20000 are allowed, and millions were taken.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

ALLOWED = 20000

# reservoirs, capacitors of diodes, resistance, load
CASES = [
    (["470u", "220u", "220u"], "5p", "1", "1k"),
    (["22u", "220u"], "30p", "1", "1k"),
    (["4.7u", "220u", "220u"], "30p", "0.1", "1k"),
    (["2.2u", "100u"], "100p", "1", "10k"),
    (["10u", "22u", "47u"], "100p", "10", "1k"),
    (["1u", "470u", "1u"], "1p", "1", "100"),
    (["220u", "100u"], "100p", "1", "10k"),
    (["1u", "47u", "10u"], "30p", "1", "1k"),
]


def bridge(k, reservoir, small, resistance, load):
    ends = (("p", f"m{k}"), (f"n{k}", "p"), ("0", f"m{k}"), (f"n{k}", "0"))
    cards = [f"d{k}{i} {a} {b}\nc{k}{i} {a} {b} {small}" for i, (a, b) in enumerate(ends)]
    return cards + [f"r{k} m{k} o{k} {resistance}", f"cr{k} o{k} n{k} {reservoir}", f"rl{k} o{k} n{k} {load}"]


def three_bridges():
    """The first one that was seen, with a load of four resistors."""
    cards = ["v1 a 0 sin(0 5 1k)", "v2 b a sin(0 2 2k)", "v3 b p sin(0 1 3k)"]
    for k, reservoir in enumerate(("1u", "10u", "100u")):
        cards += bridge(k, reservoir, "12p", "1", "1t")
        cards += [f"ra{k} o{k} e{k} 200", f"rb{k} e{k} f{k} 300", f"rc{k} f{k} g{k} 400", f"rd{k} g{k} n{k} 100"]
    return cards


def fixed_mode(longest):
    """Two that float, without diodes: the current of each resistor is what 12 pF and 586 or 58.6 V/s make of it."""
    cards = ["v1 p 0 sin(0 5 1k)"]
    for k, reservoir in enumerate(("10u", "100u")):
        cards += [f"c{k}0 p m{k} 12p ic=-2.93", f"c{k}1 n{k} p 12p ic=-2.93", f"c{k}2 0 m{k} 12p ic=-2.93",
                  f"c{k}3 n{k} 0 12p ic=-2.93", f"r{k} m{k} o{k} 1", f"cr{k} o{k} n{k} {reservoir} ic=5.86",
                  f"rl{k} o{k} n{k} 1k"]
    return cards + [".save i(r0) i(r1)", f".tran {longest!r} {2000 * longest!r} 0 {longest!r} uic"]


def steps(checker, name, cards, allowed):
    outcome = run(sys.argv[1], "\n".join([name, *cards, ".end", ""]), method=None)
    if checker.check(outcome.status == 0, f"{name}: {outcome.stderr}"):
        work = outcome.report["work"]
        found = work["steps"] + work["rejected"]
        checker.check(found <= allowed, f"{name}: {found} steps")
    return outcome


def main():
    checker = Checker("small_beside_large")
    sources = ["v1 a 0 sin(0 5 1k)", "v2 b a sin(0 2 2k)", "v3 p b sin(0 1 3k)"]
    for reservoirs, small, resistance, load in CASES:
        name = f"{' '.join(reservoirs)} beside {small}"
        cards = [card for k, c in enumerate(reservoirs) for card in bridge(k, c, small, resistance, load)]
        steps(checker, name, sources + cards + [".tran 100n 2m"], ALLOWED)
    steps(checker, "three bridges", three_bridges() + [".tran 100n 5m"], ALLOWED)
    # 2000 steps are asked for; 8000 and as many that were refused were taken
    for longest in (9.46e-11, 2e-10, 1e-9):
        outcome = steps(checker, f"no diode, {longest} s", fixed_mode(longest), 4000)
        for k, rate in enumerate((586.0, 58.6)):
            checker.close(outcome.rows[-1][outcome.names.index(f"i(r{k})")], 12e-12 * rate, 1e-12 * rate,
                          f"no diode, {longest} s: i(r{k})")
    return checker.finish()


sys.exit(main())
