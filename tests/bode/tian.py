#!/usr/bin/env python3
"""The gain of a loop by a voltage and a current: linear loops whose gain is known, loaded on both sides; switched loops,
whose gain is the same wherever they are cut.

usage: tian.py PROGRAM
"""

import cmath
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

from cases import response

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error


def solve(matrix, right):
    """Gauss' elimination with pivots."""
    n = len(right)
    rows = [list(row) + [b] for row, b in zip(matrix, right)]
    for k in range(n):
        best = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(n):
            if i != k:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k])]
    return [rows[k][n] / rows[k][k] for k in range(n)]


def gain_of(elements, s):
    """(y12 + y21) / (y11 + y22) of the circuit without the source between a and b, by its nodal equations with a voltage
    at a or at b and ground at the other one. Elements: (kind, node, node, value[, controlling node])."""
    nodes = sorted({node for e in elements for node in e[1:3] if node != "0"})
    at = {node: k for k, node in enumerate(nodes)}
    n = len(nodes)
    y = [[0j] * n for _ in range(n)]

    def add(row, column, value):
        if row != "0" and column != "0":
            y[at[row]][at[column]] += value

    for kind, p, q, value, *control in elements:
        if kind == "G":  # value * v(control) flows from p to q
            add(p, control[0], value)
            add(q, control[0], -value)
            continue
        admittance = {"R": 1 / value, "C": s * value, "L": 1 / (s * value)}[kind]
        for row, column, sign in ((p, p, 1), (q, q, 1), (p, q, -1), (q, p, -1)):
            add(row, column, sign * admittance)
    inner = [k for k in range(n) if nodes[k] not in ("a", "b")]
    two_port = {}
    for driven in "ab":
        right = [-y[k][at[driven]] for k in inner]
        v = dict(zip(inner, solve([[y[k][m] for m in inner] for k in inner], right)))
        v[at[driven]] = 1.0
        for port in "ab":
            two_port[port + driven] = sum(y[at[port]][k] * value for k, value in v.items())
    return (two_port["ab"] + two_port["ba"]) / (two_port["aa"] + two_port["bb"])


def linear_loop(number):
    """An amplifier, what it drives, a feedback network: each with a load of its own, some with a way past the cut."""
    pick = random.Random(number)

    def around(value):
        return value * 10 ** pick.uniform(-0.5, 0.5)

    scale = 10 ** pick.uniform(-1, 3)
    elements = [
        ("G", "o", "0", around(2) / scale * 10, "x"), ("R", "o", "0", around(10 * scale)),
        ("C", "o", "0", around(2e-5 / scale)), ("R", "o", "a", around(scale)),
        ("R", "a", "0", around(3 * scale)), ("R", "b", "x", around(scale)),
        ("R", "x", "0", around(2 * scale)), ("C", "x", "0", around(1e-6 / scale)),
        ("C", "b", "0", around(1e-7 / scale))]
    if number % 2:
        elements += [("L", "a", "m", around(1e-5 * scale)), ("R", "m", "0", around(scale))]
    if number % 3 == 0:
        elements += [("C", "o", "x", around(3e-7 / scale))]  # the loop passes the cut, and that both ways
    if number % 5 == 0:
        elements += [("G", "a", "0", around(0.1) / scale, "b"), ("G", "b", "0", -around(0.3) / scale, "o")]
    return elements


def text_of(elements):
    lines = ["A linear loop beside a clock"]
    for k, (kind, p, q, value, *control) in enumerate(elements):
        lines.append(f"{kind}{k + 1} {p} {q} " + (f"{control[0]} 0 " if control else "") + f"{value!r}")
    return "\n".join(lines + ["Vloop a b 0", "Vclock clock 0 PULSE(0 1 0 0 0 2u 10u)", "Rclock clock 0 1k",
                              ".pss uic", ".save v(a) v(b)", ""])


def gains(checker, program, folder, text, card, name):
    """Rows of the last signal, and the report; None after a complaint."""
    done, _, _ = response(program, folder, text + card, "run", ["--report", "c.json"])
    if not checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
        return None, None
    rows = [[float(v) for v in line.split(",")] for line in (folder / "c.csv").read_text().splitlines()[1:]]
    return ([(row[0], complex(row[-2], row[-1])) for row in rows],
            json.loads((folder / "c.json").read_text())["response"])


def crossing(gain, low, high):
    """Where |T| is 1, by bisection."""
    for _ in range(200):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if (abs(gain(middle)) > 1) == (abs(gain(low)) > 1) else (low, middle)
    return low


def check_linear(checker, program, folder):
    crossed = 0
    for number in range(20):
        elements = linear_loop(number)

        def exact(frequency, elements=elements):
            return gain_of(elements, 2j * math.pi * frequency)

        rows, found = gains(checker, program, folder, text_of(elements),
                            ".ac loop=vloop injection=both dec 10 20 3meg\n", f"linear {number}")
        for frequency, gain in rows or []:
            off = abs(gain - exact(frequency))
            checker.check(off <= 1e-9 * (1 + abs(gain)), f"linear {number}: off by {off:.2g} at {frequency}")
        for cross in (found or {}).get("crossovers", []):
            at = crossing(exact, cross["frequency"] / 1.3, cross["frequency"] * 1.3)
            margin = math.degrees(cmath.phase(-exact(at)))
            near = abs(cross["frequency"] / at - 1) < 1e-8 and abs(cross["phase_margin"] - margin) < 1e-5
            checker.check(near, f"linear {number}: {cross} for {at} Hz, {margin} deg")
            crossed += 1
    checker.check(crossed >= 10, f"{crossed} crossovers are no test")


SWITCHED = """A buck converter with a divider that loads its output
Vin in 0 12
E1 cmp 0 ctl tri 1
S1 in sw cmp 0 sm
D1 0 sw
L1 sw far 47u
C1 far esr 100u
Resr esr 0 0.1
R1 far 0 2.5
Vcut1 far out 0
Ra out m {load}
Vcut2 m div 0
Rb div 0 {load}
Cb div 0 {pole}
E2 buf 0 div 0 2
Vcut3 buf fb 0
Vref ref 0 5
G1 0 ctl ref fb 1m
Rz ctl z 1.3k
Cz z 0 82n
Vtri tri 0 PULSE(0 1 0 10u 0 0 10u)
.model sm SW(Ron=0 Vt=0)
.pss uic
.save v(far)
"""


def check_switched(checker, program, folder):
    """Behind the buffer nothing takes a current: there a voltage alone does."""
    for load, pole in (("10", "10n"), ("300", "3n"), ("2", "1u")):
        text = SWITCHED.format(load=load, pole=pole)
        right, own = gains(checker, program, folder, text, ".ac loop=vcut3 dec 5 100 130k\n", "cut 3")
        if right is None:
            continue
        for cut in ("vcut1", "vcut2", "vcut3"):
            rows, found = gains(checker, program, folder, text,
                                f".ac dec 5 100 130k loop={cut} injection=both\n", cut)
            for (frequency, gain), (_, other) in zip(rows or [], right):
                off = abs(gain - other)
                checker.check(off <= 1e-8 * (1 + abs(gain)), f"{cut}: {gain} for {other} at {frequency}")
            for mine, other in zip((found or own)["crossovers"], own["crossovers"]):
                near = all(abs(mine[key] - other[key]) <= 1e-7 * abs(other[key]) for key in other)
                checker.check(near, f"{cut}: {mine} for {other}")
        wrong, _ = gains(checker, program, folder, text, ".ac dec 5 100 130k loop=vcut2\n", "wrong")
        off = max(abs(a[1] - b[1]) / (1 + abs(b[1])) for a, b in zip(wrong, right))
        checker.check(off > 1e-3, f"a voltage alone is off by {off} where the loop is loaded: the test sees nothing")


def check_words(checker, program, folder):
    """A load is told of, where a voltage alone is injected; mistakes are."""
    text = SWITCHED.format(load="10", pole="10n")
    for options, code, words in (
            (["--loop", "vcut2"], 0, "'rb' may draw a current behind 'vcut2'"),
            (["--loop", "vcut3"], 0, None), (["--loop", "vcut2", "--injection", "both"], 0, None),
            (["--loop", "vcut2", "--injection", "twice"], 2, "--injection: 'twice' is neither voltage nor both"),
            (["--injection", "both"], 2, "no loop is asked for"),
            (["--loop", "rb", "--injection", "both"], 2, "there is no voltage source 'rb'")):
        (folder / "c.cir").write_text(text)
        done = subprocess.run([program, "bode", "c.cir", "-o", "c.csv", "--from", "1k", "--to", "10k", *options],
                              cwd=folder, capture_output=True, text=True, check=False)
        said = done.stderr.strip()
        checker.check(done.returncode == code, f"{options}: {done.returncode} {said}")
        checker.check(said == "" if words is None else words in said, f"{options}: {said}")
    stepped = text.replace(".pss uic\n", ".tran 1u 1m uic\n.options dialect=ltspice\n.step Rb 9 11 1\n")
    done, _, _ = response(program, folder, stepped, "bode", ["--loop", "vcut2", "--injection", "both", "--report",
                                                           "c.json", "--from", "1k", "--to", "10k"])
    found = json.loads((folder / "c.json").read_text())["response"]
    checker.check(done.returncode == 0 and found["injection"] == "both", f"steps: {done.stderr} {found}")
    card = ".ac dec 5 1k 10k loop=vcut2 injection=tian\n"
    done, _, _ = response(program, folder, text + card)
    checker.check(done.returncode == 3 and "'voltage' or 'both'" in done.stderr, f"{card}: {done.stderr}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("tian")
    with tempfile.TemporaryDirectory() as name:
        for look in (check_linear, check_switched, check_words):
            look(checker, program, pathlib.Path(name))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
