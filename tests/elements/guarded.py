#!/usr/bin/env python3
"""Branches of a formula that have no value where they are not chosen: constant powers, roots and logarithms behind a
condition, against closed forms, ngspice's habit of evaluating what is chosen alone.

usage: guarded.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402
from logic import run_cards, runs  # noqa: E402


def functions(checker, program):
    """Of a ramp through 0, at scales from microvolts to kilovolts; both directions, nested, in user functions and subcircuits."""
    for s in (1, 1e-3, 600):
        cases = (
            (f"if(v(x) < {0.5 * s!r}, 0, sqrt(v(x)))", lambda x: 0 if x < 0.5 * s else math.sqrt(x)),
            (f"v(x) > {0.1 * s!r} && v(x) < {10 * s!r} ? ln(v(x)) : -1", lambda x: math.log(x) if 0.1 * s < x < 10 * s else -1),
            (f"v(x) < {-0.5 * s!r} ? 1/v(x) : 3", lambda x: 1 / x if x < -0.5 * s else 3),
            (f"!(v(x) <= {0.25 * s!r}) ? v(x)**0.5 : (v(x) > {-s!r} ? 7 : 2/v(x))", lambda x: math.sqrt(x) if x > 0.25 * s else 7 if x > -s else 2 / x),
            (f"{0.3 * s!r} <= v(x) ? pow(v(x), 1.5) : v(x)", lambda x: x ** 1.5 if x >= 0.3 * s else x),
            (f"{-0.2 * s!r} > v(x) ? {-5 * s * s!r}/v(x) : !({0.4 * s!r} >= v(x) || v(x) < 0) ? log10(v(x)) : 0",
             lambda x: -5 * s * s / x if x < -0.2 * s else math.log10(x) if x > 0.4 * s else 0),
            (f"inverse(v(x), {0.2 * s!r})", lambda x: 1 / x if x > 0.2 * s else 5 / s),
            (f"if(v(x) >= {0.5 * s!r}, 1/v(x) + sqrt(v(x))*v(x), 1/(v(x) - {3 * s!r}))",
             lambda x: 1 / x + x ** 1.5 if x >= 0.5 * s else 1 / (x - 3 * s)))
        for form, wanted in cases:
            done = run_cards(program, form, [
                f"v1 x 0 pwl(0 {-2 * s!r} 1 {2 * s!r})", ".func inverse(a,b) {if(a > b, 1/a, 1/b)}", ".subckt part x o", f"b1 o 0 v={form}", "r1 o 0 1", ".ends",
                f"b1 o 0 v={form}", "r1 o 0 1", "x1 x p part", ".tran 0.013 1"])
            if not runs(checker, done, form):
                continue
            largest = max(abs(wanted(x)) for x in done.column("v(x)"))
            for x, o, p in zip(*(done.column(f"v({n})") for n in "xop")):
                if min(abs(x - c * s) for c in (-1, -0.5, -0.2, 0, 0.1, 0.2, 0.25, 0.3, 0.4, 0.5)) > 1e-6 * s:
                    checker.close(o, wanted(x), 1e-6 * largest, f"{form} at {x} V")
                    checker.close(p, wanted(x), 1e-6 * largest, f"{form} in a subcircuit at {x} V")


def loads(checker, program):
    """Constant powers that begin at 0 V, where p/v would be without end: their operating points and what they charge."""
    for volts, watts, ohms, least in ((24, 60, 0.1, 6), (400, 3000, 1, 50), (3.3, 1, 0.2, 1)):
        root = 0.5 * (volts + math.sqrt(volts * volts - 4 * watts * ohms))
        for form in (f"b1 o 0 i=if(v(o) > {least}, {watts}/v(o), 0)", f"g1 o 0 value={{v(o) < {least} ? v(o)*{watts / least ** 2!r} : {watts}/v(o)}}"):
            done = run_cards(program, form, [f"v1 i 0 pulse(0 {volts} 1u 0 0 1 2)", f"rs i o {ohms}", "c1 o 0 100u", form, ".tran 10u 10m"])
            if runs(checker, done, form):
                checker.close(done.column("v(o)")[-1], root, 1e-6 * volts, f"{form}: it ends at")
                checker.close(done.column("v(o)")[0], 0, 1e-9, f"{form}: it begins at")
    # C v v' = (volts - v)/ohms v - watts from `least` on
    done = run_cards(program, "its course", ["i1 0 o 1", "c1 o 0 1m", "b1 o 0 i=if(v(o) > 2, 1/v(o), 0)", ".ic v(o)=0", ".tran 10u 10m uic"])
    if runs(checker, done, "a course"):
        for t, v in zip(done.time, done.column("v(o)")):
            if t > 2.1e-3:  # v - 2 + ln(v - 1) = (t - 2 ms)/1 ms
                checker.close(v - 2 + math.log(v - 1), (t - 2e-3) / 1e-3, 1e-5, f"a course at {t}")
            elif t < 2e-3:
                checker.close(v, t / 1e-3, 1e-6, f"before at {t}")


def still_wrong(checker, program):
    """What a condition does not exclude is said as before."""
    for form in ("1/v(x)", "if(v(x) > -1, 1/v(x), 0)", "if(v(y) > 1, 1/v(x), 0)", "if(v(x) > 0, 0, sqrt(v(x)))"):
        done = run_cards(program, form, ["v1 x 0 pwl(0 0 1 -2)", "v2 y 0 2", f"b1 o 0 v={form}", "r1 o 0 1", ".tran 0.1 1"])
        checker.check(done.status == 1 and "finds no value" in done.stderr, f"{form}: {done.status} {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("guarded")
    for part in (functions, loads, still_wrong):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
