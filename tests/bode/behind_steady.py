#!/usr/bin/env python3
"""A response behind a steady state looks for no orbit of its own.

usage: behind_steady.py PROGRAM

`.pss` and `.ac` in one netlist give the rows of `dalcs bode`, byte for byte, and take no step more than `.pss` alone.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

SWITCH = ".model sm SW(Ron=10m Vt=0.5)\n"
CASES = {
    "boost in discontinuous conduction": """Vin in 0 DC 5 AC 1
Vg g 0 PULSE(0 1 0 0 0 3u 10u)
L1 in sw 5u
S1 sw 0 g 0 sm
D1 sw out
C1 out 0 100u
R1 out 0 50
.pss uic
""" + SWITCH,
    "a flip-flop that halves its clock": """Vin in 0 DC 12 AC 1
Vclk clk 0 PULSE(0 1 0 0 0 1u 5u)
A1 nq 0 clk 0 0 nq q 0 DFLOP
S1 in sw q 0 sm
D1 0 sw
L1 sw out 47u
C1 out 0 47u
R1 out 0 3
.pss uic
""" + SWITCH,
    "hysteretic, with a period of its own": """Vin in 0 DC 12 AC 1
Vref ref 0 5
S1 in sw ref fb mos
D1 0 sw
L1 sw out 22u
C1 out esr 100u
Resr esr 0 100m
R1 out 0 5
Rf out fb 1k
Cf fb 0 1n
.model mos SW(Ron=5m Vt=0 Vh=20m)
.pss uic
""",
    "two periods of an orbit that is unstable": """Vin in 0 DC 10 AC 1
L1 in sw 1m
S1 sw 0 u 0 latch
D1 sw out
C1 out 0 12u
R1 out 0 20
Vclk clk 0 PULSE(0 1 0 0 0 1u 100u)
Bl u 0 V=2*v(clk)-3*u(i(L1)-1.6)
.model latch SW(Vt=0 Vh=1)
.pss periods=2 uic
""",
}


def run(program, folder, verb, netlist):
    (folder / "c.cir").write_text(netlist + ".end\n")
    done = subprocess.run([program, verb, "c.cir", "-q", "-o", "c.csv", "--report", "c.json"], cwd=folder,
                          capture_output=True, text=True, check=False)
    report = json.loads((folder / "c.json").read_text()) if done.returncode == 0 else {}
    return done, report, (folder / "c.csv").read_text() if done.returncode == 0 else ""


def tolerance(checker, program, folder):
    """It is that of the search, too."""
    netlist = "boost\n" + CASES["boost in discontinuous conduction"] + ".ac list 1k\n.end\n"
    (folder / "c.cir").write_text(netlist)
    done = subprocess.run([program, "run", "c.cir", "-q", "-o", "none", "--tol", "1e-11"], cwd=folder, capture_output=True,
                          text=True, check=False)
    checker.check(done.returncode == 0 and done.stderr == "", f"--tol: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("behind a steady state")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for case, text in CASES.items():
            netlist = f"{case}\n{text}"
            both, together, rows = run(program, folder, "run", netlist + ".ac list 1k 23k 77k\n")
            alone, steady, _ = run(program, folder, "steady", netlist)
            bode, _, expected = run(program, folder, "bode", netlist + ".ac list 1k 23k 77k\n")
            if not checker.check((both.returncode, alone.returncode, bode.returncode) == (0, 0, 0),
                                 f"{case}: {both.stderr}{alone.stderr}{bode.stderr}"):
                continue
            checker.check(rows == expected, f"{case}: rows are not those of dalcs bode")
            checker.check(both.stderr.count("period") == alone.stderr.count("period"), f"{case}: told twice: {both.stderr}")
            for key in ("steps", "factorizations"):
                checker.check(together["work"][key] == steady["work"][key],
                              f"{case}: {together['work'][key]} {key}, and {steady['work'][key]} for .pss alone")
        tolerance(checker, program, folder)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
