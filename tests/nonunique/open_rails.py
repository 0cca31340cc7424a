#!/usr/bin/env python3
"""What is open goes along a rail as far as it must, and no farther.

usage: open_rails.py PROGRAM

While all diodes of a bridge without neutral block, v(p) may be anything from the largest phase to the smallest one plus
the capacitor's voltage. The answer of least norm has the least sum of squares of the six reverse voltages: the mean of
the phases plus half the capacitor's voltage, or the rail that is nearest to that.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# volts and Hz of a phase, H, ohm, F, stop, step
STARS = [(325, 50, 1e-3, 20, 50e-6, 1.6e-3, 1e-6), (325, 50, 1e-3, 20, 50e-6, 1.6e-3, 4e-7),
         (28, 400, 50e-6, 5, 25e-6, 0.2e-3, 1.25e-7), (8e3, 50, 20e-3, 400, 2.5e-6, 1.6e-3, 1e-6)]


def star(volts, hertz, henry, ohm, farad, stop, step):
    phases = [f"v{k} {s} 0 sin(0 {volts} {hertz} 0 0 {-120 * k})\nl{k} {s} {s}x {henry}\nd{k} {s}x p d\nd{k + 3} n {s}x d"
              for k, s in enumerate("abc")]
    return "\n".join(["open rails", *phases, f"r p n {ohm}", f"c p n {farad} ic=0", ".model d d(ron=0)",
                      f".tran {2 * step!r} {stop!r} uic", ".end", ""])


def main():
    checker = Checker("open_rails")
    rails = 0
    stars = some_of(STARS)
    for numbers in stars:
        what = f"{numbers[0]} V, step {numbers[-1]}"
        result = run(sys.argv[1], star(*numbers), step=numbers[-1], options=["--fill", "none"])
        if not checker.check(result.status == 0, f"{what}: {result.stderr}"):
            continue
        largest = max(result.scale(f"i(d{k})") for k in range(6))
        for i, t in enumerate(result.time):
            if t < 0.01 * numbers[-2] or max(abs(result.column(f"i(d{k})")[i]) for k in range(6)) > 1e-9 * largest:
                continue
            phase = [result.column(f"v({s}x)")[i] for s in "abc"]
            p, across = result.column("v(p)")[i], result.column("v(p)")[i] - result.column("v(n)")[i]
            free = across / 2 + sum(phase) / 3
            least = min(max(free, max(phase)), across + min(phase))
            rails += least != free
            checker.check(abs(p - least) <= 1e-9 * result.scale("v(p)"), f"{what}: v(p) is {p} at {t}, not {least}")
    checker.check(rails > 25 * len(stars), f"{rails} rows on a rail")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
