"""Circuits with gates, flip-flops and samples, unlike in size, scale and topology. {S} is the source of the small signal."""

PEAK_CURRENT = """Peak current buck with a latch, a slope and a voltage loop
Vin in 0 12
Vclk clk 0 PULSE(0 1 0 0 0 100n 10u)
S1 in sw q 0 sm
D1 0 sw
L1 sw x 22u
Rs x out 10m
C1 out esr 100u
Resr esr 0 20m
R1 out 0 2
Vramp ramp 0 PULSE(0 0.2 0 10u 0 0 10u)
Vref ref 0 {S}
G1 0 ctl ref out 1m
Rz ctl z 2k
Cz z 0 47n
B1 lim 0 V=v(ctl)-v(ramp)-0.3*i(L1)
A1 lim 0 0 0 0 over 0 0 SCHMITT Vt=0 Vh=0
A2 clk over 0 0 0 0 q 0 SRFLOP Td=50n
.model sm SW(Ron=10m Vt=0.5)
"""

DIGITAL_PI = """Buck with a digital PI, a hold, and a delay of one period
Vin in 0 12
Vclk clk 0 PULSE(0 1 0 0 0 1u 10u)
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
Vref ref 0 {S}
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 22u
C1 out esr 100u
Resr esr 0 20m
R1 out 0 2
B1 e 0 V=v(ref)-v(out)
B2 inext 0 V=v(i)+0.004*v(e)
A1 inext 0 clk 0 0 0 i 0 SAMPLEHOLD IC=0.4
B3 u 0 V=v(i)+0.01*v(e)
A2 u 0 clk 0 0 0 d 0 SAMPLEHOLD IC=0.4
A3 d 0 clk 0 0 0 dd 0 SAMPLEHOLD IC=0.4
E1 cmp 0 dd tri 1
.model sm SW(Ron=10m Vt=0)
"""

RAMPS = """Outputs that take time between their levels, on a switch and on a filter
Vin in 0 48
Vtri tri 0 PULSE(0 1 0 4u 4u 0 8u)
Vc c 0 {S}
A1 c tri 0 0 0 n q 0 DIFFSCHMITT Vt=0 Vh=0 Td=100n Trise=600n Tfall=300n
S1 in sw q 0 sm
S2 sw 0 n 0 sm
L1 sw out 100u
C1 out 0 4.7u
R1 out 0 12
Rf q f 1k
Cf f 0 10n
.model sm SW(Ron=20m Roff=100k Vt=0.7)
"""

LATE = """A comparator whose edge comes more than a period later
Vin in 0 20
Vtri tri 0 PULSE(-1 1 0 5u 5u 0 10u)
Vc c 0 {S}
A1 c tri 0 0 0 0 q 0 DIFFSCHMITT Vt=0 Vh=0 Td=13.7u
S1 in sw q 0 sm
D1 0 sw
L1 sw out 100u
C1 out 0 10u
R1 out 0 3
.model sm SW(Ron=0 Vt=0.5)
"""

DIVIDED = """Every third clock starts a pulse that a comparator ends
Vin in 0 5
Vclk ck 0 PULSE(0 1 0.3u 0 0 0.4u 1u)
Vc c 0 {S}
A1 ck 0 0 0 0 0 t 0 COUNTER cycles=3 duty=0.34
A2 t over 0 0 0 0 q 0 SRFLOP
L1 in sw 2.2u
S1 sw 0 q 0 sm
D1 sw out
C1 out 0 4.7u
R1 out 0 25
B1 over0 0 V=i(L1)-v(c)
A3 over0 0 0 0 0 0 over 0 SCHMITT Vt=0 Vh=0 Td=20n
.model sm SW(Ron=20m Vt=0.5)
"""

PULSES = """Pulses of a monostable whose width a voltage says when they begin
Vin in 0 100
Vclk clk 0 PULSE(0 1 5u 1u 1u 20u 50u)
Vc c 0 {S}
A1 clk c 0 q one
.model one oneshot(cntl_array=[0 1] pw_array=[5u 35u] clk_trig=0.5 pos_edge_trig=true out_low=0 out_high=1
+ rise_time=0.1n fall_time=0.1n rise_delay=0.1n fall_delay=0.1n)
S1 in sw q 0 sm
D1 0 sw
L1 sw out 1m
C1 out 0 10u
R1 out 0 20
.model sm SW(Ron=10m Vt=0.5)
"""

BRIDGE = """A bridge whose second leg is a phase behind the first, by a ramp and two flip-flops
Vin in 0 400
Vck ck 0 PULSE(0 1 0 0 0 2u 10u)
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
Vc c 0 {S}
A1 na 0 ck 0 0 na pa 0 DFLOP
A0 c tri 0 0 0 over 0 0 DIFFSCHMITT Vt=0 Vh=0
A2 pa 0 over 0 0 nb pb 0 DFLOP
S1 in a pa 0 sm
S2 a 0 na 0 sm
S3 in b pb 0 sm
S4 b 0 nb 0 sm
L1 a p 20u
Lp p b 1m
Ls s 0 1m
K1 Lp Ls 0.999
D1 s r1
D2 0 r1
Lo r1 out 100u
C1 out 0 20u
R1 out 0 10
Rx a b 10k
.model sm SW(Ron=50m Roff=200k Vt=0.5)
"""

DEAD_TIME = """A half bridge with dead times by delays, at 20 kHz and 600 V, into a winding
Vin in 0 600
Vtri tri 0 PULSE(-1 1 0 25u 25u 0 50u)
Vc c 0 {S}
A1 c tri 0 0 0 n q 0 DIFFSCHMITT Vt=0 Vh=0
A2 q 0 0 0 0 0 qd 0 BUF Td=1u
A3 n 0 0 0 0 0 nd 0 BUF Td=1u
A4 q qd 0 0 0 0 up 0 AND
A5 n nd 0 0 0 0 low 0 AND
S1 in sw up 0 sm
D1 sw in
S2 sw 0 low 0 sm
D2 0 sw
L1 sw x 2m
R1 x m 0.5
Vemf m 0 200
.model sm SW(Ron=20m Vt=0.5)
"""

TRACKING = """A current that is sampled in the middle of each pulse, held, and tracked for the rest
Vin in 0 24
Vtri tri 0 PULSE(0 1 0 20u 0 0 20u)
Vclk clk 0 PULSE(0 1 3u 0 0 1u 20u)
Vtr tr 0 PULSE(0 1 15u 0 0 3u 20u)
Vc c 0 {S}
H1 i 0 Vm 0.1
B1 e 0 V=v(c)-v(i)
A1 e 0 clk tr 0 0 h 0 SAMPLEHOLD
B2 d 0 V=0.45+0.3*v(h)
E1 cmp 0 d tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw y 200u
Vm y out 0
C1 out 0 100u
R1 out 0 4
.model sm SW(Ron=10m Vt=0)
"""

INTERLEAVED = """Two phases of a boost converter, each with a latch, half a clock apart
Vin in 0 24
Vck1 k1 0 PULSE(0 1 0 0 0 100n 4u)
Vck2 k2 0 PULSE(0 1 2u 0 0 100n 4u)
Vr1 r1 0 PULSE(0 3 0 4u 0 0 4u)
Vr2 r2 0 PULSE(3 0 2u 0 0 0 4u)
Vr3 r3 0 PULSE(0 3 2u 4u 0 0 4u)
Vc c 0 {S}
L1 in a 33u
S1 a 0 q1 0 sm
D1 a out
L2 in b 33u
S2 b 0 q2 0 sm
D2 b out
C1 out 0 47u
R1 out 0 24
B1 o1 0 V=i(L1)+v(r1)-v(c)
B2 o2 0 V=i(L2)+v(r3)-v(c)
A1 o1 0 0 0 0 0 x1 0 SCHMITT Vt=0 Vh=0 Td=30n
A2 o2 0 0 0 0 0 x2 0 SCHMITT Vt=0 Vh=0 Td=30n
A3 k1 x1 0 0 0 0 q1 0 SRFLOP
A4 k2 x2 0 0 0 0 q2 0 SRFLOP
.model sm SW(Ron=10m Vt=0.5)
"""

FILTERED_HOLD = """A sampled voltage that loads its source, behind a filter of its own
Vclk clk 0 PULSE(0 1 2u 0 0 1u 7u)
Vc c 0 {S}
Rc c x 1k
Cx x 0 1n
A1 x 0 clk 0 0 0 h 0 SAMPLEHOLD Rout=500
C2 h 0 4n
R2 h x 3k
A2 h 0 clk 0 0 0 g 0 SAMPLEHOLD
R3 g y 2k
C3 y 0 2n
"""

# name, netlist, DC value and amplitude of the source, the clock's period, the signal
CIRCUITS = [
    ("peak current", PEAK_CURRENT, 5.0, 1e-3, 10e-6, "v(out)"),
    ("digital PI", DIGITAL_PI, 5.0, 1e-3, 10e-6, "v(out)"),
    ("ramps", RAMPS, 0.45, 1e-3, 8e-6, "v(out)"),
    ("ramps, filtered", RAMPS, 0.45, 1e-3, 8e-6, "v(f)"),
    ("late", LATE, 0.3, 1e-3, 10e-6, "v(out)"),
    ("divided", DIVIDED, 1.1, 1e-4, 3e-6, "v(out)"),
    ("pulses", PULSES, 0.4, 1e-4, 50e-6, "i(l1)"),
    ("bridge", BRIDGE, 0.55, 1e-4, 20e-6, "v(out)"),
    ("dead time", DEAD_TIME, 0.2, 1e-4, 50e-6, "i(l1)"),
    ("tracking", TRACKING, 0.4, 1e-4, 20e-6, "v(out)"),
    ("interleaved", INTERLEAVED, 4.0, 1e-3, 4e-6, "v(out)"),
    ("filtered hold", FILTERED_HOLD, 1.0, 1e-3, 7e-6, "v(y)"),
]
