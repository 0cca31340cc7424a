#!/usr/bin/env python3
"""Files that ngspice made: linear circuits and switches keep their laws; diodes that are exponentials break those of
ideal ones by their forward voltage, which is told at the diode; and faults are found there as well.

usage: simulators.py PROGRAM NGSPICE"""

import pathlib
import subprocess
import sys
import tempfile

from audit_program import audit, dalcs_program

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
import ngspice_batch  # noqa: E402

RIGHT = {
    "a filter": """filter
V1 in 0 SIN(3 5 1k)
R1 in a 10
L1 a b 1m
C1 b 0 1u ic=2
R2 b 0 1k
.save all @r1[i] @c1[i] @r2[i]
.tran 2u 3m uic
""",
    "edges of no width": """edges
V1 in 0 PULSE(0 5 1m 0 0 2m 5m)
R1 in a 10
L1 a b 1m
C1 b 0 1u
R2 b 0 1k
.tran 10u 10m
""",
    "coupled coils": """coupled coils
V1 in 0 SIN(0 10 1k)
R1 in a 1
L1 a 0 1m
L2 b 0 4m
K1 L1 L2 0.95
R2 b 0 100
C2 b 0 1u
.tran 1u 5m
""",
    "sources that read": """controlled
V1 in 0 PULSE(0 1 0.1m 10u 10u 0.4m 1m)
R1 in 0 1k
E1 e 0 in 0 5
R2 e m 100
Vs m n 0
C1 n 0 1u
F1 0 f Vs 10
R3 f 0 10
H1 h 0 Vs 20
R4 h 0 50
G1 0 g n 0 1m
R5 g 0 1k
C5 g 0 10n
B1 bb 0 V=2*v(n)+v(g)
R6 bb 0 1k
B2 0 bc I=1m*v(n)
R7 bc 0 1k
.tran 1u 3m
""",
    "all currents, some of them twice": """savecurrents
I1 0 a 1m
I2 a 0 SIN(0 1m 1k)
R1 a 0 1k
L1 a b 1m
R2 b 0 10
C1 a 0 1u
B1 a 0 I=1m*v(a)
B2 c 0 V=2*v(a)
R3 c 0 1k
E1 d 0 a 0 2
R4 d 0 1k
G1 a 0 c 0 1m
.options savecurrents
.tran 2u 1m
""",
    "a switch with hysteresis": """relay
V1 c 0 SIN(0 2 100)
V2 s 0 10
S1 s out c 0 sw1
R1 out 0 10
.model sw1 SW(Ron=0.1 Roff=1Meg Vt=0.5 Vh=0.3)
.tran 10u 30m
""",
    "a switch by a pulse": """pwm
V1 g 0 PULSE(0 1 0 0 0 4u 10u)
V2 s 0 10
S1 s x g 0 sw1
R0 x 0 1
L1 x out 10u
R1 out 0 1
C1 out 0 10u
.model sw1 SW(Ron=0.1 Roff=1Meg Vt=0.5)
.tran 0.1u 300u
""",
    "functions of time": """functions
V1 a 0 PWL(0 0 1m 1 2m 1 2.1m 0 3m 2)
V2 b 0 EXP(0 1 0.1m 0.2m 1m 0.5m)
V3 c 0 SFFM(0 1 10k 5 1k)
R1 a x 1k
R2 b x 1k
R3 c x 1k
C1 x 0 100n
.tran 2u 3m
""",
    "an operating point": """rest
V1 a 0 DC 5 SIN(0 1 1k)
R1 a b 1k
L1 b 0 1m
C1 b 0 1u
.op
""",
}

HALF = """half wave
V1 in 0 SIN(0 10 50)
D1 in out dd
C1 out 0 20u
R1 out 0 1k
.model dd D
.tran 20u 40m uic
"""
BRIDGE = """bridge
V1 a b SIN(0 10 50)
D1 a p dd
D2 b p dd
D3 0 a dd
D4 0 b dd
C1 p 0 100u
R1 p 0 1k
.model dd D
.tran 20u 60m
"""


def simulate(ngspice, folder, netlist, ascii_values=False):
    folder = pathlib.Path(folder)
    text = ngspice_batch.in_its_order(netlist).rstrip("\n") + ("\n.options filetype=ascii" if ascii_values else "") + "\n.end\n"
    (folder / "ngspice.cir").write_text(text)
    done = subprocess.run([ngspice, "-b", "-r", "out.raw", "ngspice.cir"], cwd=folder, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, check=False, timeout=60)
    output = folder / "out.raw"
    assert output.exists(), done.stdout + done.stderr
    content = output.read_bytes()
    output.unlink()
    return content


def check_diodes(checker, program, ngspice, folder):
    for what, netlist, diodes in (("half wave", HALF, ["d1"]), ("bridge", BRIDGE, ["d1", "d2", "d3", "d4"])):
        for ascii_values in (False, True):
            found = audit(program, folder, netlist, simulate(ngspice, folder, netlist, ascii_values), "waves.raw")
            broken = set(found.broken)
            checker.check(found.status == 1 and {("BRANCH", d) for d in diodes} <= broken,
                          f"{what}: {found.broken} {found.stderr}")
            checker.check(all(law in ("BRANCH", "CURRENT") and where in diodes for law, where in broken),
                          f"{what}: more than diodes: {found.broken}")
            drop = found.law("BRANCH", diodes[0])
            checker.check(drop["unit"] == "V" and 0.6 < drop["defect"] < 0.9, f"{what}: {drop}")


def check_faults(checker, program, ngspice, folder):
    for name, old, new, worst in (("a filter", "C1 b 0 1u", "C1 b 0 1.05u", ("BRANCH", "c1")),
                                  ("a filter", "L1 a b 1m", "L1 a b 1.05m", ("BRANCH", "l1")),
                                  ("a filter", "SIN(3 5", "SIN(3 5.05", ("BRANCH", "v1")),
                                  ("coupled coils", "0.95", "0.93", ("BRANCH", "l2")),
                                  ("a switch with hysteresis", "Vh=0.3", "Vh=0.2", ("POSITION", "s1")),
                                  ("a switch by a pulse", "4u 10u", "5u 10u", ("BRANCH", "v1"))):
        content = simulate(ngspice, folder, RIGHT[name])
        found = audit(program, folder, RIGHT[name].replace(old, new), content, "waves.raw")
        checker.check(found.status == 1 and found.broken[0] == worst, f"{name}, {new}: {found.broken}")


def main(program, ngspice):
    checker = dalcs_program.Checker("files of ngspice")
    with tempfile.TemporaryDirectory() as folder:
        for what, netlist in RIGHT.items():
            found = audit(program, folder, netlist, simulate(ngspice, folder, netlist), "waves.raw")
            checker.check(found.status == 0, f"{what}: {found.answer and found.answer['laws'][:3]} {found.stderr}")
            checker.check(found.answer and not found.not_asked, f"{what}: {found.not_asked}")
            checker.check(found.answer and not found.answer["foreign"], f"{what}: {found.answer and found.answer['foreign']}")
        check_diodes(checker, program, ngspice, folder)
        check_faults(checker, program, ngspice, folder)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
