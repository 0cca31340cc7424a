#!/usr/bin/env python3
"""Raw files by the rules of other Python readers (support/spicelib_rules.py).

usage: raw_readers.py PROGRAM
"""

import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import spicelib_rules  # pylint: disable=wrong-import-position,import-error

CIRCUIT = """a filter
V1 in 0 PULSE(0 1 1m 0 0 1m 2m) AC 1
R1 in /sw {r}
C1 /sw 0 1u
.param r=1k
.save v(in) v(/sw) v(in,/sw) i(r1)
"""
STEPPED = CIRCUIT + ".step param r list 1k 2k 3k\n"
NAMES = ["v(in)", "v(/sw)", "v(in,/sw)", "i(r1)"]


class Runner:
    def __init__(self, program, folder, checker):
        self.program, self.folder, self.checker = program, pathlib.Path(folder), checker

    def read(self, netlist, *options, name="c.raw", **rules):
        (self.folder / "c.cir").write_text(netlist)
        for old in self.folder.glob("*.raw"):
            old.unlink()
        done = subprocess.run([self.program, "run", "c.cir", "-q", *options], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        self.checker.check(done.returncode == 0, f"{netlist}\n{done.stderr}")
        try:
            return spicelib_rules.read(self.folder / name, **rules)
        except (spicelib_rules.Refused, OSError) as why:
            self.checker.check(False, f"{netlist}{options}: {why}")
            return []

    def in_both(self, netlist, *options, **rules):
        """The plots, the same from binary and from text."""
        binary = self.read(netlist, *options, **rules)
        text = self.read(netlist, "--ascii", *options, **rules)
        self.checker.check([(p.names, p.columns) for p in binary]
                           == [(p.names, p.columns) for p in text], f"text differs: {netlist}")
        return binary


def check_plots(run, check):
    for card, plotname, flags, first in ((".tran 0.5m 3m", "Transient Analysis", ["real"], "time"),
                                         (".dc V1 0 1 0.5", "DC transfer characteristic", ["real"],
                                          "v-sweep"),
                                         (".ac dec 1 1 100", "AC Analysis", ["complex"],
                                          "frequency"),
                                         (".op", "Operating Point", ["real"], None)):
        plots = run.in_both(CIRCUIT + card + "\n.end\n", only_first=True)
        if not check(len(plots) == 1, f"{card}: {len(plots)} plots"):
            continue
        plot = plots[0]
        check(plot.fields["Plotname"] == plotname and plot.flags == flags, f"{plot.fields}")
        check(plot.names == ([first] if first else []) + NAMES, f"{card}: {plot.names}")
        check(plot.has_scale == (first is not None), card)
        check(plot.types[-4:] == ["voltage"] * 3 + ["current"], f"{card}: {plot.types}")


def check_several(run, check):
    plots = run.in_both(CIRCUIT + ".op\n.ac dec 1 1 100\n.dc V1 0 1 0.5\n.tran 0.5m 3m\n.end\n")
    check([p.fields["Plotname"] for p in plots]
          == ["Operating Point", "DC transfer characteristic", "AC Analysis",
              "Transient Analysis"], f"{[p.fields['Plotname'] for p in plots]}")


def check_steps(run, check):
    """An edge at tstart, after which the first rows stand, is no step of its own."""
    for tran in (".tran 0.5m 3m", ".tran 0.5m 3m 1m", ".tran 0.5m 3m 0.7m"):
        plots = run.in_both(STEPPED + tran + "\n.end\n", only_first=True)
        if not check(len(plots) == 1 and plots[0].flags == ["real", "stepped"], f"{tran}: {plots}"):
            continue
        check(len(plots[0].starts()) == 3, f"{tran}: steps start at {plots[0].starts()}")
        for k, r in enumerate((1e3, 2e3, 3e3)):
            check(set(plots[0].step("r", k)) == {r}, f"{tran}: r of step {k}")
            time = plots[0].step("time", k)
            value = plots[0].step("v(in)", k)[time.index(max(time))]
            check(time == sorted(time) and time[-1] == 3e-3 and value == 0.0, f"{tran}: step {k}")
            if tran.endswith(" 1m"):
                check(time[0] == 1e-3 and plots[0].step("v(in)", k)[0] == 1.0,
                      f"{tran}: what stands at tstart is behind the edge")
    ac = run.in_both(STEPPED + ".ac lin 2 100 200\n.end\n", only_first=True)[0]
    check(ac.flags == ["complex", "stepped"] and len(ac.starts()) == 3, f"{ac.fields}")
    wanted = 1 / (1 + 2j * math.pi * 200 * 2e3 * 1e-6)
    check(abs(ac.step("v(/sw)", 1)[1] - wanted) < 1e-12, "the second step of .ac")
    op = run.in_both(STEPPED + ".op\n.end\n", only_first=True)[0]
    check(len(op.starts()) == 3 and op.columns[0] == [1e3, 2e3, 3e3], f"{op.columns}")
    split = run.in_both(STEPPED + ".tran 0.5m 3m 1m\n.end\n", "--split-steps")
    check([p.flags for p in split] == [["real"]] * 3, "a plot for each step")
    one = run.in_both(CIRCUIT + ".step param r list 1k\n.tran 0.5m 3m 1m\n.end\n", only_first=True)
    check(one[0].flags == ["real"] and one[0].step("time", 0)[:2] == [1e-3, 1e-3],
          "a single step has both sides")


def check_script(run, check):
    script = CIRCUIT + ".control\nSCRIPT\n.endc\n.end\n"
    for setting, word in (("", b"Binary:"), ("set filetype=ascii\n", b"Values:")):
        plots = run.read(script.replace("SCRIPT", setting + "ac dec 1 1 100\nwrite w.raw "
                                        "db(v(in))"), name="w.raw", only_first=True)
        check(len(plots) == 1 and plots[0].flags == ["complex"] and
              plots[0].names[0] == "frequency", f"{setting}: {[p.fields for p in plots]}")
        check(word in (run.folder / "w.raw").read_bytes(), f"{setting}: no {word}")


def check_spyci(run, check):
    """spyci reads text by one pattern, in which nothing stands between Title, Date, Plotname, Flags, No. Variables,
    No. Points and Variables; a point is its number, blanks, and values in lines of their own."""
    header = "".join(rf"{key}:\s*(\w.*?\w|\w)\s*" for key in ("^Date", "Plotname", "Flags", r"No\. Variables",
                                                              r"No\. Points"))
    pattern = re.compile(r"^Title:\s*(.*)\s*" + header + r"Variables:\s*$(.*)^Values:(.*)", re.M | re.S)
    for card, plotname in ((".tran 0.5m 3m", "Transient Analysis"), (".ac dec 1 1 100", "AC Analysis")):
        plot = run.read(CIRCUIT + f"{card}\n.end\n", "--ascii")[0]
        found = pattern.search((run.folder / "c.raw").read_text())
        if not check(found is not None, f"no header for spyci: {card}"):
            continue
        check(found[3] == plotname and found[5].isdigit() and found[6].isdigit(), f"spyci reads {found.groups()[:6]}")
        points = re.findall(r"^\s*\d+\s+(\S+(?:\n\s*\S+)*)$", found[8], re.M)
        check(len(points) == int(found[6]) == len(plot.columns[0]), f"spyci finds {len(points)} points")
        check(all(len(point.split()) == int(found[5]) for point in points), "spyci finds other values")


def check_ngspice(run, check):
    """Debian's ngspice loads it, and has nothing to say."""
    if shutil.which("ngspice") is None:
        return
    for option in "--quiet", "--ascii":
        plot = run.read(CIRCUIT + ".tran 0.5m 3m\n.end\n", option)[0]
        (run.folder / "load.cir").write_text("load\n.control\nload c.raw\nprint length(time)\nquit 0\n.endc\n.end\n")
        done = subprocess.run(["ngspice", "-n", "-b", "load.cir"], cwd=run.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, check=False)
        check(f"length(time) = {len(plot.columns[0]):e}" in done.stdout and "rror" not in done.stderr,
              f"ngspice loads: {done.stdout}{done.stderr}")


def check_rules(run, check):
    """That the rules refuse what the readers do, and read LTspice's own layout."""
    run.read(CIRCUIT + ".tran 0.5m 3m\n.end\n")
    data = (run.folder / "c.raw").read_bytes()
    path = run.folder / "bad.raw"
    for old, new in ((b"Command: * ngspice", b"Command: * spice3f"), (b"Title:", b"Tilte:"),
                     (b"Flags: real", b"Flags: none"), (b"v(/sw)\t", b"v(in)\t"),
                     (b"v(/sw)\t", b"v( /sw\t"), (b"No. Points: ", b"No. Points: -"),
                     (b"Transient Analysis", b"AC Analysis")):
        path.write_bytes(data.replace(old, new, 1))
        try:
            spicelib_rules.read(path)
            check(False, f"{old} as {new} is read")
        except spicelib_rules.Refused:
            pass
    header = ("Title: * x\nDate: today\nPlotname: Transient Analysis\nFlags: real forward stepped\n"
              "No. Variables: 2\nNo. Points:       4\nOffset: 0\nCommand: LTspice XVII\n"
              "Variables:\n\t0\ttime\ttime\n\t1\tV(a)\tvoltage\nBinary:\n")
    rows = [(0.0, 1.0), (2.0, 1.5), (0.0, 3.0), (2.0, 4.0)]
    path.write_bytes(header.encode("utf-16-le") + b"".join(struct.pack("<df", *r) for r in rows))
    plot = spicelib_rules.read(path)[0]
    check(plot.starts() == [0, 2] and plot.step("V(a)", 1) == [3.0, 4.0], "LTspice's own layout")


def main():
    checker = dalcs_program.Checker("raw readers")
    with tempfile.TemporaryDirectory() as folder:
        run = Runner(str(pathlib.Path(sys.argv[1]).resolve()), folder, checker)
        for test in (check_plots, check_several, check_steps, check_script, check_spyci, check_ngspice, check_rules):
            test(run, checker.check)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
