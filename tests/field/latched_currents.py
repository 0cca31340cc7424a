#!/usr/bin/env python3
"""Latches that a current resets by opening the switch that carries it, against closed forms.

usage: latched_currents.py PROGRAM

A clock closes a switch, a coil's current rises to a limit, and there the switch opens. From that instant the current
falls: what compares it is high for no time, and what it resets, counts or samples has been seen to it.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

PERIODS = 12
CLOSE = 1e-9  # of the run: where a small circuit's events are

# How the limit I is seen at rs, and what remembers it at q.
SEEN = {
    "a formula": "b1 rs 0 v={{i(l1)>{i!r} ? 1 : 0}}",
    "the latch itself": "b1 rs 0 v={{i(l1)/{twice!r}}}",
    "a step": "b1 x 0 v={{u(i(l1)-{i!r})}}\ne1 rs 0 x 0 1",
    "a sense resistor": "h1 rs 0 vs {ohms!r}",
    "a switch": "v9 h 0 1\ns9 rs h n9 0 over\nb9 n9 0 v={{i(l1)/{i!r}}}\nr9 rs 0 1k\n.model over sw(vt=1 ron=1 roff=1g)",
}
KEPT = {
    "an SR latch": "a1 ck rs 0 0 0 0 q 0 SRFLOP",
    "a D flip-flop": "v8 one 0 1\na1 one 0 ck 0 rs 0 q 0 DFLOP",
    "one with both outputs": "a1 ck rs 0 0 0 nq q 0 SRFLOP\ns2 0 a nq 0 sm",
}
# What else follows: cards, what is measured, and its value of the run's times of opening.
FOLLOWED = {
    "a late latch": ("a3 ck rs 0 0 0 0 q3 0 SRFLOP Td={late!r}",
                     "WHEN v(q3)=0.5 FALL=3", lambda off, period: off[2] + period / 100),
    "a counter": ("a3 rs 0 0 0 0 0 q3 0 COUNTER cycles=4 duty=0.5",
                  "WHEN v(q3)=0.5 FALL=2", lambda off, period: off[6]),
    "a sample": ("b3 is 0 v={{i(l1)/{i!r}}}\na3 is 0 rs 0 0 0 q3 0 SAMPLEHOLD",
                 "FIND v(q3) AT={half!r}", lambda off, period: 1.0),
    "a flip-flop that divides": ("a3 nq3 0 rs 0 0 nq3 q3 0 DFLOP",
                                 "WHEN v(q3)=0.5 FALL=3", lambda off, period: off[5]),
}
SIZES = (  # V, ohm, s of the coil and of the clock, the limit over V/R
    (10.0, 1.0, 1e-4, 1e-4, 0.3),
    (400.0, 3.0, 1e-2, 1.5e-2, 0.6),
    (1.2, 5e-2, 3e-8, 2e-7, 0.9),
    (3000.0, 2e4, 0.5, 3.0, 0.5),
)


def openings(volts, ohms, tau, period, limit):
    """s: when the current comes to the limit."""
    most, i, times = volts / ohms, 0.0, []
    for k in range(PERIODS):
        wait = tau * math.log((most - i) / (most - limit))
        times.append(k * period + wait)
        i = limit * math.exp(-(period - wait) / tau)
    return times


def converter(seen, kept, size, extra="", measured=None):
    volts, ohms, tau, period, share = size
    limit = share * volts / ohms
    words = {"i": limit, "twice": 2 * limit, "ohms": 0.5 / limit, "late": period / 100,
             "half": (PERIODS - 0.01) * period}
    cards = [f"v1 p 0 {volts!r}", f"vc ck 0 pulse(0 1 0 0 0 {period / 1000!r} {period!r})",
             SEEN[seen].format(**words), KEPT[kept], extra.format(**words), "s1 p a q 0 sm", "d1 0 a",
             f"l1 a y {tau * ohms!r}", f"r1 y z {ohms!r}", "vs z 0 0", ".model sm sw(vt=0.5 ron=0)",
             f".tran {period / 20!r} {PERIODS * period!r}"]
    if measured:
        cards.append(f".meas tran m {measured.format(**words)}")
    return "\n".join(["latch", *cards, ".end", ""])


def check(checker, name, size, text, wanted=None):
    volts, ohms, tau, period, share = size
    outcome = run(sys.argv[1], text, method=None, options=["--audit", "full"])
    checker.check(outcome.status == 0, f"{name}: exit {outcome.status}: {outcome.stderr[-300:]}")
    if not outcome.report:
        return
    off = openings(volts, ohms, tau, period, share * volts / ohms)
    found = [e["time"] for e in outcome.report["events"] if e["element"] == "s1" and e["state"] == "off"]
    close = CLOSE * PERIODS * period
    checker.check(len(found) == len(off) and all(abs(x - y) <= close for x, y in zip(found, off)),
                  f"{name}: opens at {found[:3]}, not at {off[:3]}")
    checker.check(outcome.report["work"]["euler_steps"] == 0, f"{name}: steps of implicit Euler")
    if wanted:
        value = outcome.report["measurements"][0].get("value")
        right = wanted(off, period)
        checker.check(value is not None and abs(value - right) <= 1e-6 * right, f"{name}: {value}, not {right}")


def main():
    checker = Checker("latched_currents")
    for size in SIZES:
        for seen in SEEN:
            for kept in KEPT:
                check(checker, f"{seen}, {kept}, {size}", size, converter(seen, kept, size))
            for follows, (extra, measured, wanted) in FOLLOWED.items():
                check(checker, f"{seen}, {follows}, {size}", size,
                      converter(seen, "an SR latch", size, extra, measured), wanted)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
