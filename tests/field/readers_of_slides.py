#!/usr/bin/env python3
"""What reads the output of a comparator that slides, and stands on sides of its own or jumps: it has the mean of both sides.

usage: readers_of_slides.py PROGRAM

A comparator holds x at 0.7 V through a resistor and a capacitor: its output, 0 V or 1 V, is 1 V for a part a of the time. With a small
delay or hysteresis f(output) is f(1) for that part and f(0) for the rest. That is not f(a), where f has a corner, a jump or a
threshold in it. Where what reads drives x as well, a is another one.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

SLIDES = "b1 q 0 v={v(x)<0.7 ? 1 : 0}\nr1 q x 1k\nc1 x 0 1n\nry x 0 20k\n"
A = 0.7 + 0.7 / 20
FED = 0.7 / 20e3 + 0.7 / 1e3 + 0.7 / 10e3  # A into x, behind 1k and 10k
SWITCH = "s1 y v1 q 0 sw\n.model sw sw(ron=1 roff=1g vt=0.5 vh={vh})\nv1 v1 0 1\nry2 y 0 999\n"
ON_SWITCH = 0.999 * A + 0.999e-6 * (1 - A)
# What reads, and v(y) behind 40 us.
READERS = {
    "a comparator": ("b2 y 0 v={v(q)>0.5 ? 1 : 0}\n", A),
    "a comparator behind a divider": ("ra q d 1k\nrb d 0 1k\nb2 y 0 v={v(d)>0.4 ? 1 : 0}\n", A),
    "two in a chain": ("b2 q2 0 v={v(q)>0.5 ? 1 : 0}\nb3 y 0 v={v(q2)>0.9 ? 2 : 0}\n", 2 * A),
    "and": ("b2 y 0 v={(v(x)>0.65)&&!(v(q)>0.5) ? 1 : 0}\n", 1 - A),
    "u()": ("b2 y 0 v={u(v(q)-0.8)}\n", A),
    "abs()": ("b2 y 0 v={abs(v(q)-0.5)}\n", 0.5),
    "max()": ("b2 y 0 v={max(v(q),0.4)}\n", A + 0.4 * (1 - A)),
    "limit()": ("b2 y 0 v={limit(v(q),0.2,0.6)}\n", 0.6 * A + 0.2 * (1 - A)),
    "a table": ("b2 y 0 v={table(v(q),0,1,0.5,3,1,0)}\n", 1 - A),
    "a square": ("b2 y 0 v={v(q)*v(q)}\n", A),
    "the same threshold": ("b2 y 0 v={v(x)<0.7 ? 3 : 0}\n", 3 * A),
    "the same threshold, from above": ("b2 y 0 v={v(x)>0.7 ? 3 : 0}\n", 3 * (1 - A)),
    "the same threshold times x": ("b2 y 0 v={v(q)*v(x)}\n", 0.7 * A),
    "a switch": (SWITCH.format(vh=0), ON_SWITCH),
    "a switch with hysteresis": (SWITCH.format(vh=0.1), ON_SWITCH),
    "a diode": ("ra q d 1k\nd1 d y dm\nry2 y 0 1k\n.model dm d(ron=0 vfwd=0.5)\n", 0.25 * A),
    "abs() that drives x": ("b2 y 0 v={abs(v(q)-0.5)}\nrz y x 10k\n", 0.5),
    "a comparator that drives x": ("b2 y 0 v={v(q)>0.5 ? 1 : 0}\nrz y x 10k\n", FED / (1e-3 + 1e-4)),
    "an inverter that drives x": ("b2 y 0 v={v(q)>0.5 ? 0 : 1}\nrz y x 10k\n", 1 - (FED - 1e-4) / (1e-3 - 1e-4)),
    "its own threshold goes by": ("vs s 0 pwl(0 0 60u 0.6)\nb2 y 0 v={v(q)+v(s)>1.2 ? 1 : 0}\n", A),
    # these stay as they are between the sides
    "a sum": ("b2 y 0 v={2*v(q)+v(x)}\n", 2 * A + 0.7),
    "the mean behind a filter": ("rf q f 10k\ncf f 0 0.1n\nb2 y 0 v={v(f)>0.5 ? 1 : 0}\n", 1.0),
    "another threshold": ("b2 y 0 v={v(x)<0.8 ? 3 : 0}\n", 3.0),
}


def check_reader(checker, program, name):
    elements, mean = READERS[name]
    netlist = f"{name}\n{SLIDES}{elements}rl y z 10k\nrl2 z 0 1g\n.tran 0.5u 60u uic\n.end\n"
    result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return
    checker.check(result.report["work"]["euler_steps"] <= 2, f"{name}: steps of implicit Euler")
    worst = max(abs(y - mean) for t, y in zip(result.column("time"), result.column("v(y)")) if t > 40e-6)
    checker.check(worst <= 1e-6, f"{name}: v(y) off by {worst:.2e}")


def check_passing(checker, program):
    """A reader that begins to turn while the comparator slides does so when one side reaches its threshold, at 20 us."""
    netlist = (f"passing\n{SLIDES}vs s 0 pwl(0 0 60u 0.6)\nb2 y 0 v={{v(q)+v(s)>1.2 ? 1 : 0}}\nrl y 0 10k\n.tran 0.5u 60u uic\n.end\n")
    result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
    if checker.check(result.status == 0, f"passing: {result.stderr}"):
        worst = 0.0
        for t, y in zip(result.column("time"), result.column("v(y)")):
            if t > 2e-6 and abs(t - 20e-6) > 1e-9:
                worst = max(worst, abs(y - (A if t > 20e-6 else 0.0)))
        checker.check(worst <= 1e-6, f"passing: v(y) off by {worst:.2e}")


def check_euler(checker, program):
    """With the method euler nothing slides: a warning says what the values are not."""
    for reader, is_told in ((READERS["a comparator"][0], True), ("b2 y 0 v={v(q)<0.5 ? 1 : 0}\n", True), (READERS["a sum"][0], False)):
        netlist = f"euler\n{SLIDES}{reader}rl y 0 10k\n.tran 0.5u 60u uic\n.end\n"
        result = dalcs_program.run(program, netlist, method="euler", options=[])
        checker.check(result.status == 0, f"euler: {result.stderr}")
        checker.check(("'b1' stands between its sides" in result.stderr) == is_told, f"euler: {reader}{result.stderr}")


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = dalcs_program.Checker("readers of slides")
    for name in dalcs_program.some_of(list(READERS)):
        check_reader(checker, program, name)
    check_passing(checker, program)
    check_euler(checker, program)
    return checker.finish()


sys.exit(main())
