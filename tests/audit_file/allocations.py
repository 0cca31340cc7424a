#!/usr/bin/env python3
"""Makes each kind of allocation of `dalcs audit` fail, one after the other: it ends by itself with a status and a message,
or with the whole answer if it could do without that memory.

usage: allocations.py PROGRAM LIBRARY"""

import pathlib
import sys
import tempfile

from audit_program import dalcs_program, simulate
from formats import BRIDGE, NESTED, ltspice

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "alloc"))
from preload import ONCE, calls_to_fail, refused_runs  # noqa: E402


def main(program, library):
    program = str(pathlib.Path(program).resolve())
    checker = dalcs_program.Checker("allocations of dalcs audit")
    for name, netlist, as_raw in (("bridge", BRIDGE, True), ("nested", NESTED, False)):
        table = simulate(program, netlist)
        table.rows = table.rows[:40]
        if not as_raw:
            table = table.without("v(out)")
            table.names[-1] = "foreign"
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "circuit.cir").write_text(netlist)
            (folder / "waves").write_bytes(ltspice(table) if as_raw else table.csv().encode())
            command = [program, "audit", "circuit.cir", "waves", "--json"]
            done, _, numbers = calls_to_fail(library, command, folder)
            checker.check(done.returncode == 0, f"{name}: {done.returncode} {done.stderr}")
            for again in refused_runs(library, command, folder, [(number, ONCE) for number in numbers]):
                where = f"{name} at {again.number}"
                checker.check(again.tally.refused > 0, f"{where}: nothing was refused")
                good = again.returncode == 0 and again.stdout == done.stdout or \
                    1 <= again.returncode <= 4 and again.stderr.strip()
                checker.check(good, f"{where}: {again.returncode} {again.stderr}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
