#!/usr/bin/env python3
"""A schematic that contradicts its netlist is refused (tools/schematics.py).

usage: refused_schematics.py SOURCE_FOLDER
"""

import pathlib
import sys

SOURCE = pathlib.Path(sys.argv[1])
sys.path += [str(SOURCE / "tests" / "support"), str(SOURCE / "tools")]
import schematics  # noqa: E402  pylint: disable=wrong-import-position,import-error
from dalcs_program import Checker  # noqa: E402  pylint: disable=wrong-import-position,import-error

NETLIST = "Half wave\nV1 in 0 SIN(0 10 50)\nD1 in out\nR1 out 0 1k\n.tran 1m 1\n"
RIGHT = """V1 sine 0,0 0,2
D1 diode 0,0 2,0 | ideal
R1 resistor 2,0 2,2 left | 1 kΩ
wire 0,2 2,2
node out 2,0
ground 0,2
"""
# what is changed, what becomes of it, a word of the message
WRONG = [
    ("D1 diode 0,0 2,0", "D1 diode 2,0 0,0", "D1"),
    ("wire 0,2 2,2\n", "", "no line joins"),
    ("ground 0,2", "ground 2,0", "0"),
    ("node out", "node p", "p"),
    ("R1 resistor 2,0 2,2", "R2 resistor 2,0 2,2", "not drawn: r1"),
    ("wire 0,2 2,2", "wire 0,2 2,2 2,0", "D1"),
    ("D1 diode", "D1 dyode", "is no part"),
    ("D1 diode 0,0 2,0", "D1 diode 0,0 2;0", "2;0"),
    ("R1 resistor 2,0 2,2 left", "R1 resistor 2,0 2,0.2 left\nwire 2,0.2 2,2", "too short"),
]


def main():
    checker = Checker("schematics")
    picture = schematics.draw(RIGHT, NETLIST, "a < b")
    checker.check(picture.count("<tspan") == 3 and "a &lt; b" in picture, picture)
    schematics.draw(RIGHT.replace("V1 sine 0,0 0,2\n", "wire 0,0 0,0\nomit V1\n"), NETLIST, "")
    for old, new, word in WRONG:
        try:
            schematics.draw(RIGHT.replace(old, new), NETLIST, "")
            checker.check(False, f"{new!r} is drawn")
        except schematics.Wrong as error:
            checker.check(word in str(error), f"{new!r}: {error}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
