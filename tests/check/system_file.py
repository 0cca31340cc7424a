"""Reads the matrices of a system file (doc/system-file.md) and eliminates z, in rational numbers: what the
tests of `dalcs check` compute apart from the program."""

import re
from fractions import Fraction

SUFFIX = {"k": 3, "m": -3, "u": -6, "n": -9}
ALIAS = {"A": "A_I", "B": "Bbar_I", "C": "C_I"}


def number(word, parameters):
    if word.startswith("{"):
        return Fraction(eval(word[1:-1], {"__builtins__": {}}, parameters))  # {1/R}
    match = re.fullmatch(r"([-+]?[\d.]+(?:e[-+]?\d+)?)([a-z]?)", word.lower())
    return Fraction(match[1]) * Fraction(10) ** SUFFIX.get(match[2], 0)


def zeros(rows, columns):
    return [[Fraction(0)] * columns for _ in range(rows)]


def product(a, b):
    return [[sum((a[i][k] * b[k][j] for k in range(len(b))), Fraction(0))
             for j in range(len(b[0]) if b else 0)] for i in range(len(a))]


def transposed(a):
    return [list(column) for column in zip(*a)]


def added(a, b, factor=1):
    return [[x + factor * y for x, y in zip(p, q)] for p, q in zip(a, b)]


def solved(a, b):
    """a^-1 b; ValueError where a is singular."""
    n = len(a)
    rows = [list(a[i]) + list(b[i]) for i in range(n)]
    for k in range(n):
        pivot = next((i for i in range(k, n) if rows[i][k] != 0), None)
        if pivot is None:
            raise ValueError("singular")
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(n):
            if i != k and rows[i][k] != 0:
                rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k])]
    return [row[n:] for row in rows]


def is_positive(a, slack):
    """Is a + diag(slack) positive definite? In rational numbers, so without a tolerance of its own."""
    n = len(a)
    rows = [[a[i][j] + (slack[i] if i == j else 0) for j in range(n)] for i in range(n)]
    for k in range(n):
        if rows[k][k] <= 0:
            return False
        for i in range(k + 1, n):
            factor = rows[i][k] / rows[k][k]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k])]
    return True


class System:
    """The blocks of (2.1); `ordinary`: written with these cards and matrices alone."""

    def __init__(self, text):
        self.states, self.unknowns, self.pairs, matrices, parameters = [], [], [], {}, {}
        self.ordinary, current = True, None
        for line in text.splitlines()[1:]:
            words = line.split()
            if not words or line.startswith("*"):
                continue
            card = words[0].lower()
            if card == "+":
                current.append([number(word, parameters) for word in words[1:]])
            elif card == "matrix":
                current = matrices.setdefault(ALIAS.get(words[1], words[1]), [])
            elif card == ".param":
                name, value = words[1].split("=")
                parameters[name] = number(value, {})
            elif card in ("state", "unknown", "pair"):
                {"state": self.states, "unknown": self.unknowns, "pair": self.pairs}[card].append(
                    words[1].lower())
            elif card not in ("input", ".tran", ".end"):
                self.ordinary = False
        n, p, m = len(self.states), len(self.unknowns), len(self.pairs)
        self.ordinary = self.ordinary and "F" not in matrices
        shape = {"A_I": (n, n), "B_I": (n, p), "Bbar_I": (n, m), "A_II": (p, n), "B_II": (p, p),
                 "Bbar_II": (p, m), "C_I": (m, n), "C_II": (m, p), "D": (m, m)}
        self.matrix = {name: matrices.get(name, zeros(*size)) for name, size in shape.items()}
        self.P = matrices.get("P", [[Fraction(i == j) for j in range(n)] for i in range(n)])

    def quadruple(self):
        """(A, B, C, D) over (states, pairs); None where B_II is singular."""
        m = self.matrix
        top, bottom = [m["A_I"], m["Bbar_I"]], [m["C_I"], m["D"]]
        if self.unknowns:
            try:
                z = [solved(m["B_II"], m["A_II"]), solved(m["B_II"], m["Bbar_II"])]
            except ValueError:
                return None
            top = [added(a, product(m["B_I"], b), -1) for a, b in zip(top, z)]
            bottom = [added(a, product(m["C_II"], b), -1) for a, b in zip(bottom, z)]
        return (*(solved(self.P, a) for a in top), *bottom)

    def model(self):
        """(B_II, Bbar_II, C_II, D)."""
        return tuple(self.matrix[name] for name in ("B_II", "Bbar_II", "C_II", "D"))
