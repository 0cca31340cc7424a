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
C1 x 0 0.5u IC=0
.tran 2u 5m 0 2u uic
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

BULK = """a buck converter whose high side has its bulk on ground
V1 in 0 12
VG g s PULSE(0 10 1u 20n 20n 10u 25u)
M1 in g s 0 MX
L1 s out 100u
C1 out 0 10u
R1 out 0 5
.model MX NMOS(Level=1 Vto=2 Kp=20u W=1 L=2u)
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


DIGITAL = """flip-flops and gates between bridges
V1 clk 0 PULSE(0 5 10n 1p 1p 20n 50n)
V2 d 0 PULSE(0 5 0 1p 1p 80n 160n)
V3 s 0 PULSE(0 5 123n 1p 1p 5n 1)
aadc [clk d s] [dclk dd ds] adc
.model adc adc_bridge(in_low=1 in_high=4 rise_delay=2n fall_delay=3n)
aff dd dclk ds null q nq ff
.model ff d_dff(clk_delay=4n set_delay=7n rise_delay=1n fall_delay=2n)
ajk dd ~dd dclk null ds j nj jk
.model jk d_jkff(clk_delay=3n reset_delay=5n)
atff q dclk null null t nt tf
.model tf d_tff(clk_delay=6n)
ag1 [q ~dd dclk] g1 nand
.model nand d_nand(rise_delay=2n fall_delay=4n)
ag2 [q dd] g2 xor
.model xor d_xor(rise_delay=2n fall_delay=1n)
adac [q nq j t g1 g2] [aq anq aj at ag ax] dac
.model dac dac_bridge(out_low=-1 out_high=3 t_rise=1n t_fall=2n)
r1 aq 0 1k
r2 anq 0 1k
r3 aj 0 1k
r4 at 0 1k
r5 ag 0 1k
r6 ax 0 1k
.tran 0.1n 800n 0 0.1n
.end
"""

GATES = """gates, latches and a divider, an oscillator's bits
v1 clk 0 PULSE(0 5 10n 1p 1p 20n 50n)
v2 d 0 PULSE(0 5 3n 1p 1p 80n 160n)
v3 e 0 PULSE(0 5 33n 1p 1p 60n 130n)
v4 k 0 2
aadc [clk d e] [dclk dd de] adc
.model adc adc_bridge(in_low=1 in_high=4 rise_delay=2n fall_delay=3n)
a1 [dclk dd ~de] g1 and
.model and d_and(rise_delay=2n fall_delay=4n)
a2 [dclk dd de] g2 or
.model or d_or(rise_delay=2n fall_delay=4n)
a3 [dclk dd] g3 nor
.model nor d_nor(rise_delay=3n fall_delay=1n)
a4 [dclk dd de] g4 xnor
.model xnor d_xnor(rise_delay=3n fall_delay=2n)
a5 dd g5 buf
.model buf d_buffer(rise_delay=5n fall_delay=2n)
a6 dd g6 inv
.model inv d_inverter(rise_delay=5n fall_delay=2n)
a7 dclk g7 div
.model div d_fdiv(div_factor=3 high_cycles=2 rise_delay=2n fall_delay=3n)
a8 up pu
.model pu d_pullup
a9 down pd
.model pd d_pulldown
a10 sd rd dclk null null g8 g9 srff
.model srff d_srff(clk_delay=3n reset_delay=5n rise_delay=1n fall_delay=2n)
a11 dd dclk null null h1 h2 dl
.model dl d_dlatch(data_delay=4n enable_delay=4n rise_delay=1n fall_delay=2n)
a12 dd ~dd dclk null null h3 h4 sl
.model sl d_srlatch(sr_delay=4n enable_delay=4n rise_delay=1n fall_delay=2n)
a13 [dd ~de] sd and
a14 [~dd de] rd and
a15 k h5 osc
.model osc d_osc(cntl_array=[0 1 3] freq_array=[3meg 7meg 19meg] duty_cycle=0.3 init_phase=90)
adac [g1 g2 g3 g4 g5 g6 g7 g8 g9 h1 h2 h3 h4 h5 up down] [a1 a2 a3 a4 a5 a6 a7 a8 a9 b1 b2 b3 b4 b5 u d0] dac
.model dac dac_bridge(out_low=-1 out_high=3 t_rise=1n t_fall=2n)
.tran 0.1n 800n 0 0.1n
.end
"""

PRODUCTS = """products, quotients, a diode of straight lines, a switch, a line
v1 in 0 sin(0 2 1k)
v2 b 0 sin(3 1 700)
v3 p 0 pulse(0 1 0.1m 1n 1n 0.4m 1m)
a1 [in b] m mm
.model mm mult(in_offset=[0.1 -0.2] in_gain=[2 -1] out_gain=3 out_offset=-0.5)
a2 in b q md
.model md divide(num_offset=0.1 num_gain=2 den_offset=0.2 den_gain=1.5 out_gain=3 out_offset=0.1)
a3 p %gd(in s) ms
.model ms aswitch(cntl_off=0 cntl_on=1 r_off=1meg r_on=10 log=TRUE)
a5 %gd(in d) msd
.model msd sidiode(Ron=10 Roff=1meg Vfwd=0.6 Vrev=1.2 Rrev=30)
t1 b 0 f 0 z0=50 td=50u
rt f 0 150
rs s 0 100
rd d 0 100
rm m 0 1k
rq q 0 1k
.tran 1u 4m 0 1u
.end
"""

BLOCKS = """blocks of straight lines
v1 in 0 sin(0 2 1k)
v2 b 0 pulse(-1 1 0.1m 1u 1u 0.4m 1m)
a1 in g1 mg
.model mg gain(in_offset=0.1 gain=-3 out_offset=0.5)
a2 [in b] s1 ms
.model ms summer(in_offset=[0.1 -0.2] in_gain=[2 -1] out_gain=3 out_offset=-0.5)
a3 in l1 ml
.model ml limit(in_offset=0.1 gain=-2.5 out_lower_limit=-1 out_upper_limit=2 limit_range=1e-9 fraction=false)
a4 b i1 mi
.model mi int(in_offset=0.05 gain=1000 out_lower_limit=-0.15 out_upper_limit=0.2 limit_range=1e-9 out_ic=0.1)
a5 b w1 mw
.model mw slew(rise_slope=10k fall_slope=20k)
a6 in p1 mp
.model mp pwl(x_array=[-1 0 1] y_array=[-2 0 1] input_domain=1e-9 fraction=false)
a7 %vd(in b) %v(g2) mg
r1 g1 0 1k
r2 s1 0 1k
r3 l1 0 1k
r4 i1 0 1k
r5 w1 0 1k
r6 p1 0 1k
r7 g2 0 1k
.tran 1u 4m 0 1u
.end
"""

OSCILLATORS = """oscillators, pulses and hystereses
v1 c 0 pwl(0 1 8m 3)
v2 k 0 2
v3 a 0 sin(0 2 170)
v4 g 0 pulse(0 1 0.3m 1u 1u 0.4m 2m)
v5 u 0 sin(1 0.2 400)
v6 l 0 -0.5
a2 k t2 mt
.model mt triangle(cntl_array=[0 1 3] freq_array=[50 300 900] out_low=-2 out_high=3 duty_cycle=0.3)
a3 c s1 ms
a4 k s2 ms
.model ms sine(cntl_array=[0 1 3] freq_array=[50 300 900] out_low=-2 out_high=3)
a5 k q2 mq
.model mq square(cntl_array=[0 1 3] freq_array=[50 300 900] out_low=-2 out_high=3 duty_cycle=0.3 rise_time=20u fall_time=40u)
a6 a h mh
.model mh hyst(in_low=-0.5 in_high=0.7 hyst=0.4 out_lower_limit=-1 out_upper_limit=3 input_domain=1e-6 fraction=false)
a7 a d md
.model md d_dt(gain=1m out_lower_limit=-1.5 out_upper_limit=1.6 limit_range=1e-9)
a8 a u l b mc
.model mc climit(in_offset=0.1 gain=1.5 upper_delta=0.1 lower_delta=0.05 limit_range=1e-9 fraction=false)
a9 g c null p mp
.model mp oneshot(cntl_array=[0 1 3] pw_array=[50u 0.1m 0.9m] out_low=-1 out_high=2 rise_time=50u fall_time=90u
+ rise_delay=30u fall_delay=40u retrig=false)
r2 t2 0 1k
r3 s1 0 1k
r4 s2 0 1k
r5 q2 0 1k
r6 h 0 1k
r7 d 0 1k
r8 b 0 1k
r9 p 0 1k
.tran 0.5u 8m 0 0.5u
.end
"""

# What is behind them shows where the steps are, too.
STAIRCASES = """whole numbers
v1 a 0 sin(2.45 2.4 1k)
v2 t 0 pulse(0.01 8.01 0 1m 1m 1u 2.001m)
b1 x 0 v=floor(v(a))
b2 y 0 v=ceil(v(t)/3)
b3 z 0 v=nint(v(t)-4)
b5 m 0 v=v(t)-3*floor(v(t)/3)
r1 x xf 1k
c1 xf 0 0.1u ic=0
r2 y yf 1k
c2 yf 0 0.1u ic=0
r3 z zf 1k
c3 zf 0 0.1u ic=0
r5 m mf 1k
c5 mf 0 0.1u ic=0
.tran 0.5u 4m 0 0.5u uic
.end
"""

TRANSFER = """transfer functions
v1 in 0 pulse(0 1 0.1m 1u 1u 1.1m 3m)
a1 in o1 low
.model low s_xfer(gain=2 num_coeff=[1e4] den_coeff=[1 1e4] int_ic=[0])
a2 in o2 ringing
.model ringing s_xfer(gain=1 num_coeff=[1e8] den_coeff=[1 4e3 1e8] int_ic=[0 0])
a3 in o3 lead
.model lead s_xfer(gain=0.5 num_coeff=[1 2e3] den_coeff=[1 2e4] int_ic=[0])
r1 o1 0 1k
r2 o2 0 1k
r3 o3 0 1k
.tran 0.5u 4m 0 0.5u
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
        theirs = ngspice_batch.run(ngspice_batch.in_its_order(netlist), pathlib.Path(folder), stop, 120)
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
        compare(checker, program, BULK, ["v(out)", "i(l1)"], 1e-3, 0.03)
        compare(checker, program, HALF_BRIDGE, ["v(x)", "i(l1)"], 100e-6, 0.03)
        compare(checker, program, DIGITAL, [f"v(a{x})" for x in ("q", "nq", "j", "t", "g", "x")], 800e-9, 2e-2)
        # An oscillator of version 44 has its edges 1 ns before its delay has passed.
        oscillators = 5 if ngspice_batch.version() < 44 else 4
        compare(checker, program, GATES, [f"v({x}{k})" for x, n in (("a", 9), ("b", oscillators)) for k in range(1, n + 1)] + ["v(u)", "v(d0)"],
                800e-9, 2e-3)
        compare(checker, program, PRODUCTS, [f"v({x})" for x in "mqsdf"], 4e-3, 2e-3)
        compare(checker, program, BLOCKS, ["v(g1)", "v(s1)", "v(l1)", "v(i1)", "v(w1)", "v(p1)", "v(g2)"], 4e-3, 4e-3)
        compare(checker, program, OSCILLATORS, [f"v({x})" for x in ("t2", "s1", "s2", "q2", "h", "d", "b", "p")], 8e-3, 8e-3)
        compare(checker, program, STAIRCASES, [f"v({x})" for x in ("y", "xf", "yf", "zf", "mf")],
                4e-3, 4e-3)
        compare(checker, program, TRANSFER, ["v(o1)", "v(o2)", "v(o3)"], 4e-3, 8e-3)
    except ngspice_batch.NoNgspice:
        print("ngspice is not installed")
        return SKIPPED
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
