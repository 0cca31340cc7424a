#!/usr/bin/env python3
"""Legs of modular multilevel converters, 6 to 12 cells an arm, nearest level, with resistances of milliohms.

usage: modular_arms.py PROGRAM

Each cell that is switched in has a diode beside its switch. As the current of the arm passes 0 these diodes pass it one
after the other, within nanoseconds, by what their cells differ and leak. Where all once did so together, a guess may say
that they do again: each is held to its own current.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

ALLOWED = 1e-6


def arm(name, top, n, sign, farad, volts):
    cards = []
    for k in range(n):
        out, c = f"{name}{k}", f"c{name}{k}"
        cards += [f"bg{out} g{out} 0 v={sign}*v(m)>{(2 * k + 1) / n - 1!r} ? 1 : 0", f"bh{out} h{out} 0 v=1-v(g{out})",
                  f"c{out} {c} {out} {farad!r} ic={volts / n!r}", f"s{out}a {c} {top} g{out} 0 sw",
                  f"s{out}b {top} {out} h{out} 0 sw", f"d{out}a {top} {c} d", f"d{out}b {out} {top} d"]
        top = out
    return cards, top


def leg(n, volts, farad, henry, ohms, hertz, depth):
    upper, above = arm("u", "p", n, -1, farad, volts)
    lower, below = arm("l", "q", n, 1, farad, volts)
    return [f"vp p 0 {volts / 2!r}", f"vn 0 n {volts / 2!r}", f"vm m 0 sin(0 {depth} {hertz!r})", *upper, *lower,
            f"lu {above} o {henry!r}", f"ll o q {henry!r}", f"rn {below} n 10m", f"lo o z {1.5 * henry!r}", f"ro z 0 {ohms!r}",
            ".model sw sw(vt=0.5 ron=1m roff=1meg)", ".model d d(ron=1m)",
            f".tran {1 / (400 * hertz)!r} {2 / hertz!r} uic"]


# cells an arm, V, F, H, ohm of the load, Hz, depth of the modulation
CASES = [(10, 1e3, 2e-3, 3e-3, 20.0, 50.0, 0.85), (10, 1e3, 2.2e-3, 3e-3, 20.0, 50.0, 0.85),
         (6, 400.0, 1e-3, 1e-3, 10.0, 60.0, 0.9), (12, 2e4, 5e-3, 1e-2, 50.0, 50.0, 0.8),
         (8, 48.0, 1e-3, 5e-5, 1.0, 400.0, 0.95)]


def main():
    checker = Checker("modular_arms")
    for n, volts, farad, henry, ohms, hertz, depth in some_of(CASES, 1):
        name = f"{2 * n} cells at {volts:g} V"
        text = "\n".join([name, *leg(n, volts, farad, henry, ohms, hertz, depth), ".end", ""])
        exact = run(sys.argv[1], text, method=None, tolerance=1e-9)
        for stages in (5, 7):
            what = f"{name}, {stages} stages"
            outcome = run(sys.argv[1], text, method=None, stages=stages, options=["--audit", "full"])
            if checker.check(outcome.status == exact.status == 0, f"{what}: {outcome.stderr[:300]}"):
                n_euler = outcome.report["work"]["euler_steps"]
                checker.check(n_euler == 0, f"{what}: {n_euler} steps of implicit Euler")
                for signal in ("i(lu)", "i(ll)", f"v(cu{n - 1},u{n - 1})"):
                    checker.close(outcome.column(signal)[-1], exact.column(signal)[-1], ALLOWED * exact.scale(signal),
                                  f"{what}: {signal}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
