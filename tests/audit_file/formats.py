#!/usr/bin/env python3
"""Files of other programs: LTspice's raw files, names as others write them, few digits, signals that are missing,
files of another circuit, and what the command line says.

usage: formats.py PROGRAM SOURCE_ROOT"""

import json
import pathlib
import struct
import sys
import tempfile

import jsonschema

from audit_program import Table, audit, dalcs_program, simulate

BRIDGE = """bridge
V1 a b SIN(0 10 50)
D1 a p
D2 b p
D3 0 a
D4 0 b
C1 p 0 100u
R1 p 0 1k
.tran 20u 60m
"""
NESTED = """a rectifier within
.subckt half in out
D1 in m
R1 m out 10
.ends
V1 in 0 SIN(0 5 100)
X1 in out half
C1 out 0 10u
R1 out 0 1k
.save v(in) v(x1.m) v(out) i(v1) i(x1.d1) i(x1.r1) i(c1)
.tran 10u 20m
"""


def type_of(name):
    return "time" if name == "time" else "voltage" if name[0] in "vV" else "device_current"


def ltspice(table, double=False, by_signal=False, offset=0.0, mark_times=False):
    """A raw file as LTspice writes it: UTF-16, times of 8 bytes, values of 4; the sign of a time is no matter."""
    flags = "real forward" + (" double" if double else "") + (" fastaccess" if by_signal else "")
    header = (f"Title: * circuit\nDate: Thu Nov 26 09:00:00 2026\nPlotname: Transient Analysis\nFlags: {flags}\n"
              f"No. Variables: {len(table.names)}\nNo. Points: {len(table.rows):8}\n"
              f"Offset: {offset:.16e}\nCommand: Linear Technology Corporation LTspice XVII\nVariables:\n")
    header += "".join(f"\t{k}\t{name}\t{type_of(name)}\n" for k, name in enumerate(table.names))
    header += "Binary:\n"
    value = "<d" if double else "<f"
    times = [(row[0] - offset) * (-1.0 if mark_times and k % 3 == 1 else 1.0)
             for k, row in enumerate(table.rows)]
    if by_signal:
        body = [struct.pack("<d", t) for t in times]
        body += [struct.pack(value, row[c]) for c in range(1, len(table.names)) for row in table.rows]
    else:
        body = [struct.pack("<d", t) + b"".join(struct.pack(value, x) for x in row[1:])
                for t, row in zip(times, table.rows)]
    return header.encode("utf-16-le") + b"".join(body)


def check_ltspice(checker, program, folder):
    table = simulate(program, BRIDGE)
    table.names = [{"v(a)": "V(A)", "i(d1)": "I(D1)"}.get(name, name) for name in table.names]
    late = Table(table.names, [row for row in table.rows if row[0] >= 20e-3])
    nudged, time = table.nudged("V(A)", 31e-3, 0.5)
    for what, made, options in (("plain", table, {}), ("double", table, {"double": True}),
                                ("by signal", table, {"by_signal": True}),
                                ("marked times", table, {"mark_times": True}),
                                ("an offset", late, {"offset": 20e-3})):
        found = audit(program, folder, BRIDGE, ltspice(made, **options), "waves.raw")
        checker.check(found.status == 0 and found.answer["rows"] == len(made.rows),
                      f"LTspice, {what}: {found.status} {found.stderr} {found.answer and found.broken}")
        checker.check(found.answer["signals"] == len(made.names) - 1, f"LTspice, {what}: signals")
        checker.check(abs(found.answer["from"] - made.rows[0][0]) < 1e-12, f"LTspice, {what}: from")
    found = audit(program, folder, BRIDGE, ltspice(nudged), "waves.raw")
    checker.check(found.status == 1 and found.answer["laws"][0]["to"] == time, f"LTspice, nudged: {found.broken}")
    # what 24 bits leave open is allowed for, and no more: of 10 V that is 6e-7 V
    found = audit(program, folder, BRIDGE, ltspice(table), "waves.raw", ("--json", "--tol", "1e-9"))
    checker.check(("BRANCH", "v1") not in found.broken and ("CURRENT", "d1") not in found.broken,
                  f"LTspice, digits: {found.broken}")
    found = audit(program, folder, BRIDGE.replace("0 10 50", "0 10.0001 50"), ltspice(table), "waves.raw",
                  ("--json", "--tol", "1e-9"))
    checker.check(("BRANCH", "v1") in found.broken, "LTspice: 1e-5 of an amplitude is not seen")


NAMES = [
    {},
    {"v(in)": "V(IN)", "v(x1.m)": "V(x1:m)", "i(v1)": "I(V1)", "i(x1.d1)": "I(x1:D1)", "i(c1)": "I(C1)"},
    {"i(x1.d1)": "I(d:x1:1)", "i(x1.r1)": "I(r:x1:1)"},
    {"i(v1)": "v1#branch", "i(x1.d1)": "@d.x1.d1[id]", "i(x1.r1)": "@r.x1.r1[i]", "i(c1)": "@c1[i]"},
    {"i(v1)": "i(v1)", "i(x1.d1)": "i(@d.x1.d1[id])", "i(x1.r1)": "i(@r.x1.r1[i])", "i(c1)": "i(@c1[i])"},
    {"v(in)": "in", "v(x1.m)": "x1.m", "v(out)": "OUT"},
]


def check_names(checker, program, folder):
    table = simulate(program, NESTED)
    for names in NAMES:
        made = table.copy()
        made.names = [names.get(name, name) for name in made.names]
        found = audit(program, folder, NESTED, made)
        checker.check(found.status == 0 and found.answer["signals"] == 7 and not found.answer["foreign"],
                      f"{made.names}: {found.answer and found.answer['foreign']} {found.stderr}")
    differences = table.copy()
    m, out = table.index("v(x1.m)"), table.index("v(out)")
    for row in differences.rows:
        row[m] -= row[out]
    differences.names[m] = "v(x1.m,out)"
    found = audit(program, folder, NESTED, differences)
    checker.check(found.status == 0 and found.answer["signals"] == 7, f"a difference: {found.broken}")


def check_twin_currents(checker, program, folder):
    """Currents that a file has twice, as ngspice's savecurrents writes them, and that of a source."""
    netlist = "twins\ni1 0 a 1m\nl1 a b 1m\nr1 b 0 10\nr2 a 0 1k\n.tran 1u 100u\n"
    table = simulate(program, netlist)
    current = table.index("i(l1)")
    for factor in (1.0, 1.1):
        twins = Table([*table.names, "i(@l1[i])", "i(@i1[current])"],
                      [[*row, factor * row[current], 1e-3] for row in table.rows])
        found = audit(program, folder, netlist, twins)
        checker.check(found.status == 0 and not found.answer["foreign"], f"twins: {found.answer} {found.stderr}")
        checker.check(("both the current of 'l1', and differ" in found.stderr) == (factor != 1.0),
                      f"twins, times {factor}: {found.stderr}")
    found = audit(program, folder, netlist, twins.scaled("i(@i1[current])", 1.1))
    checker.check(found.status == 1 and ("CURRENT", "i1") in found.broken, f"the current of i1: {found.broken}")


def check_missing(checker, program, folder):
    table = simulate(program, BRIDGE)
    found = audit(program, folder, BRIDGE, table.without("i(d1)", "i(d2)", "i(d3)", "i(d4)"))
    checker.check(found.status == 0 and not found.not_asked, f"currents of diodes: {found.not_asked}")
    found = audit(program, folder, BRIDGE, table.without("i(d1)", "i(d2)", "i(d3)", "i(d4)").scaled("i(v1)", 1.1))
    checker.check(found.status == 1 and found.broken[0] == ("BRANCH", "c1"), f"i(v1) of 10 % more: {found.broken}")
    found = audit(program, folder, BRIDGE, table.without("v(p)"))
    checker.check(found.status == 0 and found.not_asked[("BRANCH", "d1")] == "v(p) is not in the file",
                  f"without v(p): {found.not_asked}")
    checker.check("v(p)" in found.not_asked.get(("KCL", "p"), "") or ("KCL", "p") not in found.not_asked,
                  f"KCL without v(p): {found.not_asked}")
    only = Table(["time", "v(p)"], [[row[0], row[table.index("v(p)")]] for row in table.rows])
    found = audit(program, folder, BRIDGE, only)
    checker.check(found.status == 2 and not found.answer["laws"]
                  and found.not_asked[("BRANCH", "v1")] == "v(a), v(b) are not in the file",
                  f"v(p) alone: {found.answer['laws']} {found.not_asked}")


def check_digits(checker, program, folder):
    table = simulate(program, BRIDGE)
    for form in ("%.6g", "%.4g", "%.6e", "%.9f"):
        found = audit(program, folder, BRIDGE, table.csv(lambda x, form=form: form % x))
        checker.check(found.status == 0, f"{form}: {found.answer and found.broken} {found.stderr}")
        wrong = table.scaled("i(d1)", 1.2)
        found = audit(program, folder, BRIDGE, wrong.csv(lambda x, form=form: form % x))
        checker.check(found.status == 1, f"{form}: a current of 20 % more is not seen")


def check_round_times(checker, program, folder):
    """Times like 0.001 are right, though they have one digit; as fixed points of few digits they are not."""
    netlist = "round\nV1 a 0 SIN(0 1 50)\nR1 a b 1k\nC1 b 0 10u\n.tran 0.1m 100m\n"
    done = dalcs_program.run(program, netlist, method=None, report=False,
                             at=[k * 1e-4 for k in range(1001)])
    rows = [[float(x) for x in line.split(",")] for line in done.output.decode().splitlines()[1:]]
    table = Table(done.names, rows)
    for form in (repr, lambda x: "%.6g" % x):
        content = table.csv(form)
        found = audit(program, folder, netlist, content)
        checker.check(found.status == 0, f"round times: {found.broken}")
        found = audit(program, folder, netlist.replace("10u", "10.5u"), content)
        checker.check(found.broken == [("BRANCH", "c1")], f"round times: {found.broken}")


def check_refusals(checker, program, folder):
    table = simulate(program, BRIDGE)
    other = "other\nV1 x 0 SIN(0 1 50)\nR7 x 0 1k\n.tran 1u 1m\n"
    found = audit(program, folder, other, table.without("i(v1)"))
    checker.check(found.status == 2 and found.answer is None and
                  "the file has no signal of this circuit: it has v(a), v(b), v(p), i(d1)" in found.stderr
                  and "nodes are x" in found.stderr, f"another circuit: {found.status} {found.stderr}")
    found = audit(program, folder, other.replace(".tran", ".print tran {2*v(x)}\n.tran"), table.without("i(v1)"))
    checker.check(found.status == 2 and found.stderr.rstrip().endswith("nodes are x"),
                  f"another circuit, which records a formula: {found.status} {found.stderr}")
    found = audit(program, folder, other, table)
    checker.check(found.answer["foreign"] == ["v(a)", "v(b)", "v(p)", "i(d1)", "i(d2)", "i(d3)", "i(d4)"],
                  f"in part: {found.answer}")
    for what, content, words in (
            ("no table", "1,2\n3,4\n", "holds no waveforms"),
            ("no rows", "time,v(a)\n", "no rows"),
            ("no time", "frequency,v(a)\n1,2\n", "the axis is 'frequency'"),
            ("times before 0", "time,v(a)\n-1,2\n0,1\n", "do not ascend from 0 on")):
        found = audit(program, folder, BRIDGE, content)
        checker.check(found.status == 2 and words in found.stderr, f"{what}: {found.status} {found.stderr}")
    found = audit(program, folder, "bad\nR1 a\n.tran 1 2\n", table)
    checker.check(found.status == 3, f"an error in the netlist: {found.status}")
    for options, words in ((("--tol", "0"), "greater than 0"), (("--plot", "9"), "no plot 9"),
                           (("--run", "2"), "no run 2"), (("--bogus",), "unknown option"),
                           (("another",), "one netlist and one file")):
        content = ltspice(table) if options[0] == "--plot" else table
        found = audit(program, folder, BRIDGE, content, "waves", options)
        checker.check(found.status == 2 and words in found.stderr, f"{options}: {found.stderr}")


def check_text(checker, program, folder):
    table = simulate(program, BRIDGE)
    found = audit(program, folder, BRIDGE, table, options=())
    checker.check(found.status == 0 and "all 12 laws that could be checked hold" in found.text, found.text)
    found = audit(program, folder, BRIDGE, table.nudged("v(p)", 30e-3, 1.0)[0], options=())
    checker.check(found.status == 1 and "broken since" in found.text and "laws is broken, BRANCH of c1" in found.text,
                  found.text)


def check_schema(checker, program, folder, root):
    schema = json.loads((pathlib.Path(root) / "doc" / "audit.schema.json").read_text())
    table = simulate(program, BRIDGE)
    for content in (table, table.without("v(p)"), table.nudged("v(p)", 30e-3, 1.0)[0]):
        found = audit(program, folder, BRIDGE, content)
        try:
            jsonschema.validate(found.answer, schema)
            wrong = None
        except jsonschema.ValidationError as error:
            wrong = error
        checker.check(wrong is None, f"schema: {wrong}")


def check_steps(checker, program, folder):
    netlist = ("steps\nV1 a 0 SIN(0 1 1k)\nR1 a b {r}\nC1 b 0 1u\n.param r=1k\n.step param r 1k 3k 1k\n"
               ".tran 10u 2m\n")
    table = simulate(program, netlist)
    for run in ("1", "2", "3"):
        found = audit(program, folder, netlist, table, options=("--json", "--run", run))
        checker.check(found.status == 0 and found.answer["laws"], f"run {run}: {found.stderr}")
    swapped = table.csv().replace("1000.0,", "2000.0,")
    checker.check("2000.0," in swapped, "the table has its parameter")
    resistors = netlist.replace("1k 3k 1k", "1.5k 3k 1.5k")
    found = audit(program, folder, resistors, table)
    checker.check(found.status == 1, "another resistor in the first run is not seen")


def check_rest(checker, program, folder):
    netlist = "rest\nV1 a 0 DC 5 SIN(0 1 1k)\nR1 a b 1k\nD1 b c\nL1 c 0 1m\nC1 b 0 1u\n.op\n"
    table = simulate(program, netlist)
    checker.check(audit(program, folder, netlist, table).status == 0, "an operating point")
    for signal in ("v(a)", "v(b)", "v(c)", "i(l1)"):
        found = audit(program, folder, netlist, table.nudged(signal, 0.0, 0.0123456789)[0])
        checker.check(found.status == 1, f"an operating point with another {signal}")


HEADERS = "headers\nV1 in 0 SIN(0 10 50)\nD1 in out\nC1 out 0 20u\nR1 out 0 1k\n.tran 20u 40m uic\n"


def check_units(checker, program, folder):
    table = simulate(program, HEADERS)
    made = table.copy()
    made.names = ["time (s)"] + [f"{name} ({'V' if name[0] == 'v' else 'A'})" for name in table.names[1:]]
    plain = audit(program, folder, HEADERS, table).answer["laws"]
    checker.check(audit(program, folder, HEADERS, made).answer["laws"] == plain, "units in the header")
    for column, unit, factor in (("time", "ms", 1e3), ("v(out)", "mV", 1e3), ("i(d1)", "kA", 1e-3), ("i(v1)", "µA", 1e6)):
        made = table.scaled(column, factor)
        made.names[table.index(column)] = f"{column} [{unit}]"
        found = audit(program, folder, HEADERS, made)
        checker.check(found.status == 0 and len(found.answer["laws"]) == len(plain), f"{column} in {unit}: {found.text[:300]}")
        made = table.scaled(column, 1.1 * factor)
        made.names[table.index(column)] = f"{column} [{unit}]"
        checker.check(audit(program, folder, HEADERS, made).status == 1, f"{column} in {unit}, a tenth too large")


def check_rows(checker, program, folder):
    table = simulate(program, HEADERS)
    exchanged = table.copy()
    exchanged.rows[700], exchanged.rows[701] = exchanged.rows[701], exchanged.rows[700]
    found = audit(program, folder, HEADERS, exchanged)
    checker.check(found.status == 2 and "the time goes back from" in found.stderr and "at row 702" in found.stderr,
                  f"rows that are exchanged: {found.stderr}")
    twice = table.copy()
    twice.rows += [list(row) for row in table.rows]
    found = audit(program, folder, HEADERS, twice)
    checker.check(found.status == 0 and "the first of 2 runs" in found.stderr, f"two runs: {found.stderr}")
    for value in ("nan", "inf", ""):
        lines = table.csv().splitlines()
        cells = lines[500].split(",")
        cells[table.index("v(out)")] = value
        lines[500] = ",".join(cells)
        found = audit(program, folder, HEADERS, "\n".join(lines) + "\n")
        checker.check(found.status == 0 and "1 value is no number, the first one that of 'v(out)'" in found.stderr,
                      f"{value!r}: {found.stderr}")
    for line, said in (("1,2", "line 501 has 2 values, and the first line has"), ("1,x,3", "line 501: 'x' is no number for")):
        lines = table.csv().splitlines()
        lines[500] = line
        found = audit(program, folder, HEADERS, "\n".join(lines) + "\n")
        checker.check(found.status == 2 and said in found.stderr, f"{line}: {found.stderr}")


def check_twins(checker, program, folder):
    table = simulate(program, HEADERS)
    made = table.copy()
    made.names.append("V(OUT)")
    for row in made.rows:
        row.append(row[table.index("v(out)")])
    checker.check("both the voltage" not in audit(program, folder, HEADERS, made).stderr, "the same column twice")
    for row in made.rows:
        row[-1] *= 2.0
    found = audit(program, folder, HEADERS, made)
    checker.check("'v(out)' and 'V(OUT)' are both the voltage of node 'out'" in found.stderr, f"twins: {found.stderr}")


def check_two_rests(checker, program, folder):
    """An `op` of a simulator, with the DC values, and the one that a .tran begins at."""
    netlist = "rest\nV1 a 0 DC 5 SIN(1 1 1k)\nR1 a b 1k\nC1 b 0 1u\nR2 b 0 1k\n{}\n"
    for analysis in (".op", ".tran 10u 1m"):
        table = simulate(program, netlist.format(analysis))
        table.rows = table.rows[:1]
        found = audit(program, folder, netlist.format(".tran 10u 1m"), table)
        checker.check(found.status == 0 and found.answer["laws"], f"rest of {analysis}: {found.answer}")
        found = audit(program, folder, netlist.format(".tran 10u 1m"), table.scaled("v(a)", 1.5))
        checker.check(found.status == 1, f"rest of {analysis} with another v(a)")


def main(program, root):
    checker = dalcs_program.Checker("files of other programs")
    with tempfile.TemporaryDirectory() as folder:
        for check in (check_ltspice, check_names, check_missing, check_digits, check_round_times, check_refusals, check_text,
                      check_steps, check_rest, check_units, check_rows, check_twins, check_twin_currents, check_two_rests):
            check(checker, program, folder)
        check_schema(checker, program, folder, root)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
