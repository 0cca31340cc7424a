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
# a program that ends while a run goes on that would take days. Rows go to a function of C: one of Python's must not be
# called any more once Python is on its way out.
LEAVES = """
import ctypes
import time
library, take = ctypes.CDLL("libngspice.so.0"), ctypes.CDLL(None).getppid
library.ngSpice_Init(None, None, None, take, None, None, None)
lines = (ctypes.c_char_p * 6)(b"t", b"v1 a 0 sin(0 1 50)", b"r1 a 0 1", b".tran 1u 100000", b".end", None)
print(library.ngSpice_Circ(lines), library.ngSpice_Command(b"bg_run"), library.ngSpice_running())
time.sleep(0.1)
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

    def test_start_file(self):
        """.spiceinit of the folder, else of the user's home, where the program has ngspice's name; and -D."""
        program = self.programs[0]
        control = NETLIST.replace(".end\n", ".control\nop\nprint v(out)\necho [$?mine] $mine\nwrite c.raw\n.endc\n.end\n")
        home, here, work = self.root / "home", self.root / "here", self.root / "empty"
        for folder in (home, here, work):
            folder.mkdir()
            (folder / "half.cir").write_text(control, encoding="utf-8")
        (home / ".spiceinit").write_text("* mine\n\n  set MINE = home ; a comment\nset filetype=ascii\nset = 1\nset numdgt=4\n",
                                         encoding="utf-8")
        (here / ".spiceinit").write_text("unset numdgt\nset mine=(a b) $ a list\nalias q quit\nset filetype=binary\n",
                                         encoding="utf-8")

        def ngspice(folder, *words, name="ngspice", text="half.cir"):
            done = subprocess.run([program, "as-ngspice", name, *words, text], cwd=folder, capture_output=True, text=True,
                                  check=True, env={**os.environ, "HOME": str(home)})
            raw = (folder / "c.raw").read_bytes()
            (folder / "c.raw").unlink()
            return done.stdout.split("\n")[:2], done.stderr, b"Values:" in raw

        out, err, is_text = ngspice(work)
        self.assertEqual(out, ["v(out) = 5.0000e-01", "[1] home"])
        self.assertIn(f"note: '{home}/.spiceinit' was read", err)
        self.assertIn("/.spiceinit:5: note: 'set = 1' is left out", err)
        self.assertTrue(is_text)
        out, err, is_text = ngspice(here, "-D", "numdgt=4", "-D", "mine=c")
        self.assertEqual(out, ["v(out) = 5.000000e-01", "[1] a b"])
        self.assertIn("note: './.spiceinit' was read", err)
        self.assertIn("./.spiceinit:3: note: 'alias q quit' is left out", err)
        self.assertFalse(is_text)
        for words, name in ((["-n", "-D", "numdgt=4", "-D", "mine", "-D", "FileType = ascii"], "ngspice"),
                            (["-b", "-D", "numdgt=4", "-D", "mine", "-D", "filetype=ascii"], str(program))):
            out, err, is_text = ngspice(here, *words, name=name)
            self.assertEqual((out, err, is_text), (["v(out) = 5.0000e-01", "[1] "], "", True))
        script = LOADS.replace("library.ngSpice_CurPlot.restype", """
said = []
say = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_char_p, ctypes.c_int, ctypes.c_void_p)(
    lambda text, number, user: said.append(text.decode()) or 0)
SKIP
library.ngSpice_Init(say, None, None, None, None, None, None)
library.ngSpice_Command(b"echo $?mine $numdgt")
print([line for line in said if "**" not in line and "stderr" not in line], sum("a name is missing" in s for s in said))
library.ngSpice_CurPlot.restype""")
        for skip, said in (("", [f"stdout Note: {home}/.spiceinit was read, as ngspice does", "stdout 1 4"]),
                           ("library.ngSpice_nospiceinit()", None)):
            done = subprocess.run([program, "as-ngspice", sys.executable, "-c", script.replace("SKIP", skip)], cwd=work,
                                  capture_output=True, text=True, check=True, env={**os.environ, "HOME": str(home)})
            shown, result, _ = done.stdout.split("\n")
            self.assertEqual(result, "0 0 op1")
            if said is not None:
                self.assertEqual(shown, f"{said} 1")
            self.assertEqual("spiceinit" in shown, said is not None)

    def test_command_lines(self):
        """How programs start it: spicelib and PyLTSpice, xschem in three ways, Qucs-S, Oregano."""
        for words, makes in (("-D ngbehavior=kiltpsa -b -o half.log -r half.raw half.cir", "half.raw half.log"),
                             ("-b -r half.raw -o half.out half.cir", "half.raw half.out"), ("-i half.cir -a", ""),
                             ("half.cir -a", ""), ("half.cir", ""), ("-b half.cir", "")):
            self.as_ngspice(self.programs[0], "ngspice", *words.split())
            for name in makes.split():
                self.assertGreater((self.root / name).stat().st_size, 0, name)
                (self.root / name).unlink()

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
        both = [ctypes.CDLL(str(library)), ctypes.CDLL(str(next(self.root.rglob("libdalcs.so.1"))))]
        self.assertEqual(both[0].ngSpice_running(), 0)


if __name__ == "__main__":
    BUILD, PROGRAM = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
