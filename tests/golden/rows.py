#!/usr/bin/env python3
"""Which rows are written: times of --at, another .tran, and how much it will be, told before.

usage: rows.py PROGRAM
"""

import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
CIRCUIT = """a charged capacitor
V1 in 0 1
R1 in out {r}
.param r=1k
C1 out 0 1u
.tran 100u 2m uic
.meas tran vend find v(out) at=1m
.end
"""


def exact(at):
    return 1.0 - math.exp(-at / 1e-3)


class Case(unittest.TestCase):
    def setUp(self):
        # pylint: disable-next=consider-using-with
        self.kept = tempfile.TemporaryDirectory(prefix="dalcs-rows-")
        self.addCleanup(self.kept.cleanup)
        self.folder = pathlib.Path(self.kept.name)
        self.write(CIRCUIT)

    def write(self, text):
        (self.folder / "a.cir").write_text(text)

    def run_it(self, *options, status=0, verb="run"):
        done = subprocess.run([PROGRAM, verb, "a.cir", *options], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def rows(self, *options):
        """Times and v(out)."""
        self.run_it("-q", "-o", "a.csv", *options)
        names, *lines = (self.folder / "a.csv").read_text().splitlines()
        place = names.split(",").index("v(out)")
        return [(float(cells[0]), float(cells[place])) for cells in (line.split(",") for line in lines)]


class Times(Case):
    def test_listed(self):
        for options in (("--at", "0,150u,1m,2m"), ("--at", "1m", "--at", "2m,0", "--at", "150u,150u")):
            rows = self.rows(*options)
            self.assertEqual([row[0] for row in rows], [0, 150e-6, 1e-3, 2e-3])
            for at, value in rows:
                self.assertAlmostEqual(value, exact(at), delta=1e-9)
        self.assertEqual([row[0] for row in self.rows("--at", "2.0000000001m")], [2e-3])

    def test_of_a_file(self):
        """One whose name begins like a number, and beside times of the command line."""
        (self.folder / "10m.txt").write_text("# times\n1u\n\n1m other\n")
        self.assertEqual([row[0] for row in self.rows("--at", "10m.txt")], [1e-6, 1e-3])
        self.assertEqual([row[0] for row in self.rows("--at", "10m.txt", "--at", "1m,0.5m")], [1e-6, 5e-4, 1e-3])

    def test_mistakes(self):
        (self.folder / "t.txt").write_text("1m\n")
        for options, wanted in ((("--at", "3m"), "--at: 3 ms comes after the end of the run, 2 ms"),
                                (("--at", "1m,x"), "--at: 'x' is no time; write 0,10m,1"),
                                (("--at", "1m,"), "--at: '' is no time"),
                                (("--at", "-1m"), "--at: '-1m' is no time"),
                                (("--at", "t.txt", "--at", "t.txt"), "a second file of times"),
                                (("--at", "1m", "--fill", "1e-3"), "--at prints only its own times"),
                                (("--at", "1m", "--compress", "1e-3"), "--at prints each of its times")):
            self.assertIn(wanted, self.run_it(*options, status=2).stderr)
        self.assertIn("cannot read 'none.txt'", self.run_it("--at", "none.txt", status=4).stderr)


class Transient(Case):
    def test_another_end(self):
        rows = self.rows("--tstop", "500u")
        self.assertEqual((rows[0][0], rows[-1][0]), (0.0, 500e-6))
        self.assertAlmostEqual(rows[-1][1], exact(500e-6), delta=1e-9)
        self.assertAlmostEqual(self.rows("--tstop", "1m", "--set", "r=2k")[-1][1], exact(0.5e-3), delta=1e-9)

    def test_an_end_of_each_kind(self):
        """The end is the second time, or the only one; a parameter or an expression may stand there."""
        for card in ".tran 100u 2m uic", ".tran 100u {2*1m} uic", ".tran 2m uic", ".tran 100u 2m 0 10u uic":
            self.write(".options dialect=ltspice\n".join(CIRCUIT.split("\n", 1)).replace(".options", "\n.options", 1)
                       .replace(".tran 100u 2m uic", card))
            self.assertEqual(self.rows("--tstop", "0.7m")[-1][0], 0.7e-3, card)

    def test_another_card(self):
        rows = self.rows("--tran", "50u 300u uic", "--fill", "none")
        self.assertEqual(len(rows), 7)
        self.assertEqual(self.rows("--tran", ".tran 50u 300u uic", "--fill", "none"), rows)
        self.assertAlmostEqual(self.rows("--tran", "50u 300u")[0][1], 1.0, delta=1e-12)  # from the operating point
        self.write("\n".join(card for card in CIRCUIT.splitlines() if not card.startswith(".tran")))
        self.assertEqual(self.rows("--tran", "50u 300u uic", "--fill", "none"), rows)

    def test_what_a_block_runs(self):
        """`run` is of the netlist's .tran, and so are those behind the first."""
        self.write(CIRCUIT.replace(".end", ".control\nrun\nwrite b.raw v(out)\nprint time[length(time)-1]\n.endc"))
        self.assertIn("= 7.000000e-04", self.run_it("--tstop", "0.7m").stdout)
        self.write(CIRCUIT.replace(".end", ".tran 10u 5m uic"))
        self.assertEqual(self.rows("--tran", "50u 300u uic", "--fill", "none")[-1][0], 300e-6)

    def test_in_each_thread(self):
        """Of .step, whose threads read the netlist themselves."""
        self.write(CIRCUIT.replace(".end", ".step param r list 1k 2k 4k"))
        self.run_it("-q", "-o", "none", "--measures", "m.csv", "--tstop", "0.5m", "--jobs", "2")
        table = (self.folder / "m.csv").read_text().splitlines()
        self.assertEqual([line.split(",")[1] for line in table[1:]], ["nan"] * 3)
        self.run_it("-q", "-o", "none", "--measures", "m.csv", "--tstop", "1m", "--jobs", "2")
        table = (self.folder / "m.csv").read_text().splitlines()
        for line, ohm in zip(table[1:], (1, 2, 4)):
            self.assertAlmostEqual(float(line.split(",")[1]), exact(1e-3 / ohm), delta=1e-8)

    def test_mistakes(self):
        said = self.run_it("--tran", "1u -5", status=3).stderr
        self.assertRegex(said, r"--tran:1:\d+: error: the stop time must be positive")
        self.assertIn("--tstop: '0' is not a number greater than 0", self.run_it("--tstop", "0", status=2).stderr)
        self.assertIn("'dalcs envelope' has --stop", self.run_it("--tstop", "1", status=2, verb="envelope").stderr)
        self.assertIn("--tran is an option of 'dalcs run'", self.run_it("--tran", "1", status=2, verb="bode").stderr)
        self.write(CIRCUIT.replace(".end", ".control\n tran 1u 2m\n.endc"))
        self.assertIn("--tstop changes the netlist's .tran, and the .control block has 'tran 1u 2m'",
                      self.run_it("--tstop", "1m", status=2).stderr)
        self.write(CIRCUIT.replace(".tran 100u 2m uic", ".op").replace(".meas", "*"))
        said = self.run_it("--tstop", "1m", status=3).stderr
        self.assertIn("the netlist has no .tran that could end at another time", said)
        self.assertIn("--tran 'STEP STOP' makes one", said)


class Volume(Case):
    """Two signals, the time and the current of V1: 32 bytes a row in a raw file."""

    def start(self, rows, *options):
        """Runs it until the note is there, or until the first rows are, and ends it."""
        for file in self.folder.iterdir():
            file.unlink()
        self.write(CIRCUIT.replace(".tran 100u 2m", f".tran {2e-3 / (rows - 1.5)!r} 2m"))
        with subprocess.Popen([PROGRAM, "run", "a.cir", *options], cwd=self.folder, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True) as run:
            end = time.monotonic() + 60
            while time.monotonic() < end and run.poll() is None and not [
                    file for file in self.folder.iterdir() if file.name != "a.cir" and file.stat().st_size > 0]:
                time.sleep(0.005)
            run.send_signal(signal.SIGINT)
            return run.communicate()[1]

    def free(self):
        return shutil.disk_usage(self.folder).free

    def test_a_note(self):
        """From 1e9 bytes on: tested at a tenth and at ten times."""
        self.assertNotIn("will have", self.start(5_000_000))
        if self.free() < 7e9:
            self.skipTest("the disk is small")
        said = self.start(160_000_000)
        self.assertIn("note: 'a.raw' will have at least 160000000 rows of 4 values, about 5.12 GB", said)
        self.assertIn("--fill adds those", said)
        self.assertNotIn("will have", self.start(160_000_000, "-q"))
        self.assertIn("'a.csv' will have at least 30000000 rows of 4 values, about 2.16 GB",
                      self.start(30_000_000, "-o", "a.csv"))

    def test_no_room(self):
        """More than the disk has is refused before anything is written; an older file stays."""
        (self.folder / "a.raw").write_text("older")
        rows = int(3 * self.free() / 32)
        self.write(CIRCUIT.replace(".tran 100u 2m", f".tran {2e-3 / rows!r} 2m"))
        said = self.run_it(status=4).stderr
        self.assertRegex(said, r"'a.raw' would have \d+ rows of 4 values, at least [\d.]+ .B, and its disk has")
        self.assertEqual((self.folder / "a.raw").read_text(), "older")
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.cir", "a.raw"])
        self.write(CIRCUIT.replace(".tran 100u 2m", f".tran {2e-3 / (rows // 40)!r} 2m")
                   .replace(".end", ".step param r 1k 40k 1k"))
        self.assertIn("and its disk has", self.run_it(status=4).stderr)

    def test_what_is_no_disk(self):
        """Few rows of many, none at all, a device."""
        self.write(CIRCUIT.replace(".tran 100u 2m", ".tran 1e-13 2m"))
        for options in (("--at", "1m"), ("-q", "-o", "none"), ("--method", "euler", "--step", "10u")):
            self.assertNotIn("its disk has", self.run_it(*options).stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
