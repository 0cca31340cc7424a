#!/usr/bin/env python3
"""`dalcs as-ngspice`, and dalcs called by ngspice's name, where both are built and where they are installed.

usage: as_ngspice.py BUILD_FOLDER DALCS
"""

import ctypes
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

NETLIST = "half a volt\nV1 in 0 1\nR1 in out 1\nR2 out 0 1\n.tran 1u 1m\n.end\n"
# what it loads by its bare name, and a vector of it
LOADS = """
import ctypes
library = ctypes.CDLL("libngspice.so.0")
library.ngSpice_CurPlot.restype = ctypes.c_char_p
lines = (ctypes.c_char_p * 6)(b"t", b"v1 a 0 3", b"r1 a 0 1", b".op", b".end", None)
print(library.ngSpice_Circ(lines), library.ngSpice_Command(b"run"), library.ngSpice_CurPlot().decode())
"""
# a program that ends while a run goes on that would take days, and whose callback is written in Python
LEAVES = """
import ctypes
library = ctypes.CDLL("libngspice.so.0")
rows = []
take = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_int, ctypes.c_void_p)(
    lambda row, n, number, user: rows.append(n) or 0)
library.ngSpice_Init(None, None, None, take, None, None, None)
lines = (ctypes.c_char_p * 6)(b"t", b"v1 a 0 sin(0 1 50)", b"r1 a 0 1", b".tran 1u 100000", b".end", None)
print(library.ngSpice_Circ(lines), library.ngSpice_Command(b"bg_run"), library.ngSpice_running())
while not rows:
    pass
"""
BUILD = PROGRAM = ""


class AsNgspice(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.place.cleanup)
        cls.root = pathlib.Path(cls.place.name)
        subprocess.run(["meson", "install", "-C", BUILD, "--no-rebuild", "--destdir", cls.root], check=True,
                       stdout=subprocess.DEVNULL)
        cls.programs = [pathlib.Path(PROGRAM).resolve(), next(cls.root.rglob("bin/dalcs"))]
        (cls.root / "half.cir").write_text(NETLIST, encoding="utf-8")

    def dalcs(self, program, *words, status=0, **variables):
        done = subprocess.run([program, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              check=False, cwd=self.root, env={**os.environ, **variables})
        self.assertEqual(done.returncode, status, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def as_ngspice(self, program, *words, status=0, **variables):
        return self.dalcs(program, "as-ngspice", *words, status=status, **variables)

    def test_library(self):
        for program in self.programs:
            self.assertEqual(self.as_ngspice(program, sys.executable, "-c", LOADS), "0 0 op1\n")

    def test_end_of_process(self):
        self.assertEqual(self.as_ngspice(self.programs[0], sys.executable, "-c", LEAVES), "0 0 1\n")

    def test_program(self):
        for program in self.programs:
            self.assertIn("this is dalcs", self.as_ngspice(program, "ngspice", "-v"))
            self.assertEqual(self.as_ngspice(program, "ngspice", "-n", "-a", "-q", "-D", "ngbehavior=ltpsa", "-D",
                                             "filetype=ascii", "-r", "half.raw", "-o", "half.log", "half.cir"), "")
            raw = (self.root / "half.raw").read_text(encoding="utf-8")
            self.assertIn("Values:", raw)
            self.assertIn("v(out)", raw)
            (self.root / "half.raw").unlink()

    def test_refused(self):
        program = self.programs[0]
        for option in ["-p", "-s"]:
            self.assertIn("takes no commands", self.as_ngspice(program, "ngspice", option, status=2))
        self.assertIn("no netlist", self.as_ngspice(program, "ngspice", status=2))
        self.assertIn("unknown option", self.as_ngspice(program, "ngspice", "--nosuch", "half.cir", status=2))
        self.assertIn("cannot run", self.as_ngspice(program, "no_such_program", status=4))
        self.assertIn("unknown option", self.as_ngspice(program, "-x", status=2))

    def test_environment(self):
        program = self.programs[1]
        folder = next(self.root.rglob("dalcs/ngspice"))
        shown = self.as_ngspice(program, "sh", "-c", 'echo "$PATH|$LD_LIBRARY_PATH|$NGSPICE_LIBRARY_PATH"',
                                LD_LIBRARY_PATH="/before")
        path, libraries, library = shown.strip().split("|")
        self.assertTrue(path.startswith(f"{folder.resolve()}:"))
        self.assertEqual(libraries, f"{folder.resolve()}:/before")
        self.assertEqual(library, str(folder.resolve() / "libngspice.so.0"))
        settings = self.as_ngspice(program)
        shown = subprocess.run(["sh", "-c", f"{settings}\ncommand -v ngspice"], capture_output=True, text=True,
                               check=True).stdout
        self.assertEqual(shown.strip(), str(folder.resolve() / "ngspice"))
        self.assertEqual(self.as_ngspice(program, "sh", "-c", "exit 7", status=7), "")

    def test_symbols(self):
        """No name of dalcs is seen: a program may load both libraries."""
        library = next(self.root.rglob("libngspice.so.0"))
        names = subprocess.run(["nm", "-D", "--defined-only", library], capture_output=True, text=True,
                               check=True).stdout.split("\n")
        for line in filter(None, names):
            self.assertRegex(line.split()[-1], "^ng(Spice|Get|CM)_")
        self.assertGreaterEqual(len(names), 22)
        # that both can be loaded
        both = [ctypes.CDLL(str(library)), ctypes.CDLL(str(next(self.root.rglob("libdalcs.so.0"))))]
        self.assertEqual(both[0].ngSpice_running(), 0)


if __name__ == "__main__":
    BUILD, PROGRAM = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
