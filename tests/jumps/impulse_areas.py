#!/usr/bin/env python3
"""Sources that read an impulse and act on states of their own: these jump by its area.

usage: impulse_areas.py PROGRAM

A current i(v1) of charge q, read by H, F or B, is an impulse of voltage or of current. What adds it up jumps by q over
its own capacitance or inductance, what is two states behind it does not jump, and a diode lets one sign through. All
have closed forms. So has the dual, a voltage across a coil whose current jumps. Where nothing jumps but by an event's error there is no impulse to read: tests/field/readers.py."""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# what drives the impulse of i(v1) at 1 ms, or as the run starts with uic, and at 3 ms: cards and charges (C)
ACTS = {
    "a capacitor": ("v1 a 0 pulse(0 1 1m 0 0 2m 10m)\nc1 a 0 1m", 1e-3, -1e-3),
    "a capacitor at 400 V": ("v1 a 0 pulse(0 400 1m 0 0 2m 10m)\nc1 a 0 2u\nr1 a 0 1k", 8e-4, -8e-4),
    "a capacitor at 1 mV": ("v1 a 0 pulse(0 1m 1m 0 0 2m 10m)\nc1 a 0 1n", 1e-12, -1e-12),
    "two in series": ("v1 a 0 pulse(0 3 1m 0 0 2m 10m)\nc1 a b 1u\nc2 b 0 2u\nrb b 0 1g", 2e-6, -2e-6),
    "one behind a diode": ("v1 a 0 pulse(0 5 1m 0 0 2m 10m)\nd1 a b d\nc1 b 0 10u\nr1 b 0 1meg", 5e-5, 0.0),
    "a capacitor from the start": ("v1 a 0 1\nc1 a 0 1m", 1e-3, 0.0),
    "two diodes from the start": ("v1 a 0 -20\nc1 b 0 5u\nd1 b x d\nd2 x a d\nrx x 0 1g", -1e-4, 0.0),
    "one behind a switch": ("v1 a 0 5\nvg g 0 pulse(0 1 1m 0 0 9m 20m)\ns1 a b g 0 s\nc1 b 0 10u\nr1 b 0 1t", 5e-5, 0.0),
}
# what reads it: cards, the state, its change over the charge for a positive and a negative one (1/F, ...)
READS = {
    "H into RC": ("h1 d 0 v1 -1\nr3 d f 1k\nc3 f 0 1u", "c3", 1e3, 1e3),
    "a large H into RC": ("h1 d 0 v1 -1k\nr3 d f 1\nc3 f 0 1m", "c3", 1e6, 1e6),
    "F into a capacitor": ("f1 f 0 v1 1\nc3 f 0 1u\nr3 f 0 10k", "c3", 1e6, 1e6),
    "F into RC": ("f1 d 0 v1 1\nr4 d 0 2k\nr3 d f 1k\nc3 f 0 1u", "c3", 2e6 / 3, 2e6 / 3),
    "B into RC": ("b1 d 0 v=-2*i(v1)\nr3 d f 1k\nc3 f 0 1u", "c3", 2e3, 2e3),
    "H into RL": ("h1 d 0 v1 -1\nr3 d f 1k\nl3 f 0 1m", "l3", 1e3, 1e3),
    "H, a diode and RC": ("h1 d 0 v1 -1\nd9 d e d\nr3 e f 1k\nc3 f 0 1u\nr4 f 0 10k", "c3", 1e3, 0.0),
    "the diode turned": ("h1 d 0 v1 1\nd9 d e d\nr3 e f 1k\nc3 f 0 1u\nr4 f 0 10k", "c3", 0.0, -1e3),
    "H, a bridge and RC": ("h1 d w v1 -1\nrw w 0 1meg\nd5 d p d\nd6 w p d\nd7 n d d\nd8 n w d\nr3 p f 1k\nc3 f n 1u\nrn n 0 1\n"
                           "r4 f n 10k", "c3", 1e3, -1e3),
    "two states behind": ("h1 d 0 v1 -1\nr3 d e 1k\nc4 e 0 1u\nr5 e f 1k\nc3 f 0 1u", "c3", 0.0, 0.0),
    "E between both": ("h1 d 0 v1 -1\nr3 d e 1k\nc4 e 0 1u\ne5 m 0 e 0 2\nr5 m f 1k\nc3 f 0 1u", "c3", 0.0, 0.0),
}
# the dual: an impulse of the voltage v(a), of flux q, where the current of a coil jumps
COILS = {
    "a coil at 3 A": ("i1 0 a pulse(0 3 1m 0 0 2m 10m)\nl1 a 0 1m", 3e-3, -3e-3),
    "a coil at 1 mA": ("i1 0 a pulse(0 1m 1m 0 0 2m 10m)\nl1 a 0 10u", 1e-8, -1e-8),
    "two coils": ("i1 0 a pulse(0 2 1m 0 0 2m 10m)\nl1 a b 1m\nl2 b 0 3m", 8e-3, -8e-3),
    "a coil that a diode takes": ("i1 0 a pulse(0 3 1m 0 0 8m 20m)\nd1 a b d\nl1 b 0 1m", 3e-3, 0.0),
}
VOLTAGES = {
    "E into RC": ("e1 d 0 a 0 1\nr3 d f 1k\nc3 f 0 1u", "c3", 1e3, 1e3),
    "G into a capacitor": ("g1 0 f a 0 1m\nc3 f 0 1u\nr3 f 0 10k", "c3", 1e3, 1e3),
    "B into RC": ("b1 d 0 v=-2*v(a)\nr3 d f 1k\nc3 f 0 1u", "c3", -2e3, -2e3),
    "E, a diode and RC": ("e1 d 0 a 0 1\nd9 d e d\nr3 e f 1k\nc3 f 0 1u\nr4 f 0 10k", "c3", 1e3, 0.0),
    "E into RL": ("e1 d 0 a 0 1\nr3 d f 1k\nl3 f 0 1m", "l3", 1e3, 1e3),
    "E, two states behind": ("e1 d 0 a 0 1\nr3 d e 1k\nc4 e 0 1u\nr5 e f 1k\nc3 f 0 1u", "c3", 0.0, 0.0),
}
METHODS = ["auto", "lobatto", "euler"]


def main():
    checker = Checker("impulse_areas")
    cases = [*itertools.product(ACTS.items(), READS.items()), *itertools.product(COILS.items(), VOLTAGES.items())]
    for (acts, (cards, *charges)), (reads, (more, state, up, down)) in some_of(cases):
        at_start = acts.endswith("start")
        tran = f".tran 0.1m 5m {'uic' if at_start else ''}"
        text = "\n".join([acts, cards, more, ".model d d", ".model s sw(ron=0 vt=0.5)", tran, ".end", ""])
        for method in METHODS:
            what = f"{acts}, {reads}, {method}"
            outcome = run(sys.argv[1], text, method=method, options=["--audit", "full"])
            if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr}"):
                continue
            jumps = [(j["time"], j["states"][state]) for j in outcome.report["jumps"] if state in j["states"]]
            largest = max(abs(charge * way) for charge in charges for way in (up, down, 1e3))
            for time, charge in zip((0.0 if at_start else 1e-3, 3e-3), charges):
                here = sum(s["after"] - s["before"] for at, s in jumps if abs(at - time) < 1e-12)
                checker.close(here, charge * (up if charge > 0.0 else down), 1e-7 * largest, f"{what}: {state} at {time}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
