#!/usr/bin/env python3
"""Sources whose frequency sweeps, across capacitors and through coils: their current or voltage is a derivative.

usage: swept_sources.py PROGRAM

sin(phase(t)) of thousands of radians is known to 1e-12 and no better. What that makes of a derivative over a step, the
more the shorter the step, is no error that a shorter step mends: no step falls back to implicit Euler, and the derivative
is that of the closed form.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

ROWS = 400
ALLOWED = 1e-7


class Sweep:
    """From one frequency to another in `seconds`, each second by the same factor or by the same step."""

    def __init__(self, first, last, seconds, by_factor):
        self.first, self.last, self.seconds, self.by_factor = first, last, seconds, by_factor

    def formula(self):
        if self.by_factor:
            growth = self.last / self.first
            radians = 2 * math.pi * self.seconds * self.first / math.log(growth)
            return f"sin({radians!r}*{growth!r}**(time/{self.seconds!r}))"
        slope = (self.last - self.first) / self.seconds
        return f"sin({2 * math.pi * self.first!r}*time+{math.pi * slope!r}*time**2)"

    def derivative(self, t):
        if self.by_factor:
            growth = self.last / self.first
            frequency = self.first * growth ** (t / self.seconds)
            phase = 2 * math.pi * self.seconds * frequency / math.log(growth)
        else:
            slope = (self.last - self.first) / self.seconds
            frequency = self.first + slope * t
            phase = 2 * math.pi * self.first * t + math.pi * slope * t * t
        return 2 * math.pi * frequency * math.cos(phase)


SWEEPS = [Sweep(10.0, 1e3, 5.0, True), Sweep(1e3, 10.0, 5.0, True), Sweep(20.0, 2e4, 0.2, True),
          Sweep(1.0, 50.0, 20.0, False), Sweep(1e5, 1e6, 1e-3, False)]
# A source and what reads its derivative, over it.
CIRCUITS = {
    "capacitor": (["b1 i 0 v={size}*{formula}", "c1 n i 1u", "v1 n 0 0", "h1 o 0 v1 1meg"], "v(o)", 1.0),
    "coil": (["b1 0 i i={size}*{formula}", "l1 i 0 2m"], "v(i)", 2e-3),
}


def main():
    program = sys.argv[1]
    checker = Checker("swept_sources")
    for k, sweep in enumerate(SWEEPS):
        for name, (cards, signal, factor) in CIRCUITS.items():
            what = f"sweep {k}, {name}"
            size = (1.0, 325.0, 1e-3)[k % 3]
            text = "\n".join([what, *cards, f".tran {sweep.seconds / 1000!r} {sweep.seconds!r} uic", ".end", ""])
            times = [sweep.seconds * (j + 0.5) / ROWS for j in range(ROWS)]
            outcome = run(program, text.format(size=size, formula=sweep.formula()), method=None, at=times,
                          options=["--audit", "full"])
            if checker.check(outcome.status == 0, f"{what}: {outcome.stderr[:300]}"):
                n_euler = outcome.report["work"]["euler_steps"]
                checker.check(n_euler == 0, f"{what}: {n_euler} steps of implicit Euler")
                wanted = [factor * size * sweep.derivative(t) for t in times]
                scale = max(map(abs, wanted))
                off = max(abs(a - b) for a, b in zip(outcome.column(signal)[-ROWS:], wanted)) / scale
                checker.check(off <= ALLOWED, f"{what}: off by {off:.2g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
