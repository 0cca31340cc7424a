#!/usr/bin/env python3
"""Siconos (Debian's python3-siconos) on the problems of degenerate.py that it can take.

usage: second_opinion.py SOLVE_NETLISTS COUNT [FIRST]

Its solvers of linear complementarity problems, w = M lambda + q, ask for a matrix. The equations, reduced in rational
numbers to the pairs, give one of lambda and w of each pair in terms of the others; what is open or asks something of
sources has no such form, and is not taken. An answer of Siconos counts where its signs say which
of each pair is 0 and that mode, in rational numbers, is an answer. dalcs must have solved that problem. What Siconos
finds no answer to although there is one, is counted.
"""

import pathlib
import subprocess
import sys
import tempfile
from fractions import Fraction

import numpy
import siconos.numerics as numerics
from degenerate import draw
from rational import Problem

SOLVERS = {"Lemke": numerics.SICONOS_LCP_LEMKE, "pivot": numerics.SICONOS_LCP_PIVOT}


def in_terms_of_others(problem):
    """{column: ({column: value}, constant)}: one of (lambda, w) of each pair in terms of the other ones; None: it is
    not to be had. Of a switch the other one is what is 0."""
    n = problem.n_pairs
    rows = [[{c: v for c, v in row.items() if c >= 0}, right] for row, right in problem.reduced()]
    found = {}
    for i, (row, right) in enumerate(rows):
        taken = {c % n for c in found}
        free = [c for c in row if c % n not in taken
                and (problem.is_diode[c % n] or (c < n) == problem.mode[c % n])]
        if not free:
            if row or right != 0:
                return None
            continue
        c = max(free)
        pivot = row[c]
        rows[i] = [{k: v / pivot for k, v in row.items()}, right / pivot]
        found[c] = i
        for j, other in enumerate(rows):
            factor = other[0].get(c, 0)
            if j != i and factor:
                for k, v in rows[i][0].items():
                    Problem.put(other[0], k, -factor * v)
                other[1] -= factor * rows[i][1]
    if len(found) < n:
        return None
    return {c: ({k: -v for k, v in rows[i][0].items() if k != c}, rows[i][1]) for c, i in found.items()}


def make_lcp(problem):
    """M, q of the diodes, in rational numbers; None: it is not to be had."""
    n = problem.n_pairs
    rows = in_terms_of_others(problem)
    if rows is None:
        return None
    dependent = [c for c in rows if problem.is_diode[c % n]]
    other = [(c + n) % (2 * n) for c in dependent]
    return [[rows[c][0].get(e, Fraction(0)) for e in other] for c in dependent], [rows[c][1] for c in dependent]


def solution(M, q, basis):
    """z with z_k = 0 outside the basis and w_k = 0 in it; None: that is no one answer."""
    n = len(basis)
    table = [[M[i][j] for j in basis] + [-q[i]] for i in basis]
    for k in range(n):
        best = next((i for i in range(k, n) if table[i][k] != 0), None)
        if best is None:
            return None
        table[k], table[best] = table[best], table[k]
        table[k] = [v / table[k][k] for v in table[k]]
        for i in range(n):
            if i != k and table[i][k] != 0:
                table[i] = [a - table[i][k] * b for a, b in zip(table[i], table[k])]
    z = [Fraction(0)] * len(q)
    for k, j in enumerate(basis):
        z[j] = table[k][n]
    return z


def is_answered(M, q, solver):
    """By Siconos, and right in rational numbers."""
    size = len(q)
    z, w = numpy.zeros(size), numpy.zeros(size)
    lcp = numerics.LCP(numpy.array(M, dtype=float), numpy.array(q, dtype=float))
    if numerics.linearComplementarity_driver(lcp, z, w, numerics.SolverOptions(solver)) != 0:
        return False
    exact = solution(M, q, [k for k in range(size) if z[k] > w[k]])
    return exact is not None and all(v >= 0 for v in exact) and all(
        sum(m * v for m, v in zip(row, exact)) + c >= 0 for row, c in zip(M, q))


def main():
    solver, count = sys.argv[1], int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    problems, taken, solvable, failed = 0, 0, 0, 0
    answered = dict.fromkeys(SOLVERS, 0)
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, first + count):
            done = subprocess.run([solver, folder], input=draw(seed), capture_output=True, text=True, check=True)
            for line in done.stdout.splitlines():
                words = line.split()
                problem = Problem(pathlib.Path(folder) / f"{words[0]}.dalcs")
                problems += 1
                lcp = make_lcp(problem) if problem.n_pairs > 0 else None
                if lcp is None or not lcp[1]:
                    continue
                taken += 1
                is_solved = int(words[3]) == 0
                solvable += is_solved
                for name, number in SOLVERS.items():
                    if is_answered(*lcp, number):
                        answered[name] += 1
                        if not is_solved:
                            failed += 1
                            print(f"FAILED {seed}: system {words[1]}, sigma {words[2]}: Siconos has an answer")
    said = ", ".join(f"{n} by its {name}" for name, n in answered.items())
    print(f"second_opinion.py: {problems} problems, {taken} of them taken, {solvable} of these solved, {said}; {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
