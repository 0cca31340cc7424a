#!/usr/bin/env python3
"""Capacitors that ideal switches join one after the other: the response against sampled-data formulas.

The orbit is at rest: all capacitors have one voltage, and nothing jumps. A small signal leaves them at voltages that differ,
and at each instant at which a switch closes charge passes. The first capacitor follows the source while its switch is
closed; the last one holds what it has until its own switch closes again.

usage: shared_charge.py PROGRAM
"""

import cmath
import collections
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402
from tian import solve  # noqa: E402

NEAR = 1e-9
FRACTIONS = (1e-3, 0.03, 0.2, 0.41, 0.77, 1.6)  # of the frequency of the clock

# store: F, of each capacitor; begin: parts of the period at which the switches close; wide: how long they stay closed
Chain = collections.namedtuple("Chain", "name level period wide store begin extra")

CHAINS = [
    Chain("one to three", 1.0, 10e-6, 0.4, (1e-6, 3e-6), (0.0, 0.5), ""),
    Chain("picofarads", 3.3, 100e-9, 0.3, (1e-12, 0.4e-12), (0.1, 0.55), ""),
    Chain("a large one behind", 400.0, 1e-3, 0.45, (1e-6, 100e-6), (0.02, 0.5), ""),
    Chain("at once behind each other", 5.0, 20e-6, 0.5, (10e-9, 22e-9), (0.0, 0.5), ""),
    Chain("three, forward", 12.0, 5e-6, 0.2, (1e-9, 2e-9, 3e-9), (0.05, 0.35, 0.65), ""),
    Chain("three, backward", 12.0, 5e-6, 0.2, (1e-9, 2e-9, 3e-9), (0.65, 0.35, 0.05), ""),
    Chain("four", -2.0, 40e-6, 0.15, (1e-6, 0.5e-6, 2e-6, 0.1e-6), (0.0, 0.25, 0.5, 0.75), ""),
    Chain("beside a filter", 1.0, 10e-6, 0.3, (1e-6, 1e-6), (0.1, 0.6), "R9 in f 10\nC9 f 0 1u\n"),
    Chain("behind a buffer", 1.0, 10e-6, 0.3, (1e-6, 4e-6), (0.1, 0.6), "buffer"),
    Chain("no load but a gigaohm", 1.0, 10e-6, 0.4, (1e-6, 3e-6), (0.0, 0.5), "R9 in 0 1g\n"),
]


def netlist(chain):
    first = "in"
    text = f"* {chain.name}\nVin in 0 DC {chain.level} AC 1\n"
    if chain.extra == "buffer":
        text += "E9 buf 0 in 0 1\n"
        first = "buf"
    else:
        text += chain.extra
    nodes = [first] + [f"n{k}" for k in range(len(chain.store))]
    for k, (store, begin) in enumerate(zip(chain.store, chain.begin)):
        text += (f"Vg{k} g{k} 0 PULSE(0 1 {begin * chain.period!r} 0 0 {chain.wide * chain.period!r} {chain.period!r})\n"
                 f"S{k} {nodes[k]} {nodes[k + 1]} g{k} 0 sm\nC{k} {nodes[k + 1]} 0 {store!r}\n")
    asked = " ".join(repr(part / chain.period) for part in FRACTIONS)
    return text + f".model sm SW(Ron=0 Vt=0.5)\n.save v({nodes[-1]})\n.pss uic\n.ac list {asked}\n.end\n"


def expected(chain, w):
    """Voltages are rows over those at t = 0 and, last, what the source adds."""
    n, period = len(chain.store), chain.period
    now = [[complex(i == k) for k in range(n + 1)] for i in range(n)]
    kept = None
    for k in sorted(range(n), key=lambda k: chain.begin[k]):
        if k == 0:
            now[0] = [0j] * n + [cmath.exp(1j * w * (chain.begin[0] + chain.wide) * period)]
        else:
            both = chain.store[k - 1] + chain.store[k]
            now[k] = now[k - 1] = [(chain.store[k - 1] * x + chain.store[k] * y) / both for x, y in zip(now[k - 1], now[k])]
        kept = now[k] if k == n - 1 else kept
    turn = cmath.exp(1j * w * period)
    start = solve([[now[i][k] - turn * (i == k) for k in range(n)] for i in range(n)], [-now[i][n] for i in range(n)])
    held = sum(x * y for x, y in zip(kept, start + [1.0]))
    return held * cmath.exp(-1j * w * chain.begin[n - 1] * period) * (1 - 1 / turn) / (1j * w * period)


def check_chains(name, chains, netlist_of):
    checker = Checker(name)
    for chain in chains:
        done = run(sys.argv[1], netlist_of(chain), method=None)
        if not checker.check(done.status == 0, f"{chain.name}: status {done.status}\n{done.stderr}"):
            continue
        for row, part in zip(done.rows, FRACTIONS):
            value = complex(row[1], row[2])
            right = expected(chain, 2 * math.pi * part / chain.period)
            checker.check(abs(value - right) <= NEAR, f"{chain.name} at {part}: {value}, not {right}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(check_chains("shared_charge", CHAINS, netlist))
