#!/usr/bin/env python3
"""Checks .dc, .ac and .step against closed forms and against ngspice, and the files they write.

usage: sweeps.py PROGRAM [NGSPICE]
"""

import cmath
import csv
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import raw_file  # pylint: disable=wrong-import-position,import-error

TWO_PI = 2 * math.pi


class Case:
    """Runs netlists in one folder and keeps what they wrote."""

    def __init__(self, program, ngspice, folder):
        self.program, self.ngspice, self.folder = program, ngspice, pathlib.Path(folder)
        self.checker = dalcs_program.Checker("sweeps")

    def run(self, netlist, *options, status=0):
        (self.folder / "c.cir").write_text(netlist)
        for old in ("c.csv", "c.raw"):
            (self.folder / old).unlink(missing_ok=True)
        done = subprocess.run([self.program, "run", "c.cir", "-o", "c.csv", "-o", "c.raw",
                               *options], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        self.checker.check(done.returncode == status, f"{netlist}\n{done.stderr}")
        return done

    def table(self):
        with open(self.folder / "c.csv", encoding="ascii") as file:
            lines = list(csv.reader(file))
        return lines[0], [[float(x) for x in line] for line in lines[1:]]

    def column(self, name):
        names, rows = self.table()
        return [row[names.index(name)] for row in rows]

    def plots(self):
        return raw_file.read(self.folder / "c.raw")

    def ngspice_plots(self, netlist):
        """ngspice's own answers to the same netlist: {plot name: {vector: values}}."""
        (self.folder / "n.cir").write_text(netlist)
        subprocess.run([self.ngspice, "-b", "-r", "n.raw", "n.cir"], cwd=self.folder,
                       capture_output=True, check=True)
        data = (self.folder / "n.raw").read_bytes()
        found, at = {}, 0
        while at < len(data):
            plot, at = read_ngspice(data, at)
            found[plot.name] = plot
        return found

    def loads(self, what, vectors):
        """ngspice loads the raw file and finds the vectors, of these lengths."""
        if self.ngspice is None:
            return
        commands = "\n".join(f"let n{k} = length({name})\nprint n{k}"
                             for k, (name, _) in enumerate(vectors))
        (self.folder / "l.cir").write_text(f"*\n.control\nload c.raw\n{commands}\nquit\n.endc\n"
                                           ".end\n")
        said = subprocess.run([self.ngspice, "-b", "l.cir"], cwd=self.folder, capture_output=True,
                              text=True, check=False)
        for k, (name, length) in enumerate(vectors):
            self.checker.check(f"n{k} = {length:.6e}" in said.stdout,
                               f"{what}: ngspice reads {name}: {said.stdout} {said.stderr}")

    def near(self, found, wanted, tolerance, what):
        if self.checker.check(len(found) == len(wanted), f"{what}: {len(found)} values, "
                                                         f"not {len(wanted)}"):
            scale = max(map(abs, wanted), default=0.0) or 1.0
            for k, (a, b) in enumerate(zip(found, wanted)):
                self.checker.close(a, b, tolerance * scale, f"{what}[{k}]")


def read_ngspice(data, at):
    """A plot as ngspice itself writes it: other header lines, other types."""
    fields, names = {}, []
    while True:
        line, at = raw_file.read_line(data, at)
        if line.startswith("Variables:"):
            break
        name, _, value = line.partition(":")
        fields[name] = value.strip()
    for _ in range(int(fields["No. Variables"])):
        line, at = raw_file.read_line(data, at)
        names.append(line.split("\t")[2])
    _, at = raw_file.read_line(data, at)
    is_complex = "complex" in fields["Flags"]
    width = len(names) * (2 if is_complex else 1)
    n = int(fields["No. Points"])
    numbers = raw_file.struct.unpack(f"<{width * n}d", data[at:at + 8 * width * n])
    rows = [numbers[k * width:(k + 1) * width] for k in range(n)]
    if is_complex:
        rows = [tuple(complex(*row[k:k + 2]) for k in range(0, width, 2)) for row in rows]
    return raw_file.Plot(fields, names, [], rows), at + 8 * width * n


# ---- .dc ---------------------------------------------------------------------------------------------

CLIPPER = """a clipper
V1 in 0 5
R1 in out 1k
D1 out lim
V2 lim 0 2
.dc V1 -1 4 0.1 V2 1 2 0.5
.end
"""

NETWORK = """a resistive network
V1 a 0 1
I1 0 b 1m
R1 a b 1k
R2 b 0 2k
E1 c 0 b 0 3
R3 c d 1k
R4 d 0 500
.dc V1 0 2 0.25 R2 1k 4k 1k
.end
"""

PARAMETER = """a parameter
.param r=1k
.param double={2*r}
V1 in 0 6
R1 in out {r}
R2 out 0 {double}
.dc param r 100 300 100
.end
"""


def check_dc(case):
    case.run(CLIPPER)
    plot = case.plots()[0]
    wanted = [(-1 + 0.1 * k, v2) for v2 in (1, 1.5, 2) for k in range(51)]
    names, rows = case.table()
    case.checker.check(names[:3] == ["v1", "v2", "v(in)"], f"columns {names}")
    case.checker.check(plot.names[:3] == ["v-sweep", "v2", "v(in)"] and
                       plot.name == "DC transfer characteristic", f"raw columns {plot.names}")
    case.near([row[0] for row in rows], [v for v, _ in wanted], 1e-15, ".dc v1")
    case.near(case.column("v(out)"), [min(v, v2) for v, v2 in wanted], 1e-12, "clipper")
    case.near(case.column("i(d1)"), [max(0, (v - v2) / 1e3) for v, v2 in wanted], 1e-12,
              "clipper's diode")
    case.checker.check(rows[50][0] == 4.0, "counted, not accumulated: the last point is the stop")
    case.near(plot.column("v(out)"), case.column("v(out)"), 0.0, "raw and csv")
    case.loads(".dc", [("v(out)", 153), ("v2", 153)])

    case.run(NETWORK)
    found = case.plots()[0]
    if case.ngspice is not None:
        theirs = case.ngspice_plots(NETWORK)["DC transfer characteristic"]
        case.near(found.column("v-sweep"), [row[0] for row in theirs.rows], 1e-11, "as ngspice")
        for name in ("v(a)", "v(b)", "v(c)", "v(d)", "i(v1)"):
            case.near(found.column(name), theirs.column(name), 1e-11, f"as ngspice: {name}")

    case.run(PARAMETER)
    case.near(case.column("r"), [100, 200, 300], 1e-15, ".dc param")
    case.near(case.column("v(out)"), [4, 4, 4], 1e-14, "what depends on the parameter follows")
    case.near(case.column("i(v1)"), [-0.02, -0.01, -1 / 150], 1e-13, ".dc param, current")

    case.run(CLIPPER.replace(".dc V1 -1 4 0.1 V2 1 2 0.5", ".dc V1 4 -1 -2.5"))
    case.near(case.column("v1"), [4, 1.5, -1], 1e-15, "downwards")
    case.run(CLIPPER.replace(".dc V1 -1 4 0.1 V2 1 2 0.5", ".dc temp -40 125 82.5"))
    case.near(case.column("temp"), [-40, 42.5, 125], 1e-15, "temperatures")
    case.near(case.column("v(out)"), [2, 2, 2], 1e-15, "nothing depends on them")
    # A switch remembers: the warm start is part of the answer, in both ways of sweeping.
    for sweep, scale in ((".dc V1 0 1 1", "v1"), (".dc param x 0 1 1", "x")):
        case.run(f"""a switch with hysteresis
.param x=0
V1 c 0 {{x}}
S1 in out c 0 sw
.model sw SW(Vt=0.5 Vh=0.2)
V2 in 0 1
R1 out 0 1k
{sweep}
.end
""")
        case.near(case.column("v(out)"), [0, 1], 1e-12, f"a switch over {scale}")


# ---- .ac ---------------------------------------------------------------------------------------------

RESONANCE = """a series resonance
V1 in 0 DC 0 AC 2 30
R1 in a 10
L1 a out 1m
C1 out 0 1u
R2 out 0 1k
.ac dec 20 10 1Meg
.end
"""

COUPLED = """a transformer and controlled sources
V1 in 0 AC 1
R1 in a 10
L1 a 0 1m
L2 b 0 4m
K1 L1 L2 0.9
R2 b 0 100
G1 0 c b 0 1m
C1 c 0 10n
R3 c 0 1k
E1 d 0 c 0 5
R4 d e 50
C2 e 0 100n
I1 0 e AC 1m -90
.ac oct 5 100 1Meg
.end
"""

RECTIFIER = """a bridge that conducts, one that blocks
V1 in 0 DC {dc} AC 1
D1 in out dm
D2 0 in dm
.model dm D(Ron=10 Roff=1Meg)
R1 out 0 1k
C1 out 0 1u
.ac lin 5 100 500
.end
"""


SHORTED = """a filter, and a resistor across a short: a part without unknowns
V1 in 0 AC 1
R1 in out 1k
C1 out 0 1u
R2 b 0 1
R3 b 0 0
.ac lin 5 100 500
.end
"""


def check_ac(case):
    case.run(RESONANCE)
    plot = case.plots()[0]
    frequency = [x.real for x in plot.column("frequency")]
    case.near(frequency, [10 * 10 ** (k / 20) for k in range(101)], 1e-13, "20 a decade")
    source = cmath.rect(2, math.radians(30))

    def answer(f):
        s = 2j * math.pi * f
        load = 1 / (s * 1e-6 + 1e-3)
        return source * load / (load + 10 + s * 1e-3)

    case.checker.check("complex" in plot.flags and plot.types[0] == "frequency", "flags")
    for f, found in zip(frequency, plot.column("v(out)")):
        case.checker.close(found, answer(f), 1e-12 * abs(answer(f)), f"resonance at {f}")
    for part, of in (("re", lambda z: z.real), ("im", lambda z: z.imag)):
        case.near(case.column(f"{part}(v(out))"), [of(z) for z in plot.column("v(out)")], 0.0,
                  f"{part} in the csv")
    case.loads(".ac", [("v(out)", 101), ("frequency", 101)])

    case.run(SHORTED)
    plot = case.plots()[0]
    for f, found in zip([x.real for x in plot.column("frequency")], plot.column("v(out)")):
        case.checker.close(found, 1 / (1 + 2j * math.pi * f * 1e-3), 1e-12, f"shorted, at {f}")
    case.checker.check(not any(plot.column("v(b)")), "a voltage across a short")

    case.run(COUPLED)
    found = case.plots()[0]
    if case.ngspice is not None:
        theirs = case.ngspice_plots(COUPLED)["AC Analysis"]
        for name in ("frequency", "v(a)", "v(b)", "v(c)", "v(e)", "i(v1)"):
            ours, other = found.column(name), theirs.column(name)
            if name == "frequency":  # ngspice leaves its imaginary part undefined
                ours, other = [x.real for x in ours], [x.real for x in other]
            if case.checker.check(len(ours) == len(other), f"{name}: {len(ours)} {len(other)}"):
                for k, (a, b) in enumerate(zip(ours, other)):
                    case.checker.close(a, b, 1e-9 * abs(b), f"as ngspice: {name}[{k}]")

    for dc, resistance in ((5, 1 / (1 / 10 + 1 / 1e6)), (-5, 1e6)):
        done = case.run(RECTIFIER.replace("{dc}", str(dc)))
        for f, found in zip((100, 200, 300, 400, 500), case.plots()[0].column("v(out)")):
            load = 1 / (TWO_PI * 1j * f * 1e-6 + 1e-3)
            case.checker.close(found, load / (load + resistance), 1e-9 * abs(found),
                               f"a diode at {dc} V, {f} Hz")
        side = "d1 on, d2 off" if dc > 0 else "d1 off, d2 on"
        case.checker.check(f"frozen    {side}" in done.stdout, f"sides in the summary: {done.stdout}")
    done = case.run(RECTIFIER.replace("{dc}", "0").replace("(Ron=10 Roff=1Meg)", ""))
    case.checker.check("neither current nor voltage" in done.stderr and "d1 as" in done.stderr,
                       f"a degenerate operating point says so: {done.stderr}")


# ---- .step -------------------------------------------------------------------------------------------

STEPPED = """a filter
.param r=1k
V1 in 0 DC 1 AC 1 PULSE(0 1 0 0 0 1 2)
R1 in out {r}
C1 out 0 1u
.step param r list 500 1k 2k
.step C1 1u 2u 1u
.tran 100u 2m uic
.ac lin 2 100 200
.op
.dc V1 0 2 1
.end
"""


def check_step(case):
    done = case.run(STEPPED)
    names, rows = case.table()
    case.checker.check(names[:3] == ["r", "c1", "time"], f"columns {names}")
    order = [(r, c) for c in (1e-6, 2e-6) for r in (500.0, 1000.0, 2000.0)]
    seen = list(dict.fromkeys((row[0], row[1]) for row in rows))
    case.checker.check(seen == order, f"the first .step is the innermost: {seen}")
    for row in rows:
        exact = 1 - math.exp(-row[2] / (row[0] * row[1]))
        case.checker.close(row[names.index("v(out)")], exact, 1e-6, f"step {row[:3]}")
    by_name = {plot.name: plot for plot in case.plots()}
    case.checker.check(list(by_name) == ["Operating Point", "DC transfer characteristic",
                                         "AC Analysis", "Transient Analysis"], f"{list(by_name)}")
    for plot in by_name.values():
        case.checker.check("stepped" in plot.flags, f"{plot.name}: {plot.flags}")
    tran = by_name["Transient Analysis"]
    case.checker.check(len(tran.steps()) == 6, f"{len(tran.steps())} steps by the scale")
    case.checker.check([step[0][1:3] for step in tran.steps()] == order, "columns of the steps")
    case.checker.check(len(by_name["Operating Point"].rows) == 6, "six operating points")
    case.checker.check(len(by_name["AC Analysis"].steps()) == 6, "six times two frequencies")
    for step in by_name["AC Analysis"].steps():
        for row in step:
            rc = (row[1] * row[2]).real
            wanted = 1 / (1 + TWO_PI * 1j * row[0].real * rc)
            found = row[by_name["AC Analysis"].names.index("v(out)")]
            case.checker.close(found, wanted, 1e-12, f".ac of a step at {row[0]}")
    case.checker.check(done.stdout.count("6 steps: ") == 4, f"the summary: {done.stdout}")
    case.loads(".step", [("v(out)", len(tran.rows)), ("r", len(tran.rows))])

    case.run(STEPPED, "--split-steps")
    plots = case.plots()
    case.checker.check(len(plots) == 24 and all(plot.flags in (["real"], ["complex"])
                                                for plot in plots), "a plot for each step")
    case.checker.check(plots[-1].fields["Title"] == "a filter: r = 2000 c1 = 2e-06",
                       plots[-1].fields["Title"])

    # .dc builds the circuit again at each point, with the values of the step
    case.run("""a divider
.param a=1 b=1
V1 in 0 10
R1 in out {a*1k}
R2 out 0 {b*1k}
.dc param b 1 3 2
.step param a list 1 4
.end
""")
    case.near(case.column("v(out)"), [10 / (1 + a / b) for a in (1, 4) for b in (1, 3)], 1e-13, ".dc in .step")

    for card, label, wanted in (
            (".step dec param r 10 1k 1", "r", [10, 100, 1000]),
            (".step oct R9 1 8 1", "r9", [1, 2, 4, 8]),
            (".step V1 1 2 0.5", "v1", [1, 1.5, 2]),
            (".step I1 list 0 1m", "i1", [0, 1e-3]),
            (".step D dm(Vfwd) 0 1 0.5", "dm(vfwd)", [0, 0.5, 1]),
            (".step dm(Ron) list 0 1", "dm(ron)", [0, 1]),
            (".step temp -55 125 90", "temp", [-55, 35, 125]),
            (".step param r lin 1 3 2", "r", [1, 3]),
            (".step param q list 1 2", "q", [1, 2])):
        netlist = f"""what can be stepped
.param r=1k
V1 in 0 5
I1 0 in 0
D1 in out dm
.model dm D(Roff=1Meg)
R1 out 0 {{r}}
R9 out 0 {'{q}' if ' q ' in card else '1k'}
{card}
.op
.end
"""
        case.run(netlist)
        values = case.column(label)
        case.near(values, wanted, 1e-13, card)
        for k, value in enumerate(values):
            v1 = value if label == "v1" else 5
            drop = value if label == "dm(vfwd)" else 0
            r = value if label == "r" else 1e3
            r9 = value if label in ("r9", "q") else 1e3
            ron = value if label == "dm(ron)" else 0
            load = r * r9 / (r + r9)
            g = 1e-6
            # i = v/Roff + (v - drop)/ron through the diode; ideal for ron = 0
            out = v1 - drop if ron == 0 else ((v1 - drop) / ron + v1 * g) / (1 / load + g + 1 / ron)
            case.checker.close(case.column("v(out)")[k], out, 1e-9, f"{card}: step {k}")

    # What fails in one step says in which, and loses none of the others.
    done = case.run("""two sources
V1 a 0 1
V2 a 0 1
R1 a 0 1k
.step V2 1 2 1
.op
.end
""", status=3)
    case.checker.check("step 2 of 2: v2 = 2" in done.stderr and
                       (case.folder / "c.csv").read_text().count("\n") == 2, f"a step that fails: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).absolute()
    ngspice = sys.argv[2] if len(sys.argv) > 2 else None
    with tempfile.TemporaryDirectory() as folder:
        case = Case(program, ngspice, folder)
        check_dc(case)
        check_ac(case)
        check_step(case)
        return case.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
