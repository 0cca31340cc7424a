#!/usr/bin/env python3
"""Measurements beside ngspice's of the same netlist, at its accuracy; and ngspice loads raw files.

usage: as_ngspice.py PROGRAM NGSPICE
"""

import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

NETLIST = """beside ngspice
V1 in 0 SIN(0 10 1k)
R1 in out 1k
C1 out 0 100n
.tran 0.1u 5m 0 0.1u
.print tran v(out)
.meas tran vrms RMS v(out)
.meas tran vmax MAX v(out)
.meas tran vmin MIN v(out) from=1m to=3m
.meas tran vat MAX_AT v(out)
.meas tran vpp PP v(out)
.meas tran vint INTEG v(out)
.meas tran part AVG v(out) from=1m to=1.3m
.meas tran rise WHEN v(out)=1 rise=2
.meas tran fall FIND v(in) WHEN v(out)=1 fall=last
.meas tran at FIND v(in) AT=1.1m
.meas tran delay TRIG v(in) val=1 rise=1 TARG v(out) val=1 rise=1
.meas tran equal WHEN v(in)=v(out) fall=2
.meas tran twice PARAM='vmax*2'
.four 1k v(out)
.end
"""

LINE = re.compile(r"^(\w+)\s+=\s+(\S+)(.*)$", re.MULTILINE)


def read(text):
    return {name: (float(value), rest) for name, value, rest in LINE.findall(text)
            if re.fullmatch(r"[-+.\de]+", value)}


def main():
    program, ngspice = str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]
    checker = dalcs_program.Checker("as ngspice")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "c.cir").write_text(NETLIST)
        said = [subprocess.run([command, "-b", "c.cir"], cwd=folder, capture_output=True, text=True,
                               stdin=subprocess.DEVNULL, check=False, timeout=60).stdout
                for command in (program, ngspice)]
        ours, theirs = read(said[0]), read(said[1])
        names = re.findall(r"\.meas tran (\w+)", NETLIST)
        for name in names:
            if checker.check(name in ours and name in theirs, f"{name}: {name in ours}, "
                             f"{name in theirs}"):
                checker.close(ours[name][0], theirs[name][0],
                              5e-4 * abs(theirs[name][0]) + 1e-9, name)
                words = [re.findall(r"(\w+)=", found[name][1]) for found in (ours, theirs)]
                checker.check(words[0] == words[1], f"{name}: {words}")
        rows = [re.findall(r"^ ([01])\s+(\S+)\s+(\S+)\s+(\S+)\s", text, re.MULTILINE)
                for text in said]
        checker.check(rows[0][:2] and len(rows[0]) == 2 and len(rows[1]) == 2, f"four: {rows}")
        for k in (2, 3):
            checker.close(float(rows[0][1][k]), float(rows[1][1][k]),
                          1e-3 * abs(float(rows[1][1][k])), f"four, column {k}")
        for options in ([], ["--ascii"]):
            subprocess.run([program, "-b", "-r", "w.raw", *options, "c.cir"], cwd=folder,
                           stdout=subprocess.DEVNULL, check=True, timeout=60)
            (folder / "load.cir").write_text("load\n.control\nload w.raw\n"
                                             "print length(v(out)) vecmax(v(out))\nquit\n.endc\n"
                                             ".end\n")
            done = subprocess.run([ngspice, "-b", "load.cir"], cwd=folder, capture_output=True,
                                  text=True, stdin=subprocess.DEVNULL, check=False, timeout=60)
            loaded = re.search(r"vecmax\(v\(out\)\) = (\S+)", done.stdout)
            if checker.check(loaded is not None, f"{options}: {done.stdout}"):
                checker.close(float(loaded.group(1)), ours["vmax"][0], 1e-5, f"{options}: loaded")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
