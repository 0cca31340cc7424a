"""Converters by the names of their topologies. {S} is the source of the small signal; a netlist has no analysis."""

import collections

# amplitude: of a small sine on {S}, whose DC value is level; clock: s, 0 where no source repeats
Topology = collections.namedtuple("Topology", "name netlist level amplitude clock signal")

SW = ".model sm SW(Ron=10m Vt=0.5)\n"


def gate(node, period, begin, duty):
    """High from begin to begin + duty, in parts of the period."""
    if begin + duty <= 1:
        return f"Vg{node} g{node} 0 PULSE(0 1 {begin * period!r} 0 0 {duty * period!r} {period!r})\n"
    return f"Vg{node} g{node} 0 PULSE(1 0 {(begin + duty - 1) * period!r} 0 0 {(1 - duty) * period!r} {period!r})\n"


def two_coils():
    """SEPIC, Cuk and Zeta, at unlike powers and frequencies."""
    damp = "Rx b xd 5\nCx xd a 100u\n"
    yield Topology("sepic", "Vin in 0 {S}\n" + gate(1, 5e-6, 0, 0.45) + "L1 in a 33u\nS1 a 0 g1 0 sm\nCs a b 10u\n" + damp +
                   "L2 b 0 33u\nD1 b out\nC1 out 0 47u\nR1 out 0 8\n" + SW, 12.0, 1e-3, 5e-6, "v(out)")
    yield Topology("cuk", "Vin in 0 {S}\n" + gate(1, 20e-6, 0, 0.6) + "L1 in a 500u\nS1 a 0 g1 0 sm\nCs a b 4.7u\n"
                   "Rx b xd 20\nCx xd a 22u\nD1 b 0\nL2 b out 500u\nC1 out 0 22u\nR1 out 0 60\n" + SW,
                   48.0, 1e-2, 20e-6, "v(out)")
    yield Topology("zeta", "Vin in 0 {S}\n" + gate(1, 1e-6, 0, 0.3) + "S1 in a g1 0 sm\nL1 a 0 4.7u\nCs a b 1u\n"
                   "Rx b xd 2\nCx xd a 4.7u\nD1 0 b\nL2 b out 4.7u\nC1 out 0 10u\nR1 out 0 1.5\n" + SW,
                   5.0, 1e-3, 1e-6, "v(out)")


def transformers():
    yield Topology("forward, reset winding", "Vin in 0 {S}\n" + gate(1, 10e-6, 0, 0.4) + "L1 in sw 2m\nL2 s 0 0.5m\n"
                   "L3 0 r 2m\nK1 L1 L2 L3 1\nS1 sw 0 g1 0 sm\nD3 r in\nD1 s f\nD2 0 f\nLo f out 40u\nC1 out 0 100u\n"
                   "R1 out 0 2\n" + SW, 48.0, 1e-2, 10e-6, "v(out)")
    yield Topology("push-pull", "Vin in 0 {S}\n" + gate(1, 20e-6, 0, 0.35) + gate(2, 20e-6, 0.5, 0.35) +
                   "L1 in a 1m\nL2 b in 1m\nL3 s1 0 4m\nL4 0 s2 4m\nK1 L1 L2 L3 L4 0.998\nS1 a 0 g1 0 sm\nS2 b 0 g2 0 sm\n"
                   "Da 0 a\nDb 0 b\nRa a an 200\nCa an in 1n\nRb b bn 200\nCb bn in 1n\n"
                   "D1 s1 f\nD2 s2 f\nLo f out 200u\nC1 out 0 22u\nR1 out 0 20\n" + SW, 24.0, 1e-2, 20e-6, "v(out)")
    yield Topology("half-bridge, current doubler", "Vin in 0 {S}\n" + gate(1, 8e-6, 0, 0.4) + gate(2, 8e-6, 0.5, 0.4) +
                   "C8 in m 20u\nC9 m 0 20u\nR8 in m 20k\nR9 m 0 20k\nS1 in sw g1 0 sm\nS2 sw 0 g2 0 sm\nD8 sw in\nD9 0 sw\n"
                   "Lk sw p 5u\nLp p m 800u\nLs x y 50u\nK1 Lp Ls 0.999\nD1 0 x\nD2 0 y\nLa x xa 10u\nRa xa out 5m\n"
                   "Lb y yb 10u\nRb yb out 5m\n"
                   "C1 out 0 100u\nR1 out 0 0.5\nRx x 0 1k\n" + SW, 380.0, 1e-1, 8e-6, "v(out)")
    yield Topology("phase-shifted full bridge", "Vin in 0 {S}\n" + gate(1, 10e-6, 0, 0.5) + gate(2, 10e-6, 0.5, 0.5) +
                   gate(3, 10e-6, 0.32, 0.5) + gate(4, 10e-6, 0.82, 0.5) +
                   "S1 in a g1 0 sm\nS2 a 0 g2 0 sm\nS3 in b g3 0 sm\nS4 b 0 g4 0 sm\nLr a p 12u\nLp p b 1m\n"
                   "L2 s 0 40u\nL3 0 t 40u\nK1 Lp L2 L3 0.9995\nD1 s f\nD2 t f\nRs f fs 200\nCs fs 0 1n\n"
                   "Lo f out 20u\nC1 out 0 47u\nR1 out 0 1.2\n" + SW, 400.0, 1e-1, 10e-6, "v(out)")
    yield Topology("boost, coupled coils", "Vin in 0 {S}\n" + gate(1, 12e-6, 0, 0.55) + "L1 in sw 60u\nL2 sw x 240u\n"
                   "K1 L1 L2 0.985\nS1 sw 0 g1 0 sm\nD1 x out\nDc sw c\nCc c in 1u\nRc c in 400\nC1 out 0 10u\nR1 out 0 150\n" +
                   SW, 20.0, 1e-3, 12e-6, "v(out)")


def discontinuous():
    """Coils whose currents come to 0 in each period."""
    yield Topology("flyback, discontinuous", "Vin in 0 {S}\n" + gate(1, 10e-6, 0, 0.3) + "L1 in sw 40u\nL2 0 s 10u\nK1 L1 L2 0.98\n"
                   "S1 sw 0 g1 0 sm\nDc sw c\nCc c in 10n\nRc c in 4.7k\nD1 s out\nC1 out 0 100u\nR1 out 0 30\n" + SW,
                   100.0, 1e-2, 10e-6, "v(out)")
    yield Topology("sepic, discontinuous", "Vin in 0 {S}\n" + gate(1, 4e-6, 0, 0.3) + "L1 in a 20u\nS1 a 0 g1 0 sm\nCs a b 10u\n"
                   "Rx b xd 5\nCx xd a 47u\nL2 b 0 6u\nD1 b out\nC1 out 0 22u\nR1 out 0 60\n" + SW, 12.0, 5e-2, 4e-6, "v(out)")
    yield Topology("cuk, discontinuous", "Vin in 0 {S}\n" + gate(1, 8e-6, 0, 0.25) + "L1 in a 60u\nS1 a 0 g1 0 sm\nCs a b 4.7u\n"
                   "Rx b xd 10\nCx xd a 22u\nD1 b 0\nL2 b out 30u\nC1 out 0 22u\nR1 out 0 150\n" + SW, 24.0, 1e-1, 8e-6, "v(out)")
    t = 1 / 60
    lines = "".join(f"V{k} n{k} 0 SIN(0 170 60 0 0 {-120 * k})\nR{k} n{k} m{k} 0.1\nL{k} m{k} x{k} 0.5m\nD{k} x{k} p\nD{k + 3} q x{k}\n"
                    for k in range(3))
    yield Topology("three phases into a capacitor", lines + "Vin p r {S}\nC1 r q 1m\nRl r q 80\nRg q 0 100k\n", 0.0, 1e-1, t, "v(r,q)")
    yield Topology("three phases, a capacitor behind a coil", lines + "Vin p r {S}\nLd r s 2m\nC1 s q 220u\nRl s q 25\nRg q 0 100k\n",
                   0.0, 1e-1, t, "v(s,q)")


def bridge_of_two(one, other, node):
    return f"S1{node} in {node} g{one} 0 sm\nS2{node} {node} 0 g{other} 0 sm\n"


def dual_active():
    for shift in (0.04, 0.11, -0.2):
        t = 16e-6
        begin = shift % 1
        text = "Vin in 0 {S}\n" + gate(1, t, 0, 0.5) + gate(2, t, 0.5, 0.5)
        text += f"Vp3 g3 0 PULSE(0 1 {begin * t!r} 0 0 {t / 2!r} {t!r})\nE4 g4 0 one g3 1\nVone one 0 1\n" if begin < 0.5 \
            else f"Vp3 g3 0 PULSE(1 0 {(begin - 0.5) * t!r} 0 0 {t / 2!r} {t!r})\nE4 g4 0 one g3 1\nVone one 0 1\n"
        text += "S1 in a g1 0 sm\nS2 a 0 g2 0 sm\nS3 in b g2 0 sm\nS4 b 0 g1 0 sm\nLr a p 40u\nRp p p1 20m\nLp p1 b 2m\n"
        text += "Ls s t 0.5m\nK1 Lp Ls 0.9998\nS5 out s g3 0 sm\nS6 s o2 g4 0 sm\nS7 out t g4 0 sm\nS8 t o2 g3 0 sm\n"
        load = "R1 out o2 20\n" if shift > 0 else "R1 out bat 1\nVb bat o2 200\n"
        yield Topology(f"dual active bridge, {shift}", text + "Co out o2 40u\n" + load + "Rg o2 0 1meg\n" + SW, 400.0, 1e-1, t,
                       "i(vin)")


def resonant():
    for factor in (0.75, 1.0, 1.3):
        t = 1e-5 / factor
        yield Topology(f"LLC at {factor} of its resonance", "Vin d 0 {S}\n" + gate(1, t, 0, 0.5) + gate(2, t, 0.5, 0.5) +
                       "S1 d sw g1 0 sm\nS2 sw 0 g2 0 sm\nLr sw r 25.33u\nCr r p 100n\nLm p 0 120u\nLs1 s1 0 3u\nLs2 0 s2 3u\n"
                       "K1 Lm Ls1 Ls2 0.999\nD1 s1 out\nD2 s2 out\nCo out 0 200u\nRo out 0 1\n" + SW, 100.0, 1e-2, t, "v(out)")
    yield Topology("class E", "Vin d 0 {S}\n" + gate(1, 1e-6, 0, 0.5) + "Lc d sw 100u\nS1 sw 0 g1 0 sm\nD1 0 sw\nCp sw 0 2.2n\n"
                   "Lr sw r 15u\nCr r o 2.2n\nR1 o 0 10\n" + SW, 12.0, 1e-3, 1e-6, "v(o)")
    yield Topology("quasi-resonant, zero voltage", "Vin in 0 {S}\n" + gate(1, 2e-6, 0, 0.55) + "S1 in x g1 0 sm\nDs x in\n"
                   "Cr in x 4.7n\nLr x sw 1.5u\nD1 0 sw\nLo sw out 100u\nC1 out 0 20u\nR1 out 0 3\n" + SW,
                   12.0, 1e-3, 2e-6, "v(out)")
    yield Topology("quasi-resonant, zero current", "Vin in 0 {S}\n" + gate(1, 4e-6, 0, 0.3) + "S1 in x g1 0 sm\nDf x y\n"
                   "Lr y sw 1u\nCr sw 0 100n\nD1 0 sw\nLo sw out 100u\nC1 out 0 20u\nR1 out 0 6\n" + SW,
                   24.0, 1e-3, 4e-6, "v(out)")


def phases():
    t = 9e-6
    text = "".join(gate(k, t, k / 3, 0.4) + f"L{k} in w{k} {40 + 5 * k}u\nR{k} w{k} x{k} 20m\nS{k} x{k} 0 g{k} 0 sm\n"
                   f"D{k} x{k} out\n" for k in range(3))
    yield Topology("interleaved boost", "Vin in 0 {S}\n" + text + "C1 out 0 22u\nR9 out 0 12\n" + SW, 24.0, 1e-3, t, "v(out)")
    t = 10e-6
    yield Topology("three-level buck", "Vin in 0 {S}\n" + gate(1, t, 0, 0.35) + gate(2, t, 0.5, 0.35) + gate(3, t, 0.35, 0.65) +
                   gate(4, t, 0.85, 0.65) + "S1 in a g1 0 sm\nS2 a sw g2 0 sm\nS3 b 0 g3 0 sm\nS4 sw b g4 0 sm\nCf a b 10u\n"
                   "L1 sw out 20u\nC1 out 0 22u\nR1 out 0 1\n.model sm SW(Ron=20m Vt=0.5)\n", 24.0, 1e-3, t, "v(out)")


def ladders():
    t = 10e-6
    text = "Vin in 0 {S}\n" + gate(1, t, 0, 0.5) + gate(2, t, 0.5, 0.5) + "Ea ck1 0 g1 0 5\nEb ck2 0 g2 0 5\nD0 in n0\n"
    text += "".join(f"R{k} ck{1 + k % 2} c{k} 30\nC{k} c{k} n{k} 100n\nD{k + 1} n{k} n{k + 1}\n" for k in range(4))
    yield Topology("Dickson charge pump", text + "Co n4 0 1u\nRo n4 0 5k\n", 5.0, 1e-3, t, "v(n4)")
    yield Topology("voltage doubler", "Vl a 0 SIN(0 170 60)\nVin b a {S}\nRl b x 0.5\nD1 x p\nD2 n x\nC1 p 0 470u\n"
                                      "C2 0 n 470u\n"
                   "R1 p n 300\nR2 p 0 10k\nR3 n 0 10k\n", 0.0, 1e-2, 1 / 60, "v(p)")


def controlled():
    peak = ("Vin in 0 {0}\nVclk clk 0 PULSE(0 1 0 0 0 100n 10u)\nVr ramp 0 PULSE(0 {1} 0 10u 0 0 10u)\nVc c 0 {{S}}\n"
            "B1 lim 0 V=v(c)-v(ramp)-0.5*i(L1)\nA1 lim 0 0 0 0 over 0 0 BUF Ref=0\nA2 clk over 0 0 0 0 q 0 SRFLOP Td=50n\n"
            "S1 in sw q 0 sm\nD1 0 sw\nL1 sw out 20u\nC1 out esr 47u\nRe esr 0 10m\nR1 out 0 4\n" + SW)
    yield Topology("peak current at 0.7, with slope", peak.format(12.0, 1.5), 2.8, 1e-4, 10e-6, "v(out)")
    yield Topology("valley current", "Vin in 0 24\nVclk clk 0 PULSE(0 1 0 0 0 100n 5u)\nVc c 0 {S}\n"
                                     "Vr ramp 0 PULSE(0 0.6 0 5u 0 0 5u)\n"
                   "B1 low 0 V=i(L1)-v(ramp)-v(c)\nA1 low 0 0 0 0 u 0 0 SCHMITT Vt=0 Vh=0\n"
                   "A2 u clk 0 0 0 0 q 0 SRFLOP Td=30n\nS1 in sw q 0 sm\nD1 0 sw\nL1 sw out 47u\nC1 out 0 22u\n"
                   "R1 out 0 3\n" + SW,
                   1.5, 1e-4, 5e-6, "v(out)")
    yield Topology("sampled PI", "Vin in 0 48\nVck ck 0 PULSE(0 1 1u 0 0 1u 20u)\n"
                                 "Vtri tri 0 PULSE(0 1 0 9.999u 10u 1n 20u)\nVref ref 0 {S}\n"
                   "B1 e 0 V=v(ref)-v(out)\nB2 in1 0 V=v(i)+0.0005*v(e)\nA1 in1 0 ck 0 0 0 i 0 SAMPLEHOLD IC=0.25\n"
                   "B3 u 0 V=v(i)+0.002*v(e)\nA2 u 0 ck 0 0 0 d 0 SAMPLEHOLD IC=0.25\nE1 cmp 0 d tri 1\n"
                   "S1 in sw cmp 0 s0\nD1 0 sw\n"
                   "L1 sw out 100u\nC1 out 0 100u\nR1 out 0 5\n.model s0 SW(Ron=10m Vt=0)\n", 12.0, 2e-2, 20e-6, "v(out)")


def at_the_mains():
    for angle in (30, 70, 110):
        t = 0.02
        delay = angle / 360 * t
        text = "Vl a b SIN(0 325 50)\nRb b 0 1meg\n"
        for n, (low, high) in enumerate((("x", "p"), ("n", "x"), ("b", "p"), ("n", "b"))):
            half = delay + (t / 2 if n in (1, 2) else 0)
            text += f"Vg{n} g{n} 0 PULSE(0 1 {half!r} 0 0 1m {t!r})\nA{n} {low} {high} g{n} 0 scr\n"
        text += "Ll a x 1m\nLd p d 30m\nRd d e 10\nVin e n {S}\n.model scr thyristor(Ron=1m Voff=1m)\n"
        yield Topology(f"thyristor bridge at {angle} degrees", text, 20.0, 1e-2, t, "i(ld)")
    lines, t = "", 1 / 50
    for side, shift in (("a", 15), ("b", -15)):
        for k in range(3):
            lines += (f"V{side}{k} n{side}{k} {side}0 SIN(0 325 50 0 0 {-120 * k + shift})\n"
                      f"L{side}{k} n{side}{k} m{side}{k} 1m\n"
                      f"D{side}{k} m{side}{k} {side}p\nD{side}{k + 3} {side}n m{side}{k}\n")
    yield Topology("twelve-pulse rectifier", lines + "Vj an bp 0\nRa a0 0 1meg\nRb b0 0 1meg\nVin ap q {S}\nLd q out 10m\n"
                   "C1 out bn 470u\nR1 out bn 50\n", 0.0, 1e-1, t, "v(out,bn)")
    yield Topology("cycloconverter", "Vl s 0 SIN(0 100 150)\nVg p 0 PULSE(1 0 10m 0 0 10m 20m)\nEn n 0 one p 1\n"
                                     "Vone one 0 1\nRs s l 0.1\nLs l x 0.2m\n"
                   "E1 y 0 x 0 -1\nDp1 x pp\nDp2 y pp\nDn1 nn x\nDn2 nn y\nS1 pp o p 0 sm\nS2 o nn n 0 sm\nVin o o1 {S}\n"
                   "L1 o1 o2 5m\nR1 o2 0 10\nDf1 0 o f1\nDf2 o 0 f1\n.model f1 D(Vfwd=150)\n" + SW, 0.0, 1e-2, 0.02, "i(l1)")


def floating():
    """What a transformer or a common coil keeps apart from ground."""
    t = 10e-6
    yield Topology("tapped buck", "Vin in 0 {S}\n" + gate(1, t, 0, 0.3) + "S1 in a g1 0 sm\nL1 a c 90u\nL2 c out 10u\n"
                   "K1 L1 L2 0.99\nD1 0 c\nRs a s 300\nCs s 0 470p\nC1 out 0 100u\nR1 out 0 0.5\n" + SW,
                   48.0, 1e-2, t, "v(out)")
    yield Topology("isolated sepic", "Vin in 0 {S}\n" + gate(1, t, 0, 0.4) + "L1 in a 100u\nS1 a 0 g1 0 sm\nCs a b 10u\n"
                   "Rx b xd 10\nCx xd a 47u\nL2 b 0 100u\nL3 s q 25u\nK1 L2 L3 1\nD1 s out\nC1 out q 47u\nR1 out q 5\n"
                   "Rg q 0 1k\n" + SW, 24.0, 1e-2, t, "v(out,q)")
    yield Topology("half-controlled bridge", "Vl a b SIN(0 325 50)\nRb b 0 100k\nVg1 g1 0 PULSE(0 1 3m 0 0 2m 20m)\n"
                   "Vg2 g2 0 PULSE(0 1 13m 0 0 2m 20m)\nA1 a p g1 0 scr\nA2 b p g2 0 scr\nD1 n a\nD2 n b\nLd p d 20m\n"
                   "Rd d e 8\nVin e n {S}\n.model scr thyristor(Ron=1m Voff=1m)\n", 30.0, 1e-1, 0.02, "i(ld)")


def inverters():
    t, f = 0.0025, 400.0
    text = "Vin dc 0 {S}\n" + f"Vtri tri 0 PULSE(-1 1 0 {t / 18 - 1e-9!r} {t / 18!r} 1n {t / 9!r})\n"
    text += "".join(f"Vr{k} r{k} 0 SIN(0 0.9 {f!r} 0 0 {-120 * k})\n" for k in range(3))
    text += "Bz z 0 V=-0.5*(max(v(r0),max(v(r1),v(r2)))+min(v(r0),min(v(r1),v(r2))))\n"
    for k in range(3):
        text += (f"Bc{k} c{k} 0 V=v(r{k})+v(z)-v(tri)\nBd{k} d{k} 0 V=-v(c{k})\nS{k} dc u{k} c{k} 0 s0\n"
                 f"S{k + 3} u{k} 0 d{k} 0 s0\n"
                 f"L{k} u{k} f{k} 0.5m\nC{k} f{k} fd{k} 4.7u\nR{k} fd{k} star 2\nLg{k} f{k} o{k} 0.2m\nRo{k} o{k} n {10 + k}\n")
    yield Topology("space vector inverter with LCL filters", text + "Rn n 0 1meg\nRst star 0 1meg\n"
                   ".model s0 SW(Ron=10m Vt=0)\n",
                   600.0, 1.0, t, "i(vin)")
    t = 1e-3
    text = ("Vl a b SIN(0 100 1k)\nLl a x 1m\nRl x y 0.2\nVt tri 0 PULSE(0 1 0 12.499u 12.5u 1n 25u)\nVd ref 0 {S}\n"
            "Vs s 0 SIN(0 1 1k)\n"
            "Bm m 0 V=v(ref)*abs(v(s))-v(tri)\nS5 y p pos 0 sp\nS6 y 0 neg 0 sp\nBp pos 0 V=v(m)*v(s)\nBq neg 0 V=-v(m)*v(s)\n"
            "D1 y p\nD2 0 y\nD3 b p\nD4 0 b\nC1 p 0 200u\nR1 p 0 60\n.model sp SW(Ron=10m Vt=0)\n")
    yield Topology("totem pole", text, 0.55, 1e-4, t, "v(p)")


def free():
    yield Topology("hysteretic buck", "Vin in 0 {S}\nVref ref 0 3.3\nS1 in sw ref fb mos\nD1 0 sw\nL1 sw out 4.7u\n"
                                      "C1 out esr 47u\n"
                   "Re esr 0 50m\nR1 out 0 2\nRf out fb 1k\nCf fb 0 470p\n.model mos SW(Ron=10m Vt=0 Vh=15m)\n",
                   12.0, 1e-3, 0, "v(out)")
    yield Topology("constant on-time", "Vin in 0 {S}\nVref ref 0 1.2\nB1 low 0 V=v(ref)-v(out)\n"
                                       "A1 low 0 0 0 0 0 ask 0 SCHMITT Vt=0 Vh=0\n"
                   "Von on 0 0.5\nA2 ask on 0 q one\n.model one oneshot(cntl_array=[0 1] pw_array=[0.2u 0.4u] retrig=false "
                   "rise_time=0.1n fall_time=0.1n rise_delay=10n fall_delay=10n out_low=0 out_high=1)\n"
                   "S1 in sw q 0 sm\nD1 0 sw\nL1 sw out 1u IC=4\n"
                   "C1 out esr 100u IC=1.25\nRe esr 0 20m\nR1 out 0 0.3\n" + SW, 12.0, 1e-3, 0, "v(out)")
    yield Topology("flyback at the border", "Vin in 0 {S}\nVc c 0 2\nB1 hi 0 V=i(L1)-v(c)\n"
                                            "A1 hi 0 0 0 0 0 over 0 SCHMITT Vt=0 Vh=0\n"
                   "B2 no 0 V=-v(s)\nA3 no 0 0 0 0 0 gone 0 SCHMITT Vt=0 Vh=0.2\nA2 gone over 0 0 0 0 q 0 SRFLOP Td=50n IC=1\n"
                   "L1 in sw 100u\nL2 0 s 25u\nK1 L1 L2 1\nS1 sw 0 q 0 sm\nCd sw 0 100p\nD1 s out\nC1 out 0 100u IC=8\n"
                   "R1 out 0 10\n" + SW,
                   40.0, 1e-3, 0, "v(out)")


def square(node, low, high, period, duty=0.5, begin=0.0, edge=0.0):
    """Low at the beginning unless begin is 0."""
    return f"V{node} {node} 0 PULSE({low!r} {high!r} {begin * period!r} {edge!r} {edge!r} {duty * period!r} {period!r})\n"


def doubler(name, load, level=5.0, period=10e-6, store=100e-9, out="10u", edge=0.0):
    return Topology(name, "Vin in 0 {S}\n" + square("ck", 0.0, level, period, 0.5, 0.0, edge) + f"D1 in a\nC1 ck a {store!r}\n"
                    f"D2 a out\nC2 out 0 {out}\nRa a out {200 * period / store!r}\n{load}\n",
                    level, 1e-4 * level, period, "v(out)")


def pumps():
    """Capacitors that share charge in an instant, through diodes that are open right behind it.

    Small resistances of leakage open them: at no voltage and no current they would conduct half of a small signal.
    """
    yield doubler("doubler", "R1 out 0 10k")
    yield doubler("doubler, load of a current", "I1 out 0 1m")
    yield doubler("doubler, kilovolts", "R1 out 0 10meg", 2000.0, 1e-3, 10e-9, "33n")
    yield doubler("doubler, picofarads", "I1 out 0 20n", 1.2, 50e-9, 1e-12, "3p")
    yield doubler("doubler, edges of 10 ns", "R1 out 0 2k", edge=10e-9)
    yield doubler("doubler, a filter behind it", "R1 out f 10\nL1 f g 1m\nC3 g 0 4.7u\nR2 g 0 1k", out="1u")
    yield Topology("Greinacher on a square wave", "Vs s 0 {S}\nV1 in s PULSE(-5 5 0 0 0 5u 10u)\nC1 in a 100n\nD1 0 a\nD2 a out\n"
                   "C2 out 0 1u\nR1 out 0 1k\nRa a out 20k\n", 0.0, 1e-3, 10e-6, "v(out)")
    yield Topology("Cockcroft-Walton on a square wave", "Vs s 0 {S}\nV1 in s PULSE(-100 100 0 0 0 0.4m 1m)\nC1 in a 1u\nC2 a b 470n\n"
                   "D1 0 a\nD2 a m\nD3 m b\nD4 b out\nC3 m 0 1u\nC4 out m 330n\nR1 out 0 100k\nRa a m 200k\nRb b out 400k\n", 0.0, 1e-2, 1e-3, "v(out)")
    yield Topology("Dickson, three stages", "Vin in 0 {S}\n" + square("k", 0.0, 3.3, 1e-6) + square("q", 0.0, 3.3, 1e-6, 0.45, 0.52) +
                   "D0 in n0\nC0 k n0 10p\nD1 n0 n1\nC1 q n1 10p\nD2 n1 n2\nC2 k n2 10p\nD3 n2 out\nCo out 0 50p\nI1 out 0 1u\n"
                   "R0 n0 n1 5meg\nR1 n1 n2 5meg\nR2 n2 out 5meg\n", 3.3, 1e-4, 1e-6, "v(out)")
    yield Topology("inverting pump", "Vin in 0 {S}\nB1 ck 0 V=v(in)*v(g)\nVg g 0 PULSE(0 1 0 0 0 0.4u 1u)\nC1 ck a 1u\n"
                   "D1 a 0\nD2 b a\nC2 b 0 4.7u\nR1 b 0 150\nRa a b 200\n", 12.0, 1e-3, 1e-6, "v(b)")
    yield Topology("halver of switches", "Vin in 0 {S}\n" + gate(1, 2e-6, 0, 0.45) + gate(2, 2e-6, 0.5, 0.45) +
                   "S1 in a g1 0 s0\nS2 b out g1 0 s0\nS3 a out g2 0 s0\nS4 b 0 g2 0 s0\nC1 a b 2.2u\nC2 out 0 10u\nR1 out 0 5\n"
                   ".model s0 SW(Ron=0 Vt=0.5)\n", 24.0, 1e-2, 2e-6, "v(out)")
    yield Topology("charged side by side, emptied in a row", "Vin in 0 {S}\n" + gate(1, 100e-6, 0.1, 0.3) +
                   "D1 in a\nD2 in b\nS1 0 am gn 0 s0\nS2 0 bm gn 0 s0\nC1 a am 1u\nC2 b bm 680n\nS3 a bm g1 0 s0\nS4 in am g1 0 s0\n"
                   "D3 b out\nC3 out 0 3.3u\nR1 out 0 2k\nRa a out 20k\nRb b out 30k\nEn gn 0 hi g1 1\nVh hi 0 1\n.model s0 SW(Ron=0 Vt=0.5)\n",
                   10.0, 1e-3, 100e-6, "v(out)")
    yield Topology("bootstrap of a buck", "Vin in 0 {S}\n" + gate(1, 10e-6, 0, 0.4) + "S1 in sw g1 0 sm\nD1 0 sw\nL1 sw out 47u\n"
                   "C1 out 0 22u\nR1 out 0 4\nVcc vcc 0 10\nDb vcc bt\nCb bt sw 220n\nRb bt sw 10k\n" + SW,
                   24.0, 1e-3, 10e-6, "v(bt)")
    yield Topology("a comparator strikes the pump", "Vin in 0 {S}\nVr r 0 PULSE(0 1 0 20u 0 0 20u)\n"
                   "S1 in ck r c s0\nS2 0 ck c r s0\nE1 c 0 f 0 60m\nRf out f 10k\nCf f 0 10n\nC1 ck a 100n\nD1 in a\nD2 a out\nC2 out 0 1u\nR1 out 0 3k\nRa a out 40k\n"
                   ".model s0 SW(Ron=0 Vt=0)\n", 6.0, 1e-3, 20e-6, "v(out)")


GROUPS = {"two_coils": two_coils, "transformers": transformers,
          "discontinuous": discontinuous, "dual_active": dual_active, "resonant": resonant,
          "phases": phases, "ladders": ladders, "controlled": controlled, "at_the_mains": at_the_mains,
          "floating": floating, "inverters": inverters, "free": free, "pumps": pumps}
