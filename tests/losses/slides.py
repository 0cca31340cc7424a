#!/usr/bin/env python3
"""Losses of a window in which a switch slides along its threshold: a warning names what turns. The values of a slide are means
over the positions of the switch, whose product is no mean power.

usage: slides.py PROGRAM

A chopper raises the current of a coil from 0.5 to 1 A in about 60 us and holds it there, sliding or with a hysteresis.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CHOPPER = """chopper
v1 a 0 10
s1 a x 0 m sw
d1 0 x d
l1 x y 1m ic=0.5
vs y o 0
h1 m 0 vs 1
r1 o 0 2
.model d d(ron=0)
.model sw sw(vt=-1 {hysteresis} ron=0.5)
.tran 1u 200u uic
.end
"""

CASES = [  # the window, the hysteresis, is there a warning?
    ("0:200u", "", True),
    ("100u:150u", "", True),
    ("10u:40u", "", False),
    ("0:200u", "vh=0.01", False),
]


def main():
    checker = dalcs_program.Checker("losses of slides")
    for window, hysteresis, warns in CASES:
        run = dalcs_program.run(sys.argv[1], CHOPPER.format(hysteresis=hysteresis), method=None, options=(f"--losses={window}",))
        told = "losses: 's1' turns where a switch slides along its threshold, one of 2 elements" in run.stderr
        checker.check(run.status == 0 and told == warns, f"{window} {hysteresis}: {run.status}: {run.stderr}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
