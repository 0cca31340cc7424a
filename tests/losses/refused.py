#!/usr/bin/env python3
"""Bad .losses and .switchloss cards, each with its place: file:line:column.

usage: refused.py PROGRAM
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

NETLIST = """refused
V1 a 0 10
S1 a b g 0 sm
R1 b 0 1
Vg g 0 PULSE(0 1 0 0 0 5u 10u)
.model sm sw(vt=0.5)
.tran 1u 100u
{}
{}
.end
"""

CASES = [  # the cards, the line and column of the message, what it says
    ((".losses from=20u to=10u",), 8, 14, "not before its end"),
    ((".losses to=200u",), 8, 12, "the window ends at 0.0002 s, the run at 0.0001 s"),
    ((".losses from=100u",), 8, 14, "not before its end"),
    ((".losses from=-1u",), 8, 14, "cannot be negative"),
    ((".losses out=r9",), 8, 13, "there is no element 'r9'"),
    ((".losses out=r1,r1",), 8, 16, "named twice"),
    ((".losses for=1u",), 8, 9, "unknown parameter 'for'"),
    ((".losses", ".losses"), 9, 1, "a second .losses"),
    ((".losses", ".switchloss s1 eon v=(0 100 100) i=(0 1) e=(0 0 0 0 0 0)"), 9, 29, "does not ascend"),
    ((".losses", ".switchloss s1 eon v=(0 100) i=(2 1) e=(0 0 0 0)"), 9, 35, "does not ascend"),
    ((".losses", ".switchloss s1 eon v=(0 100) i=(0 1) e=(0 0 0)"), 9, 1, "need 4 energies, not 3"),
    ((".losses", ".switchloss s1 on v=(0 100) i=(0 1) e=(0 0 0 0)"), 9, 16, "none of eon, eoff, err"),
    ((".losses", ".switchloss s1 eon v=(0 -1) i=(0 1) e=(0 0 0 0)"), 9, 25, "cannot be negative"),
    ((".losses", ".switchloss s7 eon v=(0 1) i=(0 1) e=(0 0 0 0)"), 9, 13, "neither a switch or diode"),
    ((".losses", ".switchloss s1 err v=(0 1) i=(0 1) e=(0 0 0 0)"), 9, 13, "energy of this kind"),
    ((".losses", ".switchloss s1 eon i=(0 1) e=(0 0)"), 9, None, "v= is missing"),
]


def main():
    checker = dalcs_program.Checker("refused losses")
    for cards, line, column, text in CASES:
        netlist = NETLIST.format(*(cards + ("*",))[:2])
        run = dalcs_program.run(sys.argv[1], netlist)
        place = rf":{line}:{column if column else '[0-9]+'}: error: [^\n]*{re.escape(text)}"
        checker.check(run.status == 3 and re.search(place, run.stderr),
                      f"{cards}: {run.status}: {run.stderr}")
    plain = NETLIST.format("*", "*")
    for option in ("--losses=20u", "--losses=20u:10u", "--losses=x:1u", "--losses=-1u:1u"):
        run = dalcs_program.run(sys.argv[1], plain, options=(option,))
        checker.check(run.status == 2 and "--losses" in run.stderr, f"{option}: {run.stderr}")
    for option in ("--losses=0:200u", "--losses=100u:"):
        run = dalcs_program.run(sys.argv[1], plain, options=(option,))
        checker.check(run.status == 3 and "not a window of the run" in run.stderr, f"{option}: {run.stderr}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
