#!/usr/bin/env python3
"""`dalcs equations` of every netlist, read back as a system, gives the waveforms of the netlist.

usage: read_back.py DALCS FORMAT,... [FOLDER]

Each netlist and system file of netlists/, or of its FOLDER, and the netlists beside this test run by themselves
and from what `equations --format FORMAT` wrote. With the default method the rows are equal to the bit, and so are
status, events and jumps; with implicit Euler, tried in the first format, they agree to rounding (looking for what is
open asks the engine more often, and what it keeps has other last bits). With FORMAT lcs the unknowns z are
eliminated, and the rows agree to the tolerance of the method; both run with a hundredth of the default, for a voltage
across an open resistance R is then R times a difference of currents (netlists/converters/flyback_rcd: 1e7 ohm), and
what a step may miss of these shows R times as large. Of these only the rows of .tran are compared: rows that fill adds
stand where the waveform bends, which another arithmetic knows to its own digits."""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

import dalcs_program  # noqa: E402

ENDING = {"json": "json"}
REFUSED = 3
LCS_TOLERANCE = 1e-8


def write_system(program, netlist, folder, kind):
    """The file that `equations` wrote, or None where it refused."""
    target = pathlib.Path(folder) / f"system.{ENDING.get(kind, 'dalcs')}"
    options = ["--form", "lcs", "--format", "system"] if kind == "lcs" else ["--format", kind]
    done = subprocess.run([program, "equations", str(netlist), "-o", str(target)] + options,
                          capture_output=True, text=True, check=False)
    return (target if done.returncode == 0 else None), done


def has_products(done):
    """No file of matrices can hold these, and `equations` says so."""
    return "a system file has no products and functions" in done.stderr


def what_happened(run):
    report = run.report or {}
    return ([(event["time"], event["element"], event["state"]) for event in report.get("events", [])],
            [(jump["time"], jump["states"]) for jump in report.get("jumps", [])])


def compare_exactly(checker, name, found, wanted):
    checker.check(found.status == wanted.status,
                  f"{name}: status {found.status}, not {wanted.status}: {found.stderr}")
    checker.check(found.output == wanted.output, f"{name}: other rows")
    checker.check(what_happened(found) == what_happened(wanted), f"{name}: other events or jumps")


def compare_to_rounding(checker, name, found, wanted):
    """The same rows, up to 1e-11 of the largest value of their unit."""
    if not checker.check(found.status == wanted.status,
                         f"{name}: status {found.status}, not {wanted.status}: {found.stderr}"):
        return
    if found.output == wanted.output:
        return
    if not checker.check(found.names == wanted.names and len(found.rows) == len(wanted.rows),
                         f"{name}: other signals or times"):
        return
    found_columns, wanted_columns = list(zip(*found.rows)), list(zip(*wanted.rows))
    largest = {}
    for signal, column in zip(wanted.names, wanted_columns):
        unit = signal if signal == "time" else signal[0]
        largest[unit] = max(largest.get(unit, 0.0), max(map(abs, column)))
    for signal, mine, theirs in zip(wanted.names, found_columns, wanted_columns):
        allowed = 1e-11 * largest[signal if signal == "time" else signal[0]]
        error = max(abs(a - b) for a, b in zip(mine, theirs))
        checker.check(error <= allowed, f"{name}: {signal} off by {error:.2e}")


def compare_roughly(checker, name, found, wanted):
    """Another arithmetic, the same answers: within the tolerance of the method."""
    if not checker.check(found.status == wanted.status,
                         f"{name}: status {found.status}, not {wanted.status}: {found.stderr}"):
        return
    if wanted.status != 0:
        return
    checker.check(found.names == wanted.names, f"{name}: other signals")
    tick = 1e-10 * max(wanted.time, default=0.0) or 1.0  # events are found to rounding
    times = {round(row[0] / tick): row for row in found.rows}
    scale = [max(abs(row[k]) for row in wanted.rows) for k in range(len(wanted.names))]
    common = [row for row in wanted.rows if round(row[0] / tick) in times]
    checker.check(len(common) > 0.2 * len(wanted.rows), f"{name}: other times")
    sides = {}
    for row in wanted.rows:
        sides[row[0]] = sides.get(row[0], 0) + 1
    units = {kind: max(scale[k] for k in range(1, len(scale)) if wanted.names[k][0] == kind)
             for kind in {name[0] for name in wanted.names[1:]}}
    rows = [(row, times[round(row[0] / tick)]) for row in common if sides[row[0]] == 1]
    for k in range(1, len(wanted.names)):
        # a circuit that falls to rest has no current but what voltages near 0 make
        allowed = 2e-5 * max(units[wanted.names[k][0]], 1e-3 * max(units.values()), 1e-10)
        error, where = max((abs(row[k] - other[k]), row[0]) for row, other in rows)
        checker.check(error <= allowed, f"{name}: {wanted.names[k]} off by {error:.2e} at {where}")


def read_back_exactly(program, checker, netlist, kinds, folder):
    """Returns whether the netlist can be read at all."""
    name = netlist.name
    wanted = dalcs_program.run(program, netlist, method=None)
    for kind in kinds:
        system, done = write_system(program, netlist, folder, kind)
        if wanted.status == REFUSED or has_products(done):  # when it is read: there are no equations
            checker.check(done.returncode not in (0, -6, -11), f"{name}: {done.stderr}")
        elif checker.check(system is not None, f"{name}, {kind}: {done.stderr}"):
            compare_exactly(checker, f"{name}, {kind}",
                            dalcs_program.run(program, system, method=None), wanted)
            if kind == kinds[0]:
                compare_to_rounding(checker, f"{name} by euler",
                                    dalcs_program.run(program, system, report=False),
                                    dalcs_program.run(program, netlist, report=False))
    return wanted.status != REFUSED


def read_back_reduced(program, checker, netlist, folder):
    name = netlist.name
    options = {"method": None, "tolerance": LCS_TOLERANCE, "options": ["--fill", "none"]}
    wanted = dalcs_program.run(program, netlist, **options)
    system, done = write_system(program, netlist, folder, "lcs")
    if wanted.status == REFUSED or has_products(done):
        checker.check(done.returncode not in (0, -6, -11), f"{name}: {done.stderr}")
    elif checker.check(system is not None, f"{name}: {done.stderr}") and \
            "cannot be eliminated" not in done.stderr:
        compare_roughly(checker, name, dalcs_program.run(program, system, **options), wanted)
    return wanted.status != REFUSED


def main():
    program, kinds = sys.argv[1], sys.argv[2].split(",")
    checker = dalcs_program.Checker(f"read_back {sys.argv[2]}")
    netlists = [path for path in sorted(dalcs_program.NETLISTS.joinpath(*sys.argv[3:]).rglob("*"))
                if path.suffix in (".cir", ".dalcs")]
    netlists += [] if sys.argv[3:] else sorted(pathlib.Path(__file__).parent.glob("*.cir"))
    read = 0
    netlists = netlists if sys.argv[3:] else dalcs_program.some_of(netlists)
    for netlist in netlists:
        with tempfile.TemporaryDirectory() as folder:
            read += (read_back_reduced(program, checker, netlist, folder) if kinds == ["lcs"] else
                     read_back_exactly(program, checker, netlist, kinds, folder))
    checker.check(read > 0.8 * len(netlists), f"only {read} of {len(netlists)} netlists")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
