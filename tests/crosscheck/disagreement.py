#!/usr/bin/env python3
"""The cross-check must notice a wrong answer: it gets dalcs programs that lie a little.

usage: disagreement.py DALCS CROSSCHECK
"""

import os
import pathlib
import stat
import subprocess
import sys
import tempfile

NETLIST = """half-wave rectifier with a load that is switched on
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 100u
R1 out 0 1k
S1 out r c 0 sm
R2 r 0 500
Vc c 0 PULSE(0 1 10m 0 0 1 2)
.model sm SW(Ron=0 Vt=0.5)
.tran 20u 40m
.save v(in) v(out) v(in,out) v(0,in) i(d1) i(s1)
.end
"""
LIAR = """#!{python}
import csv, subprocess, sys
done = subprocess.run([{dalcs!r}, *sys.argv[1:]])
path = sys.argv[sys.argv.index("-o") + 1]
with open(path, newline="") as file:
    header, *rows = [row for row in csv.reader(file)]
place = header.index({signal!r})
for row in rows:
    t, value = float(row[0]), float(row[place])
    row[place] = repr({lie})
with open(path, "w", newline="") as file:
    csv.writer(file).writerows([header, *rows])
sys.exit(done.returncode)
"""
LIES = [  # signal, what becomes of its value, the cross-check's status
    ("v(out)", "value", 0),
    ("v(out)", "1.03 * value", 1),
    ("v(out)", "value + 0.5 * (t > 0.039)", 1),
    ("v(out)", "1.03 * value + 1e3 * (0.02 < t < 0.02005)", 1),  # its height is no excuse
    ("v(in)", "-value", 1),
    ("v(in,out)", "-value", 1),
    ("v(0,in)", "-value", 1),
    ("i(d1)", "0.0", 1),
    ("i(s1)", "value + 1e-3", 1),
    ("v(out)", "float('nan') if t > 0.02 else value", 1),
    ("v(out)", "value + 3.0 * (0.02 < t < 0.02005)", 0),  # a glitch, shorter than 1 %
]


def main():
    dalcs, crosscheck = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:])
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "a.cir").write_text(NETLIST)
        liar = folder / "liar"

        def check(expected, what, program=liar, **options):
            nonlocal failures
            done = subprocess.run([sys.executable, "-B", crosscheck, str(folder / "a.cir"),
                                   "--dalcs", str(program), "--method", "euler"],
                                  capture_output=True, text=True, check=False, **options)
            if done.returncode != expected:
                failures += 1
                print(f"FAIL {what}: status {done.returncode}, not {expected}\n{done.stdout}"
                      f"{done.stderr}")

        for signal, lie, expected in LIES:
            liar.write_text(LIAR.format(python=sys.executable, dalcs=dalcs, signal=signal, lie=lie))
            liar.chmod(liar.stat().st_mode | stat.S_IXUSR)
            check(expected, f"{signal} = {lie}")
        check(2, "dalcs is missing", program=folder / "nowhere")
        check(2, "ngspice is missing", program=dalcs, env={**os.environ, "PATH": "/nowhere"})
        (folder / "a.cir").write_text(NETLIST.replace("1k", "abc"))
        check(2, "an error in the netlist", program=dalcs)
    print(f"{len(LIES) + 3} checks, {failures} failed")
    return 0 if failures == 0 else 1


if __name__ == "__main__":
    sys.exit(main())
