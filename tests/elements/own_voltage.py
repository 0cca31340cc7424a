#!/usr/bin/env python3
"""Resistances by formulas of their own voltage, against the current that they are.

usage: own_voltage.py PROGRAM

A resistance R(v) that is 0 at 0 V has a second root there, with any current: a charged capacitor across it must not jump to
0 V. Each circuit is run with R= and with a source of the current v / R(v): the waveforms agree, and nothing jumps."""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

SUPPLY = "v1 i 0 24\nrs i o 0.1\nc1 o 0 100u ic=20\n"
FLOATING = "v1 i 0 10\nra i p 2\nrb q 0 3\nc1 p q 1u ic=5\n"
MAINS = "v1 a b sin(0 325 50)\nd1 a o\nd2 b o\nd3 0 a\nd4 0 b\nrg b 0 1meg\nc1 o 0 100u ic=300\n.model d d\n"
SMALL = "v1 i 0 pulse(1m 2m 1u 1n 1n 5u 20u)\nrs i o 10\nc1 o 0 10n ic=1.5m\n"
# What feeds it, the card with R=, the same as a current, the stop time, the node, how near.
CASES = {
    "constant power": (SUPPLY, "r1 o 0 r=v(o)*v(o)/60", "b1 o 0 i=60/v(o)", 1e-4, "o"),
    "constant power above 6 V": (SUPPLY, "r1 o 0 r=if(v(o)>=6,v(o)*v(o)/60,0.6)",
                                 "b1 o 0 i=if(v(o)>=6,60/v(o),v(o)/0.6)", 1e-4, "o"),
    "written the other way round": (SUPPLY, "r1 0 o {v(o)*v(o)/60}", "b1 o 0 i=60/v(o)", 1e-4, "o"),
    "the larger of two": (SUPPLY, "r1 o 0 r=max(v(o)*v(o)/60,0.6)", "b1 o 0 i=min(60/v(o),v(o)/0.6)", 1e-4, "o"),
    "constant current": (SUPPLY, "r1 o 0 r=v(o)*2", "b1 o 0 i=0.5", 1e-4, "o"),
    "three in parallel": (SUPPLY, "r1 o 0 r=v(o)*6 m=3", "b1 o 0 i=0.5", 1e-4, "o"),
    "two nodes": (FLOATING, "r1 p q r=v(p,q)*v(p,q)*20", "b1 p q i=0.05/v(p,q)", 2e-5, "p"),
    "two nodes apart": (FLOATING, "r1 p q r=(v(p)-v(q))*10", "b1 p q i=0.1", 2e-5, "p"),
    "a varistor": (FLOATING, "r1 p q r=100/(1+v(q,p)**2)", "b1 p q i=v(p,q)*(1+v(p,q)**2)/100", 2e-5, "p"),
    "behind a bridge": (MAINS, "r1 o 0 r=v(o)**2/100", "b1 o 0 i=100/v(o)", 2e-2, "o"),
    "millivolts": (SMALL, "r1 o 0 r=v(o)*1meg", "b1 o 0 i=1u", 2e-5, "o"),
}


def main():
    program = sys.argv[1]
    checker = Checker("own voltage")
    for name, (feed, resistance, current, stop, node) in CASES.items():
        times = [stop * (k + 0.37) / 50 for k in range(50)]
        both = [run(program, f"{name}\n{feed}{card}\n.tran {stop / 50!r} {stop!r} uic\n.end\n", at=times, method=None,
                    options=["--audit", "full"]) for card in (resistance, current)]
        if not checker.check(all(r.status == 0 for r in both), f"{name}: {[r.stderr[-300:] for r in both]}"):
            continue
        checker.check(not both[0].report["jumps"], f"{name}: {both[0].report['jumps']}")
        v, w = (r.column(f"v({node})") for r in both)
        worst = max(abs(x - y) for x, y in zip(v, w)) / max(map(abs, w))
        checker.check(worst <= 1e-8, f"{name}: v({node}) differs by {worst:.1e}")
        checker.check(both[0].report["work"]["steps"] < 2000, f"{name}: {both[0].report['work']['steps']} steps")
    end = run(program, f"end\n{SUPPLY}r1 o 0 r=v(o)*v(o)/60\n.tran 1m 10m uic\n.end\n", method=None).column("v(o)")[-1]
    checker.check(math.isclose(end, 12 + math.sqrt(144 - 0.1 * 60), rel_tol=1e-9), f"it ends at {end!r}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
