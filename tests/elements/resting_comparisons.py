#!/usr/bin/env python3
"""Comparisons whose sides are equal for a while: behind a diode that blocks, on a rail, of a current that is none.

usage: resting_comparisons.py PROGRAM

Where nothing else decides, a formula has there the value that it is written with: > and < are false, >= and <= true,
sgn is 0. At scales from microvolts to kilovolts, as an operating point, and in runs where the sides become equal.
So is it of a rate where what it is of goes flat, and rounding over the length of a step is left of it: the parts of the
time at which comparisons are true are those of a trapezoid's flanks.
"""

import sys
import pathlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

HALF_WAVE = "d1 a x\nr1 x 0 1k"
CLAMP = "r1 a x 1k\nd1 x c\nvc c 0 {half}"
COIL = "d1 a x\nl1 x z 10m\nr1 z 0 100"
FREEWHEEL = COIL + "\nd2 0 x"
# circuit, formula, its value at the crest of the sine, behind it (0.8 of a period), and at rest with the source below 0
CASES = [
    (HALF_WAVE, "u(v(x))", 1, 0, 0), (HALF_WAVE, "v(x)>0 ? 1 : 0", 1, 0, 0), (HALF_WAVE, "v(x)>=0 ? 1 : 0", 1, 1, 1),
    (HALF_WAVE, "v(x)<0 ? 1 : 0", 0, 0, 0), (HALF_WAVE, "v(x)<=0 ? 1 : 0", 0, 1, 1), (HALF_WAVE, "sgn(v(x))", 1, 0, 0),
    (HALF_WAVE, "if(v(x)>0,2,-1)", 2, -1, -1), (HALF_WAVE, "if(v(x)>=0,7,-1)", 7, 7, 7),
    (HALF_WAVE, "u(v(x))*u(v(a))", 1, 0, 0), (HALF_WAVE, "inv(v(x)/{half})", 0, 1, 1), (HALF_WAVE, "3*u(-v(x))-1", -1, -1, -1),
    (HALF_WAVE, "(v(x)>0) && (v(a)>0) ? 4 : 3", 4, 3, 3), (HALF_WAVE, "!(v(x)>0) ? 4 : 3", 3, 4, 4),
    (CLAMP, "v(x)>={half} ? 1 : 0", 1, 0, 0), (CLAMP, "v(x)>{half} ? 1 : 0", 0, 0, 0), (CLAMP, "v(x)<{half} ? 1 : 0", 0, 1, 1),
    (CLAMP, "i(d1)>0 ? 5 : 4", 5, 4, 4),
    (COIL, "i(l1)>0 ? 1 : 0", 1, 0, 0), (COIL, "i(l1)<=0 ? 1 : 0", 0, 1, 1), (COIL, "buf(i(l1)/{amp}+0.5)", 1, 0, 0),
    (FREEWHEEL, "i(d2)>0 ? 3 : 2", 2, 3, 2), (FREEWHEEL, "i(d1)>0 ? 3 : 2", 3, 2, 2),
]

# what makes a rate of a trapezoid on node a, and its name
RATES = [("", "ddt(v(a))"), ("r2 a b 1k\nr3 b 0 2.2k", "ddt(v(b))"), ("c2 a 0 1u", "i(c2)"), ("f2 0 b v1 1\nl2 b 0 1m", "v(b)"),
         ("e2 b 0 a 0 -3\nr2 b 0 1", "-ddt(v(b)/3)"), ("v2 b a {volts!r}\nr2 b 0 1k", "ddt(v(b))"), ("vs a b 0\nc2 b 0 1u", "i(vs)"),
         ("r2 a b 1k\nd2 b 0\nd3 0 b", "ddt(v(a))")]
RISE, HIGH, FALL, LOW = 0.14, 0.26, 0.2, 0.4  # parts of a period
COMPARISONS = [("u(x)", RISE), ("x>0 ? 1 : 0", RISE), ("x>=0 ? 1 : 0", 1 - FALL), ("x<0 ? 1 : 0", FALL), ("x<=0 ? 1 : 0", 1 - RISE),
               ("if(x>0,2,-1)", 3 * RISE - 1), ("!(x>0) ? 4 : 3", 4 - RISE), ("sgn(x)", RISE - FALL), ("3-2*sgn(-x)", 3 + 2 * (RISE - FALL))]


def check_rates(checker, case, volts, period):
    """The means over two periods of all comparisons of a rate."""
    cards, rate = case
    wave = f"PULSE(0 {volts!r} {0.4 * LOW * period!r} {RISE * period!r} {FALL * period!r} {HIGH * period!r} {period!r})"
    drive = f"i1 0 s {wave}\nv1 s a 0\nr1 a 0 1" if rate == "v(b)" else f"v1 a 0 {wave}"
    text = "\n".join(["flat", drive, cards.format(volts=volts)] + [f"b{k + 10} y{k} 0 v={formula.replace('x', rate)}\nr{k + 50} y{k} 0 1k\n"
                                              f".meas tran m{k} avg v(y{k})" for k, (formula, _) in enumerate(COMPARISONS)]
                     + [f".tran {period / 100!r} {2 * period!r}", ".end\n"])
    done = run(sys.argv[1], text, method=None, options=["--audit", "full"])
    what = f"{rate} behind {cards[:20]!r}, {volts} V, {period} s"
    if checker.check(done.status == 0, f"{what}: {done.stderr[:300]}"):
        got = {m["name"]: m["value"] for m in done.report["measurements"]}
        for k, (formula, mean) in enumerate(COMPARISONS):
            checker.close(got[f"m{k}"], mean, 1e-9, f"{what}: mean of {formula}")


def check(checker, case, volts, method):
    cards, formula, crest, behind, rest = case
    words = {"half": repr(0.5 * volts), "amp": repr(0.01 * volts)}
    rows = "\n.meas tran crest find v(y) at=0.25m\n.meas tran behind find v(y) at=0.8m\n.end\n"
    for source, tail, wanted in ((f"SIN(0 {volts!r} 1k)", ".tran 1u 0.9m" + rows, {"crest": crest, "behind": behind}),
                                 (repr(-volts), ".tran 1u 1m" + rows, {"crest": rest, "behind": rest})):
        text = "\n".join(["resting", f"v1 a 0 {source}", "r9 a 0 1k", cards.format(**words),
                          f"b7 y 0 v={formula.format(**words)}", "r8 y 0 1k", tail])
        done = run(sys.argv[1], text, method=method, options=["--audit", "full"])
        what = f"{formula} in {cards.splitlines()[-1]}, {source}, {method}"
        if checker.check(done.status == 0, f"{what}: {done.stderr[:300]}"):
            got = {m["name"]: m["value"] for m in done.report["measurements"]}
            for name, value in wanted.items():
                checker.close(got[name], value, 1e-12, f"{what}: {name}")


def main():
    checker = Checker("resting_comparisons")
    for case in some_of(CASES):
        for volts in 10.0, 2e-5, 3e3:
            for method in "auto", "lobatto":
                check(checker, case, volts, method)
    for case in some_of(RATES):
        for volts, period in (3.3, 5e-6), (2e-5, 0.02), (3e3, 1e-3):
            check_rates(checker, case, volts, period)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
