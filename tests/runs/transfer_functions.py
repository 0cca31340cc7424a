#!/usr/bin/env python3
""".tf: gains and resistances of unlike circuits against closed forms and against ngspice; steps, scripts, what is refused.

usage: transfer_functions.py PROGRAM
"""

import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

INF = math.inf

# what; cards; gain, resistance at the output, at the input
CASES = (
    ("a divider", "v1 in 0 10\nr1 in b 1k\nr2 b 0 3k\n.tf v(b) v1", 0.75, 750, 4000),
    ("between two nodes", "v1 in 0 10\nr1 in b 1k\nr2 b 0 3k\n.tf v(b,in) v1", -0.25, 750, 4000),
    ("a current source", "i1 0 in 1m\nr1 in 0 2k\nr2 in b 1k\nr3 b 0 3k\n.tf v(b) i1", 1000.0, 1500, 4000 / 3),
    ("a current behind a voltage", "v1 in 0 5\nr1 in a 1k\nr2 a 0 1k\nr3 a b 500\nv2 b 0 0\n.tf i(v2) v1",
     1 / 2000, 1000, 4000 / 3),
    ("the current of the source itself", "v1 in 0 1\nr1 in 0 1u\n.tf i(v1) v1", -1e6, 1e-6, 1e-6),
    ("a current behind a current", "i1 0 a 2\nr1 a 0 1meg\nv2 a b 0\nr2 b 0 3meg\n.tf i(v2) i1", 0.25, 4e6, 0.75e6),
    ("a diode that conducts", "v1 in 0 10\nr1 in a 1k\nd1 a b\nr2 b 0 3k\nd2 0 b\n.tf v(b) v1", 0.75, 750, 4000),
    ("a diode that blocks", "v1 in 0 -10\nr1 in a 1k\nd1 a b\nr2 b 0 3k\n.tf v(b) v1", 0.0, 3000, INF),
    ("a diode with ohms", "v1 in 0 10\nr1 in a 1k\nd1 a 0 dm\n.model dm d(ron=250 vfwd=0.7)\n.tf v(a) v1", 0.2, 200, 1250),
    ("a coil and capacitors", "v1 in 0 sin(1 5 1k)\nr1 in a 2\nl1 a b 1m rser=0\nc1 b 0 1n\nr2 b 0 6\nc2 a c 1u\nr3 c 0 7\n.tf v(b) v1",
     0.75, 1.5, 8),
    ("an amplifier", "v1 in 0 1\nr1 in a 10k\nr2 a o 100k\ne1 x 0 0 a 1e5\nr3 x o 50\n.tf v(o) v1",
     (50 - 1e5 * 1e5) / (1.1e5 + 50 + 1e5 * 1e4), 1.1e5 * 50 / (1.1e5 + 50 + 1e5 * 1e4),
     (1.1e5 + 50 + 1e5 * 1e4) / (1 + 1e5)),
    ("a buffer", "v1 in 0 1\nr1 in a 1k\ne1 o 0 a 0 7\nr2 o p 50\nr3 p 0 50\nd1 0 a\n.tf v(p) v1", 3.5, 25, INF),
    ("a square", "v1 in 0 3\nb1 o 0 v=v(in)*v(in)\nr1 o p 10\nr2 p 0 30\n.tf v(p) v1", 4.5, 7.5, INF),
    ("a formula with a jump", "v1 in 0 3\nb1 o 0 v=v(in)>1 ? 3*v(in) : 0\nr1 o p 10\nr2 p 0 30\n.tf v(p) v1", 2.25, 7.5, INF),
    ("a switch that is closed", "v1 in 0 12\nv2 g 0 5\ns1 in a g 0 sw\n.model sw sw(ron=3 roff=1g vt=2)\nr1 a 0 9\n.tf v(a) v1",
     0.75, 2.25, 12),
    ("a switch that is open", "v1 in 0 12\nv2 g 0 5\ns1 in a g 0 sw\n.model sw sw(ron=3 vt=7)\nr1 a 0 9\n.tf v(a) v1", 0.0, 9, INF),
    ("a transformer of coils, which are shorts", "v1 in 0 1\nr1 in a 4\nl1 a 0 1m\nl2 b 0 4m\nk1 l1 l2 0.9\nr2 b 0 5\n.tf v(b) v1",
     0.0, 0.0, 4),
    ("an inner resistance", ".options dialect=ltspice\nv1 in 0 1 rser=3\nr1 in 0 1k\n.tf v(in) v1", 1000 / 1003, 3000 / 1003, 1003),
    # a part of a short and nothing else: all its voltages are 0, and the diodes may as well block
    ("a diode in a tie", "v1 in 0 1\nd1 in a\nc1 a 0 1u\ni1 0 a 0\n.tf v(a) i1", 0.0, 0.0, 0.0),
    ("two diodes in a tie", "v1 in 0 1k\nr1 in 0 1k\nd1 in a\nd2 a b\nc1 b 0 1p\ni1 0 b 0\n.tf v(b) i1", 0.0, 0.0, 0.0),
    ("two against each other in a tie", "i1 0 a 0\nd1 a 0\nd2 0 a\nc1 a 0 1m\n.tf v(a) i1", 0.0, 0.0, 0.0),
    ("large and small", "v1 in 0 1\nr1 in a 1e9\nr2 a 0 1m\n.tf v(a) v1", 1e-3 / (1e9 + 1e-3), 1e9 * 1e-3 / (1e9 + 1e-3), 1e9 + 1e-3),
)


def near(checker, got, wanted, what):
    got = float(got)  # "inf" where there is none
    if math.isinf(wanted):
        checker.check(got == wanted, f"{what}: {got}, not {wanted}")
    else:
        checker.close(got, wanted, 1e-12 * abs(wanted) + 1e-15, what)


def closed_forms(checker, program):
    """Beside a .op and an .ac, which they leave as they are; and the summary, where an infinite resistance is none of 0."""
    for what, cards, *wanted in CASES:
        done = run(program, f"{what}\n{cards}\n.end\n", method=None)
        if not checker.check(done.status == 0, f"{what}: {done.stderr}"):
            continue
        values = list(done.report["transfer"].values())
        for got, value, name in zip(values, wanted, done.report["transfer"]):
            near(checker, got, value, f"{what}: {name}")
        checker.check(done.names[1:] == list(done.report["transfer"]), f"{what}: columns {done.names}")
        checker.check([float(v) for v in values] == done.rows[0][1:], f"{what}: row {done.rows[0]}")
        checker.check(done.report["audit"]["frequencies"] == 2, f"{what}: {done.report['audit']}")
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "circuit.cir"
            path.write_text(f"{what}\n{cards}\n.end\n")
            said = subprocess.run([program, "run", path, "-o", "none"], stdin=subprocess.DEVNULL, capture_output=True,
                                  text=True, check=False).stdout
        shown = re.search(r"input_impedance +(\S+)", said)
        checker.check(shown is not None and (shown[1] == "inf") == math.isinf(wanted[2]), f"{what}: {said}")


def beside(checker, program):
    """Other analyses have what they have without .tf, bit by bit; AC values of sources come back."""
    cards = "v1 in 0 sin(2 5 1k) ac 3\nr1 in a 1k\nd1 a b\nr2 b 0 3k\nc1 b 0 1u\n{}.ac dec 3 10 1k\n.end\n"
    plain = run(program, "beside\n" + cards.format(""), method=None)
    both = run(program, "beside\n" + cards.format(".tf v(b) v1\n"), method=None)
    if checker.check(plain.status == 0 and both.status == 0, f"beside: {both.stderr}"):
        checker.check(plain.output == both.output, "beside: .ac is another one")
        checker.close(both.report["transfer"]["transfer_function"], 0.75, 1e-12, "beside")


def steps(checker, program):
    done = run(program, "steps\ni1 0 in 1m\nr1 in b 1k\nr2 b m 3k\nv2 m 0 0\nr3 in 0 2k\n.tf i(v2) i1\n.step r1 1k 3k 1k\n"
               ".print tran {v(b)*2}\n.end\n", method=None)
    if checker.check(done.status == 0 and len(done.rows) == 3, f"steps: {done.stderr}"):
        for row in done.rows:
            r1 = row[0]
            for got, wanted in zip(row[2:], (2e3 / (5e3 + r1), 5e3 + r1, 2e3 * (3e3 + r1) / (5e3 + r1))):
                near(checker, got, wanted, f"a step with {r1} ohm")


SCRIPT = """script
v1 in 0 10
r1 in b 1k
r2 b 0 3k
i2 0 b 0
.control
tf v(b) v1
print transfer_function
print v1#input_impedance
let twice = 2*transfer_function
print twice
tf v(b) i2
print all
op
print v(b)
.endc
.end
"""


def scripts(checker, program):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "circuit.cir"
        path.write_text(SCRIPT)
        done = subprocess.run([program, "run", path, "-o", "none", "-q"], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, check=False)
        checker.check(done.stdout.split("\n")[:7] == [
            "transfer_function = 7.500000e-01", "v1#input_impedance = 4.000000e+03", "twice = 1.500000e+00",
            "transfer_function = 7.500000e+02", "output_impedance_at_v(b) = 7.500000e+02", "i2#input_impedance = 7.500000e+02",
            "v(b) = 7.500000e+00"], f"a script: {done.stdout}{done.stderr}")


REFUSED = (
    (".tf v(b) v9", 3, "there is no element 'v9'"),
    (".tf v(x) v1", 3, "no element is connected to a node 'x'"),
    (".tf v(b) r1", 3, "'r1' is a resistor: .tf needs a V or I source here"),
    (".tf i(r1) v1", 3, "'r1' is a resistor: .tf needs a V source here"),
    (".tf v(b,b) v1", 3, "the output of .tf is the voltage between a node and itself"),
    (".tf v(b)", 3, "a V or I source is missing"),
    (".tf v1 v(b)", 3, "expected v(a), v(a,b) or i(vsource)"),
    (".tf v(b) v1 x", 3, "did not expect 'x' here"),
    (".tf v(b) v1\n.tf v(in) v1", 3, "a second .tf, the first at"),
    ("l1 b 0 1m\nl2 b 0 1m\n.tf v(b) v1", 1, "at 0 Hz the response is not unique"),
    ("c1 b c 1u\nc2 c 0 1u\n.tf v(c) v1", 1, "at 0 Hz the response is not unique"),
)


def refusals(checker, program):
    for cards, status, said in REFUSED:
        done = run(program, f"refused\nv1 in 0 10\nr1 in b 1k\nr2 b 0 3k\n{cards}\n.end\n", method=None)
        checker.check(done.status == status and said in done.stderr, f"{cards}: {done.status}\n{done.stderr}")
    done = run(program, "a tie\nv1 in 0 0\nr1 in a 1k\nd1 a 0\nr2 a 0 1k\n.tf v(a) v1\n.end\n", method=None)
    checker.check(done.status == 0 and ".tf takes d1 as blocking" in done.stderr, f"a tie: {done.stderr}")


def ngspice(checker):
    """The cases that its elements can have; the output resistance of a current is 1e20 there, whatever the circuit."""
    if shutil.which("ngspice") is None:
        return
    for what, cards, *wanted in CASES:
        if re.search(r"^[sdb]|ltspice|rser", cards, re.MULTILINE):
            continue
        done = subprocess.run(["ngspice", "-b"], input=f"{what}\n{cards}\n.end\n", capture_output=True, text=True, check=False)
        got = dict(re.findall(r"^(\S+) = +(\S+)$", done.stdout, re.MULTILINE))
        for name, value in got.items():
            place = 0 if name == "transfer_function" else 2 if name.endswith("input_impedance") else 1
            is_told = math.isfinite(wanted[place]) and not name.endswith("#output_impedance")
            if is_told:
                checker.close(float(value), wanted[place], 1e-5 * abs(wanted[place]) + 1e-9, f"{what}, ngspice: {name}")


def main():
    program = sys.argv[1]
    checker = Checker("transfer functions")
    closed_forms(checker, program)
    beside(checker, program)
    steps(checker, program)
    scripts(checker, program)
    refusals(checker, program)
    ngspice(checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
