#!/usr/bin/env python3
"""Converters behind a sampled controller: pulses of a picosecond let hold capacitors take their values at once.

usage: sampled_controls.py PROGRAM

Where a sample jumps, what it commands turns a switch of a part that acts on it, and the diodes around that switch change
with it. No step falls back to implicit Euler, and the end is that of a run with nine stages at 1e-11.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from without_euler import compare_ends  # noqa: E402

ALLOWED = 1e-7
OHMS = {"ideal": "", "real": " ron=1m roff=10meg"}
POWER = {
    "buck": ["s4 in sw g 0 sh", "d1 0 sw", "l1 sw out 22u", "c1 out 0 100u"],
    "boost": ["l1 in sw 47u", "s4 sw 0 g 0 sh", "d1 sw out", "c1 out 0 100u"],
    "inverting": ["s4 in sw g 0 sh", "l1 sw 0 33u", "d1 no sw", "c1 no 0 100u", "e9 out 0 0 no 1"],
    "synchronous": ["s4 in sw g 0 sh", "bn gn 0 v=1-v(g)", "s5 sw 0 gn 0 sh", "d1 0 sw", "l1 sw out 22u",
                    "c1 out 0 100u"],
}
# power, input and output in V, load in ohm, period in s, both gains
CASES = [("buck", 12, 5, 2, 1e-5, 0.02, 0.01), ("buck", 24, 12, 50, 2e-5, 0.005, 0.002),
         ("boost", 12, 24, 20, 4e-6, 0.1, 0.02), ("boost", 5, 9, 200, 1e-5, 0.02, 0.01),
         ("inverting", 12, 10, 10, 2e-5, 0.005, 0.002), ("synchronous", 12, 3.3, 0.5, 1e-5, 0.02, 0.01),
         ("synchronous", 12, 3.3, 50, 4e-6, 0.1, 0.02)]


def netlist(case, ohms):
    power, volts, wanted, load, period, proportional, integral = case
    cards = [f"v1 in 0 {volts}", *POWER[power], f"r1 {'no' if power == 'inverting' else 'out'} 0 {load}",
             f"be e 0 v={wanted}-v(out)", f"vs1 s1 0 pulse(0 1 0 0 0 1p {period!r})",
             f"vs2 s2 0 pulse(0 1 {period / 2!r} 0 0 1p {period!r})", "s1 e eh s1 0 sh", "ce eh 0 1n",
             f"bi xi 0 v=v(xb)+{integral}*v(e)", "s2 xi xa s1 0 sh", "ca xa 0 1n", "bc xc 0 v=v(xa)", "s3 xc xb s2 0 sh",
             "cb xb 0 1n", f"bd d 0 v=limit({proportional}*v(eh)+v(xa),0,0.9)",
             f"vr r 0 pulse(0 1 0 {period!r} 0 0 {period!r})", "bp g 0 v=v(d)>v(r) ? 1 : 0",
             f".model sh sw(vt=0.5{ohms})", f".tran {period / 10!r} {100 * period!r} uic"]
    return "\n".join(["sampled control", *cards, ".end", ""])


if __name__ == "__main__":
    sys.exit(compare_ends(sys.argv[1], "sampled_controls", CASES, OHMS, netlist,
                          "v(out)", {"tolerance": 1e-11, "stages": 9}, ALLOWED))
