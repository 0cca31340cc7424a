#!/usr/bin/env python3
"""dalcs plot from outside: every format, what is refused and how, and that a file that could not be
finished is not there.

usage: program.py DALCS
"""

import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.dom.minidom
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUCK = ROOT / "netlists" / "converters" / "buck.cir"
OK, RUN_FAILED, USAGE, NETLIST, INPUT_OUTPUT = range(5)
DALCS = ""


def unpacked(pdf):
    """A PDF, and what its compressed streams hold: in a later version of Cairo that is where its pages are."""
    content = pdf.read_bytes()
    parts = [content]
    for stream in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", content, re.DOTALL):
        try:
            parts.append(zlib.decompressobj().decompress(stream))
        except zlib.error:
            pass  # a font, or no such stream
    return b"\n".join(parts)


class Plot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.holder = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.holder.name)
        cls.run_program("run", BUCK, "-o", "buck.raw", "-o", "buck.csv", "--report", "buck.json",
                        "-q")

    @classmethod
    def tearDownClass(cls):
        cls.holder.cleanup()

    @classmethod
    def run_program(cls, *arguments, netlist="", **environment):
        return subprocess.run([DALCS, *map(str, arguments)], cwd=cls.folder, capture_output=True,
                              text=True, check=False, input=netlist,
                              env={**os.environ, "LC_ALL": "C.UTF-8", **environment})

    def plot(self, *arguments, status=OK, **environment):
        done = self.run_program("plot", *arguments, **environment)
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done

    def refused(self, *arguments, status=USAGE):
        """The message; no file may be left."""
        before = sorted(os.listdir(self.folder))
        done = self.plot(*arguments, status=status)
        self.assertEqual(sorted(os.listdir(self.folder)), before)
        self.assertEqual(done.stdout, "")
        return done.stderr

    def texts(self, path):
        """What is written in an SVG."""
        document = xml.dom.minidom.parse(str(self.folder / path))
        found = []
        for node in document.getElementsByTagName("text"):
            parts = []
            stack = [node]
            while stack:
                top = stack.pop(0)
                if top.nodeType == top.TEXT_NODE:
                    parts.append(top.data)
                stack = list(top.childNodes) + stack
            found.append("".join(parts).strip())
        return found

    def need_gnuplot(self):
        if not shutil.which("gnuplot"):
            self.skipTest("gnuplot is not installed")

    def test_panels_by_units(self):
        self.need_gnuplot()
        done = self.plot("buck.raw", "-s", "v(out),v(out)*i(l1)", "-s", "i(l1)", "--from", "0.95m",
                         "-o", "a.svg")
        self.assertEqual(done.stdout, "wrote a.svg\n")
        texts = self.texts("a.svg")
        for text in ["Buck converter in continuous conduction", "voltage (V)", "power (W)",
                     "current (A)", "time (ms)", "v(out)*i(l1)", "s1", "d1", "conducts"]:
            self.assertIn(text, texts)
        self.assertNotIn("v(sw)", texts)
        self.assertNotIn("d1 off, s1 on", texts)
        again = self.plot("buck.raw", "-s", "v(out),v(out)*i(l1)", "-s", "i(l1)", "--from", "0.95m",
                          "-o", "b.svg", "-q")
        self.assertEqual(again.stdout, "")
        self.assertEqual((self.folder / "a.svg").read_bytes(), (self.folder / "b.svg").read_bytes())

    def test_events_of_a_report(self):
        self.need_gnuplot()
        if "without the library" in self.run_program("plot", "buck.csv", "--report",
                                                     "buck.json").stderr:
            self.skipTest("built without jansson")
        self.plot("buck.csv", "--report", "buck.json", "--events", "--from", "0.985m", "-o", "c.svg")
        texts = self.texts("c.svg")
        self.assertIn("d1 off, s1 on", texts)
        self.assertIn("buck.csv", texts)  # a table has no title
        self.plot("buck.csv", "--events", "--no-bars", "-o", "d.svg")
        texts = self.texts("d.svg")
        self.assertTrue(any(text.endswith("events: too many to mark") for text in texts), texts)
        self.assertNotIn("conducts", texts)

    def test_what_a_bar_says(self):
        """A diode conducts. A relay and a pair of a system file, whose lambda may be a voltage, are on."""
        self.need_gnuplot()
        for name, says, not_so in (("papers/bt10_fig_2_1.cir", "conducts", "on"), ("papers/bt10_fig_2_1.dalcs", "on", "conducts"),
                                   ("relays/relay.cir", "on", "conducts"), ("converters/inverter_three_phase.cir", "conducts", "on")):
            self.run_program("run", ROOT / "netlists" / name, "-o", "bar.raw", "--report", "bar.json", "-q")
            if "without the library" in self.run_program("plot", "bar.raw", "--report", "bar.json").stderr:
                self.skipTest("built without jansson")
            self.plot("bar.raw", "--report", "bar.json", "-o", "bar.svg")
            texts = self.texts("bar.svg")
            self.assertIn(says, texts, name)
            self.assertNotIn(not_so, texts, name)

    def test_a_long_title_stays_on_the_page(self):
        """At 0.54 em for a character, in pixels of SVG, of PNG at 96 and of PDF at 100 in an inch."""
        program = self.folder / "bin" / "gnuplot"
        program.parent.mkdir()
        program.write_text("#!/bin/sh\ncat >script.txt\n", encoding="utf-8")
        program.chmod(0o755)
        self.run_program("run", "-", "-o", "long.raw", "-q", netlist="a " * 60 + "\nR1 a 0 1\nV1 a 0 1\n.tran 1u 1m\n")
        for name, em in [("t.svg", 18.0), ("t.png", 20.0), ("t.pdf", 20.9)]:
            self.run_program("plot", "long.raw", "--width", "800", "-o", name, PATH=f"{program.parent}:/usr/bin:/bin")
            text, left = re.search(r"^set label 1 '(.*)' at screen ([\d.]+),",
                                   (self.folder / "script.txt").read_text(encoding="utf-8"), re.MULTILINE).groups()
            self.assertTrue(text.endswith("\u2026"), text)
            self.assertLess(float(left) * 800 + 0.54 * em * len(text), 810, name)
            self.assertGreater(float(left) * 800 + 0.6 * em * len(text), 790, name)

    def test_real_and_imaginary_parts(self):
        (self.folder / "parts.csv").write_text("frequency,re(v(a)),im(v(a))\n1,1,0\n2,0.5,-0.5\n", encoding="utf-8")
        self.assertIn("note: these are real and imaginary parts; from a .raw file", self.plot("parts.csv").stderr)
        self.assertEqual(self.plot("parts.csv", "-s", "re(v(a))").stderr, "")

    def test_formats(self):
        self.need_gnuplot()
        for name, start in [("e.PNG", b"\x89PNG\r\n\x1a\n"), ("e.pdf", b"%PDF-")]:
            self.plot("buck.raw", "-o", name, "--theme", "dark")
            self.assertTrue((self.folder / name).read_bytes().startswith(start))
        self.plot("buck.raw", "--theme", "dark", "-o", "e.svg")
        self.assertTrue('fill="#16181c"' in (self.folder / "e.svg").read_text())

    def test_peaks_of_many_rows(self):
        """Of a million rows each peak is in the picture, which stays small."""
        self.need_gnuplot()
        n = 1_000_000
        header = (f"Title: many\nPlotname: Transient Analysis\nFlags: real\nNo. Variables: 2\n"
                  f"No. Points: {n}\nVariables:\n\t0\ttime\ttime\n\t1\tv(a)\tvoltage\nBinary:\n")
        rows = bytearray(struct.pack("=2d", 0.0, 1.0) * n)
        for k in range(n):
            struct.pack_into("=d", rows, 16 * k, k * 1e-9)
        struct.pack_into("=d", rows, 16 * 123_456 + 8, 5.0)
        (self.folder / "many.raw").write_bytes(header.encode() + rows)
        self.plot("many.raw", "-o", "many.svg")
        svg = (self.folder / "many.svg").read_text()
        self.assertLess(len(svg), 200_000)
        self.assertIn("5", self.texts("many.svg"))
        shown = self.plot("many.raw")
        self.assertIn("5 V", shown.stdout)

    def test_theme_for_paper(self):
        """No colour is in it, and lines have patterns."""
        self.plot("buck.raw", "-s", "v(sw),v(out),i(l1),v(sw)-v(out)", "--theme", "print", "-o",
                  "paper.svg")
        svg = (self.folder / "paper.svg").read_text()
        colours = set(re.findall(r"rgb\( *(\d+), *(\d+), *(\d+)\)", svg))
        colours |= {tuple(str(int(word[k:k + 2], 16)) for k in (0, 2, 4))
                    for word in re.findall(r"#([0-9a-f]{6})", svg)}
        self.assertTrue(colours)
        self.assertTrue(all(max(map(int, c)) - min(map(int, c)) <= 10 for c in colours), colours)
        self.assertIn("stroke-dasharray", svg)

    def test_rounding_is_not_magnified(self):
        """Less than a femtovolt is drawn as 0."""
        rows = "".join(f"{k * 1e-3},{(-1) ** k * 8e-17}\n" for k in range(100))
        (self.folder / "nothing.csv").write_text("time,v(a)\n" + rows)
        self.plot("nothing.csv", "-o", "nothing.svg")
        texts = self.texts("nothing.svg")
        self.assertIn("voltage (V)", texts)
        self.assertIn("0.4", texts)

    def test_system_without_units(self):
        """A position is no voltage; a file that names units keeps them."""
        for name, quantity in [("hsw99_unilateral", "value"), ("units", "voltage (V)")]:
            system = pathlib.Path(BUCK).parents[1] / "papers" / "hsw99_unilateral.dalcs"
            if name == "units":
                system = self.folder / "units.dalcs"
                system.write_text("dalcs-system 2 x\nstate x V 1\nmatrix A\n+ -1\n.tran 10m 1\n")
            subprocess.run([DALCS, "run", system, "-o", "system.raw", "--plot", "run.svg", "-q"],
                           cwd=self.folder, check=True)
            self.plot("system.raw", "-o", "later.svg")
            for picture in "run.svg", "later.svg":
                self.assertIn(quantity, self.texts(picture))
                self.assertEqual("voltage (V)" in self.texts(picture), name == "units")

    def test_terminal(self):
        shown = self.plot("buck.raw", COLUMNS="60").stdout
        lines = shown.splitlines()
        self.assertEqual(lines[0], "Buck converter in continuous conduction")
        self.assertTrue(all(len(line) <= 60 for line in lines))
        self.assertIn("6.061 V", shown)
        self.assertIn("\u28ff", shown)
        self.assertNotIn("\033", shown)
        plain = self.plot("buck.raw", LC_ALL="C").stdout
        self.assertTrue(plain.isascii())

    def test_several_plots_and_runs(self):
        two = ("Title: t\nPlotname: {}\nFlags: real\nNo. Variables: 2\nNo. Points: 3\nVariables:\n"
               "\t0\tv1\tvoltage\n\t1\ti(r1)\tcurrent\nValues:\n")
        values = "0 0\n 7\n1 1\n 8\n2 {}\n 9\n"
        (self.folder / "two.raw").write_text(two.format("first") + values.format(2)
                                             + two.format("second") + values.format(0))
        done = self.plot("two.raw")
        self.assertIn("this is plot 2 of 2, second; --plot N draws another", done.stderr)
        self.assertIn("v1 starts again: this is the first of 2 runs; --run N", done.stderr)
        self.assertEqual(self.plot("two.raw", "--plot", "1").stderr, "")
        self.assertIn("one row", self.refused("two.raw", "--run", "2"))
        self.assertIn("has 2 runs: there is no run 3", self.refused("two.raw", "--run", "3"))
        self.assertIn("there is no plot 3", self.refused("two.raw", "--plot", "3"))

    def test_a_response(self):
        """Magnitudes in dB over phases in degrees, where nobody says what is drawn; of a loop its gain."""
        (self.folder / "rc.cir").write_text("t\nV1 in 0 AC 1\nR1 in out 1k\nC1 out 0 1u\n.ac dec 10 1 100k\n.end\n")
        self.run_program("run", "rc.cir", "-o", "rc.raw", "-q")
        self.plot("rc.raw", "-o", "rc.svg", "-q")
        texts = self.texts("rc.svg")
        for text in "db(v(out))", "phase(v(out))", "magnitude (dB)", "phase (\u00b0)", "frequency (Hz)", "-60":
            self.assertIn(text, texts)
        self.assertNotIn("voltage (V)", texts)
        self.plot("rc.raw", "-s", "v(out)", "-o", "rc.svg", "-q")
        self.assertIn("voltage (mV)", self.texts("rc.svg"))
        loop = (self.folder / "rc.raw").read_bytes().replace(b"v(out)", b"loop(v)")
        (self.folder / "loop.raw").write_bytes(loop)
        self.plot("loop.raw", "-o", "loop.svg", "-q")
        self.assertIn("db(loop(v))", self.texts("loop.svg"))
        self.assertNotIn("db(v(in))", self.texts("loop.svg"))

    def test_gaps(self):
        """No line leads over what has no value, in a run and in a family."""
        value = ("1", "inf", "3", "4", "nan", "nan", "6", "-inf", "2", "5", "1", "1")
        (self.folder / "gaps.csv").write_text("time,v(a)\n" + "".join(f"{k},{v}\n" for k, v in enumerate(value)))
        (self.folder / "two.csv").write_text("load,time,v(a)\n" + "".join(
            f"{load},{k},{v}\n" for load in (1, 2) for k, v in enumerate(value)))
        self.plot("gaps.csv", "-o", "gaps.svg", "-q")
        drawn = re.findall(r"<path stroke='rgb\(  0, 114, 178\)'\s+d='([^']*)'", (self.folder / "gaps.svg").read_text())
        # Two points that stand alone draw nothing; the legend's line besides.
        ends = [line.count("L") for line in " ".join(drawn).split("M") if "L" in line]
        self.assertEqual(ends, [1, 1, 3], drawn)
        self.plot("two.csv", "--family", "-s", "v(a)", "-o", "family.svg", "-q")
        text = (self.folder / "family.svg").read_text()
        self.assertEqual(len([line for path in re.findall(r" d='(M[^']*)'", text) for line in path.split("M")
                              if line.count("L") == 3]), 2)
        self.assertIn("one picture at a time: -o 'a.svg' and -o 'b.html'", self.refused("gaps.csv", "-o", "a.svg", "-o", "b.html"))

    def test_spectrum(self):
        self.plot("buck.raw", "-s", "v(sw)", "--from", "0.9m", "--spectrum", "1meg", "-o", "spectrum.svg", "-q")
        texts = self.texts("spectrum.svg")
        self.assertIn("v(sw)", texts)
        self.assertTrue(any(text.startswith("frequency (") for text in texts), texts)
        self.assertIn("Hz", self.plot("buck.csv", "--spectrum", "1meg").stdout)
        self.assertIn("the lowest frequency of this range is",
                      self.refused("buck.raw", "--spectrum", "1", "-o", "x.svg"))
        self.assertIn("more than 20000 frequencies", self.refused("buck.raw", "--spectrum", "1t", "-o", "x.svg"))
        self.assertIn("leave out --report", self.refused("buck.raw", "--spectrum", "1meg", "--events"))

    def test_histogram(self):
        (self.folder / "runs.csv").write_text("run,ripple,error\n" + "".join(f"{k},{k * k},\n" for k in range(99)) +
                                              '99,nan,"from t = 0 on no solution exists, ""d1"""\n')
        self.plot("runs.csv", "-s", "ripple", "--histogram", "-o", "histogram.svg", "-q")
        texts = self.texts("histogram.svg")
        self.assertIn("number of runs", texts)
        self.assertTrue(any(text.startswith("ripple") for text in texts), texts)
        self.assertIn("not waveforms", self.refused("buck.raw", "-s", "v(out)", "--histogram", "-o", "x.svg"))
        self.assertIn("not both", self.refused("runs.csv", "--histogram", "--spectrum", "1k"))

    def test_width(self):
        """A narrow picture has smaller panels, the same texts of the same size, and all of them inside."""
        sizes = {}
        for width in (400, 640, 1200, 4000):
            self.plot("buck.raw", "-s", "v(sw),v(out)", "-s", "i(l1)", "--width", str(width), "-o", "w.svg", "-q")
            drawn = (self.folder / "w.svg").read_text()
            found, height = re.search(r'<svg\s+width="(\d+)" height="(\d+)"', drawn).groups()
            self.assertEqual(int(found), width)
            sizes[width] = int(height), set(re.findall(r'font-size="([\d.]+)"', drawn))
            for x in re.findall(r'transform="translate\(([\d.]+),', drawn):
                self.assertLessEqual(float(x), width)
            self.assertIn("v(sw)", self.texts("w.svg"))
        self.assertEqual(len({fonts for fonts in map(frozenset, (fonts for _, fonts in sizes.values()))}), 1)
        self.assertLess(sizes[640][0], 0.7 * sizes[1200][0])
        self.plot("buck.raw", "--width", "600", "-o", "w.pdf", "-q")
        self.assertRegex(unpacked(self.folder / "w.pdf"), rb"/MediaBox \[ ?0 0 432 ")  # 6 inches
        for arguments, message in [(["--width", "399", "-o", "x.svg"], "'399' is not from 400 to 4000"),
                                   (["--width", "4001", "-o", "x.svg"], "'4001' is not from 400 to 4000"),
                                   (["--width", "wide", "-o", "x.svg"], "'wide' is not a number"),
                                   (["--width", "640"], "give -o a name that ends in .svg"),
                                   (["--width", "640", "-o", "x.html"], "--width is for pictures")]:
            self.assertIn(message, self.refused("buck.raw", *arguments), arguments)

    def test_tornado(self):
        """Of .wcase each value at its ends; of other tables a plane, which fits these rows exactly."""
        rows = [(k % 7, k * k % 5, k % 3) for k in range(40)]
        (self.folder / "plane.csv").write_text(
            "run,a,b,c,y,error\n" + "".join(f"{k},{a},{b},{c},{3 + 2 * a - b},\n" for k, (a, b, c) in enumerate(rows)) +
            '40,1,2,3,nan,"no solution, again"\n')
        said = self.plot("plane.csv", "-s", "y", "--tornado=c,b,a").stdout.splitlines()
        mean = [sum(row[i] for row in rows) / 40 for i in range(3)]
        middle = 3 + 2 * mean[0] - mean[1]
        bars = [line.split() for line in said]
        self.assertEqual([bar[0] for bar in bars], ["y", "a", "b", "c"])
        for bar, (low, high) in zip(bars[1:], [(2 * (0 - mean[0]), 2 * (6 - mean[0])), (mean[1], mean[1] - 4), (0, 0)]):
            self.assertAlmostEqual(float(bar[1]), middle + low, delta=1e-5)
            self.assertAlmostEqual(float(bar[2]), middle + high, delta=1e-5)
        (self.folder / "worst.csv").write_text(
            "r1,lot(rb),y,z,error\n1000,0,5,1,\n950,0,6,1,\n1050,0,4,1,\n1000,-1,5.5,1,\n1000,1,nan,1,no solution\n"
            "1050,0,4,1,\n950,-1,7,1,\n1000,0,5,1,\n1000,0,5,1,\n")
        bars = [line.split() for line in self.plot("worst.csv", "-s", "Y", "--tornado").stdout.splitlines()]
        self.assertEqual([bar[:3] for bar in bars[1:]], [["r1", "6", "4"], ["lot(rb)", "5.5", "nan"]])
        self.plot("worst.csv", "-s", "y", "--tornado", "-o", "tornado.svg", "-q")
        texts = self.texts("tornado.svg")
        for text in "r1 (950 to 1.05 k)", "lot(rb) (-1 to 1)", "low end", "high end", "y", "worst.csv":
            self.assertIn(text, texts)
        self.plot("worst.csv", "-s", "y", "--tornado", "-o", "t.html", "-q")
        page = (self.folder / "t.html").read_text()
        self.assertTrue("<svg" in page and "low end" in page)
        self.plot("worst.csv", "-s", "y", "--tornado", "-o", "t.png", "-q", "--theme", "dark")
        self.assertTrue((self.folder / "t.png").read_bytes().startswith(b"\x89PNG"))
        for arguments, message in [
                (["plane.csv", "-s", "y", "--tornado"], "say which columns are values: --tornado=r1,c1"),
                (["worst.csv", "-s", "r1", "--tornado"], "'r1' is one of the values that .wcase has varied"),
                (["plane.csv", "-s", "yy", "--tornado=a"], "the table has no column 'yy'"),
                (["plane.csv", "-s", "y", "--tornado=a,bb"], "the table has no column 'bb'"),
                (["plane.csv", "-s", "y", "--tornado=a,b,a"], "'a' is constant in the table, or follows from"),
                (["worst.csv", "-s", "y", "--tornado=z"], "'z' is constant in the table"),
                (["plane.csv", "--tornado=a"], "a tornado chart shows one column"),
                (["plane.csv", "-s", "y", "--tornado=a", "--family"], "--tornado or --family, not both"),
                (["plane.csv", "-s", "y", "--tornado=a", "--events"], "leave out --report and --events")]:
            self.assertIn(message, self.refused(*arguments), arguments)
        (self.folder / "few.csv").write_text("a,b,c,y\n" + "1,2,3,4\n2,2,1,4\n0,1,1,1\n")
        self.assertIn("3 runs are too few to tell the effects of 3 values apart",
                      self.refused("few.csv", "-s", "y", "--tornado=a,b,c"))

    def test_family(self):
        """All steps over each other, from the raw file and from the table, in which the axis comes after the steps."""
        (self.folder / "step.cir").write_text("steps\n.options dialect=ltspice\nV1 in 0 SIN(0 10 50)\nD1 in out\n"
                                              "C1 out 0 {c}\nR1 out 0 1k\n.param c=1u\n.tran 100u 60m uic\n"
                                              ".step R1 list 100 10k\n.step param c list 10u 20u\n.end\n")
        self.run_program("run", "step.cir", "-q", "-o", "step.raw", "-o", "step.csv")
        for name in "step.raw", "step.csv":
            self.plot(name, "-s", "v(in,out)", "--family", "-o", "family.svg", "-q")
            texts = self.texts("family.svg")
            for text in "r1", "time (ms)", "v(in,out) (V)":
                self.assertIn(text, texts)
            self.plot(name, "-s", "i(d1)", "--family=c", "--from", "20m", "-o", "family.svg", "-q")
            texts = self.texts("family.svg")
            for text in "c (1e-6)", "i(d1) (mA)", "10", "20", "60":
                self.assertIn(text, texts)
            drawn = (self.folder / "family.svg").read_text()
            self.assertGreaterEqual(drawn.count("gnuplot_plot_"), 4)
            for arguments, message in [
                    (["--family=in", "-s", "v(out)", "-o", "x.svg"], "the file has no column 'in'"),
                    (["--family=v(in)", "-s", "v(out)", "-o", "x.svg"], "'v(in)' does not have one value in each run"),
                    (["--family", "-o", "x.svg"], "a family shows one signal"),
                    (["--family", "-s", "v(out)"], "a family of curves is not drawn as text"),
                    (["--family", "-s", "v(no)", "-o", "x.svg"], "no signal 'v(no)'")]:
                self.assertIn(message, self.refused(name, *arguments), arguments)
        self.assertIn("a family needs several runs, and the file has 1",
                      self.refused("buck.raw", "-s", "v(out)", "--family", "-o", "x.svg"))
        self.assertIn("the first of 4 runs", self.plot("step.csv", "-s", "v(out)").stderr)

    def test_refusals(self):
        for arguments, status, message in [
                (["buck.raw", "-s", "v(ot)"], USAGE, "no signal 'v(ot)'; did you mean 'v(out)'?"),
                (["buck.raw", "-s", "v(out"], USAGE, "')' is missing"),
                (["buck.raw", "--from", "2m"], USAGE, "the file goes from 0 s to 1 ms"),
                (["buck.raw", "--from", "2u", "--to", "1u"], USAGE, "the range is empty"),
                (["buck.raw", "--from", "x"], USAGE, "--from: 'x' is not a number"),
                (["buck.raw", "-o", "a.gif"], USAGE, "name it .svg, .png, .pdf or .html"),
                (["buck.raw", "--theme", "red"], USAGE, "not light, dark or print"),
                (["buck.raw", "--theme", "dark"], USAGE, "--theme is for pictures and pages"),
                (["buck.raw", "--theme", "print", "-o", "a.html"], USAGE, "a page is light or dark"),
                (["buck.raw", "--run", "0"], USAGE, "--run: '0' is not a number from 1 on"),
                (["buck.raw", "--sinals", "a"], USAGE, "did you mean '--signals'?"),
                (["buck.raw", "-s"], USAGE, "option '-s' needs a value"),
                (["buck.raw", "b.raw"], USAGE, "'b.raw' is one too many"),
                ([], USAGE, "no file given"),
                ([BUCK], USAGE, "holds no waveforms"),
                (["buck.raw", "--report", BUCK], USAGE, "is no report of dalcs run"),
                (["buck.raw", "--report", "no.json"], INPUT_OUTPUT, "cannot read 'no.json'"),
                (["no.raw"], INPUT_OUTPUT, "cannot read 'no.raw': No such file"),
                (["buck.raw", "-o", "no/a.png"], INPUT_OUTPUT, "cannot write 'no/a.png'"),
                (["buck.raw", "-o", "no/a.html"], INPUT_OUTPUT, "cannot write 'no/a.html'")]:
            with self.subTest(arguments=arguments):
                if "--report" in arguments and "jansson" in self.refused(
                        "buck.raw", "--report", BUCK):
                    continue
                self.assertIn(message, self.refused(*arguments, status=status))

    def test_without_gnuplot(self):
        done = self.plot("buck.raw", "-o", "g.png", status=INPUT_OUTPUT, PATH="/nowhere")
        self.assertIn("gnuplot is not installed (on Debian: apt-get install gnuplot-nox)",
                      done.stderr)
        self.assertFalse((self.folder / "g.png").exists())

    def test_full_disk(self):
        """What does not fit leaves nothing and keeps what was there."""
        (self.folder / "old.html").write_text("old")
        before = sorted(os.listdir(self.folder))
        done = subprocess.run(["bash", "-c", 'ulimit -f 100; exec "$0" plot buck.raw -o old.html',
                               DALCS], cwd=self.folder, capture_output=True, text=True, check=False)
        if "without the library" in done.stderr:
            self.skipTest("built without dygraphs")
        self.assertEqual(done.returncode, INPUT_OUTPUT, done.stderr)
        self.assertIn("cannot write 'old.html': File too large", done.stderr)
        self.assertEqual((self.folder / "old.html").read_text(), "old")
        self.assertEqual(sorted(os.listdir(self.folder)), before)

    def test_input_is_not_overwritten(self):
        shutil.copy(self.folder / "buck.csv", self.folder / "in.svg")
        self.assertIn("'./in.svg' is the input", self.refused("in.svg", "-o", "./in.svg"))

    def test_help(self):
        text = self.plot("--help").stdout
        for name in ["--signals", "--from", "--to", "--report", "--events", "--no-bars", "--theme",
                     "--plot", "--run", "--output", "--quiet"]:
            self.assertIn(name, text)


if __name__ == "__main__":
    DALCS = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
