#!/usr/bin/env python3
"""LTspice's PHASEDET: the charge that it pumps against edges counted by hand, the same from two flip-flops and a gate, its
limits, a loop that locks, and what is refused.

usage: phase_detector.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402
from logic import run_cards, runs  # noqa: E402

# delays and periods of both inputs, seconds to run: one leads, lags, is faster, edges at once, one alone, from ns to s
INPUTS = ((1, 50, 2, 30, 300), (10, 50, 20, 30, 500), (3, 7, 1, 7, 100), (2, 10, 2, 10, 60), (1, 2, 5, 1000, 40),
          (5, 1000, 1, 2, 40), (0.5, 3, 0.25, 3.01, 200), (4, 9, 2, 5, 150))


def pumped(first_a, every_a, first_b, every_b, t):
    """Seconds for which up was set, less those for which down was, until t."""
    edges = {}
    for which, first, every in ((0, first_a, every_a), (1, first_b, every_b)):
        for k in range(int((t - first) / every) + 1 if first <= t else 0):
            edges.setdefault(first + k * every, set()).add(which)
    is_set, total, last = [False, False], 0.0, 0.0
    for at, which in [*sorted(edges.items()), (t, set())]:  # edges at one time act at once
        total += (at - last) * (is_set[0] - is_set[1])
        last = at
        is_set = [is_set[k] or k in which for k in range(2)]
        if all(is_set):
            is_set = [False, False]
    return total


def charges(checker, program):
    """On a capacitor, at each row; and of two flip-flops that an AND of both clears, with delays and without."""
    for place, (da, ta, db, tb, end) in enumerate(INPUTS):
        unit, amperes = ((1e-9, 1e-3), (1e-3, 10e-6), (1.0, 2.0))[place % 3]
        farad = amperes * end * unit
        what = f"inputs {place}"
        clocks = [f"v{n} {n} 0 pulse(0 5 {d * unit!r} 0 0 {t * unit / 4!r} {t * unit!r})" for n, d, t in (("a", da, ta), ("b", db, tb))]
        cards = [*clocks, f"a1 a b 0 0 0 0 o 0 PHASEDET Iout={amperes!r} Vhigh=1k Vlow=-1k Ref=2", f"c1 o 0 {farad!r} ic=0",
                 "a2 one 0 a 0 clr 0 up 0 DFLOP Ref=0.5", "a3 one 0 b 0 clr 0 dn 0 DFLOP Ref=0.5", "a4 up dn 0 0 0 0 clr 0 AND", "v1 one 0 1",
                 f"g1 0 p up dn {amperes!r}", f"c2 p 0 {farad!r} ic=0",
                 f".tran {end * unit / 50!r} {end * unit!r} uic", ".save v(o) v(p) i(a1)"]
        done = run_cards(program, what, cards)
        if not runs(checker, done, what):
            continue
        for t, o, p in zip(done.time, done.column("v(o)"), done.column("v(p)")):
            wanted = amperes * unit * pumped(da, ta, db, tb, t / unit) / farad
            checker.close(o, wanted, 1e-9, f"{what}: the charge at {t}")
            checker.close(p, wanted, 1e-9, f"{what}: that of flip-flops at {t}")
        if da != db:
            currents = {round(i / amperes, 9) for i in done.column("i(a1)")}
            checker.check(currents <= {0.0, 1.0, -1.0}, f"{what}: currents {sorted(currents)}")


def limits(checker, program):
    """Its output stays between Vlow and Vhigh, whatever side of 0 these are on; a delay moves edges; Rout and Cout."""
    for low, high in ((0, 1), (-3, -1), (2, 5)):
        for leads in (True, False):
            what = f"from {low} V to {high} V"
            first, second = ("1u", "2u") if leads else ("2u", "1u")
            done = run_cards(program, what, [
                f"v1 a 0 pulse(0 10 {first} 0 0 1u 4u)", f"v2 b 0 pulse(0 10 {second} 0 0 1u 4u)",
                f"a1 a b 0 0 0 0 o 0 PHASEDET Iout=1m Vlow={low} Vhigh={high} Ref=5", f"c1 o 0 1n ic={(low + high) / 2}", ".tran 1u 60u uic"])
            if runs(checker, done, what):
                v = done.column("v(o)")
                checker.check(min(v) >= low - 1e-9 and max(v) <= high + 1e-9, f"{what}: {min(v)} to {max(v)}")
                checker.close(v[-1], high if leads else low, 1e-9, f"{what}: at its end")
    done = run_cards(program, "delay", ["v1 a 0 pulse(0 1 1u 0 0 1u 10u)", "v2 b 0 pulse(0 1 3u 0 0 1u 10u)",
                                        "a1 a b 0 0 0 0 o 0 PHASEDET Iout=1m Vlow=-9 Vhigh=9 Ref=0.5 Td=0.5u Rout=1k Cout=100p", ".tran 0.1u 8u uic"])
    if runs(checker, done, "a delay, with R and C"):
        for t, v in zip(done.time, done.column("v(o)")):
            up, down = max(0, min(t, 3.5e-6) - 1.5e-6), max(0, t - 3.5e-6)
            wanted = (1 - math.exp(-up / 1e-7)) * math.exp(-down / 1e-7)
            checker.close(v, wanted, 1e-8, f"a delay, with R and C, at {t}")


def locks(checker, program):
    """A loop of second order with a modulator comes to rest at the reference's frequency, from below and above."""
    for hertz, slope, centre in ((10e3, 5e3, 8e3), (10e3, 5e3, 14e3), (200.0, 100, 150)):
        what = f"a loop at {hertz} Hz"
        volts = (hertz - centre) / slope
        amperes, ohms = 1e-4, 10e3
        farad = 40 / (hertz * ohms)
        done = run_cards(program, what, [
            f"vr r 0 sin(0 1 {hertz!r})", f"b1 f 0 v={centre!r}+{slope!r}*v(c)",
            "a1 f 0 0 0 0 0 s 0 MODULATE mark=1 space=0", f"a2 r s 0 0 0 0 c 0 PHASEDET Iout={amperes!r} Vhigh=3 Vlow=-3 Ref=0.1",
            f"r1 c d {ohms!r}", f"c1 d 0 {farad!r} ic=0", f".tran {1 / hertz!r} {400 / hertz!r} uic", ".save v(d)"])
        if runs(checker, done, what):
            checker.close(done.column("v(d)")[-1], volts, 2e-3 * max(1, abs(volts)), f"{what}: the control")


def refused(checker, program):
    cases = (("a1 a 0 0 0 0 0 o 0 PHASEDET", "pin 2 of 'a1' is not wired"),
             ("a1 a b 0 0 0 0 0 0 PHASEDET", "pin 7 of 'a1' is not wired"),
             ("a1 a b 0 0 0 0 o 0 PHASEDET Trise=1n", "a phase detector has no parameter 'trise' here"),
             ("a1 a b 0 0 0 0 o 0 PHASEDET Iout=-1m", "'iout' cannot be negative"),
             ("a1 a b 0 0 0 0 o 0 PHASEDET Vlow=2", "Vhigh must be above Vlow"))
    for card, text in cases:
        done = run_cards(program, card, ["v1 a 0 1", "v2 b 0 1", card, "r1 o 0 1", ".tran 1 2"])
        checker.check(done.status != 0 and text in done.stderr, f"{card}: {done.stderr}")
    done = run_cards(program, "a pin too many", ["v1 a 0 1", "v2 b 0 1", "a1 a b a 0 0 0 o 0 PHASEDET tripdt=1n", "r1 o 0 1", ".tran 1u 2u"])
    checker.check(done.status == 0 and "pin 3 of 'a1' means nothing" in done.stderr, f"a pin too many: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("phase_detector")
    for part in (charges, limits, locks, refused):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
