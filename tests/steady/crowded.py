#!/usr/bin/env python3
"""Searches for a steady state where a switch undoes at once what makes it switch.

usage: crowded.py PROGRAM

A comparator that fires a charge pump, whose output it compares, has no end of it: each stroke lifts the threshold above the
ramp, which reaches it again in no time. One period took as long as a hundred thousand one-step problems, so that the search
had no end. It ends with the reason. Where a switch that slides lets the circuit come back, the state is found as ever.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

PUMP = """A comparator fires the pump that it compares
Vin in 0 6
Vr r 0 PULSE(0 1 0 20u 0 0 20u)
S1 in ck r c s0
S2 0 ck c r s0
E1 c 0 out 0 {gain}
C1 ck a 100n
D1 in a
D2 a out
C2 out 0 1u
R1 out 0 3k
Ra a out 40k
.model s0 SW(Ron=0 Vt=0{hysteresis})
"""
HELD = """A switch holds a voltage by sliding
V1 a 0 {volts}
Vref ref 0 {held}
S1 a b ref c s0
R1 b c {ohms}
C1 c 0 {store}
R2 c 0 {{5 * {ohms}}}
Vg g 0 PULSE(0 1 0 0 0 {{0.4 * {clock}}} {clock})
S2 c d g 0 s1
R3 d 0 {{4 * {ohms}}}
.model s0 SW(Ron=1 Vt=0)
.model s1 SW(Ron=1 Vt=0.5)
.pss uic
"""


def run(program, folder, verb, netlist):
    (folder / "c.cir").write_text(netlist + ".end\n")
    done = subprocess.run([program, verb, "c.cir", "-q", "-o", "c.csv", "--report", "c.json"], cwd=folder,
                          capture_output=True, text=True, check=False)
    return done, json.loads((folder / "c.json").read_text())


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("crowded")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        pump = PUMP.format(gain="80m", hysteresis="")
        done, _ = run(program, folder, "steady", pump + ".pss uic\n")
        checker.check(done.returncode == 1 and "events crowd, or a switch slides" in done.stderr, f"pump: {done.stderr}")
        done, report = run(program, folder, "run", pump + ".tran 1u 45u uic\n")
        problems = report["work"]["osnsp"]  # 27 segments were tried where each step has a jump, and 900 000 problems solved
        checker.check(problems < 450000, f"the run: {problems} one-step problems")
        checker.check("did not agree" in done.stderr or "slides along its threshold" in done.stderr, f"the run: {done.stderr}")
        for volts, held, ohms, store, clock in ((5, 2, 1e3, 1e-6, 1e-3), (40, 11, 20.0, 1e-6, 1e-4), (0.6, 0.25, 1e5, 1e-9, 2e-4)):
            done, report = run(program, folder, "steady", HELD.format(volts=volts, held=held, ohms=ohms, store=store, clock=clock))
            if checker.check(done.returncode == 0, f"{volts} V: {done.stderr}"):
                off = abs(report["steady"]["states"]["c1"] - held) / held
                checker.check(off <= 1e-9 and not report["steady"]["exact"], f"{volts} V: off by {off:.2g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
