#!/usr/bin/env python3
"""Formulas of nothing but outputs of gates, samples and sources: in each row the formula of what it reads.

usage: gate_readers.py PROGRAM

A formula of sources alone is a function of time whose edges are computed before the run. The output of a gate is a
source, too, but nobody knows its edges before: a formula that took it for a known one stood still at its first value, or
at that of the copy that it had of it, with exit status 0.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

ALLOWED = 1e-9  # of what the formula is made of
VALUES = "v(y) v(z) v(w)"  # of the gate, of another one, of a sine

# what puts out v(y), and v(z): clocks of period T and 0.37 T, levels of A volts
GATES = {
    "sample": "A1 w 0 c 0 0 0 y 0 SAMPLEHOLD Ref={A4!r}\nA2 y 0 c 0 0 0 z 0 SAMPLEHOLD "
              "Ref={A4!r}\n",
    "divider": "A1 k 0 c 0 0 k y 0 DFLOP Vhigh={A!r} Ref={A4!r}\nA2 c y 0 0 0 0 z 0 XOR Vhigh={A!r} Ref={A4!r}\n",
    "counter": "A1 c 0 0 0 0 0 y 0 COUNTER cycles=3 duty=0.34 Vhigh={A!r} Ref={A4!r}\n"
               "A2 c 0 0 0 0 0 z 0 COUNTER cycles=5 duty=0.6 Vhigh={A3!r} Vlow={negative!r} Ref={A4!r}\n",
    "ramps": "A1 c 0 0 0 0 0 y 0 BUF Td={T20!r} Trise={T9!r} Tfall={T20!r} Vhigh={A!r} Ref={A4!r}\n"
             "A2 c 0 0 0 0 z 0 0 INV Td={T9!r} Trise={T20!r} Vhigh={A!r} Vlow={negative!r} Ref={A4!r}\n",
    "schmitt": "A1 w 0 0 0 0 0 y 0 SCHMITT Vt={A3!r} Vh={A9!r} Vhigh={A!r}\nA2 w 0 0 0 0 0 z 0 SCHMITT Vhigh={A3!r}\n",
    "latch": "A1 c f 0 0 0 0 y 0 SRFLOP Vhigh={A!r} Ref={A4!r}\nA2 f c 0 0 0 0 z 0 AND Vhigh={A!r} Ref={A4!r}\n",
    "bridges": "A1 [c f] [dc df] ad\n.model ad adc_bridge(in_low={A4!r} in_high={A4!r} rise_delay={T20!r})\n"
               "A2 [dc ~df] dy nd\n.model nd d_nand(rise_delay={T9!r} fall_delay={T20!r})\nA3 [dy dc] [y z] da\n"
               ".model da dac_bridge(out_low={negative!r} out_high={A!r} t_rise={T20!r} t_fall={T9!r})\n",
    "monostable": "A1 c s null y mono\nVs s 0 {A3!r}\n.model mono oneshot(cntl_array=[0 {A!r}] pw_array=[{T20!r} {T!r}] "
                  "clk_trig={A4!r} rise_time={T9!r} fall_time={T20!r} out_low={negative!r} out_high={A!r})\nA2 f 0 0 0 0 0 z 0 BUF Vhigh={A!r} Ref={A4!r}\n",
}


def limit(x, low, high):
    return max(low, min(high, x))


# the formula, Python's, and whether its value jumps with what it reads
FORMULAS = [
    ("2*v(y)", lambda y, z, w, A: 2 * y),
    ("v(y)+{A}", lambda y, z, w, A: y + A),
    ("v(y)-v(z)", lambda y, z, w, A: y - z),
    ("v(y)-0.5*v(w)", lambda y, z, w, A: y - 0.5 * w),
    ("limit(v(y)+v(w), {A9}, {A})", lambda y, z, w, A: limit(y + w, 0.09 * A, A)),
    ("abs(v(z)-{A3})", lambda y, z, w, A: abs(z - 0.3 * A)),
    ("max(v(y), min(v(z), v(w)))", lambda y, z, w, A: max(y, min(z, w))),
    ("table(v(z), {A9},0, {A3},{A}, {A},{A3})", None),
    ("v(y) > {A4} ? 1 : -2", lambda y, z, w, A: 1.0 if y > 0.43 * A else -2.0),
    ("v(y) > v(w) ? v(z) : {A3}", lambda y, z, w, A: z if y > w else 0.3 * A),
    ("v(y) > {A4} && v(z) > {A4} ? {A} : 0", lambda y, z, w, A: A if y > 0.43 * A and z > 0.43 * A else 0.0),
    ("v(z)*v(w)/{A}", lambda y, z, w, A: z * w / A),
    ("u(v(y)-{A4})*v(w)", lambda y, z, w, A: w if y > 0.43 * A else 0.0),
]
# where a formula jumps, a row on its edge may be on either side
EDGES = {8: lambda y, z, w, A: [y - 0.43 * A], 9: lambda y, z, w, A: [y - w],
         10: lambda y, z, w, A: [y - 0.43 * A, z - 0.43 * A], 12: lambda y, z, w, A: [y - 0.43 * A]}


def table(z, A):
    points = [(0.09 * A, 0.0), (0.3 * A, A), (A, 0.3 * A)]
    if z <= points[0][0]:
        return points[0][1]
    for (a, fa), (b, fb) in zip(points, points[1:]):
        if z <= b:
            return fa + (fb - fa) * (z - a) / (b - a)
    return points[-1][1]


def netlist(gate, A, T):
    values = {"A": A, "A3": 0.3 * A, "A4": 0.43 * A, "A9": 0.09 * A, "negative": -0.7 * A, "T": T, "T9": 0.09 * T,
              "T20": T / 20}
    text = [f"formulas of gates\nVc c 0 PULSE(0 {A!r} {0.1 * T!r} 0 0 {0.4 * T!r} {T!r})",
            f"Vf f 0 PULSE(0 {A!r} {0.173 * T!r} 0 0 {0.11 * T!r} {0.37 * T!r})",
            f"Vw w 0 SIN({0.4 * A!r} {0.9 * A!r} {0.21 / T!r})", GATES[gate].format(**values)]
    for k, (formula, _) in enumerate(FORMULAS):
        for name in ("A9", "A3", "A4", "A"):
            formula = formula.replace("{" + name + "}", repr(values[name]))
        text.append(f"B{k} u{k} 0 V={formula}\nE{k} x{k} 0 u{k} 0 1\nR{k} x{k} q{k} 1k\nC{k} q{k} 0 {T * 1e-4!r}")
    saved = " ".join(f"v(u{k})" for k in range(len(FORMULAS)))
    return "\n".join(text + [f".save {VALUES} {saved}\n.tran {T / 7!r} {9.3 * T!r} uic\n.end\n"])


def check_case(checker, program, gate, A, T, method):
    outcome = run(program, netlist(gate, A, T), method=method, report=False, options=("--audit", "full"),
                  step=T / 400 if method == "euler" else None)
    what = f"{gate}, {A} V, {T} s, {method or 'auto'}"
    if not checker.check(outcome.status == 0, f"{what}: exit {outcome.status}\n{outcome.stderr}"):
        return
    y, z, w = (outcome.column(signal) for signal in VALUES.split())
    checker.check(len(set(y)) > 1 and len(set(z)) > 1, f"{what}: its outputs stand still")
    for k, (formula, f) in enumerate(FORMULAS):
        worst = 0.0
        for row, found in zip(zip(y, z, w), outcome.column(f"v(u{k})")):
            on_edge = k in EDGES and min(map(abs, EDGES[k](*row, A))) <= ALLOWED * A
            wanted = f(*row, A) if f else table(row[1], A)
            worst = max(worst, 0.0 if on_edge else abs(found - wanted))
        checker.close(worst, 0.0, ALLOWED * max(A, 2.0), f"{what}: {formula} is off")


def main():
    checker = Checker("gate_readers")
    scales = [(1.0, 1e-3), (5.0, 1e-6), (300.0, 0.1), (0.02, 1e-4)]
    for gate in GATES:
        for A, T in some_of(scales):
            check_case(checker, sys.argv[1], gate, A, T, None)
        check_case(checker, sys.argv[1], gate, 5.0, 1e-3, "euler")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
