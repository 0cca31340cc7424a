#!/usr/bin/env python3
"""Two clocks whose edges meet, a gate of both, and a counter behind it: what it counts, against whole numbers.

usage: coincident_clocks.py PROGRAM [SEED COUNT]

Periods, delays and widths have common parts, so that many edges of one clock are edges of the other one. In binary
fractions they are a rounding apart. A gate between them must not show for no time what it has with one of them moved.
"""

import pathlib
import random
import sys
from fractions import Fraction

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

GATES = {"AND": lambda a, b: a and b, "OR": lambda a, b: a or b, "XOR": lambda a, b: a != b}


def drawn(seed):
    """(period in s, gate, periods, {clock: (delay, width, period) in periods of the first})"""
    rng = random.Random(f"coincident {seed}")
    parts = rng.choice([20, 50, 100])
    other = Fraction(rng.choice([37, 30, 33, 70, 7, 9, 11]), rng.choice([100, 10, 50]))
    clocks = {"c": (Fraction(rng.randint(1, parts - 1), parts), Fraction(rng.randint(1, parts // 2), parts), Fraction(1)),
              "f": (Fraction(rng.randint(1, parts - 1), parts), other * Fraction(rng.randint(1, 9), 10), other)}
    seconds = float(f"{10 ** rng.uniform(-7, 0):.3g}")
    return seconds, rng.choice(list(GATES)), Fraction(rng.randint(9, 15)) + Fraction(777, 1000), clocks


def edges_of(clocks, periods):
    edges = {}
    for name, (delay, width, period) in clocks.items():
        start = delay
        while start <= periods:
            edges.setdefault(start, {})[name] = True
            edges.setdefault(start + width, {})[name] = False
            start += period
    return {t: edges[t] for t in sorted(edges) if t <= periods}


def count(edges, gate):
    """(how often the gate's output rises, how many edges meet)"""
    at, shown, rises = {"c": False, "f": False}, False, 0
    for changes in edges.values():
        at.update(changes)
        now = GATES[gate](at["c"], at["f"])
        rises += now and not shown
        shown = now
    return rises, sum(len(changes) == 2 for changes in edges.values())


def netlist(seconds, gate, periods, clocks):
    cards = ["clocks whose edges meet"]
    for name, times in clocks.items():
        delay, width, period = (f"{float(t) * seconds:.15g}" for t in times)
        cards.append(f"V{name} {name} 0 PULSE(0 1 {delay} 0 0 {width} {period})")
    cards += [f"A1 f c 0 0 0 0 z 0 {gate}", "A2 z 0 0 0 0 0 k 0 COUNTER cycles=2 duty=0.5", "R1 k o 1k",
              f"C1 o 0 {1e-4 * seconds!r}", ".save v(k)",
              f".tran {float(periods) * seconds / 50!r} {float(periods) * seconds!r} uic", ".end", ""]
    return "\n".join(cards)


def main():
    checker = Checker("coincident_clocks")
    first, n = (int(a) for a in sys.argv[2:4]) if len(sys.argv) > 2 else (0, 40)
    met = 0
    for seed in some_of(range(first, first + n)):
        seconds, gate, periods, clocks = drawn(seed)
        rises, meetings = count(edges_of(clocks, periods), gate)
        if meetings == 0:
            continue
        met += 1
        for method, step in ((None, None), ("euler", seconds / 1000.0)):
            name = f"{seed}, {method or 'auto'}"
            outcome = run(sys.argv[1], netlist(seconds, gate, periods, clocks), method=method, step=step, report=False)
            if not checker.check(outcome.status == 0, f"{name}: exit {outcome.status}\n{outcome.stderr}"):
                continue
            shown = outcome.column("v(k)")
            counted = sum((a > 0.5) != (b > 0.5) for a, b in zip(shown, shown[1:]))
            checker.check(counted == rises, f"{name}: {gate} of clocks that meet {meetings} times has risen {rises} times, "
                                            f"{counted} were counted")
    checker.check(met > 0, "no clocks meet")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
