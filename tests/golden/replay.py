#!/usr/bin/env python3
"""A step that has no certified answer leaves its problem in a file, which tools/replay solves again.

usage: replay.py DALCS REPLAY
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

HARD = pathlib.Path(__file__).resolve().parents[2] / "netlists" / "hard"
REFUSED = {"hc11b": "no solution exists: loop v1, d1\n",
           "hc11c": "no solution exists: cutset i1, d1\n",
           "hc28b": "no solution exists: no mode of d1, d2\n"}
OK, FAILED, USAGE, DAMAGED, INPUT_OUTPUT = range(5)
DALCS = REPLAY = ""


class Replay(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def start(self, program, *arguments, expect):
        done = subprocess.run([program, *map(str, arguments)], cwd=self.folder, check=False,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, expect, done.stderr)
        return done

    def refuse(self, name, *options):
        """Runs an infeasible circuit; its error messages."""
        return self.start(DALCS, "run", HARD / f"{name}.cir", "--quiet", *options,
                          expect=FAILED).stderr

    def replay(self, name, expect):
        return self.start(REPLAY, name, expect=expect)

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def test_default_name(self):
        """Beside the first output, whose name it takes; even --quiet says where."""
        for name in REFUSED:
            self.assertIn(f"'{name}.failed.dalcs'", self.refuse(name))
        self.assertEqual(self.files(), [f"{name}.failed.dalcs" for name in sorted(REFUSED)])
        (self.folder / "results").mkdir()
        self.refuse("hc11b", "-o", "results/out.csv", "-o", "other.raw")
        self.assertEqual([path.name for path in (self.folder / "results").iterdir()],
                         ["out.failed.dalcs"])

    def test_same_verdict(self):
        for name, verdict in REFUSED.items():
            self.refuse(name, "--dump", "it.dalcs")
            done = self.replay("it.dalcs", FAILED)
            self.assertIn(verdict, done.stdout)
            self.assertRegex(done.stdout, rf"{name}\.cir (at|from) ")
            self.assertEqual(self.files(), ["it.dalcs"])

    def test_no_witness(self):
        """What no witness confirms is not said to have no solution, here as there."""
        netlist = pathlib.Path(__file__).parents[1] / "refusals" / "unfound_in_a_crowd.cir"
        said = self.start(DALCS, "run", netlist, "-q", "--dump", "it.dalcs", expect=FAILED).stderr
        text = self.replay("it.dalcs", FAILED).stdout
        for words in (said, text):
            self.assertIn("a solution may exist, but none was found: ", words)
            self.assertNotIn("no solution exists", words)

    def test_names_and_residuals(self):
        self.refuse("hc28b", "--method", "euler", "--dump", "it.dalcs")
        text = self.replay("it.dalcs", FAILED).stdout
        for piece in [r"2 states, 6 algebraic unknowns, 2 pairs, 2 sources; not passive",
                      r"h = 0\.001 s", r"state +c2 +-1 V before", r"current of +vs1 ",
                      r"diode +d1 +o", r"KCL at +z1 .* of .* A", r"branch +vs2 .* V"]:
            self.assertRegex(text, piece)

    def test_made_solvable(self):
        """The file is the problem: 1 V the other way round, and there is an answer."""
        self.refuse("hc11b", "--dump", "it.dalcs")
        path = self.folder / "it.dalcs"
        text = path.read_text()
        self.assertIn("sigma 0\nu 1\nu 1\n", text)
        path.write_text(text.replace("sigma 0\nu 1\nu 1\n", "sigma 0\nu 1\nu -1\n"))
        done = self.replay("it.dalcs", OK)
        self.assertIn("verdict   certified: ", done.stdout)
        self.assertRegex(done.stdout, r"node +1 +-1 V\n")
        self.assertRegex(done.stdout, r"diode +d1 +o.+ -> off +0 A +1 V\n")

    def test_damaged(self):
        self.refuse("hc28b", "--dump", "it.dalcs")
        whole = (self.folder / "it.dalcs").read_text()
        cut = self.folder / "cut.dalcs"
        for length in range(0, len(whole) - len("end\n"), 7):
            cut.write_text(whole[:length])
            done = self.replay("cut.dalcs", DAMAGED)
            self.assertRegex(done.stderr, r"^cut\.dalcs:\d+: error: expected ")
        cut.write_text(whole.replace("pair diode", "pair 0", 1))
        wrong_line = whole[:whole.index("pair diode")].count("\n") + 1
        self.assertIn(f"cut.dalcs:{wrong_line}: error: expected diode, breakdown or switch, "
                      "not '0'", self.replay("cut.dalcs", DAMAGED).stderr)

    def test_no_file(self):
        self.assertIn("'nowhere': No such file", self.replay("nowhere", INPUT_OUTPUT).stderr)
        self.assertIn("usage:", self.start(REPLAY, expect=USAGE).stderr)

    def test_unwritable(self):
        """The verdict is what matters: it comes whatever happens to the dump."""
        (self.folder / "taken").mkdir()
        for path, reason in [("nowhere/it.dalcs", "No such file"), ("taken", "Is a directory")]:
            errors = self.refuse("hc11b", "--dump", path)
            self.assertIn("loop v1, d1", errors)
            self.assertIn(f"could not be written to '{path}': {reason}", errors)
            self.assertEqual(self.files(), ["taken"])

    def test_not_over_the_netlist(self):
        text = (HARD / "hc11b.cir").read_text()
        (self.folder / "a.cir").write_text(text)
        done = self.start(DALCS, "run", "a.cir", "--dump", "./a.cir", expect=USAGE)
        self.assertIn("is the netlist itself", done.stderr)
        done = self.start(DALCS, "run", "a.cir", "--dump", "a.csv", "-o", "a.csv", expect=USAGE)
        self.assertIn("given for two results", done.stderr)
        self.assertEqual((self.folder / "a.cir").read_text(), text)
        self.assertEqual(self.files(), ["a.cir"])

    def test_no_file_without_failure(self):
        text = (HARD / "hc11b.cir").read_text().replace("DC 1", "DC -1")
        (self.folder / "a.cir").write_text(text)
        self.start(DALCS, "run", "a.cir", "-q", "--dump", "it.dalcs", expect=OK)
        self.assertEqual(self.files(), ["a.cir", "a.raw"])


if __name__ == "__main__":
    DALCS, REPLAY = (str(pathlib.Path(argument).resolve()) for argument in sys.argv[1:3])
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
