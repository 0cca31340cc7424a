#!/usr/bin/env python3
"""Runs netlists with .control blocks, and compares files and printed numbers with ngspice's own.

usage: control.py PROGRAM [NGSPICE]
"""

import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import raw_file  # pylint: disable=wrong-import-position,import-error

CIRCUIT = """{title}
.param rload=1k
V1 in 0 DC 2 AC 1 SIN(0 1 1k)
R1 in out 1k
C1 out 0 100n
R2 out 0 {{rload}}
"""

# name: (what follows the circuit, files to compare, largest difference over the largest value)
DECKS = {
    "only in the block": ("""
.control
op
wrdata op v(out)
dc V1 0 2 0.5
wrdata dc v(out) i(V1)
ac dec 5 100 100k
wrdata ac v(out) in
.endc
""", ["op", "dc", "ac"], 1e-7),
    "both": (""".dc V1 -1 1 0.25
.control
run
wrdata first.txt v(out)
alter r1 = 3k
run
wrdata second.txt v(out)
alter @r1[resistance] = 2k
alter V1 dc = 7
op
print v(out)
.endc
""", ["first.txt", "second.txt"], 1e-7),
    "one scale and names": ("""
.control
set wr_singlescale
set wr_vecnames
ac lin 7 10 5k
wrdata out.txt v(out) v(in)
unset wr_vecnames
wrdata plain.txt v(out) v(in)
dc V1 0 1 0.1
set wr_vecnames
wrdata dc.txt v(in) v(out) xlimit 0 1
.endc
""", ["out.txt", "plain.txt", "dc.txt"], 1e-7),
    "formulas": ("""
.control
ac lin 3 100 3k
let gain = v(out)/v(in)
print vecmax(mag(gain)) vecmin(db(gain))
print real(gain[1]) imag(gain[1]) mag(gain[2]) ph(gain[0])
let scaled = 2*mag(gain)^2 - 1
print scaled[0] scaled[2] length(scaled) mean(scaled)
let x = -3
print x abs(x) sqrt(16) exp(1) ln(2) log10(1000) floor(2.7) 7*(2-5)/3
print x lt 0 x gt 0 x eq -3
let z = (1,2)
let w = z*(x,real(z))
let turned = gain*(0,1)
print real(z) imag(z) real(w) imag(w) abs((3,4)) imag(turned[1]) real(turned[2])
.endc
""", [], 1e-7),
    "loops": ("""
.control
foreach value 500 1k 2k
  alter r2 = $value
  op
  print v(out)
end
let count = 0
repeat 4
  let count = count + 1
end
print count
while count > 2
  let count = count - 1
end
print count
if count = 2
  echo two
else
  echo other
end
.endc
""", [], 1e-7),
    "parameters": (""".op
.control
alterparam rload = 3k
reset
run
print v(out)
quit
.endc
""", [], 1e-7),
}

TRANSIENT = (""".tran 10u 3m
.control
run
wrdata tran v(out) v(in)
tran 1u 1m
wrdata short v(out)
.endc
""", ["tran", "short"])


def numbers(path):
    """The rows of a wrdata file, a line of names left out."""
    lines = [line.split() for line in path.read_text().splitlines()]
    names = lines.pop(0) if lines and re.match(r"[a-z]", lines[0][0]) else None
    return names, [[float(x) for x in line] for line in lines]


def printed(text):
    """The `name = value` lines, blanks in names aside."""
    return [(name.replace(" ", ""), float(value)) for name, value in
            re.findall(r"^(\S.*?) = (-?[\d.]+e[+-]\d+)$", text, re.MULTILINE)]


class Both:
    """Runs a netlist with dalcs, and with ngspice where there is one."""

    def __init__(self, program, ngspice, checker):
        self.program, self.ngspice, self.checker = program, ngspice, checker

    def run(self, folder, what, text, status=0):
        folder = pathlib.Path(folder)
        outcome = []
        for name, command in (("ours", [self.program, "run", "c.cir", "-q"]),
                              ("theirs", [self.ngspice, "-b", "c.cir"])):
            (folder / name).mkdir()
            (folder / name / "c.cir").write_text(text)
            if command[0] is None:
                outcome.append(None)
                continue
            done = subprocess.run(command, cwd=folder / name, capture_output=True, text=True,
                                  check=False, timeout=60)
            if name == "ours":
                self.checker.check(done.returncode == status, f"{what}: {done.stderr}")
            outcome.append(done)
        return outcome

    def compare(self, what, body, files, tolerance):
        checker = self.checker
        with tempfile.TemporaryDirectory() as folder:
            ours, theirs = self.run(folder, what, CIRCUIT.format(title=what) + body + ".end\n")
            folder = pathlib.Path(folder)
            for name in files:
                if not checker.check((folder / "ours" / name).exists(), f"{what}: no {name}"):
                    continue
                found = numbers(folder / "ours" / name)
                checker.check(len(found[1]) > 0, f"{what}: {name} is empty")
                if theirs is not None:
                    self.same(f"{what}: {name}", found, numbers(folder / "theirs" / name),
                              tolerance)
            if theirs is not None:
                a, b = printed(ours.stdout), printed(theirs.stdout)
                checker.check([x for x, _ in a] == [x for x, _ in b], f"{what}: {a}\n{b}")
                for (name, x), (_, y) in zip(a, b):
                    checker.close(x, y, 1e-6 * max(1.0, abs(y)), f"{what}: {name}")

    def same(self, what, ours, theirs, tolerance):
        checker = self.checker
        checker.check(ours[0] == theirs[0], f"{what}: names {ours[0]}, not {theirs[0]}")
        shape = (len(ours[1]), len(ours[1][0]))
        if checker.check(shape == (len(theirs[1]), len(theirs[1][0])), f"{what}: {shape}"):
            scale = [max(abs(row[k]) for row in theirs[1]) or 1.0 for k in range(shape[1])]
            for k, (a, b) in enumerate(zip(ours[1], theirs[1])):
                for i in range(shape[1]):
                    checker.close(a[i], b[i], tolerance * scale[i], f"{what}: line {k}, {i}")


def interpolate(rows, t, column):
    for a, b in zip(rows, rows[1:]):
        if a[0] <= t <= b[0] and b[0] > a[0]:
            part = (t - a[0]) / (b[0] - a[0])
            return a[column] + part * (b[column] - a[column])
    return rows[-1][column]


def check_transients(both):
    with tempfile.TemporaryDirectory() as folder:
        _, theirs = both.run(folder, "transients", CIRCUIT.format(title="t") + TRANSIENT[0])
        for name in TRANSIENT[1]:
            _, ours = numbers(pathlib.Path(folder) / "ours" / name)
            if theirs is None:
                continue
            _, other = numbers(pathlib.Path(folder) / "theirs" / name)
            both.checker.check(len(ours[0]) == len(other[0]), f"{name}: columns")
            for row in other[5::7]:
                for column in range(1, len(row), 2):
                    both.checker.close(interpolate(ours, row[0], column), row[column], 5e-3,
                                       f"{name} at {row[0]}, column {column}")


def check_alone(both):
    """What ngspice has no counterpart for."""
    checker = both.checker
    with tempfile.TemporaryDirectory() as folder:
        ours, _ = both.run(folder, "files", CIRCUIT.format(title="files") + """
.model dm D
D1 out x dm
R3 x 0 1k
.control
tran 10u 1m
write part.raw v(out) i(V1)
write all.raw
save all @r1[i]
dc V1 0 2 1
print @r1[i]
altermod dm vfwd = 0.25
op
set numdgt=12
print v(out)-v(x) v(out,x)
let x = 4
echo x is $&x, twice {2*x}
listing
listing
.endc
.end
""")
        folder = pathlib.Path(folder) / "ours"
        plot = raw_file.read(folder / "part.raw")[0]
        checker.check(plot.names == ["time", "v(out)", "i(v1)"] and len(plot.rows) >= 101,
                      f"write: {plot.names} {len(plot.rows)}")
        checker.check(len(raw_file.read(folder / "all.raw")[0].names) > 4, "write without names")
        found = raw_file.read(folder / "c.raw")
        checker.check([p.name for p in found] == ["Transient Analysis",
                                                  "DC transfer characteristic",
                                                  "Operating Point"], "all runs in one file")
        checker.check(dict(printed(ours.stdout)) == {"v(out)-v(x)": 0.25, "v(out,x)": 0.25},
                      f"altermod: {ours.stdout}")
        checker.check("x is 4, twice 8" in ours.stdout, ours.stdout)
        checker.check(ours.stderr.count("'listing' is not supported here") == 1, ours.stderr)
    with tempfile.TemporaryDirectory() as folder:
        ours, _ = both.run(folder, "no analysis", CIRCUIT.format(title="late") + """.op
.control
print v(out)
.endc
.end
""")
        checker.check(printed(ours.stdout) == [("v(out)", 1.0)], f"cards first: {ours.stdout}")
    with tempfile.TemporaryDirectory() as folder:
        both.run(folder, "an error leaves no file", CIRCUIT.format(title="x") + """
.control
op
wrdata w.txt v(out)
tarn 1u 1m
.endc
.end
""", status=3)
        checker.check(not (pathlib.Path(folder) / "ours" / "w.txt").exists(), "nothing was run")

    check_vectors_measured(both)
    check_left_out(both)


def check_vectors_measured(both):
    """let vectors and parameters in meas, print and echo: v(out) = 2 (1 - exp(-t/tau))."""
    with tempfile.TemporaryDirectory() as folder:
        ours, _ = both.run(folder, "vectors", """vectors
.param vin=2 half={vin/2}
V1 vin 0 DC {vin} AC 1
R1 vin out 1k
C1 out 0 1u
.control
let limit = 1.5
tran 10u 4m uic
let p = out*(-v1#branch)
let twice = p*2
let bad = mean(p)
meas tran energy INTEG twice
meas tran t1 when v(out)=limit
meas tran t2 when v(out)={Half}
meas tran t3 when out=half
meas tran there find p at={t2}
meas tran none avg bad
set numdgt=15
print energy t1 t2 t3 there half+limit
echo half is {HALF}, three {vin+half}, vin is {vin}
ac dec 20 1 10k
let gain = db(v(out))
let size = mag(out)
meas ac f3 when gain=-20
meas ac low min size
print f3 low
.endc
.end
""")
        found = dict(printed(ours.stdout))
        decibel = 20 * math.log10(1 / math.hypot(1, 2e-3 * math.pi * 1e4))
        wanted = {"t1": 1e-3 * math.log(4), "t2": 1e-3 * math.log(2), "t3": 1e-3 * math.log(2),
                  "there": 1e-3, "half+limit": 2.5, "low": 10 ** (decibel / 20),
                  "energy": 2 * 4e-3 * (0.5e-3 - 1e-3 * math.exp(-4) + 0.5e-3 * math.exp(-8))}
        for name, value in wanted.items():
            both.checker.close(found.get(name, math.nan), value, 1e-6, f"vectors: {name}")
        both.checker.close(found["f3"], math.sqrt(99) / (2e-3 * math.pi), 1.0, "a level in dB")
        both.checker.check("half is 1, three 3, vin is 2" in ours.stdout, ours.stdout)
        both.checker.check("a vector of `let` cannot be measured" in ours.stderr, ours.stderr)


def check_left_out(both):
    """What cannot be done and changes no run is left out; ngspice goes on too."""
    with tempfile.TemporaryDirectory() as folder:
        ours, _ = both.run(folder, "left out", CIRCUIT.format(title="x") + """
.control
op
let y = nowhere*2
let z = (1
print z v(nobody)
repeat 3
  print y
end
print v(out)
wrdata none.txt v(none)
wrdata w.txt v(out)
.endc
.end
""")
        folder = pathlib.Path(folder) / "ours"
        both.checker.check(printed(ours.stdout) == [("v(out)", 1.0)], f"left out: {ours.stdout}")
        both.checker.check(ours.stderr.count("this line is left out") == 5, ours.stderr)
        both.checker.check((folder / "w.txt").exists() and (folder / "c.raw").exists() and
                           not (folder / "none.txt").exists(), "files beside what is left out")


def main():
    program = pathlib.Path(sys.argv[1]).absolute()
    checker = dalcs_program.Checker("control")
    both = Both(program, sys.argv[2] if len(sys.argv) > 2 else None, checker)
    for what, (body, files, tolerance) in DECKS.items():
        both.compare(what, body, files, tolerance)
    check_transients(both)
    check_alone(both)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
