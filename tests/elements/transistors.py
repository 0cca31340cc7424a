#!/usr/bin/env python3
"""MOSFETs, IGBTs and bipolar transistors as switches, against closed forms: what a card means, circuits, refusals.

usage: transistors.py PROGRAM
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# kT/q at 27 degrees, and the line that touches an exponential body diode of 1e-14 A at 1 A
KT_Q = 300.15 * 1.380649e-23 / 1.602176634e-19
BODY_OHM = KT_Q / (1 + 1e-14)
BODY_VOLT = KT_Q * math.log1p(1e14) - BODY_OHM


def run_at(program, text, quiet=True):
    return run(program, text, method=None, tolerance=1e-10, quiet=quiet)


def value_of(done, name):
    return {m["name"]: m["value"] for m in done.report["measurements"]}[name]


def pulse(low, high, delay, width, period):
    return f"pulse({low!r} {high!r} {delay!r} 0 0 {width!r} {period!r})"


# A model card, its element's parameters, the gate's high level, its resistance by hand.
CARDS = (
    (".model x NMOS(Vto=3 Kp=2)", "", 10, 1 / (2 * 7)),
    (".model x NMOS(Vto=1 Kp=20u W=1m L=2u Rd=0.1 Rs=0.2)", "", 5, 1 / (20e-6 * 500 * 4) + 0.3),
    (".model x NMOS Vto=1 Kp=20u", "W=1m L=2u", 5, 1 / (20e-6 * 500 * 4)),
    (".model x NMOS (LEVEL=3 VTO=3.1 KP=20.71u W=0.94 L=2u RD=22m RS=20m RDS=444K TOX=100n CGDO=1n)", "", 10,
     1 / (20.71e-6 * 0.94 / 2e-6 * 6.9) + 0.042),
    (".model x NMOS(Level=1 Vto=2 Tox=50n Uo=650 W=10m L=1u)", "", 12,
     1 / (650e-4 * 3.9 * 8.8541878128e-12 / 50e-9 * 1e4 * 10)),
    (".model x VDMOS(Rg=3 Vto=4 Rd=30m Rs=10m Rb=20m Kp=25 lambda=.03 Cgdmax=1n mfg=IR Vds=100 Ron=77m Qg=72n)", "", 12,
     1 / (25 * 8) + 0.04),
    (".model x VDMOS nchan (Vto=2 Kp=10 mtriode=0.5)", "", 8, 1 / (10 * 0.5 * 6)),
    (".model x VDMOS(Vto=2 Ron=33m)", "", 8, 0.033),
    (".model x NMOS(Vto=2 Ron=33m Kp=5)", "", 8, 0.033),
    (".model x VDMOS(Vto=2 Kp=10 Vgon=6)", "", 8, 1 / (10 * 4)),
    (".model x NMOS(Vto=3 Kp=2)", "M=4", 10, 1 / (2 * 7) / 4),
    ("* irf540n of the table", "", 10, 0.044),
)


def cards(checker, program):
    """The resistance of a closed switch from a divider, at several scales of voltage."""
    for card, parameters, high, ohms in CARDS:
        for volts in some_of((0.05, 12, 800)):
            name = "irf540n" if card[0] == "*" else "x"
            text = f"a card\nv1 in 0 {volts}\nr1 in d 10\nvg g 0 {pulse(0, high, 1e-6, 5e-6, 1e-5)}\n" \
                   f"m1 d g 0 0 {name} {parameters}\n{card}\n.tran 0.1u 20u\n.meas tran v find v(d) at=3u\n" \
                   ".meas tran i find i(m1) at=3u\n.end\n"
            done = run_at(program, text, quiet=False)
            if checker.check(done.status == 0, f"{card}: {done.stderr}"):
                on = volts * ohms / (10 + ohms)
                checker.close(value_of(done, "v"), on, 1e-8 * volts, f"{card} at {volts} V")
                checker.close(value_of(done, "i"), on / ohms, 1e-8 * volts, f"{card} at {volts} V: i")
                checker.check("is a switch, on above v(gs)" in done.stderr, done.stderr)
                checker.check(done.stderr.count("is a switch") == 1, done.stderr)


def low_side(volts, r, ron):
    on = volts / (r + ron)
    return [f"v1 in 0 {volts}", f"r1 in d {r}", "m1 d g 0 n", f"vg g 0 {pulse(0, 10, 2e-6, 4e-6, 1e-5)}"], \
        "avg i(m1)", 0.4 * on


def high_side_nmos(volts, r, ron):
    """The gate against the source, as a bootstrapped driver has it."""
    return [f"v1 in 0 {volts}", f"r1 s 0 {r}", "m1 in g s n", f"vg g s {pulse(0, 10, 2e-6, 4e-6, 1e-5)}"], \
        "avg v(s)", 0.4 * volts * r / (r + ron)


def high_side_pmos(volts, r, ron):
    low = volts - 10
    return [f"v1 in 0 {volts}", f"r1 d 0 {r}", "m1 d g in in p", f"vg g 0 {pulse(volts, low, 2e-6, 4e-6, 1e-5)}"], \
        "avg v(d)", 0.4 * volts * r / (r + ron)


def body_diode(volts, r, ron):
    """Backwards, with the gate off: the line of the body diode."""
    i = max(0.0, (volts - BODY_VOLT) / (r + BODY_OHM))
    return [f"v1 in 0 {-volts}", f"r1 in d {r}", "m1 d g 0 0 n", "vg g 0 0"], "avg i(m1)", -i


def synchronous(volts, r, ron):
    """Backwards with the gate on: channel and body diode share the current."""
    i = volts / (r + ron)
    if i * ron > BODY_VOLT:  # a knee: node voltage by the two branches in parallel
        g = 1 / ron + 1 / BODY_OHM
        v = (volts / r + BODY_VOLT / BODY_OHM) / (1 / r + g)
        i = (volts - v) / r
    return [f"v1 in 0 {-volts}", f"r1 in d {r}", "m1 d g 0 0 n", "vg g 0 10"], "avg i(m1)", -i


def series_string(volts, r, ron):
    return [f"v1 in 0 {volts}", f"r1 in d {r}", "m1 d g1 m n", "m2 m g2 0 n", f"vg1 g1 m {pulse(0, 10, 2e-6, 4e-6, 1e-5)}",
            f"vg2 g2 0 {pulse(0, 10, 3e-6, 4e-6, 1e-5)}", f"r2 d m {1e6 * r}", f"r3 m 0 {1e6 * r}"], \
        "find i(r1) at=4.5u", volts / (r + 2 * ron / (1 + ron / (1e6 * r)))


def parallel(volts, r, ron):
    return [f"v1 in 0 {volts}", f"r1 in d {r}", "m1 d g 0 n", "m2 d g 0 n m=2",
            f"vg g 0 {pulse(0, 10, 2e-6, 4e-6, 1e-5)}"], "find i(m2) at=4u", volts / (r + ron / 3) * 2 / 3


def h_bridge(volts, r, ron):
    """The diagonals in turn, without a dead time: a square wave."""
    first, second = pulse(0, 10, 0.0, 5e-6, 1e-5), pulse(10, 0, 0.0, 5e-6, 1e-5)
    return [f"v1 in 0 {volts}", "m1 in g1 a n", "m2 a g2 0 n", "m3 in g3 b n", "m4 b g4 0 n", f"r1 a b {r}",
            f"vg1 g1 a {first}", f"vg4 g4 0 {first}", f"vg3 g3 b {second}", f"vg2 g2 0 {second}"], \
        "avg abs(i(r1))", volts / (r + 2 * ron)


def freewheeling(volts, r, ron):
    """A coil between the supply and the drain; an ideal diode takes its current: L/R is long, the mean 0.4 v/r."""
    return [f"v1 in 0 {volts}", f"r1 in x {r}", f"l1 x d {r * 1e-5!r} ic=0", "d1 d in ideal", "m1 d g 0 n",
            ".model ideal d(ron=0)", f"vg g 0 {pulse(0, 10, 0.0, 1e-3, 2e-3)}"], "find i(l1) at=8u", \
        volts / (r + ron) * (1 - math.exp(-8e-6 * (r + ron) / (r * 1e-5)))


def half_bridge(volts, r, ron):
    """A dead time after the upper one: the current goes on through the lower one's body diode."""
    coil, t = r * 1e-5, 4e-6
    i0 = volts / (r + ron) * (1 - math.exp(-t * (r + ron) / coil))
    end = -BODY_VOLT / (r + BODY_OHM)
    tau = coil / (r + BODY_OHM)
    i1 = max(0.0, end + (i0 - end) * math.exp(-1e-6 / tau))
    return [f"v1 in 0 {volts}", "m1 in gh s n", "m2 s gl 0 n", f"l1 s x {coil!r} ic=0", f"r1 x 0 {r}",
            f"vh gh s {pulse(0, 10, 0.0, t, 1e-3)}", f"vl gl 0 {pulse(0, 10, 5e-6, t, 1e-3)}"], "find i(l1) at=4.999999999u", i1


def subcircuit(volts, r, ron):
    return [f"v1 in 0 {volts}", f"r1 in d {r}", "x1 d g 0 half", f"vg g 0 {pulse(0, 10, 2e-6, 4e-6, 1e-5)}",
            ".subckt half d g s", "m1 d g s s n", ".ends"], "avg i(x1.m1)", 0.4 * volts / (r + ron)


def ramp(volts, r, ron):
    """It closes where the gate passes its threshold, 2 V."""
    return [f"v1 in 0 {volts}", f"r1 in d {r}", "m1 d g 0 n", "vg g 0 pwl(0 0 10u 10)"], \
        f"when v(d)={volts / 2!r} fall=1", 2e-6


CIRCUITS = (low_side, high_side_nmos, high_side_pmos, body_diode, synchronous, series_string, parallel, h_bridge,
            freewheeling, half_bridge, subcircuit, ramp)


def circuits(checker, program):
    for circuit in CIRCUITS:
        for volts, r, ron in some_of(((12, 10, 0.05), (0.02, 1e3, 1), (400, 20, 0.3), (5e3, 500, 2), (48, 0.5, 2e-3))):
            lines, what, wanted = circuit(volts, r, ron)
            text = "\n".join([circuit.__name__, *lines, f".model n VDMOS(Vto=2 Ron={ron!r})",
                              f".model p PMOS(Vto=-2 Ron={ron!r})", ".tran 0.1u 10u uic", f".meas tran m {what}", ".end", ""])
            done = run_at(program, text)
            case = f"{circuit.__name__} at {volts} V, {r} and {ron} ohm"
            if checker.check(done.status == 0, f"{case}: {done.stderr}"):
                checker.close(value_of(done, "m"), wanted, 3e-8 * abs(wanted) + 1e-12, case)


# model, its element's parameters, the gate's high level against the source, what the channel saturates at
SATURATIONS = (("NMOS(Vto=2 Kp=2)", "W=1 L=1", 4.5, 6.25), ("NMOS(Vto=1 Kp=20u W=1m L=2u)", "", 5, 0.08), ("VDMOS(Vto=4 Kp=25)", "", 5, 12.5),
               ("VDMOS(Vto=4 Kp=25 mtriode=3)", "", 5, 12.5), ("NMOS(Vto=2 Kp=2)", "W=1 L=1 M=3", 4.5, 18.75), ("NMOS(Vto=2 Kp=2 Vgon=3)", "W=4 L=1", 12, 4),
               ("PMOS(Vto=-2 Kp=2)", "W=1 L=1", -4, -4), ("VDMOS(pchan Vto=-3 Kp=10)", "", -3.5, -1.25), ("NMOS(Vto=0.5 Kp=1m W=1 L=1)", "", 1, 125e-6))


def saturations(checker, program):
    """A current source's ramp through a transistor: beyond what its channel carries there is a warning, short of it none."""
    for model, more, level, limit in SATURATIONS:
        for part in (0.5, 0.99, 1.04, 5):
            text = f"a ramp\ni1 {'0 d' if limit > 0 else 'd 0'} pwl(0 0 1m {abs(limit) * part!r})\nvg g 0 pulse(0 {level!r} -1 0 0 1 2)\n" \
                   f"m1 d g 0 x {more}\n.model x {model}\n.tran 10u 1m\n.save i(m1)\n.end\n"
            text = text.replace(f"pulse(0 {level!r} -1 0 0 1 2)", repr(level))
            done = run_at(program, text, quiet=False)
            what = f"{model} {more} at {part} of its current"
            checker.check(done.status == 0, f"{what}: {done.stderr}")
            words = f"'m1' carries {limit * part:.4g} A at 0.001 s, more than the {limit:.4g} A at which its channel saturates"
            checker.check(("saturates" in done.stderr) == (part > 1), f"{what}: {done.stderr}")
            checker.check(part < 1 or words in done.stderr, f"{what}: {words}: {done.stderr}")
    for card in ("m1 d g 0 irf540", "m1 d g 0 x\n.model x NMOS(Vto=2 Ron=0.1)"):
        text = f"none is known\nv1 a 0 1e4\nr1 a d 1\nvg g 0 10\n{card}\n.tran 1u 1m\n.end\n"
        done = run_at(program, text, quiet=False)
        checker.check(done.status == 0 and "saturates" not in done.stderr, f"{card}: {done.stderr}")


def igbts(checker, program):
    """A knee and a resistance; backwards only by the diode that the card has."""
    chopper = "a chopper\nv1 in 0 {v}\nr1 in c {r}\nz1 c g 0 ig\nvg g 0 {gate}\n{card}\n.tran 0.1u 10u\n" \
              ".meas tran m avg i(z1)\n.end\n"
    for volts, r in some_of(((600, 10), (24, 1), (3, 100), (5e3, 50), (0.5, 10))):
        for card, knee, ron in ((".model ig NIGBT(Vt=5 Kp=2 Vce0=1.2)", 1.2, 1 / 20), (".model ig NIGBT", 0.8, 1 / (0.38 * 10.3)),
                                (".model ig NIGBT(Vt=5 Vce0=1 Ron=20m Tau=1u Area=1e-5)", 1, 0.02)):
            on = max(0.0, (volts - knee) / (r + ron))
            done = run_at(program, chopper.format(v=volts, r=r, gate=pulse(0, 15, 2e-6, 4e-6, 1e-5), card=card))
            if checker.check(done.status == 0, f"{card}: {done.stderr}"):
                checker.close(value_of(done, "m"), 0.4 * on, 1e-8 * (volts / r), f"{card} at {volts} V")
        for card, back in ((".model ig NIGBT(Vt=5 Vdiode=1.5 Rdiode=10m)", max(0.0, (volts - 1.5) / (r + 0.01))),
                           (".model ig NIGBT(Vt=5)", 0.0)):
            done = run_at(program, chopper.format(v=-volts, r=r, gate=pulse(0, 15, 2e-6, 4e-6, 1e-5), card=card))
            if checker.check(done.status == 0, f"{card}: {done.stderr}"):
                checker.close(value_of(done, "m"), -back, 1e-8 * (volts / r), f"{card} at {-volts} V")


def bipolars(checker, program):
    """A relay's driver: the base takes current, the collector is on; its coil's current goes into a diode."""
    vt, at = KT_Q, 1e-3
    vbe = vt * math.log1p(at / 1e-14) - vt * at / (at + 1e-14)
    rbe = vt / (at + 1e-14)
    for volts, r, rb in some_of(((12, 100, 1e3), (5, 1e3, 1e4), (24, 50, 470), (1, 10, 100), (100, 1e3, 2.2e3))):
        text = f"a relay\n.options bjt=switch\nv1 in 0 {volts}\nr1 in x {r}\nl1 x c {r * 1e-5!r} ic=0\nd1 c in ideal\n" \
               f".model ideal d(ron=0)\nq1 c b 0 t\nrb g b {rb}\nvg g 0 {pulse(0, 5, 0.0, 8e-6, 1e-3)}\n" \
               ".model t NPN(Bf=200 Is=1e-14 Rc=0.5 Re=0.1 Vaf=100)\n.tran 0.1u 20u uic\n.meas tran on find i(q1) at=7u\n" \
               ".meas tran base find i(rb) at=7u\n.meas tran off find i(l1) at=15u\n.end\n"
        pnp = text.replace("v1 in 0", "v1 0 in").replace("d1 c in", "d1 in c").replace("NPN", "PNP").replace("vg g 0", "vg 0 g")
        for sign, cards_ in ((1, text), (-1, pnp)):
            done = run_at(program, cards_)
            if not checker.check(done.status == 0, f"{volts} V: {done.stderr}"):
                continue
            tau = r * 1e-5 / (r + 0.6)
            on = volts / (r + 0.6) * (1 - math.exp(-7e-6 / tau))
            peak = volts / (r + 0.6) * (1 - math.exp(-8e-6 / tau))
            checker.close(value_of(done, "on"), sign * on, 1e-7 * on, f"{sign * volts} V: the collector")
            checker.close(value_of(done, "base"), sign * (5 - vbe) / (rb + rbe), 1e-10, f"{sign * volts} V: the base")
            checker.close(value_of(done, "off"), sign * peak * math.exp(-7e-6 / 1e-5), 1e-7 * on, f"{sign * volts} V: the diode")


def bulks(checker, program):
    """A bulk on another node than the source: the channel when it is on, backwards from Vto on when the gate is at the source,
    and a diode from the bulk to each end; a p channel is the same with all signs changed."""
    vfwd, ron = 0.0258649 * math.log1p(1e14) - 0.0258649, 0.0258649  # the tangent of Is = 1e-14 at 1 A
    for ohms, volts, vto, gain in ((1, 12, 2, 10), (50, 400, 4, 0.5), (0.2, 3.3, 1, 100)):
        for sign, kind in ((1, "NMOS"), (-1, "PMOS")):
            on = volts / ohms / (1 + 1 / (gain * (10 * vto - vto)) / ohms)
            below = (volts - vfwd) / (ohms + ron)
            # gate on for 10 us, then the load pulls the source below the bulk, then above the drain
            load = f"0 0 10u 0 10u {-sign * volts!r} 20u {-sign * volts!r} 20u {sign * (2 * volts + vto)!r}"
            text = (f"a bulk on ground\nv1 d 0 {sign * volts!r}\nvg g s pulse({sign * 10 * vto!r} 0 10u 0 0 1 2)\nm1 d g s 0 mx\n"
                    f"r1 s l {ohms!r}\nv2 l 0 pwl({load})\n.model mx {kind}(Vto={sign * vto!r} Kp={gain!r} W=1 L=1 Rd=0)\n"
                    ".save i(r1) v(s)\n.tran 1u 30u\n.end\n")
            done = run_at(program, text)
            what = f"{kind} at {volts} V"
            if checker.check(done.status == 0 and "a diode from there to drain and source each" in done.stderr,
                             f"{what}: {done.status} {done.stderr}"):
                for t, current in ((5e-6, on), (15e-6, below), (25e-6, -volts / (ohms + 1 / (gain * (10 * vto - vto))))):
                    checker.close(done.at("i(r1)", t), sign * current, 1e-4 * abs(current), f"{what} at {t}")


def alike_ends(checker, program):
    """With a bulk on ground the end of the card's source may be the one at the supply. Then the channel is off while the gate is
    within Vto of the other end, which follows the gate where it is higher, up to the supply, behind the channel's resistance. A coil keeps its current through the
    diode of the bulk, and a capacitor keeps its charge behind a gate that is off."""
    vfwd, ron = 0.0258649 * math.log1p(1e14) - 0.0258649, 0.0258649
    for ohms, volts, vto, gain in ((1, 12, 2, 10), (50, 400, 4, 0.5), (0.2, 3.3, 1.5, 100), (1e4, 5, 1.2, 1e-2), (30, 48, 3, 1)):
        for sign, kind in ((1, "NMOS"), (-1, "PMOS")):
            high = volts + 3 * vto
            gate = f"0 0 10u 0 10u {sign * (0.4 * volts + vto)!r} 20u {sign * (0.4 * volts + vto)!r} 20u {sign * high!r}"
            model = f".model mx {kind}(Vto={sign * vto!r} Kp={gain!r} W=1 L=1 Rd=0)\n"
            text = (f"the source at the supply\nv1 s 0 {sign * volts!r}\nvg g 0 pwl({gate})\nm1 d g s 0 mx\n"
                    f"r1 d 0 {ohms!r}\n{model}.save v(d)\n.tran 1u 30u\n.end\n")
            done = run_at(program, text)
            what = f"{kind} at {volts} V"
            if checker.check(done.status == 0, f"{what}: {done.status} {done.stderr}"):
                share = 1 / (1 + 1 / (gain * 2 * vto) / ohms)
                for t, level in ((5e-6, 0), (15e-6, 0.4 * volts * share), (25e-6, volts * share)):
                    checker.close(done.at("v(d)", t), sign * level, 1e-9 * volts, f"{what} at {t}")
            text = (f"a sampled voltage\nv1 s 0 pwl(0 {sign * volts!r} 20u {sign * volts!r} 20u {sign * 2 * volts!r})\n"
                    f"vg g 0 pwl(0 {sign * (2 * volts + vto)!r} 10u {sign * (2 * volts + vto)!r} 10u 0)\nm1 d g s 0 mx\n"
                    f"c1 d 0 1p\n{model}.save v(d)\n.tran 1u 40u uic\n.end\n")
            done = run_at(program, text)
            if checker.check(done.status == 0, f"{what}, sampled: {done.status} {done.stderr}"):
                checker.close(done.at("v(d)", 15e-6), sign * volts, 1e-8 * volts, f"{what}: the sample")
                checker.close(done.at("v(d)", 35e-6), sign * volts, 1e-8 * volts, f"{what}: the sample, held")
            tau = 10e-6
            text = (f"a coil\nv1 s 0 {sign * volts!r}\nvg g 0 pwl(0 {sign * high!r} 10u {sign * high!r} 10u 0)\nm1 d g s 0 mx\n"
                    f"l1 d x {tau * ohms!r} ic=0\nr1 x 0 {ohms!r}\n{model}.save i(l1)\n.tran 1u 15u uic\n.end\n")
            done = run_at(program, text)
            if checker.check(done.status == 0, f"{what}, a coil: {done.status} {done.stderr}"):
                total = ohms + 1 / (gain * 2 * vto)
                peak = volts / total * (1 - math.exp(-10e-6 * total / (tau * ohms)))
                rest = vfwd / (ohms + ron)
                left = (peak + rest) * math.exp(-4e-6 * (ohms + ron) / (tau * ohms)) - rest
                checker.close(done.at("i(l1)", 14e-6), sign * max(left, 0), 1e-4 * volts / ohms, f"{what}: the coil")


def followers(checker, program):
    """A gate that is driven against ground, not above the supply: the source follows it by Vto, behind the channel's resistance, with a
    warning; a capacitor across the load keeps what it has while the gate is lower. A pull-up and a second transistor drive a third
    whose bulk is elsewhere, whichever end is at the supply."""
    for ohms, volts, vto, ron in ((10, 24, 3, 0.05), (1e4, 3.3, 0.7, 200), (0.3, 600, 4, 1e-3), (47, 1, 0.2, 5)):
        for sign, kind in ((1, "NMOS"), (-1, "PMOS")):
            gate = sign * (0.5 * volts + vto)
            text = (f"a follower\nv1 in 0 {sign * volts!r}\nvg g 0 pulse(0 {gate!r} 10u 0 0 20u 100u)\nm1 in g s s mx\nr1 s 0 {ohms!r}\n"
                    f"c1 s 0 {40e-6 / ohms!r} ic=0\n.model mx {kind}(Vto={sign * vto!r} Ron={ron!r})\n.save v(s)\n.tran 1u 40u uic\n.end\n")
            done = run_at(program, text, quiet=False)
            what = f"{kind} at {volts} V"
            if checker.check(done.status == 0 and "'m1' is a follower, not a switch" in done.stderr, f"{what}: {done.stderr}"):
                level = sign * 0.5 * volts / (1 + ron / ohms)
                tau = 40e-6 / ohms / (1 / ohms + 1 / ron)
                peak = level * (1 - math.exp(-20e-6 / tau))
                checker.close(done.at("v(s)", 30e-6), peak, 1e-8 * volts, f"{what}: the load")
                checker.close(done.at("v(s)", 40e-6), peak * math.exp(-0.25), 1e-8 * volts, f"{what}: the load, left alone")
    for m2 in ("m2 x g in w px", "m2 in g x w px"):
        text = f"a driven p channel\nv1 in 0 12\nv2 w 0 14\nva a 0 pulse(0 5 10u 0 0 20u 100u)\nr1 in g 100\nm1 g a 0 nx\n{m2}\n" \
               "r2 x 0 5\n.model nx NMOS(Vto=2 Ron=1)\n.model px PMOS(Vto=-3 Ron=0.1)\n.save v(x)\n.tran 1u 40u\n.end\n"
        done = run_at(program, text)
        if checker.check(done.status == 0, f"{m2}: {done.status} {done.stderr}"):
            checker.close(done.at("v(x)", 5e-6), 0, 1e-9, f"{m2}, off")
            checker.close(done.at("v(x)", 20e-6), 12 * 5 / 5.1, 1e-8, f"{m2}, on")


REFUSED = (
    ("m1 d g 0 0 nothing", "there is no model 'nothing'"),
    ("m1 d g nx", "has 3 or 4 nodes"),
    ("m1 d g 0 x y nx", "has 3 or 4 nodes"),
    ("m1 d g 0 d irf540", "bulk of 'm1' is not on its source"),
    ("m1 d g 0 d dx\n.model dx VDMOS(Vto=2 Ron=1)", "bulk of 'm1' is not on its source"),
    ("m1 d d 0 0 nx", "gate of 'm1' is connected to its drain"),
    ("m1 d g 0 0 nx\nvs g 0 sin(5 0.1 1k)", "it is an amplifier, not a switch"),
    ("m1 d g 0 0 nx\nvs g 0 pulse(5 8 0 1u 1u 5u 10u)", "it is an amplifier, not a switch"),
    ("m1 in g d zx\nvs g 0 pulse(0 10 0 0 0 5u 10u)\n.model zx NMOS(Vto=2 Ron=0)", "is a follower, not a switch"),
    ("z1 in g d ix\nvs g 0 pulse(0 10 0 0 0 5u 10u)\n.model ix NIGBT(Vt=5 Ron=1m)", "is a follower, not a switch"),
    ("m1 in g d 0 zx\nvs g 0 pulse(0 30 0 0 0 5u 10u)\n.model zx NMOS(Vto=2 Ron=0)", "its channel needs a resistance"),
    ("m1 d g 0 0 px\nvs g 0 sin(-5 0.1 1k)", "it is an amplifier, not a switch"),
    ("m1 d g 0 0 nx foo=1\nvs g 0 1", "has no parameter 'foo'"),
    ("m1 d g 0 0 nx m=0\nvs g 0 1", "must be positive"),
    ("m1 d g 0 0 bs\n.model bs NMOS(level=14)", "is of integrated circuits"),
    ("m1 d g 0 0 bs\n.model bs NMOS(Kp=0)", "'kp' must be positive"),
    ("m1 d g 0 0 bs\n.model bs NMOS(Rd=-1)", "'rd' cannot be negative"),
    ("m1 d g 0 0 dx\n.model dx D", "here NMOS, PMOS or VDMOS is wanted"),
    ("z1 d g 0 mf\n.model mf NMF(Vto=-2)", "MESFET"),
    ("z1 d g 0 nx", "here NIGBT is wanted"),
    ("q1 d g 0 qx\n.model qx NPN", "need not be a switch"),
    ("j1 d g 0 jx\n.model jx NJF", "not supported yet"),
)


def refusals(checker, program):
    for lines, words in REFUSED:
        done = run_at(program, f"refused\nv1 in 0 12\nr1 in d 10\nr2 g 0 1k\nr3 d 0 1meg\n{lines}\n.model nx NMOS(Vto=2 Kp=1)\n"
                               ".model px PMOS(Vto=-2 Kp=1)\n.tran 1u 20u\n.end\n")
        checker.check(done.status == 3 and words in done.stderr, f"{lines}: {done.status} {done.stderr}")
    drive = "b1 g 0 V=u(sin(2*pi*1e5*time))*12"
    done = run_at(program, f"unknown\nv1 in 0 12\nr1 in d 10\n{drive}\nm1 d g 0 nx\n.model nx NMOS(Vto=2 Kp=1)\n.tran 1u 20u\n.end\n", quiet=False)
    checker.check(done.status == 0 and "at 10 V, since no source gives" in done.stderr, done.stderr)


# Elements with a model that is in a library on another machine; the channel and the threshold that the drive asks for,
# and what a 10 ohm load at 12 V carries on average, in parts of what it would behind 50 mohm all the time.
TYPICAL = (
    ("m1 d g 0 0 far\nr1 in d 10\nvs g 0 pulse(0 12 0 0 0 4u 10u)", "an n", 3, 0.4),
    ("m1 d g 0 far\nr1 in d 10\nvs g 0 pulse(0 5 1u 0 0 7u 10u)", "an n", 3, 0.7),
    ("m1 d g 0 far\nr1 in d 10\nvs g 0 pulse(-5 15 0 0 0 2u 10u)", "an n", 3, 0.2),
    ("m1 d g 0 far\nr1 in d 10\nvs g 0 pulse(0 2.5 0 0 0 6u 10u)", "an n", 1.25, 0.6),
    ("m1 d g 0 far\nr1 in d 10\nvs x 0 pulse(10 0 0 0 0 4u 10u)\nr2 x g 10", "an n", 3, 0.6),
    ("m1 in g s far\nr1 s 0 10\nvs g s pulse(0 9 0 0 0 5u 10u)", "an n", 3, 0.5),
    ("m1 in g s far\nr1 s 0 10\nvs g 0 pulse(0 24 0 0 0 3u 10u)", "an n", 3, 0.3),
    ("m1 d g in in far\nr1 d 0 10\nvs g 0 pulse(12 0 0 0 0 4u 10u)", "a p", -3, 0.4),
    ("m1 d g in far\nr1 d 0 10\nvs g 0 pulse(12 9.5 0 0 0 8u 10u)", "a p", -1.25, 0.8),
    ("m1 d g in far\nr1 d 0 10\nvs g in pulse(-15 5 0 0 0 3u 10u)", "a p", -3, 0.7),
    ("m1 d g 0 far\nr1 in d 10\nb1 g 0 V=u(sin(2*pi*1e5*time))*10", "an n", 3, 0.5),
    ("m1 d g 0 far m=1\nr1 in d 10\nm2 d2 g 0 far\nr3 in d2 10\nvs g 0 pulse(0 5 0 0 0 4u 10u)", "an n", 3, 0.4),
)


def typical(checker, program):
    on = 12 / 10.05
    for lines, channel, threshold, part in TYPICAL:
        text = f"far away\nv1 in 0 12\n{lines}\n.lib C:\\LTC\\lib\\cmp\\standard.mos\n.tran 1u 20u\n" \
               ".meas tran i avg i(r1)\n.end\n"
        done = run_at(program, text, quiet=False)
        if checker.check(done.status == 0, f"{lines}: {done.stderr}"):
            checker.close(value_of(done, "i"), part * on, 1e-9, lines)
            said = f"in its place is {channel} channel of 50 mohm, on {'above' if threshold > 0 else 'below'} v(gs) = {threshold:g} V"
            checker.check(done.stderr.count(said) == 1 and "is a switch" not in done.stderr, f"{lines}: {done.stderr}")
    # the body diode of a p channel leads from drain to source
    text = "backwards\nv1 in 0 12\nm1 d g in far\nvs g 0 pulse(12 0 5u 0 0 1u 10u)\nr1 d x 10\nv2 x 0 20\n" \
           ".lib far.lib\n.tran 1u 4u\n.meas tran i find i(v2) at=2u\n.end\n"
    done = run_at(program, text)
    if checker.check(done.status == 0, done.stderr):
        checker.close(value_of(done, "i"), -(8 - BODY_VOLT) / (10 + BODY_OHM), 1e-9, "body diode of a p channel")
    for lines, words in (("vs g 0 sin(5 0.1 1k)", "it is an amplifier, not a switch"),
                         ("vs g 0 pulse(4 10 0 0 0 4u 10u)", "it is an amplifier, not a switch")):
        text = f"amplifier\nv1 in 0 12\nr1 in d 10\nm1 d g 0 far\n{lines}\n.lib far.lib\n.tran 1u 20u\n.end\n"
        done = run_at(program, text)
        checker.check(done.status == 3 and words in done.stderr, f"{lines}: {done.status} {done.stderr}")


# What drives the gate, the level it is on at against the source, what the card may be; on at 3 us.
CLOCK = "vc c 0 pulse(0 1 1u 1n 1n 4u 10u)\n"
LOGIC_DRIVES = (
    ("a1 c 0 0 0 0 0 g 0 buf vhigh=5 ref=0.5", 5, "nmos(level=1 kp=2 vto=2)"),
    ("a1 c 0 0 0 0 g 0 0 buf vhigh=12 vlow=-3 ref=1.5", 12, "nmos(level=1 kp=2 vto=2)"),
    ("a1 c 0 0 0 0 0 gg 0 and vhigh=15 ref=0.5\nrg gg g 10", 15, "nmos(level=1 kp=0.3 vto=4)"),
    ("a1 c 0 0 0 0 0 g 0 schmitt vt=0.5 vh=0.1 vhigh=3.3 trise=20n", 3.3, "nmos(level=1 kp=9 vto=1)"),
    ("vd dd 0 1\na1 dd 0 c 0 0 0 g 0 dflop vhigh=4.5 ref=0.5", 4.5, "nmos(level=1 kp=5 vto=1.5)"),
    ("a1 c 0 0 0 0 0 g 0 buf vhigh=6 ref=0.5 rout=100\nrp g 0 1meg", 6, "vdmos(kp=10 vto=2)"),
    ("a1 c 0 0 0 0 0 gg 0 buf vhigh=8 ref=0.5\nrg gg g2 5\nrg2 g2 g 5", 8, "vdmos(kp=10 vto=2 rd=10m)"),
    ("a1 [c] [q] ad\na2 [q] [g] da\n.model ad adc_bridge(in_low=0.5 in_high=0.5)\n"
     ".model da dac_bridge(out_low=0 out_high=5)", 5, "nmos(level=1 kp=2 vto=2)"),
    ("a1 [c] [q] ad\na2 q nq inv\na3 nq nnq inv\na4 [nnq] [g] da\n.model ad adc_bridge(in_low=0.5 in_high=0.5)\n"
     ".model inv d_inverter(rise_delay=1n fall_delay=1n)\n.model da dac_bridge(out_low=-2 out_high=7)", 7,
     "nmos(level=1 kp=2 vto=2)"),
    ("a1 c 0 0 0 0 0 g 0 buf vhigh=48 ref=0.5 trise=10n tfall=10n", 48, "nmos(level=1 kp=0.1 vto=5)"),
)


def logic_drives(checker, program):
    """The level of the gate is what the output of a gate gives, and the resistance follows it."""
    for drive, level, card in LOGIC_DRIVES:
        text = f"behind logic\nv1 in 0 12\nr1 in d 10\n{CLOCK}{drive}\nm1 d g 0 0 x\n.model x {card}\n" \
               ".tran 0.1u 20u\n.meas tran v find v(d) at=3u\n.end\n"
        done = run_at(program, text, quiet=False)
        if checker.check(done.status == 0, f"{drive}: {done.stderr}"):
            k = {p.split("=")[0]: float(p.split("=")[1].replace("10m", "0.01"))
                 for p in card[card.index("(") + 1:-1].split()}
            ohms = 1 / (k["kp"] * (level - k["vto"])) + k.get("rd", 0)
            checker.close(value_of(done, "v"), 12 * ohms / (10 + ohms), 1e-9, drive)
            checker.check(f"at {level:g} V" in done.stderr, f"{drive}: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("transistors")
    for part in (cards, circuits, saturations, bulks, alike_ends, followers, igbts, bipolars, refusals, typical, logic_drives):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
