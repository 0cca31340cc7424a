#!/usr/bin/env python3
"""From a schematic of Lepton EDA to a waveform: lepton-netlist writes the netlist, with both of its SPICE backends.

usage: lepton.py PROGRAM

The circuit is a half-wave rectifier with a closed form.
"""

import csv
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
OMEGA, OHM, FARAD = 2.0 * math.pi * 50.0, 1e3, 20e-6


def attributes(x, y, texts):
    return "{\n" + "".join(f"T {x} {y} 5 10 1 1 0 0 1\n{text}\n" for text in texts) + "}\n"


def part(x, y, symbol, *texts):
    return f"C {x} {y} 1 0 0 {symbol}-1.sym\n" + (attributes(x, y, texts) if texts else "")


def net(x1, y1, x2, y2, name=None):
    return f"N {x1} {y1} {x2} {y2} 4\n" + (attributes(x1, y1, [f"netname={name}"]) if name else "")


SCHEMATIC = "v 20220529 2\n" + "".join((
    part(0, 0, "vsin", "refdes=V1", "value=SIN(0 10 50)"), part(200, -300, "gnd"), net(300, 1200, 300, 1500, "in"),
    part(1000, 1300, "diode", "refdes=D1", "model-name=RECT"), net(300, 1500, 1000, 1500), net(1900, 1500, 2500, 1500, "out"),
    part(2500, 1400, "resistor", "refdes=R1", "value=1k"), part(3300, 1200, "gnd"),
    part(2500, 900, "capacitor", "refdes=C1", "value=20u"), net(2500, 1500, 2500, 1100), net(3400, 1500, 3400, 1100),
    part(5000, 1000, "spice-model", "refdes=A2", "model-name=RECT", "model=n=0.01", "type=D"),
    part(5000, 0, "spice-directive", "refdes=A1", "value=.tran 20u 12m uic")))


class Lepton(unittest.TestCase):
    def test_a_schematic(self):
        opens = (math.pi - math.atan(OMEGA * OHM * FARAD)) / OMEGA
        left = 10.0 * math.sin(OMEGA * opens) * math.exp(-(12e-3 - opens) / (OHM * FARAD))
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "rc.sch").write_text(SCHEMATIC, encoding="utf-8")
            for backend in "spice-sdb", "spice-noqsi":
                subprocess.run(["lepton-netlist", "-q", "-g", backend, "-o", "rc.cir", "rc.sch"], cwd=folder, check=True,
                               capture_output=True, env={**os.environ, "HOME": folder, "GUILE_AUTO_COMPILE": "0"})
                subprocess.run([PROGRAM, "run", "rc.cir", "-q", "-o", "rc.csv"], cwd=folder, check=True,
                               capture_output=True)
                with open(pathlib.Path(folder) / "rc.csv", newline="", encoding="utf-8") as table:
                    *_, row = csv.DictReader(table)
                self.assertAlmostEqual(float(row["v(out)"]), left, delta=1e-8)
                self.assertAlmostEqual(float(row["v(in)"]), 10.0 * math.sin(OMEGA * 12e-3), delta=1e-8)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
