#!/usr/bin/env python3
"""Comparators of formulas that read each other, one of them in a loop with a capacitor or a coil.

usage: chains_that_slide.py PROGRAM

One comparator keeps x at its threshold T; others read its output, and drive x. All at their thresholds is an answer of the formulas. With a
small delay, or a small hysteresis, none of them rests there: they go from side to side together. So each output is the part of the
time that the first one gives it (Filippov 1988, chapter 2): of two sides with the slopes a > 0 and b < 0 of x, the one with a for the part
(T' - b)/(a - b), whatever the thresholds of the others are.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

FIRST = "b2 q2 0 v={v(x)>v(t) ? 1 : 0}\n"
# What drives x from q2; then v(q2) along v(x) = v(t) = T with the slope S (V/s), and the steps that are allowed.
RC = "r1 q1 x 1k\nc1 x 0 1n\nry x 0 20k\n"


def of_rc(t, s):
    return 1.0 - (t + 1e3 * (t / 20e3 + 1e-9 * s))


def of_diode(t, s):
    return 1.0 - (t / 20e3 + 1e-9 * s) * 1e3 / (1.0 - t)


CHAINS = {
    "two": (FIRST + "b1 q1 0 v={v(q2)<0.5 ? 1 : 0}\n" + RC, of_rc),
    "another threshold": (FIRST + "b1 q1 0 v={v(q2)<0.1 ? 1 : 0}\n" + RC, of_rc),
    "three": (FIRST + "b3 q3 0 v={v(q2)<0.4 ? 1 : 0}\nb1 q1 0 v={v(q3)>0.6 ? 1 : 0}\n" + RC, of_rc),
    "four": (FIRST + "b3 q3 0 v={v(q2)<0.4 ? 5 : -5}\nb4 q4 0 v={v(q3)>1 ? 0 : 3}\nb1 q1 0 v={v(q4)>2 ? 0 : 1}\n" + RC, of_rc),
    "a divider": (FIRST + "rm1 q2 m 1k\nrm2 m 0 3k\nb1 q1 0 v={v(m)<0.25 ? 1 : 0}\n" + RC, of_rc),
    "u()": ("b2 q2 0 v={u(v(x)-v(t))}\nb1 q1 0 v={u(0.5-u(v(q2)-0.5))}\n" + RC, of_rc),
    "a sum": (FIRST + "vs s 0 sin(0 0.2 90k)\nb1 q1 0 v={v(q2)+v(s)<0.5 ? 1 : 0}\n" + RC, of_rc),
    "a part of x": (FIRST + "b1 q1 0 v={v(q2)+0.1*v(x)<0.5 ? 1 : 0}\n" + RC, of_rc),
    "and": (FIRST + "b3 q3 0 v={v(x)<0.95 ? 1 : 0}\nb1 q1 0 v={v(q2)<0.5 && v(q3)>0.5 ? 1 : 0}\n" + RC, of_rc),
    "a diode": (FIRST + "b1 q1 0 v={v(q2)<0.5 ? 1 : 0}\nr1 q1 a 1k\nd1 a x dm\n.model dm d(ron=0 vfwd=0)\nc1 x 0 1n\nry x 0 20k\n", of_diode),
    "a coil": ("b2 q2 0 v={1k*i(l1)>v(t) ? 1 : 0}\nb1 q1 0 v={v(q2)<0.5 ? 1 : 0}\nl1 q1 y 1m\nry y 0 1k\n", lambda t, s: 1.0 - t - 1e-6 * s),
}
THRESHOLDS = {  # v(t): what it is, and T and S at a time
    "at rest": ("vt t 0 0.7\n", lambda t: (0.7, 0.0)),
    "a sine": ("vt t 0 sin(0.5 0.05 50k)\n",
               lambda t: (0.5 + 0.05 * math.sin(1e5 * math.pi * t), 5e3 * math.pi * math.cos(1e5 * math.pi * t))),
}


def check_chain(checker, program, name, chain, threshold):
    elements, part = CHAINS[chain]
    source, track = THRESHOLDS[threshold]
    netlist = f"{name}\n{source}{elements}r0 q2 z 10k\nc0 z 0 0.3n\n.tran 0.5u 25u uic\n.end\n"
    result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return
    work = result.report["work"]
    checker.check(work["euler_steps"] <= 2, f"{name}: {work['euler_steps']} steps of implicit Euler")
    worst = 0.0
    for t, value in zip(result.column("time"), result.column("v(q2)")):
        if t > 5e-6:
            worst = max(worst, abs(value - part(*track(t))))
    checker.check(worst <= 1e-6, f"{name}: v(q2) off by {worst:.2e}")


def check_coupled(checker, program):
    """Two chains that act on each other each keep their own threshold."""
    netlist = ("coupled\nb2 q2 0 v={v(x)>0.7 ? 1 : 0}\nb1 q1 0 v={v(q2)<0.5 ? 1 : 0}\nr1 q1 x 1k\nc1 x 0 1n\n"
               "b4 p2 0 v={v(y)>0.4 ? 1 : 0}\nb3 p1 0 v={v(p2)<0.3 ? 1 : 0}\nr3 p1 y 1k\nc3 y 0 2n\nrxy x y 3k\n.tran 0.5u 40u uic\n.end\n")
    result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
    if checker.check(result.status == 0, f"coupled: {result.stderr}"):
        for signal, value in (("v(q2)", 0.2), ("v(p2)", 0.7)):
            checker.check(abs(result.column(signal)[-1] - value) <= 1e-8, f"coupled: {signal} is {result.column(signal)[-1]}")


def check_start(checker, program):
    """An operating point has the answer of the formulas; behind it they go from side to side."""
    elements, part = CHAINS["two"]
    netlist = f"start\nvt t 0 0.7\n{elements}.tran 0.5u 10u\n.end\n"
    result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
    if checker.check(result.status == 0, f"start: {result.stderr}"):
        worst = max(abs(value - part(0.7, 0.0)) for value in result.column("v(q2)")[1:])
        checker.check(worst <= 1e-6, f"start: v(q2) off by {worst:.2e}")


def check_starts(checker, program):
    """Of two that are at their thresholds from the start on, what each is known to is that of its argument, on whichever side it stands."""
    for scale, seconds, above in ((1.0, 1.0, "<"), (1e3, 1e3, ">"), (1e-3, 1e-3, "<")):
        c, t = 1e-9 * seconds, 1e-6 * seconds
        part = [1 - 0.583 - (0.583 / 20 + (0.583 - 0.773) / 4), 1 - 0.773 - (0.773 / 20 + (0.773 - 0.583) / 4)]
        other = ">" if above == "<" else "<"
        cards = [card for k, threshold in enumerate((0.583, 0.773)) for card in (
            f"b2{k} q{k} 0 v={{v(x{k}){other}{threshold * scale!r} ? 1 : 0}}", f"b1{k} p{k} 0 v={{v(q{k}){above}0.3 ? {scale!r} : 0}}",
            f"r{k} p{k} x{k} 1k", f"c{k} x{k} 0 {c * (k + 1)!r}", f"ry{k} x{k} 0 20k")]
        name = f"started together, {scale} V, {seconds} us"
        netlist = "\n".join([name, *cards, "rx x0 x1 4k", f".tran {0.1 * t!r} {20 * t!r}", ".end", ""])
        result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
        if checker.check(result.status == 0, f"{name}: {result.stderr}"):
            checker.check(result.report["work"]["steps"] <= 200, f"{name}: {result.report['work']['steps']} steps")
            for k in range(2):
                mean = part[k] if above == "<" else 1.0 - part[k]
                checker.check(abs(result.column(f"v(q{k})")[-1] - mean) <= 1e-7, f"{name}: v(q{k}) {result.column(f'v(q{k})')[-1]}, not {mean}")


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = dalcs_program.Checker("chains that slide")
    for chain in dalcs_program.some_of(list(CHAINS)):
        for threshold in THRESHOLDS:
            check_chain(checker, program, f"{chain}, {threshold}", chain, threshold)
    check_coupled(checker, program)
    check_start(checker, program)
    check_starts(checker, program)
    return checker.finish()


sys.exit(main())
