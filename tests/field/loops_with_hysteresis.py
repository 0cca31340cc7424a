#!/usr/bin/env python3
"""A switch with hysteresis that acts on its control at once, without a state in between: closed it opens, open it closes.

usage: loops_with_hysteresis.py PROGRAM

Where it is open its control goes in proportion to a source that rises from 0, and reaches Vt + Vh at a known time. Where it is
closed the control is below Vt - Vh at that time. So behind it no position agrees with the control, no time passes between
two turns, and nothing says for which part of the time the switch is closed. The run ends there with status 1, and says so.
With a capacitor at the control the same circuit oscillates; without a hysteresis the switch slides (Filippov 1988).
A switch without a resistance empties the capacitor at its control at once, and opens: that is a sawtooth, and no such loop.
"""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

INVERTER = "r{0} p n{0} 1k\ns{0} n{0} 0 n{1} 0 m"


def ring(n):
    cards = ["v1 p 0 pwl(0 0 1m 10)"] + [INVERTER.format(k, (k + 1) % n) for k in range(n)]
    return "\n".join(cards + [".model m sw(vt=5 vh=1 ron=1)"])


SHUNT = "r1 a 0 10\ns1 a 0 a 0 m\n.model m sw(vt=8 vh=1 ron=0.1)"
SENSED = "i1 0 a pwl(0 0 1m 40m)\nv2 a b 0\nr1 b 0 100"
# cards for 1 ms; switches one of which is named; the time in s; a control that it may be of
CASES = {
    "itself": (f"i1 0 a pwl(0 0 1m 2)\n{SHUNT}", ["s1"], 0.45e-3, "v(a)"),
    "large": ("i1 0 a pwl(0 0 1m 2k)\nr1 a 0 10\ns1 a 0 a 0 m\n.model m sw(vt=8k vh=1k ron=0.1)", ["s1"], 0.45e-3, "v(a)"),
    "small": ("i1 0 a pwl(0 0 1m 2u)\nr1 a 0 10\ns1 a 0 a 0 m\n.model m sw(vt=8u vh=1u ron=0.1)", ["s1"], 0.45e-3, "v(a)"),
    "a narrow one": ("i1 0 a pwl(0 0 1m 2)\nr1 a 0 10\ns1 a 0 a 0 m\n.model m sw(vt=18 vh=18m ron=0.1)", ["s1"], 0.9009e-3,
                     "v(a)"),
    "a pulse": (f"i1 0 a pwl(0 0 0.5m 1 0.55m 0 1m 0)\n{SHUNT}", ["s1"], 0.45e-3, "v(a)"),
    "a step": (f"i1 0 a pulse(0 2 0.5m 0 0 1)\n{SHUNT}", ["s1"], 0.5e-3, "v(a)"),
    "from the start": (f"i1 0 a 1\n{SHUNT}", ["s1"], 0.0, "v(a)"),
    "e": ("v1 in 0 pwl(0 0 1m 20)\nr1 in a 1k\ns1 a 0 c 0 m\ne1 c 0 a 0 2\n.model m sw(vt=12 vh=2 ron=10)", ["s1"], 0.35e-3,
          "v(c)"),
    "b": ("v1 in 0 pwl(0 0 1m 10)\nr1 in a 100\ns1 a 0 c 0 m\nb1 c 0 v={v(a)-v(in)*0.1+0.2}\n"
          ".model m sw(vt=1.75 vh=0.25 ron=1)", ["s1"], 0.2e-3, "v(c)"),
    "w": (f"{SENSED}\nw1 a 0 v2 m\n.model m csw(it=15m ih=5m ron=1)", ["w1"], 0.5e-3, "i(v2)"),
    "f": (f"{SENSED}\nf1 0 d v2 10\nr3 d 0 50\ns1 a 0 d 0 m\n.model m sw(vt=7.5 vh=2.5 ron=1)", ["s1"], 0.5e-3, "v(d)"),
    "h": (f"{SENSED}\nh1 d 0 v2 500\ns1 a 0 d 0 m\n.model m sw(vt=7.5 vh=2.5 ron=1)", ["s1"], 0.5e-3, "v(d)"),
    "a diode": ("i1 0 b pwl(0 0 1m 2)\nd1 b a d\n.model d d\n" + SHUNT, ["s1"], 0.45e-3, "v(a)"),
    "two in a circle": ("v1 p 0 pwl(0 0 1m 10)\nr1 p a 1k\ns1 a 0 q 0 m\nv2 u 0 5\ns2 u q a 0 mh\nr2 q 0 10k\n"
                        ".model m sw(vt=2.5 ron=1)\n.model mh sw(vt=5 vh=1 ron=10)", ["s2"], 0.6e-3, "v(a)"),
    "a mosfet behind it": ("v1 p 0 pwl(0 0 1m 10)\nr1 p d 1k\nm1 d g 0 0 nm\ns2 h g d 0 ms\nv2 h 0 10\nr3 g 0 10k\n"
                           ".model nm nmos(vto=3 kp=1)\n.model ms sw(vt=5 vh=1 ron=1)", ["s2"], 0.6e-3, "v(d)"),
    "of two formulas": ("i1 0 a pwl(0 0 1m 2)\nr1 a 0 10\nb1 q 0 v={if(v(a)>v(w),5,0)}\nbw w 0 v={if(v(q)>2.5,7,9)}\n"
                        "s1 a 0 q 0 m\n.model m sw(vt=2.5 ron=0.1)", ["s1"], 0.45e-3, "v(q)"),
    "of one formula": ("i1 0 a pwl(0 0 1m 2)\nr1 a 0 10\nb1 q 0 v={if(v(a)+0.4*v(q)>9,5,0)}\n"
                       "s1 a 0 q 0 m\n.model m sw(vt=2.5 ron=0.1)", ["s1"], 0.45e-3, "v(q)"),
    "of three formulas": ("v1 s 0 pwl(0 0 1m 2m)\nr1 s a 1meg\nb1 q 0 v={if(v(a)>v(w),1,0)}\nb2 n 0 v={if(v(q)>0.5,0,1)}\n"
                          "bw w 0 v={if(v(n)>0.5,0.9m,0.7m)}\ns1 a 0 q 0 m\n.model m sw(vt=0.5 ron=100k roff=1g)", ["s1"],
                          0.45045e-3, "v(q)"),
    "of a limiter": ("i1 0 a pwl(0 0 1m 2)\nr1 a 0 10\nb1 q 0 v={5*u(v(p)-8)}\nbp p 0 v={v(a)+0.2*v(q)-u(v(n)-2)}\nb2 n 0 v={5-v(q)}\n"
                     "s1 a 0 q 0 m\n.model m sw(vt=2.5 ron=0.1)", ["s1"], 0.45e-3, "v(q)"),
    "three in a ring": (ring(3), ["s0", "s1", "s2"], 0.6e-3, None),
    "five in a ring": (ring(5), ["s0", "s1", "s2", "s3", "s4"], 0.6e-3, None),
    "a coil beside it": (f"i1 0 a pwl(0 0 1m 2)\nl1 a l 1\nr2 l 0 1g\n{SHUNT}", ["s1"], 0.45e-3, "v(a)"),
    "a filter behind it": (f"i1 0 a pwl(0 0 1m 2)\nr5 a w 1g\nc5 w 0 1n\n{SHUNT}", ["s1"], 0.45e-3, "v(a)"),
    "a state elsewhere": (f"i1 0 a pwl(0 0 1m 2)\nv5 q 0 sin(0 3 5k)\nr5 q w 100\nc5 w 0 1u\ng5 0 a w 0 1n\n{SHUNT}", ["s1"],
                          0.45e-3, "v(a)"),
}


# sawtooth oscillators; what is taken at once; between which values it goes, and its period in s
SAWTEETH = {
    "a capacitor": ("i1 0 a 10m\nc1 a 0 1u\ns1 a 0 a 0 m\n.model m sw(vt=3 vh=2 ron={0})", "v(a)", 0.0, 5.0, 0.5e-3),
    "a large one": ("i1 0 a 10k\nc1 a 0 1m\ns1 a 0 a 0 m\n.model m sw(vt=3k vh=2k ron={0})", "v(a)", 0.0, 5e3, 0.5e-3),
    "read by an e": ("i1 0 a 10m\nc1 a 0 1u\ne1 b 0 a 0 1m\ns1 a 0 b 0 m\n.model m sw(vt=3m vh=2m ron={0})", "v(a)", 0.0, 5.0,
                     0.5e-3),
    "to a voltage": ("i1 0 a 10m\nc1 a 0 1u ic=2\nv2 q 0 2\ns1 a q a 0 m\n.model m sw(vt=5 vh=2 ron={0})", "v(a)", 2.0, 7.0, 0.5e-3),
    "filled": ("i1 a 0 10m\nc1 a 0 1u ic=5\nv2 q 0 5\ne1 b 0 q a 1\ns1 q a b 0 m\n.model m sw(vt=3 vh=2 ron={0})", "v(a)", 0.0,
               5.0, 0.5e-3),
}


def of(netlist, more=()):
    return "\n".join(["a loop with hysteresis", netlist, *more, ".tran 1u 1m uic", ".end", ""])


def check_end(checker, program, name, method):
    cards, switches, time, control = CASES[name]
    what = f"{name}, {method}"
    result = run(program, of(cards), method=method)
    found = re.search(r"error: (?:from|at) t = (\S+) (?:s )?(?:\(.*?\) )?(?:on )?no position of '(\w+)' agrees with its control, "
                      r"([^:]+): where it is closed that is", result.stderr)
    if not checker.check(result.status == 1 and found is not None, f"{what}: exit {result.status}: {result.stderr[:400]}"):
        return
    late = 0.0 if method is None else 2e-6  # a step of implicit Euler that ends behind the time
    checker.check(-1e-9 <= float(found[1]) - time <= 1e-9 + late, f"{what}: at {found[1]}, not {time}")
    checker.check(found[2] in switches, f"{what}: of {found[2]}")
    checker.check(control is None or found[3] == control, f"{what}: by {found[3]}")


def check_ways_out(checker, program):
    """With a capacitor at the control it goes up to 9 V and down to 7 V; without a hysteresis it stays at 8 V."""
    cards, _, _, _ = CASES["itself"]
    result = run(program, of(cards, ["c1 a 0 1u"]), method=None, options=["--audit", "full"])
    if checker.check(result.status == 0 and "slides" not in result.stderr, f"a capacitor: {result.stderr[:300]}"):
        checker.close(max(result.column("v(a)")), 9.0, 0.02, "a capacitor: the largest voltage")
    result = run(program, of(cards.replace(" vh=1", "")), method=None, options=["--audit", "full"])
    if checker.check(result.status == 0 and "slides" in result.stderr, f"without a hysteresis: {result.stderr[:300]}"):
        checker.close(result.column("v(a)")[-1], 8.0, 1e-9, "without a hysteresis: the voltage")


def check_sawtooth(checker, program, name, ron, method):
    cards, signal, low, high, period = SAWTEETH[name]
    what = f"a sawtooth, {name}, {ron} ohm, {method}"
    result = run(program, of(cards.format(ron)), method=method)
    if not checker.check(result.status == 0, f"{what}: exit {result.status}: {result.stderr[:300]}"):
        return
    values = result.column(signal)
    slack = (high - low) * (1e-6 if method is None else 2.1e-6 / period)  # two steps of implicit Euler
    checker.close(max(values), high, slack, f"{what}: the largest value")
    checker.close(min(values), low, slack, f"{what}: the least value")


# a switch beside a diode in series with a coil, closed by a comparator without hysteresis; unit of voltage, formula
BESIDE_A_DIODE = [(1.0, "v(a)-v(o)>10m ? 1 : 0"), (1.0, "u(v(a)-v(o)-10m)"), (1e3, "if(v(a)-v(o)>10,1,0)")]


def check_no_hysteresis(checker, program, unit, formula):
    """From 0.1 A to 1.1 A the diode has the switch close and the switch has itself open: both are at 10 mV, and nothing jumps."""
    netlist = (f"v1 s 0 sin(0 {10.0 * unit!r} 1k)\nl1 s a {10e-6 * unit!r}\nd1 a o d\n.model d d(ron={0.1 * unit!r})\ns1 a o g 0 m\n"
               f"b1 g 0 v={{{formula}}}\nc1 o 0 {10e-6 / unit!r}\nr1 o 0 {100.0 * unit!r}\n.model m sw(vt=0.5 ron={0.01 * unit!r})")
    what = f"{formula}, {unit} V"
    result = run(program, of(netlist).replace(" 1m uic", " 200u uic"), method=None)
    if not checker.check(result.status == 0, f"{what}: exit {result.status}: {result.stderr[:300]}"):
        return
    drops = [v for v, i in zip(result.column("v(a,o)"), result.column("i(l1)")) if 0.11 < i < 1.09]
    checker.check(len(drops) > 10, f"{what}: {len(drops)} rows")
    checker.close(max(drops), 0.01 * unit, 1e-8 * unit, f"{what}: the largest drop")
    checker.close(min(drops), 0.01 * unit, 1e-8 * unit, f"{what}: the least drop")


def main():
    program = sys.argv[1]
    checker = Checker("loops_with_hysteresis")
    for name in CASES:
        check_end(checker, program, name, None)
    for name in ("itself", "e", "w", "three in a ring", "a filter behind it"):
        check_end(checker, program, name, "euler")
    check_ways_out(checker, program)
    for unit, formula in BESIDE_A_DIODE:
        check_no_hysteresis(checker, program, unit, formula)
    for name in SAWTEETH:
        for ron in ("0", "1n"):
            check_sawtooth(checker, program, name, ron, None)
            check_sawtooth(checker, program, name, ron, "euler")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
