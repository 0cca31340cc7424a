#!/usr/bin/env python3
"""What a large netlist takes until its equations stand: bytes at the peak and allocations, by element.

usage: large_netlist.py CHECK_NETLIST LIBRARY

A million elements are read in little more than the time that their memory takes to be touched.
"""

import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "support")]
from dalcs_program import Checker  # noqa: E402
from preload import run_preloaded  # noqa: E402

SIZES = [20000, 160000]
CALLS = 200         # more for eight times the elements: arrays grow and blocks double


def elements(n):
    """R, C, D, V by turns."""
    yield "elements\nV n0 0 1"
    for k in range(n // 4):
        yield (f"R{k} n{k} n{k + 1} {k % 997 + 1}.5k\nC{k} n{k + 1} 0 {k % 13 + 1}n\n"
               f"D{k} n{k + 1} m{k} diode\nV{k} m{k} 0 DC {k % 7}.25")
    yield ".model diode D\n.op\n.end\n"


def calls(n):
    """The same, every card a subcircuit call with a parameter."""
    yield "calls\nV n0 0 1\n.subckt part a b r=1k\nR1 a b {r}\n.ends"
    for k in range(n):
        yield f"X{k} n{k} n{k + 1} part r={k + 1}"
    yield f"R n{n} 0 1k\n.op\n.end\n"


def measure(program, library, name, cards, n):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "large.cir").write_text("\n".join(cards(n)))
        done, tally = run_preloaded(library, [program, "large.cir"], folder)
        if done.returncode != 0 or tally.live > 0.01 * tally.peak:
            raise AssertionError(f"status {done.returncode}, {tally.live} bytes never freed: "
                                 f"{done.stderr.decode()}")
        print(f"{name}: {n} elements, {tally.calls} allocations, {tally.peak / n:.0f} bytes each "
              f"at the peak, {tally.peak_rss * 1024 / n:.0f} resident")
        return tally


def main():
    program, library = sys.argv[1:]
    checker = Checker("large_netlist")
    # By element: bytes at the peak, with blocks that are not full, and allocations. Of the first 80 are the columns by
    # which the audit reads the operating point.
    for name, cards, bytes_each, calls_each in (("elements", elements, 850, 0),
                                                ("calls", calls, 1900, 1)):
        small, large = [measure(program, library, name, cards, n) for n in SIZES]
        checker.check(large.peak <= bytes_each * SIZES[1],
                      f"{name}: {large.peak / SIZES[1]:.0f} bytes each, wanted {bytes_each}")
        more = large.calls - small.calls - calls_each * (SIZES[1] - SIZES[0])
        checker.check(more <= CALLS, f"{name}: {large.calls} allocations for {SIZES[1]}, "
                                     f"{small.calls} for {SIZES[0]}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
