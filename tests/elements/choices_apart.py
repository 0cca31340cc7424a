#!/usr/bin/env python3
"""Formulas that choose between numbers far apart, as a resistance of 1 mohm or 1 Gohm, against switches.

usage: choices_apart.py PROGRAM

b + c (a - b) is rounded by the larger of a and b, whatever c is. So it is built on the smaller one, and of a quotient of
1 over the numbers. Each formula is compared with the same circuit of switches S with these numbers as Ron and Roff, from
picoamperes to kiloamperes, with gates from sources and behind an RC, with AND, OR, NOT and nested choices."""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

GATES = {
    "sources": "vg g 0 pulse(0 1 0 1n 1n 5u 10u)\nvh h 0 pulse(0 1 2u 1n 1n 5u 10u)",
    "behind RC": "vp p 0 pulse(0 1 0 1n 1n 5u 10u)\nrp p g 1k\ncp g 0 0.5n\nvq q 0 pulse(0 1 2u 1n 1n 5u 10u)\n"
                 "rq q h 1k\ncq h 0 0.5n",
}
LOADS = {  # ohms of R and of the load, volts, farads
    "10 V": (1e-3, 1e9, 10.0, "rl o 0 10\ncl o 0 1u"),
    "10 V, farther apart": (1e-6, 1e15, 10.0, "rl o 0 10\ncl o 0 1u"),
    "kiloamperes": (1e-5, 1e7, 3e3, "rl o 0 1\ncl o 0 5u"),
    "10 mV": (50.0, 1e13, 1e-2, "rl o 0 100k\ncl o 0 10p"),
    "a coil and a diode": (1e-2, 1e10, 48.0, "d1 0 o d\nl1 o x 100u\nrl x 0 3\n.model d d(ron=10m)"),
}
SINGLE = "s1 a o g 0 sw\n.model sw sw(ron={on} roff={off} vt=0.5)"
BOTH = ("s1 a m g 0 sa\ns2 m o h 0 sa\nrx a m {off}\nry m o {off}\n.model sa sw(ron={half} vt=0.5)")
READ = {  # the formula and the switches that are the same
    "chosen": ("r1 a o r={{v(g)>0.5 ? {on} : {off}}}", SINGLE),
    "chosen the other way": ("r1 a o r={{v(g)<=0.5 ? {off} : {on}}}", SINGLE),
    "by if": ("r1 a o r='if(v(g)>0.5,{on},{off})'", SINGLE),
    "not": ("r1 a o r={{!(v(g)>0.5) ? {off} : {on}}}", SINGLE),
    "a sum": ("r1 a o r={{{on}+{off}*(1-u(v(g)-0.5))}}", SINGLE),
    "a current over it": ("b1 a o i={{v(a,o)/if(v(g)>0.5,{on},{off})}}", SINGLE),
    "a current by a conductance": ("b1 a o i={{v(a,o)*if(v(g)>0.5,1/{on},1/{off})}}", SINGLE),
    "a current over a sum of steps": ("b1 a o i={{v(a,o)/({on}+{off}*u(0.5-v(g)))}}", SINGLE),
    "a resistance over a sum of steps": ("r1 a o r={{1/(1/{off}+(v(g)>0.5)/{on})}}",
                                         "s1 a o g 0 sw\nr2 a o {off}\n.model sw sw(ron={on} vt=0.5)"),
    "two currents": ("b1 a o i={{v(g)>0.5 ? v(a,o)/{on} : v(a,o)/{off}}}", SINGLE),
    "the larger first": ("b1 a o i={{v(g)<=0.5 ? v(a,o)/{off} : v(a,o)/{on}}}", SINGLE),
    "E of its current": ("e1 a o value={{i(e1)*(v(g)>0.5 ? {on} : {off})}}", SINGLE),
    "and": ("r1 a o r={{v(g)>0.5 && v(h)>0.5 ? {on} : {off}}}",
            "ba y 0 v={{min(u(v(g)-0.5),u(v(h)-0.5))}}\ns1 a o y 0 sw\n.model sw sw(ron={on} roff={off} vt=0.5)"),
    "or": ("b1 a o i={{v(a,o)/((v(g)>0.5 || v(h)>0.5) ? {on} : {off})}}",
           "ba y 0 v={{max(u(v(g)-0.5),u(v(h)-0.5))}}\ns1 a o y 0 sw\n.model sw sw(ron={on} roff={off} vt=0.5)"),
    "nor": ("r1 a o r={{(v(g)<0.5 && v(h)<0.5) ? {off} : {on}}}",
            "ba y 0 v={{max(u(v(g)-0.5),u(v(h)-0.5))}}\ns1 a o y 0 sw\n.model sw sw(ron={on} roff={off} vt=0.5)"),
    "nested": ("r1 a o r={{v(g)>0.5 ? (v(h)>0.5 ? {on} : {mid}) : {off}}}",
               "bx y 0 v={{min(u(v(g)-0.5),u(v(h)-0.5))}}\nbz z 0 v={{min(u(v(g)-0.5),1-u(v(h)-0.5))}}\n"
               "s1 a o y 0 sw\ns2 a o z 0 sm\nr2 a o {off}\n.model sw sw(ron={on2} vt=0.5)\n.model sm sw(ron={mid2} vt=0.5)"),
    "a quotient by a nested choice": (
        "b1 a o i={{v(a,o)/(v(g)>0.5 ? (v(h)>0.5 ? {on} : {mid}) : {off})}}",
        "bx y 0 v={{min(u(v(g)-0.5),u(v(h)-0.5))}}\nbz z 0 v={{min(u(v(g)-0.5),1-u(v(h)-0.5))}}\n"
        "s1 a o y 0 sw\ns2 a o z 0 sm\nr2 a o {off}\n.model sw sw(ron={on2} vt=0.5)\n.model sm sw(ron={mid2} vt=0.5)"),
}


def values(on, off):
    mid = 1e3 * on
    return {"on": repr(on), "off": repr(off), "half": repr(on / 2), "mid": repr(mid),
            "on2": repr(1 / (1 / on - 1 / off)), "mid2": repr(1 / (1 / mid - 1 / off))}


def outcome_of(gates, volts, load, part):
    text = "\n".join(["choices", f"v1 a 0 {volts!r}", gates, part, load, ".tran 0.1u 60u", ".end", ""])
    return run(sys.argv[1], text, method=None, options=[])


def rows_of(outcome):
    """v(o) and i(v1) at the multiples of the step, behind what happens there."""
    rows = {}
    for t, v, i in zip(outcome.time, outcome.column("v(o)"), outcome.column("i(v1)")):
        if abs(t / 1e-7 - round(t / 1e-7)) < 1e-6:
            rows[round(t / 1e-7)] = (v, i)
    return rows


def main():
    checker = Checker("choices_apart")
    cases = itertools.product(GATES.items(), LOADS.items(), READ.items())
    for (gated, gates), (loaded, (on, off, volts, load)), (read, (formula, switches)) in some_of(cases):
        what = f"{read}, gates {gated}, {loaded}"
        numbers = values(on, off)
        made, wanted = (outcome_of(gates, volts, load, part.format(**numbers)) for part in (formula, switches))
        if not checker.check(made.status == 0 and wanted.status == 0, f"{what}: {made.stderr}{wanted.stderr}"):
            continue
        a, b = rows_of(made), rows_of(wanted)
        checker.check(set(a) == set(b) and len(a) > 500, f"{what}: {len(a)} rows, not {len(b)}")
        for k, name in enumerate(("v(o)", "i(v1)")):
            scale = max(abs(row[k]) for row in b.values())
            off_by = max(abs(a[n][k] - b[n][k]) for n in b)
            checker.check(off_by <= 3e-9 * scale, f"{what}: {name} is {off_by:.3g} off, of {scale:.3g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
