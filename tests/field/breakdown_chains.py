#!/usr/bin/env python3
"""Gaps that break down one after the other in no time, each by what the one before has done.

usage: breakdown_chains.py PROGRAM

The first gap of a Marx generator closes, its voltage falls below what keeps it closed, and the others are above what
closes them, all at once. Which is first is what vanishing stray capacitances tell: the gap that reaches its threshold
first on the way. So each circuit is compared with itself with strays of a millionth, in which every event has a time of
its own; they change the times of breakdown by about as much.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

STRAY = 1e-6      # over the capacitor beside it
ALLOWED = 1e-4    # relative, of times from the start on


def held_by_voltage(strike, quench, ron):
    """A gap a-b between nodes; the quenching voltage is that of the gap itself."""
    def gap(k, a, b, more):
        return [f"s{k} {a} {b} {a} {b} gap{k}",
                f".model gap{k} sw(vt={(strike * more + quench) / 2!r} vh={(strike * more - quench) / 2!r} ron={ron!r} roff=1g)"]
    return gap


def held_by_current(strike, hold, ron):
    def gap(k, a, b, more):
        return [f"vi{k} {a} y{k} 0", f"s{k} y{k} {b} q{k} 0 gap{k}",
                f"bq{k} q{k} 0 v=(abs(v({a},{b}))>{strike * more!r} | abs(i(vi{k}))>{hold!r}) ? 1 : 0",
                f".model gap{k} sw(vt=0.5 vh=0.1 ron={ron!r} roff=1g)"]
    return gap


def marx(n, volts, r, c, load, gap):
    """Strays at all nodes that no capacitor holds."""
    cards = [f"v1 in 0 {volts!r}", f"rc in a1 {r!r}", f"c1 a1 0 {c!r}"]
    for k in range(2, n + 1):
        cards += [f"c{k} a{k} b{k} {c!r}", f"ra{k} a{k - 1} a{k} {r!r}", f"rb{k} {f'b{k - 1}' if k > 2 else 0} b{k} {r!r}"]
    for k in range(1, n + 1):
        cards += gap(k, f"a{k}", f"b{k + 1}" if k < n else "out", 1.0 if k == 1 else 1.2)
    cards += [f"rl out 0 {load!r}", f"cp out 0 {c / 1000!r}"]
    return cards, [f"{x}{k}" for x in "ab" for k in range(2, n + 1)], c


def string(n, volts, r, c, load, gap):
    """Gaps in series with resistors across them that share the voltage unequally, over a capacitor that is charged."""
    cards = [f"v1 in 0 {volts!r}", f"rc in m0 {r!r}", f"c1 m0 0 {c!r}"]
    for k in range(1, n + 1):
        b = f"m{k}" if k < n else "out"
        cards += [f"rg{k} m{k - 1} {b} {10 * r * (1.0 - 0.05 * k)!r}", *gap(k, f"m{k - 1}", b, 1.0)]
    return [*cards, f"rl out 0 {load!r}"], [*(f"m{k}" for k in range(1, n)), "out"], c


# circuit, gaps, V, ohm, F, ohm of the load, the gap, stop in s
CASES = {
    "two of 10 kV": (marx, 2, 12e3, 1e5, 1e-8, 500.0, held_by_voltage(1e4, 200.0, 1.0), 5.7e-3),
    "four of 10 kV": (marx, 4, 12e3, 1e5, 1e-8, 500.0, held_by_voltage(1e4, 200.0, 1.0), 14.2e-3),
    "five of 40 V": (marx, 5, 50.0, 1e4, 1e-9, 100.0, held_by_voltage(40.0, 1.0, 0.1), 143.6e-6),
    "three of 10 kV, held by current": (marx, 3, 12e3, 1e5, 1e-8, 500.0, held_by_current(1e4, 0.5, 1.0), 30e-3),
    "six of 10 kV, held by current": (marx, 6, 12e3, 1e5, 1e-8, 500.0, held_by_current(1e4, 0.5, 1.0), 35e-3),
    "a string of two": (string, 2, 600.0, 1e4, 1e-7, 10.0, held_by_voltage(130.0, 2.0, 1.0), 1.5e-3),
    "a string of four": (string, 4, 600.0, 1e4, 1e-7, 10.0, held_by_voltage(110.0, 1.0, 0.5), 1.5e-3),
}


def breakdowns(checker, what, cards, stop):
    outcome = run(sys.argv[1], "\n".join([what, *cards, f".tran {stop / 1000!r} {stop!r} uic", ".end", ""]), method=None,
                  options=["--audit", "full"])
    if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr[:300]}"):
        return None, []
    return outcome, [e["time"] for e in outcome.report["events"] if e["element"] == "s1" and e["state"] == "on"]


def main():
    checker = Checker("breakdown_chains")
    for what, (circuit, n, volts, r, c, load, gap, stop) in CASES.items():
        cards, nodes, beside = circuit(n, volts, r, c, load, gap)
        outcome, times = breakdowns(checker, what, cards, stop)
        strays = [f"cs{node} {node} 0 {STRAY * beside!r}" for node in nodes]
        _, wanted = breakdowns(checker, f"{what}, with strays", [*cards, *strays], stop)
        if outcome is None:
            continue
        n_euler = outcome.report["work"]["euler_steps"]
        checker.check(n_euler == 0, f"{what}: {n_euler} steps of implicit Euler")
        checker.check("did not agree" not in outcome.stderr, f"{what}: {outcome.stderr[:300]}")
        if checker.check(len(times) == len(wanted) > 0, f"{what}: {len(times)} breakdowns, not {len(wanted)}"):
            for time, right in zip(times, wanted):
                checker.close(time, right, ALLOWED * right, f"{what}: a breakdown")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
