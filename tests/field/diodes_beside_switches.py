#!/usr/bin/env python3
"""Ideal diodes across closed switches of milliohms, at kilovolts: each closes where the current of its switch passes 0.

usage: diodes_beside_switches.py PROGRAM

Legs hang on a common link, in a part that is stepped on factors. A source with phase k of the cycle drives the current of
leg k; the switch carries it one way, the diode the other, so it takes over at a zero of the sine. What the diode waits for
is the on-resistance times that current, microvolts between two nodes at kilovolts: the difference of these nodes, to the
part of them that steps promise, would have it close late.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

LATE = 1e-5  # of the angle of the sine, in radians


def legs(n, volts, ohms, amperes, hertz):
    cards = [f"v9 p0 0 {volts!r}", "r8 p0 p 1m", f"c99 p 0 {1e-3 * amperes / volts / hertz!r} ic={volts!r}"]
    for k in range(n):
        cards += [f"s{k} p h{k} on 0 sw", f"d{k} h{k} p di",
                  f"i{k} x{k} 0 sin(0 {amperes!r} {hertz!r} 0 0 {360 * (k + 0.5) / n!r})",
                  f"r{k}a x{k} y{k} 1", f"c{k} y{k} 0 {1e-6 * amperes / volts / hertz!r} ic={volts!r}",
                  f"r{k}b y{k} x{k} 10", f"vx{k} h{k} x{k} 0"]
    return cards + ["von on 0 1", f".model sw sw(vt=0.5 ron={ohms!r})", ".model di d", "r9 on 0 1k",
                    f".tran {1e-2 / hertz!r} {2.2 / hertz!r} uic"]


def main():
    checker = Checker("diodes_beside_switches")
    for n, volts, ohms, amperes, hertz in some_of([
            (12, 3e3, 1e-2, 0.05, 5e3), (12, 600.0, 1e-3, 0.2, 50.0), (15, 3e4, 5e-2, 0.1, 400.0),
            (12, 48.0, 2e-4, 0.02, 1e5)]):
        what = f"{n} legs of {ohms:g} ohm at {volts:g} V and {hertz:g} Hz"
        outcome = run(sys.argv[1], "\n".join([what, *legs(n, volts, ohms, amperes, hertz), ".end", ""]), method=None,
                      options=["--audit", "full"])
        if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr}"):
            continue
        for k in range(n):
            first = (0.5 - (k + 0.5) / n) % 1.0  # of a period: where the sine falls through 0
            found = [e["time"] * hertz for e in outcome.report["events"] if e["element"] == f"d{k}" and e["state"] == "on"]
            if (k + 0.5) / n > 0.5:
                found = [t for t in found if t > 1e-3]  # it conducts from the start
            wanted = [t for t in (first, 1 + first, 2 + first) if t < 2.2]
            if checker.check(len(found) == len(wanted), f"{what}: d{k} closes at {found}, not at {wanted}"):
                for one, other in zip(found, wanted):
                    checker.close(one, other, LATE / (2 * math.pi), f"{what}: d{k} closes, in periods")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
