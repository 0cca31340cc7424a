#!/usr/bin/env python3
"""Slides whose segments are as long as the flow along the threshold allows, and whose ends cost few of them.

usage: slides_that_end.py PROGRAM

A comparator that holds a voltage behind a short time constant took a segment for each fiftieth of that, though nothing moved.
The end of a slide took one for each halving of what was left. Where a second comparator began to slide, the switch that it
commands counted as one that slides by itself, and steps of implicit Euler went on. Beside a coil that is cut off, whose leaks are
nanoamperes, sides had no certified answer here and there, and segments ended. All four are held to closed forms, and to numbers of
one-step problems that the steps of the flow take.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

# v(a) rises to {held} and stays there: the mean of b1 is what r1 brings.
HELD = """A comparator holds a voltage, behind which a small resistor leads to a larger capacitor
v1 p 0 10
r1 p a {ohms}
c1 a 0 {store}
rm a m {{{ohms}/1000}}
cm m 0 {{10*{store}}}
b1 a 0 i={{80/{ohms}*u(v(a)-{held})*(1+(v(p)/10)**2)}}
.tran {{{ohms}*{store}}} {{100*{ohms}*{store}}} uic
.end
"""
# v(n) has no capacitor: b0 holds it at once. v(a) gets to its threshold later, and both slide.
SECOND = """A comparator begins to slide beside another one that has no state
v1 p 0 pulse(0 10 0 {unit} {unit} 1 2)
r0 p n {ohms}
rx n a {{2*{ohms}}}
b0 n 0 i={{20/{ohms}*u(v(n)-3)*(1+(v(p)/10)**2)}}
r1 p a {{2*{ohms}}}
c1 a 0 {{{unit}/{ohms}}}
b1 a 0 i={{20/{ohms}*u(v(a)-2.5)*abs(v(p))/10}}
.tran {unit} {{100*{unit}}} uic
.end
"""
# The current of the source falls below what r0 takes at the threshold, and v(a) leaves it.
LEFT = """A clamp that slides while there is current for it
i1 0 a pwl(0 {amperes} {{1000*{unit}}} 0)
c1 a 0 {{{unit}*{amperes}/10}}
r0 a 0 {{40/{amperes}}}
s1 a b a ref clamp
rb b 0 {{5/{amperes}}}
vr ref 0 20
.model clamp sw(ron={{0.1/{amperes}}} vt=0)
.tran {{5*{unit}}} {{900*{unit}}} uic
.end
"""

# a chopper that holds its current, beside a filter that is cut off: its coil comes to rest, and leaks are all that flows there
CUT_OFF = """cut off
v1 p 0 {volts!r}
.model sw sw(vt=0.5 ron={ron!r} roff={roff!r})
.model d d
b1 c1 0 v={{i(l1)<{limit!r} ? 1 : 0}}
s1 p a1 c1 0 sw
d1 0 a1 d
l1 a1 o1 {coil!r}
r1 o1 0 {load!r}
vg g 0 PULSE(1 0 {at!r} {edge!r} {edge!r} 1 2)
s2 p a2 g 0 sw
d2 0 a2 d
l2 a2 o2 {coil!r}
c2 o2 0 {store!r}
r2 o2 0 {rest!r}
.tran {step!r} {stop!r} uic
.end
"""


def run(checker, program, name, netlist, most):
    result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return None
    problems = result.report["work"]["osnsp"]
    checker.check(problems <= most, f"{name}: {problems} one-step problems, and {most} are enough")
    return [dict(zip(result.names, row)) for row in result.rows]


def check_close(checker, name, value, wanted):
    checker.check(abs(value - wanted) <= 1e-8 * abs(wanted), f"{name}: {value!r} instead of {wanted!r}")


def check_held(checker, program, ohms, store, held):
    name = f"held at {held} V by {ohms} ohm, {store} F"
    rows = run(checker, program, name, HELD.format(ohms=ohms, store=store, held=held), 60000)
    if rows is not None:
        check_close(checker, name + ": v(a)", rows[-1]["v(a)"], held)
        check_close(checker, name + ": v(m)", rows[-1]["v(m)"], held)
        check_close(checker, name + ": i(v1)", rows[-1]["i(v1)"], -(10.0 - held) / ohms)


def check_second(checker, program, ohms, unit):
    name = f"a second one, {ohms} ohm, {unit} s"
    rows = run(checker, program, name, SECOND.format(ohms=ohms, unit=unit), 40000)
    if rows is not None:
        check_close(checker, name + ": v(n)", rows[-1]["v(n)"], 3.0)
        check_close(checker, name + ": v(a)", rows[-1]["v(a)"], 2.5)
        check_close(checker, name + ": i(v1)", rows[-1]["i(v1)"], -7.0 / ohms - 7.5 / (2.0 * ohms))


def check_left(checker, program, amperes, unit):
    name = f"left, {amperes} A, {unit} s"
    rows = run(checker, program, name, LEFT.format(amperes=amperes, unit=unit), 5000)
    if rows is None:
        return
    # c v' = i - v/r with i = amperes (1 - t/(1000 unit)): in units of `unit` and 1 V, r c = 4 units.
    left = 500.0
    for row in rows:
        t = row["time"] / unit
        if t > left + 1.0:
            since = t - left
            steady = 40.0 * (1.0 - (t - 4.0) / 1000.0)
            at_end = 40.0 * (1.0 - (left - 4.0) / 1000.0)
            wanted = steady + (20.0 - at_end) * math.exp(-since / 4.0)
            check_close(checker, f"{name}: v(a) at {t:.6g}", row["v(a)"], wanted)
        elif 100.0 < t < left - 1.0:
            check_close(checker, f"{name}: v(a) at {t:.6g}", row["v(a)"], 20.0)


def check_cut_off(checker, program, volts, limit, unit):
    ohm = volts / limit
    load, rest, roff = 0.4 * ohm, 1.6 * ohm, 1e8 * ohm
    store = 2.0 * unit / rest
    name = f"cut off, {volts} V, {limit} A, {unit} s"
    netlist = CUT_OFF.format(volts=volts, ron=1e-4 * ohm, roff=roff, limit=limit, coil=unit * ohm, load=load, at=unit, edge=1e-3 * unit,
                             store=store, rest=rest, step=0.05 * unit, stop=10.0 * unit)
    rows = run(checker, program, name, netlist, 100000)
    if rows is None:
        return
    for row in rows:
        if row["time"] > 4.0 * unit:
            check_close(checker, f"{name}: i(l1) at {row['time']}", row["i(l1)"], limit)
            check_close(checker, f"{name}: v(o1) at {row['time']}", row["v(o1)"], limit * load)
    first = next(row for row in rows if row["time"] > 6.0 * unit)
    leak = volts * rest / (rest + roff)
    decay = math.exp((first["time"] - rows[-1]["time"]) / store * (1.0 / rest + 1.0 / roff))
    check_close(checker, name + ": v(o2)", rows[-1]["v(o2)"], leak + (first["v(o2)"] - leak) * decay)


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("slides that end")
    for ohms, store, held in ((500.0, 1.6e-13, 2.3), (1e5, 1e-9, 1.1), (2.0, 1e-6, 4.7)):
        check_held(checker, program, ohms, store, held)
    for ohms, unit in ((1e6, 1e-5), (50.0, 1e-8)):
        check_second(checker, program, ohms, unit)
    for amperes, unit in ((2.0, 1e-7), (1e-3, 1e-3)):
        check_left(checker, program, amperes, unit)
    for volts, limit, unit in ((24.0, 2.0, 1e-3), (3.0, 1e-3, 1e-5), (400.0, 30.0, 1e-2)):
        check_cut_off(checker, program, volts, limit, unit)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
