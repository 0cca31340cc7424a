#!/usr/bin/env python3
"""Every netlist of the tree that runs obeys its own laws, in a .raw file to 1e-6 and in a .csv file to 1e-3.

usage: own.py PROGRAM"""

import json
import pathlib
import subprocess
import sys
import tempfile

from audit_program import dalcs_program

# what gates write is not known beforehand; oscillators, pulses and samples
GATES = """gates between circuits
V1 c 0 SIN(2 1 100)
A1 c q vco
A2 q null null p pulse
R1 p f 10k
C1 f 0 0.1u
R2 q 0 1k
A3 f 0 q 0 0 0 h 0 SAMPLEHOLD
A4 f 0 0 0 0 n m 0 SCHMITT Vt=0.15 Vh=0.05 Tau=10u
R3 m h 1k
.model vco square(cntl_array=[0 4] freq_array=[0 40k] out_low=0)
.model pulse oneshot(cntl_array=[0 1] pw_array=[10u 10u])
.tran 1u 2m
.end
"""
FORMATS = {".raw": "1e-6", ".csv": "1e-3"}
# a formula that divides by 0 at every row: what is written is what was computed
WITHOUT_VALUES = """no value
V1 a 0 PULSE(0 1 1u 0 0 1u 3u)
R1 a 0 1
V2 z 0 0
R2 z 0 1
.save v(a) {v(a)/v(z)}
.tran 0.1u 10u
.end
"""


def rows_without_values(program, checker):
    for options in (("-o", "x.raw"), ("-o", "x.csv"), ("--ascii", "-o", "x.raw")):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "x.cir").write_text(WITHOUT_VALUES)
            ran = subprocess.run([program, "run", "x.cir", "--quiet", *options], cwd=folder, stdin=subprocess.DEVNULL,
                                 capture_output=True, text=True, check=False)
            checker.check(ran.returncode == 0, f"rows without values, {options}: {ran.stderr}")


def main(program):
    program = pathlib.Path(program).resolve()
    checker = dalcs_program.Checker("laws of dalcs's own files")
    asked = 0
    netlists = [None, *dalcs_program.some_of(sorted(dalcs_program.NETLISTS.rglob("*.cir")))]
    for netlist in netlists:
        with tempfile.TemporaryDirectory() as folder:
            if netlist is None:
                netlist = pathlib.Path(folder) / "gates.cir"
                netlist.write_text(GATES)
            for ending, tolerance in FORMATS.items():
                output = pathlib.Path(folder) / f"out{ending}"
                ran = subprocess.run([program, "run", netlist, "-o", output, "--quiet", "--audit", "off"],
                                     cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, check=False)
                if ran.returncode != 0 or not output.exists():
                    continue
                done = subprocess.run([program, "audit", netlist, output, "--tol", tolerance, "--json"],
                                      stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
                answer = json.loads(done.stdout) if done.stdout else {"laws": []}
                few = done.returncode == 2 and "not_asked" in answer and not answer["laws"]
                asked += len(answer["laws"])
                checker.check(done.returncode == 0 or few,
                              f"{netlist.name} as {ending}: status {done.returncode} {done.stderr}"
                              f"{[law for law in answer['laws'] if law['broken']]}")
    rows_without_values(program, checker)
    checker.check(asked > 3 * len(netlists), f"only {asked} laws were asked of {len(netlists)} netlists")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
