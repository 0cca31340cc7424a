#!/usr/bin/env python3
"""Losses, powers and rms values of windows in which switches slide along their thresholds: means of what they are in each position,
in closed form, not products of means.

usage: slides.py PROGRAM

Each circuit stands still in the mean, so that each switch is closed for a part of the time that its voltages and currents tell.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CHOPPER = """chopper
v1 a 0 {v}
s1 a x 0 m sw
d1 0 x d
l1 x y 1m ic={i}
vs y o 0
h1 m 0 vs 1
r1 o 0 {r}
.model d d(ron={rd} vfwd={vd})
.model sw sw(vt=-{i} ron={rs})
.tran 1u 200u uic
.losses from=10u to=153u
.meas tran p avg p(s1) from=10u to=153u
.meas tran e integ v(a,x)*i(s1) from=10u to=153u
.meas tran v rms v(x) from=10u to=153u
.meas tran i rms i(v1) from=10u to=153u
.meas tran b avg abs(v(x)-{v}/2) from=10u to=153u
.meas tran m max p(s1) from=10u to=153u
.end
"""

RELAY = """a relay that holds a capacitor through a divider, with a leak
v1 a 0 12
s1 a c r c sw
r1 a c 10k
c1 c 0 1u ic=5
r2 c 0 1k
vr r 0 5
.model sw sw(vt=0 ron={ron} roff={roff})
.tran 10u 1m uic
.losses
.end
"""

TWO = """two choppers on one load
v1 a 0 10
s1 a x 0 m sw
d1 0 x d
l1 x y 1m ic=1
vs y o 0
h1 m 0 vs 1
v2 a2 0 30
s2 a2 x2 0 m2 sw2
d2 0 x2 d
l2 x2 y2 2m ic=2
vs2 y2 o 0
h2 m2 0 vs2 1
r1 o 0 2
.model d d(ron=0.02)
.model sw sw(vt=-1 ron=0.5)
.model sw2 sw(vt=-2 ron=0.2)
.tran 1u 200u uic
.losses
.meas tran both avg p(s1)+p(s2)
.end
"""

UNKNOWN = """values that no mean over positions is had of
v1 a 0 10
s1 a x 0 m sw
d1 0 x d
l1 x y 1m ic=1
vs y o 0
h1 m 0 vs 1
r1 o 0 2
.model d d(ron=0)
.model sw sw(vt=-1 ron=0.5)
.tran 1u 200u uic
.print tran p(s1)
.meas tran t0 param='20u'
.meas tran late avg p(s1) from='t0' to=33u
.meas tran there find p(s1) at=50u
.meas tran mean avg i(s1) from='t0' to=33u
.switchloss s1 eon v=(0 400) i=(0 10 20) e=(0 0 0 0 1m 2m)
.losses
.end
"""


class Told:
    """What a run told of a circuit."""

    def __init__(self, checker, netlist):
        self.run = dalcs_program.run(sys.argv[1], netlist, method=None)
        checker.check(self.run.status == 0, self.run.stderr)
        losses = self.run.report["losses"]
        losses = losses[0] if isinstance(losses, list) else losses
        self.balance = losses["balance"]
        self.element = {e["element"]: e for e in losses["elements"]}
        self.measured = {m["name"]: m.get("value") for m in self.run.report.get("measurements", [])}


def near(checker, told, expected, scale, what):
    checker.check(told is not None and abs(told - expected) < 1e-8 * scale, f"{what}: {told} for {expected}")


def chopper(checker, v=10.0, i=1.0, r=2.0, rd=0.0, vd=0.0, rs=0.5):
    told = Told(checker, CHOPPER.format(v=v, i=i, r=r, rd=rd, vd=vd, rs=rs))
    closed, opened = v - rs * i, -vd - rd * i  # v(x)
    part = (r * i - opened) / (closed - opened)
    scale = v * i
    element = told.element
    for name, power in (("v1", -part * scale), ("s1", part * rs * i * i), ("d1", (1 - part) * (vd + rd * i) * i), ("r1", r * i * i)):
        near(checker, element[name]["power"], power, scale, f"{name} at {v} V, {i} A")
    near(checker, element["s1"]["i_rms"], math.sqrt(part) * i, i, "i_rms of s1")
    near(checker, element["d1"]["v_rms"], math.sqrt(part * closed**2 + (1 - part) * opened**2), v, "v_rms of d1")
    near(checker, told.balance, 0.0, scale * 143e-6, "balance")
    near(checker, told.measured["p"], part * rs * i * i, scale, "avg p(s1)")
    near(checker, told.measured["m"], part * rs * i * i, scale, "max p(s1)")
    near(checker, told.measured["e"], part * rs * i * i * 143e-6, scale * 143e-6, "integ v(a,x)*i(s1)")
    near(checker, told.measured["v"], math.sqrt(part * closed**2 + (1 - part) * opened**2), v, "rms v(x)")
    near(checker, told.measured["i"], math.sqrt(part) * i, i, "rms i(v1)")
    near(checker, told.measured["b"], part * abs(closed - v / 2) + (1 - part) * abs(opened - v / 2), v, "avg abs()")


def relay(checker, ron, roff):
    told = Told(checker, RELAY.format(ron=ron, roff=roff))
    closed, opened = 7.0 / ron, 7.0 / roff
    part = (5e-3 - 0.7e-3 - opened) / (closed - opened)
    near(checker, told.element["s1"]["power"], 7.0 * (4.3e-3), 0.06, f"relay of {ron} ohm")
    near(checker, told.element["s1"]["i_rms"], math.sqrt(part * closed**2 + (1 - part) * opened**2), closed, "its i_rms")
    near(checker, told.element["v1"]["power"], -0.06, 0.06, "its source")


def two(checker):
    told = Told(checker, TWO)
    powers = {}
    for k, (v, i, ron) in enumerate(((10.0, 1.0, 0.5), (30.0, 2.0, 0.2)), 1):
        part = (6.0 + 0.02 * i) / (v - ron * i + 0.02 * i)
        powers |= {f"s{k}": part * ron * i * i, f"d{k}": (1 - part) * 0.02 * i * i, f"v{k}": -part * v * i}
    for name, power in powers.items():
        near(checker, told.element[name]["power"], power, 18.0, f"{name} of two")
    near(checker, told.balance, 0.0, 18.0 * 200e-6, "balance of two")
    near(checker, told.measured["both"], powers["s1"] + powers["s2"], 18.0, "p(s1)+p(s2)")


def unknown(checker):
    told = Told(checker, UNKNOWN)
    near(checker, told.measured["mean"], 2 / 9.5, 1.0, "a mean of a signal")
    for name in ("late", "there"):
        checker.check(told.measured[name] is None, f"{name}: {told.measured[name]}")
    for words in ("late: a switch slides", "there: a switch slides", "'p(s1)' is computed from these means", "no energy of its table is counted"):
        checker.check(words in told.run.stderr, f"no '{words}': {told.run.stderr}")


def main():
    checker = dalcs_program.Checker("losses of slides")
    chopper(checker)
    chopper(checker, v=1e3, i=50.0, r=10.0, rd=1e-3, vd=1.5, rs=2e-3)
    chopper(checker, v=5e-3, i=1e-3, r=2.0, rd=0.1, vd=1e-4, rs=0.0)
    relay(checker, 200.0, 1e5)
    relay(checker, 1e3, 1e12)
    two(checker)
    unknown(checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
