#!/usr/bin/env python3
"""Makes each kind of allocation of a run fail, one after the other, and then all from there on.

usage: every_allocation.py PROGRAM LIBRARY CASE:METHOD ...

A path of calls that an earlier case has failed is left to it, unless the run is a long one (tools/test --long).
Whatever fails, the program ends by itself with a status of 1 to 4 and a message, or with the right
output if it could do without that memory; the output's final name never holds half a result.
"""

import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "support")]
from dalcs_program import IS_LONG, Checker  # noqa: E402
from preload import DEPTH, FROM_THERE, ONCE, paths_of_calls, refused_runs  # noqa: E402

CASES = {  # netlist and status without a failure
    "system": ("""dalcs-system 2 Everything that a system file may have
.param k=2
input u SIN(0 1 1)
input g PULSE(0 1 0.1 0 0 0.2 0.5)
system
state x1 V 1
state x2 A
unknown z
pair d
interval r {-k} {k}
free b
switch s on=0.5 off=0.5 direct
matrix A_I
+ -1 0
+ 0 -1
matrix Bbar_I sparse
+ 1 1 1 2 2 1 2 4 1
matrix A_II
+ 1 0
matrix B_II
+ -1
matrix C_I
+ 1 0
+ 0 1
+ 0 0
+ 0 1
matrix D sparse
+ 3 3 1 4 4 1
matrix F
+ -1 0
+ 0 0
+ 0 0
+ 0 0
matrix direct_control
+ 0 0
+ 0 0
+ 0 0
+ 0 1
matrix storage
+ 1 0
+ 0 1
output y x1 1 z 2 w(r) 1 minus x2 1
system
coordinate q 1 0
contact floor
matrix G
+ 1
matrix constant_force
+ -1
.tran 0.1 0.5
.end
""", 0),
    "equations": ("""What equations writes of a circuit with jumps, held voltages and a switch
V1 in 0 PULSE(0 5 1m 0 0 1m 2m)
R1 in a 1k
D1 a b
C1 b 0 1u
L1 b c 1m
S1 c 0 in 0 sm
R2 c 0 1k
S2 c 0 in c sm
.model sm SW(Vt=2)
.ic v(b)=1
.tran 10u 1m
.end
""", 0),
    "start": ("""Two capacitors and a diode: a jump at t = 0
C1 1 0 1u ic=10
C2 2 0 3u ic=2
R1 2 0 1k
D1 1 2
.tran 100u 1m uic
.end
""", 0),
    "bridge": ("""Full bridge on a floating DC side
V1 a b SIN(0 10 50)
R0 b 0 1
D1 a p
D2 b p
D3 m a
D4 m b
C1 p m 100u
R1 p m 1k
.tran 1m 30m uic
.options compress=1m
.op
.save v(p,m) i(d1)
.end
""", 0),
    "elements": ("""What cards expand into
Vlimited limited 0 1 Ilimit=1 revIlimit=1m
Rlimited limited 0 100
V1 a 0 AM(5 2 1k 20k) Rser=1 Cpar=1n
V2 b 0 PWL REPEAT FOREVER (0 0 2u 3 4u 0) ENDREPEAT
I3 0 b SFFM(0 1 10k 0.3 50k)
L1 a 0 10u Rser=1 Rpar=1k
L2 e 0 20u
L3 f 0 30u
K1 L1 L2 L3 0.9
R2 e 0 10
R3 f 0 10
D1 b d limited m=2
R4 d 0 1
D2 b g exponential 2
A1 %gd(b g) block
R5 g 0 1
W1 b h V2 cs
S1 b h b 0 vs
R6 h 0 1
E1 k 0 POLY(2) b 0 g 0 1 2 3
G1 k 0 POLY(2) b 0 g 0 1 2 3
G2 k 0 k 0 1m
H2 h i Vh 2
Vh i 0 0
.model limited D(Ron=1 Ilimit=1 RevIlimit=1 Vrev=5 Epsilon=0.1)
.model exponential D(IS=1n RS=0.1 CJO=1p BV=50)
.model block sidiode(Ron=1)
.model cs ISWITCH(Ron=1 It=1 Ih=0.2)
.model vs VSWITCH(Ron=1 Von=2)
.tran 2u 6u uic
.save v(d) i(l1) i(g1) i(d1) i(v1)
.end
""", 0),
    "storage": ("""Flux and charge that are no straight lines, a core, a transformer
V1 a 0 5
R1 a b 1
L1 b 0 Flux=pwl(x,-2,-1.1u,-1,-1u,1,1u,2,1.1u) m=2
L2 b 0 Flux=1u*tanh(x) ic=0.1
L3 b 0 Hc=16 Bs=0.44 Br=0.1 A=1e-6 Lm=0.1 N=30 segments=2
C1 b 0 Q=x*(x<0 ? 1n : 2n)
A1 b 0 c 0 d 0 tr
R2 c 0 100
R3 d 0 100
.model tr transformer(turns=[1 2 -3])
.tran 10n 20n uic
.save v(b) i(l1) i(c1)
.end
""", 0),
    "wrong_storage": ("""Flux and charge that cannot be
V1 a 0 1
L1 a 0 Flux=-1m*tanh(x)
L2 a 0 Flux=1m*x-1m*x**3
L3 a 0 Hc=16
L4 a 0 1m
L5 b 0 1m
L6 c 0 1m
C1 a 0 C='v(a)+v(b)'
C2 a 0 C='1/(2+sin(v(a)))'
K1 L4 L5 0.99
K2 L4 L6 0.99
.tran 1u 3u
.end
""", 3),
    "gates": ("""gates, a latch with a delay, what a comparator reads of an RC, and losses
v1 a 0 PULSE(0 1 0 0 0 4u 10u)
a1 a q2 0 0 0 0 q1 0 AND
a2 c 0 0 0 0 q2 0 0 SCHMITT Vt=0.5 Vh=0.2
a3 q1 q2 0 0 0 0 q3 0 SRFLOP Td=1u Rout=1
a4 c 0 a q3 0 0 held 0 SAMPLEHOLD
a5 a 0 0 0 0 0 q5 0 COUNTER
a6 [a ~c] [da dc] adc
.model adc adc_bridge(in_low=0.2 in_high=0.8)
a7 da dc null null q7 nq7 flip
.model flip d_dff(clk_delay=0.1u)
a8 c x8 lim
.model lim int(gain=1meg out_upper_limit=1)
r8 x8 held 1k
r1 q1 c 1k
c1 c 0 1n ic=0
r3 q3 0 1k
.losses
.meas tran mean avg v(q3)
.tran 1u 30u uic
.end
""", 0),
    "oscillators": ("""oscillators, pulses, hystereses, rates, and what outputs are behind
v1 c 0 PWL(0 0.2 20u 1)
a1 c t tri
.model tri triangle(cntl_array=[0 1] freq_array=[0 200k])
a2 c s sin
.model sin sine(cntl_array=[0 1] freq_array=[10k 200k])
a3 c q sq
.model sq square(cntl_array=[0 1] freq_array=[10k 200k] out_low=0)
a4 q c null p one
.model one oneshot(cntl_array=[0 1] pw_array=[1u 2u])
a5 t h hys
a13 q s 0 0 0 0 k 0 PHASEDET Iout=1u Cout=1n
b9 w2 0 V=idtmod(1meg*v(c),0,1)
.model hys hyst(in_low=-0.5 in_high=0.5)
a6 s d rate
.model rate d_dt(gain=1u out_upper_limit=1)
a7 s t d l lim
.model lim climit
a8 q p null null g n lat
.model lat d_dlatch
a9 q 0 0 0 0 0 b 0 BUF Rhigh=1k Rlow=2k Cout=1n
a10 c 0 0 0 0 0 v 0 VARISTOR
a11 c t 0 0 0 0 m 0 MODULATE mark=200k space=0
a12 v w g 0 th
.model th thyristor(Il=1m)
b1 y 0 V=v(t) laplace=1/(1+s*1u)
b2 0 z I=1m*v(t) rpar=1k
r1 s v 1k
r2 w 0 1k
.op
.end
""", 0),
    "transistors": ("""What commands transistors, and what they become
V1 b 0 1
R1 b d 10
M1 d switched 0 irf540n
M2 d switched 0 0 channel W=1m
Z1 d switched 0 gated
Q1 d base 0 bipolar
A1 d 0 switched both
R2 switched base 1k
V2 switched 0 PULSE(0 10 1u 0 0 1u 4u)
.options bjt=switch
.model channel NMOS(Vto=2 Kp=1)
.model gated NIGBT(Vdiode=1)
.model bipolar NPN
.model both triac
.tran 2u 2u uic
.save v(d) i(m1) i(a1)
.end
""", 0),
    "tolerances": ("""Tolerances on parts and in models, and the worst of them
V1 in 0 5
R1 in a RB 1k DEV=1%
.model RB RES(R=1 LOT/1=5%)
X1 a 0 leg
.subckt leg a b
D1 a m DM
R1 m b {mc(1k,0.1)}
.model DM D(vfwd=0.7 DEV/gauss=10m LOT=1%)
.ends
.tran 1u 1u
.meas tran v max v(a)
.wcase corners=no
.end
""", 0),
    "dialect": ("""A netlist told to be LTspice's, and what its and Xyce's switches have
.options dialect=ltspice gmin=1n itl4=10
V1 a 0 SIN(0 4k7 1)
L1 a b 1m
L2 b 0 1m
L3 c 0 2m
K1 L2 L3 0.5
R1 c 0 2R2
S1 a d m1 CONTROL={2*v(a)-1}
R2 d 0 1k
.model m1 ako:m0 Ron=1
.model m0 SW(Ron=2 Roff=1Meg Vt=1 Lser=1m Vser=0.6)
.save v(*) i(*)
.tran 1
.end
""", 0),
    "switched": ("""Coupled inductors, controlled sources, an ideal switch
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
L1 in a 100u
L2 0 b 100u
K1 L1 L2 1
S1 a 0 g 0 sm
D1 b out DI
C1 out 0 10u
E1 e 0 out 0 2
R1 e 0 1k
F1 0 out Vin 1m
R2 out 0 10
.model sm SW(Ron=0 Vt=0.5)
.model DI D(Ron=1m Vfwd=0.3)
.ic v(out)=1
.tran 1u 20u uic
.end
""", 0),
    "modes": ("""Switches that sources and a voltage move, jumps, singular modes
V1 a b SIN(0 10 1k)
R0 b 0 1
D1 a p
D2 b p
D3 m a
D4 m b
C1 p m 10u
R1 p m 1k
S1 p q g m sg
C2 q m 10u ic=1
S2 q m p m sv
R2 q m 100
Vg g m PULSE(0 1 0.2m 0 0 0.3m 1m)
Vh h 0 SIN(0 1 2k)
S3 b 0 h 0 sg
.model sg SW(Vt=0.5)
.model sv SW(Vt=6 Vh=1 Ron=10)
.options compress=1m
.tran 20u 1m uic
.save v(p,m) v(q,m) i(d1)
.end
""", 0),
    "leaps": ("""A chopper, whose periods before the rows are leapt over
V1 in 0 24
Vg g 0 PULSE(0 1 0 0 0 40u 100u)
S1 in a g 0 sm
D1 0 a
L1 a b 2m
R1 b 0 5
.model sm SW(Vt=0.5)
.meas tran mean AVG i(l1) from=9.8m
.tran 20u 10m 9.9m uic
.end
""", 0),
    "undetermined": ("""A ring, a stack, an ideal transformer at 0 V, and feedback with two answers
I1 0 r 1
D1 r s
D2 s 0
D3 0 r
V1 in 0 -1
D4 in m
D5 m n
D6 n 0
V2 a 0 0
L1 a 0 1m
L2 t 0 1m
L3 0 u 1m
K12 L1 L2 1
K13 L1 L3 1
K23 L2 L3 1
D7 t o
D8 u o
L4 o q 1m ic=4
R1 q 0 1
E1 e 0 f 0 3
D9 e g
R2 g f 1
R3 f 0 1
I2 f 0 1
.op
.tran 100u 200u uic
.end
""", 0),
    "steady": ("""A steady state of a source that repeats later, and of a charge that stays
V1 g 0 PWL(0 0 3u 0 3u 1 6u 1 6u 0 13u 0) R=3u
R1 g a 10
C2 a m 1u
C3 m 0 1u
.pss step=1u uic
.end
""", 0),
    "sensitive": ("""A sensitivity
V1 g 0 PULSE(0 1 0 0 0 1u 3u)
R1 g a 10
C1 a 0 1u
.pss step=1u uic
.sens r1
.meas pss mean avg v(a)
.end
""", 0),
    "response": ("""The gain of a loop around an orbit in discontinuous conduction, and a part without memory
Vin in 0 12
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw out 10u
C1 out 0 10u
R1 out 0 50
Vl out fb 0
Vref ref 0 0.5
E2 ctl 0 ref fb 0.02
.model sm SW(Ron=0 Vt=0)
Va x 0 1
Ra x 0 1
.save v(out) v(x)
.pss step=1u uic
.ac dec 1 1k 100k loop=vl injection=both sideband=1
.end
""", 0),
    "envelope": ("""Periods that are leapt over, a source that is a ramp, and the losses of an orbit
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 3u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 10u
C1 out 0 10u
R1 out 0 50
Iload out 0 PWL(0 0 100u 0.1)
.model sm SW(Ron=0 Vt=0.5)
.save v(out)
.env 80u tol=0.1 step=5u uic
.pss step=5u uic
.losses
.end
""", 0),
    "refused": ("""A diode across a source
V1 1 0 PWL(0 -1 1m 1)
D1 1 0
.tran 100u 1m
.end
""", 1),
    "blocked": ("""Current sources against a diode and an open switch, at the operating point
I1 0 a 3
I2 a 0 1
R1 a b 1k
C1 b 0 1u
D1 0 a
S1 b 0 c 0 SW
Vc c 0 0
Vd c 0 0
.model SW SW(Ron=0 Vt=0.5)
.op
.end
""", 1),
    "sources": ("""Sources that contradict each other
V1 1 0 5
V2 2 0 3
R1 1 2 0
I1 0 3 1
I2 3 0 2
.op
.end
""", 3),
    "language": ("""Parameters, a subcircuit in another, a condition, a library
.param r={2*k} k=500 tau='r*1u'
.func twice(x) {2*x + k - 500}
.lib part.lib fast
V1 in 0 SIN(0 9 {1/(6*tau)})
Xa in out part r={twice(r)} params: c=1u
.if (k > 1)
R9 out 0 r
.endif
.subckt part a b r=1 c=1
X1 a m half r={r/2}
X2 m b half
C1 b 0 {c}
.subckt half p q r=1k
R1 p q {r}
D1 q 0 clamp
.ends
.ends
.tran 100u 2m
.save v(out) v(xa:m) i(xa.x1.d1)
.end
""", 0),
    "formulas": ("""Sources with a formula, in a subcircuit and out of it
.func clip(x,y) {min(max(x,-y),y)}
.subckt amp p n out gain=1e6
B1 out 0 V=limit(gain*v(p,n), -10, 10)
.ends
V1 in 0 SIN(0 5 1k)
R1 in n 1k
R2 n out 3k
X1 0 n out amp
C1 y 0 1u
B2 0 y I=1m*sgn(v(in)) - clip(v(y)/1k, 1m) + 1m*sin(1000*time)*exp(-time) + u(time-0.1m)*1m
B3 z 0 V=max(abs(v(in)), abs(v(out))) + i(R1) + (v(in) > 1 && v(out) > 2 ? 1 : 0)
E4 w 0 TABLE {v(in)} = (-1,-2) (0,0) (1,1)
R3 z w 1k
.save v(y) {v(y)*i(r1)} w(r3) {v(in) > 0 ? abs(v(y)) : v(out) && 1}
.tran 50u 0.2m
.end
""", 0),
    "smooth": ("""Products and functions, alone, in each other and in a POLY
V1 in 0 dc 1 sin(1 2 1k) ac 1
R1 in a 1
B1 a b I=1m*v(a,b)+0.1*v(a,b)**3
B2 b 0 I=1e-12*(exp(v(b)/0.05)-1)
C1 b 0 1u
B3 z 0 V=max(v(a)*v(b), 0) + exp(-log(1+v(a)*v(a))) + time*v(b)
E4 y 0 POLY(2) a b in 0 0 1 0 0 0 2
R4 y z 1k
.op
.ac lin 2 1k 2k
.tran 50u 0.1m
.end
""", 0),
    "wrong_formulas": ("""Mistakes in formulas
.func f(x) {x*f(x)}
V1 a 0 1
B1 b 0 V=f(v(a))
B2 b 0 V=v(a)*v(b)
B3 c 0 V=v(nowhere) + i(nobody) + g(v(a))
B4 d 0 V=u(v(a))*v(b)
E1 e 0 TABLE {v(a)} = (1,2) (0,3)
.op
.end
""", 3),
    "wrong_language": ("""Mistakes in parameters and subcircuits
.param a={b} b={a} c={nobody} d={sqrt(0-1)
.func f(x) {f(x)}
Xa 1 2 part q=3
Xb 1 nowhere
Xc 1 part
.subckt part n
R1 n 0 {f(1)}
R2 n 0 {c + 1/0}
.ends
.if (c
.include nothing.inc
.endif
.op
.end
""", 3),
    "stepped": ("""Sweeps of everything, small signals, a step that has other nodes
.param r=1k
V1 in 0 DC 2 AC 1 45
R1 in out {r}
C1 out 0 1u
D1 out lim dm
V2 lim 0 1
.model dm D
.step param r list 1k 2k
.nodeset v(out)=1
.ac lin 1 10 10
.dc R1 1k 2k 1k
.save v(out) i(d1)
.print ac vdb(out)
.end
""", 0),
    "random": ("""Random values in every place, two runs
.param c={mc(1u, 0.1)}
.func part(x) {agauss(x, x/20, 3)}
V1 in 0 DC 2
X1 in out leg r={part(1k)}
.subckt leg a b r=1
R1 a b {r}
.ends
C1 out 0 {c}
B1 x 0 V=v(out)*gauss(1)
R2 x 0 {limit(1k, 10)}
.if (rand() < 2)
R3 out 0 1k
.endif
.op
.save v(out)
.options seed=3
.mc 2
.end
""", 0),
    "script": ("""A control block
.param r=1k
V1 in 0 DC 2 AC 1
R1 in out {r}
C1 out 0 1u
.dc V1 0 1 1
.control
set wr_vecnames
set list = ( 1k 2k )
foreach x $list
  alter r1 = $x
  ac lin 2 10 20
  wrdata w.txt v(out) mag(v(out))
end
save all @r1[i]
alterparam r = {2*500}
reset
run
write w.raw
op
let x = 2*v(out) - v(in,out)
print x all
repeat 2
  let x = x + 1
end
while x > 100
end
if x > 1
  echo $&x
end
.endc
.end
""", 0),
    "plots": ("""Plots, spectra and functions of a control block
V1 in 0 DC 2 AC 1 SIN(0 1 1k)
R1 in out 1k
C1 out 0 1u
.tran 0.1m 1m
.tran 0.1m 0.4m
.control
define twice(x) 2*x
compose r values 1k 2k
run
linearize
fft v(out)
let line = twice(mag(v(out)[1]))
setplot tran1
spec 0 2k 1k v(out)
set curplot = new
set scratch = $curplot
foreach x $&r
  alter r1 = $x
  op
  let {$scratch}.out$x = v(out)
end
print {$scratch}.out1k tran1.v(out) > t.txt
echo $plots $#plots $?nothing
strcmp same $scratch a
cross c 1 tran1.v(in) tran2.v(in)
unlet c
fourier 1k v(out)
setplot
display
destroy all
.endc
.end
""", 0),
    "mistaken": ("""Several mistakes
R1 1 0 1kk2
C1 1 0
Q1 1 2 3 model
D1 1 0 nowhere
.tran 1u 1m
.end
""", 3),
}
FILES = {"part.lib": """.lib slow
.model clamp d(vfwd=5)
.endl
.lib fast
.model clamp d(vfwd=4 ron=1)
.endl
"""}
OLD = b"from an earlier run\n"


class Case:
    def __init__(self, program, library, name, method, folder):
        self.library, self.folder = library, pathlib.Path(folder)
        netlist, self.status = CASES[name]
        (self.folder / "circuit.cir").write_text(netlist)
        for file, text in FILES.items():
            (self.folder / file).write_text(text)
        self.command = [program, "run", "circuit.cir", "--method", method, "-o", "out.csv"]
        if name != "leaps":  # the report has a ledger of energies, which needs every segment
            self.command += ["--report", "report.json"]
        if name == "tolerances":  # the order of allocations of several threads is not fixed
            self.command += ["--jobs", "1"]
        if name == "equations":  # the method is a format
            self.command = [program, "equations", "circuit.cir", "--form", "lcs", "--format", method,
                            "-o", "out.csv"]
        self.checker = Checker(f"{name} with {method}")

    def judge(self, run, wanted):
        """Checks one run in which allocations failed."""
        check = self.checker.check
        where = f"{'only' if run.way == ONCE else 'from'} allocation {run.number}"
        output = (run.folder / "out.csv").read_bytes()
        error = run.stderr.decode(errors="replace")
        check(run.tally.refused > 0, f"{where}: nothing was refused")
        if not check(run.returncode >= 0, f"{where}: signal {-run.returncode}\n{error}"):
            return
        if run.returncode == 0:
            check(output == wanted, f"{where}: status 0 but another output")
        else:
            check(1 <= run.returncode <= 4, f"{where}: status {run.returncode}")
            check(output == OLD, f"{where}: failed, yet touched the output")
            check(error.strip(), f"{where}: failed without a word")

    def points(self, known):
        """Runs without a failure; returns the output and what is to fail: of each path of calls that is not known the first
        allocation, in the long run also the last, and of every third path all from the first one on."""
        output = self.folder / "out.csv"
        output.write_bytes(OLD)
        done, whole, first, last = paths_of_calls(self.library, self.command, self.folder, depth=DEPTH)
        error = done.stderr.decode(errors="replace")
        wanted = output.read_bytes()
        self.checker.check(done.returncode == self.status and whole.refused == 0,
                           f"status {done.returncode}, not {self.status}:\n{error}")
        self.checker.check((wanted == OLD) == (self.status != 0), "the output was not as expected")
        output.write_bytes(OLD)
        new = sorted(number for path, number in first.items() if path not in known)
        ends = {number for path, number in last.items() if path not in known} if IS_LONG else set()
        print(f"{self.checker.name}: {whole.calls} allocations by {len(first)} paths of calls, {len(new)} of them new")
        known.update(first)
        return wanted, [(n, ONCE) for n in {*new, *ends}] + [(n, FROM_THERE) for n in new[::3]]

    def every(self, known):
        wanted, points = self.points(known)
        noticed = 0
        for run in refused_runs(self.library, self.command, self.folder, points) if points else []:
            self.judge(run, wanted)
            noticed += run.returncode != 0
        self.checker.check(noticed > len(points) // 2 or self.status != 0 or not points,
                           f"only {noticed} of {len(points)} failures were noticed")


def main():
    program, library, *cases = sys.argv[1:]
    known = set()
    status = 0
    for case in cases:
        name, method = case.split(":")
        with tempfile.TemporaryDirectory() as folder:
            run = Case(program, library, name, method, folder)
            run.every(set() if IS_LONG else known)
            status |= run.checker.finish()
    return status


if __name__ == "__main__":
    sys.exit(main())
