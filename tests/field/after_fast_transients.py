#!/usr/bin/env python3
"""After a transient that is very much faster than the steps, these are long again at once.

usage: after_fast_transients.py PROGRAM

A diode that blocks leaves what is left in its coil to Roff: L/Roff is 0.2 ns to 0.5 ns here, and steps are 10 us. On the way
back each length would have a map of its own, used once. Steps are counted, and what is rejected with them; the numbers of
a way back length by length are beside those that are allowed.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

# H, ohm, F, phases; steps allowed (length by length: 1285, 638, 372)
CASES = [(2e-4, 1e6, 1e-4, 3, 1150), (5e-6, 1e4, 1e-3, 3, 575), (5e-6, 1e4, 1e-3, 1, 330)]


def rectifier(coil, roff, capacitor, phases):
    cards = [f"{phases} phases, {coil} H, {roff} ohm", f".model dm d(ron=1m roff={roff!r} vfwd=0)"]
    for k in range(phases):
        cards += [f"v{k} a{k} 0 sin(0 100 50 0 0 {-120 * k})", f"l{k} a{k} b{k} {coil!r}", f"dp{k} b{k} p dm"]
        cards += [f"dn{k} m b{k} dm"] if phases > 1 else []
    cards += ["vz m 0 0"] if phases == 1 else []
    return "\n".join([*cards, f"c p m {capacitor!r}", "r p m 50", ".tran 100u 60m uic", ".end", ""])


def main():
    checker = Checker("after_fast_transients")
    for coil, roff, capacitor, phases, allowed in CASES:
        out = run(sys.argv[1], rectifier(coil, roff, capacitor, phases), method=None, options=["--audit", "full"])
        if checker.check(out.status == 0, f"{coil}, {roff}, {phases}: {out.stderr[:300]}"):
            steps, rejected = out.report["work"]["steps"], out.report["work"]["rejected"]
            checker.check(steps <= allowed, f"{coil}, {roff}, {phases}: {steps} steps, {allowed} allowed")
            checker.check(rejected <= steps / 2, f"{coil}, {roff}, {phases}: {rejected} rejected of {steps}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
