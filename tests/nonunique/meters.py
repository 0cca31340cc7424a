#!/usr/bin/env python3
"""A voltmeter changes nothing where an ideal circuit leaves voltages open: strings of open switches, blocking diodes and
thyristors, nodes that nothing ties, at the operating point, at events, at jumps, with both methods.

usage: meters.py PROGRAM

Each circuit is run as it is and with meters of several kinds at one of its open nodes: E, G into a resistor, B, and
cables of diodes and capacitors behind an E, few sections and many. All voltages must be what they are without the meter.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

MODELS = """.model d d(ron=0)
.model dv d(ron=0 vfwd=0.7)
.model s sw(ron=0 vt=0.5)
.model sr sw(ron=10m roff=1meg vt=0.5)
.subckt th a k g
d1 a m d
vs m n 0
s1 n k u 0 s
b1 u 0 v=v(g)+min(1,max(0,i(vs)*1k))
.ends
"""

# name, cards, stop, what voltages are compared, the node that is read
CIRCUITS = [
    ("two diodes", "v1 a 0 sin(0 10 1k)\nd1 a m d\nd2 m b d\nr1 b 0 1k", "2m", "a m b", "m"),
    ("a diode and a switch", "v1 a 0 sin(0 10 1k)\nd1 a m d\ns1 m b g 0 s\nr1 b 0 1k\nvg g 0 pulse(0 1 0.31m 1u 1u 0.2m 0.47m)",
     "2m", "a m b", "m"),
    ("three switches",
     "v1 a 0 sin(0 10 1k)\ns1 a m g 0 s\ns2 m n h 0 s\ns3 n b g 0 s\nr1 b 0 1k\nc1 b 0 1u\n"
     "vg g 0 pulse(0 1 0.31m 0 0 0.2m 0.47m)\nvh h 0 pulse(0 1 0.2m 0 0 0.2m 0.33m)", "2m", "a m n b", "n"),
    ("a square wave across three diodes", "v1 a 0 pulse(-5 10 0.1m 0 0 0.2m 0.41m)\nd1 a m d\nd2 m n dv\nd3 n b d\nr1 b 0 1k",
     "2m", "a m n b", "m"),
    ("two diodes that block after a charge",
     "v1 a 0 pulse(0 10 0.1m 0 0 0.2m 0.41m)\nc1 a x 1u\ns1 x p g 0 s\nd1 p m d\nd2 m q d\nc2 q 0 2u\nr2 q 0 1k\n"
     "vg g 0 pulse(0 1 50u 0 0 0.1m 0.17m)", "2m", "p m q", "m"),
    ("a leg that is off",
     "v1 p 0 400\ns1 p m g 0 s\ns2 m 0 h 0 s\ns3 m o k 0 s\nr1 o 0 10\nvg g 0 pulse(0 1 10u 0 0 10u 60u)\n"
     "vh h 0 pulse(0 1 30u 0 0 10u 60u)\nvk k 0 pulse(0 1 15u 0 0 7u 60u)", "300u", "m o", "m"),
    ("a leg with diodes",
     "v1 p 0 400\ns1 p m g 0 s\ns2 m 0 h 0 s\nd1 m p d\nd2 0 m d\nl1 m o 100u\nr1 o 0 10\n"
     "vg g 0 pulse(0 1 10u 0 0 10u 160u)\nvh h 0 pulse(0 1 90u 0 0 10u 160u)", "600u", "m o", "m"),
    ("switches of two transistors",
     "v1 a 0 sin(0 325 1k)\ns1 a m g 0 s\nd1 m a d\ns2 b m g 0 s\nd2 m b d\nr1 b 0 10\nvg g 0 pulse(0 1 33u 0 0 40u 90u)",
     "1m", "a m b", "m"),
    ("a matrix of switches",
     "v1 a 0 sin(0 325 1k)\nv2 b 0 sin(0 325 1k 0 0 -120)\nv3 c 0 sin(0 325 1k 0 0 120)\ns1 a m g1 0 s\ns2 b m g2 0 s\n"
     "s3 c m g3 0 s\ns4 m o g4 0 s\nr1 o 0 10\nvg1 g1 0 pulse(0 1 0 0 0 20u 100u)\nvg2 g2 0 pulse(0 1 33u 0 0 20u 100u)\n"
     "vg3 g3 0 pulse(0 1 66u 0 0 20u 100u)\nvg4 g4 0 pulse(0 1 10u 0 0 31u 70u)", "1m", "m o", "m"),
    ("a thyristor", "v1 a 0 sin(0 325 50)\nx1 a o g th\nr1 o 0 10\nvg g 0 pulse(0 1 4m 0 0 1m 20m)", "60m",
     "a o x1.m x1.n", "x1.m"),
    ("two thyristors in series",
     "v1 a 0 sin(0 325 50)\nx1 a m g th\nx2 m o g th\nr1 o 0 10\nvg g 0 pulse(0 1 4m 0 0 1m 20m)", "60m",
     "a m o x1.m x2.m", "m"),
    ("a dimmer",
     "v1 a 0 sin(0 325 50)\nx1 a o g th\nx2 o a h th\nr1 o 0 100\nvg g 0 pulse(0 1 4m 0 0 1m 20m)\n"
     "vh h 0 pulse(0 1 14m 0 0 1m 20m)", "60m", "a o x1.m x2.m", "x1.m"),
    ("a flying capacitor",
     "v1 p 0 20\nc1 x y 1u ic=10\ns1 p x g 0 s\ns2 y 0 g 0 s\ns3 x o h 0 s\ns4 y 0 h 0 s\nc2 o 0 1u\nr2 o 0 1k\n"
     "vg g 0 pulse(0 1 20u 0 0 100u 300u)\nvh h 0 pulse(0 1 160u 0 0 100u 300u)", "2m", "x y o", "x"),
    ("a winding that floats",
     "v1 in i0 pulse(-20 20 0 1u 1u 24u 50u)\nr0 i0 0 1\nl1 in 0 200u ic=0\nl2 x y 200u ic=0\nk1 l1 l2 1\nd1 x p d\nd2 y p d\nd3 n x d\n"
     "d4 n y d\nc1 p n 1u ic=30\nr1 p n 1k", "300u", "x y p n", "x"),
    ("a coil that diodes cut off",
     "v1 a 0 sin(0 100 1k)\nd1 a m d\nl1 m n 1m\nd2 n b d\nr1 b 0 100", "3m", "a m n b", "m"),
    ("a Marx generator",
     "v1 in 0 1k\nr1 in a 10k\nc1 a b 1u\nr2 b 0 10k\nr3 a c 10k\nc2 c e 1u\nr4 e 0 10k\ns1 a f g 0 s\ns2 f e g 0 s\nd1 c h d\n"
     "d2 h o d\nr5 o 0 1k\nr6 b 0 10\nvg g 0 pulse(0 1 10m 0 0 10m 30m)", "50m", "c f h o", "f"),
    ("strings far apart",
     "v1 a 0 sin(0 10k 1k)\nd1 a m d\nd2 m b d\nr1 b 0 1meg\nv2 c 0 sin(0 1m 1k 0 0 90)\ns1 c n g 0 s\ns2 n e g 0 s\n"
     "r2 e b 10\nvg g 0 pulse(0 1 0.31m 1u 1u 0.2m 0.47m)", "2m", "a m b c n e", "n"),
    ("a point that three diodes and a switch reach",
     "v1 a 0 sin(0 10 1k)\nv2 b 0 sin(0 10 1k 0 0 -120)\nd1 a m d\nd2 b m d\nd3 0 m d\ns1 m o g 0 s\nr1 o 0 1k\nc1 o 0 1u\n"
     "vg g 0 pulse(0 1 0.31m 0 0 0.1m 0.37m)", "2m", "a b m o", "m"),
    ("switches with resistances",
     "v1 a 0 sin(0 10 1k)\ns1 a m g 0 sr\ns2 m n g 0 s\ns3 n b g 0 s\nr1 b 0 1k\nvg g 0 pulse(0 1 0.31m 1u 1u 0.2m 0.47m)",
     "2m", "a m n b", "n"),
    ("a charge pump of switches",
     "v1 p 0 5\ns1 p x g 0 s\ns2 y 0 g 0 s\nc1 x y 1u\ns3 p y h 0 s\nd1 x z d\nd2 z o d\nc2 o 0 1u\nr2 o 0 1k\n"
     "vg g 0 pulse(0 1 0 0 0 40u 100u)\nvh h 0 pulse(0 1 50u 0 0 40u 100u)", "1m", "x y z o", "z"),
    ("two switches that read the circuit",
     "v1 a 0 sin(0 10 1k)\ns1 a m a 0 s\ns2 m b 0 c s\nr1 b 0 1k\nr2 c 0 1k\nc1 c 0 100n\nr3 a c 1k", "3m", "a m b", "m"),
    ("a rectifier that synchronous switches help",
     "v1 a 0 pulse(-12 12 0 0 0 10u 20u)\nd1 a m d\ns1 a m g 0 s\nd2 m b d\nl1 b o 10u\nc1 o 0 10u\nr1 o 0 2\nd3 0 b d\n"
     "vg g 0 pulse(0 1 1u 0 0 8u 20u)", "200u", "a m b o", "m"),
]


def cable(node, sections):
    lines = [f"ezz z0 0 {node} 0 1"]
    for k in range(sections):
        lines += [f"dz{k} z{k} z{k + 1} d", f"rz{k} z{k} z{k + 1} 1k", f"cz{k} z{k + 1} 0 10n"]
    return "\n".join(lines)


def meters(node):
    yield "E", f"ezz z1 0 {node} 0 1"
    yield "G", f"gzz 0 z1 {node} 0 1m\nrz z1 0 1k"
    yield "B", f"bzz z1 0 v=abs(v({node}))\nrz z1 0 1k"
    yield "a section", cable(node, 1)
    yield "40 sections", cable(node, 40)


def seconds(text):
    return float(text[:-1]) * {"u": 1e-6, "m": 1e-3}[text[-1]]


def netlist(name, cards, stop, nodes, start, extra=""):
    saved = " ".join(f"v({n})" for n in nodes.split())
    return "\n".join([name, cards, extra, MODELS + f".save {saved}", f".tran {seconds(stop) / 100!r} {stop} {start}", ".end", ""])


def rows_of(outcome):
    """The row at each time, of two at one time the one behind: what is open may jump, and a meter shows it."""
    return {t: k for k, t in enumerate(outcome.time)}


def compare(checker, what, plain, read):
    if not checker.check(read.status == 0, f"{what}: {read.stderr}"):
        return
    before, after = rows_of(plain), rows_of(read)
    checker.check(before.keys() == after.keys(), f"{what}: {len(after)} rows, not {len(before)}")
    for name in plain.names[1:]:
        a, b = plain.column(name), read.column(name)
        off, t = max((abs(a[before[t]] - b[after[t]]), t) for t in before if t in after)
        checker.check(off <= 1e-7 * plain.scale("v("),
                      f"{what}: {name} at {t:.6g} s is {b[after[t]]:.9g}, not {a[before[t]]:.9g}")


def main():
    checker = Checker("meters")
    for name, cards, stop, nodes, node in some_of(CIRCUITS):
        end = seconds(stop)
        at = [end * (k + 0.37) / 97 for k in range(97)]
        for method, start in ((None, ""), (None, "uic"), ("euler", "")):
            times = {"step": end / 400, "options": ["--audit", "off"]} if method else {"at": [0.0, *at]}
            plain = run(sys.argv[1], netlist(name, cards, stop, nodes, start), method=method, **times)
            what = f"{name}, {method or 'radau'} {start}"
            if not checker.check(plain.status == 0, f"{what}: {plain.stderr}"):
                continue
            for kind, extra in meters(node):
                read = run(sys.argv[1], netlist(name, cards, stop, nodes, start, extra), method=method, **times)
                compare(checker, f"{what}, with {kind}", plain, read)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
