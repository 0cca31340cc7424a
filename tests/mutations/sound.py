#!/usr/bin/env python3
"""Right waveforms of circuits that look as if a law were broken: the audit finds nothing in them, drawn or full. A
comparator whose output stands between its levels: either its argument is at the knot, or the audit says that it is not. And
formulas that cut off what has far more digits than a number keeps: either they are right, or the audit says that they are not.

usage: sound.py PROGRAM
"""

import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

EDGE = "V1 a 0 PULSE(0 1 1m 0 0 2m 10m)\n"
DRIVEN = EDGE + "E1 u 0 a 0 1\nC1 u 0 1m\n"
READ = "R1 d 0 1k\nR3 d f 1k\nC3 f 0 1u\n.tran 0.1m 5m\n"
CUT = ("vin in 0 12\nvg g 0 PULSE(0 12 0 10n 10n {{{period}/2}} {period})\ns1 in sw g 0 sa\ns2 0 sw sw 0 sb\nl1 sw out {henry}\n"
       "c1 out 0 100u\nr1 out 0 1\n.model sa SW(ron=1m roff={roff} vt=0.5)\n.model sb SW(ron=1m roff={roff} vt=0)\n")
TRIAC = "V1 a 0 SIN(0 325 50)\nR1 a c 10\nL1 c b 10m\nA1 b 0 g t1\nVg g 0 PULSE(0 2 4m 0 0 0.5m 10m)\n"

FILTERED = "V1 a 0 SIN(0 1 1k)\nR1 a b 1k\nC1 b 0 10n ic=0\n"
LOADED = "R2 o p 1k\nC2 p 0 1u ic=0\n.tran 5u 2m uic\n"
LINE_COILS = ("va a 0 SIN(0 311 50)\nvc c 0 SIN(0 311 50 0 0 120)\nl1 a a1 1m\nl3 c c1 1m\nd1 a1 p d\nd3 c1 p d\n"
              "d4 n a1 d\nd6 n c1 d\nrg n 0 1meg\nld p x 50m\nrd x n 50\n.tran 10u 20m\n")

# name: (netlist, options, {(signal, time): value})
CIRCUITS = {
    "a node at 0 V beside 3 V, which elimination makes 1e-17 V": (
        "v1 a 0 -3\nr2 b 0 509\nr3 c b 0.07506\nr4 d a 15.22k\nc1 d b 195.2n\ng2 b d b 0 0.009449\n.op\n", [], {}),
    "nothing flows, beside 5 V across tenths of milliohms": (
        "v1 a 0 5\nr2 b a 247.3k\nr3 c a 20.77k\nr4 d c 0.02976\nr5 e c 0.76\nra1 b a 0.1729m\nra2 c b 45.68k\n"
        "ca3 a d 55n\n.op\n", [], {}),
    "small signals of which nothing flows": (
        "v1 a 0 AC 1 172\nr2 b a 49.49k\nr3 c b 2.279m\nr4 d c 16.86k\nr5 e 0 471\nr6 f c 2.207m\nca1 d c 29n\n"
        "ra2 f d 0.1716\nwa3 a e v1 w0\n.model w0 CSW(it=1m ron=1m roff=1meg)\n.ac dec 2 1 1g\n", [], {}),
    "small signals around an amplifier between its rails": (
        "v1 a 0 AC 1\nr1 a n 1k\nr2 n o 3k\nb1 o 0 V=10*sgn(-v(n))\nr3 o 0 1k\n.ac dec 2 1 1g\n", [], {}),
    "small signals beside a switch that has no rest": (
        "v1 a 0 AC 1\nr1 a b 1k\nix1 0 b 1m\nwa9 b 0 v1 w0\n.model w0 CSW(it=1u ron=1m roff=1meg)\n.ac dec 2 1 1g\n", [], {}),
    "H reads an impulse into an RC": (DRIVEN + "H1 d 0 E1 -1\n" + READ, [], {("v(f)", 1e-3): 1.0}),
    "F reads an impulse into R and an RC": (DRIVEN + "F1 0 d E1 -1\n" + READ, [], {("v(f)", 1e-3): 500.0}),
    "B reads an impulse into an RC": (DRIVEN + "B1 d 0 V=-i(E1)\n" + READ, [], {("v(f)", 1e-3): 1.0}),
    "E of H reads an impulse into an RC": (
        DRIVEN + "H1 d 0 E1 -1\nE2 h 0 d 0 3\nR3 h f 1k\nC3 f 0 1u\n.tran 0.1m 5m\n", [], {("v(f)", 1e-3): 3.0}),
    "G of H reads an impulse into a capacitor": (
        DRIVEN + "H1 d 0 E1 -1\nG2 0 f d 0 1m\nR3 f 0 1k\nC3 f 0 1u\n.tran 0.1m 5m\n", [], {("v(f)", 1e-3): 1.0}),
    "H reads an impulse into an RL": (
        DRIVEN + "H1 d 0 E1 -1\nR1 d 0 1k\nL3 d f 1\nR3 f 0 1k\n.tran 0.1m 5m\n", [], {("i(l3)", 1e-3): 1e-3}),
    "a hyperbolic tangent that is 1e5 times as steep as its argument": (
        FILTERED + "B1 o 0 V=tanh(1e5*v(b))+0.1*v(b)\n" + LOADED, [], {}),
    "a logarithm of an exponential of up to 5e8": (
        FILTERED.replace("0 1 1k", "0 20 1k") + "B1 o 0 V=ln(1+exp(v(b)))+0.1*v(b)\n" + LOADED, [], {}),
    "an exponential that falls from 7e10, of which 5 V are left": (
        "V1 a 0 EXP(25 0 0 1u 10u 0.2m)\nR1 a b 1k\nC1 b 0 1n ic=0\nB1 o 0 V=min(exp(v(b)),5)+0.1*v(b)\nR2 o p 1k\n"
        "C2 p 0 100n ic=0\n.tran 5u 1m uic\n", [], {}),
    "a triac that tells microamperes from tens of amperes": (
        TRIAC + ".model t1 triac(Vgt=1 Ioff=1u)\n.tran 0.1m 60m\n", ["--tol", "1e-10"], {}),
    "rounding of a resistor through ideal branches": (
        "v1 b bs 0\ns1 bs bt g 0 m0\ne1 bt bu 0 0 1\nr0 bu bv 0\nv2 g 0 1\nr2 b c 9\nv11 c 0 SIN(0 10 60)\n"
        "c1 bv bw 1n\n.model m0 SW(vt=0.5)\n.tran 1u 1m uic\n", [], {}),
    "an oscillator without resistance, above its threshold at the start": (
        "v1 in 0 10\nr1 in a 10k\nc1 a 0 100n ic=8\ns1 a 0 a 0 sw\n.model sw SW(vt=4 vh=2 ron=0)\n.tran 20u 5m uic\n",
        [], {}),
    "a source on a capacitor, from rest": (
        "v1 a 0 SIN(1 5 1k)\nc1 a 0 1u\nr1 a b 10\nc2 b 0 1u\nd1 b c\nc3 c 0 1u\nr3 c 0 1k\nl1 b d 1m\nr4 d 0 10\n"
        ".tran 20u 2m\n", [], {}),
    "a capacitor across an ideal transformer, from rest": (
        "v1 p 0 SIN(0 4 50)\nlp p 0 1\nls a b 1\nk1 lp ls 1\nc1 a b 300u\nr1 a b 100\n.tran 40m\n", [], {}),
    "capacitors across three windings, from rest": (
        "v1 p 0 PULSE(0 10 0 1m 1m 3m 10m)\nr1 p q 0\nlp q 0 1m\nls a b 4m\nlt c d 1\nk1 lp ls 1\nk2 lp lt 1\nk3 ls lt 1\n"
        "c1 a b 1u\nr2 a b 50\nc2 c d 10n\nr3 c d 1meg\nr4 d 0 1k\n.tran 20m\n", [], {}),
    "a bridge with a snubber behind an ideal transformer, from rest": (
        "v1 p 0 SIN(0 325 50)\nlp p 0 10\nls a b 0.1\nk1 lp ls 1\nc1 a b 100n\nd1 a o d\nd2 b o d\nd3 0 a d\nd4 0 b d\n"
        "c2 o 0 1m\nr1 o 0 100\n.model d D(ron=10m)\n.tran 40m\n", [], {}),
    "coils in both lines of a bridge that a megohm ties to ground, from rest": (
        LINE_COILS + ".model d D\n", [], {}),
    "the same, where diodes leak less than that": (
        LINE_COILS + ".model d D(ron=1m roff=1e9)\n", [], {}),
    "a coil before two knees, from rest": (
        "v1 a 0 PULSE(0 325 0 1e-05 1e-05 0.0004 0.001)\nr1 a b 0.1\nl1 b c 0.000159\nc1 c d 1.59e-05\nr2 d e 10\nr3 e f 100\n"
        "d1 0 f d\n.model d D(ron=10m vfwd=0.6 vrev=3 rrev=0.1)\n.tran 0.001\n", [], {}),
    "a current source in a coil, from rest": (
        "i1 0 a SIN(1 5 1k)\nl1 a b 1m\nr1 b 0 10\nd1 0 b\n.tran 20u 2m\n", [], {}),
    "an ideal peak detector, from rest": (
        "v1 a 0 SIN(0 5 1k)\nd1 a b\nc1 b 0 1u\nr1 b 0 10k\ns1 b c a 0 sw\nc2 c 0 1u\nr2 c 0 1k\n"
        ".model sw SW(vt=1 ron=0)\n.tran 20u 4m\n", [], {}),
    "initial voltages that cannot be": (
        "v1 a 0 5\nc1 a b 1u ic=1\nc2 b 0 2u ic=1\nc3 c 0 1u ic=9\nd1 c b\nl1 d 0 1m ic=1\nl2 d e 2m ic=0\nr1 e 0 1k\n"
        ".tran 20u 3m uic\n", [], {}),
    "a clamp with a gain of 1e3 that a capacitor jumps to": (
        "v1 in 0 SIN(0 5 1k)\nr1 in x 1k\ne1 o 0 value={limit(1e3*(2-v(x)),-12,12)}\nd1 x o d\nc1 x 0 10n ic=3\n"
        ".tran 1u 4m uic\n", [], {("v(x)", 0.0): 2000.0 / 1001.0}),
    "a clamp with a gain of 1e5 that it leaves at once": (
        "v1 in 0 SIN(0 5 1k)\nr1 in x 1k\ne1 o 0 value={1e5*(2-v(x))}\nd1 x o d\nc1 x 0 10n ic=3\n.tran 10u 20m uic\n",
        [], {("v(x)", 0.0): 2e5 / 100001.0}),
    "a window of two clamps": (
        "v1 in 0 5\nr1 in x 10k\ne1 o 0 value={limit(1e5*(2-v(x)),-12,12)}\ne2 p 0 value={limit(1e5*(1-v(x)),-12,12)}\n"
        "d1 x o d\nd2 p x d\nc1 x 0 1n ic=-7\n.tran 10u 20m uic\n", [], {("v(x)", 0.0): 1e5 / 100001.0}),
    "a clamp between two capacitors": (
        "c1 x 0 10n ic=3\nc2 x y 10n ic=-1\ne1 o 0 value={1e5*(1-v(y))}\nd1 y o d\nr2 x 0 2k\nr3 y 0 1k\n"
        ".tran 10u 20m uic\n", [], {("v(y)", 0.0): 1e5 / 100001.0}),
    "a clamp with a gain of 1e7 and nothing that moves": (
        "vr r 0 2.658704\ne1 o 0 r x 1e7\nd1 x o d\nc1 x 0 44.9n ic=5.411737\n.tran 10u 20m uic\n", [],
        {("v(x)", 0.0): 2.658704e7 / 10000001.0}),
    "a coil that jumps to a limit of current with a gain of 1e6": (
        "l1 a m 3.984322u ic=5.769\nr1 m s 1392.454695\nvs s 0 1.261885\nb1 0 a I=limit(1e6*(1.9-i(vs)),-20,20)\n"
        "d1 a 0 d\n.tran 10u 20m uic\n", [], {}),
    "perfectly coupled coils with initial currents": (
        "l1 a 0 1m ic=1\nl2 b 0 4m ic=0.5\nk1 l1 l2 1\nr1 a 0 10\nr2 b 0 10\n.tran 20u 3m uic\n", [], {}),
    "capacitors that a gate through E and B joins": (
        "vp p 0 PULSE(0 1 10u 0 0 40u 100u)\ne1 g 0 p 0 2\nv1 in 0 10\ns1 in x g 0 sw\nc1 x 0 1u\ns2 x y g2 0 sw\n"
        "c2 y 0 1u\nb1 g2 0 V=2-v(g)\nr1 y 0 1k\n.model sw SW(vt=1 vh=0.2 ron=0)\n.tran 1u 1m uic\n", [], {}),
    "the front of a wave, as small as numbers get": (
        "v1 a 0 SIN(0 1e-311 50)\nr1 a b 1k\nc1 b 0 1u\n.tran 10u 100m\n", [], {}),
    "the square of the front of a wave": (
        "v1 a 0 SIN(0 1e-158 50)\nr1 a b 1k\nc1 b 0 1u\n.tran 10u 100m\n", [], {}),
    "a coil that a resistance leaves less time than a run resolves": (
        "v1 v1 0 SIN(0 1 1k)\nb1 int 0 V=(u(v(v1)*8-1)+u(v(v1)*8-2))/8\nc1 c 0 10p\nr1 n c 100g\nl1 int n .01u\n"
        ".tran .25m\n", [], {}),
    "a coil that is cut off in 1e-14 s, again and again": (
        CUT.format(henry="1u", roff="100meg", period="10u") + ".tran 1m\n", [], {}),
    "a coil that is cut off in 1e-12 s, to 1e-8": (
        CUT.format(henry="1u", roff="1meg", period="10u") + ".tran 1m\n", ["--tol", "1e-8"], {}),
    "a coil that is cut off in 1e-13 s after milliseconds": (
        CUT.format(henry="10u", roff="100meg", period="1m") + ".tran 20m\n", ["--tol", "1e-10"], {}),
    "an ohm before a teraohm, with voltages that pass through 0": (
        "r1 o x 1k\nc1 x 0 2m ic=0\nr2 x 0 1k\nv1 p 0 PULSE(-1m 0.7m 0 8 6 0 18)\nv2 q 0 SFFM(0 1m 0.85 2 0.155)\n"
        "e1 s w p 0 1\ne2 w 0 q 0 -1\nr8 s u 1\nr9 u 0 1e12\nb1 o 0 V=limit(v(u),-0.3m,0.5m)\n.tran 0.5 20 uic\n",
        ["--method", "lobatto"], {}),
    "a spark gap on the voltage across it": (
        "v1 in 0 10\nr1 in a1 1k\nc1 a1 b1 1u\nr2 b1 0 1k\nr3 a1 a2 1k\nc2 a2 b2 1u\nr4 b1 b2 1k\ns1 a1 b2 a1 b1 sp\n"
        "s2 a2 o a2 b2 sp\nrl o 0 10k\n.model sp SW(vt=6 vh=3 ron=0.1)\n.tran 0.1m 60m uic\n", [], {}),
    "a ramp into a farad through a microhm, from rest": (
        "c1 s 0 0.3\nv1 a 0 PWL(0 0 20u 88.4)\ns1 s a g 0 sw\nv2 g 0 1\nr1 s 0 100\n"
        ".model sw SW(Ron=1u Roff=1G Vt=.5)\n.tran 1m\n", [], {}),
    "a ramp into 10 mF through a milliohm, from rest": (
        "v1 a 0 PWL(0 0 1u 400)\nr1 a s 1m\nc1 s 0 10m\nr2 s 0 10\n.tran 1u 100u\n", [], {}),
    "a ramp through a diode of a microhm, from 5 V": (
        "v1 a 0 PWL(0 5 10u 50)\nd1 a s dm\nc1 s 0 1\nr2 s 0 1\n.model dm D(Ron=1u)\n.tran 1u 100u\n", [], {}),
    "a ramp into two capacitors and a coil, from rest": (
        "v1 a 0 PWL(0 0 5u -20)\nr1 a s 10u\nc1 s 0 50m\nr2 s t 5u\nc2 t 0 0.1\nl1 t u 1u\nr3 u 0 1\n.tran 1u 50u\n",
        [], {}),
    "a step reads a node behind a short": (
        "v1 a 0 SIN(2.5 2.4 1k)\nr1 a h 0\nb1 i 0 v=u(v(h)-1)\nr2 i 0 1k\n.tran 1u 2m\n", [], {("v(i)", 0.2e-3): 1.0}),
    "steps read a node behind three shorts, the last one first": (
        "v1 a 0 SIN(2.5 2.4 1k)\nr3 c h 0\nr2 b c 0\nr1 a b 0\nb1 i 0 v=u(v(h)-1)+u(v(h)-3)\nr4 i 0 1k\n.tran 1u 2m\n",
        [], {("v(i)", 0.2e-3): 2.0}),
    "a limit reads a node behind a short of a capacitor's": (
        "v1 a 0 SIN(0 5 1k)\nr1 a b 1k\nc1 b 0 100n\nr2 h b 0\nb1 0 i i=limit(v(h),-1,1)\nr3 i 0 1k\n.tran 1u 2m\n",
        [], {}),
}

# A synchronous rectifier that its own voltage turns off: 10 mV is between 6 mV, closed, and 0.76 V, open.
SLIDES = """i1 0 b {amperes}
b1 sg 0 v={{v(b)-v(o) > {knot} ? {high} : 0}}
s1 b o sg 0 sw
d1 b o d
r1 o 0 1
c1 o 0 1u
.model sw SW(vt={threshold} ron=1m roff=1meg)
.model d D(ron=10m vfwd=0.7)
.tran 0.1u 5u uic
"""
SLIDING = [{"amperes": 6, "knot": 10e-3, "high": 1, "threshold": 0.5},
           {"amperes": 6, "knot": 0.3, "high": 5, "threshold": 1.5},
           {"amperes": 60, "knot": 0.1, "high": 12, "threshold": 2}]


def value_of(rows, signal, time):
    """On the right of an event at that time."""
    names, *lines = (line.split(",") for line in rows.splitlines())
    return [float(line[names.index(signal)]) for line in lines if abs(float(line[0]) - time) < 1e-12][-1]


def check_slide(checker, program, values):
    with tempfile.TemporaryDirectory() as directory:
        where = pathlib.Path(directory)
        (where / "c.cir").write_text(f"slide\n{SLIDES.format(**values)}.end\n")
        ran = subprocess.run([program, "run", str(where / "c.cir"), "-o", str(where / "c.csv")],
                             capture_output=True, text=True, check=False)
        is_found = ran.returncode == 1 and "the audit finds position of s1" in ran.stderr
        across = None if ran.returncode != 0 else max(
            abs(value_of((where / "c.csv").read_text(), "v(b)", t) - value_of((where / "c.csv").read_text(), "v(o)", t)
                - values["knot"]) for t in (1e-6, 3e-6, 5e-6))
        checker.check(is_found or (across is not None and across <= 1e-6),
                      f"slide at {values}: {ran.returncode}, off by {across} {ran.stderr}")


# name: (netlist, what v(o) is of v(b), where that has no jump)
CUT_OFF = {
    "a root beside an exponential of 2e17 V, of which 1 V is left": (
        FILTERED.replace("0 1 1k", "1 1.5 1k").replace("ic=0", "ic=1")
        + "B1 o 0 V=sqrt(abs(v(b)))+min(exp(40*v(b)),1)\n" + LOADED,
        lambda v: math.sqrt(abs(v)) + min(math.exp(40 * v), 1)),
    "an exponential of 2e17 V, of which 4 kV are left, and a choice": (
        FILTERED.replace("0 1 1k", "0 5 1k") + "B1 o 0 V=if(v(b)>1,min(exp(8*v(b)),4000),0.5)+0.3*v(b)\n" + LOADED,
        lambda v: None if abs(v - 1) < 1e-6 else (min(math.exp(8 * v), 4000) if v > 1 else 0.5) + 0.3 * v),
    "a ninth power of 2e15 V, of which 2 V are left": (
        "V1 a 0 SIN(0 50 50)\nR1 a b 1\nC1 b 0 1m ic=0\nB1 o 0 V=max(-2,min(2,v(b)**9))+0.01*v(b)\nR2 o p 10\n"
        "C2 p 0 1m ic=0\n.tran 100u 5m uic\n",
        lambda v: min(max(v**9, -2), 2) + 0.01 * v),
}


def check_cut_off(checker, program, name, netlist, law):
    with tempfile.TemporaryDirectory() as directory:
        where = pathlib.Path(directory)
        (where / "c.cir").write_text(f"{name}\n{netlist}.end\n")
        ran = subprocess.run([program, "run", str(where / "c.cir"), "-o", str(where / "c.csv")],
                             capture_output=True, text=True, check=False)
        if ran.returncode == 1 and "the audit finds" in ran.stderr:
            return
        names, *lines = (line.split(",") for line in (where / "c.csv").read_text().splitlines())
        found = [(float(line[names.index("v(b)")]), float(line[names.index("v(o)")])) for line in lines]
        wanted = [(v, o, law(v)) for v, o in found if law(v) is not None]
        worst, v = max((abs(o - w), v) for v, o, w in wanted)
        largest = max(abs(o) for _, o in found)
        checker.check(ran.returncode == 0 and worst <= 1e-6 * largest,
                      f"{name}: {ran.returncode}, off by {worst} where v(b) is {v} {ran.stderr}")


def main():
    program = sys.argv[1]
    checker = Checker("sound")
    for name, (netlist, options, values) in CIRCUITS.items():
        for how in ("sample", "full"):
            with tempfile.TemporaryDirectory() as directory:
                where = pathlib.Path(directory)
                (where / "c.cir").write_text(f"{name}\n{netlist}.end\n")
                ran = subprocess.run([program, "run", str(where / "c.cir"), "-o", str(where / "c.csv"), "--audit", how, *options],
                                     capture_output=True, text=True, check=False)
                proof = next((line for line in ran.stdout.splitlines() if line.startswith("  proof")), "")
                checker.check(ran.returncode == 0 and proof and "more than" not in proof,
                              f"{name}, {how}: {ran.returncode} {proof} {ran.stderr}")
                for (signal, time), value in values.items():
                    is_value = value_of((where / "c.csv").read_text(), signal, time) if ran.returncode == 0 else None
                    checker.check(is_value is not None and abs(is_value - value) < 1e-6 * abs(value),
                                  f"{name}: {signal} is {is_value}, not {value}")
    for values in SLIDING:
        check_slide(checker, program, values)
    for name, (netlist, law) in CUT_OFF.items():
        check_cut_off(checker, program, name, netlist, law)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
