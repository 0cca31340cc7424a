#!/usr/bin/env python3
"""dalcs converge: the orders of Euler and of Radau on a smooth circuit and through events, the table,
the page, and mistakes.

usage: converge.py PROGRAM
"""

import csv
import pathlib
import statistics
import subprocess
import sys
import tempfile
import unittest

PROGRAM = ""
NETLISTS = pathlib.Path(__file__).resolve().parents[2] / "netlists"
SMOOTH = """Two coupled oscillations, driven
V1 a 0 SIN(0 1 700)
R1 a b 2
L1 b c 1m
C1 c 0 10u ic=1
L2 c d 2m ic=0.1
C2 d 0 5u
R2 d 0 50
.tran 10u 10m uic
.save v(c) v(d) i(l1) i(l2)
.end
"""


class Converge(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.netlist = self.folder / "a.cir"
        self.netlist.write_text(SMOOTH)

    def converge(self, netlist, *options, status=0):
        done = subprocess.run([PROGRAM, "converge", str(netlist), *options], capture_output=True,
                              text=True, check=False, cwd=self.folder)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def table(self, netlist, *options):
        self.converge(netlist, *options, "-q", "-o", "t.csv")
        with open(self.folder / "t.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def order(self, stages, steps):
        rows = self.table(self.netlist, "--methods", f"radau{stages}" if stages > 1 else "euler",
                          "--steps", steps)
        self.assertEqual({row["stages"] for row in rows}, {str(stages)})
        orders = [float(row["order"]) for row in rows if row["order"]]
        self.assertGreaterEqual(len(orders), 2, rows)
        return statistics.median(orders)

    def test_orders(self):
        for stages, steps, tolerance in ((1, "1u..100n", 0.05), (3, "100u..10u", 0.2),
                                         (5, "400u..50u", 0.4), (7, "300u,150u,100u", 0.5)):
            with self.subTest(stages=stages):
                self.assertAlmostEqual(self.order(stages, steps), 2 * stages - 1, delta=tolerance)

    def test_order_of_euler_through_events(self):
        rows = self.table(NETLISTS / "rectifiers/full_bridge_rl.cir", "--methods", "euler",
                          "--steps", "100u..5u")
        for row in rows[1:]:
            self.assertAlmostEqual(float(row["order"]), 1.0, delta=0.05)

    def test_errors_are_right(self):
        """Of implicit Euler on a decay, which is known: 1/(1 + h)^n against exp(-n h)."""
        self.netlist.write_text("A decay\nC1 a 0 1 ic=1\nR1 a 0 1\n.tran 0.1 1 uic\n.end\n")
        rows = self.table(self.netlist, "--methods", "euler", "--steps", "10m,1m")
        for row in rows:
            h = float(row["step"])
            wanted = max(abs((1 + h) ** -round(k * 0.01 / h) - 2.718281828459045 ** (-k * 0.01))
                         for k in range(4, 97))
            # The scale is the largest value at the measured times, the first of which is 40 ms.
            wanted /= 2.718281828459045 ** -0.04
            self.assertAlmostEqual(float(row["error"]) / wanted, 1.0, delta=0.02)

    def test_text_and_page(self):
        out = self.converge(self.netlist, "--steps", "20u,10u,5u", "-o", "a.html").stdout
        for heading in ("euler: order 0.7", "radau, 3 stages", "radau, 5 stages",
                        "radau, 7 stages"):
            self.assertIn(f"\n  {heading}", out)
        text = (self.folder / "a.html").read_text()
        self.assertEqual(text.count("<svg"), 1)
        self.assertEqual(text.count("<tr>"), 13)

    def test_mistakes(self):
        cases = [
            ((), "no steps given: --steps 10u..100n"),
            (("--steps", "1u..10u"), "--steps: 1u..10u must fall from the largest step to the smallest"),
            (("--steps", "1u..x"), "--steps: 'x' is not a number greater than 0"),
            (("--steps", "1u,,2u"), "--steps: write 1m..1u or up to 40 steps separated by commas"),
            (("--steps", "10u,3u"),
             "--steps: 3e-06 s does not divide 1e-05 s: the steps would not end at common times"),
            (("--steps", "10u,10u"), "--steps: 1e-05 s is given twice"),
            (("--steps", "8m"), "--steps: 0.008 s is more than half of the run, 0.01 s"),
            (("--steps", "1u,1p"), "--steps: 1e-12 s would take 1e+10 steps; the most is 2e+07"),
            (("--steps", "1m..1f"),
             "--steps: 1.81899e-15 s would take 5e+12 steps; the most is 2e+07"),
            (("--steps", "1u", "--methods", "gear"),
             "--methods: write euler, radau, radau1, radau3, radau5, radau7, radau9 or several of "
             "them, each once, separated by commas"),
            (("--steps", "1u", "-o", "a.txt"),
             "unknown format of 'a.txt': name it .html or .csv"),
        ]
        for options, message in cases:
            with self.subTest(options=options):
                done = self.converge(self.netlist, *options, status=2)
                self.assertEqual(done.stderr, f"dalcs: error: {message}\n")
                self.assertEqual(done.stdout, "")


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
