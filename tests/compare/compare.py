#!/usr/bin/env python3
"""dalcs compare: a planted difference is found, giving up is told, ngspice is praised where it is
better, and nothing is left behind.

usage: compare.py PROGRAM
"""

import os
import pathlib
import re
import shutil
import stat
import subprocess
import sys
import tempfile
import unittest

PROGRAM = ""
NETLISTS = pathlib.Path(__file__).resolve().parents[2] / "netlists"
HALF_WAVE = """Half wave with a capacitor
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 100u
R1 out 0 100
.tran 50u 40m uic
.save v(out) i(d1)
.end
"""
SMOOTH = """A coil and a resistor
V1 a 0 SIN(0 1 1k)
L1 a b 1m
R1 b 0 5
.tran 50u 4m uic
.save i(l1)
.end
"""
NEVER = """#!/bin/sh
echo "doAnalyses: TRAN:  Timestep too small; time = 0, timestep = 1e-20"
exit 1
"""
# The netlist is the last argument; whatever stands for R1 becomes a tenth larger.
TAMPERED = """#!/bin/sh
for last; do :; done
[ -f "$last" ] && sed -i 's/^r1 out 0 100$/r1 out 0 110/' "$last"
exec ngspice "$@"
"""


class Compare(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "tmp").mkdir()

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def pretender(self, text):
        path = self.write("pretender", text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return path

    def path_with(self, *programs):
        """A PATH where only these are found."""
        only = self.folder / "bin"
        only.mkdir()
        for program in programs:
            (only / program).symlink_to(shutil.which(program))
        return str(only)

    def compare(self, netlist, *options, status=0, **environment):
        done = subprocess.run([PROGRAM, "compare", netlist, *map(str, options)], capture_output=True,
                              text=True, check=False, cwd=self.folder,
                              env={**os.environ, "TMPDIR": str(self.folder / "tmp"), **environment})
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        self.assertEqual(list((self.folder / "tmp").iterdir()), [], "left behind")
        return done

    def test_agreement(self):
        netlist = self.write("a.cir", HALF_WAVE)
        out = self.compare(netlist, "--within", "1e-3").stdout
        self.assertIn("on the same circuit, from 0 s to 40 ms, 2 signals.", out)
        self.assertRegex(out, r"it differs by at most \d\.\de-(09|1\d) \(")
        self.assertRegex(out, r"ngspice +1\.\de-01 .* D stock; ")  # 0.8 V of 10 V
        self.assertRegex(out, r"v\(out\) +(?:9\.\d+|10) V +\d\.\de-(0[7-9]|1\d) +\d\.\de-0[4-9] +\d\.\de-0[12]\n")
        self.assertIn("dalcs by default is more exact", out)

    def test_without_a_first_time(self):
        """ngspice has no .tran of one time, and 0 is no step for it."""
        netlist = self.write("a.cir", SMOOTH.replace(".tran 50u 4m", ".tran 4m"))
        self.compare(netlist, "--within", "1e-3")

    def test_planted_difference(self):
        netlist = self.write("a.cir", HALF_WAVE)
        done = self.compare(netlist, "--with", self.pretender(TAMPERED), "--within", "1e-3",
                            status=1)
        found = re.search(r"not within 0.001: dalcs is off by \S+, ngspice by (\S+)\n", done.stderr)
        self.assertTrue(found, done.stderr)
        self.assertGreater(float(found.group(1)), 5e-3)

    def test_it_always_gives_up(self):
        netlist = self.write("a.cir", HALF_WAVE)
        page = self.folder / "a.html"
        done = self.compare(netlist, "--with", self.pretender(NEVER), "-o", page)
        self.assertIn("Timestep too small; time = 0, timestep = 1e-20", done.stdout)
        self.assertRegex(done.stdout, r"ngspice got to the end with none of \d\d settings\.")
        self.assertIn("Timestep too small", page.read_text())
        self.assertEqual(done.stderr, "")

    def test_it_gives_up_now_and_then(self):
        done = self.compare(NETLISTS / "rectifiers/full_bridge_rc.cir", "--limit", "1")
        self.assertRegex(done.stdout, r"ngspice gave up, for instance\n +at \S+ \S?s with D .*: "
                                      r"Timestep too small; time = ")
        self.assertRegex(done.stdout, r"ngspice gave up with \d+ of \d+ settings\.")

    def test_where_ngspice_is_better_it_says_so(self):
        netlist = self.write("a.cir", SMOOTH)
        out = self.compare(netlist, "--methods", "euler").stdout
        self.assertIn("nearer to the reference than dalcs's default in i(l1).", out)
        self.assertRegex(out, r"ngspice's most exact setting is more exact: \S+ in the worst signal "
                              r"against \S+ of dalcs by default\.")

    def test_what_is_not_determined(self):
        netlist = self.write("a.cir", HALF_WAVE.replace("D1 in out", "D1 in out\nD2 in out"))
        out = self.compare(netlist, "--with", self.pretender(NEVER)).stdout
        self.assertIn("The circuit does not determine i(d1): it is not compared.", out)

    def test_page(self):
        netlist = self.write("a.cir", HALF_WAVE.replace("Half wave", "Half <wave> & more"))
        page = self.folder / "a.html"
        self.compare(netlist, "-o", page, "--quiet")
        text = page.read_text()
        self.assertEqual(text.count("<svg"), 3)
        self.assertIn("<h1>Half &lt;wave&gt; &amp; more with a capacitor</h1>", text)
        self.assertIn("D1 in out\n", text)  # the netlist, and the one for ngspice
        self.assertIn(".save i(v__1)", text)
        addresses = set(re.findall(r"https?://[^\s'\"<]+", text))
        self.assertLessEqual({address for address in addresses if "www.w3.org" not in address},
                             set())
        self.assertNotIn("<script src", text)

    def test_without_ngspice(self):
        netlist = self.write("a.cir", HALF_WAVE)
        done = self.compare(netlist, "-o", "a.html", status=4, PATH=self.path_with("gnuplot"))
        self.assertEqual(done.stderr, "dalcs: error: ngspice is not installed (on Debian: apt-get "
                                      "install ngspice)\n")
        self.assertEqual(done.stdout, "")
        self.assertFalse((self.folder / "a.html").exists())

    def test_without_gnuplot(self):
        netlist = self.write("a.cir", HALF_WAVE)
        done = self.compare(netlist, "-o", "a.html", "-q", PATH=self.path_with("ngspice"))
        self.assertEqual(done.stderr, "dalcs: warning: 'a.html' has no figures: gnuplot is not "
                                      "installed (on Debian: apt-get install gnuplot-nox)\n")
        self.assertIn("No figures: gnuplot is not installed", (self.folder / "a.html").read_text())

    def test_too_slow(self):
        netlist = self.write("a.cir", HALF_WAVE)
        loop = "#!/bin/sh\n[ \"$1\" = --version ] && exit 0\nwhile :; do :; done\n"
        out = self.compare(netlist, "--with", self.pretender(loop), "--limit", "20m").stdout
        self.assertIn("no end within 0.02 s of CPU time", out)

    def test_mistakes(self):
        netlist = self.write("a.cir", HALF_WAVE)
        still = self.write("op.cir", HALF_WAVE.replace(".tran 50u 40m uic", ".op"))
        no_counterpart = self.write("b.cir", HALF_WAVE.replace(
            ".save", "C2 in out 1n\n.ic v(in,out)=1\n.save"))
        cases = [
            ((netlist, "--methods", "auto,trap"), 2,
             "--methods: write auto, radau, euler or several of them, each once, separated by commas"),
            ((netlist, "--methods", "auto,auto"), 2,
             "--methods: write auto, radau, euler or several of them, each once, separated by commas"),
            ((netlist, "--with", "spice3"), 2,
             "--with: 'spice3' is neither ngspice nor the path of one"),
            ((netlist, "--with", "./none"), 4, "cannot run './none': No such file or directory"),
            ((netlist, "--limit", "0"), 2, "--limit: '0' is not a number greater than 0"),
            ((netlist, "--within", "x"), 2, "--within: 'x' is not a number greater than 0"),
            ((netlist, "-o", "a.svg"), 2, "unknown format of 'a.svg': name it .html"),
            ((netlist, "-o", "none/a.html"), 4,
             "cannot write 'none/a.html': No such file or directory"),
            ((netlist, "--methodes", "x"), 2,
             "unknown option '--methodes'; did you mean '--methods'?"),
            ((netlist, netlist), 2, f"one netlist at a time: '{netlist}' is one too many"),
            ((still,), 3, f"{still} has no .tran: there are no waveforms to compare"),
        ]
        for options, status, message in cases:
            with self.subTest(options=options):
                done = self.compare(*options, status=status)
                self.assertEqual(done.stderr, f"dalcs: error: {message}\n")
                self.assertEqual(done.stdout, "")
        done = self.compare(no_counterpart, status=3)
        self.assertIn(f"{no_counterpart}:8:", done.stderr)
        self.assertIn("error: ngspice has no .ic between two nodes", done.stderr)


if __name__ == "__main__":
    PROGRAM = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
