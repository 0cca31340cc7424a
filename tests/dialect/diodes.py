#!/usr/bin/env python3
"""Diodes by name, and the currents that the tangents of exponential ones are taken at.

The table against the figures that it states; circuits of milliamperes and of amperes against ngspice, where it is there.

usage: diodes.py PROGRAM
"""

import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# name, a forward current in A and the voltage there; the reverse voltage
NAMED = (
    ("1N4148", 0.1, 0.92, 100), ("1n4148w", 1e-3, 0.60, 100), ("D1N4148", 0.1, 0.92, 100),
    ("DI_1N4148W", 0.1, 0.92, 100), ("1N914", 0.1, 0.92, 100), ("BAS16", 0.1, 0.95, 100),
    ("BAV99", 1e-3, 0.62, 100), ("1N4001", 1, 0.93, 50), ("1N4004", 1, 0.93, 400),
    ("1N4007", 1, 0.93, 1000), ("1N4007G", 0.01, 0.65, 1000), ("D1N4002", 1, 0.93, 100),
    ("S1M", 1, 0.93, 1000), ("1N5408", 3, 0.92, 1000), ("1N5404", 0.1, 0.70, 400),
    ("UF4007", 1, 1.35, 1000), ("UF4004", 1, 0.98, 400), ("ES1D", 1, 0.90, 200),
    ("MUR460", 4, 1.12, 600), ("mur120", 1, 0.83, 200), ("MUR1560", 15, 1.25, 600),
    ("MURS160T3G", 1, 1.05, 600), ("FR107", 1, 0.98, 1000), ("1N5817", 1, 0.40, 20),
    ("1N5818", 1, 0.43, 30), ("1N5819", 0.1, 0.30, 40), ("1N5822", 3, 0.47, 40),
    ("MBRS340", 3, 0.47, 40), ("MBRS140T3G", 1, 0.47, 40), ("MBR735", 7.5, 0.55, 35),
    ("MBR745", 7.5, 0.55, 45), ("MBR20100CT", 10, 0.75, 100), ("MBR0520LT1G", 0.5, 0.36, 20),
    ("SS14", 1, 0.47, 40), ("B540C", 5, 0.48, 40), ("BAT54", 1e-3, 0.28, 30),
    ("BAT54S", 0.1, 0.55, 30), ("BAT85", 0.1, 0.60, 30), ("1N34A", 5e-3, 0.75, 60),
    ("MBR6545", 65, 0.55, 45), ("MBR1100", 1, 0.74, 100), ("MBR40250", 40, 0.85, 250), ("MBRB30H60CT", 30, 0.65, 60),
    ("SB5100", 5, 0.72, 100), ("SR580", 5, 0.74, 80), ("B240A", 2, 0.55, 40), ("B5819W", 1, 0.47, 40), ("SS26", 2, 0.65, 60),
    ("STPS20L45CT", 20, 0.55, 45), ("STPS3045CT", 30, 0.55, 45), ("STPS10H100", 10, 0.74, 100), ("MUR8100E", 8, 1.65, 1000),
    ("MUR2020", 2, 0.70, 200), ("DS1588", 0.1, 0.95, 100), ("MR760", 6, 0.95, 1000), ("RURG3060", 30, 1.35, 600), ("RURG80100", 80, 1.65, 1000), ("RHRP8120", 8, 2.60, 1200),
    ("STTH3R06", 3, 1.35, 600), ("STTH12010", 120, 1.65, 1000), ("STTH15L06", 1.5, 0.85, 600), ("DSEI60-06A", 60, 1.35, 600),
    ("HER108", 1, 1.65, 1000), ("HER303", 3, 0.92, 200), ("FR207", 2, 0.95, 1000), ("ES2D", 2, 0.92, 200), ("US2M", 2, 1.65, 1000),
    ("RS2G", 2, 0.95, 400), ("S2K", 2, 0.95, 800), ("C3D10060A", 10, 1.50, 600), ("C4D20120D", 2, 0.95, 1200), ("C3D1P7060Q", 1.7, 1.50, 600),
    ("PMEG3010BEA", 1, 0.47, 30), ("PMEG2005AEA", 0.5, 0.47, 20), ("PMEG10020ELR", 2, 0.74, 100), ("PMEG6010EP", 1, 0.65, 60),
    ("PDS760", 7, 0.65, 60), ("DFLS240", 2, 0.55, 40), ("MBRM140", 1, 0.55, 40), ("CMSH3-40", 3, 0.55, 40),
    ("CMDSH2-3", 0.2, 0.48, 30), ("BAT46WJ", 0.1, 0.65, 100), ("UPSC600", 1, 1.50, 600),
    ("IDH10G65C5", 10, 1.50, 650), ("IDW40G120C5", 40, 1.55, 1200), ("10MQ060N", 1, 0.55, 60),
    ("LED", 20e-3, 1.90, 5), ("led_blue", 20e-3, 3.20, 5), ("QTLP690C", 20e-3, 1.90, 5),
)

# name, the Zener voltage, the current there
ZENERS = (
    ("1N4728A", 3.3, 0.25 / 3.3), ("1N4733A", 5.1, 0.25 / 5.1), ("1N4742A", 12, 0.25 / 12),
    ("1N4744", 15, 0.25 / 15), ("1N4764A", 100, 0.25 / 100), ("1N5221B", 2.4, 20e-3),
    ("1N5231B", 5.1, 20e-3), ("1N5242B", 12, 0.125 / 12), ("1N5245B", 15, 0.125 / 15),
    ("1N750", 4.7, 20e-3), ("1N759A", 12, 20e-3), ("D1N750", 4.7, 20e-3),
    ("MMSZ5231B", 5.1, 20e-3), ("1N5338B", 5.1, 1.25 / 5.1), ("1N5349B", 12, 1.25 / 12),
    ("1N5369B", 51, 1.25 / 51), ("1N5371B", 60, 1.25 / 60), ("1N5378B", 100, 1.25 / 100),
    ("BZX84C15VLY", 15, 5e-3), ("BZX84B8V2LY", 8.2, 5e-3),
    ("BZX84C6V2", 6.2, 5e-3), ("BZX84C6V2L", 6.2, 5e-3), ("BZX84C15", 15, 5e-3),
    ("BZX79C5V1", 5.1, 5e-3), ("BZX79-C5V1", 5.1, 5e-3), ("BZX55C12", 12, 5e-3),
    ("DFLZ33", 33, 0.35 / 33), ("MM3Z5V1T1G", 5.1, 5e-3), ("UDZV12B", 12, 5e-3), ("BZX84C12VL", 12, 5e-3), ("P6KE200A", 200, 1 / 200),
    ("1.5KE33A", 33, 10e-3), ("BZX85C10", 10, 0.35 / 10), ("BZT52C3V3", 3.3, 5e-3), ("BZV55-C33", 33, 0.12 / 33),
)

UNKNOWN = ("MBR10", "MUR3", "C3D1006", "SS2", "HER109", "FR308", "ES2Z", "B12", "STTH06", "MUR15200", "MBR10500", "IDH10", "S10M",
           "PMEG30", "PMEG3010TOOLONG", "PMEG0010", "1N5379B",
           "1N4147X", "1N4727A", "BZX84C", "BZX84C1V0", "BZX84C6V2V1", "1N", "MUR", "4148", "diode", "1n41488")


def table(checker, program):
    """A current source finds the stated voltage: the tangent is taken at that current."""
    for name, amperes, volts, reverse in some_of(NAMED):
        done = run(program, f"named\nI1 0 a {amperes}\nD1 a 0 {name}\n.op\n.end\n", method=None, report=False)
        checker.check(done.status == 0, f"{name}: {done.stderr}")
        checker.check("is not in the netlist" in done.stderr and f"{reverse} V in reverse" in done.stderr,
                      f"{name}: {done.stderr}")
        if done.rows:
            checker.close(done.column("v(a)")[0], volts, 1e-3 * volts, f"{name} at {amperes} A")
    for name, volts, amperes in some_of(ZENERS):
        done = run(program, f"zener\nI1 a 0 {amperes!r}\nD1 a 0 {name}\n.op\n.end\n", method=None, report=False)
        checker.check(done.status == 0 and f"Zener voltage {volts:g} V" in done.stderr,
                      f"{name}: {done.stderr}")
        if done.rows:
            checker.close(-done.column("v(a)")[0], volts, 5e-3 * volts + 0.2, f"{name} at {amperes} A")
    for name in UNKNOWN:
        done = run(program, f"unknown\nI1 0 a 1\nD1 a 0 {name}\n.op\n.end\n", method=None, report=False)
        checker.check(done.status == 3 and "there is no model" in done.stderr, f"{name}: {done.stderr}")


def places(checker, program):
    """Inside subcircuits, beside models of the netlist, once or often, with areas and numbers."""
    for lines, volts in (
            ("D1 a 0 1N4148", 0.92), ("X1 a s\n.subckt s p\nD1 p 0 1N4148\n.ends", 0.92),
            ("D1 a 0 1N4148\n.model 1N4148 D(Ron=1 Vfwd=0.5)", 0.6),
            ("X1 a s\n.subckt s p\nD1 p 0 1N4148\n.model 1N4148 D(Ron=1 Vfwd=0.5)\n.ends", 0.6),
            ("X1 a s\n.subckt s p\nD1 p 0 1N4148\n.ends\n.model 1N4148 D(Ron=1 Vfwd=0.5)", 0.6),
            ("D1 a b 1N4148\nD2 b 0 1N4148", 1.84), ("D1 a b 1N4148\nD2 b 0 other\n.model other D", 0.92),
            ("D1 a 0 1N4148 n=3", 2.76), ("D1 a 0 1N4148 m=1", 0.92)):
        done = run(program, f"places\nI1 0 a 0.1\n{lines}\n.op\n.end\n", method=None, report=False)
        checker.check(done.status == 0, f"{lines}: {done.stderr}")
        if done.rows:
            checker.close(done.column("v(a)")[0], volts, 1e-6, lines)
    twice = run(program, "twice\nI1 0 a 0.1\nD1 a b 1N4148\nD2 b 0 1N4148\n.op\n.end\n", method=None, report=False)
    checker.check(twice.stderr.count("is not in the netlist") == 1, twice.stderr)


# ---- Currents that the circuit has --------------------------------------------------------------------

SMALL = ".model d D(IS=2.52n N=1.752 RS=0.568)"
LARGE = ".model d D(IS=14.1n N=1.984 RS=33.9m)"
SCHOTTKY = ".model d D(IS=31.7u N=1.373 RS=51m)"
BRIDGE = "D1 a p d\nD2 b p d\nD3 0 a d\nD4 0 b d"

# name, netlist, what is measured, how far it may be off ngspice's, how far it is with a tangent at 1 A at least
CIRCUITS = (
    ("a milliampere bridge", f"V1 a b SIN(0 10 1k)\n{BRIDGE}\nR1 p 0 1k\n{SMALL}\n.tran 1u 5m 0 1u\n",
     "AVG v(p) from=2m to=5m", 6e-3, 5e-2),
    ("its peak", f"V1 a b SIN(0 10 1k)\n{BRIDGE}\nR1 p 0 1k\n{SMALL}\n.tran 1u 5m 0 1u\n",
     "MAX v(p) from=2m to=5m", 5e-3, 2e-2),
    ("a bridge of 100 uA", f"V1 a b SIN(0 5 1k)\n{BRIDGE}\nR1 p 0 33k\n{SMALL}\n.tran 1u 5m 0 1u\n",
     "AVG v(p) from=2m to=5m", 2e-2, 0.1),
    ("a bridge with a capacitor", f"V1 a b SIN(0 10 50)\n{BRIDGE}\nR1 p 0 1k\nC1 p 0 100u\n{SMALL}\n"
     ".tran 10u 0.4 0 10u\n", "AVG v(p) from=0.3 to=0.4", 8e-3, 1e-2),
    ("a half wave", f"V1 a 0 SIN(0 3 1k)\nD1 a p d\nR1 p 0 10k\n{SMALL}\n.tran 1u 5m 0 1u\n",
     "AVG v(p) from=2m to=5m", 2e-2, 0.1),
    ("a doubler", f"V1 a 0 SIN(0 5 1k)\nC1 a b 1u\nD1 0 b d\nD2 b p d\nC2 p 0 10u\nR1 p 0 10k\n{SMALL}\n"
     ".tran 2u 100m 0 2u\n", "AVG v(p) from=80m to=100m", 1.5e-2, 3e-2),
    ("a string of three", f"V1 a 0 5\nR1 a p 1k\nD1 p q d\nD2 q r d\nD3 r 0 d\n{SMALL}\n.tran 1u 1m\n",
     "AVG v(p)", 1e-4, 0.1),
    ("a clamp", f"V1 a 0 SIN(0 10 1k)\nR1 a p 10k\nD1 p 0 d\nD2 0 p d\n{SMALL}\n.tran 1u 5m 0 1u\n",
     "RMS v(p) from=2m to=5m", 8e-2, 0.25),
    ("a bridge of 20 A", f"V1 a b SIN(0 50 50)\n{BRIDGE}\nR1 p 0 2\n{LARGE}\n.tran 10u 60m 0 10u\n",
     "AVG v(p) from=20m to=60m", 4e-3, 0),
    ("a coil that runs free", f"V1 a 0 PULSE(0 10 0 1u 1u 50u 100u)\nD1 a p d\nD2 0 p d\nL1 p q 5m\nR1 q 0 100\n"
     f"{SMALL}\n.tran 0.2u 2m 0 0.2u\n", "AVG v(q) from=1m to=2m", 4e-3, 2e-2),
    ("a Schottky diode of 10 mA", f"V1 a 0 SIN(0 2 1k)\nD1 a p d\nR1 p 0 100\n{SCHOTTKY}\n.tran 1u 5m 0 1u\n",
     "AVG v(p) from=2m to=5m", 2e-2, 0.04),
    ("a Zener diode of 5 mA", "V1 a 0 12\nR1 a p 1k\nD1 0 p d\n.model d D(IS=1f BV=5.1 IBV=5m RS=1)\n"
     ".tran 1u 1m\n", "AVG v(p)", 1e-3, 1e-3),
)


def ours(program, text):
    """The measurement, how many runs found the currents; None where it failed."""
    done = run(program, text, method=None, report=True, quiet=False)
    found = [m["value"] for m in (done.report or {}).get("measurements", [])]
    runs = re.search(r"found in (\d+) run", done.stderr)
    return (found[0] if done.status == 0 and found else None), int(runs.group(1)) if runs else 0, done.stderr


def theirs(text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "c.cir"
        path.write_text(text)
        done = subprocess.run(["ngspice", "-b", str(path)], capture_output=True, text=True, check=False, timeout=60)
        found = re.search(r"(?m)^m\s*=\s*(\S+)", done.stdout)
        return float(found.group(1)) if found else None


def currents(checker, program):
    for name, body, measure, allowed, with_one in some_of(CIRCUITS):
        text = f"{name}\n{body}.meas tran m {measure}\n.end\n"
        fixed = text.replace(".end\n", ".options diodecurrent=1\n.end\n")
        mine, runs, said = ours(program, text)
        at_one, none, _ = ours(program, fixed)
        checker.check(mine is not None and at_one is not None, f"{name}: {said}")
        checker.check(1 <= runs <= 8 and none == 0, f"{name}: {runs} runs, {none} with diodecurrent=\n{said}")
        if mine is None or at_one is None or not shutil.which("ngspice"):
            continue
        wanted = theirs(text)
        if not checker.check(wanted is not None, f"{name}: ngspice has no result"):
            continue
        off, before = abs(mine / wanted - 1), abs(at_one / wanted - 1)
        print(f"{name}: ngspice {wanted:.5g}, dalcs {mine:.5g} ({off:.1%}), at 1 A {at_one:.5g} ({before:.1%})")
        checker.check(off <= allowed, f"{name}: {mine}, ngspice {wanted}: off by {off:.2%}")
        checker.check(before >= with_one, f"{name}: at 1 A off by {before:.2%} only: this tests nothing")


def closed_form(checker, program):
    """A resistor and a diode at rest: the line touches the curve at the solution."""
    vt = 300.15 * 1.380649e-23 / 1.602176634e-19
    for volts, ohms in ((5, 1e3), (5, 1e5), (1, 1e3), (12, 10), (100, 1), (5, 1e7), (0.8, 50)):
        saturation, n, rs = 2.52e-9, 1.752, 0.568
        low, high = 0.0, volts / ohms
        for _ in range(200):
            i = (low + high) / 2
            v = n * vt * math.log1p(i / saturation) + (rs + ohms) * i
            low, high = (i, high) if v < volts else (low, i)
        for analysis in (".op", ".tran 1u 1m", ".dc V1 {0} {0} 1".format(volts)):
            done = run(program, f"at rest\nV1 a 0 {volts}\nR1 a p {ohms}\nD1 p 0 d\n{SMALL}\n{analysis}\n"
                       ".options reltol=1e-9\n.end\n", method=None, report=False)
            checker.check(done.status == 0, done.stderr)
            if done.rows:
                checker.close(done.column("i(d1)")[-1], i, 1e-6 * i, f"{volts} V, {ohms} ohm, {analysis}")


def steps(checker, program):
    """Each step has currents of its own, and so has each run of a script."""
    text = (f"steps\n.param r=1k\nV1 a 0 5\nR1 a p {{r}}\nD1 p 0 d\n{SMALL}\n.step param r list 1k 100k\n.op\n"
            ".options reltol=1e-9\n.end\n")
    alone = []
    for r in ("1k", "100k"):
        one = run(program, text.replace("r=1k", f"r={r}").replace(".step param r list 1k 100k\n", ""), method=None,
                  report=False)
        alone.append(one.column("v(p)")[-1])
    both = run(program, text, method=None, report=False)
    checker.check(both.status == 0, both.stderr)
    if both.rows:
        for found, wanted in zip(both.column("v(p)"), alone):
            checker.close(found, wanted, 1e-9, "a step")


def lines_of(stderr):
    """Vfwd and Ron of each diode, from the note that names them."""
    return {name: (float(volts), float(ohms)) for name, volts, ohms in
            re.findall(r"'(\w+)' at [-+.e\d]+ A \(Vfwd = ([-+.e\d]+) V, Ron = ([-+.e\d]+) ohm\)", stderr)}


# what is swept, over what, the rest of the circuit; the current of d1 at x, from its line and from those of all
CURVES = (
    ("v1", "-1 1 10m", "v1 a 0 0\nd1 a 0 d", lambda x, v, r, _: max(0, (x - v) / r)),
    ("v1", "0 0.9 50m", "v1 a 0 0\nd1 a 0 d\n.options reltol=1e-9", lambda x, v, r, _: max(0, (x - v) / r)),
    ("v1", "0 40 0.5", "v1 in 0 0\nr1 in a 100\nd1 a 0 d", lambda x, v, r, _: max(0, (x - v) / (r + 100))),
    ("v1", "-5 5 0.25", "v1 in 0 0\nr1 in a 1meg\nd1 a 0 d", lambda x, v, r, _: max(0, (x - v) / (r + 1e6))),
    ("v1", "5 -5 -0.25", "v1 in 0 0\nr1 in a 1k\nd1 0 b d\nv2 b a 0", lambda x, v, r, _: max(0, (-x - v) / (r + 1e3))),
    ("i1", "0 1m 50u", "i1 0 a 0\nd1 a 0 d", lambda x, v, r, _: x),
    ("i1", "0 20 1", "i1 0 a 0\nd1 a b d\nr1 b 0 10m\nr2 a 0 1k",
     lambda x, v, r, _: max(0, (1e3 * x - v) / (1e3 + r + 10e-3))),
    ("r1", "100 1k 100", "v1 in 0 5\nr1 in a 1k\nd1 a 0 d", lambda x, v, r, _: (5 - v) / (r + x)),
    ("r1", "1meg 10meg 1meg", "v1 in 0 5\nr1 in a 1meg\nd1 a 0 d", lambda x, v, r, _: (5 - v) / (r + x)),
    ("v1", "0 3 0.1", "v1 in 0 0\nr1 in a 50\nd1 a b d\nd2 b 0 d",
     lambda x, v, r, all_: max(0, (x - v - all_["d2"][0]) / (r + all_["d2"][1] + 50))),
    ("v1", "0 0.9 20m", "v1 a 0 0\nd1 a 0 d\nd2 a 0 e\n.model e d(is=1n rs=1)", lambda x, v, r, _: max(0, (x - v) / r)),
)


def curves(checker, program):
    """A .dc is on one line at all of its points, that of the currents which it carries as a whole, and its audit is on it too."""
    for what, points, cards, wanted in CURVES:
        for model in ("d(is=2.52n rs=0.568 n=1.752)", "d(is=1e-12 rs=50m)", "d(is=1u rs=1 n=1.1)"):
            name = f"a curve over {what}, {cards}, {model}"
            done = run(program, f"curve\n{cards}\n.model d {model}\n.dc {what} {points}\n.save i(d1)\n.end\n", method=None,
                       options=("--audit", "full"), report=False, quiet=False)
            checker.check(done.status == 0, f"{name}: {done.stderr}")
            lines = lines_of(done.stderr)
            if done.status != 0 or "d1" not in lines:
                continue
            found = done.column("i(d1)")
            for x, i in zip(done.column(done.names[0]), found):
                checker.close(i, wanted(x, *lines["d1"], lines), 1e-3 * max(map(abs, found)), f"{name} at {x}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = Checker("diodes")
    for part in (table, places, closed_form, steps, curves, currents):
        part(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
