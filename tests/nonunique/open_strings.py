#!/usr/bin/env python3
"""Strings of blocking diodes and open switches: what each has of the voltage, before and after switches act, and where a
meter reads it.

usage: open_strings.py PROGRAM

The voltage of a string is that of its open switches, in equal shares, for of all answers these have the least norm of the
diodes. Where all its switches are closed, the diodes that block in its direction share it.
"""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

ELEMENT = {"D": "d{k} {p} {q} d", "R": "d{k} {q} {p} d", "S": "s{k} {p} {q} g 0 s"}
NETLIST = """{title}
v1 a 0 sin(0 10 1k)
rl a 0 1k
cb b 0 1u
rb b 0 1k
vg g 0 pulse(0 1 0.31m 1u 1u 0.2m 0.47m)
{string}
{meter}
.model d d(ron=0)
.model s sw(ron=0 vt=0.5)
.save v(a) v(b) v(g) v(n1) v(n2)
.tran 20u 2m
"""


def meter_of(node, sections):
    """A voltmeter with a cable: diodes with resistors across them, and capacitors, behind a source that only reads."""
    lines = [f"em m0 0 {node} 0 1"]
    for k in range(sections):
        lines += [f"dm{k} m{k} m{k + 1} d", f"rm{k} m{k} m{k + 1} 1k", f"cm{k} m{k + 1} 0 10n"]
    return "\n".join(lines)


def shares(string, voltage, closed):
    """The part of the voltage that each element has; None: the string conducts."""
    is_open = "S" in string and not closed
    blocks = {"D": voltage < 0 and not is_open, "R": voltage > 0 and not is_open, "S": not closed}
    n = sum(blocks[e] for e in string)
    return [blocks[e] / n for e in string] if n > 0 else None


def check(checker, program, string, sections):
    nodes = ("a", "n1", "n2", "b")
    elements = "\n".join(ELEMENT[e].format(k=k, p=nodes[k], q=nodes[k + 1])
                         for k, e in enumerate(string))
    meter = meter_of("n1", sections) if sections else ""
    at = [7.3e-6 + 20.1e-6 * k for k in range(97)]
    result = run(program, NETLIST.format(title=string, string=elements, meter=meter), at=at,
                 method=None, options=("--audit", "full"))
    where = f"{string} with {sections} sections"
    if not checker.check(result.status == 0, f"{where}: {result.status}: {result.stderr}"):
        return
    worst = 0.0
    for a, b, g, *between in zip(*(result.column(f"v({n})") for n in ("a", "b", "g", "n1", "n2"))):
        part = shares(string, a - b, g > 0.5)
        if part is None or abs(a - b) < 1e-6:
            continue
        wanted = (a - part[0] * (a - b), a - (part[0] + part[1]) * (a - b))
        worst = max(worst, *(abs(x - y) for x, y in zip(between, wanted)))
    checker.check(worst <= 1e-7, f"{where}: off by {worst:.3g} V")


def main():
    checker = Checker("open_strings")
    program = sys.argv[1]
    for string in itertools.product("DRS", repeat=3):
        check(checker, program, "".join(string), 0)
    for string, sections in (("DSS", 3), ("SRS", 12), ("RSS", 24), ("DSR", 40), ("SDS", 40)):
        check(checker, program, string, sections)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
