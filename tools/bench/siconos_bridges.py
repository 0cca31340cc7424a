#!/usr/bin/python3
"""Siconos on its two diode bridge examples: Moreau-Jean time stepping, an LCP for each step.

    siconos_bridges.py CIRCUIT REFERENCE.csv REPEATS THETA STEP...

Prints a line of JSON for each step: error and CPU time of the stepping alone. Debian's
python3-siconos belongs to Debian's own Python, so this is a program of its own. The matrices are
Siconos' own, reduced by hand; its names of the unknowns are in the comments."""

import csv
import json
import sys
import time

import numpy
from siconos.kernel import (LCP, ComplementarityConditionNSL, EulerMoreauOSI, FirstOrderLinearDS,
                            FirstOrderLinearTIR, Interaction, NonSmoothDynamicalSystem,
                            TimeDiscretisation, TimeStepping)

C, L, R, CF, STOP = 1e-6, 1e-2, 1e3, 300e-9, 5e-3


def lc_bridge():
    """x = (v, i), lambda = (-v of DR1, -v of DF2, i of DF1, i of DR2); v(2,3) = lambda0 + lambda1"""
    a = [[0, -1 / C], [1 / L, 0]]
    b = [[0, 0, -1 / C, 1 / C], [0, 0, 0, 0]]
    c = [[0, 0], [0, 0], [-1, 0], [1, 0]]
    d = [[1 / R, 1 / R, -1, 0], [1 / R, 1 / R, 0, -1], [1, 0, 0, 0], [0, 1, 0, 0]]
    return [10, 0], a, b, c, d, lambda x, l: (x[0], l[0] + l[1], x[1])


def lc_bridge_capfilter():
    """x = (v, i, v of the filter)"""
    a = [[0, -1 / C, 0], [1 / L, 0, 0], [0, 0, -1 / (R * CF)]]
    b = [[0, 0, -1 / C, 1 / C], [0, 0, 0, 0], [1 / CF, 0, 1 / CF, 0]]
    c = [[0, 0, 1], [0, 0, 0], [-1, 0, 1], [1, 0, 0]]
    d = [[0, -1, 0, 0], [1, 0, 1, -1], [0, -1, 0, 0], [0, 1, 0, 0]]
    return [10, 0, 0], a, b, c, d, lambda x, l: (x[0], x[2], x[1])


def simulate(circuit, theta, step, wanted):
    """(rows at the steps in `wanted`, CPU s of the stepping)"""
    x0, a, b, c, d, signals = circuit()
    system = FirstOrderLinearDS(numpy.array(x0, float), numpy.array(a, float))
    relation = FirstOrderLinearTIR(numpy.array(c, float), numpy.array(b, float))
    relation.setDPtr(numpy.array(d, float))
    interaction = Interaction(ComplementarityConditionNSL(4), relation)
    network = NonSmoothDynamicalSystem(0.0, STOP + step)
    network.insertDynamicalSystem(system)
    network.link(interaction, system)
    stepping = TimeStepping(network, TimeDiscretisation(0.0, step), EulerMoreauOSI(theta), LCP())
    x, multiplier = system.x(), interaction.lambda_(0)
    rows, k = [], 0
    begin = time.process_time()
    for target in wanted:
        while k < target:
            stepping.computeOneStep()
            k += 1
            if k == target:
                rows.append([float(value) for value in signals(x, multiplier)])
            stepping.nextStep()
    return rows, time.process_time() - begin


def main():
    name, reference, repeats, theta, *steps = sys.argv[1:]
    circuit = {"lc_bridge": lc_bridge, "lc_bridge_capfilter": lc_bridge_capfilter}[name]
    with open(reference, newline="", encoding="utf-8") as file:
        _, *table = csv.reader(line for line in file if not line.startswith("#"))
    exact = [[float(field) for field in row] for row in table]
    for step in map(float, steps):
        wanted = [round(row[0] / step) for row in exact]
        simulate(circuit, float(theta), step, wanted[:1])  # loads what is loaded once
        runs = [simulate(circuit, float(theta), step, wanted) for _ in range(int(repeats))]
        error = max(max(abs(row[j] - values[j + 1]) for row, values in zip(runs[0][0], exact))
                    / max(abs(values[j + 1]) for values in exact) for j in range(3))
        print(json.dumps({"step": step, "error": error, "steps": round(STOP / step),
                          "cpu_s": [seconds for _, seconds in runs]}), flush=True)


if __name__ == "__main__":
    main()
