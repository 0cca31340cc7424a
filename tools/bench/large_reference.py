"""Reference values by extrapolated implicit Euler, for circuits too large for the exact reference.

y(h) = y + c1 h + c2 h^2 + ... at each output time that is a step of all runs; two columns of the
extrapolation table leave what is not smooth: events move by whole steps. So the error is not taken
from theory but measured, as the largest change when all three steps are halved."""

import csv
import math
import subprocess

import near_ideal

GOLDEN = (math.sqrt(5) - 1) / 2
ROWS = 100


def euler(dalcs, netlist, step, times_file, folder):
    output = folder / f"euler_{step:g}.csv"
    subprocess.run([dalcs, "run", netlist, "--quiet", "--method", "euler", "--step", repr(step),
                    "--at", times_file, "-o", output], check=True)
    with open(output, newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    return header, [[float(field) for field in row] for row in rows]


def extrapolate(coarse, fine, factor):
    return [[f[0]] + [b + (b - a) / (factor - 1) for a, b in zip(c[1:], f[1:])]
            for c, f in zip(coarse, fine)]


def difference(one, two):
    """Over each column's size, the largest."""
    columns = list(zip(*two))[1:]
    return max(max(abs(a[k + 1] - b[k + 1]) for a, b in zip(one, two))
               / max(map(abs, column)) for k, column in enumerate(columns))


def make(dalcs, netlist, step, times_file, folder):
    """(header, rows, how far they can be trusted) from four runs: step/8 is the finest."""
    header, runs = None, []
    for level in range(4):
        header, rows = euler(dalcs, netlist, step / 2 ** level, times_file, folder)
        runs.append(rows)
    first = [extrapolate(a, b, 2) for a, b in zip(runs, runs[1:])]
    second = [extrapolate(a, b, 4) for a, b in zip(first, first[1:])]
    candidates = [(difference(first[-2], first[-1]), first[-1]),
                  (difference(second[-2], second[-1]), second[-1]),
                  (difference(runs[-2], runs[-1]), runs[-1])]
    accuracy, rows = min(candidates, key=lambda candidate: candidate[0])
    return header, rows, accuracy


def write(circuit, dalcs, netlist, folder):
    """The circuit's file of reference values. Its grid is the coarsest of the four steps."""
    stop = near_ideal.analyses(near_ideal.logical_lines(circuit.text())[1])[1][1]
    places = [(k + (k * GOLDEN) % 1) * stop / ROWS for k in range(ROWS)]
    times = sorted({max(1, round(place / circuit.grid)) * circuit.grid for place in places})
    times_file = folder / f"{circuit.name}.at"
    times_file.write_text("".join(f"{time:.12g}\n" for time in times))
    header, rows, accuracy = make(dalcs, netlist, circuit.grid, times_file, folder)
    with open(circuit.values(), "w", newline="", encoding="utf-8") as file:
        file.write(f"# {circuit.reference} from steps of {circuit.grid:g} s and a half, a quarter, "
                   f"an eighth of it; halving them changes it by {accuracy:.0e}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows([f"{value:.17g}" for value in row] for row in rows)
