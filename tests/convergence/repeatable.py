#!/usr/bin/env python3
"""The same input gives the same bytes, and so does another address space.

usage: repeatable.py PROGRAM
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import NETLISTS, Checker, run  # noqa: E402

CASES = ["hard/hc06", "hard/hc16", "hard/hc17", "hard/hc24", "hard/hc25",
         "rectifiers/full_bridge", "rectifiers/full_bridge_cfilter_floating",
         "multipliers/greinacher", "converters/buck_dcm"]


def check(checker, case, method):
    netlist = NETLISTS / f"{case}.cir"
    first = run(sys.argv[1], netlist, method=method)
    # Long names move everything on the stack and on the heap.
    second = run(sys.argv[1], netlist, method=method,
                 environment={"DALCS_TEST_PADDING": "x" * 5000})
    checker.check(first.status == 0 and first.output,
                  f"{case} with {method}: exit {first.status}: {first.stderr}")
    checker.check(first.output == second.output, f"{case} with {method}: two runs differ")


def main():
    checker = Checker("repeatable")
    for case in CASES:
        for method in ("euler", "auto"):
            check(checker, case, method)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
