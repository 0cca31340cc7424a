#!/usr/bin/env python3
"""Checks DEV, LOT and .wcase: what each draws and shares, the ends of a divider by hand, what is said of mistakes.

usage: tolerances.py PROGRAM

Seeds are fixed: a test of a distribution fails always or never.
"""

import csv
import itertools
import json
import math
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())

DIVIDER = """a divider of parts with tolerances
V1 in 0 10
R1 in out 1k DEV=5% LOT=2%
R2 out 0 RB 2k
.model RB RES (R=1 DEV=1% LOT=10%)
C1 out 0 1u DEV=0.1u
.tran 10u 1m
.meas tran vend find v(out) at=1m
.meas tran cur avg i(v1)
.meas tran vin max v(in)
"""

SHARED = """what tolerances share
V1 in 0 10
R1 in a 1k LOT=10%
R2 a b 2k LOT=5%
R3 b 0 1k LOT/3=10%
R4 in 0 RB 1k
R5 in 0 1k RB
L1 in l 1m LOT/3=1%
R6 l 0 R=1k DEV/gauss=1%
D1 in c dl
R7 c 0 1k
D2 in d dl
R8 d 0 1k
X1 in 0 leg
X2 in 0 leg
X3 in 0 other
.subckt leg a b
R1 a m RB 1k
D1 m n dl
R2 n b 1k
.model RB RES(R=1 LOT=5%)
.model dl D(vfwd=0.5 LOT=10% Ron=1 DEV=0.1)
.ends
.subckt other a b
R1 a b RB 1k
.model RB RES(R=1 LOT=5%)
.ends
.model RB RES(R=1 LOT=20%)
.model dl D(vfwd=0.7 DEV/1=5% Ron=2 DEV/1/uniform=5%)
.model unused D(vfwd=0.7 LOT=5%)
.op
.meas op x find v(a)
"""


def divide(r1, lot_r, r2, lot_rb):
    """Value of the divider where these are the tolerances' places."""
    upper = 1e3 * (1 + 0.05 * r1 + 0.02 * lot_r)
    lower = 2e3 * (1 + 0.01 * r2 + 0.10 * lot_rb)
    return 10 * lower / (upper + lower)


class Tolerances(unittest.TestCase):
    def setUp(self):
        # pylint: disable-next=consider-using-with
        self.kept = tempfile.TemporaryDirectory(prefix="dalcs-tolerances-")
        self.addCleanup(self.kept.cleanup)
        self.folder = pathlib.Path(self.kept.name)

    def run_it(self, text, *more, status=0):
        (self.folder / "a.cir").write_text(text + ".end\n")
        done = subprocess.run([PROGRAM, "run", "a.cir", "-o", "none", "--measures", "m.csv", *more], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def rows(self, text, *more, status=0):
        self.run_it(text, *more, status=status)
        lines = (self.folder / "m.csv").read_text().splitlines()
        return [{key: value if key == "error" else float(value) for key, value in row.items()}
                for row in csv.DictReader(lines)]

    # ---- .mc ----

    def test_values_are_within_their_tolerances(self):
        rows = self.rows(DIVIDER + ".mc 2000\n")
        self.assertEqual(list(rows[0]), ["run", "r1", "r2", "c1", "vend", "cur", "vin", "error"])
        for name, nominal, most in (("r1", 1e3, 0.07), ("r2", 2e3, 0.11), ("c1", 1e-6, 0.1)):
            values = [row[name] / nominal - 1 for row in rows]
            self.assertLess(max(map(abs, values)), most)
            self.assertGreater(max(values), 0.9 * most)
            self.assertLess(min(values), -0.9 * most)
            self.assertLess(abs(statistics.mean(values)), most / 10)
        for row in rows:
            self.assertAlmostEqual(row["vend"], 10 * row["r2"] / (row["r1"] + row["r2"]), delta=1e-9)

    def test_even_and_normal(self):
        text = ("t\nV1 a 0 1\nR1 a 0 1k DEV=10%\nR2 a 0 1k DEV/gauss=10%\nR3 a 0 1k DEV/g 100\n"
                ".op\n.meas op x find v(a)\n.mc 4000\n")
        rows = self.rows(text)
        for name, quantile in (("r1", lambda p: 2 * p - 1), ("r2", statistics.NormalDist().inv_cdf),
                               ("r3", statistics.NormalDist().inv_cdf)):
            values = sorted((row[name] / 1e3 - 1) / 0.1 for row in rows)
            for p in 0.05, 0.25, 0.5, 0.75, 0.95:
                self.assertAlmostEqual(values[int(p * len(values))], quantile(p), delta=0.08)

    def test_what_is_shared(self):
        rows = self.rows(SHARED + ".mc 25\n")
        self.assertNotIn("unused(vfwd)", rows[0])
        for row in rows:
            def moved(name, nominal, row=row):
                return row[name] / nominal - 1
            self.assertAlmostEqual(moved("r1", 1e3), 2 * moved("r2", 2e3), delta=1e-12)   # of one letter
            self.assertAlmostEqual(moved("r3", 1e3), 10 * moved("l1", 1e-3), delta=1e-12)  # of LOT/3
            self.assertAlmostEqual(moved("r4", 1e3), moved("r5", 1e3), delta=1e-12)       # of a model
            self.assertAlmostEqual(moved("x1.r1", 1e3), moved("x2.r1", 1e3), delta=1e-12)  # of its text
            self.assertAlmostEqual(moved("d1(vfwd)", 0.7), moved("d1(ron)", 2), delta=1e-12)  # DEV/1 of a device
            apart = [moved("r1", 1e3), moved("r3", 1e3), moved("r4", 1e3) / 2, 2 * moved("x1.r1", 1e3),
                     2 * moved("x3.r1", 1e3), 2 * moved("d1(vfwd)", 0.7), 2 * moved("d2(vfwd)", 0.7),
                     row["x1.d1(ron)"] - 1, row["x2.d1(ron)"] - 1]
            for a, b in itertools.combinations(apart, 2):
                self.assertNotAlmostEqual(a, b, delta=1e-9)

    def test_a_diode_has_what_was_drawn(self):
        text = ("t\nV1 in 0 10\nD1 in a dm\nR1 a 0 1k\nD2 in b dm\nR2 b 0 1k\n.model dm D(vfwd=0.7 DEV=5% LOT=5%)\n"
                ".tran 1u 1m\n.meas tran a avg v(a)\n.meas tran b avg v(b)\n.mc 5\n")
        for row in self.rows(text):
            self.assertAlmostEqual(row["a"], 10 - row["d1(vfwd)"], delta=1e-9)
            self.assertAlmostEqual(row["b"], 10 - row["d2(vfwd)"], delta=1e-9)
            self.assertNotEqual(row["a"], row["b"])

    def test_same_draws(self):
        """In parts, in threads, alone, with another card, beside .step."""
        text = DIVIDER + ".mc 12\n"
        whole = self.rows(text, "--jobs", "2")
        self.assertEqual(self.rows(text, "--jobs", "1"), whole)
        self.assertEqual(self.rows(text, "--shard", "2/3"), whole[4:8])
        alone = self.rows(text, "--only", "7")[0]
        self.assertEqual([alone[k] for k in ("r1", "r2", "vend")], [whole[6][k] for k in ("r1", "r2", "vend")])
        more = self.rows(text.replace("C1 out", "R9 in 0 3k DEV=7%\nC1 out"))
        self.assertEqual([row["r2"] for row in more], [row["r2"] for row in whole])
        other = self.rows(text, "--seed", "2")
        self.assertNotEqual(other[0]["r1"], whole[0]["r1"])
        stepped = self.rows(text.replace("R2 out 0 RB 2k", "R2 out 0 RB {x}\n.param x=2k") +
                            ".step param x list 2k 4k\n")
        self.assertEqual({row["r2"] / row["x"] for row in stepped}, {row["r2"] / 2e3 for row in whole})

    def test_without_runs_all_is_nominal(self):
        said = self.run_it(DIVIDER).stderr
        self.assertIn("tolerances (DEV, LOT) count in runs of .mc and .wcase only", said)
        self.assertEqual(said.count("note"), 1)
        for more in "", ".options dialect=ltspice\n.step param x 1 3 1\n":
            for row in self.rows(DIVIDER + more):
                self.assertAlmostEqual(row["vend"], 10 * 2 / 3, delta=1e-9)

    # ---- .wcase ----

    def test_divider(self):
        for more, most in ("", 1), (" corners=no", 1), (" vary dev", 1), (" vary lot", 1), (" vary both", 1):
            rows = self.rows(DIVIDER + f".wcase{more}\n", "--report", "r.json")
            said = json.loads((self.folder / "r.json").read_text())["worst_case"]
            lot, dev = ("dev" not in more) * most, ("lot" not in more) * most
            names = ["r1"] * dev + ["lot(r)"] * lot + ["r2"] * dev + ["lot(rb)"] * lot + ["c1"] * dev
            self.assertEqual(list(said["parameters"]), names)
            self.assertEqual(said["corners"], "no" not in more)
            n = len(names)
            self.assertEqual(said["runs"], 1 + 2 * n + 6 + (2 ** n if said["corners"] else 0))
            self.assertEqual(len(rows), said["runs"])
            vend = said["results"][0]
            self.assertAlmostEqual(vend["nominal"], divide(0, 0, 0, 0), delta=1e-9)
            self.assertAlmostEqual(vend["smallest"], divide(dev, lot, -dev, -lot), delta=1e-9)
            self.assertAlmostEqual(vend["largest"], divide(-dev, -lot, dev, lot), delta=1e-9)
            least = {"r1": 1, "lot(r)": 1, "r2": -1, "lot(rb)": -1, "c1": 0}
            self.assertEqual(vend["at_smallest"], {name: least[name] for name in names})
            self.assertEqual(vend["at_largest"], {name: -least[name] for name in names})
            vin = said["results"][2]
            self.assertEqual([vin["smallest"], vin["largest"]], [10, 10])
            self.assertEqual(set(vin["at_smallest"].values()) | set(vin["at_largest"].values()), {0})
            for p, name in enumerate(names):
                place = [0, 0, 0, 0]
                if name != "c1":
                    at = ["r1", "lot(r)", "r2", "lot(rb)"].index(name)
                    place[at] = -1
                    self.assertAlmostEqual(vend["alone"][name][0], divide(*place), delta=1e-9)
                    place[at] = 1
                    self.assertAlmostEqual(vend["alone"][name][1], divide(*place), delta=1e-9)
                self.assertEqual(rows[1 + 2 * p][name], said["parameters"][name][0])
                self.assertEqual(rows[2 + 2 * p][name], said["parameters"][name][2])
        self.assertEqual(said["parameters"]["r1"], [950, 1000, 1050])
        self.assertEqual(said["parameters"]["lot(rb)"], [-1, 0, 1])

    def test_corners_are_all_there(self):
        rows = self.rows(DIVIDER + ".wcase\n")[17:]
        seen = {(row["r1"], row["lot(r)"], row["r2"], row["lot(rb)"], row["c1"]) for row in rows}
        self.assertEqual(len(rows), 32)
        self.assertEqual(len(seen), 32)
        for row in rows:
            self.assertAlmostEqual(row["vend"], divide((row["r1"] - 1e3) / 50, row["lot(r)"],
                                                       (row["r2"] - 2e3) / 20, row["lot(rb)"]), delta=1e-9)

    def test_effects_that_do_not_add_up(self):
        """A bridge in balance: the effect of one arm says nothing about the effect of two."""
        text = ("t\nV1 in 0 10\nR1 in a 1k DEV=10%\nR2 a 0 1k\nR3 in b 1k DEV=10%\nR4 b 0 1k\n"
                "B1 c 0 V=-abs(v(a)-v(b))\n.tran 1u 10u\n.meas tran off min v(c)\n")
        done = self.run_it(text + ".wcase\n", "--report", "r.json")
        off = json.loads((self.folder / "r.json").read_text())["worst_case"]["results"][0]
        self.assertAlmostEqual(off["smallest"], -10 * abs(1 / 1.9 - 1 / 2.1), delta=1e-9)
        self.assertEqual(off["at_smallest"]["r1"], -off["at_smallest"]["r3"])
        self.assertIn("'off' is smallest, -0.501253, in a corner that the single tolerances do not predict", done.stderr)
        self.assertNotIn("largest", done.stderr)
        done = self.run_it(text + ".wcase corners=no\n", "--report", "r.json")
        off = json.loads((self.folder / "r.json").read_text())["worst_case"]["results"][0]
        self.assertGreater(off["smallest"], -0.3)

    def test_functions(self):
        """mc, unif, aunif, flat, limit, agauss, gauss and rand have ends, too; each call is one of them."""
        written = {"mc(10,0.1)": (9, 11), "unif(10,0.1)": (9, 11), "aunif(10,2)": (8, 12), "10+flat(3)": (7, 13),
                   "limit(10,1)": (9, 11), "agauss(10,3,3)": (7, 13), "gauss(10,0.1,2)": (9, 11),
                   "10+gauss(1)": (7, 13), "10+rand()": (10, 11), "mc(5,0.1)+mc(5,0.1)": (9, 11)}
        for value, (low, high) in written.items():
            self.run_it(f"t\nI1 0 a 1\nR1 a 0 {{x}}\n.param x={{{value}}}\n.op\n.meas op v find v(a)\n.wcase\n",
                        "--report", "r.json")
            said = json.loads((self.folder / "r.json").read_text())["worst_case"]
            self.assertEqual([said["results"][0][k] for k in ("smallest", "largest")], [low, high], value)
            self.assertEqual(list(said["parameters"]), ["x", "x:2"] if "+mc" in value else ["x"])

    def test_a_function_and_a_tolerance(self):
        text = "t\nI1 0 a 1\nR1 a 0 {mc(10,0.1)} DEV=5%\n.op\n.meas op v find v(a)\n"
        self.run_it(text + ".wcase\n", "--report", "r.json")
        said = json.loads((self.folder / "r.json").read_text())["worst_case"]
        self.assertEqual(list(said["parameters"]), ["r1", "r1(dev)"])
        self.assertAlmostEqual(said["results"][0]["largest"], 11 * 1.05, delta=1e-12)
        for row in self.rows(text + ".mc 4\n"):
            self.assertEqual(list(row), ["run", "r1", "v", "error"])
            self.assertAlmostEqual(row["v"], row["r1"], delta=1e-12)

    def test_many_tolerances_have_no_corners(self):
        parts = "".join(f"R{k} n{k} n{k + 1} 1k DEV=1%\n" for k in range(12))
        text = "t\nV1 n0 0 10\n" + parts + "R99 n12 0 1k{}\n.op\n.meas op v find v(n12)\n.wcase\n"
        for tolerance, n, corners in ("", 12, True), (" DEV=1%", 13, False):
            self.run_it(text.format(tolerance), "--report", "r.json")
            said = json.loads((self.folder / "r.json").read_text())["worst_case"]
            self.assertEqual((len(said["parameters"]), said["corners"]), (n, corners))
            last = 1.01 if tolerance else 1
            self.assertAlmostEqual(said["results"][0]["largest"], 10 * last / (12 * 0.99 + last), delta=1e-9)

    def test_sizes(self):
        """In per cent, in ohms, of a model's factor, from an expression, behind any way to write the value."""
        written = {"R1 in 0 1k DEV=5%": 50, "R1 in 0 1k DEV=5": 5, "R1 in 0 1k dev 0.5%": 5, "R1 in 0 R=1k DEV=1%": 10,
                   "R1 in 0 {x} DEV={x/100}%": 100, "R1 in 0 RB 1k\n.model RB RES(R=1 DEV=0.05)": 50,
                   "R1 in 0 1k RB\n.model RB R(DEV=5%)": 50, "R1 in 0 RB R=1k DEV=1%\n.model RB RES(R=1 DEV=9%)": 10,
                   "R1 in 0 1k RB\n.model RB RES(TC1=1 DEV=5% R=1 LOT=2%)": 20}
        for card, size in written.items():
            text = f"t\n.param x=1k\nI1 0 in 1\n{card}\n.op\n.meas op v find v(in)\n.wcase\n"
            self.run_it(text, "--report", "r.json")
            v = json.loads((self.folder / "r.json").read_text())["worst_case"]["results"][0]
            self.assertAlmostEqual(v["largest"], 1000 + size, delta=1e-9, msg=card)
            self.assertAlmostEqual(v["smallest"], 1000 - size, delta=1e-9, msg=card)

    def test_other_elements(self):
        cards = {"V1 b 0 5 DEV=10%": 5.5, "V1 b 0 DC 5 AC 1 DEV=10%": 5.5, "I1 0 b 5m DEV=10%": 5.5,
                 "E1 b 0 one 0 5 DEV=10%": 5.5,
                 "G1 0 b one 0 5m DEV=10%": 5.5, "F1 0 b Vone 5 LOT=10%": 5.5, "H1 b 0 Vone 5k DEV=10%": 5.5}
        for card, largest in cards.items():
            text = (f"t\nVone one 0 1\nIone 0 one 1m\n{card}\nR1 b 0 1k\n.op\n"
                    ".meas op v find v(b)\n.wcase\n")
            self.run_it(text, "--report", "r.json")
            v = json.loads((self.folder / "r.json").read_text())["worst_case"]["results"][0]
            self.assertAlmostEqual(v["largest"], largest, delta=1e-9, msg=card)

    def test_steady_state(self):
        text = ("t\nV1 in 0 PULSE(0 10 0 0 0 5u 10u)\nR1 in out 1k DEV=5%\nC1 out 0 1u\nR2 out 0 1k DEV=5%\n.pss\n"
                ".meas pss v avg v(out)\n.wcase\n")
        self.run_it(text, "--report", "r.json")
        v = json.loads((self.folder / "r.json").read_text())["worst_case"]["results"][0]
        for key, r1, r2 in ("smallest", 1.05, 0.95), ("largest", 0.95, 1.05), ("nominal", 1, 1):
            self.assertAlmostEqual(v[key], 5 * r2 / (r1 + r2), delta=1e-6)

    def test_a_run_that_fails_is_in_the_table(self):
        text = ("t\n.param x={aunif(1,2)}\nV1 in 0 10\nR1 in a 1k DEV=10%\nC1 a 0 {x*1u}\n.tran 1u 10u\n"
                ".meas tran v max v(in)\n.wcase\n")
        rows = self.rows(text, status=1)
        self.assertEqual(len(rows), 1 + 4 + 2 + 4)
        bad = [row for row in rows if row["error"]]
        self.assertEqual(len(bad), 3)
        for row in rows:
            self.assertEqual(bool(row["error"]), row["x"] < 0)
            self.assertEqual(math.isnan(row["v"]), row["x"] < 0)
            self.assertIn("cannot be negative" if row["x"] < 0 else "", row["error"])
        said = self.run_it(text, status=1).stderr
        self.assertIn("3 of 11 runs of .wcase failed, the first where\n  x = -1\n", said)

    def test_threads_change_no_byte(self):
        """A rectifier with 6 tolerances, whose table and report do not depend on the number of threads."""
        text = ("t\nV1 in 0 SIN(0 10 50) \nD1 in out DM\n.model DM D(vfwd=0.7 DEV=10% Ron=10m DEV=20%)\n"
                "C1 out 0 47u DEV=20%\nR1 out 0 1k DEV=5%\nR2 out m 10 LOT=5%\nC2 m 0 {x*1u} DEV=10%\n"
                ".param x={aunif(1,0.5)}\n.tran 10u 60m uic\n.meas tran vlow min v(out) from=40m\n"
                ".meas tran never when v(out)=99\n.wcase\n")
        tables, reports = [], []
        for jobs in "1", "2", "5":
            self.run_it(text, "--jobs", jobs, "--report", "r.json")
            tables.append((self.folder / "m.csv").read_bytes())
            reports.append(json.loads((self.folder / "r.json").read_text())["worst_case"])
        self.assertEqual(len(tables[0].splitlines()), 1 + 1 + 14 + 4 + 128)
        self.assertEqual((tables[1], reports[1]), (tables[0], reports[0]))
        self.assertEqual((tables[2], reports[2]), (tables[0], reports[0]))

    def test_interrupted(self):
        """Ctrl-C ends the runs of all threads, of which there are 4122."""
        parts = "".join(f"D{k} in n{k}\nR{k} n{k} 0 1k DEV=5%\nC{k} n{k} 0 20u\n" for k in range(12))
        (self.folder / "a.cir").write_text(f"t\nV1 in 0 SIN(0 10 50)\n{parts}.tran 1u 5\n"
                                           ".meas tran x max v(n1)\n.wcase\n.end\n")
        for jobs in "1", "3":
            with subprocess.Popen([PROGRAM, "run", "a.cir", "-q", "-o", "none", "--measures", "m.csv", "--jobs", jobs],
                                  cwd=self.folder, stderr=subprocess.PIPE, text=True) as run:
                time.sleep(0.5)  # all of them take seconds
                run.send_signal(signal.SIGINT)
                _, said = run.communicate(timeout=60)
            self.assertEqual(run.returncode, -signal.SIGINT, said)
            self.assertIn("interrupted", said)

    def test_table(self):
        said = self.run_it(DIVIDER + ".wcase\n").stdout
        table = said[said.index("worst cases"):].splitlines()
        self.assertEqual(table[0], "worst cases of 5 tolerances, by 49 runs with all corners")
        self.assertEqual(table[2].split(), ["vend", "6.24561", "6.66667", "7.04762"])
        self.assertEqual(table[3].split(), ["r1", "1050", "1000", "950", "6.77966", "6.55738"])
        self.assertEqual(table[4].split(), ["lot(r)", "1", "0", "-1", "6.71141", "6.62252"])

    # ---- What is refused ----

    def test_messages(self):
        cards = {
            "R9 in 0 1k DEV": "the size of this tolerance is missing",
            "R9 in 0 1k DEV=-5%": "a tolerance cannot be negative",
            "R9 in 0 1k DEV=five": "'five' is no number",
            "R9 in 0 1k LOT/cauchy=5%": "there is no distribution 'cauchy'",
            "R9 in 0 1k DEV=5% DEV=3%": "a second DEV of the same value",
            "C9 in 0 1u IC=0 DEV=5%": "a tolerance of 'c9' is of its value, not of 'ic'",
            "V9 b 0 SIN(0 1 50) DEV=5%\nR9 b 0 1": "this tolerance is of a value that is no number",
            "B9 b 0 V=v(in) DEV=5%\nR9 b 0 1": "'b9' has no value that could have a tolerance",
            "D9 in 0 dm DEV=5%\n.model dm D(vfwd=20)": "'d9' has no value that could have a tolerance",
            "D9 in 0 dm\n.model dm D(DEV=5%)": "this tolerance follows no parameter",
            ".wcase\n.wcase": "a second .wcase",
            ".wcase vary all": "expected 'dev', 'lot' or 'both'",
            ".wcase corners=some": "expected 'yes' or 'no'",
            ".wcase\n.mc 10": "a worst case belongs to one circuit, and .step and .mc make several",
            ".distribution d (-1,1) (1,1)": "distributions by tables are not supported",
        }
        for card, wanted in cards.items():
            with self.subTest(card):
                said = self.run_it(DIVIDER + card + "\n", status=3).stderr
            self.assertIn(wanted, said, card)
            self.assertRegex(said, "a.cir:1[12]:.*error")
        self.assertIn("nothing that .wcase varies has a tolerance",
                      self.run_it("t\nV1 a 0 1\nR1 a 0 1\n.op\n.meas op x max v(a)\n.wcase\n", status=3).stderr)
        self.assertIn("nothing is measured",
                      self.run_it("t\nV1 a 0 1\nR1 a 0 1 DEV=5%\n.op\n.wcase\n", status=3).stderr)
        self.assertIn("what .wcase looks at in PSpice is ignored",
                      self.run_it(DIVIDER + ".wc tran v(out) ymax vary both hi\n").stderr)

    def test_nodes_may_have_these_names(self):
        rows = self.rows("t\nV1 dev 0 10\nR1 dev lot 1k\nR2 lot 0 1k\nE1 o 0 lot 0 2\nR3 o 0 1k\n.op\n"
                         ".meas op x find v(o)\n.step R1 list 1k 3k\n")
        self.assertEqual([row["x"] for row in rows], [10, 5])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
