#!/usr/bin/env python3
"""What a call gives may be said with what it gives besides; F and H may read the current of a coil.

Each netlist is run beside the same one in another spelling: with numbers, or with a source of 0 V in series.

usage: call_parameters.py PROGRAM
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

PART = """.subckt part a b params: r=1k c=1u step=1
R1 a b {r}
C1 b 0 {c}
R2 b 0 {step}
.ends
V1 in 0 sin(0 10 50)
R9 out 0 1k
"""
CALLS = [
    ("beside", "r=2k step=0.5*r", "r=2k step=1k"),
    ("before it is said", "step=0.5*r r=2k", "r=2k step=1k"),
    ("a chain", "c=1n*k step=k*r r=300 k=3", "c=3n step=900 r=300 k=3"),
    ("in braces", "r={2*k} k=10 step={k+r}", "r=20 step=30 k=10"),
    ("in params:", "params: r=4k step={sqrt(r)}", "r=4k step=63.245553203367587"),
]
LOADS = [
    ("F of a coil", "L1 m 0 1m\nF1 0 y L1 2\nRy y 0 5", "Vm m n 0\nL1 n 0 1m\nF1 0 y Vm 2\nRy y 0 5"),
    ("H of a coil", "L1 m 0 1m\nH1 y 0 L1 3\nRy y 0 5", "Vm m n 0\nL1 n 0 1m\nH1 y 0 Vm 3\nRy y 0 5"),
    ("H of one of two coupled coils", "L1 m 0 1m\nL2 z 0 4m\nK1 L1 L2 0.9\nRz z 0 10\nH1 y 0 L2 3\nRy y 0 5",
     "L1 m 0 1m\nVm z n 0\nL2 n 0 4m\nK1 L1 L2 0.9\nRz z 0 10\nH1 y 0 Vm 3\nRy y 0 5"),
    ("F of a coil behind a diode", "D1 m d\nL1 d 0 1m\nF1 0 y L1 2\nRy y 0 5\nD2 0 d",
     "D1 m d\nVm d n 0\nL1 n 0 1m\nF1 0 y Vm 2\nRy y 0 5\nD2 0 d"),
    ("a speed that brakes", "L1 m e 1m\nH1 e 0 L2 0.1\nF1 0 w L1 0.1\nC9 w 0 1m\nRw w 0 10\nL2 w q 1u\nRq q 0 1",
     "Vl m l 0\nL1 l e 1m\nH1 e 0 Vm 0.1\nF1 0 w Vl 0.1\nC9 w 0 1m\nRw w 0 10\nL2 w s 1u\nVm s q 0\nRq q 0 1"),
]


def compare(checker, program, title, first, second, signal, at):
    results = [run(program, text, at=at, method="auto", options=["--audit", "full"]) for text in (first, second)]
    for result in results:
        if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
            return
    one, other = (result.column(signal) for result in results)
    size = max(map(abs, other))
    worst = max(abs(a - b) for a, b in zip(one, other))
    checker.check(size > 0 and worst <= 1e-8 * size, f"{title}: {worst:.2g} off of {size:.3g}")


def main():
    program = sys.argv[1]
    checker = Checker("call_parameters")
    at = [k * 1e-3 for k in range(1, 21)]
    for name, given, wanted in CALLS:
        texts = [f"{name}\n{PART}X1 in out part {words}\n.tran 1u 20m\n" for words in (given, wanted)]
        compare(checker, program, name, *texts, "v(out)", at)
    for given, wanted in (("r=q", "there is no parameter 'q'"), ("r=r", "there is no parameter 'r'"),
                          ("r=step step=r", "depends on itself")):
        result = run(program, f"refused\n{PART}X1 in out part {given}\n.tran 1u 20m\n")
        checker.check(result.status == 3 and wanted in result.stderr, f"{given}: {result.status}: {result.stderr}")
    for name, first, second in LOADS:
        texts = [f"{name}\nV1 in 0 sin(0 10 50)\nRs in m 2\n{load}\n.tran 1u 20m\n" for load in (first, second)]
        compare(checker, program, name, *texts, "v(w)" if "brakes" in name else "v(y)", at)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
