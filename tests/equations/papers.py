#!/usr/bin/env python3
"""The papers' systems in netlists/papers against closed forms or against an integrator of its own.

usage: papers.py DALCS

The references are written from the papers' equations, with each complementarity solved by hand, and not from
the files: x' = f(t, x) goes with the classical Runge-Kutta method and steps far below the output's. Where a
constraint holds a state, small projected Euler steps do."""

import csv
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

import dalcs_program  # noqa: E402
import runge_kutta  # noqa: E402

PAPERS = dalcs_program.NETLISTS / "papers"


def run(program, name, *options):
    with tempfile.TemporaryDirectory() as folder:
        output, report = pathlib.Path(folder) / "o.csv", pathlib.Path(folder) / "r.json"
        done = subprocess.run([program, "run", str(PAPERS / name), "-o", str(output), "--quiet",
                               "--report", str(report), *options],
                              capture_output=True, text=True, check=False)
        rows = list(csv.reader(output.read_text().splitlines())) if output.exists() else [[]]
        columns = {key: [float(row[k]) for row in rows[1:]] for k, key in enumerate(rows[0])}
        return done.returncode, columns, done.stderr


def at(columns, name, time):
    best = min(range(len(columns["time"])), key=lambda k: (abs(columns["time"][k] - time), -k))
    return columns[name][best]


def solution(f, x, stop, n):
    """{time: x} at n steps' ends."""
    h, t = stop / n, 0.0
    for k in range(n):
        x = runge_kutta.step(f, t, x, h)
        t = (k + 1) * h
        yield t, x


def projected(f, held, x, stop, n):
    """Explicit Euler by halves; x[held] stays at 0 where f would take it below."""
    h = stop / n
    for k in range(n):
        t = k * h
        half = [a + h / 2 * b for a, b in zip(x, f(t, x))]
        half[held] = max(0.0, half[held])
        x = [a + h * b for a, b in zip(x, f(t + h / 2, half))]
        x[held] = max(0.0, x[held])
        yield (k + 1) * h, x


def plus(value):
    return max(0.0, value)


def loops(_, x):  # 6.1
    s = x[0] / 2 - x[1]
    return [plus(x[1] - 2 * x[0]), s + plus(-s) / 3]


def coil(t, x):  # 6.2, z = (x1 + x2) / 2
    return [-x[0] + (x[0] + x[1]) / 2 + 2 * math.sin(0.4 * math.pi * t), -x[1] + (x[0] + x[1]) / 2]


def coil_not_passive(t, x):
    v = -0.5 + 3 * math.sin(math.pi * t)
    return [x[0] + (x[0] + x[1]) / 2 + v, -x[1] + (x[0] + x[1]) / 2]


def absolute(t, x):
    e = 2 * math.sin(0.6 * math.pi * t)
    s = 0.5 * abs(x[0]) + 0.1 + math.sin(0.22 * math.pi * t)
    return [-x[0] + (s / 0.75 if s > 0 else s / 1.25) + e]


def switching(a3, a4):
    def f(t, x):
        z = -((a3 if x[0] < 0 else a4) * x[0] + x[1] + math.sin(10 * t))
        return [x[0] + x[1] + 10 * z + 40 * math.sin(25 * t), x[0] + x[1] + 20 * z + math.sin(t)]
    return f


def springs(t, x):
    return [x[1], 5 * math.sin(0.5 * math.pi * t) + plus(-20 * x[0] - 20) - plus(20 * x[0] - 20),
            x[3], -math.sin(t)]


def feedback(t, x):  # 6.5: a z - lambda = s
    s = x[1] + 0.2 + math.sin(0.3 * math.pi * t)
    return [-x[0] + plus(-s) + 2 * math.sin(0.2 * math.pi * t), x[0] - plus(s) / 0.5]


def bridge(third):
    def f(_, x):
        i1 = -2 * x[0] + x[1] + plus(2 * x[0] - x[1])
        return [i1, x[0] - 2 * x[1] + x[2], third(x)]
    return f


# file, stop, x0, f, signals, the held state, steps, tolerance over the largest value
CASES = [
    ("b22_6_1.dalcs", 5, [0, 1], loops, ["x1", "x2"], None, 5000, 1e-6),
    ("b22_6_2.dalcs", 10, [1, 0.5], coil, ["x1", "x2"], 0, 100000, 1e-4),
    ("b22_6_2_not_passive.dalcs", 3, [0.2, 0.5], coil_not_passive, ["x1", "x2"], 0, 100000, 1e-4),
    ("b22_6_3_absolute.dalcs", 10, [0.3], absolute, ["x"], None, 10000, 1e-6),
    ("b22_6_3_switching.dalcs", 2, [0, 0.1], switching(1, 1), ["x1", "x2"], None, 20000, 1e-6),
    ("b22_6_3_two_branches.dalcs", 2, [0, 0.1], switching(-0.5, 2), ["x1", "x2"], None, 20000, 1e-5),
    ("b22_6_4.dalcs", 10, [0, 1, 0, 1], springs, ["q1", "v1", "q2", "v2"], None, 20000, 1e-5),
    ("b22_6_5.dalcs", 20, [0, 0], feedback, ["x1", "x2"], None, 20000, 1e-6),
    ("bg09_33.dalcs", 10, [0.2, 1, 0.5], bridge(lambda x: -x[0] + 2 * x[1] - x[2]),
     ["x1", "x2", "x3"], 2, 100000, 1e-4),
    ("bg09_33_printed.dalcs", 10, [0.2, 1, 0.5], bridge(lambda x: 0.0),
     ["x1", "x2", "x3"], None, 10000, 1e-6),
]


def check_integrated(checker, program):
    for name, stop, x0, f, signals, held, n, tolerance in CASES:
        status, columns, stderr = run(program, name)
        if not checker.check(status == 0, f"{name}: {stderr}"):
            continue
        scale = max(abs(v) for s in signals for v in columns[s])
        steps = solution(f, x0, stop, n) if held is None else projected(f, held, x0, stop, n)
        for k, (t, x) in enumerate(steps):
            if (k + 1) % (n // 20) == 0:
                for signal, value in zip(signals, x):
                    checker.close(at(columns, signal, t), value, tolerance * scale,
                                  f"{name}: {signal}({t:g})")


def check_closed_forms(checker, program):
    _, held, _ = run(program, "bt10_fig_2_1.dalcs")
    _, circuit, _ = run(program, "bt10_fig_2_1.cir")
    for time, value in ((8e-3, 4.31117304732), (18e-3, 4.72092260618)):
        checker.close(at(held, "z", time), value, 1e-6, f"figure 2.1: z({time})")
        checker.close(at(circuit, "v(2,3)", time), value, 1e-6, f"figure 2.1: v({time})")
    for tolerance in ("1e-3", "1e-6", "1e-9", "1e-12"):  # the jump is seen by micro-steps alone
        _, sweeping, _ = run(program, "bt10_fig_2_2.dalcs", "--tol", tolerance)
        for time, value in ((1, 0.75), (3, 1.5), (4.9, 1.5), (6, 3), (8.5, 3.125), (10, 3.5)):
            checker.close(at(sweeping, "x", time), value, 1e-9, f"figure 2.2, {tolerance}: x({time})")
    for name, signals in (("bt10_two_coils.dalcs", ("x1", "x2")),
                          ("bt10_two_coils.cir", ("i(l1)", "i(l2)"))):
        _, coils, _ = run(program, name)
        for signal, value in zip(signals, (1.475, 0.525)):
            checker.close(at(coils, signal, 5e-3), value, 1e-9, f"{name}: {signal}")
    for name, signals in (("bg09_36.dalcs", ("vl", "il")), ("bg09_36.cir", ("v(1)", "i(l1)"))):
        _, tank, _ = run(program, name)
        checker.close(at(tank, signals[0], 5e-3), 0.790322819644, 1e-5, f"{name}: {signals[0]}")
        checker.close(at(tank, signals[1], 5e-3), -0.0026478501601, 1e-7, f"{name}: {signals[1]}")
    _, shorted, _ = run(program, "bg09_38.dalcs")
    for time in (1e-3, 3e-3):
        checker.close(at(shorted, "x", time), 5 * math.exp(-1e3 * time), 1e-5, f"(38): x({time})")
    _, relay, _ = run(program, "hsw99_relay.dalcs")
    checker.close(at(relay, "x", 1.0), 2 * math.exp(-1) - 0.5, 1e-6, "relay: x(1)")
    checker.close(at(relay, "x", 2.0), 0.0, 1e-9, "relay: x(2)")
    checker.close(at(relay, "lambda(r)", 2.0), -0.5, 1e-9, "relay: lambda(2)")
    _, ball, _ = run(program, "hsw99_unilateral.dalcs")
    checker.close(at(ball, "q", 0.4), 1 - 9.81 * 0.08, 1e-9, "ball: q(0.4)")
    checker.close(at(ball, "q", 0.8), 0.0, 1e-9, "ball: q(0.8)")
    checker.close(at(ball, "lambda(floor)", 0.8), 19.62, 1e-6, "ball: lambda(0.8)")
    _, friction, _ = run(program, "bg13_friction.dalcs")
    _, analogue, _ = run(program, "bg13_friction.cir")
    for time in (0.1, 0.3, 1, 2, 3, 5, 9):
        for mechanical, electrical in (("d(q1)", "i(l1)"), ("d(q2)", "i(l2)")):
            checker.close(at(friction, mechanical, time), at(analogue, electrical, time), 2e-5,
                          f"friction: {mechanical}({time})")


def check_solvability(checker, program):
    for name, wanted in (("hsw99_4_2a.cir", 1), ("hsw99_4_2b.cir", 0), ("hsw99_4_11.cir", 0),
                         ("hsw99_5_11.dalcs", 0), ("hsw99_5_18.dalcs", 1),
                         ("hsw99_5_11.cir", 0), ("hsw99_5_18.cir", 1)):
        status, columns, stderr = run(program, name)
        checker.check(status == wanted, f"{name}: status {status}, not {wanted}: {stderr}")
        if name == "hsw99_5_11.dalcs":
            checker.close(at(columns, "x1", 0.5), 0.0, 1e-9, "5.11: x1")
        if name == "hsw99_5_11.cir":
            for signal in ("v(x1)", "v(x2)"):
                checker.close(at(columns, signal, 0.5), 0.0, 1e-9, f"5.11: {signal}")
            check_shared_impulse(checker, program, name)
        if name == "hsw99_4_2b.cir":
            checker.close(at(columns, "v(x1)", 2.0), 0.0, 1e-9, "4.2b: v(x1)")
        if name == "hsw99_4_11.cir":
            checker.close(at(columns, "i(d2)", 1e-6), 1e-3, 1e-9, "4.11: i(d2)")


def check_shared_impulse(checker, program, name):
    """Any shares of 1 C are an answer, none of which is negative."""
    for method in ("euler", None):
        for step in (10e-3, 7e-3, 1e-3):
            report = dalcs_program.run(program, dalcs_program.NETLISTS / "papers" / name, step=step,
                                       method=method).report
            charges = [impulse["charge"] for impulse in report["jumps"][0]["impulses"].values()]
            checker.close(sum(charges), 1.0, 1e-9, f"5.11, {method}: the charges together")
            checker.check(min(charges) >= 0.0, f"5.11, {method}: charges {charges}")


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("papers")
    check_integrated(checker, program)
    check_closed_forms(checker, program)
    check_solvability(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
