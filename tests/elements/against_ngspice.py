#!/usr/bin/env python3
"""Netlists that ngspice and dalcs both read as they are: the same signals, within a part in 1000;
with exponential diodes, which dalcs replaces by tangents, within 4 in 1000.

usage: against_ngspice.py PROGRAM TOOLS
"""

import bisect
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, sys.argv[2])
import ngspice_batch  # noqa: E402
from dalcs_program import Checker, run  # noqa: E402

SKIPPED = 77  # what meson takes for "skipped"

SOURCES = """sources
V1 a 0 AM(1.5 2 100 1k 1m)
V2 b 0 SFFM(0.5 1 1k 3 100 20 40)
V3 c 0 PULSE(0 1 0.1m 0.1m 0.1m 0.3m 1m 2)
V4 d 0 PWL(0 0 1m 1 2m 0.5) r=1m td=0.3m
R1 a x 1k
R2 b x 1k
R3 c x 1k
R4 d x 1k
C1 x 0 0.5u
.tran 2u 5m 0 2u
.end
"""

SWITCH = """a switch by a current
V1 in 0 SIN(0 10 50)
Vm in a
R1 a 0 5
W1 in y Vm cs
R2 y 0 10
.model cs CSW(It=0.5 Ih=0.25 Ron=1 Roff=1Meg)
.tran 5u 40m 0 5u
.end
"""

POLYNOMIALS = """sums of controls
V1 a 0 SIN(0 3 1k)
V2 b 0 SIN(0 2 700)
R1 a 0 10
R2 b 0 4
E1 c 0 POLY(2) a 0 b 0 0.5 2 -3
G1 0 d POLY(2) (a,0) (b,0) 0.5 2 -3
F1 0 e POLY(2) V1 V2 0.25 10 -3
H1 f 0 POLY(2) V1 V2 0.25 10 -3
R3 c 0 1
R4 d 0 2
R5 e 0 3
R6 f 0 4
.tran 5u 5m 0 5u
.end
"""

DIODE = """buck converter, {model}, {load} ohm
V1 in 0 12
S1 in sw g 0 SWM
Vg g 0 PULSE(0 5 0 10n 10n 2u 5u)
D1 0 sw DX
L1 sw out 22u ic={current}
C1 out 0 100u ic=4.3
R1 out 0 {load}
.model SWM SW(Ron=1m Roff=1Meg Vt=2.5)
.model DX {model}
.options diodecurrent={current}
.tran 0.1u 2m 0 20n uic
.end
"""


# Of transistors the channel's straight line at small voltages and the body diode's tangent: 3 in 100 of the scale.
LOW_SIDE = """a coil behind a MOSFET of level 1
V1 in 0 12
R1 in x 2
L1 x d 20u
D1 d in DX
VG g 0 PULSE(0 10 1u 10n 10n 12u 25u)
M1 d g 0 0 MX
.model MX NMOS(Level=1 Vto=3 Kp=20u W=0.7 L=1u Rd=20m Rs=10m)
.model DX D(IS=1e-14)
.tran 0.1u 100u 0 10n
.end
"""

HIGH_SIDE = """a PMOS that feeds a filter
V1 in 0 24
VG g 0 PULSE(24 12 1u 20n 20n 10u 25u)
M1 s g in in MP
D1 0 s DX
L1 s out 100u
C1 out 0 10u
R1 out 0 5
.model MP PMOS(Level=1 Vto=-3 Kp=20u W=0.5 L=1u)
.model DX D(IS=1e-14)
.tran 0.1u 1m 0 20n
.end
"""

HALF_BRIDGE = """two VDMOS with dead times
V1 in 0 48
VH gh s PULSE(0 12 1u 20n 20n 4u 10u)
VL gl 0 PULSE(0 12 5.5u 20n 20n 4.5u 10u)
M1 in gh s MX
M2 s gl 0 MX
L1 s x 50u
R1 x 0 4
.model MX VDMOS(Vto=4 Kp=25 Rd=20m Rs=5m Rb=10m)
.tran 0.1u 100u 0 10n
.end
"""


def at(times, values, t):
    """Between two points."""
    k = min(max(bisect.bisect_left(times, t), 1), len(times) - 1)
    part = (t - times[k - 1]) / (times[k] - times[k - 1])
    return values[k - 1] + part * (values[k] - values[k - 1])


def compare(checker, program, netlist, signals, stop, tolerance):
    title = netlist.splitlines()[0]
    ours = run(program, netlist, method=None)
    if not checker.check(ours.status == 0, f"{title}: {ours.stderr}"):
        return
    with tempfile.TemporaryDirectory() as folder:
        theirs = ngspice_batch.run(netlist, pathlib.Path(folder), stop, 120)
    if not checker.check(theirs.table is not None, f"{title}: ngspice: {theirs.reason}"):
        return
    times = theirs.table.column("time")
    for signal in signals:
        values = theirs.table.signal(signal)
        scale = max(abs(value) for value in values)
        # Where a switch moves, a time step of ngspice is a difference of height 1.
        off = sorted(abs(x - at(times, values, t)) / scale
                     for t, x in zip(ours.time, ours.column(signal)))
        worst = off[int(0.99 * len(off))]
        checker.check(worst <= tolerance, f"{title}: {signal} is off by {worst:.2e} of its scale")


def main():
    checker = Checker("against_ngspice")
    program = sys.argv[1]
    try:
        compare(checker, program, SOURCES, ["v(a)", "v(b)", "v(c)", "v(d)", "v(x)"], 5e-3, 1e-3)
        compare(checker, program, SWITCH, ["v(y)", "i(vm)"], 40e-3, 2e-3)
        compare(checker, program, POLYNOMIALS, ["v(c)", "v(d)", "v(e)", "v(f)"], 5e-3, 1e-3)
        for model in ("D(IS=1e-14)", "D(IS=2.52n RS=50m N=1.752)"):
            for load, current in ((5, 1), (0.5, 9)):
                netlist = DIODE.format(model=model, load=load, current=current)
                compare(checker, program, netlist, ["v(out)"], 2e-3, 4e-3)
        compare(checker, program, LOW_SIDE, ["v(d)", "i(l1)"], 100e-6, 0.03)
        compare(checker, program, HIGH_SIDE, ["v(out)", "i(l1)"], 1e-3, 0.03)
        compare(checker, program, HALF_BRIDGE, ["v(x)", "i(l1)"], 100e-6, 0.03)
    except ngspice_batch.NoNgspice:
        print("ngspice is not installed")
        return SKIPPED
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
