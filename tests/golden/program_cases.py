#!/usr/bin/env python3
"""What a person at the command line meets: options, files, messages, exit statuses.

usage: program_cases.py DALCS CLASS...
"""

import csv
import json
import os
import pathlib
import pty
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import xml.dom.minidom

RECTIFIER = """half-wave rectifier
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 100u
R1 out 0 1k
.tran 100u 40m
.end
"""
SINE = """a sine that its rows do not show
V1 a 0 SIN(0 10 50)
R1 a 0 5
.tran 10m 20m
.end
"""
BOTH = RECTIFIER.replace(".tran", ".op\n.tran")
POINT = RECTIFIER.replace("SIN(0 10 50)", "5").replace(".tran 100u 40m", ".op")
LONG = RECTIFIER.replace(".tran 100u 40m", ".tran 20u 1000 uic")  # more rows would not fit on small disks
MISTAKE = RECTIFIER.replace("1k", "abc")
# A diode that must conduct from a source into a stiffer one.
IMPOSSIBLE = """a loop of two sources and a diode
V1 a 0 5
D1 a b
V2 b 0 PULSE(10 1 1m 0 0 1 2)
R1 b 0 1k
C1 b 0 1u
.tran 100u 10m uic
.end
"""
CHARGES = """two capacitors share their charge
C1 1 0 1u ic=10
C2 2 0 3u ic=2
D1 1 2
.tran 10u 1m uic
.end
"""

OK, RUN_FAILED, USAGE, NETLIST, INPUT_OUTPUT = range(5)
DALCS = ""


class Case(unittest.TestCase):
    """A folder of its own, which is the current one of the program."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return self.folder / name

    def write(self, text, name="a.cir"):
        self.path(name).write_text(text)
        return name

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())

    def dalcs(self, *arguments, expect=OK, **options):
        done = subprocess.run([DALCS, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False, timeout=60, **options)
        self.assertEqual(done.returncode, expect, done.stderr)
        return done

    def table(self, name):
        with open(self.path(name), newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        return header, [[float(field) for field in row] for row in rows]


class Usage(Case):
    def test_help(self):
        for arguments in ["--help"], ["run", "--help"], ["run", "-h"]:
            done = self.dalcs(*arguments)
            self.assertIn("usage: dalcs", done.stdout)
            self.assertEqual(done.stderr, "")

    def test_every_option_is_in_the_help(self):
        text = self.dalcs("run", "--help").stdout
        for option in ["--output", "--method", "--tol", "--stages", "--step", "--compress", "--at", "--fill",
                       "--curve", "--report", "--plot", "--dump", "--all-signals", "--energy", "--audit", "--quiet", "--set",
                       "--measures"]:
            self.assertIn(option, text)

    def test_version(self):
        for option in "--version", "-v":
            self.assertRegex(self.dalcs(option).stdout, r"^dalcs \d+\.\d+\.\d+\n$")

    def refused(self, *arguments):
        done = self.dalcs(*arguments, expect=USAGE)
        self.assertEqual(done.stdout, "")
        self.assertTrue(done.stderr.startswith("dalcs: error: "), done.stderr)
        self.assertEqual(self.files(), ["a.cir"])
        return done.stderr

    def test_slips(self):
        self.write(RECTIFIER)
        self.assertIn("did you mean 'run'?", self.refused("rnu", "a.cir"))
        self.assertIn("did you mean '--version'?", self.refused("--versoin"))
        self.assertIn("did you mean '--step'?", self.refused("run", "a.cir", "--stepp", "1u"))
        self.assertIn("did you mean '--report'?", self.refused("run", "--repotr=r.json", "a.cir"))
        self.assertIn("'-x'", self.refused("run", "a.cir", "-x"))

    def test_values(self):
        self.write(RECTIFIER)
        self.assertIn("needs a value", self.refused("run", "a.cir", "--step"))
        self.assertIn("needs a value", self.refused("run", "a.cir", "-o"))
        self.assertIn("takes no value", self.refused("run", "a.cir", "--quiet=yes"))
        self.assertIn("'abc' is not a number", self.refused("run", "a.cir", "--step", "abc"))
        self.assertIn("greater than 0", self.refused("run", "a.cir", "--step", "0"))
        self.assertIn("greater than 0", self.refused("run", "a.cir", "--step", "-1u"))
        for option in "--tol", "--compress":
            self.assertIn(f"{option}: 'abc' is not a number",
                          self.refused("run", "a.cir", option, "abc"))
        for value in "0.9e-13", "0.11", "0", "-1u":
            self.assertIn(f"--tol: '{value}' does not lie between 1e-13 and 0.1",
                          self.refused("run", "a.cir", "--tol", value))
        for value in "0", "2", "11", "3.5", "-1", "five":
            self.assertIn(f"--stages: '{value}' is none of 1, 3, 5, 7, 9",
                          self.refused("run", "a.cir", "--stages", value))
        for value in "0", "1", "-1m":
            self.assertIn(f"--compress: '{value}' must be greater than 0 and less than 1",
                          self.refused("run", "a.cir", "--compress", value))
        for value in "0", "1", "-1m":
            self.assertIn(f"--fill: '{value}' must be greater than 0 and less than 1, or none",
                          self.refused("run", "a.cir", "--fill", value))
        self.assertIn("--curve: 'spline' is neither cubics nor lines",
                      self.refused("run", "a.cir", "--curve", "spline"))
        self.assertIn("choose one", self.refused("run", "a.cir", "--compress", "1m", "--at", "x"))
        self.assertIn("choose one", self.refused("run", "a.cir", "-o", "none", "-o", "a.csv"))
        for value in "r1", "=1", "r1=", "r1=many", "r1=nan":
            self.assertIn(f"--set: '{value}' is not NAME=NUMBER", self.refused("run", "a.cir", "--set", value))
        self.assertIn("no parameter or element 'r9'", self.refused("run", "a.cir", "--set", "r9=1"))
        self.assertIn("name it .csv", self.refused("run", "a.cir", "--measures", "m.raw"))
        self.assertIn("choose one", self.refused("run", "a.cir", "--fill", "1m", "--at", "x"))
        self.assertIn(".csv or .raw", self.refused("run", "a.cir", "-o", "out.txt"))
        self.assertIn(".svg, .png or .pdf", self.refused("run", "a.cir", "--plot", "p.gif"))
        self.assertIn("no netlist", self.refused("run"))
        self.assertIn("one too many", self.refused("run", "a.cir", "a.cir"))
        for word, meant in [("a.csv", "-o a.csv"), ("a.png", "--plot a.png"), ("1m:2m", "--losses=1m:2m"),
                            ("r1=3", "--set r1=3")]:
            self.assertIn(f"one netlist at a time: '{word}' is one too many; did you mean '{meant}'?",
                          self.refused("run", "a.cir", word))
        self.assertIn("did you mean '-o a.png'?", self.refused("plot", "a.raw", "a.png"))
        self.assertIn("did you mean '--measures'?", self.refused("run", "a.cir", "--mesures", "m.csv"))
        for word, meant in [("simulate", "run"), ("lcp", "equations"), ("version", "--version"), ("equation", "equations")]:
            self.assertIn(f"unknown verb '{word}'; did you mean '{meant}'?", self.refused(word, "a.cir"))
        self.assertIn("'dalcs run' writes its waveforms", self.refused("plot", "a.cir"))
        self.assertIn("two results", self.refused("run", "a.cir", "-o", "x.csv", "-o", "x.csv"))

    def test_a_file_that_is_not_there(self):
        """Without a verb it is a name with a dot or a slash, and no verb."""
        for name in "nowhere.cir", "in/it":
            self.assertIn(f"cannot read '{name}': No such file", self.dalcs(name, expect=INPUT_OUTPUT).stderr)
        for verb in "run", "steady", "bode", "envelope", "equations", "check", "plot":
            self.assertTrue(self.dalcs(verb, "no.cir", expect=INPUT_OUTPUT).stderr.startswith("dalcs: error: cannot read 'no.cir'"), verb)

    def test_no_ground(self):
        netlist = "A rectifier\nV1 a b SIN(0 10 50)\nD1 a p\nR1 p b 1k\n.tran 10u 20m\n.end\n"
        self.write(netlist)
        self.assertIn("no element is connected to ground: call the ground node 0 or gnd", self.dalcs("run", "a.cir").stderr)
        self.write(netlist.replace(".tran", "R2 c 0 1k\n.tran"))
        self.assertNotIn("no element is connected to ground", self.dalcs("run", "a.cir").stderr)

    def test_slips_of_system_files(self):
        self.write("x1' = -x1 + lambda\n0 <= lambda _|_ x1 >= 0\n", "mine.dalcs")
        self.assertIn("a system file begins with: dalcs-system 2 TITLE",
                      self.dalcs("run", "mine.dalcs", expect=NETLIST).stderr)
        self.write("dalcs-system 2 mine\nstate x\nP 1\n.op\n", "mine.dalcs")
        self.assertIn("write: matrix p, and its rows behind +", self.dalcs("run", "mine.dalcs", expect=NETLIST).stderr)
        self.write(RECTIFIER)
        self.assertIn("did you mean 'osnsp'?", self.dalcs("equations", "a.cir", "--form", "lcp", expect=USAGE).stderr)

    def test_one_file_for_two_results(self):
        """However it is spelled, and whether it is there or not."""
        self.write(RECTIFIER)
        here = self.folder.name
        for one, other in [("x.csv", "./x.csv"), ("x.csv", f"../{here}/x.csv"),
                           (str(self.path("x.csv")), "x.csv")]:
            self.assertIn("two results", self.refused("run", "a.cir", "-o", one, "-o", other))
            self.assertIn("two results", self.refused("run", "a.cir", "-o", one, "--report",
                                                      other))
        self.assertIn("two results", self.refused("run", "a.cir", "--report", "a.raw"))
        self.write("old", "x.csv")
        self.path("link.csv").symlink_to("x.csv")
        done = self.dalcs("run", "a.cir", "-o", "x.csv", "-o", "link.csv", expect=USAGE)
        self.assertIn("two results", done.stderr)
        self.assertEqual(self.path("x.csv").read_text(), "old")

    def test_step_and_run(self):
        self.write(RECTIFIER)
        for step, message in [("1", "longer than the run"), ("1e-30", "too small")]:
            self.assertIn(message, self.refused("run", "a.cir", "--step", step))

    def test_unknown_method(self):
        self.write(RECTIFIER)
        message = self.refused("run", "a.cir", "--method", "eluer")
        self.assertIn("unknown method 'eluer'; the methods are: auto radau lobatto euler\n", message)
        self.write(MISTAKE)  # which is not read
        self.assertEqual(self.refused("run", "a.cir", "--method", "eluer"), message)


class Results(Case):
    def test_default_output(self):
        self.path("sub").mkdir()
        self.write(RECTIFIER, "sub/bridge.v2.cir")
        self.dalcs("run", "sub/bridge.v2.cir")
        self.assertEqual(self.files(), ["bridge.v2.raw", "sub"])

    def test_csv(self):
        self.dalcs("run", self.write(RECTIFIER), "-o", "out.csv")
        header, rows = self.table("out.csv")
        self.assertEqual(header[0], "time")
        self.assertEqual(sorted(header[1:]), ["i(d1)", "i(v1)", "v(in)", "v(out)"])
        self.assertEqual(rows[0][0], 0.0)
        self.assertEqual(rows[-1][0], 0.04)
        self.assertAlmostEqual(max(row[header.index("v(out)")] for row in rows), 10.0, places=2)

    def test_formulas_alone(self):
        """What .print names are all columns, whatever its formulas are computed by."""
        for formula, name in (("{1/(2+v(in))}",) * 2, ("{v(in)*v(out)}",) * 2, ("p(r1)",) * 2, ("{v(in) - 1}", "{v(in)-1}"),
                              ("par('abs(v(out))')", "{abs(v(out))}")):
            self.write(RECTIFIER.replace(".tran", f".print tran {formula}\n.tran"))
            self.dalcs("run", "a.cir", "-o", "out.csv", "-q")
            header, _ = self.table("out.csv")
            self.assertEqual(header, ["time", name])

    def test_step_takes_suffixes(self):
        self.write(RECTIFIER)
        self.dalcs("run", "a.cir", "--method", "euler", "--step", "20us", "--report", "r.json",
                   "-q")
        report = json.loads(self.path("r.json").read_text())
        self.assertEqual(report["step"], 20e-6)
        self.assertEqual(report["work"]["steps"], 2000)

    def test_at(self):
        self.write("# times\n0\n\n1m\n2.5m ignored\n* note\n0.0333\n", "times.txt")
        self.dalcs("run", self.write(RECTIFIER), "--at", "times.txt", "-o", "out.csv")
        self.assertEqual([row[0] for row in self.table("out.csv")[1]], [0.0, 1e-3, 2.5e-3, 0.0333])
        text = self.path("out.csv").read_bytes()
        for end in b"\r\n", b"\r":
            self.path("times.txt").write_bytes(self.path("times.txt").read_bytes().replace(b"\r", b"").replace(b"\n", end))
            self.dalcs("run", "a.cir", "--at", "times.txt", "-o", "out.csv")
            self.assertEqual(self.path("out.csv").read_bytes(), text)

    def test_table_with_returns_alone(self):
        self.dalcs("run", self.write(RECTIFIER), "-o", "out.csv", "-q")
        shown = self.dalcs("plot", "out.csv").stdout
        self.path("out.csv").write_bytes(self.path("out.csv").read_bytes().replace(b"\r", b"").replace(b"\n", b"\r"))
        self.assertEqual(self.dalcs("plot", "out.csv").stdout, shown)
        self.assertIn("laws that could be checked hold", self.dalcs("audit", "a.cir", "out.csv").stdout)

    def test_runs_that_are_not_there(self):
        self.write(RECTIFIER)
        for options in (), ("--set", "r1=5"), ("--measures", "m.csv"):
            done = self.dalcs("run", "a.cir", "-o", "none", "--only", "3", *options, expect=USAGE)
            self.assertIn("error: this is one run, without .step and .mc: there is no run 3 of them", done.stderr)
        self.assertIn("no run 2", self.dalcs("steady", "a.cir", "-o", "none", "--only", "2", expect=USAGE).stderr)
        self.dalcs("run", "a.cir", "-o", "none", "--only", "1")
        self.dalcs("run", "a.cir", "-o", "out.csv", "-q")
        for command in ("plot", "out.csv"), ("audit", "a.cir", "out.csv"):
            self.assertIn("'out.csv' has 1 plot: there is no plot 2", self.dalcs(*command, "--plot", "2", expect=USAGE).stderr)
            self.dalcs(*command, "--plot", "1")

    def test_options_without_effect(self):
        many = RECTIFIER.replace(".tran", ".step r1 list 10 20 30\n.tran")
        for text, options, words in (
                (RECTIFIER, "-o out.csv --ascii", "no raw file is written: --ascii"),
                (RECTIFIER, "-o none --ascii", "no raw file is written: --ascii"),
                (RECTIFIER, "-o out.csv -o out.raw --ascii", ""),
                (many, "-o out.csv --split-steps", "no raw file is written: --split-steps"),
                (many, "-o out.raw --split-steps", ""),
                (many, "--split-steps", ""),
                (many, "-o out.raw --split-steps --only 2", "there is one run, and no step of .step: --split-steps"),
                (RECTIFIER, "-o out.raw --split-steps", "there is one run, and no step of .step: --split-steps"),
                (RECTIFIER, "-o out.csv --fill none --curve lines", "no rows are added: --curve"),
                (RECTIFIER, "-o out.csv --at 0,1m --curve cubics", "no rows are added: --curve"),
                (RECTIFIER, "-o out.csv --curve lines", ""),
                (RECTIFIER, "-o none --measures m.csv", "the netlist has no .meas: --measures"),
                (many, "-o out.csv --measures m.csv", ""),
                (RECTIFIER.replace(".tran", ".meas tran a max v(out)\n.tran"), "-o none --measures m.csv", "")):
            done = self.dalcs("run", self.write(text), "-q", *options.split())
            self.assertEqual([line for line in done.stderr.splitlines() if line.startswith("dalcs: ")],
                             [f"dalcs: warning: {words} has no effect"] if words else [], options)

    def test_fill(self):
        """Rows between those of .tran, which stay: more of them for less, for lines, and none where that is said."""
        times = {}
        for name, options in {"default": [], "coarse": ["--fill", "1m"], "fine": ["--fill", "1n"],
                              "lines": ["--curve", "lines"], "none": ["--fill", "none"]}.items():
            self.dalcs("run", self.write(SINE), "-q", "-o", "out.csv", *options)
            times[name] = [row[0] for row in self.table("out.csv")[1]]
            self.assertTrue(set(times.get("none", [])) <= set(times[name]))
        self.assertEqual(len(times["none"]), 3)
        counts = [len(times[name]) for name in ("none", "coarse", "default", "fine", "lines")]
        self.assertEqual(counts, sorted(set(counts)))
        for card, like in ((".options fill=1m", "coarse"), (".options curve=lines", "lines"),
                           (".options fill=none", "none"), (".options interp", "none")):
            self.dalcs("run", self.write(SINE.replace(".end", f"{card}\n.end")), "-q", "-o", "out.csv")
            self.assertEqual([row[0] for row in self.table("out.csv")[1]], times[like], card)
        self.dalcs("run", "a.cir", "-q", "-o", "out.csv", "--fill", "1n", "--curve", "cubics")
        self.assertEqual([row[0] for row in self.table("out.csv")[1]], times["fine"])

    def test_nothing_to_fill(self):
        """Rows of implicit Euler and of --at are what is asked for."""
        self.write(SINE.replace(".end", ".options fill=1m\n.end"))
        done = self.dalcs("run", "a.cir", "--method", "euler", "-o", "out.csv")
        self.assertIn("a.cir:5:15: note: fill has no effect with euler", done.stderr)
        self.assertEqual(len(self.table("out.csv")[1]), 3)
        self.write("0\n3m\n", "times.txt")
        done = self.dalcs("run", "a.cir", "--at", "times.txt", "-o", "out.csv")
        self.assertIn("a.cir:5:15: note: fill has no effect: only the output times", done.stderr)
        self.assertEqual(len(self.table("out.csv")[1]), 2)
        self.dalcs("run", "a.cir", "--method", "radau", "--step", "1m", "--fill", "1m", "-o", "out.csv")
        self.assertGreater(len(self.table("out.csv")[1]), 3)
        self.dalcs("run", self.write(SINE), "--method", "radau", "--step", "1m", "-o", "out.csv")
        self.assertEqual(len(self.table("out.csv")[1]), 3)
        done = self.dalcs("run", "a.cir", "--method", "euler", "--fill", "1m", expect=USAGE)
        self.assertIn("fill has no meaning with euler", done.stderr)

    def test_end_of_filling(self):
        """A file has an end, and what it lacks is said."""
        done = self.dalcs("run", self.write(SINE), "--fill", "1e-14", "--curve", "lines", "-o", "out.raw")
        self.assertRegex(done.stderr, r"note: 100000 added rows, and 4 for each row of .tran, are the limit: it is reached at t = "
                                      r"\S+ s, and no rows are added after that\n  hint: --fill")
        points = re.search(rb"No. Points: (\d+)", self.path("out.raw").read_bytes()[:1000])
        self.assertTrue(100000 < int(points[1]) < 100020, points[1])

    def test_compress(self):
        """Fewer rows, each of them one of all; an operating point keeps its own."""
        self.write(BOTH)
        self.dalcs("run", "a.cir", "-q", "--method", "euler", "-o", "all.csv")
        self.dalcs("run", "a.cir", "-q", "--method", "euler", "--compress", "10m", "-o", "few.csv",
                   "-o", "few.raw")
        header, every = self.table("all.csv")
        _, few = self.table("few.csv")
        self.assertLess(3 * len(few), len(every))
        self.assertTrue(all(row in every for row in few))
        self.assertEqual((few[0], few[-1]), (every[0], every[-1]))
        self.assertIn(b"No. Points: 1 ", self.path("few.raw").read_bytes())
        scale = [max(abs(row[k]) for row in every) for k in range(len(header))]
        after = 0
        for row in every:
            after += few[after][0] < row[0]
            one, other = few[max(after - 1, 0)], few[after]
            part = (row[0] - one[0]) / ((other[0] - one[0]) or 1.0)
            for k in range(1, len(header)):
                line = one[k] + part * (other[k] - one[k])
                self.assertLessEqual(abs(line - row[k]), 0.01 * scale[k] + 1e-15)
        self.write(BOTH.replace(".op", ".options compress=10m\n.op"), "b.cir")
        self.dalcs("run", "b.cir", "-q", "--method", "euler", "-o", "b.csv")
        self.assertEqual(self.path("b.csv").read_bytes(), self.path("few.csv").read_bytes())

    def test_compress_at_times(self):
        """Times that are asked for have their rows, whatever the netlist says."""
        self.write("0\n1m\n2m\n3m\n", "times.txt")
        self.write(RECTIFIER.replace(".tran", ".options compress=0.9\n.tran"))
        done = self.dalcs("run", "a.cir", "--at", "times.txt", "-o", "out.csv")
        self.assertIn("a.cir:6:19: note: compress has no effect: each output time gets its row\n", done.stderr)
        self.assertEqual([row[0] for row in self.table("out.csv")[1]], [0.0, 1e-3, 2e-3, 3e-3])

    def test_last_time_is_rounded(self):
        self.write("1m\n0.04000000000001\n", "times.txt")
        self.dalcs("run", self.write(RECTIFIER), "--at", "times.txt", "-o", "out.csv")
        self.assertEqual([row[0] for row in self.table("out.csv")[1]], [1e-3, 0.04])

    def test_bad_times(self):
        self.write(RECTIFIER)
        for text, message in [("0\nx\n", "times.txt:2: 'x'"), ("1m\n1m\n", "times.txt:2:"),
                              ("40m\n41m\n", "times.txt:2: '41m' comes after the end"),
                              ("-1\n", "times.txt:1:"), ("# none\n", "no times")]:
            self.write(text, "times.txt")
            done = self.dalcs("run", "a.cir", "--at", "times.txt", expect=USAGE)
            self.assertIn(message, done.stderr)
        done = self.dalcs("run", "a.cir", "--at", "nowhere.txt", expect=INPUT_OUTPUT)
        self.assertIn("'nowhere.txt': No such file", done.stderr)
        self.assertEqual(self.files(), ["a.cir", "times.txt"])

    def test_several_outputs(self):
        done = self.dalcs("run", self.write(RECTIFIER), "-o", "x.csv", "-o", "y.raw", "--report",
                          "r.json", "-o", "z.csv")
        self.assertEqual(self.files(), ["a.cir", "r.json", "x.csv", "y.raw", "z.csv"])
        self.assertEqual(self.path("x.csv").read_bytes(), self.path("z.csv").read_bytes())
        for name in "x.csv", "y.raw", "z.csv", "r.json":
            self.assertIn(f"wrote     {name}\n", done.stdout)

    def test_operating_point(self):
        done = self.dalcs("run", self.write(POINT), "-o", "out.csv")
        header, rows = self.table("out.csv")
        self.assertEqual(len(rows), 1)
        self.assertEqual(dict(zip(header, rows[0])), {"time": 0.0, "v(in)": 5.0, "v(out)": 5.0,
                                                      "i(v1)": -0.005, "i(d1)": 0.005})
        self.assertRegex(done.stdout, r"v\(out\) +5\.000  V\n")

    def test_lines_of_a_model(self):
        """The five parameters of a diode: Roff lies beside the branch of Vfwd and Ron and that of
        Vrev and Rrev. Ron and Roff of a switch are its two resistances."""
        model = "D(Ron=5 Roff=20 Vfwd=0.2 Vrev=0.5 Rrev=10)"
        for volts, amperes in [(1, 0.8 / 5 + 1 / 20), (0.1, 0.1 / 20), (-0.4, -0.4 / 20),
                               (-1, -0.5 / 10 - 1 / 20)]:
            self.write(f"line\nV1 a 0 {volts}\nD1 a 0 m\n.model m {model}\n.op\n.end\n")
            self.dalcs("run", "a.cir", "-q", "-o", "out.csv")
            header, rows = self.table("out.csv")
            self.assertAlmostEqual(rows[0][header.index("i(d1)")], amperes, places=15)
        for control, amperes in [(1, 0.2), (0, 0.05)]:
            self.write(f"two resistances\nV1 a 0 1\nVc c 0 {control}\nS1 a 0 c 0 m\n"
                       ".model m SW(Ron=5 Roff=20 Vt=0.5)\n.op\n.end\n")
            self.dalcs("run", "a.cir", "-q", "-o", "out.csv")
            header, rows = self.table("out.csv")
            self.assertAlmostEqual(rows[0][header.index("i(s1)")], amperes, places=15)

    def test_report(self):
        self.dalcs("run", self.write(CHARGES), "--method", "euler", "--report", "r.json", "-q")
        report = json.loads(self.path("r.json").read_text())
        self.assertEqual(report["status"], "ok")
        self.assertEqual(report["method"], {"component 1": "euler"})
        self.assertEqual(set(report["size"]), {"nodes", "x", "z", "lambda", "switches",
                                               "components"})
        self.assertLess(report["certificate"]["worst"], 2e-13)
        jump = report["jumps"][0]
        self.assertEqual(jump["time"], 0.0)
        self.assertEqual(jump["states"]["c1"]["before"], 10.0)
        self.assertAlmostEqual(jump["states"]["c1"]["after"], 4.0, places=12)
        self.assertAlmostEqual(jump["impulses"]["d1"]["charge"], 6e-6, places=17)
        self.assertAlmostEqual(jump["energy_lost"], 24e-6, places=16)
        self.assertAlmostEqual(report["start"]["c2"], 4.0, places=12)

    def test_same_bytes_twice(self):
        self.write(BOTH)
        environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000"}
        for name in "one", "two":
            self.dalcs("run", "a.cir", "-q", "-o", f"{name}.csv", "-o", f"{name}.raw",
                       env=environment)
        for kind in "csv", "raw":
            self.assertEqual(self.path(f"one.{kind}").read_bytes(),
                             self.path(f"two.{kind}").read_bytes())

    def test_a_file_alone_is_run(self):
        self.write(RECTIFIER)
        self.dalcs("a.cir", "-q", "-o", "one.csv")
        self.dalcs("run", "a.cir", "-q", "-o", "two.csv")
        self.assertEqual(self.path("one.csv").read_bytes(), self.path("two.csv").read_bytes())

    def test_standard_output(self):
        """- for a result: the table alone, as the file has it, and what is for people on the other stream."""
        (self.folder / "half.cir").write_text(RECTIFIER.replace(".end", ".meas tran top max v(out)\n.end"))
        run = [DALCS, "run", "half.cir"]
        subprocess.run([*run, "-q", "-o", "a.csv", "--measures", "m.csv"], cwd=self.folder, check=True)
        for option, name in (["-o", "-"], "a.csv"), (["-o", "none", "--measures", "-"], "m.csv"):
            for quiet in [], ["-q"]:
                done = subprocess.run([*run, *option, *quiet], cwd=self.folder, capture_output=True, text=True, check=True)
                self.assertEqual(done.stdout, (self.folder / name).read_text())
                self.assertEqual(done.stderr == "", bool(quiet))
        done = subprocess.run([*run, "-o", "none", "--report", "-"], cwd=self.folder, capture_output=True, text=True,
                              check=True)
        self.assertEqual(json.loads(done.stdout)["status"], "ok")
        done = subprocess.run([DALCS, "-", "-q", "-o", "-"], cwd=self.folder, capture_output=True, text=True,
                              input=RECTIFIER, check=True)
        self.assertEqual(done.stdout, (self.folder / "a.csv").read_text())
        drawn = subprocess.run([DALCS, "plot", "-", "-s", "v(out)"], cwd=self.folder, capture_output=True, text=True,
                               input=done.stdout, check=True)
        self.assertIn("v(out)", drawn.stdout)
        self.assertNotIn("-", [path.name for path in self.folder.iterdir()])
        done = subprocess.run([*run, "-o", "-", "--measures", "-"], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("'-' is given for two results", done.stderr)
        with open("/dev/full", "w", encoding="ascii") as full:
            done = subprocess.run([*run, "-q", "-o", "-"], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True,
                                  check=False)
        self.assertEqual(done.returncode, 4)
        self.assertIn("No space left on device", done.stderr)
        done = subprocess.run([DALCS, "none.cir"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (4, "dalcs: error: cannot read 'none.cir': No such file or directory\n"))

    def test_standard_input(self):
        self.path("part.inc").write_text("R1 out 0 1k\n")
        text = RECTIFIER.replace("R1 out 0 1k\n", ".include part.inc\n")
        self.write(text)
        self.dalcs("run", "a.cir", "-q", "-o", "file.csv")
        for outputs, name in ([], "stdin.raw"), (["-o", "piped.csv"], "piped.csv"):
            done = subprocess.run([DALCS, "run", "-", "-q", *outputs], input=text, text=True, cwd=self.path("."),
                                  capture_output=True, check=False)
            self.assertEqual((done.returncode, done.stderr), (OK, ""))
            self.assertIn(name, self.files())
        self.assertEqual(self.path("file.csv").read_bytes(), self.path("piped.csv").read_bytes())
        done = subprocess.run([DALCS, "run", "-"], input=MISTAKE, text=True, cwd=self.path("."),
                              capture_output=True, check=False)
        self.assertEqual(done.returncode, NETLIST)
        self.assertIn("stdin:5:10: error:", done.stderr)

    def test_set(self):
        """To the bit what the netlist with that value in its text gives."""
        self.write(RECTIFIER.replace("1k", "{load}").replace(".end", ".param load=1k\n.end"))
        self.write(RECTIFIER.replace("1k", "220").replace("100u\n", "47u\n"), "b.cir")
        self.dalcs("run", "a.cir", "-q", "-o", "a.csv", "--set", "LOAD=220", "--set", "c1=47u")
        self.dalcs("run", "b.cir", "-q", "-o", "b.csv")
        self.assertEqual(self.path("a.csv").read_bytes(), self.path("b.csv").read_bytes())
        done = self.dalcs("run", "a.cir", "-o", "none", "--set", "c1=-1u", expect=NETLIST)
        self.assertIn("cannot be negative", done.stderr)

    def test_measures(self):
        cards = ".meas tran peak max v(out)\n.meas tran low min v(out) from=20m\n.meas tran x find v(out) when v(out)=99\n"
        self.write(RECTIFIER.replace(".end", cards + ".step param load list 500 2k\n.param load=1\n.end")
                   .replace("1k", "{load}"))
        self.dalcs("run", "a.cir", "-q", "-o", "none", "--set", "c1=47u", "--measures", "m.csv")
        self.assertEqual(self.files(), ["a.cir", "m.csv"])
        rows = list(csv.reader(self.path("m.csv").read_text().splitlines()))
        self.assertEqual(rows[0], ["c1", "load", "peak", "low", "x", "error"])
        self.assertEqual([row[:2] for row in rows[1:]], [["4.7e-05", "500"], ["4.7e-05", "2000"]])
        for row in rows[1:]:
            self.dalcs("run", "a.cir", "-q", "-o", "none", "--set", "c1=47u", "--report", "r.json")
            found = json.loads(self.path("r.json").read_text())["measurements"]
            wanted = [entry["value"] for entry in found if entry["step"] == f"load = {row[1]}"]
            self.assertEqual([float(row[2]), float(row[3]), *row[4:]], [wanted[0], wanted[1], "nan", ""])

    def test_measures_of_a_failed_run(self):
        self.write(IMPOSSIBLE.replace(".end", ".meas tran x max v(b)\n.end"))
        self.path("m.csv").write_text("old")
        self.dalcs("run", "a.cir", "-q", "-o", "none", "--measures", "m.csv", expect=RUN_FAILED)
        self.assertEqual(self.path("m.csv").read_text(), "old")
        self.dalcs("run", "a.cir", "-q", "-o", "none", "--measures", "nowhere/m.csv", expect=INPUT_OUTPUT)


class Summary(Case):
    def test_text(self):
        done = self.dalcs("run", self.write(CHARGES), "--method", "euler")
        for piece in ["two capacitors share their charge\n", "2 states", "euler, step 10 us",
                      "worst residual", "signal", "v(1)",
                      "jump at t=0: c1 10 V -> 4 V, c2 2 V -> 4 V; charge through d1 6 uC; "
                      "24 uJ lost", "wrote     a.raw"]:
            self.assertIn(piece, done.stdout)

    def test_jump_without_the_still_ones(self):
        """A state that stays at 0 has rounding only, which is no jump."""
        self.write(CHARGES.replace("D1 1 2", "D1 1 2\nL1 1 0 10m ic=0"))
        self.assertIn("jump at t=0: c1 10 V -> 4 V, c2 2 V -> 4 V;",
                      self.dalcs("run", "a.cir").stdout)

    def test_measurements(self):
        done = self.dalcs("run", self.write("sine\nV1 a 0 SIN(0 10 50)\nR1 a 0 5\n"
                                            ".tran 10u 20m\n.end\n"), "--fill", "none")
        self.assertRegex(done.stdout, r"v\(a\) +-10\.00  V +10\.00  V +0\.000  V +7\.071  V "
                                      r"+0\.000  V\n")

    def test_what_is_rounding(self):
        """Averages of 4.2e-7 and 4.2e-6 of the rms, last values of 3e-10 and 3e-9 of the largest, 5 and 50 fV."""
        self.write("small\nV1 a 0 SIN(3u 10 50)\nV2 b 0 SIN(30u 10 50)\nR1 a 0 5\nR2 b 0 5\n"
                   "V3 c 0 PWL(0 0 10m 1 20m 300p)\nV4 d 0 PWL(0 0 10m 1 20m 3n)\nR3 c 0 5\nR4 d 0 5\n"
                   "V5 e 0 SIN(0 5f 50)\nV6 f 0 SIN(0 50f 50)\nR5 e 0 5\nR6 f 0 5\n"
                   ".tran 10u 20m\n.end\n")
        lines = self.dalcs("run", "a.cir", "--fill", "none").stdout.split("\n")
        table = {line.split()[0]: line for line in lines if line.startswith("  v(")}
        self.assertRegex(table["v(a)"], r"10\.00  V +0\.000  V +7\.071  V")
        self.assertRegex(table["v(b)"], r"10\.00  V +30\.00 uV +7\.071  V")
        self.assertRegex(table["v(c)"], r" 0\.000  V$")
        self.assertRegex(table["v(d)"], r" 3\.000 nV$")
        self.assertRegex(table["v(e)"], r"v\(e\)( +0\.000  V){5}$")
        self.assertRegex(table["v(f)"], r" 50\.00 fV .* 35\.36 fV ")
        self.write("steps\nV1 a 0 SIN({3u*k} 10 50)\nR1 a 0 5\n.param k=1\n.step param k list 1 10\n"
                   ".tran 10u 20m\n.end\n")
        steps = self.dalcs("run", "a.cir", "--fill", "none").stdout
        self.assertRegex(steps, r"\n +1 +0\.000  V .*\n +10 +30\.00 uV ")

    def test_quiet(self):
        done = self.dalcs("run", self.write(RECTIFIER), "--quiet")
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr, "")

    def test_notes_are_not_for_quiet(self):
        self.write(RECTIFIER.replace(".tran", ".options method=gear\n.tran"))
        self.assertIn("note: ", self.dalcs("run", "a.cir").stderr)
        self.assertEqual(self.dalcs("run", "a.cir", "-q").stderr, "")

    def test_tolerances(self):
        """One note, however many of them there are."""
        self.write(RECTIFIER.replace(".tran", ".options method=euler reltol=1e-4\n"
                                     ".options vntol=1u abstol=1p\n.tran"))
        done = self.dalcs("run", "a.cir")
        self.assertIn("a.cir:6:23: note: reltol, abstol and vntol have no effect with the fixed "
                      "step of euler\n", done.stderr)
        self.assertEqual(done.stderr.count("note: "), 1)

    def test_tolerance_without_use(self):
        self.write(RECTIFIER)
        done = self.dalcs("run", "a.cir", "--method", "euler", "--tol", "1m")
        self.assertEqual(done.stderr, "dalcs: note: a tolerance and a number of stages have no "
                         "effect with euler\n")
        done = self.dalcs("run", self.write(POINT), "-q", "--tol", "1m")
        self.assertIn("warning: the netlist has no .tran: --tol has no effect", done.stderr)

    def test_unknown_method_of_the_netlist(self):
        self.write(RECTIFIER.replace(".tran", ".options method=magic\n.tran"))
        self.assertIn("a.cir:6:17: note: method=magic has no meaning here: using auto\n",
                      self.dalcs("run", "a.cir").stderr)
        self.assertEqual(self.dalcs("run", "a.cir", "--method", "euler").stderr, "")

    def test_what_auto_chose(self):
        done = self.dalcs("run", self.write(CHARGES))
        self.assertRegex(done.stdout, r"\n  method    auto: .*: \d+ steps?\b")

    def test_switches_that_never_agree(self):
        """A switch that takes away what holds it closed, with and without another step to come."""
        flutter = ("a switch that opens itself\nV1 a 0 1\nR1 a b 1\nS1 b 0 b 0 m\n"
                   ".model m SW(Vt=0.5)\n{}\n.end\n")
        self.write(flutter.format(".op"))
        done = self.dalcs("run", "a.cir", "-q")
        self.assertEqual(done.stderr, "dalcs: warning: at the operating point 's1' and what controls it do not "
                         "agree: closed it opens, open it closes; it is left as it stood\n")
        self.write("an oscillator without an operating point\nV1 in 0 12\nS1 in a 0 o m\nD1 0 a\nL1 a o 100u\n"
                   "C1 o 0 100u\nR1 o 0 5\n.model m SW(Vt=-5 Vh=0.05)\n.tran 1u 1m\n.end\n")
        done = self.dalcs("run", "a.cir", "-q")
        self.assertRegex(done.stderr, r"^dalcs: warning: at the operating point 's1' and what controls it .*\n"
                         r"  hint: with uic, and IC= where it matters, a run starts without one\n$")
        self.write(flutter.format("C1 a c 1n\nV2 c 0 SIN(0 1 1k)\nR2 c 0 1\n.tran 100u 200u"))
        done = self.dalcs("run", "a.cir", "-q", "--method", "euler", expect=1)
        self.assertRegex(done.stderr, r"error: at t = 0.0001 s \(step 1, h = 0.0001 s\) no position of 's1' agrees "
                         r"with its control, v\(b\): where it is closed that is 0 V, and below 500 mV opens it; where "
                         r"it is open that is 1 V, and above 500 mV closes it\n")

    def test_warnings_are_for_quiet(self):
        done = self.dalcs("run", self.write(POINT), "-q", "--step", "1u")
        self.assertIn("warning: the netlist has no .tran: --step has no effect", done.stderr)

    def test_no_progress_in_a_pipe(self):
        self.assertNotIn("\r", self.dalcs("run", self.write(RECTIFIER), "--step", "50n").stderr)

    def test_many_signals(self):
        netlist = "\n".join(["ladder", "V1 n0 0 1"]
                            + [f"R{k} n{k} n{k + 1} 1" for k in range(30)]
                            + ["R99 n30 0 1", ".tran 1u 10u", ".end", ""])
        self.write(netlist)
        self.assertIn("... and 8 more: --all-signals", self.dalcs("run", "a.cir").stdout)
        done = self.dalcs("run", "a.cir", "--all-signals")
        self.assertIn("v(n30)", done.stdout)
        self.assertNotIn("more", done.stdout)

    def test_full_device(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            done = subprocess.run([DALCS, "run", self.write(RECTIFIER)], cwd=self.folder,
                                  stdout=full, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(done.returncode, INPUT_OUTPUT)
        self.assertIn("standard output: No space left", done.stderr)

    def test_reader_that_left(self):
        """As head does: there is no message, but the status says that not all was read."""
        self.write(RECTIFIER)
        self.dalcs("run", "a.cir", "-o", "a.raw")
        for command in (["run", "a.cir"], ["check", "a.cir"], ["audit", "a.cir", "a.raw"], ["equations", "a.cir"]):
            reader, writer = os.pipe()
            os.close(reader)
            done = subprocess.run([DALCS, *command], cwd=self.folder, stdout=writer, stderr=subprocess.PIPE,
                                  text=True, check=False)
            os.close(writer)
            self.assertEqual((done.returncode, done.stderr), (INPUT_OUTPUT, ""), command)


class Failures(Case):
    """A run that fails leaves what was there, and says what it leaves."""

    def test_no_netlist(self):
        done = self.dalcs("run", "nowhere.cir", "-o", "out.csv", expect=INPUT_OUTPUT)
        self.assertIn("'nowhere.cir': No such file or directory", done.stderr)
        self.path("folder").mkdir()
        done = self.dalcs("run", "folder", expect=INPUT_OUTPUT)
        self.assertIn("Is a directory", done.stderr)
        self.assertEqual(self.files(), ["folder"])

    def test_netlist_error(self):
        self.write("old", "out.csv")
        done = self.dalcs("run", self.write(MISTAKE), "-o", "out.csv", "-o", "new.raw", "--report",
                          "r.json", "--plot", "p.svg", expect=NETLIST)
        self.assertIn("a.cir:5:10: error:", done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertEqual(self.files(), ["a.cir", "out.csv"])
        self.assertEqual(self.path("out.csv").read_text(), "old")

    def test_no_analysis(self):
        done = self.dalcs("run", self.write(RECTIFIER.replace(".tran 100u 40m\n", "")),
                          expect=NETLIST)
        self.assertIn(".tran", done.stderr)
        self.assertEqual(self.files(), ["a.cir"])

    def test_over_the_netlist(self):
        self.write(RECTIFIER, "a.csv")
        done = self.dalcs("run", "a.csv", "-o", "./a.csv", expect=USAGE)
        self.assertIn("is the netlist itself", done.stderr)
        self.assertEqual(self.path("a.csv").read_text(), RECTIFIER)

    def test_default_over_the_netlist(self):
        self.write(RECTIFIER, "a.raw")
        done = self.dalcs("run", "a.raw", expect=USAGE)
        self.assertIn("is the netlist itself", done.stderr)
        self.assertEqual(self.path("a.raw").read_text(), RECTIFIER)

    def test_over_the_times(self):
        self.write("1m\n", "times.csv")
        done = self.dalcs("run", self.write(RECTIFIER), "--at", "times.csv", "-o", "./times.csv",
                          expect=USAGE)
        self.assertIn("'./times.csv' holds the times of --at", done.stderr)
        self.assertEqual(self.path("times.csv").read_text(), "1m\n")

    def test_closed_streams(self):
        """No file takes the place of a closed standard stream and gets what is meant for it."""
        nodes = range(200)  # so many that the summary does not fit into a buffer
        self.write("\n".join(["ladder", "V1 n0 0 1", *(f"R{k} n{k} n{k + 1} 1" for k in nodes),
                              "R999 n200 0 1", ".tran 1u 10u", ".end", ""]))
        self.dalcs("run", "a.cir", "-q", "-o", "good.csv")
        for closed in ">&-", "2>&-", "<&- >&- 2>&-":
            command = f"exec {DALCS!r} run a.cir -o out.csv --all-signals {closed}"
            done = subprocess.run(["sh", "-c", command], cwd=self.folder, check=False,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            self.assertEqual(done.returncode, OK if closed == "2>&-" else INPUT_OUTPUT)
            self.assertEqual(self.path("out.csv").read_bytes(),
                             self.path("good.csv").read_bytes(), closed)

    def test_unwritable(self):
        self.write(RECTIFIER)
        self.path("folder.csv").mkdir()
        for arguments in [["-o", "nowhere/out.csv"], ["-o", "folder.csv"],
                          ["--report", "nowhere/r.json"], ["--plot", "nowhere/p.svg"],
                          ["-o", "good.csv", "-o", "nowhere/out.raw"]]:
            done = self.dalcs("run", "a.cir", *arguments, expect=INPUT_OUTPUT)
            self.assertIn(f"cannot write '{arguments[-1]}'", done.stderr)
            self.assertEqual(self.files(), ["a.cir", "folder.csv"])

    def test_disk_full(self):
        """Noticed when it happens, not at the end of a run of hours."""
        self.write("old", "out.csv")

        for name, other in ("csv", "raw"), ("raw", "csv"):
            done = self.dalcs("run", self.write(LONG), "-o", f"out.{name}", "-o", f"out.{other}",
                              expect=INPUT_OUTPUT, preexec_fn=self.small_files)
            self.assertIn(f"cannot write 'out.{name}': File too large", done.stderr)
            self.assertIn("what was computed is in 'out.partial.csv'; 'out.csv' is of an earlier "
                          "run\n", done.stderr)
            self.assertIn("what was computed is in 'out.partial.raw'\n", done.stderr)
            self.assertEqual(self.files(), ["a.cir", "out.csv", "out.partial.csv",
                                            "out.partial.raw"])
            self.assertEqual(self.path("out.csv").read_text(), "old")
            self.check_partial_files()

    LIMIT = 20000

    def small_files(self):
        resource.setrlimit(resource.RLIMIT_FSIZE, (self.LIMIT, self.LIMIT))

    def check_partial_files(self):
        """They hold whole rows, as many as went onto the disk."""
        header, rows = self.table("out.partial.csv")
        self.assertTrue(all(len(row) == len(header) for row in rows))
        size = self.path("out.partial.csv").stat().st_size
        self.assertGreater(size, self.LIMIT - 200)
        self.assertLessEqual(size, self.LIMIT)
        (names, points), = Ngspice.plots(self.path("out.partial.raw").read_bytes())
        self.assertEqual(names, header)
        self.assertGreater((len(points) + 1) * len(names) * 8, self.LIMIT - 1000)
        n = min(len(rows), len(points))
        self.assertEqual([list(row) for row in points[:n]], rows[:n])

    def test_disk_full_at_the_end(self):
        """A run of so few rows that the last ones go to the disk when it is over."""
        text = RECTIFIER.replace(".tran 100u", ".tran 50u")
        for name in "csv", "raw":
            done = self.dalcs("run", self.write(text), "-q", "-o", f"out.{name}",
                              expect=INPUT_OUTPUT, preexec_fn=self.small_files)
            self.assertEqual(done.stderr, f"dalcs: error: cannot write 'out.{name}': File too "
                             f"large\ndalcs: what was computed is in 'out.partial.{name}'\n")
        self.check_partial_files()
        done = self.dalcs("run", self.write(text), "-q", "-o", "out.csv", "-o", "out.raw",
                          expect=INPUT_OUTPUT, preexec_fn=self.small_files)
        for name in "out.csv", "out.raw":
            self.assertIn(f"cannot write '{name}': File too large", done.stderr)
        self.assertEqual(self.files(), ["a.cir", "out.partial.csv", "out.partial.raw"])
        self.check_partial_files()

    def test_disk_full_in_the_second_plot(self):
        """The operating point is whole and stays."""
        self.write(BOTH)
        self.dalcs("run", "a.cir", "-q", "-o", "out.raw")
        whole = self.path("out.raw").read_bytes()
        second = whole.index(b"Title:", 1)
        rows = whole.index(b"Binary:", second) + len("Binary:\n")
        for size, lengths in (second, [1]), (rows + 39, [1]), (rows + 239, [1, 5]):
            self.LIMIT = size
            self.dalcs("run", "a.cir", "-q", "-o", "out.raw", expect=INPUT_OUTPUT,
                       preexec_fn=self.small_files)
            found = list(Ngspice.plots(self.path("out.partial.raw").read_bytes()))
            self.assertEqual([len(points) for _, points in found], lengths)
            self.assertEqual(self.path("out.raw").read_bytes(), whole)

    def test_infeasible(self):
        self.write("old", "out.csv")
        done = self.dalcs("run", self.write(IMPOSSIBLE), "-o", "out.csv", "--report", "r.json",
                          expect=RUN_FAILED)
        for element in "v1", "d1", "v2":
            self.assertIn(element, done.stderr)
        self.assertIn("'out.partial.csv'", done.stderr)
        self.assertEqual(self.files(), ["a.cir", "out.csv", "out.failed.dalcs", "out.partial.csv",
                                        "r.json"])
        self.assertEqual(self.path("out.csv").read_text(), "old")
        _, rows = self.table("out.partial.csv")
        self.assertLess(rows[-1][0], 1.1e-3)
        report = json.loads(self.path("r.json").read_text())
        self.assertNotEqual(report["status"], "ok")
        self.assertEqual(sorted(report["infeasible"]["elements"]), ["d1", "v1", "v2"])
        self.assertEqual(report["infeasible"]["kind"], "loop")

    def test_infeasible_with_fewer_rows(self):
        """What was held back when the run failed is written as well."""
        self.write(IMPOSSIBLE)
        for name, options in [("all", []), ("few", ["--compress", "0.5"])]:
            self.dalcs("run", "a.cir", "-q", "--method", "euler", "-o", f"{name}.csv", *options,
                       expect=RUN_FAILED)
        _, every = self.table("all.partial.csv")
        _, few = self.table("few.partial.csv")
        self.assertLess(len(few), len(every))
        self.assertEqual(few[-1], every[-1])

    def test_infeasible_from_the_start(self):
        text = IMPOSSIBLE.replace("PULSE(10 1 1m 0 0 1 2)", "1")
        self.dalcs("run", self.write(text), "-o", "out.csv", expect=RUN_FAILED)
        self.assertEqual(self.files(), ["a.cir", "out.failed.dalcs"])


class Interrupt(Case):
    def interrupt(self, number):
        self.write("old", "out.csv")
        self.write(LONG)
        process = subprocess.Popen([DALCS, "run", "a.cir", "-q", "-o", "out.csv", "-o", "out.raw",
                                    "--report", "r.json"], cwd=self.folder, text=True,
                                   stderr=subprocess.PIPE)
        with process:
            deadline = time.monotonic() + 60
            while time.monotonic() < deadline and not any(
                    path.stat().st_size > 1 << 20 for path in self.folder.glob("*.partial-*")):
                time.sleep(0.02)
            process.send_signal(number)
            _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, -number, errors)
        told = re.search(r"^dalcs: interrupted at t = \S+ \S?s, after (\d+) rows$", errors,
                         re.MULTILINE)
        self.assertIn("'out.partial.csv'", errors)
        self.assertEqual(self.files(), ["a.cir", "out.csv", "out.partial.csv", "out.partial.raw",
                                        "r.json"])
        self.assertEqual(self.path("out.csv").read_text(), "old")
        self.assertEqual(json.loads(self.path("r.json").read_text())["status"], "cancelled")
        header, rows = self.table("out.partial.csv")
        self.assertTrue(all(len(row) == len(header) for row in rows))
        self.assertEqual(int(told[1]), len(rows))
        raw = self.path("out.partial.raw").read_bytes()
        self.assertIn(f"No. Points: {len(rows)} ".encode(), raw)

    def test_ctrl_c(self):
        self.interrupt(signal.SIGINT)

    def test_terminate(self):
        self.interrupt(signal.SIGTERM)

    def test_while_an_operating_point_is_looked_for(self):
        n = 12  # 4096 modes for each position of the switches, none of which fits
        cards = ["not passive"]
        for k in range(n):
            cards += [f"v{k} a{k} 0 {1 + k}", f"r{k} a{k} b{k} 1k", f"d{k} b{k} c{k}", f"rn{k} c{k} 0 -{500 + 7 * k}",
                      f"e{k} x{k} 0 c{k} b{(k + 1) % n} 3", f"rx{k} x{k} b{(k + 2) % n} 300",
                      f"s{k} c{k} x{k} x{(k + 3) % n} c{(k + 5) % n} sm"]
        self.write("\n".join([*cards, ".model sm sw(ron=10 roff=1meg vt=0.7)", ".tran 1m 1", ".end", ""]))
        with subprocess.Popen([DALCS, "run", "a.cir", "-q", "-o", "none"], cwd=self.folder, text=True,
                              stderr=subprocess.PIPE) as process:
            time.sleep(2)
            process.send_signal(signal.SIGINT)
            _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, -signal.SIGINT, errors)
        self.assertIn("dalcs: interrupted at t = 0 s, after 0 rows", errors)


class Terminal(Case):
    """A run whose messages go to a terminal says how far it is, and nothing of it elsewhere."""

    def test_progress(self):
        self.write(LONG.replace("SIN(0 10 50)", "SIN(0 10 5k)"))
        master, slave = pty.openpty()
        with subprocess.Popen([DALCS, "run", "a.cir", "-o", "out.csv", "--fill", "none"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=slave, text=True) as process:
            os.close(slave)
            shown = b""
            while not re.search(rb" left\x1b", shown):
                shown += os.read(master, 4096)
            process.send_signal(signal.SIGINT)
            try:
                while True:
                    shown += os.read(master, 4096)
            except OSError:  # the terminal has no other end any more
                os.close(master)
            printed = process.communicate()[0]
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertRegex(shown, rb"^dalcs: note: .out.csv. will have at least 50000001 rows [^\n]*\n"
                         rb"\r +\d+ %  \S+ .?s of 1 ks  \S+ .?s/s  \d+ events  "
                         rb"(\d+ h )?(\d+ min )?(\d+ s )?left\x1b\[K")
        # erased before the next message
        self.assertRegex(shown, rb"\r\x1b\[Kdalcs: interrupted at t = ")
        self.assertNotIn("\r", printed)
        self.assertIn("stopped   at ", printed)


class Ngspice(Case):
    """ngspice loads the raw file and finds every value, to the last bit."""

    @staticmethod
    def plots(data):
        """(names, values by point) of each plot in a raw file."""
        place = 0
        while place < len(data):
            start = data.index(b"Binary:\n", place) + len(b"Binary:\n")
            header = data[place:start].decode().splitlines()
            fields = dict(line.split(": ", 1) for line in header if ": " in line)
            names = [line.split("\t")[2] for line in header if line.startswith("\t")]
            n = len(names) * int(fields["No. Points"])
            place = start + 8 * n
            values = struct.unpack(f"<{n}d", data[start:place])
            yield names, [values[k:k + len(names)] for k in range(0, n, len(names))]

    def test_load(self):
        if not shutil.which("ngspice"):
            self.skipTest("ngspice is not installed")
        self.dalcs("run", self.write(BOTH), "-q", "--method", "euler", "-o", "ours.raw")
        # ngspice makes the last plot of the file the current one.
        self.write("* load\n.control\nset filetype=binary\nload ours.raw\nsetplot\n"
                   "setplot tran1\nwrite tran.raw\nsetplot op1\nwrite op.raw\nquit 0\n.endc\n.end\n",
                   "load.cir")
        done = subprocess.run(["ngspice", "-n", "-b", "load.cir"], cwd=self.folder, text=True,
                              stdin=subprocess.DEVNULL, capture_output=True, check=False)
        self.assertNotIn("Error", done.stdout + done.stderr)
        self.assertNotIn("no such command", done.stdout + done.stderr)
        ours = list(self.plots(self.path("ours.raw").read_bytes()))
        self.assertEqual([len(rows) for _, rows in ours], [1, 401])
        for (names, rows), file in zip(ours, ["op.raw", "tran.raw"]):
            (their_names, their_rows), = self.plots(self.path(file).read_bytes())
            self.assertEqual(sorted(their_names), sorted(names))
            order = [their_names.index(name) for name in names]
            bits = [struct.pack(f"{len(row)}d", *row) for row in rows]
            self.assertEqual([struct.pack(f"{len(order)}d", *[row[k] for k in order])
                              for row in their_rows], bits)


class Plot(Case):
    def test_svg(self):
        if not shutil.which("gnuplot"):
            self.skipTest("gnuplot is not installed")
        name = "it's \"$(id)\" `id`; rm.svg"
        self.dalcs("run", self.write(RECTIFIER.replace("half-wave", "<half> & 'wave'")), "--plot",
                   name)
        self.assertEqual(self.files(), ["a.cir", "a.raw", name])
        document = xml.dom.minidom.parse(str(self.path(name)))
        self.assertEqual(document.documentElement.tagName, "svg")
        texts = " ".join(node.firstChild.data for node in document.getElementsByTagName("tspan")
                         if node.firstChild)
        texts += " ".join("".join(child.data for child in node.childNodes
                                  if child.nodeType == child.TEXT_NODE)
                          for node in document.getElementsByTagName("text"))
        for piece in ["<half> & 'wave' rectifier", "v(out)", "i(d1)", "voltage (V)", "time (ms)"]:
            self.assertIn(piece, texts)

    def test_png(self):
        if not shutil.which("gnuplot"):
            self.skipTest("gnuplot is not installed")
        self.dalcs("run", self.write(RECTIFIER), "-q", "--plot", "p.PNG")
        data = self.path("p.PNG").read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        # Two panels and the bar of a diode.
        self.assertEqual(struct.unpack(">II", data[16:24]), (1200, 772))

    def test_without_gnuplot(self):
        done = self.dalcs("run", self.write(RECTIFIER), "-o", "out.csv", "--plot", "p.svg",
                          expect=INPUT_OUTPUT, env={"PATH": "/nowhere"})
        self.assertIn("gnuplot is not installed (on Debian: apt-get install gnuplot-nox)",
                      done.stderr)
        self.assertEqual(self.files(), ["a.cir", "out.csv"])


if __name__ == "__main__":
    DALCS = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
