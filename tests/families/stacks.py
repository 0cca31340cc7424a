#!/usr/bin/env python3
"""Stacks of diodes between equal sections: any number of them is one capacitor behind one diode.

usage: stacks.py PROGRAM euler|auto [MOST_SECTIONS]

A chain of N nodes, each with C and R to ground, the first one fed through a resistor; between them
stacks of M ideal diodes. All nodes have the same voltage at all times, that of N C and R/N behind a
single diode. While they discharge alike, all diodes are tied, no resistor is at the nodes inside a
stack, and rounding of the capacitors' currents is all that flows there.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

SOURCES = {"sine": "sin(0 10 2k)", "pulse": "pulse(0 10 20u 1u 1u 200u 500u)"}
SIZES = [(3, 2), (12, 1), (12, 2), (12, 4), (30, 2), (30, 3)]


def chain(source, sections, stack, capacitance, resistance):
    lines = ["stacks", f"v1 in 0 {source}", "rs in n0 10"]
    for k in range(1, sections + 1):
        nodes = [f"n{k - 1}"] + [f"f{k}_{m}" for m in range(1, stack)] + [f"n{k}"]
        lines += [f"d{k}_{m} {nodes[m]} {nodes[m + 1]} di" for m in range(stack)]
        lines += [f"c{k} n{k} 0 {capacitance!r}", f"rl{k} n{k} 0 {resistance!r}"]
    return "\n".join(lines + [".model di d", ".tran 1u 1m uic", ""])


def main():
    program, method = sys.argv[1:3]
    most = int(sys.argv[3]) if sys.argv[3:] else 30
    options = {"method": "euler", "step": 1e-6} if method == "euler" else {"method": None}
    checker = Checker(f"stacks {method}")
    at = [(k + 0.382) * 1e-5 for k in range(99)] if method == "auto" else None
    for name, source in SOURCES.items():
        for sections, stack in (size for size in SIZES if size[0] <= most):
            case = f"{name}, {sections} sections, {stack} diodes each"
            whole = run(program, chain(source, 1, 1, 1e-7 * sections, 1e3 / sections), at=at, **options)
            result = run(program, chain(source, sections, stack, 1e-7, 1e3), at=at, **options)
            if not (checker.check(whole.status == 0, f"{case}: {whole.stderr}")
                    and checker.check(result.status == 0, f"{case}: {result.stderr}")):
                continue
            exact = whole.column("v(n1)")
            scale = max(map(abs, exact))
            # Of the default method twice its own tolerance: both runs are approximations.
            tolerance = 1e-11 if method == "euler" else 2e-6
            worst = max(abs(a - b) for k in (1, sections // 2 + 1, sections)
                        for a, b in zip(result.column(f"v(n{k})"), exact)) / scale
            print(f"{case}: {worst:.1e}")
            checker.check(worst <= tolerance, f"{case}: off by {worst:.1e} of the scale")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
