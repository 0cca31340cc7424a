#!/usr/bin/env python3
"""Two coils in series, resistors between them and nothing else, beside a capacitor that a step charges within 1e-14 to 1e-9 s.

usage: coils_in_series.py PROGRAM

No equation without derivatives has the voltage between the coils. Rounding of the sums of conductances there is a resistor to
ground, which in steps so short carries more than the coils: their currents grew without bound. The closed form is that of one
coil, by the two real poles of the circuit.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

EXACT = 1e-7
STEP = 1e-6  # s, when the source steps


def response(source, r_source, farad, ohm, henry, t):
    """The current of the coil at t behind the step: the partial fractions of its transform."""
    if t <= 0:
        return 0.0
    b = 1 / (r_source * farad) + ohm / henry
    c = (r_source + ohm) / (r_source * farad * henry)
    fast = -(b + math.sqrt(b * b - 4 * c)) / 2
    slow = c / fast
    return source / (r_source * farad * henry) * ((math.exp(fast * t) - 1) / fast - math.expm1(slow * t) / slow) / (fast - slow)


def look_at(checker, program, henry, farad, small, large, how):
    """small, large: ohm of resistors side by side, whose conductances are added up."""
    ohm = small + 2 * large + 30 * small + 0.3
    between = {
        "ends at ground": f"r2 x m {small!r}\nr3 m y {large!r}\nr4 y n {large!r}\nr5 n z {30 * small!r}\nl2 z b {3 * henry!r}\nr6 b 0 0.3\n",
        "ends at a coil": f"r6 x b 0.3\nr2 b m {small!r}\nr3 m y {large!r}\nr4 y n {large!r}\nr5 n z {30 * small!r}\nl2 z 0 {3 * henry!r}\n",
        "a side branch": f"r2 x m {small!r}\nr3 m y {large!r}\nr7 y s {small!r}\nr8 s t {large!r}\nr4 y n {large!r}\nr5 n z {30 * small!r}\n"
                         f"l2 z b {3 * henry!r}\nr6 b 0 0.3\n",
    }[how]
    text = (f"{how}\nv1 a 0 pulse(0 10 {STEP!r} 0 0 1 2)\nr1 a o 1\nc1 o 0 {farad!r}\nl1 o x {henry!r}\n{between}"
            f".tran 1u 20u uic\n.end\n")
    times = [1e-6 * (k + 0.37) for k in range(19)]
    name = f"{henry:g} H, {farad:g} F, {small:g} and {large:g} ohm, {how}"
    done = run(program, text, at=times, method=None)
    if not checker.check(done.status == 0, f"{name}: {done.stderr}"):
        return
    exact = [response(10.0, 1.0, farad, ohm, 4 * henry, t - STEP) for t in times]
    for column in ("i(l1)", "i(l2)"):
        off = max(abs(a - b) for a, b in zip(done.column(column), exact)) / max(exact)
        checker.check(off <= EXACT, f"{name}: {column} is off by {off:.2g} of its largest value")


def main():
    checker = Checker("coils_in_series")
    cases = [(henry, farad, small, large, how) for henry in (1.6, 1e-3, 20.0) for farad in (1e-9, 1e-12, 1e-14)
             for small, large in ((0.09, 495.0), (1e-3, 10.0), (1e-6, 1e3))
             for how in ("ends at ground", "ends at a coil", "a side branch")]
    for case in some_of(cases, 3):
        look_at(checker, sys.argv[1], *case)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
