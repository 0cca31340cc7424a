#!/usr/bin/env python3
"""`dalcs -b`, ngspice's command line, and raw files as text.

usage: batch.py PROGRAM
"""

import itertools
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import raw_reader  # pylint: disable=wrong-import-position,import-error

NETLIST = """batch
V1 in 0 PULSE(0 5 1m 0 0 1 2)
R1 in out 1k
C1 out 0 1u
.op
.tran 0.5m 4m
.print tran v(out)
.meas tran t WHEN v(out)=2.5
.meas tran vmax MAX v(in)
.end
"""


def run(program, folder, *arguments):
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True,
                          stdin=subprocess.DEVNULL, check=False, timeout=60,
                          env={**os.environ, "SOURCE_DATE_EPOCH": "0"})


def command_lines(program, checker, folder):
    first = None
    words = [["-b"], ["-r", "out.dat"], ["-o", "log"], ["-a"], ["-n"], ["c.cir"]]
    for order in list(itertools.permutations(range(len(words))))[::37]:
        line = [word for k in order for word in words[k]]
        for name in ("out.dat", "log"):
            (folder / name).unlink(missing_ok=True)
        done = run(program, folder, *line)
        if not checker.check(done.returncode == 0 and done.stdout == "" and done.stderr == "",
                             f"{line}: {done}"):
            return
        found = (folder / "out.dat").read_bytes()
        first = first or found
        checker.check(found == first, f"{line}: another raw file")
        checker.check("t                   =  1.693147181e-03" in (folder / "log").read_text(),
                      f"{line}: no measurement in the log")
    plots = raw_reader.read(folder / "out.dat")
    checker.check([plot[1] for plot in plots] == [["v(out)"], ["time", "v(out)"]],
                  f"plots: {[plot[1] for plot in plots]}")


def tables(program, checker, folder):
    done = run(program, folder, "-b", "c.cir")
    rows = re.findall(r"^(\d+)\t(\S+)\t(\S+)\t$", done.stdout, re.MULTILINE)
    checker.check(done.returncode == 0 and len(rows) == 10, f"table: {done.stdout}")
    checker.check("Index   time            v(out)" in done.stdout, f"heading: {done.stdout}")
    checker.check(rows[-1][1:] == ("4.000000e-03", "4.751065e+00"), f"last row: {rows[-1:]}")
    checker.check("\n\tv(out)                           0.000000e+00" in done.stdout,
                  f"operating point: {done.stdout}")
    checker.check(sorted(p.name for p in folder.iterdir()) == ["c.cir"],
                  "files without -r: " + ", ".join(p.name for p in folder.iterdir()))


CARDS = """several tables // and comments
V1 in 0 DC 1 AC 1 // a volt
// R9 in 0 1
R1 in out 1k
C1 out 0 1u
.op
.dc V1 0 1 0.5
.ac dec 1 10 100
.tran 0.5m 1m uic
.print dc v(out) i(v1)
.print ac vdb(out) v(out)
.plot ac vp(out) (-1,1) db(v(in,out))
.print tran v(in) v(out)
.print tran v(in,out) @r1[i]
.print op v(out)
.end
"""

LINES = """\
Operating Point
Index   v(out)
0 1.000000e+00
DC transfer characteristic
Index   v1              v(out)          i(v1)
0 0.000000e+00 0.000000e+00 0.000000e+00
1 5.000000e-01 5.000000e-01 0.000000e+00
2 1.000000e+00 1.000000e+00 0.000000e+00
AC Analysis
Index   frequency       vdb(out)        v(out)
0 1.000000e+01 -1.71115e-02 9.960677e-01, -6.25848e-02
1 1.000000e+02 -1.44507e+00 7.169568e-01, -4.50477e-01
AC Analysis
Index   frequency       vp(out)         db(v(in,out))
0 1.000000e+01 -6.27494e-02 -2.40535e+01
1 1.000000e+02 -5.60982e-01 -5.48147e+00
Transient Analysis
Index   time            v(in)           v(out)
0 0.000000e+00 1.000000e+00 0.000000e+00
1 5.000000e-04 1.000000e+00 3.934693e-01
2 1.000000e-03 1.000000e+00 6.321206e-01
Transient Analysis
Index   time            v(in,out)       i(r1)
0 0.000000e+00 1.000000e+00 1.000000e-03
1 5.000000e-04 6.065307e-01 6.065307e-04
2 1.000000e-03 3.678794e-01 3.678794e-04
"""


def cards(program, checker, folder):
    """A table for each .print, in the order of the analyses; the numbers of .ac are ngspice's own."""
    (folder / "cards.cir").write_text(CARDS)
    done = run(program, folder, "-b", "cards.cir")
    checker.check(done.returncode == 0 and done.stderr == "", f"cards: {done}")
    found = re.findall(r"^ *(Operating Point|DC transfer \w+|\w+ Analysis|Index .*?|\d+\t.*?)\s*$",
                       done.stdout, re.MULTILINE)
    found = [re.sub(r"\d\.\d+e-2\d", "0.000000e+00", line.replace("\t", " ")) for line in found]
    checker.check(found == LINES.splitlines(), "cards: " + "\n".join(found))
    (folder / "cards.cir").write_text(CARDS.replace(".op", ".op\n.step R1 list 1k 2k"))
    done = run(program, folder, "-b", "cards.cir")
    checker.check(re.findall(r"Transient Analysis(.*)", done.stdout)
                  == ["  r1=1000"] * 2 + ["  r1=2000"] * 2, f"steps: {done.stdout}")
    (folder / "cards.cir").write_text(re.sub(r"\.(print|plot|tran) .*\n", "", CARDS))
    done = run(program, folder, "-b", "cards.cir")
    checker.check(re.findall(r"^Index.*", done.stdout, re.MULTILINE)
                  == [f"Index   {'v1':16}{'v(in)':16}{'v(out)':16}{'i(v1)':16}",
                      f"Index   {'frequency':16}{'v(in)':32}{'v(out)':32}{'i(v1)':32}"],
                  f"without .print and .tran everything: {done.stdout}")
    (folder / "cards.cir").unlink()


def refusals(program, checker, folder):
    for line, status, why in ((["-b"], 2, "no netlist given"),
                              (["-b", "c.cir", "d.cir"], 2, "'d.cir' is one too many"),
                              (["-b", "-r"], 2, "option '-r' needs a value"),
                              (["-b", "-y", "c.cir"], 2, "unknown option '-y'"),
                              (["-b", "none.cir"], 4, "cannot read 'none.cir'"),
                              (["-b", "-r", "c.cir", "c.cir"], 2, "is the netlist itself"),
                              (["-b", "-o", "c.cir", "c.cir"], 2, "is the netlist itself"),
                              (["-b", "-o", "x", "-r", "x", "c.cir"], 2, "given for two results"),
                              (["-b", "-o", "no/log", "c.cir"], 4, "cannot write 'no/log'"),
                              (["-x", "c.cir"], 2, "unknown option '-x'"),
                              (["-b", "loop.cir"], 1, "")):
        (folder / "loop.cir").write_text("loop\nV1 a 0 SIN(0 1 1k)\nD1 a 0\nR1 a 0 1\n"
                                         ".tran 1u 1m\n.end\n")
        done = run(program, folder, *line)
        checker.check(done.returncode == status and why in done.stderr, f"{line}: {done}")
        (folder / "loop.cir").unlink()
    for path in folder.iterdir():
        if path.name != "c.cir":
            path.unlink()
    done = run(program, folder, "-b", "-i", "-p", "-s", "-D", "a=1", "-r", "x.raw", "c.cir")
    checker.check(done.returncode == 0 and done.stderr.count("has no meaning here") == 3,
                  f"what has no meaning: {done}")
    (folder / "x.raw").unlink()


def ascii_files(program, checker, folder):
    (folder / "text.cir").write_text(NETLIST.replace(".op", ".op\n.options filetype=ascii"))
    run(program, folder, "run", "c.cir", "-o", "binary.raw")
    run(program, folder, "run", "c.cir", "-o", "text.raw", "--ascii")
    run(program, folder, "-b", "text.cir", "-r", "option.raw")
    binary, text = (folder / "binary.raw").read_bytes(), (folder / "text.raw").read_bytes()
    checker.check(b"Binary:" in binary and b"Values:" not in binary, "binary by default")
    checker.check(b"Values:" in text and b"Binary:" not in text, "text when asked for")
    checker.check((folder / "option.raw").read_bytes() == text, "filetype=ascii is --ascii")
    checker.check([plot[1:] for plot in raw_reader.read(folder / "binary.raw")] ==
                  [plot[1:] for plot in raw_reader.read(folder / "text.raw")],
                  "the same values in both")


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    checker = dalcs_program.Checker("batch")
    for test in (command_lines, tables, cards, refusals, ascii_files):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "c.cir").write_text(NETLIST)
            test(program, checker, folder)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
