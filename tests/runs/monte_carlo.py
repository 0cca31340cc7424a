#!/usr/bin/env python3
"""Checks random values: their distributions, that they depend on seed, run and name alone, and what is said of them.

usage: monte_carlo.py PROGRAM

Seeds are fixed: a test of a distribution fails always or never.
"""

import csv
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile
import unittest

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())

DIVIDER = """a divider of parts with tolerances
.param c={mc(10u, 0.05)*one} tol=3 one=1
.func part(x) {agauss(x, x*0.05, tol)}
V1 in 0 10
R1 in out {part(1k)}
R2 out 0 {part(1k)}
X1 out 0 leg r={mc(10k, 0.1)}
X2 out 0 leg r={mc(10k, 0.1)}
.subckt leg a b r=1k
R1 a b {r}
R2 a b {gauss(1k)+1Meg}
.ends
C1 out 0 {c}
.tran 1u 3u
.meas tran vout avg v(out)
.meas tran gain param='vout/10'
.mc 40
.end
"""

# A draw of each function: R1 is the value itself, as 1 A through it gives.
KINDS = {
    "gauss(0.5)+10": ("normal", 10.0, 0.5),
    "gauss(10,0.3,3)": ("normal", 10.0, 1.0),
    "agauss(10,2,4)": ("normal", 10.0, 0.5),
    "flat(2)+10": ("uniform", 8.0, 12.0),
    "mc(10,0.2)": ("uniform", 8.0, 12.0),
    "unif(10,0.3)": ("uniform", 7.0, 13.0),
    "aunif(10,1)": ("uniform", 9.0, 11.0),
    "1+rand()": ("uniform", 1.0, 2.0),
    "table(rand(),0,1,0.5,2,1,4)": ("two lines", 1.0, 4.0),
}


def distribution(kind, a, b):
    """The cumulative distribution, mean and variance."""
    if kind == "normal":
        return lambda x: 0.5 * math.erfc(-(x - a) / b / math.sqrt(2.0)), a, b * b
    if kind == "uniform":
        return lambda x: min(1.0, max(0.0, (x - a) / (b - a))), (a + b) / 2.0, (b - a) ** 2 / 12.0
    # half of them even on (1, 2), half on (2, 4)
    return (lambda x: (x - 1.0) / 2.0 if x < 2.0 else 0.5 + (x - 2.0) / 4.0), 2.25, \
        0.5 * (7.0 / 3.0) + 0.5 * (28.0 / 3.0) - 2.25 ** 2


class MonteCarlo(unittest.TestCase):
    def setUp(self):
        # pylint: disable-next=consider-using-with
        self.kept = tempfile.TemporaryDirectory(prefix="dalcs-monte-carlo-")
        self.addCleanup(self.kept.cleanup)
        self.folder = pathlib.Path(self.kept.name)

    def run_it(self, text, *more, status=0, name="m.csv"):
        (self.folder / "a.cir").write_text(text)
        done = subprocess.run([PROGRAM, "run", "a.cir", "-q", "-o", "none", "--measures", name, *more],
                              cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr

    def table(self, text, *more, **how):
        self.run_it(text, *more, **how)
        return (self.folder / how.get("name", "m.csv")).read_text()

    def rows(self, text, *more):
        return list(csv.DictReader(self.table(text, *more).splitlines()))

    def column(self, text, name, *more):
        return [float(row[name]) for row in self.rows(text, *more)]

    def test_distributions(self):
        runs = 1500
        for formula, (kind, a, b) in KINDS.items():
            value = sorted(self.column(
                f"t\nI1 0 out 1\nR1 out 0 {{{formula}}}\n.op\n.meas op r max v(out)\n"
                f".mc {runs} seed=3\n.end\n", "r"))
            self.assertEqual(len(value), runs)
            cumulative, mean, variance = distribution(kind, a, b)
            far = max(max((k + 1) / runs - cumulative(x), cumulative(x) - k / runs)
                      for k, x in enumerate(value))
            self.assertLess(far * math.sqrt(runs), 1.63, formula)  # once in a hundred
            got = sum(value) / runs
            self.assertLess(abs(got - mean), 3.3 * math.sqrt(variance / runs), formula)
            spread = sum((x - got) ** 2 for x in value) / (runs - 1)
            self.assertLess(abs(spread / variance - 1.0), 3.3 * math.sqrt(2.0 / runs), formula)

    def test_limit_is_either_end(self):
        value = self.column("t\nI1 0 out 1\nR1 out 0 {limit(10, 2)}\n.op\n.meas op r max v(out)\n"
                            ".mc 400\n.end\n", "r")
        low = sum(abs(x - 8.0) < 1e-9 for x in value)
        self.assertEqual(low + sum(abs(x - 12.0) < 1e-9 for x in value), 400)
        self.assertLess(abs(low - 200), 3.3 * 10.0)

    def test_columns_are_what_was_drawn(self):
        rows = self.rows(DIVIDER)
        self.assertEqual(list(rows[0]), ["run", "c", "r1", "r2", "x1.r", "x1.r2", "x2.r", "x2.r2", "vout",
                                         "gain", "error"])
        for row in rows:
            part = {name: float(value) for name, value in row.items() if name != "error"}
            down = 1.0 / part["r2"] + sum(1.0 / part[n] for n in ("x1.r", "x1.r2", "x2.r", "x2.r2"))
            self.assertAlmostEqual(part["vout"], 10.0 / (1.0 + part["r1"] * down), delta=1e-9)
            self.assertTrue(9.5e-6 <= part["c"] <= 10.5e-6)

    def test_no_two_places_draw_the_same(self):
        rows = self.rows(DIVIDER.replace(".mc 40", ".mc 400"))
        scaled = {"r1": (1e3, 50 / 3), "r2": (1e3, 50 / 3), "x1.r": (1e4, 1e3 / math.sqrt(3)),
                  "x2.r": (1e4, 1e3 / math.sqrt(3)), "x1.r2": (1e6, 1e3), "x2.r2": (1e6, 1e3),
                  "c": (1e-5, 5e-7 / math.sqrt(3))}
        value = {name: [(float(row[name]) - mean) / sigma for row in rows]
                 for name, (mean, sigma) in scaled.items()}
        names = list(value)
        for k, one in enumerate(names):
            for other in names[:k]:
                product = sum(x * y for x, y in zip(value[one], value[other])) / len(rows)
                self.assertLess(abs(product), 4.0 / math.sqrt(len(rows)), (one, other))
            self.assertEqual(len(set(value[one])), len(rows))

    def test_threads_parts_and_single_runs_draw_the_same(self):
        whole = self.table(DIVIDER, "--jobs", "1")
        self.assertEqual(self.table(DIVIDER, "--jobs", "5", name="n.csv"), whole)
        head, *lines = whole.splitlines(keepends=True)
        joined = ""
        for k in 1, 2, 3:
            part = self.table(DIVIDER, "--shard", f"{k}/3", name=f"p{k}.csv")
            self.assertTrue(part.startswith(head))
            joined += part[len(head):]
        self.assertEqual(head + joined, whole)
        for k in 1, 17, 40:
            self.assertEqual(self.table(DIVIDER, "--only", str(k), name="one.csv"), head + lines[k - 1])
        (self.folder / "r.partial.csv").write_text(head + "".join(lines[:7]))
        self.assertEqual(self.table(DIVIDER, "--resume", name="r.csv"), whole)

    def test_moments_are_printed(self):
        (self.folder / "a.cir").write_text(DIVIDER)
        done = subprocess.run([PROGRAM, "run", "a.cir", "-o", "none", "--measures", "m.csv"], cwd=self.folder,
                              capture_output=True, text=True, check=True)
        head, first, second = done.stdout.splitlines()[-5:-2]
        self.assertEqual(head.split(), ["40", "runs", "mean", "sigma", "least", "largest"])
        rows = list(csv.DictReader((self.folder / "m.csv").read_text().splitlines()))
        for line in first, second:
            name, *numbers = line.split()
            value = [float(row[name]) for row in rows]
            wanted = [statistics.mean(value), statistics.stdev(value), min(value), max(value)]
            for got, exact in zip(numbers, wanted):
                self.assertAlmostEqual(float(got), exact, delta=1e-5 * abs(exact))

    def test_waveforms_change_no_value(self):
        whole = self.table(DIVIDER)
        done = subprocess.run([PROGRAM, "run", "a.cir", "-q", "-o", "a.raw", "--measures", "w.csv"],
                              cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.folder / "w.csv").read_text(), whole)

    def test_other_cards_change_no_draw(self):
        whole = self.rows(DIVIDER)
        names = ["c", "r1", "r2", "x1.r", "x1.r2", "x2.r", "x2.r2"]
        lines = DIVIDER.splitlines()
        others = (
            DIVIDER.replace("V1 in", "* a comment\nR9 in 0 {agauss(1k, 9, 3)}\nV1 in"),
            DIVIDER.replace(" out ", " exit ").replace("v(out)", "v(exit)"),
            "\n".join([lines[0], *lines[13:16], *lines[8:13], *lines[1:8], *lines[16:]]) + "\n",
            DIVIDER.replace("tol=3", "tol={1+2*u(5)} d={gauss(1)}"),
            DIVIDER.replace(".mc 40", ".mc 40\n.options reltol=1e-4"),
            DIVIDER.replace(" one=1", "").replace(".param", ".param one=1"),  # it waits no longer
        )
        for text in others:
            rows = self.rows(text)
            for row, wanted in zip(rows, whole):
                self.assertEqual([row[n] for n in names], [wanted[n] for n in names], text)

    def test_seeds(self):
        usual = self.table(DIVIDER)
        self.assertEqual(self.table(DIVIDER, "--seed", "1"), usual)
        self.assertEqual(self.table(DIVIDER.replace(".mc 40", ".mc 40\n.options seed=1")), usual)
        told = self.table(DIVIDER.replace(".mc 40", ".mc 40\n.options seed=9007199254740991"))
        self.assertNotEqual(told, usual)
        self.assertEqual(self.table(DIVIDER.replace(".mc 40", ".mc 40 seed=9007199254740991")), told)
        self.assertEqual(self.table(DIVIDER.replace(".mc 40", ".mc 40 seed=5"), "--seed", "1"), usual)
        # Seeds share no value, not even of another run
        one = set(self.column(DIVIDER, "r1"))
        self.assertFalse(one & set(self.column(DIVIDER, "r1", "--seed", "2")))

    def test_run_of_ltspice(self):
        """.step param run draws as .mc does."""
        text = DIVIDER.replace(".mc 40", ".options dialect=ltspice\n.step param run 1 40 1")
        self.assertEqual(self.table(text), self.table(DIVIDER))
        self.assertEqual(self.run_it(text), "")

    def test_other_steps_meet_the_same_parts(self):
        for cards in ".mc 5\n.step param load list 1k 2k", ".step param load list 1k 2k\n.mc 5":
            text = DIVIDER.replace(".mc 40", ".options dialect=ltspice\n.param load=1k\nR8 out 0 {load}\n" + cards)
            rows = self.rows(text)
            self.assertEqual(len(rows), 10)
            for run in range(1, 6):
                same = [row for row in rows if row["run"] == str(run)]
                self.assertEqual(sorted(row["load"] for row in same), ["1000", "2000"])
                self.assertEqual(same[0]["x1.r2"], same[1]["x1.r2"])
                self.assertNotEqual(same[0]["vout"], same[1]["vout"])
        # Without .mc each step draws anew
        rows = self.rows(DIVIDER.replace(".mc 40", ".options dialect=ltspice\n.step param run 1 5 1\n"
                                         ".step param tol list 2 3"))
        self.assertEqual(len({row["x1.r"] for row in rows}), 10)

    def test_a_parameter_is_drawn_once(self):
        rows = self.rows("t\n.param r={gauss(5)+100}\nI1 0 a 1\nR1 a b {r}\nR2 b 0 {r}\n.op\n"
                         ".meas op one max v(a,b)\n.meas op two max v(b)\n.mc 20\n.end\n")
        for row in rows:
            self.assertEqual(row["one"], row["two"])
            self.assertAlmostEqual(float(row["two"]), float(row["r"]), delta=1e-9)

    def test_formulas_draw_several_values(self):
        """V1's two draws are two values, and hold for the whole run."""
        rows = self.rows("t\nV0 c 0 1\nB1 a 0 V=V(c)*gauss(1)+V(c)*gauss(1)\nB2 b 0 V=gauss(1)*V(c)\nR1 a 0 1\n"
                         "R2 b 0 1\n.tran 1u 10u\n.meas tran low min v(a)\n.meas tran high max v(a)\n"
                         ".meas tran other max v(b)\n.mc 600\n.end\n")
        for row in rows:
            self.assertEqual(row["low"], row["high"])
        variance = sum(float(row["low"]) ** 2 for row in rows) / len(rows)
        self.assertLess(abs(variance / 2.0 - 1.0), 4.0 * math.sqrt(2.0 / len(rows)))  # 4 if they were one
        product = sum(float(row["low"]) * float(row["other"]) for row in rows) / len(rows)
        self.assertLess(abs(product), 4.0 * math.sqrt(2.0 / len(rows)))

    def test_a_condition_may_draw(self):
        rows = self.rows("t\n.param p={rand()}\n.if (p < 0.5)\nR1 a 0 {flat(1)+10}\n.else\nR2 a 0 {flat(1)+20}\n"
                         ".endif\nI1 0 a 1\n.op\n.meas op r max v(a)\n.mc 30\n.end\n")
        for row in rows:
            self.assertLess(abs(float(row["r"]) - (10.0 if float(row["p"]) < 0.5 else 20.0)), 1.0)
        self.assertGreater(len({float(row["p"]) < 0.5 for row in rows}), 1)
        # its own draw is the same whether it has to wait for a parameter or not
        text = ("t\n.param one=1\n*first\n.if (rand()*one < 0.5)\nR1 a 0 10\n.else\nR2 a 0 20\n.endif\n"
                "I1 0 a 1\n.op\n.meas op r max v(a)\n.mc 30\n.end\n")
        known = text.replace("*first", ".if (one == 2)\nR3 a 0 1\n.endif")
        value = self.column(text, "r")
        self.assertEqual(value, self.column(known, "r"))
        self.assertEqual(set(value), {10.0, 20.0})

    def test_a_variant_that_fails_keeps_its_row(self):
        text = DIVIDER.replace("part(1k)}\nR2", "part(1k)}\nC7 in 0 {limit(0,1u)}\nR2")
        self.run_it(text, status=1)
        rows = list(csv.DictReader((self.folder / "m.csv").read_text().splitlines()))
        failed = [row for row in rows if row["error"]]
        self.assertTrue(0 < len(failed) < 40)
        for row in failed:
            self.assertEqual(row["vout"], "nan")
            self.assertIn("negative", row["error"])
            self.assertEqual(row["c7"], "-1e-06")

    def test_reset_of_a_script_draws_anew(self):
        text = DIVIDER.replace(".mc 40", ".control\nrepeat 3\nrun\nprint gain\nreset\nend\n.endc")
        loops = text.replace("print gain", "print v(out)[2]")
        (self.folder / "a.cir").write_text(loops)
        done = subprocess.run([PROGRAM, "run", "a.cir"], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        printed = [line.split("=")[1].split()[0] for line in done.stdout.splitlines() if line.startswith("vout")]
        wanted = self.column(DIVIDER, "vout")[:3]
        self.assertEqual(len(printed), 3, done.stdout)
        for got, value in zip(printed, wanted):
            self.assertAlmostEqual(float(got), value, delta=1e-7)

    def test_a_command_of_a_script_runs_once(self):
        """As without .mc, and as .step is left out there."""
        text = DIVIDER.replace(".end\n", ".control\ntran 1u 3u\nprint v(out)[2]\n.endc\n.end\n")
        (self.folder / "a.cir").write_text(text)
        done = subprocess.run([PROGRAM, "run", "a.cir"], cwd=self.folder, capture_output=True, text=True,
                              check=True)
        printed = [line for line in done.stdout.splitlines() if line.startswith("v(out)[2]")]
        self.assertEqual(len(printed), 1, done.stdout)
        self.assertAlmostEqual(float(printed[0].split("=")[1]), self.column(DIVIDER, "vout")[0], delta=1e-6)

    def test_a_single_run_is_run_1(self):
        text = DIVIDER.replace(".mc 40\n", "")
        (self.folder / "a.cir").write_text(text)
        done = subprocess.run([PROGRAM, "run", "a.cir", "-o", "none", "--measures", "m.csv"], cwd=self.folder,
                              capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr.count("random values are drawn once"), 1, done.stderr)
        alone = list(csv.DictReader((self.folder / "m.csv").read_text().splitlines()))[0]
        self.assertEqual(alone["vout"], self.rows(DIVIDER)[0]["vout"])
        for cards in ".mc 3", ".options dialect=ltspice\n.step param run 1 3 1":
            (self.folder / "a.cir").write_text(text.replace(".end\n", cards + "\n.end\n"))
            for more in (), ("--jobs", "1"), ("--only", "2"):
                done = subprocess.run([PROGRAM, "run", "a.cir", "-o", "none", "--measures", "m.csv", *more],
                                      cwd=self.folder, capture_output=True, text=True, check=True)
                self.assertEqual(done.stderr, "")

    def test_messages(self):
        cards = {
            "R9 in 0 {gauss(1,2,3,4)}": "'gauss' does not take 4 arguments",
            "R9 in 0 {rand(3,4)}": "rand(x) has a value for each whole x",
            "R9 in 0 {agauss(1,2,0)}": "a value of agauss is not finite",
            "B9 in2 0 V=gauss(V(in))": "'gauss' of a voltage, a current or the time",
            ".mc": "a number of runs is missing",
            ".mc 0": "the number of runs is a whole one, from 1 to",
            ".mc 1.5": "the number of runs is a whole one, from 1 to",
            ".mc 5 seed=-2": "a seed is a whole number from 0 to 2^53",
            ".options seed=1.5": "a seed is a whole number from 0 to 2^53",
            ".sampling": "Xyce's samplings are not supported yet (.sampling)",
        }
        for card, wanted in cards.items():
            said = self.run_it(DIVIDER.replace(".mc 40", card), status=3)
            self.assertIn(wanted, said, card)
            self.assertIn("a.cir:", said)
            self.assertIn("hint", said, card)
        said = self.run_it(DIVIDER.replace(".mc 40", ".mc 3 tran v(out) ymax list"))
        self.assertIn("what .mc looks at in PSpice is ignored", said)
        said = self.run_it("t\nV1 a 0 1\nR1 a 0 1\n.op\n.meas op x max v(a)\n.mc 3\n.end\n")
        self.assertIn("nothing in the netlist is random", said)
        for option in ("--seed", "x"), ("--seed", "-3"), ("--only", "0"), ("--only", "41"):
            self.assertIn(option[0][2:], self.run_it(DIVIDER, *option, status=2).replace("no step 41", "only"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
