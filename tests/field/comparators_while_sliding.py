#!/usr/bin/env python3
"""A comparator without hysteresis, written as a formula, commands switches: the current stays where its argument is 0.

usage: comparators_while_sliding.py PROGRAM

Along a threshold the mean of both positions has the argument of the comparator at 0 (Filippov 1988, chapter 2). Its output,
0 or 1, is then the part of the time for which the switch is on, and so are drivers that read it, and what only observes
what the switch does. A coil that a source V charges through the switch up to the current I, against R, has the closed form

    i = V/R (1 - exp(-t R/L)) up to I, then I;    the output of the comparator: 1, then R I/V.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CHOPPERS = {  # what commands s1 from i(l1) and {I}, and the height of v(g)
    "a comparator": ("b1 g 0 v={i(l1)<{I} ? 1 : 0}\ns1 a x g 0 sw", 1.0),
    "the other way": ("b1 g 0 v={i(l1)>={I} ? 0 : 5}\ns1 a x g 0 sw", 5.0),
    "u()": ("b1 g 0 v=u({I}-i(l1))\ns1 a x g 0 sw", 1.0),
    "a driver": ("b1 g 0 v={i(l1)<{I} ? 1 : 0}\nb2 h 0 v={v(g)>0.3 ? 12 : -3}\nrh h 0 1k\ns1 a x h 0 sw", 1.0),
    "a driver that inverts twice": ("b1 g 0 v={i(l1)<{I} ? 1 : 0}\ne2 m 0 g 0 -2\ns1 a x 0 m sw", 1.0),
    "an observer": ("b1 g 0 v={i(l1)<{I} ? 1 : 0}\ns1 a x g 0 sw\nb3 q 0 v={v(x)>{V}/2 ? 2 : 1}\nrq q 0 1k", 1.0),
    "a sense resistor": ("b1 g 0 v={v(o)<{I}*{R} ? 1 : 0}\ns1 a x g 0 sw", 1.0),
}
VALUES = [(12.0, 1.0, 1e-3, 2.0), (400.0, 20.0, 5e-3, 3.0), (3.3, 0.1, 2.2e-6, 10.0)]  # V, R, L, I


def chopper(kind, values):
    command, _ = CHOPPERS[kind]
    for name, value in zip("VRLI", values):
        command = command.replace("{" + name + "}", repr(value))
    V, R, L, current = values
    reached = -L / R * math.log(1.0 - R * current / V)
    return (f"chopper\nv1 a 0 {V!r}\n{command}\nd1 0 x d\nl1 x o {L!r}\nr1 o 0 {R!r}\n.model sw sw(vt=0.5)\n"
            f".model d d(ron=0)\n.tran {reached / 20!r} {4 * reached!r} uic\n.end\n", reached)


def run(checker, program, name, netlist):
    result = dalcs_program.run(program, netlist, method=None, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{name}: {result.stderr}"):
        return None
    steps = result.report["work"]
    checker.check(steps["euler_steps"] <= 10, f"{name}: {steps['euler_steps']} steps of implicit Euler")
    return result


def check_chopper(checker, program, kind, values):
    name = f"{kind}, {values}"
    V, R, L, current = values
    netlist, reached = chopper(kind, values)
    result = run(checker, program, name, netlist)
    if result is None:
        return
    worst = {"i(l1)": 0.0, "v(g)": 0.0, "v(x)": 0.0, "v(q)": 0.0}
    part = R * current / V
    height = CHOPPERS[kind][1]
    for row in result.rows:
        at = dict(zip(result.names, row))
        t = at["time"]
        if abs(t - reached) < 1e-6 * reached:
            continue
        slides = t > reached
        wanted = {"i(l1)": current if slides else V / R * (1.0 - math.exp(-t * R / L)),
                  "v(g)": height * (part if slides else 1.0), "v(x)": R * current if slides else V,
                  "v(q)": 1.0 + (part if slides else 1.0)}
        for signal in worst:
            if signal in at:
                worst[signal] = max(worst[signal], abs(at[signal] - wanted[signal]) / abs(wanted[signal] or current))
    for signal, off in worst.items():
        checker.check(off <= 1e-8, f"{name}: {signal} is off by {off:.2g}")


BRIDGE = """bridge that follows a sine
v1 p 0 48
vr r 0 sin(0 {A} 50)
bc g 0 v={{v(r)>i(l1) ? 1 : 0}}
bn h 0 v={{1-v(g)}}
s1 p a g 0 sw
s2 b 0 g 0 sw
s3 p b h 0 sw
s4 a 0 h 0 sw
l1 a x 5m
r1 x b 1
.model sw sw(vt=0.5{ron})
.tran 100u 20m uic
.end
"""


def check_bridge(checker, program, amplitude, ron):
    """From rest the current follows the reference at once: what the coil and the resistor take is the mean voltage."""
    name = f"bridge, {amplitude} A{ron}"
    result = run(checker, program, name, BRIDGE.format(A=amplitude, ron=ron))
    if result is None:
        return
    omega = 100.0 * math.pi
    own = 0.02 if ron else 0.0
    for row in result.rows:
        at = dict(zip(result.names, row))
        if at["time"] < 1e-5:
            continue
        wanted = amplitude * math.sin(omega * at["time"])
        across = 5e-3 * omega * amplitude * math.cos(omega * at["time"]) + (1.0 + own) * wanted
        if not checker.check(abs(at["i(l1)"] - wanted) <= 1e-7 * amplitude and
                             abs(at["v(g)"] - 0.5 * (1.0 + across / 48.0)) <= 1e-5,
                             f"{name}: i(l1) = {at['i(l1)']}, not {wanted}, v(g) = {at['v(g)']} at {at['time']}"):
            return


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = dalcs_program.Checker("comparators while sliding")
    for kind in CHOPPERS:
        for values in dalcs_program.some_of(VALUES):
            check_chopper(checker, program, kind, values)
    for amplitude, ron in dalcs_program.some_of([(5.0, ""), (0.2, ""), (5.0, " ron=10m")]):
        check_bridge(checker, program, amplitude, ron)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
