#!/usr/bin/env python3
"""What a netlist takes until its equations stand grows as it does, for each kind of card.

usage: linear_reading.py CHECK_NETLIST

Instructions are counted by valgrind for N and for 4 N cards, less those of a netlist of two. Where the work is in
proportion the second number is 4 of the first, with a logarithm a little more, where it is the square of the cards 16.
A part that grows with the square is seen from a twentieth of the whole at N cards.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import IS_LONG, Checker  # noqa: E402

N = 600 if IS_LONG else 300
MOST = 4.5
SKIPPED = 77


def each(n, pattern):
    """The lines of `pattern` for 0..n-1; J is the next number."""
    return [pattern.replace("J", str(k + 1)).replace("K", str(k)) for k in range(n)]


def nested(n):
    """As many calls, two in each subcircuit."""
    depth = n.bit_length() - 1
    cards = [line for k in range(depth) for line in
             (f".subckt s{k} a b", f"x1 a m s{k + 1}", f"x2 m b s{k + 1}", ".ends")]
    return cards + [f".subckt s{depth} a b", "r1 a b 1k", ".ends", "x0 n 0 s0", "v1 n 0 1", ".op"]


ONE = ["v1 n 0 1"]
SINE = ["v1 n 0 sin(0 1 1k)"]
RAMP = ["i1 0 a 1", "r1 a 0 1k", "c1 a 0 1u"]
TRAN = [".tran 1u 2u"]
OP = [".op"]

KINDS = {
    "a ladder": lambda n: each(n, "rK nK nJ 1k") + ["v1 n0 0 1", f"rl n{n} 0 1"] + OP,
    "parameters, each of the one before": lambda n: [".param p0=1"] + each(n, ".param pJ=pK+1") + [f"r1 n 0 {{p{n}}}"] + ONE + OP,
    "parameters, each of the one behind": lambda n: each(n, ".param pK=pJ+1") + [f".param p{n}=1", "r1 n 0 {p0}"] + ONE + OP,
    "parameters on a line": lambda n: [".param " + " ".join(each(n, "pK=J")), "r1 n 0 {p0}"] + ONE + OP,
    "parameters in use": lambda n: each(n, ".param pK=J\nrK n 0 {pK}") + ONE + OP,
    "functions": lambda n: each(n, ".func fK(x)={x+J}\nrK n 0 {fK(2)}") + ONE + OP,
    "nested subcircuits": nested,
    "subcircuit calls": lambda n: [".subckt s a b r=1k", "r1 a b {r}", "c1 a b 1n", ".ends"] + each(n, "xK n 0 s r=J") + ONE + OP,
    "subcircuits": lambda n: each(n, ".subckt sK a b\nr1 a b 1k\n.ends\nxK n 0 sK") + ONE + OP,
    "measurements": lambda n: RAMP + each(n, ".meas tran mK max v(a)") + TRAN,
    "measurements of differences": lambda n: each(n, "rK nK nJ 1k\n.meas tran mK max v(nK,nJ)") + ["v1 n0 0 1", f"rl n{n} 0 1"] + TRAN,
    "measurements of measurements": lambda n: RAMP + [".meas tran m0 max v(a)"] + each(n, ".meas tran mJ param='mK+1'") + TRAN,
    "formulas in a chain": lambda n: ["v1 n0 0 1"] + each(n, "bK nJ 0 v=v(nK)+1") + OP,
    "formulas of their own": lambda n: ONE + each(n, "bK mK 0 i=v(n)*2+v(mK)\nrK mK 0 1") + OP,
    "formulas with kinks": lambda n: SINE + each(n, "bK mK 0 v=abs(v(n))") + OP,
    "formulas of time": lambda n: each(n, "bK mK 0 v=sin(J*time)") + OP,
    "products with a gate": lambda n: ONE + each(n, "vgK gK 0 pulse(0 1 0 0 0 5u 10u)\nbK mK 0 v=v(gK)*v(n)\nrK mK 0 1") + TRAN,
    "comparators with switches": lambda n: SINE + [".model sw sw(vt=0 ron=1)"] + each(
        n, "bK gK 0 v={v(n)>0.1J ? 1 : 0}\nsK n mK gK 0 sw\nrK mK 0 1") + TRAN,
    "sources": lambda n: each(n, "vK nK 0 1\nrK nK 0 1") + OP,
    "pulses": lambda n: each(n, "vK nK 0 pulse(0 1 0 1u 1u 5u 10u)\nrK nK 0 1") + TRAN,
    "current controls": lambda n: each(n, "vK nK 0 1\nfK nK 0 vK 2\nrK nK 0 1") + OP,
    "sources that are resistors": lambda n: ONE + each(n, "vmK n qK 0\nhK qK mK vmK 2\ngK mK 0 mK 0 1") + OP,
    "H in a chain with its V": lambda n: ["v1 n0 0 1"] + each(n, "hK nK nJ v1 -2") + [f"rl n{n} 0 1"] + OP,
    "models": lambda n: ONE + each(n, "dK n mK dmK\nrK mK 0 1\n.model dmK d(ron=J)") + OP,
    "tolerances": lambda n: ONE + [".model rb res(r=1 lot=5%)"] + each(n, "rK n mK rb 1k dev=1%\nrbK mK 0 1 lot/1=2%") + OP + [
        ".mc 2"],
    "models with tolerances": lambda n: ONE + each(n, "dK n mK dmK\nrK mK 0 1\n.model dmK d(ron=J dev=1% lot=1%)") + OP + [".mc 2"],
    "scaled diodes": lambda n: ONE + [".model dm d(is=1e-14)"] + each(n, "dK n mK dm J\nrK mK 0 1") + OP,
    "switches": lambda n: ONE + [".model sw sw(vt=0.5 ron=1)"] + each(n, "sK n mK n 0 sw\nrK mK 0 1") + OP,
    "initial voltages": lambda n: ONE + each(n, "rK n mK 1\ncK mK 0 1u\n.ic v(mK)=J") + [".tran 1u 2u uic"],
    "initial voltages on a line": lambda n: ONE + each(n, "rK n mK 1\ncK mK 0 1u") + [".ic " + " ".join(each(n, "v(mK)=1")),
                                                                                 ".tran 1u 2u uic"],
    "saved signals": lambda n: ONE + each(n, "rK n mK 1\ncK mK 0 1u\n.save v(mK) i(rK) v(n,mK)") + TRAN,
    "printed signals": lambda n: ONE + each(n, "rK n mK 1\ncK mK 0 1u\n.print tran v(mK) v(n,mK)") + TRAN,
    "couplings": lambda n: SINE + each(n, "laK n 0 1m\nlbK mK 0 1m\nkK laK lbK 0.9\nrK mK 0 1") + OP,
    "points of a waveform": lambda n: ["v1 n 0 pwl(0 0"] + each(n, "+ Ju J") + ["+ )", "r1 n 0 1"] + TRAN,
    "polynomials": lambda n: ONE + each(n, "eK mK 0 poly(2) n 0 mK 0 1 2 3\nrK mK 0 1") + OP,
    "global nodes": lambda n: [".global " + " ".join(each(n, "gK"))] + each(n, "rK gK 0 1") + ["v1 g0 0 1"] + OP,
    "spectra": lambda n: ["v1 n0 0 sin(0 1 1k)"] + each(n, "rK nK nJ 1\n.four 1k v(nK)") + [f"rl n{n} 0 1", ".tran 1u 1m"],
    "nodes with one connection": lambda n: ONE + each(n, "rK n mK 1k") + OP,
}


def instructions(program, folder, netlists):
    """What each netlist takes; all are read by one process, so that valgrind translates the program once."""
    paths = []
    for k, cards in enumerate(netlists):
        paths.append(folder / f"{k}.cir")
        paths[-1].write_text("\n".join(["t", *cards, ".end", ""]))
    subprocess.run(["valgrind", "--tool=callgrind", "--dump-after=check_netlist", f"--callgrind-out-file={folder / 'out'}",
                    program, "--each", *paths], capture_output=True, check=False,
                   env={**os.environ, "MALLOC_PERTURB_": "0"})  # filling blocks that double is no reading
    found = []
    for k in range(1, len(paths) + 1):
        dump = folder / f"out.{k}"
        total = re.search(r"^(?:totals|summary): (\d+)", dump.read_text(), re.MULTILINE) if dump.exists() else None
        found.append(int(total.group(1)) if total else None)
    return found


def main():
    checker = Checker("linear_reading")
    if shutil.which("valgrind") is None:
        return SKIPPED
    netlists = [["r1 n 0 1", *ONE, *OP]] * 2 + [cards(n) for cards in KINDS.values() for n in (N, 4 * N)]
    with tempfile.TemporaryDirectory() as folder:
        # The first has the start of the program, too.
        _, start, *counts = instructions(sys.argv[1], pathlib.Path(folder), netlists)
    for name, *count in zip(KINDS, counts[::2], counts[1::2]):
        if checker.check(None not in (start, *count), f"{name}: {start} {count}"):
            ratio = (count[1] - start) / (count[0] - start)
            checker.check(ratio <= MOST, f"{name}: {start}, {count} instructions, {ratio:.2f} of {N} cards for {4 * N}")
            print(f"{name}: {start} {count} {ratio:.2f}")
    return checker.finish()


sys.exit(main())
