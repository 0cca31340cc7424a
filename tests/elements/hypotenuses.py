#!/usr/bin/env python3
"""hypot(x, y) where both are 0 or pass 0 together: it has a value there and no slope. One conductor of 1k, a divider of two
behind it, and a source of the hypotenuse of its two voltages: the answer is a line on each side of 0.

usage: hypotenuses.py PROGRAM
"""

import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

VOLTS = [1e-6, 1e-3, 1.0, 1e3]
SHARES = [0.05, 0.3, 1.0]  # mA of the source, for a hypotenuse of 1 V
WAVES = {
    "sin(0 {v} 50)": lambda t: math.sin(100 * math.pi * t),
    "pwl(0 0 5m {v} 10m 0 15m 0 20m {{-{v}}})": lambda t: (t / 5e-3 if t < 5e-3 else max(0.0, 2 - t / 5e-3) if t < 15e-3
                                                      else 3 - t / 5e-3),
    "sin({{{v}/2}} {{{v}/2}} 50 0 0 -90)": lambda t: 0.5 - 0.5 * math.cos(100 * math.pi * t),
}
ROWS = [0.37e-3 + k * 0.9e-3 for k in range(22)]

NETLIST = """hypotenuse of two voltages
V1 1 0 {wave}
R1 1 a 1k
Rb a b 1k
Rc b 0 1k
Rd d 0 1k
B1 a 0 I={share!r}m*hypot(v(a),v(b))
B2 d 0 V=hypot(v(1),2*v(b))
.tran 1m 20m
.end
"""


def look(program, checker, form, volt, share):
    name = f"{form} {volt:g} V {share:g}"
    result = run(program, NETLIST.format(wave=form.format(v=repr(volt)), share=share), method=None, at=ROWS,
                 options=["--audit", "full"], environment={"LC_ALL": "C"})
    if not checker.check(result.status == 0, f"{name}: exit {result.status}: {result.stderr}"):
        return
    for t, a, d in zip(ROWS, result.column("v(a)"), result.column("v(d)")):
        v = volt * WAVES[form](t)
        wanted = v / (1.5 + math.copysign(share * math.sqrt(1.25), v))
        checker.check(abs(a - wanted) <= 1e-8 * volt, f"{name}: v(a) at {t:g} is {a!r}, not {wanted!r}")
        wanted = math.hypot(v, wanted)
        checker.check(abs(d - wanted) <= 1e-8 * volt, f"{name}: v(d) at {t:g} is {d!r}, not {wanted!r}")


def check_at_rest(checker, program):
    netlist = NETLIST.format(wave="0", share=0.3).replace(".tran 1m 20m", ".op")
    result = run(program, netlist, method=None)
    checker.check(result.status == 0, f"at rest: exit {result.status}: {result.stderr}")


def main():
    program = sys.argv[1]
    checker = Checker("hypotenuses")
    check_at_rest(checker, program)
    for case in some_of(list(itertools.product(WAVES, VOLTS, SHARES)), 3):
        look(program, checker, *case)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
