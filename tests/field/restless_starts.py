#!/usr/bin/env python3
"""Oscillators without an operating point, run without uic: a switch opens what closes it.

usage: restless_starts.py PROGRAM

A warning names the switch. The run begins with it as it stood, open, here with nothing stored: as with uic. Nothing is
wrong with the waveform. Where no position agrees with its control from some time on, the run ends there with status 1.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

ALLOWED = 1e-9
OUTPUT = ["c1 o 0 100u", "r1 o 0 5"]
# cards, stop time in s, signal, switch
CASES = {
    "buck": (["v1 in 0 12", "s1 in a 0 o m", "d1 0 a", "l1 a o 100u", *OUTPUT, ".model m sw(vt=-5 vh=0.05)"],
             1e-3, "v(o)", "s1"),
    "buck, real": (["v1 in 0 12", "s1 in a r o m", "v2 r 0 3.3", "d1 0 a dm", "l1 a o 22u", *OUTPUT,
                    ".model m sw(vt=0 vh=0.02 ron=10m)", ".model dm d(ron=10m)"], 1e-3, "v(o)", "s1"),
    "buck, no coil": (["v1 in 0 12", "s1 in a 0 o m", "r2 a o 1", *OUTPUT, ".model m sw(vt=-5 vh=0.2)"], 1e-3, "v(o)", "s1"),
    "thermostat": (["i1 0 p dc 10", "s1 p h 0 h m", "d1 p q", "v1 q 0 100", "c1 h 0 2", "r1 h 0 5",
                    ".model m sw(vt=-20 vh=1)"], 60.0, "v(h)", "s1"),
    "two sections": (["v1 in 0 24", "s1 in a 0 o m", "r2 a b 10", "c2 b 0 1u", "r3 b o 10", "c1 o 0 1u", "r1 o 0 100",
                      ".model m sw(vt=-6 vh=1)"], 1e-3, "v(o)", "s1"),
    "negative": (["v1 in 0 -15", "s1 in a o 0 m", "l1 a o 1m", "d1 a 0", *OUTPUT, ".model m sw(vt=-5 vh=0.1)"],
                 5e-3, "v(o)", "s1"),
    "by a current": (["v1 in 0 48", "s1 in a 0 n m", "h1 n 0 v2 1", "d1 0 a", "l1 a b 1m", "v2 b c 0", "r1 c 0 2",
                      ".model m sw(vt=-3 vh=0.25)"], 2e-3, "i(l1)", "s1"),
    "two converters": (["v1 in 0 12", "s1 in a 0 o m", "d1 0 a", "l1 a o 100u", *OUTPUT, "s2 in e 0 f m", "d2 0 e",
                        "l2 e f 47u", "c2 f 0 47u", "r2 f 0 3", ".model m sw(vt=-5 vh=0.05)"], 1e-3, "v(f)", "s1"),
}

# What the switch does acts on its control at once, and the control is beyond the other threshold in each position: closed it
# takes the current that closes it. No position holds for any time, and within the hysteresis nothing says for which part of
# the time each does.
NO_ANSWER = {
    "boost": (["v1 in 0 pwl(0 0 1u 5)", "l1 in a 50u", "w1 a 0 v2 m", "v2 x 0 0", "d1 a o", "c1 o x 10u", "r1 o 0 100",
               "i1 0 x dc 0", ".model m csw(it=1 ih=0.5)"], 4e-4, "w1"),
    "boost, small": (["v1 in 0 pwl(0 0 1u 5m)", "l1 in a 50n", "w1 a 0 v2 m", "v2 x 0 0", "d1 a o", "c1 o x 10m", "r1 o 0 0.1",
                      ".model m csw(it=1 ih=0.5)"], 4e-4, "w1"),
    "by a voltage": (["v1 in 0 pwl(0 0 1u 5)", "l1 in a 50u", "s1 a 0 s 0 m", "h1 s 0 v2 3", "v2 x 0 0", "d1 a o dm",
                      "c1 o x 10u", "r1 o 0 100", ".model m sw(vt=3 vh=1.5)", ".model dm d(ron=10m)"], 4e-4, "s1"),
    "flyback": (["v1 in 0 pwl(0 0 1u 5)", "l1 in a 50u", "l2 0 b 50u", "k1 l1 l2 1", "w1 a 0 v2 m", "v2 x 0 0", "d1 a o",
                 "c1 o x 10u", "r1 o 0 100", "r2 b 0 1k", ".model m csw(it=1 ih=0.5)"], 4e-4, "w1"),
}


def check_no_answer(checker, program, name):
    cards, stop, switch = NO_ANSWER[name]
    for how in ("sample", "full"):
        netlist = "\n".join([name, *cards, f".tran {stop / 200!r} {stop!r} uic", ".end", ""])
        result = run(program, netlist, method=None, options=["--audit", how])
        checker.check(result.status == 1 and f"no position of '{switch}' agrees with its control, " in result.stderr,
                      f"{name}, {how}: exit {result.status}: {result.stderr[:500]}")


def main():
    program = sys.argv[1]
    checker = Checker("restless_starts")
    for name, (cards, stop, signal, switch) in CASES.items():
        times = [stop * (k + 0.5) / 200 for k in range(200)]
        done = {how: run(program, "\n".join([name, *cards, f".tran {stop / 200!r} {stop!r} {how}", ".end", ""]), method=None,
                         at=times, options=["--audit", "full"]) for how in ("", "uic")}
        if not checker.check(all(o.status == 0 for o in done.values()),
                             f"{name}: {done[''].stderr[:300]} {done['uic'].stderr[:300]}"):
            continue
        says = f"at the operating point '{switch}' and what controls it do not agree"
        checker.check(switch is None or says in done[""].stderr, f"{name}: {done[''].stderr[:300]}")
        pairs = list(zip(done[""].column(signal), done["uic"].column(signal)))
        scale = max(abs(b) for _, b in pairs)
        off = max(abs(a - b) for a, b in pairs) / scale
        checker.check(off <= ALLOWED, f"{name}: off by {off:.2g} of {scale:.3g}")
    for name in NO_ANSWER:
        check_no_answer(checker, program, name)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
