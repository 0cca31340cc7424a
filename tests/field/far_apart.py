#!/usr/bin/env python3
"""Milliohms beside gigaohms: what only leaks hold, to all digits; and carriers that meet their reference at t = 0.

usage: far_apart.py PROGRAM

KCL adds up conductances. Of 1000 S and 1e-9 S the sum is off by 1e-13 S, which is a resistor to ground that is not
there: a divider of two leaks was off by 3e-5 of its voltage, two coils in series with a leak rose to 1e240 A, and an
island had a voltage that nothing gave it. Resistors that conduct 2.7e8 times as well as the least conductor of their
part have their current as an unknown.

Times closer than the resolution of a run are one: a carrier and a reference that are both 0 at t = 0 cross at 1e-21 s
by rounding.
"""

import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

INNER = 3e-8  # what the default tolerance leaves to a step, to which the limit is derived
LIMIT = INNER / 2.0 ** -53


def outcome_of(checker, name, cards):
    outcome = run(sys.argv[1], "\n".join([name, *cards, ".end", ""]), method=None, options=["--audit", "full"])
    return outcome if checker.check(outcome.status == 0, f"{name}: {outcome.stderr}") else None


def divider(checker, seed):
    """A chain of resistors between a leak to the supply and one to ground."""
    chance = random.Random(f"divider {seed}")
    ohms = 10.0 ** chance.uniform(-4, 1)
    leaks = [10.0 ** chance.uniform(7, 12) for _ in range(2)]
    n = chance.randint(1, 4)
    cards = ["v1 in 0 600", f"r1 in n0 {leaks[0]!r}", f"r2 n{n} 0 {leaks[1]!r}"]
    cards += [f"ra{k} n{k} n{k + 1} {ohms * chance.uniform(0.5, 2)!r}" for k in range(n)]
    if seed % 3 == 1:
        cards[1] = f"s1 in n0 0 0 m\n.model m SW(ron=1m roff={leaks[0]!r} vt=0.5)"
    if seed % 3 == 2:
        cards[2] = f"d1 0 n{n} m\n.model m D(ron=1m roff={leaks[1]!r})"
    outcome = outcome_of(checker, f"divider {seed}", cards + [".save v(n0)", ".tran 1u 10u"])
    if outcome:
        wanted = 600.0 * leaks[1] / (leaks[0] + leaks[1])
        checker.close(outcome.column("v(n0)")[-1], wanted, INNER * 600.0, f"divider {seed}: v(n0)")


def two_coils(checker, seed):
    """What leaks through a diode flows through two coils and two resistors: I (1 - exp(-t R/L)), and stays."""
    chance = random.Random(f"coils {seed}")
    ohms = [10.0 ** chance.uniform(-5, 0) for _ in range(2)]
    leak = 10.0 ** chance.uniform(5, 7)
    around = leak + sum(ohms)
    cards = ["c1 o m 1 ic=1", "l1 o y 1", f"d1 m a leaky\n.model leaky D(ron=1m roff={leak!r})", "l2 a x 1",
             f"r1 x b {ohms[0]!r}", f"r2 b y {ohms[1]!r}", ".save i(l1)", ".tran 2u 400u uic"]
    outcome = outcome_of(checker, f"coils {seed}", cards)
    if outcome:
        for t, x in zip(outcome.time, outcome.column("i(l1)")):
            checker.close(x, (1.0 - math.exp(-t * around / 2.0)) / around, 1e-6 / around, f"coils {seed}: i(l1) at {t}")


def unknowns(cards):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "circuit.cir"
        path.write_text("\n".join(["sizes", *cards, ".end", ""]))
        done = subprocess.run([sys.argv[1], "check", str(path), "--json"], capture_output=True, text=True, check=True)
    return sum(part["size"]["algebraic"] for part in json.loads(done.stdout)["parts"])


def limit(checker):
    """An unknown more from the limit on, and none before."""
    def of(ratio):
        return unknowns(["v1 in 0 1", "r1 in a 1", f"r2 a 0 {ratio!r}", "d1 a 0", ".tran 1u 1m"])
    checker.check(of(1.001 * LIMIT) == of(0.999 * LIMIT) + 1, "the limit is where it is derived to be")
    checker.check(of(0.1 * LIMIT) == of(1.0), "resistors that are not far apart are no unknowns")


def dead_end(checker):
    """1 ohm and a leak behind a diode that blocks: an island without current, wherever it is."""
    for ohms in ("1", "14.7m", "3.3", "470"):
        cards = [f"r1 x d {ohms}", "s1 d out 0 g m", "vg g 0 1", "d1 c out", "c1 c y 1 ic=1", "l1 y 0 10u",
                 ".model m SW(ron=0.1 roff=1e8)", ".save v(c) i(l1)", ".tran 5.3n 1.06u uic"]
        outcome = outcome_of(checker, f"a dead end of {ohms}", cards)
        if outcome:
            checker.close(outcome.column("v(c)")[-1], 1.0, 1e-9, f"a dead end of {ohms}: v(c)")
            checker.close(outcome.column("i(l1)")[-1], 0.0, 1e-12, f"a dead end of {ohms}: i(l1)")


def island(checker, seed):
    """Coils and resistors that hang on a sine by one node: KCL of the island adds up to 0, and so does its answer."""
    chance = random.Random(f"island {seed}")
    ohms = [10.0 ** chance.uniform(-4, -2), 10.0 ** chance.uniform(0, 2)]
    cards = ["v1 as n sin(0 50 97)", "l1 n b 1", "s1 t p g 0 m", "vg g 0 0", "va b x 0", "vb a y 0", "d1 y b", "l2 p q 1",
             f"r1 q o {ohms[0]!r}", f"r2 o a {ohms[1]!r}", ".model m sw(ron=1m vt=0.5 vh=0.3)", ".save i(l1) i(l2)",
             ".tran 33.4u 6.69m uic"]
    outcome = outcome_of(checker, f"island {seed}", cards)
    if outcome:
        for name in ("i(l1)", "i(l2)"):
            checker.close(max(map(abs, outcome.column(name))), 0.0, 1e-9, f"island {seed}: {name}")


def meeting(checker, seed):
    """Legs whose carrier, some quarter of a period late, and whose sine are 0 at the start; half of the gates are
    formulas. The currents begin at 0 and stay within what the supply can drive."""
    chance = random.Random(f"meeting {seed}")
    period = 10.0 ** chance.uniform(-6, -3)
    hertz = 1.0 / (period * chance.uniform(7, 13))
    size = chance.choice((0.3, 1.0)) * chance.choice((-1, 1))
    cells = chance.randint(1, 4)
    cards = [f"vr ref 0 sin(0 {size * 0.7!r} {hertz!r})", "v1 in 0 100"]
    for k in range(cells):
        quarter = chance.choice((0.25, 0.75))
        ramp, peak = period / 2, abs(size)
        cards += [f"vt{k} t{k} 0 pulse({-peak!r} {peak!r} {-quarter * period!r} {ramp!r} {ramp!r} "
                  f"{1e-9 * period!r} {period * (1 + 1e-9)!r})"]
        gate = (f"ref t{k}", f"t{k} ref")
        if chance.random() < 0.5:
            cards += [f"bg{k} g{k} 0 v=v(ref)>v(t{k}) ? 1 : -1"]
            gate = (f"g{k} 0", f"0 g{k}")
        cards += [f"s{k}a in a{k} {gate[0]} m", f"da{k} a{k} in", f"s{k}b a{k} 0 {gate[1]} m", f"db{k} 0 a{k}",
                  f"l{k} a{k} b{k} {period * 5!r}", f"r{k} b{k} 0 1"]
    cards += [".model m SW(ron=1m roff=1e8)", ".save " + " ".join(f"i(l{k})" for k in range(cells)),
              f".tran {period / 50!r} {3.3 * period!r} uic"]
    outcome = outcome_of(checker, f"meeting {seed}", cards)
    if outcome:
        for k in range(cells):
            checker.check(abs(outcome.column(f"i(l{k})")[0]) < 1e-9, f"meeting {seed}: i(l{k}) begins at 0")
            checker.check(all(-1e-3 < x < 100.0 for x in outcome.column(f"i(l{k})")), f"meeting {seed}: i(l{k})")
        first = [e["time"] for e in outcome.report["events"]]
        checker.check(not [t for t in first if 0.0 < t < 1e-12 * period], f"meeting {seed}: events at {first[:2]}")


def main():
    checker = Checker("far_apart")
    for seed in range(24):
        divider(checker, seed)
    for seed in range(16):
        two_coils(checker, seed)
    limit(checker)
    dead_end(checker)
    for seed in range(12):
        island(checker, seed)
    for seed in range(16):
        meeting(checker, seed)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
