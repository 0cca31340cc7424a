#!/usr/bin/env python3
"""Inverters behind LCL filters into stars without a neutral, which megohms tie to the midpoint.

usage: filtered_inverters.py PROGRAM

What is left of the sum of the coils' currents is volts across a megohm, which no shorter step mends and nobody wants to
wait for. It must not be taken for a state that is off: no state moves at an event, and steps are not tried in vain.
"""

import pathlib
import random
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

LEGS = 3
SEEDS = (0, 3, 4, 7)
MOST_REJECTED = 0.1  # of all steps


def phase(k, n, values):
    cards = [f"vm{k} m{k} 0 sin(0 0.8 50 0 0 {-360 * k / n})", f"e{k} g{k} 0 m{k} t 1", f"s{k}a p h{k} g{k} 0 s",
             f"d{k}a h{k} p d", f"s{k}b h{k} 0 0 g{k} s", f"d{k}b 0 h{k} d"]
    at = f"h{k}"
    for stage, (coil, capacitor) in enumerate(values):
        end = f"y{k}{stage}"
        cards += [f"l{k}{stage} {at} x{k}{stage} {coil!r}", f"r{k}{stage} x{k}{stage} {end} 0.1",
                  f"c{k}{stage} {end} z{k}{stage} {capacitor!r}", f"rd{k}{stage} z{k}{stage} y 1"]
        at = end
    return cards + [f"ll{k} {at} x{k} 3m", f"rl{k} x{k} n 10"]


def netlist(seed):
    draw = random.Random(seed)
    values = [tuple(nominal * draw.uniform(0.6, 1.6) for nominal in pair) for pair in ((1.5e-3, 1e-5), (2e-4, 1e-6))]
    cards = ["vdc p1 0 600", "ldc p1 p2 20u", "rdc p2 p 20m", "cdc p q 500u", "rcd q 0 10m", "vmid d 0 300",
             "rmid d mid 1", "vt t 0 pulse(-1 1 0 50u 50u 1f 100u)"]
    for k in range(LEGS):
        cards += phase(k, LEGS, values)
    cards += ["rs y mid 1k", "rn n mid 1meg"]
    return "\n".join(["inverter", *cards, ".model s sw(ron=5m vt=0)", ".model d d(ron=5m)", ".tran 10u 8m uic", ".end", ""])


def main():
    program = sys.argv[1]
    checker = Checker("filtered_inverters")
    for seed in SEEDS:
        outcome = run(program, netlist(seed), method=None, options=["--audit", "full"])
        if checker.check(outcome.status == 0, f"{seed}: {outcome.stderr[:300]}"):
            work = outcome.report["work"]
            checker.check(work["euler_steps"] == 0, f"{seed}: {work['euler_steps']} steps of implicit Euler")
            checker.check(work["rejected"] <= MOST_REJECTED * work["steps"],
                          f"{seed}: {work['rejected']} of {work['steps']} steps were tried in vain")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
