#!/usr/bin/env python3
"""Pictures of orbits, multipliers and loops: each by one command, and the same from files.

usage: pictures.py PROGRAM
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

NETLISTS = pathlib.Path(__file__).resolve().parents[1] / "steady" / "cases"

UNSTABLE = """Peak current control above half duty, without a ramp
Vin in 0 12
Vclk clk 0 PULSE(0 1 0 1n 1n 50n 10u)
S1 in sw ctl 0 sm
D1 0 sw
L1 sw out 20u
Vout out 0 8
B1 ctl 0 V=3-i(L1)+100*v(clk)
.model sm SW(Ron=0 Vt=0 Vh=0.05)
.pss uic
"""


def run(program, folder, *arguments):
    return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, check=False)


def check_bode(checker, program, folder):
    (folder / "vm.cir").write_text((NETLISTS / "buck_vm.cir").read_text())
    for ending in ("svg", "png", "pdf", "html"):
        done = run(program, folder, "bode", "vm.cir", "--loop", "vinj", "--from", "100", "--to", "45k",
                   "--report", "vm.json", "--plot", f"one.{ending}")
        checker.check(done.returncode == 0 and f"wrote     one.{ending}" in done.stdout, f"bode: {done.stderr}")
        done = run(program, folder, "plot", "vm.raw", "--report", "vm.json", "-o", f"two.{ending}")
        checker.check(done.returncode == 0, f"plot: {done.stderr}")
    margin = json.loads((folder / "vm.json").read_text())["response"]["crossovers"][0]
    own = f"{margin['phase_margin']:.3g} \u00b0 at {margin['frequency'] / 1e3:.4g} kHz"
    for name in ("one.svg", "two.svg"):
        text = (folder / name).read_text()
        checker.check(own in text and "phase(loop(vinj))" in text and "conducts" not in text, f"{name}: no '{own}'")
    for name in ("one.html", "two.html"):
        found = re.search(r'"lines": (\[.*?\])', (folder / name).read_text())
        lines = json.loads(found.group(1)) if found else []
        checker.check([(x["panel"], x["level"]) for x in lines] == [(0, True), (1, True), (1, False)]
                      and lines[2]["text"] == own and abs(lines[2]["at"] - margin["frequency"]) < 1e-6,
                      f"{name}: {lines}")
    done = run(program, folder, "plot", "vm.raw", "--report", "vm.json", "-s", "v(out)", "-o", "three.svg")
    checker.check(done.returncode == 0 and own not in (folder / "three.svg").read_text(), "signals of one's own")
    done = run(program, folder, "bode", "vm.cir", "-o", "vm.csv", "--plot", "four.svg")
    checker.check(done.returncode == 2 and "--plot draws a .raw file" in done.stderr, f"csv: {done.stderr}")


def check_phase(checker, program, folder):
    """Beyond half a turn the phase of a loop goes on."""
    (folder / "lag.cir").write_text("""Three lags beside a clock
Vclock clock 0 PULSE(0 1 0 0 0 2u 10u)
Rclock clock 0 1k
E1 a 0 0 z 100
R1 a b 1k
C1 b 0 1n
E2 c 0 b 0 1
R2 c d 1k
C2 d 0 1n
E3 e 0 d 0 1
R3 e f 1k
C3 f 0 1n
Vloop f z 0
.pss uic
""")
    done = run(program, folder, "bode", "lag.cir", "--loop", "vloop", "--from", "1k", "--to", "40meg", "-q",
               "--plot", "lag.html", "--report", "lag.json")
    page = (folder / "lag.html").read_text() if done.returncode == 0 else ""
    found = json.loads((folder / "lag.json").read_text())["response"]
    texts = re.findall(r'"text": "([^"]+)"', page)
    checker.check(done.returncode == 0 and len(found["reversals"]) == 1 and len(texts) == 2
                  and "dB at" in texts[1], f"lag: {texts} {found} {done.stderr}")
    done = run(program, folder, "bode", "lag.cir", "--loop", "vloop", "--from", "1k", "--to", "40meg", "-q",
               "--plot", "lag.svg")
    tics = {float(t) for t in re.findall(r">(-?\d+)<", (folder / "lag.svg").read_text())}
    checker.check(-250.0 in tics and not any(60 < t <= 180 for t in tics), f"phase from {sorted(tics)}")


def check_decibels(checker, program, folder):
    """A response without a loop is drawn in dB; what is 0 but for rounding is left out."""
    (folder / "db.cir").write_text("""A square wave that switches a filter
Vin in 0 DC 1 AC 1
Vhold hold 0 2
Rhold hold in 1k
Vclock clock 0 PULSE(0 1 0 0 0 2u 10u)
S1 in sw clock 0 sm
R1 sw out 100
C1 out 0 100n
R2 out 0 1k
E1 small 0 out 0 {small}
R3 small 0 1k
.model sm SW(Ron=1 Roff=1k Vt=0.5)
.param small=1e-12
.save v(in) v(hold) v(out) v(small)
.pss uic
""")
    for small, is_drawn in ("1e-12", True), ("1e-14", False):
        done = run(program, folder, "bode", "db.cir", "--from", "100", "--to", "10k", "-q", "--set", f"small={small}",
                   "--plot", "db.svg")
        picture = (folder / "db.svg").read_text() if done.returncode == 0 else ""
        checker.check("magnitude (dB)" in picture and "db(v(out))" in picture and "phase(v(out))" in picture
                      and "v(hold)" not in picture, f"decibels: {done.stderr}")
        checker.check(("v(small)" in picture) == is_drawn, f"a gain of {small}")


def check_orbit(checker, program, folder):
    (folder / "orbit.cir").write_text(UNSTABLE)
    for ending in ("svg", "html"):
        done = run(program, folder, "steady", "orbit.cir", "--plot", f"orbit.{ending}", "--multipliers-plot", "m.svg",
                   "--report", "orbit.json")
        checker.check(done.returncode == 0 and f"wrote     orbit.{ending}" in done.stdout
                      and "wrote     m.svg" in done.stdout, f"orbit: {done.stdout} {done.stderr}")
    checker.check("conducts" in (folder / "orbit.svg").read_text(), "the orbit has no modes")
    steady = json.loads((folder / "orbit.json").read_text())["steady"]
    picture = (folder / "m.svg").read_text()
    checker.check(not steady["stable"] and "i(l1)" in picture and "multipliers of a period" in picture, "multipliers")
    checker.check(("of the orbit of two periods" in picture) == ("doubled" in steady), "the orbit of two periods")
    done = run(program, folder, "steady", "orbit.cir", "-q", "--multipliers-plot", "m.html")
    page = (folder / "m.html").read_text() if done.returncode == 0 else ""
    checker.check(page.startswith("<!DOCTYPE html>") and "multipliers of a period" in page and "http" not in
                  page.replace("http://www.w3.org/", ""), f"a page of multipliers: {done.stderr}")
    for arguments, words in ((["run", "orbit.cir", "--multipliers-plot", "m.svg"], "an option of 'dalcs steady'"),
                             (["steady", "orbit.cir", "--multipliers-plot", "m.txt"], "unknown format of 'm.txt'"),
                             (["steady", "orbit.cir", "--plot", "m.txt"], "name it .svg, .png, .pdf or .html")):
        done = run(program, folder, *arguments)
        checker.check(done.returncode == 2 and words in done.stderr, f"{arguments}: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("pictures")
    with tempfile.TemporaryDirectory() as name:
        for look in (check_bode, check_phase, check_decibels, check_orbit):
            look(checker, program, pathlib.Path(name))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
