#!/usr/bin/env python3
"""Where a period begins does not matter to the response around it.

usage: phase_of_mains.py PROGRAM

Rectifiers whose diodes a sine turns over at t = 0, where a run begins, against the same ones a part of a period later; an
ideal bridge in continuous conduction against its closed form.
"""

import csv
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

BRIDGE = "d1 in p d\nd2 0 p d\nd3 m in d\nd4 m 0 d\n"
# {0}: the phase in degrees, besides those of the other windings
CASES = {
    "a bridge with a coil": "v1 in 0 SIN(0 12 50 0 0 {0}) AC 1\n" + BRIDGE + "l1 p q 0.1\nr1 q m 5\n",
    "a bridge with a filter": "v1 in 0 SIN(0 325 50 0 0 {0}) AC 1\n" + BRIDGE + "l1 p q 0.2\nc1 q m 1m\nr1 q m 20\n",
    "a bridge with a resistor": "v1 in 0 SIN(0 12 400 0 0 {0}) AC 1\n" + BRIDGE + "r1 p m 5\nr2 in x 1\nc1 x 0 1u\n",
    "a half-wave rectifier and its freewheel": "v1 in 0 SIN(0 10 1k 0 0 {0}) AC 1\nd1 in p d\nd2 0 p d\nl1 p q 10m\nr1 q 0 8\n",
    "two windings": "v1 a 0 SIN(0 10 60 0 0 {0}) AC 1\ne1 b 0 a 0 -1\nd1 a p d\nd2 b p d\nl1 p q 0.3\nr1 q 0 8\n",
    "a voltage source that follows the current": "v1 in 0 SIN(0 12 50 0 0 {0}) AC 1\n" + BRIDGE
    + "l1 p q 0.1\nr1 q m 5\nh1 k 0 v1 3\nr2 k y 10\nl2 y 0 5m\n",
    "a current source commutates": "i1 0 in SIN(0 2 50 0 0 {0}) AC 1\n" + BRIDGE + "c1 p m 5m\nr1 p m 10\n",
    "diodes with a resistance": "v1 in 0 SIN(0 12 50 0 0 {0}) AC 1\n" + BRIDGE.replace(" d\n", " dr\n")
    + "l1 p q 0.1\nr1 q m 5\n.model dr D(Ron=10m Vfwd=0)\n",
    "the small signal is the load's": "v1 in 0 SIN(0 12 50 0 0 {0})\n" + BRIDGE + "l1 p q 0.1\nr1 q m 5\ni2 q m AC 1\n",
    "cosine and sine": "v1 a 0 SIN(0 10 50 0 0 {0}) AC 1\nv2 b 0 SIN(0 10 50 0 0 {1})\nd1 a p d\nd2 b p d\nd3 0 p d\n"
    "l1 p q 0.2\nr1 q 0 8\n",
}
FREQUENCIES = ".ac list 3 41 333 5k\n.model d D(Ron=0 Vfwd=0)\n"


def response(program, folder, netlist):
    """{signal: [complex]}, or None."""
    (folder / "c.cir").write_text(f"mains\n{netlist}{FREQUENCIES}.pss uic\n.end\n")
    done = subprocess.run([program, "bode", "c.cir", "-q", "-o", "c.csv"], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        return None, done.stderr
    with open(folder / "c.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    names = [key[3:-1] for key in rows[0] if key.startswith("re(")]
    return {name: [complex(float(row[f"re({name})"]), float(row[f"im({name})"])) for row in rows] for name in names}, done.stderr


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("phase of mains")
    with tempfile.TemporaryDirectory() as name:
        for case, netlist in CASES.items():
            found = [response(program, pathlib.Path(name), netlist.format(phase, phase + 90)) for phase in (0, 31)]
            if not checker.check(None not in [rows for rows, _ in found], f"{case}: {[said for _, said in found]}"):
                continue
            at_zero, later = (rows for rows, _ in found)
            for kind in "vi":
                scale = max((abs(z) for key, row in later.items() if key[0] == kind for z in row), default=0.0)
                off = max((abs(z - w) for key in later if key[0] == kind for z, w in zip(at_zero[key], later[key])), default=0.0)
                checker.check(off <= 1e-8 * scale, f"{case}: {kind}() off by {off:.2g} of {scale:.2g}")
            if case == "a bridge with a coil":  # 2 i each half period, dv / slope earlier or later; i has no ripple at L -> inf
                current = 2 * 12 / math.pi / 5
                ideal = -4 * current / (12 * 2 * math.pi)
                checker.check(abs(at_zero["i(v1)"][0] / ideal - 1) < 0.1, f"{case}: {at_zero['i(v1)'][0]} for {ideal}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
