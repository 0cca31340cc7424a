#!/usr/bin/env python3
"""Formulas that hold themselves, or each other: latches, flip-flops, triggers with hysteresis, timers.

usage: latches.py PROGRAM

A formula such as `v(q) > 0.5 ? 1 : 0` at q has both sides for an answer, and its threshold, between them. It keeps its side while that
one holds, as the limit of a small delay does: where what set it goes, where another formula that it reads turns and turns back, and
where a quantity reaches a threshold that could as well be kept at it. Values are those of logic, of charging capacitors and of coils.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SET = "vs s 0 PULSE(0 1 {at!r} {edge!r} {edge!r} {width!r} 1)\nvr r 0 PULSE(0 1 {late!r} {edge!r} {edge!r} {width!r} 1)\n"
LOAD = "rl q 0 1k\n"
# what holds itself, and v(q) behind the pulse at s and behind that at r, over {volts}
LATCHES = [
    (LOAD + "b1 q 0 v={{v(s)>0.5 ? {v} : (v(r)>0.5 ? 0 : (v(q)>{h} ? {v} : 0))}}", 1, 0),
    (LOAD + "b1 q 0 v={{{v}*(u(v(s)-0.5)+(1-u(v(s)-0.5))*(1-u(v(r)-0.5))*u(v(q)-{h}))}}", 1, 0),
    ("r1 e q 1k\nr2 q 0 1k\nb1 e 0 v={{v(s)>0.5 ? 2*{v} : (v(r)>0.5 ? 0 : (v(q)>0.2*{v} ? 2*{v} : 0))}}", 1, 0),
    ("r1 q 0 2\nb1 0 q i={{v(s)>0.5 ? {h} : (v(r)>0.5 ? -{h} : {h}*sgn(v(q)))}}", 1, -1),
    (LOAD + "rp p 0 3k\nb1 p 0 v={{v(s)>0.5 || v(q)>{h} ? 0 : {v}}}\nb2 q 0 v={{v(r)>0.5 || v(p)>{h} ? 0 : {v}}}", 1, 0),
    (LOAD + "b1 p 0 v={{1-u(v(q)/{v}+2*v(s)-2*v(r)-0.5)}}\nb2 a 0 v={{v(p)>0.5 ? 0 : 3}}\nb3 n 0 v={{v(a)<2 ? 1 : 0}}\n"
     "b4 q 0 v={{v(n)<0.1 ? {v} : 0}}", 1, 0),
    (LOAD + "cq q 0 1p\nrc q c 1k\ncc c 0 1p\nb1 q 0 v={{v(s)>0.5 ? {v} : (v(r)>0.5 ? 0 : (v(q)>{h} ? {v} : 0))}}", 1, 0),
    (LOAD + "b2 z 0 v={{sqrt(1+(v(q)/{v})**2)}}\nrz z 0 1k\nb1 q 0 v={{v(s)>0.5 ? {v} : (v(r)>0.5 ? 0 : (v(q)>{h} && v(z)<2 ? {v} : 0))}}",
     1, 0),
    (LOAD + "vc c 0 {v}\nsw c o q 0 m\nro o 0 1k\n.model m sw(vt={h} ron=1)\n"
     "b1 q 0 v={{v(s)>0.5 ? {v} : (v(r)>0.5 ? 0 : (v(q)>{h} ? {v} : 0))}}", 1, 0),
    (LOAD + "b1 q 0 v={{v(r)<0.5 && ((v(s)<0.5 && v(q)>{h}) || (!(v(s)<0.5) && (v(q)>{h} || (!(v(q)>{h}) && v(s)>0.5)))) ? {v} : 0}}", 1, 0),
    (LOAD + "b1 q 0 v={{v(r)<0.5 && ((v(s)<0.5 && v(q)>{h}) || v(s)>0.5) ? {v} : 0}}", 1, 0),
    ("b1 q 0 v={{v(s)>0.5 ? {v} : (v(r)>0.5 ? 0 : (v(q)>{h} ? {v} : 0))}}\nb2 p 0 v={{v(s)>0.5 ? 0 : (v(p)>{h} ? {v} : v(r)*{v})}}\n"
     "r1 q p 1k", 1, 0),
]


def check_latch(checker, case, volts, second):
    cards, high, low = case
    words = {"v": repr(volts), "h": repr(0.5 * volts)}
    at = {"at": 0.1 * second, "late": 0.6 * second, "edge": 1e-3 * second, "width": 0.1 * second}
    times = {"set": (0.15, high), "held": (0.5, high), "cleared": (0.65, low), "stays": (0.95, low)}
    text = "\n".join(["latch", SET.format(**at) + cards.format(**words)]
                     + [f".meas tran {name} find v(q) at={t * second!r}" for name, (t, _) in times.items()]
                     + [f".tran {second / 50!r} {second!r} uic", ".end\n"])
    for method in "auto", "euler":
        done = run(sys.argv[1], text, method=method, options=["--audit", "full"])
        what = f"{cards.splitlines()[-1][:60]!r}, {volts} V, {second} s, {method}"
        if checker.check(done.status == 0, f"{what}: {done.stderr[:300]}"):
            got = {m["name"]: m["value"] for m in done.report["measurements"]}
            for name, (_, value) in times.items():
                checker.close(got[name], value * volts, 1e-9 * volts, f"{what}: {name}")


def run_text(checker, what, text):
    done = run(sys.argv[1], text, method=None, options=["--audit", "full"])
    good = checker.check(done.status == 0, f"{what}: {done.stderr[:300]}")
    return {m["name"]: m["value"] for m in done.report["measurements"]} if good else None


def check_peak_current(checker, switched, scale):
    """A clock sets, the coil's current clears: it rises with 12 V to 4 A, and falls with 5 V until the clock comes."""
    stage = "sw in x q 0 m\ndf 0 x\n.model m sw(vt=0.5)" if switched else f"b2 x 0 v={{{12 * scale!r}*v(q)}}"
    period, coil = 1e-5, 2e-5
    text = "\n".join(["peak", f"vin in 0 {12 * scale!r}", f"vc clk 0 PULSE(0 1 0 1n 1n 0.1u {period!r})",
                      f"bq q 0 v={{v(clk)>0.5 ? 1 : (v(q)>0.5 && i(l1)<{4 * scale!r} ? 1 : 0)}}", stage,
                      f"l1 x o {coil!r} ic={3 * scale!r}", f"vo o 0 {5 * scale!r}", f".meas tran least find i(l1) at={period!r}",
                      f".meas tran most max i(l1) from=0 to={period!r}", f".meas tran on integ v(q) from=0.4u to={period!r}",
                      f".tran 0.1u {1.5 * period!r} uic", ".end\n"])
    what = f"peak current, {'switched' if switched else 'source'}, {scale}"
    got = run_text(checker, what, text)
    if got is not None:
        begins = 0.5e-9  # where the clock's edge passes its threshold
        rise = begins + (coil * 1.0 + 5.0 * begins) / 7.0  # 7 V over the coil take it from 3 A to 4 A
        checker.close(got["most"], 4 * scale, 1e-9 * scale, f"{what}: peak")
        checker.close(got["least"], (4 - 5.0 * (period - rise) / coil) * scale, 1e-6 * scale, f"{what}: valley")
        checker.close(got["on"], rise - 0.4e-6, 1e-6 * rise, f"{what}: time that it is on")


def check_timer(checker, volts, seconds):
    """A timer of one formula: its capacitor goes between a third and two thirds of what charges it."""
    text = "\n".join(["timer", f"bq q 0 v={{v(c)<{volts / 3!r} ? {volts!r} : (v(c)>{2 * volts / 3!r} ? 0 : (v(q)>{volts / 2!r} ? {volts!r} : 0))}}",
                      "rq q c 1k", f"cc c 0 {seconds / 1e3!r}", f".meas tran first when v(c)={volts / 2!r} rise=2",
                      f".meas tran third when v(c)={volts / 2!r} rise=4", f".meas tran most max v(c)",
                      f".meas tran least min v(c) from={2 * seconds!r} to={8 * seconds!r}", f".tran {seconds / 20!r} {8 * seconds!r} uic", ".end\n"])
    got = run_text(checker, f"timer, {volts} V", text)
    if got is not None:
        checker.close(got["third"] - got["first"], 4 * math.log(2) * seconds, 1e-7 * seconds, "timer: two periods")
        checker.close(got["most"], 2 * volts / 3, 1e-7 * volts, "timer: most")
        checker.close(got["least"], volts / 3, 1e-7 * volts, "timer: least")


def check_trigger(checker, written, volts):
    """A chopper with a trigger of one formula: its current goes between both thresholds."""
    coil, ohms = 1e-3, 2.0
    text = "\n".join(["trigger", f"vin in 0 {12 * volts!r}", f"bq q 0 v={{{written.format(a=2 * volts, b=3 * volts, d=volts)}}}",
                      "sw in x q 0 m\ndf 0 x\n.model m sw(vt=0.5)", f"l1 x o {coil!r}", f"rl o 0 {ohms!r}",
                      ".meas tran most max i(l1)", ".meas tran least min i(l1) from=0.5m to=2m",
                      f".meas tran one when i(l1)={2.5 * volts!r} rise=2", f".meas tran two when i(l1)={2.5 * volts!r} rise=3", ".tran 1u 2m uic", ".end\n"])
    got = run_text(checker, f"trigger {written}, {volts}", text)
    if got is not None:
        period = coil / ohms * (math.log((6.0 - 2.0) / (6.0 - 3.0)) + math.log(3.0 / 2.0))
        checker.close(got["most"], 3 * volts, 1e-7 * volts, f"trigger {written}: most")
        checker.close(got["least"], 2 * volts, 1e-7 * volts, f"trigger {written}: least")
        checker.close(got["two"] - got["one"], period, 1e-7 * period, f"trigger {written}: period")


def main():
    checker = Checker("latches")
    for case in some_of(LATCHES):
        for volts, second in (1.0, 1e-4), (2e4, 1.0), (3e-3, 1e-7):
            check_latch(checker, case, volts, second)
    for switched in True, False:
        for scale in 1.0, 1e-3, 500.0:
            check_peak_current(checker, switched, scale)
    for volts, seconds in (10.0, 1e-5), (2e-3, 3.0):
        check_timer(checker, volts, seconds)
    for written in ("i(l1)<{a!r}+{d!r}*v(q) ? 1 : 0", "i(l1)<{a!r} ? 1 : (i(l1)>{b!r} ? 0 : (v(q)>0.5 ? 1 : 0))",
                    "u({a!r}+{d!r}*v(q)-i(l1))"):
        for volts in 1.0, 0.02:
            check_trigger(checker, written, volts)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
