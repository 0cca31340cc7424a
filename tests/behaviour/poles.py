#!/usr/bin/env python3
"""Formulas that have no value somewhere: a run ends there and says so, and only there.

usage: poles.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

# A sine of 1 V around 0.3 V, of 1 kHz, falls through 0 here, and what follows it through 1 kohm and 0.1 uF here.
SINE_AT_0 = (math.pi + math.asin(0.3)) / (2e3 * math.pi)


def behind_filter():
    w, tau = 2e3 * math.pi, 1e-4
    size = 1 / math.hypot(1, w * tau)
    late = math.atan(w * tau)
    start = size * math.sin(late)
    low, high = 5e-4, 9e-4
    for _ in range(100):
        t = (low + high) / 2
        above = 0.3 + size * math.sin(w * t - late) + start * math.exp(-t / tau) > 0
        low, high = (t, high) if above else (low, t)
    return low


FILTER_AT_0 = behind_filter()

CIRCUIT = """{formula}
v1 a 0 {source}
r1 a c 1k
c1 c 0 0.1u
b1 b 0 v={formula}
{rest}
.tran 50u 1m
"""
SINE = "sin(0.3 1 1k)"


def run_formula(program, formula, source=SINE, rest="r2 b 0 1", **options):
    return run(program, CIRCUIT.format(formula=formula, source=source, rest=rest), method=None,
               **options)


# ---- A pole ends a run ---------------------------------------------------------------------------

POLES = (
    ("1/v(a)", SINE, SINE_AT_0),
    ("1/v(c)", SINE, FILTER_AT_0),
    ("v(a)/v(c)", SINE, FILTER_AT_0),
    ("v(c)**-3", SINE, FILTER_AT_0),
    ("1/(v(a)*v(a))", SINE, SINE_AT_0),               # the value has one sign
    ("1/v(c)**2", SINE, FILTER_AT_0),
    ("limit(1/v(c), -5, 5)", SINE, FILTER_AT_0),      # as it stands, whatever is made of it
    ("tan(5*v(a))", "sin(0 1 1k)", math.asin(math.pi / 10) / (2e3 * math.pi)),
    ("1/v(a)", "pulse(-1 1 10u 1u 1u 0.5m 1m)", 10.5e-6),
)


MOST_STEPS = 4000
RESTS = ("r2 b 0 1", "r2 b d 1k\nc2 d 0 1u\nr3 d 0 1k")


def check_poles(checker, program):
    for formula, source, time in POLES:
        for rest in RESTS:
            result = run_formula(program, formula, source, rest)
            where = f"{formula} of {source}, {rest.splitlines()[0]}"
            checker.check(result.status == 1, f"{where}: exit status {result.status}")
            checker.check("has no value" in result.stderr and "'b1'" in result.stderr
                          and "seems wrong" not in result.stderr, f"{where}: {result.stderr}")
            told = result.stderr.split("at t = ")[-1].split(" ")[0]
            checker.close(float(told or "nan"), time, 1e-9 * 1e-3 + 1e-7 * time, f"{where}: its time")
            steps = result.report["work"]["steps"]  # as many for each digit of the way to the pole
            checker.check(steps <= MOST_STEPS, f"{where}: {steps} steps")


# ---- What is none --------------------------------------------------------------------------------

NO_POLES = (
    ("3*v(a)/v(a)", SINE, lambda a, c: 3.0),
    ("v(c)*v(a)/v(c)", SINE, lambda a, c: a),
    ("1/(u(v(a)) - 0.5)", SINE, lambda a, c: 2.0 if a > 0 else -2.0),
    ("1/(u(v(c)) - 0.5)", SINE, lambda a, c: 2.0 if c > 0 else -2.0),
    ("1/v(a)", "pulse(-1 1 0 0 0 0.5m 1m)", lambda a, c: 1 / a),
    ("IF(abs(v(a)) > 0.1, 1/v(a), 0)", SINE, lambda a, c: 1 / a if abs(a) > 0.1 else 0.0),
    ("IF(abs(v(c)) < 0.1, 0, v(a)/v(c))", SINE, lambda a, c: 0.0 if abs(c) < 0.1 else a / c),
    ("v(c) > 0.1 || v(c) < -0.2 ? 1/v(c) : 5", SINE,
     lambda a, c: 1 / c if c > 0.1 or c < -0.2 else 5.0),
    ("v(c) < 0.1 && v(c) > -0.2 ? 5 : 1/v(c)", SINE,
     lambda a, c: 5.0 if -0.2 < c < 0.1 else 1 / c),
    ("exp(4*v(a))/exp(8*v(c))", SINE, lambda a, c: math.exp(4 * a - 8 * c)),
    # rounding does not leave the domain of a function
    ("sqrt(uramp(v(c)))", SINE, lambda a, c: math.sqrt(max(c, 0.0))),
    ("asin(limit(v(c), -0.5, 0.5)*2)", SINE, lambda a, c: math.asin(max(-1.0, min(1.0, 2 * c)))),
    ("asin(limit(3*v(c), -1, 1))", SINE, lambda a, c: math.asin(max(-1.0, min(1.0, 3 * c)))),
    ("sqrt(abs(v(c))) + acos(limit(2*v(c), -1, 1))", SINE,
     lambda a, c: math.sqrt(abs(c)) + math.acos(max(-1.0, min(1.0, 2 * c)))),
    ("acosh(max(1, 3*v(a)))", SINE, lambda a, c: math.acosh(max(1.0, 3 * a))),
    ("pow(max(v(c), 0), 1.5)", SINE, lambda a, c: max(c, 0.0) ** 1.5),
    ("sqrt(abs(v(c)))", SINE, lambda a, c: math.sqrt(abs(c))),
)


def check_values(checker, program):
    at = [1e-6 * (7 + 37 * k) for k in range(26)]
    for text, source, formula in NO_POLES:
        result = run_formula(program, text, source, at=at)
        where = f"{text} of {source}"
        if not checker.check(result.status == 0,
                             f"{where}: exit status {result.status}: {result.stderr}"):
            continue
        rows = zip(result.column("v(a)"), result.column("v(c)"), result.column("v(b)"))
        worst = max((abs(b - formula(a, c)) / (1 + abs(formula(a, c))) for a, c, b in rows),
                    default=math.inf)
        checker.check(worst <= 1e-6, f"{where}: off by {worst:.2e}")


# ---- What is beyond the end of a domain ----------------------------------------------------------

def check_ends(checker, program):
    for text, time in (("ln(v(c))", FILTER_AT_0), ("sqrt(v(c))", FILTER_AT_0),
                       ("pow(v(c), 0.5)", FILTER_AT_0),
                       ("asin(v(a))", math.asin(0.7) / (2e3 * math.pi))):
        result = run_formula(program, text)
        checker.check(result.status == 1 and "no value there" in result.stderr,
                      f"{text}: {result.status}: {result.stderr}")
        told = result.stderr.split("from t = ")[-1].split(" ")[0]
        checker.close(float(told or "nan"), time, 1e-6 * time, f"{text}: its time")


# ---- What is 0/0 at the start: nothing has a scale of its own there --------------------------------

def check_meters(checker, program):
    for volts, hertz in ((15.0, 2e6), (1e-3, 50.0), (325.0, 1e3)):
        w = 2 * math.pi * hertz
        netlist = (f"rms meter\nvsig s 0 sin(0 {volts!r} {hertz!r})\nb1 rms 0 v=sqrt(v(x)/time)\nc1 x 0 1 rpar=1g\n"
                   f"b2 0 x i=v(s)**2\nbc c 0 v=v(rms)*1.4142\nd1 s vr\nc2 vr 0 {20 / hertz!r} rpar=1\n"
                   f".tran {2e-3 / hertz!r} {4 / hertz!r}\n.end\n")
        result = run(program, netlist, method=None)
        what = f"a meter of {volts} V at {hertz} Hz"
        if not checker.check(result.status == 0, f"{what}: {result.stderr}"):
            continue
        for t in (0.1 / hertz, 0.33 / hertz, 1.0 / hertz, 3.7 / hertz):
            wanted = volts * math.sqrt(0.5 - math.sin(2 * w * t) / (4 * w * t))
            checker.close(result.at("v(rms)", t), wanted, 1e-6 * volts, f"{what}: at {t}")


def main():
    checker = Checker("poles")
    program = sys.argv[1]
    check_poles(checker, program)
    check_values(checker, program)
    check_ends(checker, program)
    check_meters(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
