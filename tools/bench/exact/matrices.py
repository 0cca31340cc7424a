"""Matrices of decimal numbers: what the exact reference needs of linear algebra.

A hundred digits, so that a rank is decided between 1e-25 and 1e-80 and never in doubt. A matrix is a
list of rows."""

import decimal

decimal.getcontext().prec = 100
D = decimal.Decimal
ZERO, ONE = D(0), D(1)
RANK = D("1e-25")  # a pivot this much smaller than the largest entry is none
NOISE = D("1e-50")  # a column this much smaller than the largest is what rounding left of 0


class Singular(Exception):
    """No unique solution."""


def zeros(rows, columns):
    return [[ZERO] * columns for _ in range(rows)]


def times(a, b):
    """a b; most entries of circuit matrices are 0."""
    columns = len(b[0])
    product = []
    for row in a:
        total = [ZERO] * columns
        for factor, other in zip(row, b):
            if factor:
                for k, value in enumerate(other):
                    if value:
                        total[k] += factor * value
        product.append(total)
    return product


def times_vector(a, x):
    return [sum((factor * value for factor, value in zip(row, x) if factor), ZERO) for row in a]


def solve(a, b, least=RANK):
    """X of a X = b, both with columns, by elimination with row scaling and partial pivoting;
    Singular where a pivot is below `least`."""
    n = len(a)
    work = []
    for left, right in zip(a, b):
        size = max(map(abs, left))
        if not size:
            raise Singular
        work.append([value / size for value in left] + [value / size for value in right])
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(work[i][k]))
        if abs(work[pivot][k]) < least:
            raise Singular
        work[k], work[pivot] = work[pivot], work[k]
        top = work[k]
        for i in range(k + 1, n):
            row = work[i]
            if row[k]:
                factor = row[k] / top[k]
                for j in range(k + 1, len(row)):
                    if top[j]:
                        row[j] -= factor * top[j]
                row[k] = ZERO
    columns = len(b[0])
    x = [None] * n
    for k in reversed(range(n)):
        row = work[k]
        values = row[n:]
        for j in range(k + 1, n):
            if row[j]:
                values = [v - row[j] * w if w else v for v, w in zip(values, x[j])]
        x[k] = [value / row[k] for value in values]
    assert all(len(row) == columns for row in x)
    return x


def solve_vector(a, b, least=RANK):
    return [row[0] for row in solve(a, [[value] for value in b], least)]


def column_basis(a):
    """(V, rows): the columns of V span those of a, and V restricted to `rows` is the identity, so
    that the coordinates of a vector of the span are its own entries there."""
    columns = [list(column) for column in zip(*a)]
    sizes = [max(map(abs, column)) for column in columns]
    smallest = NOISE * max(sizes)
    columns = [[value / size for value in column] for column, size in zip(columns, sizes)
               if size > smallest]
    rows, basis = [], []
    while True:
        best = max(((abs(value), c, r) for c, column in enumerate(columns)
                    for r, value in enumerate(column)), default=(ZERO, 0, 0))
        if best[0] < RANK:
            break
        _, c, r = best
        chosen = columns.pop(c)
        chosen = [value / chosen[r] for value in chosen]
        for other in columns + basis:
            factor = other[r]
            if factor:
                other[:] = [o - factor * v if v else o for o, v in zip(other, chosen)]
                other[r] = ZERO
        rows.append(r)
        basis.append(chosen)
    order = sorted(range(len(rows)), key=lambda k: rows[k])
    v = [list(row) for row in zip(*(basis[k] for k in order))] if basis else [[] for _ in a]
    return v, [rows[k] for k in order]
