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


# the lines of exponential diodes follow from the currents that they carry, and so does what the file is held to
EXPONENTIAL = {
    "half wave": "V1 a 0 SIN(0 10 50)\nD1 a b dd\nR1 b 0 1k\n.tran 0.1m 40m\n",
    "bridge": "V1 a b SIN(0 12 50)\nD1 a p dd\nD2 b p dd\nD3 m a dd\nD4 m b dd\nC1 p m 100u\nR1 p m 1k\nR2 m 0 1meg\n"
              ".tran 0.1m 100m\n",
    "from 60 ms on": "V1 a 0 SIN(0 12 50)\nD1 a p dd\nC1 p 0 100u\nR1 p 0 100\n.tran 0.1m 100m 60m\n",
    "breakdown": "V1 a 0 SIN(0 20 50)\nR1 a b 470\nD1 0 b dz\nR2 b 0 10k\n.tran 0.1m 60m\n",
    "boost": "V1 in 0 12\nL1 in x 100u\nS1 x 0 g 0 sw\nV2 g 0 PULSE(0 1 0 1n 1n 4u 10u)\nD1 x o dd\nC1 o 0 22u\n"
             "R1 o 0 20\n.tran 1u 2m\n",
    "at rest": "I1 0 a 10m\nD1 a 0 dd\n.op\n",
    "cells": "V1 a 0 SIN(0 10 50)\nD1 a b dd n=3\nD2 b c dd m=2\nR1 c 0 100\n.tran 0.1m 40m\n",
}
EXPONENTIAL_MODELS = """.model dd D(IS={} N=1.75 RS=0.5)
.model dz D(IS={} N=1.6 RS=1 BV=5.1 IBV=1m NBV=1.5)
.model sw SW(Ron=10m Roff=1meg Vt=0.5)
.end
"""


def exponential_diodes(program, checker):
    for name, circuit in EXPONENTIAL.items():
        with tempfile.TemporaryDirectory() as folder:
            for netlist, saturation in (("x.cir", "2.5n"), ("other.cir", "5n")):
                text = f"{name}\n{circuit}" + EXPONENTIAL_MODELS.format(saturation, saturation)
                (pathlib.Path(folder) / netlist).write_text(text)
            for output in ("x.raw", "x.csv"):
                status = [subprocess.run([program, *arguments], cwd=folder, stdin=subprocess.DEVNULL,
                                         capture_output=True, check=False).returncode
                          for arguments in (("run", "x.cir", "-o", output, "--quiet"), ("audit", "x.cir", output),
                                            ("audit", "other.cir", output))]
                checker.check(status == [0, 0, 1], f"exponential diodes, {name}, {output}: {status}")


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
    exponential_diodes(program, checker)
    checker.check(asked > 3 * len(netlists), f"only {asked} laws were asked of {len(netlists)} netlists")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
