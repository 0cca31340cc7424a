#!/usr/bin/env python3
"""Small signals beside a voltage that a whole part of a circuit has in common.

usage: common_mode.py PROGRAM

A bridge feeds a load whose only way to ground is a resistor: a little current of the filter through it is a large
voltage of all nodes, and rounding of that is large beside other currents. A short step takes currents that have nowhere
to go away with voltages that grow as it gets shorter, and rounding grows with them. With a sparse matrix of stages this
once left a span without end, and the answer was 'singular matrix'. The response is that of a small sine.
"""

import cmath
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

PERIOD = 40e-6
NEAR = 1e-6
AMPLITUDE = 1e-3
SIGNALS = ("v(star)", "i(lla)", "v(fa,fb)")


def bridge(common, n_dividers, control):
    """n_dividers: pairs of resistors beside the load, so that there are enough unknowns."""
    lines = ["A bridge with an isolated load", "Vdc dc0 0 400", "Rdc dc0 dc1 20m", "Ldc dc1 dc 20u", "Cdc dc e 500u",
             "Re e 0 5m", "Vtri tri 0 PULSE(-1 1 0 20u 20u 1f 40u)", "Vm m0 0 0.3", f"Vin m m0 {control}",
             f"Rmid mid star {common}", "Vmid mid 0 200", ".model sm SW(Ron=10m Vt=0.02)"]
    for leg, high, low in (("a", "m tri", "tri m"), ("b", "tri m", "m tri")):
        lines += [f"E{leg}u gu{leg} 0 {high} 1", f"S{leg}u dc s{leg} gu{leg} 0 sm", f"D{leg}u s{leg} dc",
                  f"E{leg}l gl{leg} 0 {low} 1", f"S{leg}l s{leg} 0 gl{leg} 0 sm", f"D{leg}l 0 s{leg}",
                  f"L{leg}0 s{leg} x{leg} 0.5m", f"R{leg}0 x{leg} f{leg} 50m", f"C{leg}0 f{leg} y{leg} 4.7u",
                  f"Rc{leg} y{leg} star 0.5", f"Ll{leg} f{leg} l{leg} 1m", f"Rl{leg} l{leg} n 10"]
        lines += [f"Rx{leg}{k} l{leg} q{leg}{k} 1k\nRy{leg}{k} q{leg}{k} n 1k" for k in range(n_dividers)]
    return "\n".join(lines) + "\n"


def run(program, folder, verb, netlist):
    path = folder / "c.cir"
    path.write_text(netlist + ".end\n")
    done = subprocess.run([program, verb, path.name, "-q", "-o", "c.csv", "--report", "c.json", "--tol", "1e-12"],
                          cwd=folder, capture_output=True, text=True, check=False)
    return done, json.loads((folder / "c.json").read_text())


def injected(program, folder, case, frequency, amplitude):
    netlist = bridge(*case, f"SIN(0 {amplitude!r} {frequency!r})")
    done, report = run(program, folder, "steady",
                       netlist + f".pss {4 * PERIOD!r} uic\n.four {frequency!r} 1 {' '.join(SIGNALS)}\n")
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    return [part["magnitude"][1] * cmath.exp(1j * math.radians(part["phase"][1])) / amplitude
            for part in report["fourier"]]


def look_at(checker, program, folder, case, fraction):
    frequency = fraction / PERIOD
    done, report = run(program, folder, "bode", bridge(*case, "DC 0 AC 1") + f".save {' '.join(SIGNALS)}\n.pss uic\n"
                       f".ac list {frequency!r}\n")
    if not checker.check(done.returncode == 0, f"{case}: {done.stderr}"):
        return
    checker.check(report["response"]["exact"], f"{case}: not exact")
    row = [float(v) for v in (folder / "c.csv").read_text().splitlines()[1].split(",")]
    whole, half = (injected(program, folder, case, frequency, AMPLITUDE / k) for k in (1, 2))
    largest = max(abs(w) for w in whole)
    for k, signal in enumerate(SIGNALS):
        found, expected = complex(row[2 * k + 1], row[2 * k + 2]), (4 * half[k] - whole[k]) / 3
        away = abs(found - expected) / max(abs(expected), 1e-3 * largest)
        checker.check(away <= NEAR, f"{case}: {signal} is {found}, not {expected}, off by {away:.2g}")


def large(checker, program, folder):
    """More unknowns than a dense matrix has: runs are looser, and the orbit that a response is around is not."""
    rows = []
    for options in ([], ["--tol", "1e-12"]):
        (folder / "c.cir").write_text(bridge("1", 20, "DC 0 AC 1") + f".save {' '.join(SIGNALS)}\n.pss uic\n.ac list 6k\n.end\n")
        done = subprocess.run([program, "run", "c.cir", "-q", "-o", "c.csv", "--report", "c.json", *options], cwd=folder,
                              capture_output=True, text=True, check=False)
        if not checker.check(done.returncode == 0, f"large, {options}: {done.stderr}"):
            return
        rows.append([float(v) for v in (folder / "c.csv").read_text().splitlines()[1].split(",")])
    checker.check(json.loads((folder / "c.json").read_text())["steady"]["defect"] <= 1e-10, "the orbit does not come back")
    away = max(abs(one - other) for one, other in zip(*rows)) / max(map(abs, rows[1][1:]))
    checker.check(away <= 1e-8, f"large: off by {away:.2g} from the response with --tol 1e-12")


def six_steps():
    """A motor behind a bridge whose switches conduct for a third of a period each."""
    lines = ["Six steps", "Vin p 0 DC 100 AC 1", "Rn n 0 100k", ".model sm SW(Ron=10m Vt=0.5)"]
    for k in range(3):
        for half, begin in (("h", (1 / 12 + k / 3) % 1), ("l", (7 / 12 + k / 3) % 1)):
            wraps = begin + 1 / 3 > 1
            pulse = f"1 0 {(begin - 2 / 3) * 1e-3!r} 0 0 {2e-3 / 3!r} 1m" if wraps else f"0 1 {begin * 1e-3!r} 0 0 {1e-3 / 3!r} 1m"
            lines.append(f"V{half}{k} g{half}{k} 0 PULSE({pulse})")
        lines += [f"S{k} p u{k} gh{k} 0 sm", f"D{k} u{k} p", f"Sn{k} u{k} 0 gl{k} 0 sm", f"Dn{k} 0 u{k}", f"L{k} u{k} x{k} 1m",
                  f"R{k} x{k} e{k} 0.5", f"V{k} e{k} n SIN(0 30 1k 0 0 {-120 * k})"]
    return "\n".join(lines) + "\n", "i(l0)", 370


def rectifier():
    """Four thyristors behind a coil of the line."""
    lines = ["A bridge of thyristors at 110 degrees", "Vl a b SIN(0 325 50)", "Rb b 0 100k", "Ll a x 1m", "Ld p d 30m", "Rd d e 10",
             "Vin e n DC 20 AC 1", ".model scr thyristor(Ron=1m Voff=1m)"]
    for k, (low, high) in enumerate((("x", "p"), ("n", "x"), ("b", "p"), ("n", "b"))):
        begin = 110 / 360 * 0.02 + (0.01 if k in (1, 2) else 0)
        lines += [f"Vg{k} g{k} 0 PULSE(0 1 {begin!r} 0 0 1m 20m)", f"A{k} {low} {high} g{k} 0 scr"]
    return "\n".join(lines) + "\n", "i(ld)", 85


def short_pieces(checker, program, folder):
    """Behind an event a piece of the period may be picoseconds long. What rounding makes of the flux of a coil there is a voltage,
    and a current of a resistor beside it: that is no finding, however small --tol is."""
    for netlist, signal, hertz in (six_steps(), rectifier()):
        rows = []
        for tolerance in ("1e-6", "1e-11"):
            (folder / "c.cir").write_text(f"{netlist}.save {signal}\n.pss uic\n.ac list {0.1 * hertz!r} {0.5 * hertz!r} {hertz} {2 * hertz!r}\n.end\n")
            done = subprocess.run([program, "run", "c.cir", "-q", "-o", "c.csv", "--audit", "full", "--tol", tolerance], cwd=folder,
                                  capture_output=True, text=True, check=False)
            if checker.check(done.returncode == 0, f"{signal}, --tol {tolerance}: {done.stderr}"):
                rows.append([complex(*map(float, line.split(",")[1:])) for line in (folder / "c.csv").read_text().splitlines()[1:5]])
        away = [abs(one / other - 1) for one, other in zip(*rows)] if len(rows) == 2 else []
        checker.check(max(away, default=0.0) <= 1e-8, f"{signal}: off by {away}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("a voltage in common")
    with tempfile.TemporaryDirectory() as folder:
        for case in (("1", 4), ("10k", 4), ("10k", 0), ("100k", 4)):
            look_at(checker, program, pathlib.Path(folder), case, 0.25)
        large(checker, program, pathlib.Path(folder))
        short_pieces(checker, program, pathlib.Path(folder))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
