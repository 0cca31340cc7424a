#!/usr/bin/env python3
"""Checks tables of many variants: the same bytes for any number of threads and parts, what fails, what ends them early.

usage: variants.py PROGRAM [LIBRARY]     (of crash_at.c)
"""

import csv
import json
import math
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
CRASH = str(pathlib.Path(sys.argv[2]).resolve()) if len(sys.argv) > 2 else None

CIRCUIT = """a rectifier with loads that may be impossible
.options dialect=ltspice
.param load=1 c=10u
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 {c}
R1 out 0 {load}
.tran 10u 40m uic
.meas tran vlow min v(out) from=20m
.meas tran top max v(out)
.step param c list 10u 20u -1u
.step param load list 100 0 1k 2k 10k
.end
"""

MANY = CIRCUIT.replace("10u 20u -1u", "10u 20u").replace("list 100 0 1k 2k 10k", "1k 4k 0.5")
SLOW = MANY.replace("10u 40m", "10u 4")


class Variants(unittest.TestCase):
    def setUp(self):
        # pylint: disable-next=consider-using-with
        self.kept = tempfile.TemporaryDirectory(prefix="dalcs-variants-")
        self.addCleanup(self.kept.cleanup)
        self.folder = pathlib.Path(self.kept.name)
        self.write(CIRCUIT)

    def write(self, text):
        (self.folder / "a.cir").write_text(text)

    def command(self, name, *more):
        return [PROGRAM, "run", "a.cir", "-q", "-o", "none", "--measures", name, *more]

    def run_it(self, name, *more, status=0, **how):
        done = subprocess.run(self.command(name, *more), cwd=self.folder, capture_output=True, text=True,
                              check=False, **how)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr

    def text(self, name):
        return (self.folder / name).read_text()

    def rows(self, name):
        return list(csv.DictReader(self.text(name).splitlines()))

    def test_failures_are_in_the_table(self):
        said = self.run_it("m.csv", status=1)
        rows = self.rows("m.csv")
        self.assertEqual(list(rows[0]), ["c", "load", "vlow", "top", "error"])
        self.assertEqual([(row["c"], row["load"]) for row in rows],
                         [(c, load) for load in ("100", "0", "1000", "2000", "10000")
                          for c in ("1e-05", "2e-05", "-1e-06")])
        for row in rows:
            wanted = "a capacitance cannot be negative" if row["c"].startswith("-") else \
                "no solution exists" if row["load"] == "0" else ""
            self.assertIn(wanted, row["error"])
            self.assertEqual(wanted == "", row["error"] == "")
            self.assertEqual(math.isnan(float(row["top"])), wanted != "")
            if wanted == "":
                self.assertAlmostEqual(float(row["top"]), 10.0, delta=1e-9)
        self.assertIn("7 of 15 variants failed", said)
        self.assertEqual(sorted(os.listdir(self.folder)), ["a.cir", "m.csv"])

    def test_a_run_with_waveforms_goes_on(self):
        """Its table is that of the run without them, its rows those of each step alone, and the report says which failed."""
        done = subprocess.run([PROGRAM, "run", "a.cir", "-o", "a.csv", "-o", "a.raw", "--measures", "w.csv",
                               "--report", "a.json"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 3)  # of the first that fails, with a capacitance below 0
        self.assertIn("this was step 3 of 15: c = -1e-06, load = 100", done.stderr)
        self.assertNotIn("partial", done.stderr)
        self.assertIn("c = 1e-05, load = 0: failed, from t = 0 on no solution exists", done.stdout)
        self.run_it("m.csv", status=1)
        self.assertEqual(self.text("w.csv"), self.text("m.csv"))
        with open(os.path.join(self.folder, "a.json"), encoding="utf-8") as report:
            failed = json.load(report)["failed_steps"]
        self.assertEqual([step["number"] for step in failed], [3, 4, 5, 6, 9, 12, 15])
        rows = [row for row in self.rows("w.csv") if row["error"] == ""]
        self.assertEqual(len(rows), 8)
        of_all = self.rows("a.csv")
        for row in rows:
            mine = [list(other.values())[2:] for other in of_all
                    if other["c"] == row["c"] and other["load"] == row["load"]]
            subprocess.run([PROGRAM, "run", "a.cir", "-q", "-o", "one.wave.csv", "--only", str(1 + self.rows("w.csv").index(row))],
                           cwd=self.folder, check=True)
            self.assertEqual(mine, [list(other.values())[2:] for other in self.rows("one.wave.csv")])
        header, _, points = (self.folder / "a.raw").read_bytes().partition(b"Binary:\n")
        fields = dict(line.split(": ", 1) for line in header.decode().splitlines() if ": " in line)
        self.assertEqual(int(fields["No. Points"]), len(of_all))
        self.assertEqual(len(points), 8 * int(fields["No. Variables"]) * len(of_all))

    def test_of_many_that_fail_a_few_are_told(self):
        self.write(CIRCUIT.replace("100 0 1k 2k 10k", "0").replace("list 10u 20u -1u", "-30u 30u 1u"))
        done = subprocess.run([PROGRAM, "run", "a.cir", "-o", "a.raw"], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 3)
        self.assertEqual(done.stderr.count("this was step"), 10)
        self.assertIn("61 of 61 steps failed, the first 10 as told above", done.stderr)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "a.raw")))  # there is nothing in it

    def test_each_row_is_what_a_run_alone_gives(self):
        self.run_it("m.csv", status=1)
        for row in self.rows("m.csv"):
            if row["error"] == "":
                cards = [card for card in CIRCUIT.splitlines() if not card.startswith(".step")]
                self.write("\n".join(cards))
                self.run_it("one.csv", "--set", f"c={row['c']}", "--set", f"load={row['load']}")
                one = self.rows("one.csv")[0]
                self.assertEqual([row[name] for name in one], list(one.values()))

    def test_what_is_kept_changes_no_byte(self):
        """Of an inverter, whose modes are factored by KLU: each variant is what its own process gives, also behind those
        that are other circuits (a load of 0, no load), whose patterns are others."""
        text = (pathlib.Path(__file__).parents[2] / "netlists" / "converters" / "inverter_three_phase.cir").read_text()
        for old, new in (("RA A1 N 10", "RA A1 N {LOAD}"), ("100M UIC", "60M UIC"), (".PROBE V(A,B) V(A,N) I(LA)", (
                ".PARAM LOAD=10\n.MEAS TRAN IRMS RMS I(LA) FROM=40M\n.MEAS TRAN VMAX MAX V(A,N) FROM=40M\n"
                ".STEP PARAM LOAD LIST 10 11 0 12 1G 10"))):
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write(text)
        self.run_it("m.csv", "--jobs", "1")
        whole = self.text("m.csv").splitlines()
        self.assertEqual(len(whole), 7)
        self.assertEqual(whole[1], whole[6])
        for k in range(1, 7):
            self.run_it("one.csv", "--only", str(k))
            self.assertEqual(self.text("one.csv").splitlines()[1], whole[k])

    def test_threads_and_parts_change_no_byte(self):
        self.run_it("m.csv", "--jobs", "1", status=1)
        for jobs in "2", "5", "40":
            self.run_it("n.csv", "--jobs", jobs, status=1)
            self.assertEqual(self.text("n.csv"), self.text("m.csv"))
        for parts in 1, 2, 4, 15, 20:
            joined = ""
            for k in range(1, parts + 1):
                done = subprocess.run(self.command(f"p{k}.csv", "--shard", f"{k}/{parts}"), cwd=self.folder,
                                      capture_output=True, check=False)
                self.assertIn(done.returncode, (0, 1))
                head, _, rest = self.text(f"p{k}.csv").partition("\n")
                joined = joined or head + "\n"
                joined += rest
            self.assertEqual(joined, self.text("m.csv"))

    def test_steps_of_steps(self):
        """Values that follow from another stepped parameter are those of the netlist, in every thread and part."""
        cards = ".param load=1k c=10u top={3*load}\n"
        self.write(MANY.replace(".param load=1 c=10u\n", cards).replace("1k 4k 0.5", "{load} {top} {load}"))
        self.run_it("m.csv", "--jobs", "1")
        rows = self.rows("m.csv")
        self.assertEqual([(row["c"], row["load"]) for row in rows],
                         [(c, load) for load in ("1000", "2000", "3000") for c in ("1e-05", "2e-05")])
        for jobs in "2", "4":
            self.run_it("n.csv", "--jobs", jobs)
            self.assertEqual(self.text("n.csv"), self.text("m.csv"))
        for k in range(1, 7):
            self.run_it("p.csv", "--shard", f"{k}/6")
            self.assertEqual(self.text("p.csv").splitlines()[1], self.text("m.csv").splitlines()[k])
        self.run_it("w.csv", "--only", "6")
        self.assertEqual(self.text("w.csv").splitlines()[1], self.text("m.csv").splitlines()[6])

    def test_more_variants_than_one_session_takes(self):
        self.write(MANY.replace("1k 4k 0.5", "1k 1.3k 1"))
        self.run_it("one.csv", "--jobs", "1")
        self.run_it("many.csv", "--jobs", "3")
        self.assertEqual(len(self.rows("one.csv")), 602)
        self.assertEqual(self.text("one.csv"), self.text("many.csv"))

    def test_resume(self):
        self.run_it("m.csv", status=1)
        whole = self.text("m.csv").splitlines(keepends=True)
        for n, more in (0, ""), (1, ""), (4, ""), (9, "1e-05,2"), (16, ""):
            (self.folder / "n.csv").unlink(missing_ok=True)
            (self.folder / "n.partial.csv").write_text("".join(whole[:n]) + more)
            self.run_it("n.csv", "--resume", status=1)
            self.assertEqual(self.text("n.csv"), "".join(whole))
        before = (self.folder / "n.csv").stat().st_mtime_ns
        self.run_it("n.csv", "--resume")
        self.assertEqual((self.folder / "n.csv").stat().st_mtime_ns, before)

    def test_rows_that_exist_are_not_run_again(self):
        self.run_it("m.csv", status=1)
        whole = self.text("m.csv").splitlines(keepends=True)
        marked = whole[1].rsplit(",", 1)[0] + ",marked\n"
        (self.folder / "n.partial.csv").write_text(whole[0] + marked)
        self.run_it("n.csv", "--resume", status=1)
        self.assertEqual(self.text("n.csv"), whole[0] + marked + "".join(whole[2:]))
        (self.folder / "n.partial.csv").write_text(whole[0] + marked)
        self.run_it("n.csv", status=1)  # without --resume all are run
        self.assertEqual(self.text("n.csv"), "".join(whole))

    def test_another_table_is_not_gone_on_with(self):
        for text in ("c,load,other,error\n", "c,load,vlow,top,error\n1e-05,101,1,2,\n"):
            (self.folder / "n.partial.csv").write_text(text)
            said = self.run_it("n.csv", "--resume", status=2)
            self.assertIn("'n.partial.csv' is a table of other variants", said)
            self.assertEqual(self.text("n.partial.csv"), text)

    def interrupt(self, number):
        """Ends a run when its first rows are there; its partial table stays."""
        with subprocess.Popen(self.command("n.csv", "--jobs", "2"), cwd=self.folder, stderr=subprocess.PIPE,
                              text=True) as run:
            partial = self.folder / "n.partial.csv"
            while run.poll() is None and not (partial.exists() and partial.read_text().count("\n") > 3):
                time.sleep(0.01)
            run.send_signal(number)
            said = run.communicate()[1]
        self.assertFalse((self.folder / "n.csv").exists())
        return said

    def test_ended_from_outside(self):
        for number in signal.SIGINT, signal.SIGTERM, signal.SIGKILL:
            self.write(SLOW)
            said = self.interrupt(number)
            if number != signal.SIGKILL:
                self.assertRegex(said, r"interrupted after \d+ of 12002 variants, which are in 'n.partial.csv'")
            kept = self.text("n.partial.csv")
            self.assertGreater(kept.count("\n"), 3)
            lines = kept.splitlines(keepends=True)[:4]
            # the rest takes too long: the last steps alone, of which the first rows are those
            self.write(SLOW.replace("1k 4k 0.5", "1k 1002 0.5"))
            (self.folder / "n.partial.csv").write_text("".join(lines))
            self.run_it("n.csv", "--resume")
            self.run_it("m.csv")
            self.assertEqual(self.text("n.csv"), self.text("m.csv"))
            (self.folder / "n.csv").unlink()

    def test_a_full_disk(self):
        """Here: a bound on the size of files."""
        self.write(MANY.replace("1k 4k 0.5", "1k 1.3k 1"))
        self.run_it("m.csv")

        def limit():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (9999, 9999))

        # pylint: disable-next=subprocess-popen-preexec-fn
        said = self.run_it("n.csv", status=4, preexec_fn=limit)
        self.assertIn("cannot write 'n.partial.csv': File too large", said)
        self.assertIn("--resume goes on", said)
        self.assertTrue(self.text("m.csv").startswith(self.text("n.partial.csv")))
        self.run_it("n.csv", "--resume")
        self.assertEqual(self.text("n.csv"), self.text("m.csv"))

    def test_two_at_a_time(self):
        self.write(SLOW)
        with subprocess.Popen(self.command("n.csv"), cwd=self.folder, stderr=subprocess.DEVNULL) as first:
            while not (self.folder / "n.partial.csv").exists() or not self.text("n.partial.csv"):
                time.sleep(0.01)
            self.assertIn("another run is writing 'n.partial.csv'", self.run_it("n.csv", status=4))
            first.send_signal(signal.SIGINT)

    def test_what_makes_no_sense(self):
        for option, wanted in ((("--shard", "0/4"), "K from 1 to N"), (("--shard", "5/4"), "K from 1 to N"),
                               (("--shard", "3"), "3/16"), (("--shard", "-1/2"), "3/16"),
                               (("--jobs", "0"), "from 1 on"),
                               (("--resume", "--report", "r.json"), "no other result"),
                               (("--jobs", "2", "-o", "a.csv"), "choose one")):
            self.assertIn(wanted, self.run_it("m.csv", *option, status=2))
        self.assertIn("nowhere/m.partial.csv", self.run_it("nowhere/m.csv", status=4))
        (self.folder / "folder.csv").mkdir()
        self.assertIn("Is a directory", self.run_it("folder.csv", status=4))
        self.write("\n".join(card for card in CIRCUIT.splitlines() if not card.startswith(".step")))
        self.assertIn("has no .step", self.run_it("m.csv", "--shard", "1/2", status=2))

    @unittest.skipUnless(shutil.which("parallel"), "GNU parallel is not installed")
    def test_gnu_parallel(self):
        """Parts by GNU parallel; one is killed in the middle, which costs the others nothing and is gone on with."""
        self.write(MANY)
        self.run_it("whole.csv")
        (self.folder / "part.sh").write_text(
            '#!/bin/sh\nif [ "$1" = 2 ] && [ -n "$KILL" ]; then ulimit -f 8; fi\n'  # blocks of 512 bytes: SIGXFSZ
            f'exec {PROGRAM} run a.cir -q -o none --jobs 1 --resume --shard "$1/4" --measures "part.$1.csv"\n')
        command = ["parallel", "--will-cite", "-j", "2", "sh", "part.sh", "{}", ":::", "1", "2", "3", "4"]
        killed = subprocess.run(command, cwd=self.folder, env={**os.environ, "KILL": "1"}, check=False,
                                capture_output=True, text=True)
        self.assertEqual(killed.returncode, 1, killed.stderr)  # of the jobs that failed
        self.assertTrue((self.folder / "part.2.partial.csv").exists())
        kept = (self.folder / "part.2.partial.csv").read_text().splitlines()
        self.assertGreater(len(kept), 10)
        for k in 1, 3, 4:
            self.assertTrue((self.folder / f"part.{k}.csv").exists())
        again = subprocess.run(command, cwd=self.folder, check=True, capture_output=True, text=True)
        self.assertEqual(again.stderr, "")
        parts = [self.text(f"part.{k}.csv").splitlines(True) for k in (1, 2, 3, 4)]
        self.assertEqual("".join(parts[0] + parts[1][1:] + parts[2][1:] + parts[3][1:]), self.text("whole.csv"))
        self.assertEqual(parts[1][:len(kept) - 1], [line + "\n" for line in kept[:-1]])

    @unittest.skipIf(CRASH is None, "crashes are what a sanitizer is for")
    def test_crashes(self):
        """A fault, abort() and an overflow of the stack: the row says so, all others are what they are."""
        self.write(CIRCUIT.replace(".param load=1 c=10u", ".param load=1 c={1u*exp(x)} x=1 r={1k+flat(1)}")
                   .replace("{load}", "{r}").replace(".step param load list 100 0 1k 2k 10k\n", "")
                   .replace("param c list 10u 20u -1u", "param x 5 9 0.05"))
        self.run_it("whole.csv")
        whole = self.text("whole.csv").splitlines()
        environment = {**os.environ, "LD_PRELOAD": CRASH}
        for more in ("--jobs", "2"), ("--jobs", "1"), ("--shard", "1/1"):
            said = self.run_it("m.csv", *more, status=1, env=environment)
            self.assertEqual(said.count("a variant crashed: its row says so, the others go on"), 3)
            self.assertIn("3 of 81 variants failed", said)
            rows = self.text("m.csv").splitlines()
            self.assertEqual(len(rows), len(whole))
            for before, row in zip(whole, rows):
                reason = {"7.25": "Segmentation fault", "7.5": "Aborted", "7.75": "Segmentation fault"}.get(
                    row.split(",")[0])
                if reason is None:
                    self.assertEqual(row, before)
                else:
                    x, *values, error = row.split(",")
                    self.assertEqual((x, set(values)), (before.split(",")[0], {"nan"}))
                    self.assertEqual(error, "the program crashed here: " + reason)
        self.assertEqual([path.name for path in self.folder.glob("*crashed")], [])
        done = subprocess.run([*self.command("m.csv", "--only", "46")], cwd=self.folder, env=environment, check=False,
                              capture_output=True)
        self.assertEqual(done.returncode, -signal.SIGSEGV)  # one alone is no table: the crash is there to be looked at

    def test_a_signal_that_is_sent_is_no_crash(self):
        self.write(SLOW)
        with subprocess.Popen(self.command("m.csv"), cwd=self.folder) as process:
            while not (self.folder / "m.partial.csv").exists():
                time.sleep(0.01)
            time.sleep(0.05)
            process.send_signal(signal.SIGSEGV)
            self.assertEqual(process.wait(timeout=60), -signal.SIGSEGV)
        self.assertFalse((self.folder / "m.csv").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
