#!/usr/bin/env python3
"""int, floor, ceil, round and remainders of quantities that vary: each row against the function, averages against closed
forms, and what is refused.

usage: staircases.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

ROUND = lambda x: math.copysign(math.floor(abs(x) + 0.5), x)  # noqa: E731
TRIANGLE = "V1 x 0 PULSE(0 8 0 8m 8m 1f 16.000000000001m)"

# What makes v(x), the formula of v(y), the same of a number, its least distance between jumps, v(y)'s mean (None: not
# asked for), and how many values it has.
CASES = (
    (TRIANGLE, "int(v(x))", math.trunc, 1, 3.5, 9),
    (TRIANGLE, "floor(2.5*v(x)-3)", lambda x: math.floor(2.5 * x - 3), 0.4, 6.5, 21),
    (TRIANGLE, "ceil(v(x)/3)", lambda x: math.ceil(x / 3), 3, 1.875, 4),
    (TRIANGLE, "round(v(x)-4)", lambda x: ROUND(x - 4), 1, 0, 9),
    (TRIANGLE, "nint(v(x)/8)", lambda x: ROUND(x / 8), 8, 0.5, 2),
    (TRIANGLE, "v(x)-2*int(v(x)/2)", lambda x: math.fmod(x, 2), 2, 1, None),
    (TRIANGLE, "fmod(v(x), 3)", lambda x: math.fmod(x, 3), 3, 1.375, None),
    (TRIANGLE, "v(x) % 8.5", lambda x: x, 8.5, 4, None),
    (TRIANGLE, "int(v(x)*100)/100", lambda x: math.trunc(x * 100) / 100, 1e-2, 3.995, None),
    ("V1 x 0 SIN(0.2 3.3 100)", "int(v(x))", math.trunc, 1, None, 7),
    ("V1 x 0 SIN(0 310 50)", "floor(v(x)/100)", lambda x: math.floor(x / 100), 100, None, 8),
    ("V1 x 0 SIN(0 2.2u 50)", "ceil(v(x)*1meg)", lambda x: math.ceil(x * 1e6), 1e-6, None, 6),
    ("V1 x 0 PWL(0 -3.7 5m 4.2 9m 4.2 16m -1)", "round(v(x))", ROUND, 1, None, 9),
    ("V1 x 0 EXP(0 9.9 1m 2m 9m 1m)", "int(v(x))", math.trunc, 1, None, 10),
    ("V1 x z SIN(0 2.5 100)\nV2 z 0 PULSE(0 3 0 8m 8m 1f 17m)", "floor(v(x))", math.floor, 1, None, 6),
    # behind a coil and a capacitor, and bounded by what people write
    ("V1 in 0 PULSE(0 9 1m 0 0 7m 20m)\nR1 in x 1k\nC1 x 0 1u", "int(limit(v(x), 0, 15))", math.trunc, 1, None, 9),
    ("V1 in 0 5\nL1 in x 1m ic=0\nC1 x 0 1u ic=0\nR1 x 0 100", "floor(max(min(v(x)/2, 10), -10))",
     lambda x: math.floor(x / 2), 2, None, 5),
    ("V1 in 0 SIN(0 5 100)\nD1 in x\nR1 x 0 1k", "int(limit(v(x)/5*256, 0, 255))",
     lambda x: math.trunc(min(max(x / 5 * 256, 0), 255)), 5 / 256, None, 256),
    ("V1 in 0 PULSE(0 9 1m 0 0 7m 20m)\nR1 in x 1k\nC1 x 0 1u", "round(table(v(x), 0, 0, 9, 3))",
     lambda x: ROUND(x / 3), 1.5, None, 4),
    # of a voltage that a formula bounds, in another source
    ("V1 in 0 SIN(0 5 100)\nR1 in a 1\nC1 a 0 1u\nB1 x 0 V=limit(v(a), 0, 3.2)", "floor(v(x))", math.floor, 1, None, 4),
    # time, through 0
    ("B1 x 0 V=1k*time-4", "int(1k*time-4)", math.trunc, 1, 3.75, 15),
    ("B1 x 0 V=4-1k*time", "int(4-1k*time)", math.trunc, 1, -3.75, 15),
)


def rows(checker, program, case):
    source, formula, f, apart, mean, n_values = case
    text = f"a staircase\n{source}\nB9 y 0 V={formula}\nR9 y 0 1k\n.save v(x) v(y)\n.tran 10u 16m uic\n" \
           ".meas tran mean avg v(y)\n.end\n"
    done = run(program, text, method=None, tolerance=1e-10)
    if not checker.check(done.status == 0, f"{formula}: {done.stderr}"):
        return
    x, y, time = done.column("v(x)"), done.column("v(y)"), done.time
    wrong = 0
    for k, value in enumerate(x):
        # at a jump, and within the rounding of one, both sides are right
        near = {f(value - 1e-7 * apart), f(value), f(value + 1e-7 * apart)}
        wrong += all(abs(y[k] - other) > 1e-6 * max(1, abs(other)) for other in near)
    checker.check(wrong == 0, f"{source}: {formula}: {wrong} of {len(x)} rows are wrong")
    if n_values is not None:
        values = {round(value, 6) for value in y}
        checker.check(len(values) == n_values, f"{source}: {formula}: {len(values)} values, not {n_values}: {sorted(values)[:12]}")
    jumps = sum(1 for k in range(1, len(time)) if time[k] == time[k - 1] and y[k] != y[k - 1])
    checker.check(jumps >= (n_values or 2) - 2 or f is CASES[7][2], f"{source}: {formula}: {jumps} jumps")
    if mean is not None:
        checker.close({m["name"]: m["value"] for m in done.report["measurements"]}["mean"], mean, 1e-6, f"{formula}: mean")


def jumps(checker, program):
    """Beside its number by 1e-9 of a step: not further, and so that what rests there is on the right side."""
    text = "when\nV1 in 0 PULSE(0 9 1m 0 0 7m 20m)\nR1 in x 1k\nC1 x 0 1u\nB1 y 0 V=int(limit(v(x), 0, 15))\n" \
           ".meas tran t3 when v(y)=2.5 rise=1\n.meas tran t8 when v(y)=7.5 rise=1\n.tran 10u 16m uic\n.end\n"
    done = run(program, text, method=None, tolerance=1e-12)
    if checker.check(done.status == 0, done.stderr):
        for m in done.report["measurements"]:
            volts = int(m["name"][1:])
            exact = 1e-3 * (1 + math.log(9 / (9 - volts)))
            checker.close(m["value"], exact, 3e-9 / ((9 - volts) * 1e3), f"the jump to {volts}")
    for far in (0, 300.1):
        text = f"rests\nV1 in 0 SIN(0 5 100)\nR1 in a 1\nC1 a 0 1u\nB1 x 0 V=limit(v(a)+{far}, {far}, {far}+3.2)\n" \
               f"B2 q 0 V=limit(v(a)+2*{far}, {far}, 1.5*{far})\n" \
               "B3 y 0 V=floor(limit(v(x)-v(q)/1.5, -2, 5))\n.tran 10u 16m uic\n.end\n"
        done = run(program, text, method=None)
        if checker.check(done.status == 0, done.stderr):
            checker.check({round(v, 6) for v in done.column("v(y)")} == {0, 1, 2, 3}, f"rests at 0 beside {far} V")


REFUSED = (
    ("floor(v(u))", "floor(...) of what may have any value has steps without end"),
    ("int(i(v1))", "limit(x, 0, 15) in the place of x bounds it"),
    ("v(u) % 3", "a remainder of what may have any value has steps without end"),
    ("v(x) % v(x)", "what a remainder is by must be a number"),
    ("fmod(v(x), 0)", "what a remainder is by must be a number"),
    ("int(v(x)*1000)", "has more than 1024 steps"),
    ("round(max(v(u), 0))", "has steps without end"),
    ("int(v(x)/v(u))", "has steps without end"),
)


def refusals(checker, program):
    for formula, words in REFUSED:
        text = f"refused\nV1 x 0 SIN(0 5 100)\nR1 x u 1k\nC1 u 0 1u\nB1 y 0 V={formula}\nR9 y 0 1\n.tran 10u 1m\n.end\n"
        done = run(program, text, method=None)
        checker.check(done.status == 3 and words in done.stderr, f"{formula}: {done.status} {done.stderr}")


def sweeps(checker, program):
    """Beyond the value on the card: .dc, and a script that alters it."""
    text = "a sweep\nV1 x 0 1\nB1 y 0 V=floor(v(x))\nR9 y 0 1\n.dc V1 -3.25 6 0.5\n.save v(x) v(y)\n.end\n"
    done = run(program, text, method=None)
    if checker.check(done.status == 0, done.stderr):
        for x, y in zip(done.column("v(x)"), done.column("v(y)")):
            checker.close(y, math.floor(x), 1e-9, f"floor({x}) of a sweep")
    text = "altered\nV1 x 0 1\nB1 y 0 V=floor(v(x))\nR9 y 0 1\n.control\nalter v1 = 7.5\nop\nprint v(y)\n.endc\n.end\n"
    done = run(program, text, method=None)
    checker.check(done.status == 3 and "steps without end" in done.stderr, f"altered: {done.status} {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("staircases")
    for case in CASES:
        rows(checker, program, case)
    jumps(checker, program)
    refusals(checker, program)
    sweeps(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
