#!/usr/bin/env python3
"""A ladder of capacitors and diodes is isotonic regression: of a jump everything is known exactly.

usage: isotonic.py PROGRAM step|euler|default N...

`step` looks at the values after one step of implicit Euler of 1 s: nothing limits a current here,
so that a step of any length is the jump. `euler` and `default` look at the report of the jump.

C_k from node k to ground starts at v_k, diode D_k leads from node k to node k + 1. Just after t = 0
the voltages x are the nearest to v, in the norm of the C_k, that do not descend. "Pool adjacent
violators" (Ayer et al., Ann. Math. Stat. 26, 1955) finds them; here with integers, so exactly. The
charge through D_k is what nodes 1 to k lost: sum C_j (v_j - x_j); the energy lost is
1/2 sum C_j (v_j - x_j)^2.
"""

import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import IS_LONG, Checker, run, some_of  # noqa: E402

CERTIFIED = 2e-13
STATE = 1e-12    # of the largest voltage
CHARGE = 1e-9    # of the largest charge of the pool
ENERGY = 1e-9
LARGE = 20000      # from here on one seed of one shape
MOST_SOLVES = 100  # mode changes and one-step problems of a whole run
SHAPES = {
    "random": lambda values: values,
    "rising": sorted,
    "falling": lambda values: sorted(values, reverse=True),
    "tied": lambda values: [float(round(value / 4.0)) for value in values],
    "saw": lambda values: [value + k % 7 for k, value in enumerate(sorted(values, reverse=True))],
}


def as_integers(values):
    """Integers, and the power of two that they are the values times of: nothing is rounded."""
    parts = [value.as_integer_ratio() for value in values]
    power = max(denominator for _, denominator in parts)
    return [numerator * (power // denominator) for numerator, denominator in parts], power


def pool_violators(weight, value):
    """(first, end, sum of weights, sum of weight times value) of each pool; their means ascend."""
    pools = []
    for k, (w, v) in enumerate(zip(weight, value)):
        pool = (k, k + 1, w, w * v)
        while pools and pools[-1][3] * pool[2] >= pool[3] * pools[-1][2]:
            first, _, w_before, wv_before = pools.pop()
            pool = (first, k + 1, w_before + pool[2], wv_before + pool[3])
        pools.append(pool)
    return pools


def exact_jump(capacitance, before):
    """Voltages after, charges through the diodes, the largest charge of each diode's pool, and the
    energy lost; the last digit of each is rounded, nothing else."""
    weight, weight_unit = as_integers(capacitance)
    value, value_unit = as_integers(before)
    after, charge, scale = [], [], []
    energy = 0.0
    for first, end, w, wv in pool_violators(weight, value):
        after += [wv / (w * value_unit)] * (end - first)
        # weights times (v - x), over a common denominator w
        passed = 0
        of_pool = []
        twice = 0
        for k in range(first, end):
            fall = value[k] * w - wv
            passed += weight[k] * fall
            twice += weight[k] * fall * fall
            of_pool.append(passed / (w * weight_unit * value_unit))
        energy += twice / (2 * w * w * weight_unit * value_unit * value_unit)
        charge += of_pool
        scale += [max(abs(q) for q in of_pool)] * (end - first)
    return after, charge[:-1], scale[:-1], energy


def netlist(capacitance, before, stop):
    lines = ["a ladder of capacitors and diodes"]
    lines += [f"C{k} {k} 0 {c!r} ic={v!r}" for k, (c, v) in enumerate(zip(capacitance, before), 1)]
    lines += [f"D{k} {k} {k + 1}" for k in range(1, len(before))]
    return "\n".join(lines + [f".tran {stop!r} {stop!r} uic", ".end", ""])


def check_step(checker, program, label, capacitance, before):
    """One step of 1 s: amperes are coulombs."""
    n = len(before)
    result = run(program, netlist(capacitance, before, 1.0), step=1.0)
    if not checker.check(result.status == 0, f"{label}: exit {result.status}: {result.stderr}"):
        return
    row = dict(zip(result.names, result.rows[-1]))
    after, charge, _, _ = exact_jump(capacitance, before)
    compare(checker, label, "voltage", [row[f"v({k})"] for k in range(1, n + 1)], after,
            [STATE * max(abs(v) for v in before)] * n)
    compare(checker, label, "charge", [row[f"i(d{k})"] for k in range(1, n)], charge,
            [CHARGE * max(charge)] * (n - 1))
    checker.check(result.report["certificate"]["worst"] <= CERTIFIED,
                  f"{label}: certificate {result.report['certificate']['worst']:.2e}")


def check_jump(checker, program, method, label, capacitance, before):
    n = len(before)
    result = run(program, netlist(capacitance, before, 1e-6), method=method)
    if not checker.check(result.status == 0, f"{label}: exit {result.status}: {result.stderr}"):
        return
    report = result.report
    after, charge, scale, energy = exact_jump(capacitance, before)
    compare(checker, label, "voltage", [report["start"][f"c{k}"] for k in range(1, n + 1)], after,
            [STATE * max(abs(v) for v in before)] * n)
    checker.check(all(jump["time"] == 0.0 for jump in report["jumps"]), f"{label}: a later jump")
    listed = [set(jump["impulses"]) for jump in report["jumps"]]
    # The report leaves out charges that are nothing beside the largest.
    allowed = [CHARGE * (pool if any(f"d{k}" in names for names in listed) else max(charge))
               for k, pool in enumerate(scale, 1)]
    compare(checker, label, "charge", [result.impulse(f"d{k}", "charge") for k in range(1, n)],
            charge, allowed)
    checker.close(result.loss(), energy, ENERGY * energy, f"{label}: energy lost")
    checker.check(report["certificate"]["worst"] <= CERTIFIED,
                  f"{label}: certificate {report['certificate']['worst']:.2e}")
    solves = report["work"]["osnsp"] + report["work"]["pivots"]
    checker.check(solves <= MOST_SOLVES, f"{label}: {solves} solves")


def compare(checker, label, what, found, wanted, allowed):
    """All of them, the worst is named."""
    worst = max(range(len(wanted)), default=None,
                key=lambda k: abs(found[k] - wanted[k]) - allowed[k])
    if worst is not None:
        checker.close(found[worst], wanted[worst], allowed[worst],
                      f"{label}: {what} number {worst + 1}")


def main():
    program, what, sizes = sys.argv[1], sys.argv[2], [int(n) for n in sys.argv[3:]]
    checker = Checker(f"isotonic {what}")
    for n in sizes if IS_LONG else sizes[:-1]:  # the largest takes most of the time
        for shape in some_of(SHAPES) if n < LARGE else ["random"]:
            for seed in range(max(1, min(5, 10000 // n))):
                chance = random.Random(f"{n} {shape} {seed}")
                capacitance = [10.0 ** chance.uniform(-12.0, -3.0) for _ in range(n)]
                before = SHAPES[shape]([chance.uniform(-10.0, 10.0) for _ in range(n)])
                label = f"{n} {shape} {seed}"
                if what == "step":
                    check_step(checker, program, label, capacitance, before)
                else:
                    check_jump(checker, program, "euler" if what == "euler" else None, label,
                               capacitance, before)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
