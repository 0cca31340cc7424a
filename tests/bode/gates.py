#!/usr/bin/env python3
"""Responses of circuits with gates, latches and samples around their orbits, against small sines in the time domain.

usage: gates.py PROGRAM [NAME ...]

A sine whose frequency is a fraction m/n of the clock's has an orbit of n clocks: .pss finds that, and .four its component.
The amplitude A is halved once: with (4 H(A/2) - H(A))/3 what is of the third order in it is gone. Where no source repeats
a comparator that is a gate is compared with one that is a switch with hysteresis.
"""

import cmath
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "steady"))
import gate_circuits  # pylint: disable=wrong-import-position,import-error

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

TOLERANCE = 1e-6
FRACTIONS = [(1, 40), (1, 8), (3, 10), (11, 20), (9, 10), (17, 10)]


def run(program, folder, text, *options):
    (folder / "c.cir").write_text(text)
    done = subprocess.run([program, "run", "c.cir", "-q", "--report", "c.json", "--tol", "1e-11", *options],
                          cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    return json.loads((folder / "c.json").read_text()), done.stderr


def responses(program, folder, circuit, asked):
    _, text, level, _, _, signal = circuit
    source = text.replace("{S}", f"DC {level!r} AC 1")
    cards = f".save {signal}\n.pss uic\n.ac list {' '.join(map(repr, asked))}\n"
    report, said = run(program, folder, source + cards, "-o", "c.csv")
    rows = [[float(v) for v in line.split(",")] for line in (folder / "c.csv").read_text().splitlines()[1:]]
    if not report["response"]["exact"]:
        raise RuntimeError("the response is not said to be exact: " + said)
    return [complex(row[1], row[2]) for row in rows]


def injected(program, folder, circuit, fraction, amplitude):
    _, text, level, _, clock, signal = circuit
    frequency = fraction[0] / fraction[1] / clock
    source = text.replace("{S}", f"SIN({level!r} {amplitude!r} {frequency!r})")
    cards = f".save {signal}\n.pss {fraction[1] * clock!r} uic\n.four {frequency!r} 1 {signal}\n"
    report, _ = run(program, folder, source + cards, "-o", "none")
    found = report["fourier"][0]
    return found["magnitude"][1] * cmath.exp(1j * math.radians(found["phase"][1])) / amplitude


def check(program, checker, circuit):
    name, _, _, amplitude, clock, _ = circuit
    with tempfile.TemporaryDirectory() as name_of_folder:
        folder = pathlib.Path(name_of_folder)
        asked = [m / n / clock for m, n in FRACTIONS]
        found = responses(program, folder, circuit, asked)
        largest = max(map(abs, found))
        for fraction, value in zip(FRACTIONS, found):
            whole = injected(program, folder, circuit, fraction, amplitude)
            half = injected(program, folder, circuit, fraction, amplitude / 2)
            expected = (4 * half - whole) / 3
            off = abs(value - expected) / max(abs(expected), 1e-2 * largest)
            checker.check(off <= TOLERANCE,
                          f"{name} at {fraction[0]}/{fraction[1]}: {value} instead of {expected}, off by {off:.2e}")


HYSTERETIC = """A hysteretic converter
Vin in 0 12
Vref ref 0 5 AC 1
L1 sw out 22u
D1 0 sw
C1 out esr 100u
Resr esr 0 100m
R1 out 0 5
{}
.save v(out) i(l1) v(sw)
.pss uic
.ac list 1k 20k 60k 150k 240k
"""
AS_SWITCH = "S1 in sw ref out mos\n.model mos SW(Ron=5m Vt=0 Vh=20m)"
AS_GATE = "A1 ref out 0 0 0 0 q 0 DIFFSCHMITT Vt=0 Vh=20m\nS1 in sw q 0 mos\n.model mos SW(Ron=5m Vt=0.5)"


def without_a_clock(program, checker):
    with tempfile.TemporaryDirectory() as name:
        rows = []
        for how in (AS_SWITCH, AS_GATE):
            run(program, pathlib.Path(name), HYSTERETIC.format(how), "-o", "c.csv")
            lines = (pathlib.Path(name) / "c.csv").read_text().splitlines()[1:6]
            rows.append([float(value) for line in lines for value in line.split(",")])
        scale = max(map(abs, rows[0][1:7]))
        for one, other in zip(*rows):
            checker.check(abs(one - other) <= TOLERANCE * max(abs(one), scale), f"without a clock: {one}, {other}")


def main():
    program, names = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]
    checker = dalcs_program.Checker("gates")
    for circuit in dalcs_program.kinds_of(gate_circuits.CIRCUITS):
        if not names or circuit[0] in names:
            try:
                check(program, checker, circuit)
            except RuntimeError as error:
                checker.check(False, f"{circuit[0]}: {error}")
    if not names:
        without_a_clock(program, checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
