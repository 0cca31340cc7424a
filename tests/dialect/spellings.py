#!/usr/bin/env python3
"""What other simulators spell in another way, each kind in ten ways and more, against the plain spelling.

Each kind has a frame, a line that says it plainly with a value from a closed form, and lines that mean the same.

usage: spellings.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

EXACT = 1e-8


class Kind:
    def __init__(self, name, frame, plain, signal, value, others, refused=()):
        self.name, self.frame, self.plain = name, frame, plain
        self.signal, self.value, self.others, self.refused = signal, value, others, refused

    def netlist(self, line):
        return f"{self.name}\n{self.frame.strip().replace('@', line)}\n.end\n"

    def last(self, program, line):
        return run(program, self.netlist(line), method=None, tolerance=1e-10, report=False)


def check(checker, program, kind):
    for line in [kind.plain] + some_of(kind.others):
        done = kind.last(program, line)
        if not checker.check(done.status == 0, f"{kind.name}: '{line}' ends with {done.status}\n"
                                               f"{done.stderr}"):
            continue
        value = done.column(kind.signal)[-1]
        checker.check(abs(value - kind.value) <= EXACT * max(abs(kind.value), 1e-3),
                      f"{kind.name}: '{line}' has {kind.signal} = {value!r}, not {kind.value!r}")
    for line, words in kind.refused:
        done = kind.last(program, line)
        checker.check(done.status == 3 and words in done.stderr,
                      f"{kind.name}: '{line}' ends with {done.status}, without '{words}'\n"
                      f"{done.stderr}")


# ---- Elements ------------------------------------------------------------------------------------

DERIVED = """
V1 a 0 10
D1 a b new
R1 b 0 1k
.model old D(Ron=10 Vfwd=1)
.model other D(Ron=1k Vfwd=0.3)
.model both D(Ron=1k Vfwd=1)
@
.op
"""

DIVIDER = """
V1 a 0 10
@
R2 b 0 1k
.op
"""

RISING = """
V1 a 0 1
R1 a b 1
@
.tran 1m uic
"""

ELEMENTS = [
    Kind("which way a .dc goes", "V1 a 0 1\nI1 0 c 1\nR2 c 0 1\nR1 a b 1k\nR3 b 0 1k\n@\n", ".dc V1 20 -20 -0.2", "v(b)", -10.0, [
        ".dc V1 20 -20 0.2", ".dc V1 -40 -20 -2", ".dc V1 LIN 20 -20 0.2", ".dc V1 0 -20 5", ".dc V1 -19 -20 1",
        ".dc V1 20 -20 0.2 I1 0 1 -0.5", ".dc V1 20 -20 40", ".dc LIN V1 20 -20 10", ".dc V1 0.02k -2e1 200m",
        ".param w=20\n.dc V1 {w} {-w} {w/100}",
    ], [(".dc V1 20 -20 0", "a step of 0 never reaches")]),
    Kind("attributes of R", DIVIDER, "R1 a b 1k", "v(b)", 5.0, [
        "R1 a b 1k tol=1 pwr=0.1",
        "R1 a b 1k pwr=0.1",
        "R1 a b 1K TOL=5",
        'R1 a b 1k mfg="a maker" pn="1234-5"',
        "R1 a b 1k pn=1234-5 tol=0.1",
        "R1 a b R=1k tol=1",
        "R1 a b 1k tc=0 tol=1",
        "R1 a b {2*500} tol={1}",
        "R1 a b 1k type=film",
        "X1 a b s\n.subckt s p q\nR1 p q 1k tol=1 pwr=0.25\n.ends",
    ], [("R1 a b 1k tolerence=1", "no parameter 'tolerence'")]),
    Kind("attributes of C", RISING, "C1 b 0 1m", "v(b)", 1 - math.exp(-1), [
        'C1 b 0 1m V=25 Irms=2.07 mfg="maker" pn="number" type="Al electrolytic" ppPkg=1',
        "C1 b 0 1m V=25 ",
        "C1 b 0 1m V=6.3 Rser=0 Lser=0",
        "C1 b 0 1m mfg=maker",
        "C1 b 0 1m IC=0 V=25",
        "C1 b 0 C=1m V=25",
        "C1 b 0 1m MTBF=5000",
        "C1 b 0 1m pn=UHE1A182MPD",
        'C1 b 0 1m pn="C0603 X5R" V=4',
        "X1 b s\n.subckt s p\nC1 p 0 1m V=25 Irms=1\n.ends",
    ]),
    Kind("attributes of L", "V1 a 0 1\n@\nR1 b 0 1\n.tran 1m uic\n", "L1 a b 1m", "v(b)",
         1 - math.exp(-1), [
             "L1 a b 1m Ipk=2",
             'L1 a b 1m Ipk=2 mfg="maker" pn="7447"',
             "L1 a b 1m Ipk=2 Rser=0",
             "L1 a b 1m Rser=0 Rpar=0 Cpar=0",
             "L1 a b 1m Rpar=0",
             "L1 a b 1m Rser=0.0 Rpar=0.0 Cpar=0.0",
             "L1 a b 1m ic=0 Rpar=0",
             "L1 a b {1m} Rpar={0}",
             "L1 a b L=1m rpar=0 ipk=1",
             "X1 a b s r=0\n.subckt s p q r=1\nL1 p q 1m Rpar={r}\n.ends",
         ], [("L1 a b 1m Rpar=-1", "cannot be negative")]),
    Kind("noiseless", DIVIDER, "R1 a b 1k", "v(b)", 5.0, [
        "R1 a b 1k noiseless",
        "R1 a b 1k NOISELESS",
        "R1 a b noiseless R=1k",
        "R1 a b R=1k noiseless",
        "R1 a b 1k noiseless tol=1",
        "R1 a b 1k noiseless=True",
        "R1 a b 1k noiseless = 1 tol=1",
        "R1 a b 1k tol=1 noiseless",
        "R1 a b 1k tc=1m noiseless",
        "R1 a b {1k} noiseless",
        "R1 a b 2k m=2 noiseless",
        "X1 a b s\n.subckt s p q\nR1 p q 1k noiseless\n.ends",
    ]),
    Kind("noiseless of a model", "V1 a 0 10\nR1 a b 1k\n@\n.tran 1m\n", "R2 b 0 1k", "v(b)", 5.0, [
        "D1 b 0 m\n.model m d(Ron=1k Roff=1T noiseless)",
        "D1 b 0 m\n.model m d(noiseless Ron=1k Roff=1T)",
        "D1 b 0 m\n.model m d(Ron=1k noiseless Roff=1T)",
        "D1 b 0 m\n.model m d Ron=1k Roff=1T NOISELESS",
        "D1 b 0 m\n.model m d(Ron={1k} Roff=1T noiseless)",
        "D1 b 0 m\n.model m d(Ron=1k noiseless)\n",
        "S1 b 0 a 0 m\n.model m sw(Ron=1k Roff=1T noiseless Vt=1)",
        "S1 b 0 a 0 m\n.model m sw(Vt=1 Ron=1k Roff=1T noiseless)",
        "X1 b s\n.subckt s p\nD1 p 0 m\n.model m d(Ron=1k Roff=1T noiseless)\n.ends",
        "W1 b 0 v1 m\n.model m csw(noiseless Ron=1k Roff=1T It=-1)",
    ], [("D1 b 0 m\n.model m d(Ron=1k noisles)", "not of the form")]),
    Kind("conditions of LTspice", "V1 a 0 0.3\nV2 c 0 0.7\n@\n.options dialect=ltspice\n.tran 1m\n", "V3 b 0 2",
         "v(b)", 2.0, [
             "B1 b 0 V=if(v(a),1,2)",
             "B1 b 0 V=if(v(c),2,1)",
             "B1 b 0 V=if(-v(c),1,2)",
             "B1 b 0 V=v(c)&v(a)?1:2",
             "B1 b 0 V=if(v(a)|v(c),2,1)",
             "B1 b 0 V=2*(!v(a))",
             "B1 b 0 V=2*!!v(c)",
             "B1 b 0 V=if(0.4*(v(a)>0),1,2)",
             "B1 b 0 V=if(0.6*(v(a)>0),2,1)",
             "B1 b 0 V=if(sgn(-v(a)),1,2)",
             "B1 b 0 V=if(v(a)>0.2,2,1)",
             "B1 b 0 V=if(v(a)+v(c),2,1)",
         ]),
    Kind("conditions elsewhere", "V1 a 0 0.3\n@\n.tran 1m\n", "V3 b 0 2", "v(b)", 2.0, [
        "B1 b 0 V=(0.4*(v(a)>0))?2:1",
    ], [("B1 b 0 V=v(a)?1:2", "exactly 0")]),
    Kind("so many units", RISING, "C1 b 0 1m", "v(b)", 1 - math.exp(-1), [
        "C1 b 0 0.5m x2",
        "C1 b 0 0.5m X2",
        "C1 b 0 0.25m x4",
        "C1 b 0 0.1m x10",
        "C1 b 0 0.5m x2 Rser=0",
        "C1 b 0 0.5m Rser=0 x2",
        "C1 b 0 0.5m m=2",
        "C1 b 0 {0.5m} x2 V=25",
        "C1 b 0 2m x0.5",
        "X1 b s\n.subckt s p\nC1 p 0 500u x2\n.ends",
    ], [("C1 b 0 1m x0", "must be positive"), ("C1 b 0 1m x-2", "must be positive")]),
    Kind("a model of R", DIVIDER, "R1 a b 1k", "v(b)", 5.0, [
        "R1 a b rn 1k\n.model rn RES (TCE=0 T_ABS=-273.15)",
        "R1 a b rn 1k\n.model rn R T_ABS=-273.15",
        "R1 a b rn 1k\n.model rn RES(T_ABS -273.15)",
        "R1 a b 1k rn\n.model rn RES(TC1=0 TC2=0)",
        "R1 a b rn 1k\n.model rn RES(R=1 TC1=0.001)",
        "R1 a b rn 1k\n.model rn RES R=1",
        "R1 a b rn 1k\n.model rn r res = 1",
        "R1 a b rn 1k tc=0\n.model rn RES {T_ABS=-273.15}",
        "R1 a b rn 1k\n.model rn RES(NOISE=0)",
        "R1 a b rn R=1k\n.model rn RES(T_REL_GLOBAL=0)",
        "X1 a b s\n.subckt s p q\nR1 p q rn 1k\n.model rn RES (TCE=0 T_ABS=-273.15)\n.ends",
    ], [("R1 a b rn 1k\n.model rn RES(RSH=10)", "not supported"),
        ("R1 a b rn 1k\n.model rn RES(R=2)", "both have a value"),
        ("R1 a b rn R=1k\n.model rn RES(R=2k)", "both have a value"),
        ("R1 a b rn\n.model rn RES(TC1=0)", "a resistance is missing")]),
    Kind("a model that has the resistance", DIVIDER, "R1 a b 1k", "v(b)", 5.0, [
        "R1 a b __R1\n.model __R1 r( r=1k tnom=27 tc1=100u )",
        "R1 a b rn\n.model rn RES(R=1k)",
        "R1 a b rn\n.model rn RES R=1000",
        "R1 a b rn\n.model rn R(RES=1k)",
        "R1 a b rn m=2\n.model rn r(r=2k)",
        "R1 a b rn tc1=0 tc2=0\n.model rn R(R={2*500})",
        "R1 a b rn noisy=0\n.param v=1k\n.model rn r(r={v})",
        "R1 a b rn R=1k\n.model rn RES(R=1)",
        "R1 a b 1k rn\n.model rn RES(R=1 TC1=0)",
        "R1 a b rn M=0.5\n.model rn r r=500",
        "X1 a b s\n.subckt s p q\nR1 p q rn\n.model rn r(r=1k)\n.ends",
    ]),
    Kind("a model that has the capacitance", RISING, "C1 b 0 1m", "v(b)", 1 - math.exp(-1), [
        "C1 b 0 __C1\n.model __C1 c( c=1m tnom=27 )",
        "C1 b 0 cm\n.model cm C(CAP=1m)",
        "C1 b 0 cm IC=0\n.model cm CAP c=1m",
        "C1 b 0 cm m=2\n.model cm c(c=0.5m tc1=0)",
    ], [("C1 b 0 cm\n.model cm C(CAP=-1m)", "cannot be negative")]),
    Kind("a model that has the inductance", "V1 a 0 1\n@\nR1 b 0 1\n.tran 1m uic\n", "L1 a b 1m", "v(b)",
         1 - math.exp(-1), [
             "L1 a b __L1\n.model __L1 l( l=1m tnom=27 )",
             "L1 a b lm\n.model lm IND(IND=1m)",
             "L1 a b lm IC=0\n.model lm l l=1m",
         ]),
    # A cell takes 1 V = 0.1 V per ampere times 10 A: idealised diodes have n= and m= besides.
    Kind("cells in series", "I1 0 a 1\n@\n.op\n", "D1 a 0 c\n.model c D(Ron=0.5 Vfwd=2)", "v(a)", 2.5,
         [
             "D1 a 0 c n=5\n.model c D(Ron=0.1 Vfwd=0.4)",
             "D1 a 0 c n=10 m=2\n.model c D(Ron=0.1 Vfwd=0.2)",
             "D1 a 0 c N=2\n.model c D(Ron=0.25 Vfwd=1)",
         ]),
]

# V of an exponential diode at its tangent's current, 1 A, is what the exponential says.
VT = 300.15 * 1.380649e-23 / 1.602176634e-19
ONE = VT * math.log1p(1 / 1e-9) + 0.01  # V of IS=1n, RS=10m at 1 A
CELL = "I1 0 a 1\n@\n.op\n"
DIODES = [
    Kind("cells of an exponential diode", CELL, "D1 a 0 c\n.model c D(Is=1n Rs=10m)", "v(a)", ONE, [
        "D1 a 0 c n=1\n.model c D(Is=1n Rs=10m)",
        "D1 a b c\nD2 b 0 s\n.model s D(Ron=0)\n.model c D(Is=1n Rs=10m)",
        "D1 a 0 c m=1\n.model c D(IS=1n RS=10m)",
    ]),
    Kind("36 cells", CELL, "D1 a 0 c n=36\n.model c D(Is=1n Rs=10m)", "v(a)", 36 * ONE, [
        "D1 a 0 c N=36\n.model c D(IS=1n RS=10m)",
        "D1 a 0 c n={6*6}\n.model c D(IS=1n RS=10m N=1)",
        "D1 a b c n=18\nD2 b 0 c n=18\n.model c D(IS=1n RS=10m)",
        "D1 a b c n=35\nD2 b 0 c\n.model c D(IS=1n RS=10m)",
        "D1 a 0 c area=1 n=36\n.model c D(IS=1n RS=10m)",
        "D1 a 0 c\n.model c D(IS=1n RS=0.36 N=36)",
        "D1 a 0 c n=12\n.model c D(IS=1n RS=30m N=3)",
        "D1 a 0 c n=36\n.model c D(Js=1n Rs=10m)",
        "D1 a 0 c 0.5 n=36 m=2\n.model c D(IS=1n RS=10m)",
        "X1 a s k=36\n.subckt s p k=1\nD1 p 0 c n={k}\n.model c D(IS=1n RS=10m)\n.ends",
    ]),
    # In breakdown, at 1 A: BV + N Vt ln(1 A / IBV), and RS.
    Kind("other names of BV", "I1 a 0 1\n@\n.op\n", "D1 a 0 d\n.model d D(IS=1n BV=100 IBV=1m)", "v(a)",
         -(100 + VT * math.log(1000)), [
             "D1 a 0 d\n.model d D(IS=1n VB=100 IBV=1m)",
             "D1 a 0 d\n.model d D(JS=1n VB=100)",
             "D1 a 0 d\n.model d D(is=1n vb=100 ibv=1m n=1)",
             "D1 a 0 d\n.model d D(IS=1n VRB=100)",
             "D1 a 0 d\n.model d D(IS=1n VB=100 IB=1m)",
             "D1 a 0 d\n.model d D IS=1n VB=100",
             "D1 a 0 d\n.model d D IS 1n VB 100",
             "D1 a 0 d\n.model d D(VB={10*10} IS=1n)",
             "D1 a 0 d n=1\n.model d D(VB=100 IS=1n)",
             "D1 a 0 d n=2\n.model d D(VB=50 IS=1n N=0.5)",
             "X1 a s\n.subckt s p\nD1 p 0 d\n.model d D(VB=100 IS=1n)\n.ends",
         ]),
]

# ---- Models --------------------------------------------------------------------------------------

MODEL_D = "V1 a 0 10\nD1 a b d\nR1 b 0 1k\n@\n.op\n"
ON = (10 - 0.5) * 1000 / 1500
SWITCHED = """
V1 a 0 10
V2 g 0 PULSE(0 1 1m 0 0 1m 4m)
@
R1 b 0 1k
.tran 10u 1.5m
"""
RON = 10 * 1000 / 1010
MODELS = [
    Kind("brackets of a model", MODEL_D, ".model d D(Ron=500 Vfwd=0.5)", "v(b)", ON, [
        ".model d D {Ron=500 Vfwd=0.5}",
        ".model d D{Ron=500 Vfwd=0.5}",
        ".model d D { Ron=500 Vfwd=0.5 }",
        ".model d D [Ron=500 Vfwd=0.5]",
        ".model d D[Ron=500 Vfwd=0.5]",
        ".model d D {Ron = 500 Vfwd = 0.5}",
        ".model d D {Ron={5*100} Vfwd=0.5}",
        ".model d D {Vfwd=0.5 Ron={5*100}}",
        ".model d D {Ron=500\n+ Vfwd=0.5}",
        ".model d D {Ron=500, Vfwd=0.5 }",
        ".MODEL D d{ROFF=inf RON=500 VFWD=0.5}",
        ".model d D(Ron=500 Vfwd=0.5",
        ".model d D ( Vfwd=0.5\n+ Ron=500",
    ], [(".model d D {Ron=500 Vfwd=0.5", "never closed")]),
    Kind("a list of a code model", """
V1 a 0 1
V2 b 0 2
.param kp=2
A1 [a b] o su
R1 o 0 1k
@
.tran 1u 10u
""", ".model su summer(in_gain=[2 1])", "v(o)", 4, [
        ".model su summer(in_gain=[{kp} 1.0])",
        ".model su summer(in_gain=[{kp} {kp/2}])",
        ".model su summer(in_gain=[2 {kp-1}])",
        ".model su summer(in_gain=[{ kp } 1 ])",
        ".model su summer(in_gain=[ {kp} 1 ])",
        ".model su summer(in_gain = ['kp' '1'])",
        ".model su summer(in_gain=['2*kp-2' 1])",
        ".model su summer(in_gain=[{kp}\n+ 1])",
        ".model su summer(in_gain=[{kp/2} {kp/4}] out_gain={kp})",
        ".model su summer in_gain=[{kp} 1]",
    ], [(".model su summer(in_gain=[{kp} 1", "a value is missing")]),
    Kind("blanks of a model", MODEL_D, ".model d D(Ron=500 Vfwd=0.5)", "v(b)", ON, [
        ".model d D( RON 500 VFWD 0.5 )",
        ".model d D(Ron 500 Vfwd 0.5)",
        ".model d D Ron 500 Vfwd 0.5",
        ".model d D(Ron 500, Vfwd 0.5)",
        ".model d D(Ron 500 Vfwd=0.5)",
        ".model d D(Ron=500 Vfwd 0.5)",
        ".model d D(Ron {500} Vfwd {1/2})",
        ".model d D(Ron 500 Roff inf Vfwd 0.5)",
        ".model d D {Ron 500 Vfwd 0.5}",
        ".model d D(Ron 500\n+ Vfwd 0.5)",
    ], [(".model d D(Ron 500 Vfwd)", "'vfwd' is not of the form")]),
    Kind("blanks of a switch's model", SWITCHED, "S1 a b g 0 s\n.model s SW(Ron=10 Vt=0.5)", "v(b)",
         RON, [
             "S1 a b g 0 s\n.model s SW( RON 10 VT 0.5 )",
             "S1 a b g 0 s\n.model s SW RON 10 VT 0.5",
             "S1 a b g 0 s\n.model s SW {RON=10 VT=0.5}",
             "S1 a b g 0 s\n.model s SW(ron 10 vt 0.5 vh 0.1)",
             "S1 a b g 0 s\n.model s SW(ron 10 roff inf vt 0.5)",
             "S1 a b g 0 s\n.model s SW(ron {2*5} vt {0.5})",
         ]),
    Kind("PSpice's ends in SW", SWITCHED, "S1 a b g 0 s\n.model s VSWITCH(Ron=10 Roff=inf Von=0.6 "
         "Voff=0.4)", "v(b)", RON, [
             "S1 a b g 0 s\n.model s SW(Ron=10 Von=0.6 Voff=0.4)",
             "S1 a b g 0 s\n.model s SW(RON 10 VON 0.6 VOFF 0.4)",
             "S1 a b g 0 s\n.model s SW(Ron=10 VHon=0.6 VHoff=0.4)",
             "S1 a b g 0 s\n.model s SW(Ron=10 Von=0.9 Voff=0.1)",
             "S1 a b g 0 s off\n.model s SW(Ron=10 Von=1)",
             "S1 a b 0 g s\n.model s SW(Ron=10 Von=-0.6 Voff=-0.4)",
             "W1 a b Vg s\nG1 0 h g 0 1\nVg h 0\n.model s CSW(Ron=10 Ion=0.6 Ioff=0.4)",
             "W1 a b Vg s\nG1 0 h g 0 1\nVg h 0\n.model s CSW(Ron=10 IHon=0.6 IHoff=0.4)",
             "W1 a b Vg s\nG1 0 h g 0 1\nVg h 0\n.model s ISWITCH(Ron=10 Ion=0.6 Ioff=0.4)",
             "X1 a b g q\n.subckt q p n c\nS1 p n c 0 s\n.model s SW(Ron=10 Von=0.6 Voff=0.4)\n.ends",
             "S1 a b g 0 s\n.model s SW(Ron=10 Von=7 Vt=0.5)",
             "S1 a b g 0 s\n.model s VSWITCH(Ron=10 Von=0.6 Voff=0.4 Vh=-0.5)",
             "S1 a b g 0 s\n.model s VSWITCH(Ron=10 Von=7 Voff=5 VHon=0.6 VHoff=0.4)",
             "S1 a b g 0 s\n.model s VSWITCH(Ron=10 Vt=3 VHon=0.6 VHoff=0.4)",
        ], [("S1 a b g 0 s\n.model s VSWITCH(Ron=10 Vt=0.5 VHon=0.6)", "has vhon and vhoff")]),
    Kind("closed when off", SWITCHED, "S1 a b g 0 s\n.model s SW(Ron=10 Roff=1G Vt=0.5)", "v(b)",
         RON, [
             "S1 a b q 0 s\nE9 q 0 0 g 1\n.model s SW(Ron=1G Roff=10 Vt=-0.5)",
             "S1 a b q 0 s\nE9 q 0 0 g 1\n.model s SW(Roff=10 Ron=1G Vt=-0.5 Vh=0.2)",
             "S1 a b q 0 s OFF\nE9 q 0 0 g 1\n.model s SW(Roff=10 Ron=1G Vt=-0.5 Vh=0.2)",
             "S1 a b q 0 s ON\nE9 q 0 0 g 1\n.model s SW(Roff=10 Ron=1G Vt=-0.5 Vh=0.2)",
             "S1 a b q 0 s\nE9 q 0 0 g 1\n.model s VSWITCH(Roff=10 Ron=1G Von=-0.4 Voff=-0.6)",
             "S1 a b g 0 s\n.model s VSWITCH(Roff=10 Ron=1G Von=0.4 Voff=0.6)",
             "S1 a b g 0 s\n.model s VSWITCH(Roff=10 Ron=1G VHon=0.4 VHoff=0.6)",
             "S1 a b g 0 s\n.model s VSWITCH(Roff=10 Ron=1G VHoff=0.6 VHon=0.4 Von=9)",
             "X1 a b g u\n.subckt u p n c\nE9 q 0 0 c 1\nS1 p n q 0 s\n"
             ".model s SW(Ron=1G Roff=10 Vt=-0.5)\n.ends",
             "W1 a b Vs s\nG1 0 h g 0 -1\nVs h 0\n.model s CSW(Ron=1G Roff=10 It=-0.5)",
         ], [("S1 a b g 0 s\n.model s SW(Ron=10 Roff=10 Vt=0.5)", "switches nothing")]),
    Kind("CONTROL and its models", SWITCHED, "S1 a b s CONTROL={v(g)}\n.model s SW(Ron=10 Vt=0.5)",
         "v(b)", RON, [
             "S1 a b s CONTROL={v(g)}\n.model s SWITCH(ON=0.6 OFF=0.4 RON=10 ROFF=inf)",
             "S1 a b s CONTROL={v(g)}\n.model s SWITCH(ON=0.5 OFF=0.3 RON=10)",
             "S1 a b s CONTROL={v(g)}\n.model s VSWITCH(VON=0.6 VOFF=0.4 RON=10)",
             "S1 a b s CONTROL={v(g)}\n.model s ISWITCH(ION=0.6 IOFF=0.4 RON=10)",
             "S1 a b s CONTROL={v(g)}\n.model s CSW(IT=0.5 RON=10)",
             "S1 a b s OFF CONTROL={v(g)}\n.model s SWITCH(ON=0.6 OFF=0.4 RON=10)",
             "S1 a b s CONTROL={2*v(g)}\n.model s SWITCH(ON=1 OFF=0 RON=10)",
             "S1 a b s CONTROL={-v(g)}\n.model s SWITCH(ON=-0.6 OFF=-0.4 RON=10)",
             "S1 a b s CONTROL={i(rg)}\nRg g 0 1k\n.model s ISWITCH(ION=0.6m IOFF=0.4m RON=10)",
             "S1 a b s CONTROL={i(rg)}\nRg g 0 1k\n.model s SWITCH(ON=0.6m OFF=0.4m RON=10)",
             "X1 a b g q\n.subckt q p n c\nS1 p n s CONTROL={v(c)}\n"
             ".model s SWITCH(ON=0.6 OFF=0.4 RON=10)\n.ends",
         ]),
]

# ---- Sources -------------------------------------------------------------------------------------

SOURCE = "@\nR1 a 0 50\n.tran 0.1n 90.3n\n"
LOADED = "V1 s 0 {v}\nR1 s o 10\n@\n.op\n"
MODULATED = "@\nR1 a 0 1\n.tran 1u 2.3333m\n"
T = 2.3333e-3


def modulated(m, c):
    """A (o + sin m) sin c after a delay of 1 ms."""
    t = T - 1e-3
    return 0.5 * (2 + math.sin(2 * math.pi * 180 * t + math.radians(m))) * math.sin(
        2 * math.pi * 3e3 * t + math.radians(c))


SOURCES = [
    Kind("a function in brackets of its own", SOURCE, "V1 a 0 PULSE(1 -1 0 0 0 20n 40n)", "v(a)", -1.0, [
        "V1 a 0 0.0v (PULSE 1.0V -1.0V 0 0 0 20n 40n) (AC 1v)",
        "V1 a 0 (PULSE 1 -1 0 0 0 20n 40n)",
        "V1 a 0 (PULSE(1 -1 0 0 0 20n 40n))",
        "V1 a 0 (DC 3) (PULSE 1 -1 0 0 0 20n 40n)",
        "V1 a 0 (AC 1) (PULSE 1 -1 0 0 0 20n 40n)",
        "V1 a 0 DC 3 AC 1 0 (PULSE(1 -1 0 0 0 20n 40n))",
        "V1 a 0 (AC 1 90) PULSE(1 -1 0 0 0 20n 40n)",
        "V1 a 0 ( PULSE 1 -1 0 0 0 20n 40n )",
        "V1 a 0 (pulse {1} {-1} 0 0 0 20n 40n)",
        "X1 a s\n.subckt s p\nV1 p 0 0 (PULSE 1 -1 0 0 0 20n 40n) (AC 1)\n.ends",
    ], [("V1 a 0 (PULSE 1 -1 0 0 0 20n 40n", "is missing")]),
    Kind("a value in brackets", "@\nR1 a 0 50\n.op\n", "V1 a 0 5", "v(a)", 5.0, [
        "V1 a 0 ( 5 )",
        "V1 a 0 (5)",
        "V1 a 0 ( 5 ) AC 1",
        "V1 a 0 ( {2+3} )",
        "I1 0 a ( 100m )",
    ], [("V1 a 0 ( 5", "did not expect"), ("V1 a 0 (5) (6)", "a second DC value")]),
    Kind("DISTOF", SOURCE, "V1 a 0 PULSE(1 -1 0 0 0 20n 40n)", "v(a)", -1.0, [
        "V1 a 0 DC 0 AC 1 PULSE(1 -1 0 0 0 20n 40n) DISTOF1 0 DISTOF2 0",
        "V1 a 0 DISTOF1 PULSE(1 -1 0 0 0 20n 40n)",
        "V1 a 0 DISTOF1 1 PULSE(1 -1 0 0 0 20n 40n)",
        "V1 a 0 DISTOF1 1 90 DISTOF2 1 90 PULSE(1 -1 0 0 0 20n 40n)",
        "V1 a 0 PULSE(1 -1 0 0 0 20n 40n) DISTOF2 1",
        "V1 a 0 PULSE(1 -1 0 0 0 20n 40n) distof1 0.1 -90",
        "V1 a 0 DC 0 DISTOF1 = 1 PULSE(1 -1 0 0 0 20n 40n)",
        "V1 a 0 DISTOF1 {1} {2} PULSE(1 -1 0 0 0 20n 40n)",
        "I1 0 a PULSE(20m -20m 0 0 0 20n 40n) DISTOF1 0 DISTOF2 0",
        "X1 a s\n.subckt s p\nV1 p 0 PULSE(1 -1 0 0 0 20n 40n) DISTOF1 1\n.ends",
    ]),
    Kind("a load", LOADED.format(v=5), "I1 o 0 50m", "v(o)", 4.5, [
        "I1 o 0 50m load",
        "I1 o 0 50m LOAD",
        "I1 o 0 DC 50m load",
        "I1 o 0 load 50m",
        "I1 o 0 {50m} load",
        "I1 o 0 25m load\nI2 o 0 25m load",
        "X1 o s\n.subckt s p\nI1 p 0 50m load\n.ends",
        "X1 o s m=2\n.subckt s p\nI1 p 0 25m load\n.ends",
    ]),
    # 0.3 V through 10 ohm are 30 mA: a load of 50 mA takes those and no more, at 0 V.
    Kind("a load on a weak source", LOADED.format(v=0.3), "R2 o 0 0", "v(o)", 0.0, [
        "I1 o 0 50m load",
        "I1 o 0 PWL(0 50m) load",
    ]),
    Kind("a load the wrong way round", LOADED.format(v=-3), "R2 o 0 1t", "v(o)", -3.0, [
        "I1 o 0 50m load",
        "X1 o s\n.subckt s p\nI1 p 0 50m load\n.ends",
    ]),
    Kind("AM with phases", MODULATED, "V1 a 0 AM(0.5 2 180 3k 1m)", "v(a)", modulated(0, 0), [
        "V1 a 0 AM(0.5 2 180 3k 1m 0 0)",
        "V1 a 0 AM(0.5 2 180 3k 1m 0)",
        "V1 a 0 AM 0.5 2 180 3k 1m 0 0",
        "V1 a 0 AM(0.5, 2, 180, 3k, 1m, 360, 0)",
        "V1 a 0 AM(0.5 2 180 3k 1m 0 360)",
    ]),
    Kind("AM with a phase of the carrier", MODULATED, "V1 a 0 AM(0.5 2 180 3k 1m 0 90)", "v(a)",
         modulated(0, 90), ["V1 a 0 AM(0.5 2 180 3k 1m 360 450)"]),
    Kind("AM with a phase of the signal", MODULATED, "V1 a 0 AM(0.5 2 180 3k 1m 90)", "v(a)",
         modulated(90, 0), ["V1 a 0 AM(0.5 2 180 3k 1m -270 0)"]),
    Kind("the bracket behind ENDREPEAT", "@\nR1 a 0 1k\n.tran 1.21m\n",
         "V1 a 0 PWL(0 0 0.2m 0 REPEAT FOREVER (0 2 0.5m 2 0.5m -2 1m -2) ENDREPEAT)", "v(a)",
         2.0, [
             "V1 a 0 PWL(0 0 0.2m 0 REPEAT FOREVER (0 2 0.5m 2 0.5m -2 1m -2) ENDREPEAT",
             "V1 a 0 PWL(0 0 0.2m 0 REPEAT FOREVER 0 2 0.5m 2 0.5m -2 1m -2 ENDREPEAT",
             "V1 a 0 PWL(0 0 0.2m 0 repeat forever (0 2 0.5m 2 0.5m -2 1m -2) endrepeat",
             "V1 a 0 PWL 0 0 0.2m 0 REPEAT FOREVER (0 2 0.5m 2 0.5m -2 1m -2) ENDREPEAT",
             "V1 a 0 PWL(0 0 +0.2m 0 REPEAT FOREVER (0 2 +0.5m 2 0.5m -2 1m -2) ENDREPEAT",
             "V1 a 0 PWL((0 0) (0.2m 0) REPEAT FOREVER (0 2 0.5m 2 0.5m -2 1m -2) ENDREPEAT",
             "V1 a 0 DC 0 PWL(0 0 0.2m 0 REPEAT FOREVER (0 2 0.5m 2 0.5m -2 1m -2) ENDREPEAT",
             "V1 a 0 PWL(0 0 0.2m 0\n+ REPEAT FOREVER (0 2 0.5m 2 0.5m -2 1m -2) ENDREPEAT",
             "I1 0 a PWL(0 0 0.2m 0 REPEAT FOREVER (0 2m 0.5m 2m 0.5m -2m 1m -2m) ENDREPEAT",
             "X1 a s\n.subckt s p\n"
             "V1 p 0 PWL(0 0 0.2m 0 REPEAT FOREVER (0 2 0.5m 2 0.5m -2 1m -2) ENDREPEAT\n.ends",
         ], [("V1 a 0 PWL(0 0 0.2m 0", "never closed"),
             ("V1 a 0 PWL(0 0 REPEAT FOR 2 (0 2 0.5m 2) ENDREPEAT", "never closed")]),
    Kind("PWL whose parts repeat in one another", "@\nR1 a 0 1k\n.tran 100u 9m\n",
         "V1 a 0 PWL(0 0 1m 1 2m 0 3m 1 4m 0 5m 4 6m 1 7m 0 8m 1 9m 3)", "v(a)", 3.0, [
             "V1 a 0 PWL(0 0 REPEAT FOR 1 REPEAT FOR 2 (1m 1 2m 0) ENDREPEAT 9m 3 ENDREPEAT)",
             "V1 a 0 PWL REPEAT FOR 1 (REPEAT FOR 3 (0 0 1m 1 2m 0) ENDREPEAT 9m 3) ENDREPEAT",
             "V1 a 0 PWL REPEAT FOR 3 REPEAT FOR 3 (0 0 +1m 3) ENDREPEAT ENDREPEAT",
             "V1 a 0 PWL(REPEAT FOR 3 REPEAT FOR 2 0 0 1m 1 ENDREPEAT 3m 3 ENDREPEAT)",
             "V1 a 0 PWL(REPEAT FOR 3 0 0 REPEAT FOR 2 0 0 1m 1 ENDREPEAT +1m 3 ENDREPEAT)",
             "V1 a 0 PWL(0 0 1m 1 2m 0 REPEAT FOR 1 REPEAT FOR 2 1m 1 2m 0 ENDREPEAT 10m 6 ENDREPEAT)",
             "V1 a 0 PWL time_scale_factor=1m (REPEAT FOR 3 REPEAT FOR 2 0 0 1 1 ENDREPEAT 3 3 ENDREPEAT)",
             "V1 a 0 PWL value_scale_factor=3 (REPEAT FOR 3 REPEAT FOR 2 0 0 1m 1 ENDREPEAT 3m 1 ENDREPEAT)",
             "V1 a 0 PWL(REPEAT FOREVER REPEAT FOR 2 0 0 1m 1 ENDREPEAT 3m 3 3m 3 ENDREPEAT)",
             "I1 0 a PWL(REPEAT FOR 3 REPEAT FOR 2 0 0 1m 1m ENDREPEAT 3m 3m ENDREPEAT)",
             "X1 a s\n.subckt s p\nV1 p 0 PWL(REPEAT FOR 3 REPEAT FOR 2 0 0 1m 1 ENDREPEAT 3m 3 ENDREPEAT)\n.ends",
         ], [("V1 a 0 PWL(REPEAT FOR 2 REPEAT FOREVER 0 0 1m 1 ENDREPEAT ENDREPEAT)", "cannot stand in one"),
             ("V1 a 0 PWL(REPEAT FOR 2 REPEAT FOR 2 0 0 1m 1 ENDREPEAT", "ENDREPEAT is missing")]),
    Kind("a resistance that begins with braces", "V1 a 0 2\n.param k=100 e=1\n@\nR0 b 0 0\n.op\n",
         "B1 a b I=v(a,b)/(100*(1+v(a,b)))", "i(v1)", -2 / 300, [
        "R1 a b R={k}*(1+v(a,b))",
        "R1 a b R={k}*exp(ln(1+v(a,b)))",
        "R1 a b R={k}+{k}*v(a,b)",
        "R1 a b R={k} + {k}*abs(v(a,b))",
        "R1 a b R={k} * (1+v(a,b)) tc1=0",
        "R1 a b R={k}/(1/(1+v(a,b)))",
        "R1 a b R={k}*(v(a,b) > 1 ? 3 : 4)",
        "R1 a b R={k*(1+v(a,b))}",
        "R1 a b R={k}*{e}*(1+v(a,b))",
        "X1 a b s\n.subckt s p q\nR1 p q R={k}*(1+v(p,q))\n.ends",
    ]),
    Kind("times of a PWL that formulas add", "@\nR1 a 0 1k\n.param d=1m u=2\n.tran 100u 3.5m\n",
         "V1 a 0 PWL(0 0 1m 2 3m 2 4m 4)", "v(a)", 3.0, [
             "V1 a 0 PWL(0 0 +{d} 2 +{2*d} 2 +{d} 4)",
             "V1 a 0 PWL(0 0 +{d} {u} +{u*d} {u} +{d} {u*u})",
             "V1 a 0 PWL 0 0 +{d} 2 +{2*d} 2 +{d} 4",
             "V1 a 0 PWL(0 0 1m 2 +{2*d} 2 +1m 4)",
             "V1 a 0 PWL(0 0\n+ +{d} 2\n+ +{2*d} 2\n+ +{d} 4)",
             "V1 a 0 PWL(0,0,+{d},2,+{2*d},2,+{d},4)",
             "V1 a 0 PWL (0 0) (+{d} 2) (+{2*d} 2) (+{d} 4)",
             "V1 a 0 PWL time_scale_factor=2 (0 0 +{d/2} 2 +{d} 2 +{d/2} 4)",
             "I1 0 a PWL(0 0 +{d} 2m +{2*d} 2m +{d} 4m)",
             "X1 a s k=1m\n.subckt s p k=1\nV1 p 0 PWL(0 0 +{k} 2 +{2*k} 2 +{k} 4)\n.ends",
         ], [("V1 a 0 PWL(0 0 +{d})", "has no value")]),
    Kind("points of a table in brackets", "V1 a 0 1.5\n@\nR1 b 0 1k\n.op\n", "B1 b 0 V=3.5*v(a)/1.5", "v(b)", 3.5, [
        "B1 b 0 V=table(v(a), (0, 1), (1, 2), (2, 5))",
        "B1 b 0 V=table(v(a),(0,1),(1,2),(2,5))",
        "B1 b 0 V=table(abs(v(a)), (0, 1), 1, 2, (2, 5))",
        "B1 b 0 V={table(v(a), (0, 1), (1, 2), (2, 5))}",
        "B1 b 0 V=table(v(a), (0, 1), ((1), 2), (2, (5)))",
        "B1 b 0 V=2*table(v(a), (0, 0.5), (1, 1), (2, 2.5))",
        "B1 0 b I=table(v(a), (0, 1m), (1, 2m), (2, 5m))",
        "R2 b 0 1\nI2 0 b {table(1.5, (0, 1), (1, 2), (2, 5))*1.001}",
        ".func f(x) {table(x, (0,1), (1,2), (2,5))}\nB1 b 0 V=f(v(a))",
        "X1 a b s\n.subckt s p q\nB1 q 0 V=table(v(p), (0, 1), (1, 2), (2, 5))\n.ends",
    ], [("B1 b 0 V=abs((v(a), 2))", "did not expect ','")]),
    Kind("a resistance of .ac", "V1 a 0 10\n@\nR9 b 0 1k\n.op\n", "R1 a b 1k", "v(b)", 5.0, [
        "R1 a b 1k ac=1m",
        "R1 a b 1k ac 1m",
        "R1 a b 1k AC 1Meg",
        "R1 a b R=1k ac 2",
        "R1 a b {500*2} ac {3}",
    ]),
    Kind("words of LTspice behind a formula", "V1 a 0 1\n@\nR1 b 0 1k\n.op\n", "B1 b 0 V=2*v(a)", "v(b)", 2.0, [
        "B1 b 0 V=2*v(a) NoJacob",
        "B1 b 0 V=2*v(a) tripdv=1e308 NoJacob",
        "B1 b 0 V=2*v(a) nojacob tripdt=1n",
        "B1 0 b I=2m*v(a) NoJacob",
        "B1 b 0 V={2*v(a)} NOJACOB",
        "X1 a b s\n.subckt s p q\nB1 q 0 V=2*v(p) NoJacob\n.ends",
    ]),
    # Straight lines between points that move: below, between and above them, in one line and in many, of points in any
    # of their numbers.
    Kind("tables of points that vary", "V1 a 0 1.5\nV2 h 0 3\nV3 n 0 -2\n@\nR9 b 0 1k\n.op\n", "B1 b 0 V=5", "v(b)", 5.0, [
        "B1 b 0 V=table(v(a), 0,v(h)-1, v(h),8)",
        "B1 b 0 V=table(v(a), v(n),v(n), v(h),v(h))+3.5",
        "B1 b 0 V=table(v(a), v(h),5, 2*v(h),9)",
        "B1 b 0 V=table(v(a), v(n),1, -1,v(h)+2)",
        "B1 b 0 V=tbl(v(a), v(n),1, -1,7, 1,v(h)+v(n)+3, 2,6)",
        "B1 b 0 V=table(v(a), v(n),0, 0,0, 1,v(h), v(h)-1,7)",
        "B1 b 0 V={table(v(a), -9,v(n), -8,v(n), -7,v(n), -6,v(n), -5,v(n), 0,v(h)-1, v(h),8)}",
        "B1 b 0 V=1.25*table(v(a)*v(h)/3, 0,0, v(h),v(h)*v(h)-1)",
        "B1 0 b I=table(v(a), 0,2m, v(h),8m)",
        "X1 a b h s\n.subckt s p q r\nB1 q 0 V=table(v(p), 0,v(r)-1, v(r),8)\n.ends",
        ".func f(x,y) {table(x, 0,y-1, y,8)}\nB1 b 0 V=f(v(a),v(h))",
        "B1 b 0 V=table(table(v(a), 0,0, v(h),v(h)), 0,v(h)-1, v(h),8)",
        "E1 b 0 VALUE={table(v(a), (0,v(h)-1), (v(h),8))}",
    ], [("B1 b 0 V=pwl(v(a), 0,0, v(h),1)", "are numbers"),
        ("B1 b 0 V=table(v(a), 0,0, v(h))", "not in order")]),
    # LTspice puts the letter of the kind before a name that lacks it, and finds the element by the drawn name.
    Kind("names as they were drawn", "V1 a 0 10\nB\u00a7src c 0 V=2*v(a)\nR1 c 0 4\nR\u00a7load a 0 5\n@\n"
         ".options dialect=ltspice\n.op\n", "B1 b 0 V=-i(b\u00a7src)", "v(b)", 5.0, [
        "B1 b 0 V=-i(src)",
        "B1 b 0 V={-I(SRC)}",
        "B1 b 0 V=2.5*i(load)",
        "B1 b 0 V=i(load)*i(load)+1",
        "B1 b 0 V=if(i(load)>1,5,0)",
        "B1 0 b I=i(load)/2 Rpar=5",
        "X1 a b s\n.subckt s p q\nR\u00a7load p 0 2\nB1 q 0 V=i(load)\n.ends",
        "X1 a b s\n.subckt s p q\nB\u00a7vm p r V=0\nR1 r 0 2\nB1 q 0 V=i(vm)\n.ends",
        "H1 b 0 src -1",
        "F1 0 b src -1\nR2 b 0 1",
        "E1 b 0 VALUE={2.5*i(load)}",
    ], [("R\u00a7src a 0 1\nB1 b 0 V=i(src)", "there is no element 'src'"),
        ("B1 b 0 V=i(rload)", "there is no element 'rload'")]),
    Kind("tc1 behind a formula", "V1 a 0 1\n@\nR1 b 0 1k\n.op\n", "B1 b 0 V=2*v(a)", "v(b)", 2.0, [
        "B1 b 0 V = 2*v(a) tc1=0.001",
        "B1 b 0 V={2*v(a)} tc1=0.001 tc2=0",
        "B1 b 0 V=2*v(a) temp=50",
        "B1 b 0 V=2*v(a) dtemp=1 tc1=1m",
        "B1 b 0 V=2*v(a) tc=1m,0",
        "B1 0 b I=2m*v(a) tc1=0.001",
        "B1 b 0 V=2*v(a) TC1={1m}",
        "E1 b 0 VALUE={2*v(a)} tc1=0.001",
        "G1 0 b VALUE={2m*v(a)} tc1=0.001",
        "X1 a b s\n.subckt s p q\nB1 q 0 V=2*v(p) tc1=0.001 tc2=1u\n.ends",
    ], [("B1 b 0 V=2*v(a) gain=1", "did not expect")]),
]

# At 90 degrees, of one that is 1 kohm at 27: 1 + 1m*63 + 2u*63^2.
WARM = 1.070938
HEATED = "I1 0 a 1m\n@\nR0 b 0 0\n.op\n"
MODELS += [
    Kind("a resistance at a temperature", HEATED, "R1 a b 1070.938", "v(a)", WARM, [
        "R1 a b 1k tc=1m,2u temp=90",
        "R1 a b 1k tc1=1m tc2=2u temp=90",
        "R1 a b rm 1k temp=90\n.model rm R(tc1=1m tc2=2u)",
        "R1 a b rm\n.model rm RES(R=1k tc1=1m tc2=2u)\n.temp 90",
        "R1 a b 1k tc1=1m tc2=2u\n.options temp=90",
        "R1 a b 1k tc1=1m tc2=2u dtemp=63",
        ".options temp=57\nR1 a b 1k tc1=1m tc2=2u dtemp=33",
        ".options temp=70 tnom=7\nR1 a b 1k tc1=1m tc2=2u",
        "R1 a b rm 1k\n.model rm R(tc1=1m tc2=2u tnom=7)\n.temp 70",
        "R1 a b {1k*(1+1m*(temp-27)+2u*(temp-27)**2)}\n.temp 90",
        ".param t=90\n.temp {t}\nR1 a b {1k*(1+1m*(temper-27)+2u*(temper-27)**2)}",
        "X1 a b s\n.subckt s p q\nR1 p q 1k tc1=1m tc2=2u\n.ends\n.temp 90",
        "X1 a b s\n.subckt s p q\nR1 p q {1k*(1+1m*(temp-27)+2u*(temp-27)**2)}\n.ends\n.option temp=90",
        "B1 a b I=v(a,b)/(1k*(1+1m*(temp-27)+2u*(temp-27)**2))\n.temp 90",
        f"R1 a b 1k tce={math.log(WARM) / math.log(1.01) / 63!r} temp=90",
        "R1 a b 1070.938 tc1=1m tc2=2u",
        ".param temp=90\nR1 a b 1070.938 tc1=1m",
        ".temp 90\nR1 a b 1070.938",
        "R1 a b 1k tc=1m,2u\n.temp = 90", ".temp={45*2}\nR1 a b 1k tc=1m,2u", ".TEMP =90\nR1 a b 1k tc=1m,2u",
    ], [("R1 a b 1k tc=1m,2m,3m", "did not expect"), (".temp\nR1 a b 1k", "a temperature is missing")]),
    Kind("a capacitance at a temperature", RISING, "C1 b 0 1m", "v(b)", 1 - math.exp(-1), [
        "C1 b 0 0.8m tc1=0.01 temp=52",
        "C1 b 0 cm 0.8m dtemp=25\n.model cm C(tc1=0.01)",
        "C1 b 0 cm\n.model cm C(c=0.8m tc1=0.01)\n.temp 52",
        "C1 b 0 2m tc1=0.01 temp=-23",
    ], [("C1 b 0 1m tc1=0.01 temp=-173", "cannot be negative")]),
]

# ---- Parameters, conditions, formulas --------------------------------------------------------------

CHOSEN = "V1 a 0 10\n@\nR9 a b 1k\n.op\n"
LOGIC = "V1 a 0 {x}\nV2 b 0 {y}\n@\nR1 x 0 1k\n.op\n"
PARAMETERS = [
    Kind(".param without an equal sign", "@\nR1 a 0 1\n.op\n", ".param v=5\nV1 a 0 {v}", "v(a)", 5.0, [
        ".param v 5\nV1 a 0 {v}",
        ".PARAM V 5\nV1 a 0 {v}",
        ".param v {5}\nV1 a 0 {v}",
        ".param v '2+3'\nV1 a 0 {v}",
        ".param v 5 w 3\nV1 a 0 {v*w/3}",
        ".param w 3 v=5\nV1 a 0 {v*w/3}",
        ".param v w+2\n.param w 3\nV1 a 0 {v}",
        ".param v -w\n.param w -5\nV1 a 0 {v}",
        ".param v 5V\nV1 a 0 {v}",
        ".params v 5000m\nV1 a 0 v",
        "X1 a s\n.subckt s p\n.param v 5\nV1 p 0 {v}\n.ends",
    ], [(".param v\nV1 a 0 5", "expected name=value"), (".param 5 v\nV1 a 0 5", "expected name=value")]),
    Kind("= in a condition", CHOSEN, ".param n=2\n.if (n == 2)\nR1 b 0 1k\n.else\nR1 b 0 3k\n.endif",
         "v(b)", 5.0, [
             ".param n=2\n.if (n = 2)\nR1 b 0 1k\n.else\nR1 b 0 3k\n.endif",
             ".param n=2\n.if (n=2)\nR1 b 0 1k\n.else\nR1 b 0 3k\n.endif",
             ".param n=2\n.if n = 2\nR1 b 0 1k\n.else\nR1 b 0 3k\n.endif",
             ".param n=2\n.if (n = 1)\nR1 b 0 3k\n.elseif (n = 2)\nR1 b 0 1k\n.endif",
             ".param n=2 m=3\n.if (n = 2 && m = 3)\nR1 b 0 1k\n.else\nR1 b 0 3k\n.endif",
             ".param n=2 m=3\n.if ((n = 1) || (m = 3))\nR1 b 0 1k\n.else\nR1 b 0 3k\n.endif",
             ".param n=2\n.if (n+1 = 3)\nR1 b 0 1k\n.else\nR1 b 0 3k\n.endif",
             ".param n=2\n.if (3 = n)\nR1 b 0 3k\n.elseif (2 = n)\nR1 b 0 1k\n.endif",
             ".param n=2\n.if (n <= 2)\n.if (n = 2)\nR1 b 0 1k\n.endif\n.endif",
             ".param n=2\n.if (!(n = 3))\nR1 b 0 1k\n.else\nR1 b 0 3k\n.endif",
             "X1 b s n=2\n.subckt s p n=1\n.if (n = 2)\nR1 p 0 1k\n.else\nR1 p 0 3k\n.endif\n.ends",
         ], [(".param n={1=1}\nR1 b 0 1k", "a comparison is written ==")]),
    Kind("a switch of level 2", "V1 a 0 {V}\n.param V=10\nVc c 0 PULSE(0 1 0 1m 1m 0 2m)\n@\nR1 b 0 1k\n.tran 10u 0.7m\n",
         "S1 a b c 0 w\n.model w SW(Ron=1k Vt=0.6)", "v(b)", 5.0, [
             "S1 a b c 0 w\n.model w SW(level=2 Ron=1k Vt=0.6 Vh=-0.2)",
             "S1 a b c 0 w\n.model w SW(Ron=1k Vt=0.6 Vh=0.2 LEVEL=2)",
             "S1 a b c 0 w\n.model w SW Ron=1k Vt=0.6 level=2",
             "S1 a b c 0 w\n.model w SW(Ron=1k Vt=0.6 level=1)",
         ], [("S1 a b c 0 w\n.model w SW(Ron=1k level=3)", "is 1 or 2")]),
    Kind("another name behind .ends", "V1 a 0 10\n@\nR9 a b 1k\n.op\n", "R1 b 0 1k", "v(b)", 5.0, [
        "X1 b 0 s\n.subckt s p q\nR1 p q 1k\n.ends",
        "X1 b 0 s\n.subckt s p q\nR1 p q 1k\n.ends t",
        "X1 b 0 s_2\n.subckt s_2 p q\nR1 p q 1k\n.ends s 2",
        "X1 b 0 s\n.subckt s p q\nX1 p q t\n.subckt t p q\nR1 p q 1k\n.ends u\n.ends v",
        "X1 b 0 s\n.subckt s p q\n.if (1 > 0)\nR1 p q 1k\n.endif\n.ends t",
    ], [("X1 b 0 s\n.subckt s p q\nX1 p q t\n.subckt t p q\nR1 p q 1k\n.ends s\n.ends", "ends here is 't'")]),
    Kind("m= of a subcircuit", "V1 a 0 10\n@\nR9 a b 1k\n.op\n", "R1 b 0 1k", "v(b)", 5.0, [
        "X1 b 0 s m=2\n.subckt s p q\nR1 p x 1k\nR2 x q 1k\n.ends",
        "X1 b 0 s M=4\n.subckt s p q\nR1 p q 4k\n.ends",
        "X1 b 0 s m=0.5\n.subckt s p q\nR1 p q 500\n.ends",
        "X1 b 0 s r=2k m=2\n.subckt s p q r=1\nR1 p q {r}\n.ends",
        "X1 b 0 s m={1+1}\n.subckt s p q\nR1 p q 2k\n.ends",
        "X1 b 0 t m=2\n.subckt t p q\nX2 p q s m=2\n.ends\n.subckt s p q\nR1 p q 4k\n.ends",
        "X1 b 0 t\n.subckt t p q\nX2 p q s m=2\n.ends\n.subckt s p q\nR1 p q 4k m=2\n.ends",
        "X1 b 0 s m=5\n.subckt s p q\nI1 p q 1m\n.ends",
        "X1 b 0 s m=2\n.subckt s p q\nG1 p q p q 0.5m\n.ends",
        "X1 b 0 s m=10\n.subckt s p q\nD1 p q d\n.model d D(Ron=10k)\n.ends",
        "X1 b 0 s m=2\n.subckt s p q\nV1 g 0 1\nS1 p q g 0 w\n.model w SW(Ron=2k Vt=0.5)\n.ends",
        "X1 b 0 s m=2\n.subckt s p q\nE1 x 0 p 0 0.5\nR1 p x 1k\n.ends",
        "X1 b 0 s m=2\n.subckt s p q m=1\nR1 p q {1k*m/2}\n.ends",
    ], [("X1 b 0 s m=2\n.subckt s p q\nV1 p x 0\nF1 x q V1 1\nR1 x q 1k\n.ends", "'x1.f1' reads a current"),
        ("X1 b 0 s m=-2\n.subckt s p q\nR1 p q 1k\n.ends", "must be positive")]),
]
for x, y in ((0, 0), (0, 5), (5, 0), (5, 5)):
    XOR = float(5 * ((x > 2.5) != (y > 2.5)))
    PARAMETERS.append(
        Kind(f"comparisons that differ, {x} and {y}", LOGIC.format(x=x, y=y),
             "B1 x 0 V=((v(a) > 2.5) && !(v(b) > 2.5)) || (!(v(a) > 2.5) && (v(b) > 2.5)) ? 5 : 0",
             "v(x)", XOR, [
                 "B1 x 0 V = ((v(a) > 2.5) != (v(b) > 2.5)) ? 5 : 0",
                 "B1 x 0 V = ((v(a) > 2.5) <> (v(b) > 2.5)) ? 5 : 0",
                 "B1 x 0 V = ((v(a) > 2.5) == (v(b) > 2.5)) ? 0 : 5",
                 "B1 x 0 V = 5*((v(a) > 2.5) != (v(b) > 2.5))",
                 "B1 x 0 V = if((v(a) < 2.5) != (v(b) < 2.5), 5, 0)",
                 "B1 x 0 V = ((v(a) > 2.5) == (v(b) < 2.5)) ? 5 : 0",
                 "B1 x 0 V = ((v(a) > 2.5) != ((v(b) > 2.5) == 1)) ? 5 : 0",
                 "B1 x 0 V = (!(v(a) > 2.5) == (v(b) > 2.5)) ? 5 : 0",
                 "B1 x 0 V = (((v(a) > 2.5) != (v(b) > 2.5)) != 0) ? 5 : 0",
                 "E1 x 0 VALUE={((v(a) > 2.5) != (v(b) > 2.5)) ? 5 : 0}",
                 "X1 a b x s\n.subckt s p q r\nB1 r 0 V=((v(p)>2.5) != (v(q)>2.5)) ? 5 : 0\n.ends",
             ], [("B1 x 0 V = (v(a) != v(b)) ? 5 : 0", "single points")]))

# ---- Analyses --------------------------------------------------------------------------------------

SLOW = "V1 a 0 10\nR1 a b 1k\nC1 b 0 1u\n@\n"
# Through a ramp of 20 us and then for 480 us: v = 10 - 10 tau/T (e^(T/tau) - 1) e^(-t/tau).
RAISED = 10 - 10 * (1e-3 / 20e-6) * math.expm1(20e-6 / 1e-3) * math.exp(-0.5)
ANALYSES = [
    Kind("startup", SLOW, ".tran 0.5m startup", "v(b)", RAISED, [
        ".tran 0 0.5m startup",
        ".tran 0 0.5m 0 startup",
        ".tran 0.5m STARTUP",
        ".tran 1u 0.5m 0 1u startup",
        ".tran 0.5m startup nodiscard",
        ".tran 0.5m startup uic",
        ".tran {0.5m} startup",
    ], [(".tran 0.5m step", "not supported")]),
]

# ---- Formulas in place of values -------------------------------------------------------------------

OHMS = """
V1 a 0 10
Vc c 0 2
@
R9 b 0 1k
.op
"""
WATTS = """
V1 a 0 10
R1 a b 100
Vc c 0 0.2
@
.op
"""
# i = 0.2/v at 10 - 100 i = v: the larger of the two.
ON_WATTS = 5 + math.sqrt(25 - 20)
DOUBLED = """
V1 a 0 10
R1 a b 1k
@
.op
"""
FORMULAS = [
    Kind("a resistance that is a formula", OHMS, "B1 a b V={i(b1)*1k*v(c)}", "v(b)", 10 / 3, [
        "R1 a b R={1k*v(c)}",
        "R1 a b {1k*v(c)}",
        "R1 a b '1k*v(c)'",
        "R1 a b r='v(c) * 1000'",
        "R1 a b R=1k*v(c)",
        "R1 a b R=1k*(v(c,0))",
        "R1 a b R={v(c) > 1 ? 2k : 1G}",
        "R1 a b R=if(v(c) > 1, 2k, 1G)",
        "R1 a b R={table(v(c), 0,1k, 4,3k)} tc1=0.1 tc2=0.2",
        "R1 a b R={sqrt(v(c)*2)*1k}",
        "R1 a b R={4k*(v(c)-1)} m=2",
        "R1 a b {1k*v(c)} noiseless",
        "B1 a b R={1k*v(c)}",
        "B1 a b R=1k*v(c)",
        "R1 a b R={2k + 0*time}",
        "X1 a b c s\n.subckt s p q g\n.param k=1k\nR1 p q R={k*v(g)}\n.ends",
        "X1 a b c s k=2k m=2\n.subckt s p q g k=1\nR1 p q R={k*v(g)}\n.ends",
        "Vs c2 0 2m\nR1 a b R={1e6*v(c2)}",
        "Fs 0 c2 V1 -200\nR8 c2 0 1\nR1 a b R={2k + 0*i(v1)}",
    ], [("R1 a b R={1k*v(nowhere)}", "nowhere"),
        ("R1 a b R={1k*v(c)} m=-1", "must be positive")]),
    Kind("a power that is a formula", WATTS, "B1 b 0 I={v(c)/v(b)}", "v(b)", ON_WATTS, [
        "B1 b 0 P={v(c)}",
        "B1 b 0 P=v(c)",
        "B1 b 0 P=0.2",
        "B1 0 b P={v(c)}",
        "B1 b 0 P={v(c)/2} m=2",
        "B1 b 0 P={0.1*v(c)*10}",
        "X1 b c s\n.subckt s p g\nB1 p 0 P={v(g)}\n.ends",
        "X1 b s w=0.2\n.subckt s p w=1\nB1 p 0 P={w}\n.ends",
        "B1 b 0 P=0.1\nB2 b 0 P=v(c)/2",
        "B1 b 0 P={max(v(c),0)}",
    ], [("B1 b 0 Q={v(c)}", "has no 'q='")]),
    Kind("a kind of another model", DERIVED, ".model new D(Ron=1k Vfwd=1)", "v(b)", 4.5, [
        ".model new ako:old Ron=1k", ".model new AKO:old D(Ron=1k)", ".model new ako: old D Ron=1k",
        ".model new AKO:Old D (Ron=1k)", ".model new ako:other Vfwd=1", ".model new ako:other (Vfwd=1)",
        ".model new ako:between\n.model between ako:old Ron=1k", ".model new ako:old Ron={2*k}\n.param k=500",
        ".model new ako:old Ron=1k Vfwd=1", ".model new ako:Both",
        ".subckt s p q\nD1 p q inner\n.model inner ako:other Vfwd=1\n.ends\n.model new ako:old Vfwd=100\nX1 a b s",
    ], [(".model new ako:nothing", "there is no model 'nothing' that this one could be a kind of"),
        (".model new ako:new", "'new' is a kind of itself"),
        (".model new ako:next\n.model next ako:new", "is a kind of itself")]),
    Kind("sources in parallel", DOUBLED, "B1 b 0 I={2m*v(b)}", "v(b)", 10 / 3, [
        "B1 b 0 I={1m*v(b)} m=2",
        "B1 b 0 I=1m*v(b) m=2",
        "B1 b 0 I=0.5m*v(b) M=4",
        "B1 b 0 I={1m*v(b)} m={1+1}",
        "B1 b 0 I={1m*v(b)} tc1=0 m=2",
        "B1 b 0 I={1m*v(b)} m=2 tc1=0",
        "G1 b 0 VALUE={1m*v(b)} m=2",
        "G1 b 0 VALUE {1m*v(b)} M=2",
        "G1 b 0 cur='1m*v(b)' m=2",
        "X1 b s\n.subckt s p\nB1 p 0 I={1m*v(p)} m=2\n.ends",
    ], [("B1 b 0 I={1m*v(b)} m=0", "must be positive"),
        ("B1 b 0 V={1m*v(b)} m=2", "did not expect")]),
]

# ---- Carriers: at 0.73 ms of a period of 1 ms ------------------------------------------------------

OVER_TIME = """
.param f=1k
B1 a 0 V={@}
R1 a 0 1
.tran 10u 0.73m
"""
FOUR = """
.param f=1k
B1 a 0 V={@}
R1 a 0 1
.tran 10u 3.73m
"""
FORMULAS += [
    Kind("a formula of .four in braces", "V1 a 0 SIN(0 1 1k 0 0 90)\nR1 a 0 1k\n.param f=1k n=3\n@\n.tran 10u 2m\n", ".four 1k v(a)", "v(a)", 1.0, [
        ".four 1k {v(a)}",
        ".four {f} {n} {v(a)}",
        ".four {f} {n} {n-2} {2*v(a)} v(a) {v(a)*i(v1)}",
        ".options dialect=xyce\nX1 s\n.subckt s\nV2 c 0 SIN(0 1 1k)\nR2 c 0 1\n.ends\n.four 1k {v(x1:c)} {v(a)-2*V(X1:c)}",
    ]),
]

# Beyond their domain roots, powers and inverse functions are complex in LTspice and Xyce, and the real part counts.
LTSPICE = ".options dialect=ltspice\nV1 a 0 -4\n@\nR1 b 0 1k\n.op\n"
FORMULAS += [
    Kind("the real part of a function", LTSPICE, "B1 b 0 V=1+0*v(a)", "v(b)", 1.0, [
        "B1 b 0 V=1+sqrt(v(a))",
        "B1 b 0 V=1+v(a)**0.5",
        "B1 b 0 V=1+pow(v(a), 1.5)+pow(v(a)-1, 2.5)",
        "B1 b 0 V=sqrt(sqrt(v(a)*3-1)+1)",
        "B1 b 0 V=sqrt(v(a)**2)-3",
        "B1 b 0 V=sqrt(v(a)*v(a)+9)-4",
        "B1 b 0 V=1+acosh(v(a)/8)+acosh(v(a))",
        "B1 b 0 V=-asin(v(a))*2/pi",
        "B1 b 0 V=acos(v(a))/pi",
        "B1 b 0 V=1-arccos(-v(a))-sqrt(v(a))",
        "B1 b 0 V=1+(v(a) > -5 ? sqrt(v(a)) : 7)",
        "B1 b 0 V=if(v(a) > 0.1, sqrt(v(a)), 1)",
        "B1 0 b I=1m+sqrt(v(a))",
        ".func f(x) {sqrt(x)}\nE1 b 0 value={1+f(v(a))}",
        "X1 a b s\n.subckt s p q\nB1 q 0 V=1+sqrt(v(p))*v(p)\n.ends",
    ]),
    Kind("the real part from a time on", ".options dialect=ltspice\nV1 a 0 PWL(0 -1 1m 1)\n@\nC1 c 0 1m\n.tran 50u 1m uic\n",
         "I1 0 c PWL(0 0.4 0.5m 0.4 0.5m 0)", "v(c)", 0.2, [
        "B1 0 c I=v(a)**1.5",
        "B1 0 c I=pow(v(a), 1.5)",
        "B1 0 c I=uramp(v(a))**1.5",
        "B1 0 c I=sqrt(v(a))*v(a)",
    ]),
    Kind("the real part in Xyce", LTSPICE.replace("ltspice", "xyce"), "B1 b 0 V=1+0*v(a)", "v(b)", 1.0, [
        "B1 b 0 V={1+sqrt(v(a))}",
        "E1 b 0 VALUE={1+pow(v(a), 1.5)}",
    ]),
]

# In LTspice asin(x) is that of x held in -1 ... 1. What a sine gives is there anyway, and must stay a triangle.
EMF = """
.options dialect=ltspice
.param f=100
B1 a n V=@
R1 n 0 1
L1 a b 10u Rser=0
R2 b 0 1
.tran 10u 52.5m
"""
CARRIERS = [
    Kind("a sawtooth", OVER_TIME, "f*time", "v(a)", 0.73, [
        "time*f-floor(time*f)",
        "f*time - floor(f*time)",
        "(time % 1m)/1m",
        "fmod(time, 1m)*f",
        "fmod(time*f, 1)",
        "time*f - int(time*f)",
        "1 - (-f*time - floor(-f*time))",
        "f*(time+2m) - floor(f*(time+2m))",
        "atan(tan(pi*f*time - pi/2))/pi + 0.5",
        "0.5 - atan(-tan(pi*f*time - pi/2))/pi",
        "f*time + 1 - ceil(f*time)",
        "f*time - round(f*time) + 1",
    ], [("v(a) - floor(v(a)) + 1", "steps without end")]),
    Kind("the same four periods later", FOUR, "f*time - 3", "v(a)", 0.73, [
        "time*f-floor(time*f)",
        "(time % 1m)/1m",
        "fmod(time, 1m)*f",
        "time*f - int(time*f)",
        "1 - (-f*time - floor(-f*time))",
        "f*(time+2m) - floor(f*(time+2m))",
        "atan(tan(pi*f*time - pi/2))/pi + 0.5",
        "f*time + 1 - ceil(f*time)",
        "f*time - round(f*time) + 1",
        "f*time - 3*(floor(f*time) > 2.5 ? 1 : 0)",
    ]),
    Kind("a triangle", FOUR, "4*f*time - 16 + 0.08 + 0", "v(a)", -1.0, [
        "2/pi*asin(sin(2*pi*f*time)) - 0.08",
        "2/pi*arcsin(sin(2*pi*f*time)) - 0.08",
        "2/pi*asin(sin(2*pi*f*(time-2m))) - 0.08",
        "2/pi*asin(cos(2*pi*f*time - pi/2)) - 0.08",
        "1 - 2/pi*acos(sin(2*pi*f*time)) - 0.08",
        "1 - 2/pi*acos(cos(2*pi*f*time - pi/2)) - 0.08",
        "1 - 2/pi*arccos(cos(pi/2 - 2*pi*f*time)) - 0.08",
        "1 - 4*abs(f*time - 0.25 - floor(f*time + 0.25)) - 0.08",
        "-2/pi*asin(sin(-2*pi*f*time))*1 - 0.08",
        "-2/pi*asin(-sin(2*pi*f*time)) - 0.08",
        "2/pi*acos(-cos(2*pi*f*time - pi/2)) - 1.08",
        "4*abs(f*time + 0.25 - round(f*time + 0.25)) - 1.08",
    ]),
    Kind("the back EMF of a motor's phase behind its coil", EMF, "20", "v(b)", 10.0, [
        "20*limit(3/pi*asin(sin(2*pi*f*time)),-1,1)",
        "limit(60/pi*arcsin(sin(2*pi*f*(time-10m))),-20,20)",
        "20*limit(3/pi*asin(cos(2*pi*f*time - pi/2)),-1,1)",
        "20*limit(-3/pi*asin(-sin(2*pi*f*time)),-1,1)",
        "20*limit(1.5 - 3/pi*acos(cos(2*pi*f*time - pi/2)),-1,1) + 0",
    ]),
    Kind("a comparator with a carrier", FOUR, "1", "v(a)", 1.0, [
        "0.5 > 2/pi*asin(sin(2*pi*f*time)) ? 1 : 0",
        "0.5 > time*f - floor(time*f) ? 0 : 1",
        "u(0.5 - 2/pi*asin(sin(2*pi*f*time)))",
        "(time*f - floor(time*f)) > 0.7",
        "!(2/pi*asin(sin(2*pi*f*time)) > sin(2*pi*10*time))",
        "buf(time*f - floor(time*f))",
        "if(fmod(time,1m) < 0.72m, 0, 1)",
        "(time*f - floor(time*f) > 0.7 && time > 1m) ? 1 : 0",
        "floor(2*f*time) - 2*floor(f*time)",
        "floor(time*f)/3",
    ]),
]

NOTED = [
    ("a value on .print", "V1 a 0 1\nR1 a 0 1\n.print dc v(a) r1:r\n.op\n", "no signal: it is left out"),
    ("a value on .print", "V1 a 0 1\nR1 a 0 1\n.param q=2\n.print dc q v(a)\n.op\n", "is left out"),
    ("a value on .print", "V1 a 0 1\nR1 a 0 1\n.print dc v(a) temp\n.op\n", "is left out"),
    ("a value on .print", "V1 a 0 1\nD1 a 0 dm\n.model dm D(Ron=1)\n.print dc v(a) dm:ron n(d1:cd)\n"
     ".op\n", "is left out"),
    ("a value on .print", "V1 a 0 1\nX1 a s\n.subckt s p\nR1 p 0 1\n.ends\n.print dc v(a) x1:r1:r\n"
     ".op\n", "is left out"),
    ("a value on .print", "V1 a 0 1\nR1 a 0 1\n.print dc v(a) {r1:r} {2*r1:r+v(a)}\n.op\n", "is left out"),
    ("a value on .print", "V1 a 0 1\nX1 a s\n.subckt s p\nR1 p q 1\nR2 q 0 1\n.ends\n"
     ".print dc v(a) {x1:r1:r} {v(x1:q)*2}\n.op\n", "'x1:r1:r' is a value of the netlist"),
    ("a value on .print", "V1 a 0 1\nD1 a 0 dm\n.model dm D(Ron=1)\n.print dc {dm:ron} v(a)\n.op\n", "left out"),
    ("a model of LTspice's", "V1 a 0 1\nD1 a b D\nR1 b 0 1\n.op\n", "exactly ideal"),
    ("words of a diode", "V1 a 0 1\nD1 a b d1 PJ=0.5 w=1u thermal\n.model d1 D(IS=1n CJSW=1p rth0=3 "
     "fv_max=2)\nR1 b 0 1\n.op\n", "ignored"),
    ("words of .measure", "V1 a 0 1\nR1 a 0 1\n.tran 1m\n.measure tran m max v(a) failvalue=1u\n",
     "has no meaning here"),
    ("reltol", "V1 a 0 1\nR1 a 0 1\n.options reltol=0.2\n.op\n", "a tolerance of 0.2 is cut to 0.1"),
    ("reltol", "V1 a 0 1\nR1 a 0 1\n.options abstol=0.2 reltol=0.5\n.op\n", "is cut to 0.1"),
    ("a power", "V1 a 0 1\nE1 b 0 a 0 2\nR1 b 0 1\n.print op v(a) P(e1) W(e1)\n.op\n", "p(...) is left out"),
    ("a power", "V1 a 0 1\nC1 a 0 1u Rser=1\n.print op v(a) W(c1)\n.op\n", "w(...) is left out"),
    ("startup", "V1 a 0 SIN(1 1 50)\nR1 a 0 1\n.tran 1m startup\n", "does not start at 0"),
    ("a library", "V1 a 0 1\nR1 a 0 1\n.op\n"
     ".lib C:\\Program Files (x86)\\LTC\\LTspiceIV\\lib\\cmp\\standard.dio\n", "is left out"),
    ("a library", "V1 a 0 1\nR1 a 0 1\n.op\n.lib C:\\a b\\lib\\cmp\\standard.mos\n", "is left out"),
    ("a library", "V1 a 0 1\nR1 a 0 1\n.op\n.lib /home/me/my lib (2)/cmp/Standard.BJT\n", "is left out"),
    ("a library", "V1 a 0 1\nR1 a 0 1\n.op\n.lib standard.cap\n", "is left out"),
    ("a library", "V1 a 0 1\nR1 a 0 1\n.op\n.include C:\\LTC\\cmp\\standard.jft\n", "is left out"),
    ("an integral", "V1 a 0 1\nB1 b 0 V=idt(v(a)-2*v(b))\nR1 b 0 1k\n.op\n", "without a .tran an integral is at rest"),
    ("an integral", "V1 a 0 1\nB1 b 0 V=idt(v(a)-2*v(b))\nR1 b 0 1k\n.ic v(b)=1\n.op\n", ".ic v(...) counts only for .tran"),
    ("a model twice", "V1 a 0 1\nD1 a b d\nR1 b 0 1\n.model d D(Ron=1 Vfwd={0.1*2})\n.model d  d(ron=1 vfwd={0.1*2}) ; again\n.op\n",
     "this model 'd' is the one at"),
    ("an open model", "V1 a 0 1\nD1 a b d\nR1 b 0 1\n.model d D(Ron=1\n.op\n", "the model ends with its card"),
    ("a bias point", "V1 a 0 1\nR1 a 0 1\n.tran 1m\n.savebias b.txt internal time=1m\n", "(.savebias) are not used"),
    ("a bias point", "V1 a 0 1\nR1 a 0 1\n.op\n.loadbias b.txt\n", "(.loadbias) are not used"),
    ("steady", "V1 a 0 1\nR1 a 0 1\n.tran 0 1m 0 1u steady startup\n", "goes on to the end of .tran"),
    ("a temperature", "V1 a 0 1\nD1 a b d\nR1 b 0 1 tc1=1m\n.model d D(Is=1p)\n.temp 85\n.op\n", "keep their values of 27 degrees"),
    ("temperatures", "V1 a 0 1\nR1 a 0 1 tc1=1m\n.temp 27 85 125\n.op\n", "first temperature of this card alone"),
    ("a stray parenthesis", "V1 a 0 1\nS1 a b a 0 w\nR1 b 0 1\n.model w SW Ron=1 Vt=0.5 )\n.op\n", "no parenthesis was opened that this one closes"),
    ("a stray parenthesis", "V1 a 0 1\nD1 a b d\nR1 b 0 1\n.model d D(Ron=1))\n.op\n", "no parenthesis was opened that this one closes"),
    ("a stray parenthesis", "V1 a 0 1\nA1 a b g\nR1 b 0 1\n.model g gain gain=2 )\n.op\n", "no parenthesis was opened that this one closes"),
    ("level 2", "V1 a 0 1\nS1 a b a 0 w\nR1 b 0 1\n.model w SW(level=2 Ron=1 Roff=1Meg Vt=0.5 Vh=-0.1)\n.op\n", "changes over smoothly from 0.4 to 0.6 V (LTspice)"),
    ("level 2", "V1 a 0 1\nS1 a b a 0 w\nR1 b 0 1\n.param l=2\n.model w SW(Ron=1 Vt=0.5 Vh=0.3 level={l})\n.op\n", "from 0.2 to 0.8 V (LTspice)"),
    ("the name of .ends", "V1 a 0 1\nX1 a 0 s\n.subckt s p q\nR1 p q 1\n.ends r\n.op\n", "that ends here is 's'"),
    ("a sound file", "V1 a 0 1\nR1 a 0 1\n.tran 1m\n.wave out.wav 16 44100 v(a)\n", "(.wave) are not written"),
    ("a sound file", "V1 a 0 1\nR1 a 0 1\n.op\n.wave \"c:\\my sounds\\o.wav\" 8 8k v(a) v(a)\n", "(.wave) are not written"),
]


def check_notes(checker, program):
    for name, body, words in NOTED:
        done = run(program, f"{name}\n{body}.end\n", method=None, report=False, quiet=False)
        checker.check(done.status == 0 and words in done.stderr,
                      f"{name}: ends with {done.status}, without '{words}'\n{done.stderr}")


def check_table(checker, program):
    """A table of time with thousands of points is a triangle at each."""
    for n in (600, 5000):
        points = "".join(f"+ ,{k / 10:.1f}u,{k % 2}\n" for k in range(n))
        done = run(program, f"table\nB1 a 0 V={{table(time\n{points}+ )}}\nR1 a 0 1\n"
                   f".tran 1u {n / 10 - 0.15:.2f}u\n.end\n", method=None, report=False)
        checker.check(done.status == 0, done.stderr)
        if done.rows:
            checker.close(done.column("v(a)")[-1], 0.5, 1e-6, f"{n} points: the last value")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("spellings")
    for kind in (ELEMENTS + DIODES + MODELS + SOURCES + PARAMETERS + ANALYSES + FORMULAS +
                 CARRIERS):
        check(checker, program, kind)
    check_notes(checker, program)
    check_table(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
