"""All answers of a small resistive network of ideal diodes, by brute force in rational numbers.

Every mode is tried: in it the network is a set of linear equations, what they leave is a polyhedron, and
its corners and rays bound each quantity. Nothing is shared with the program: no graph, no convexity."""

import itertools
from fractions import Fraction

INFINITY = float("inf")


def reduce_rows(rows, n_columns):
    """Reduced row echelon form in place. Returns the pivot columns among the first n_columns."""
    pivots = []
    for column in range(n_columns):
        rank = len(pivots)
        best = next((k for k in range(rank, len(rows)) if rows[k][column] != 0), None)
        if best is None:
            continue
        rows[rank], rows[best] = rows[best], rows[rank]
        pivot = rows[rank][column]
        rows[rank] = [value / pivot for value in rows[rank]]
        for k, row in enumerate(rows):
            if k != rank and row[column] != 0:
                factor = row[column]
                rows[k] = [a - factor * b for a, b in zip(row, rows[rank])]
        pivots.append(column)
    return pivots


def solve(equations, n):
    """equations [a_0, ..., a_(n-1), b] with a.x = b. Returns (point, directions), None if there is none."""
    rows = [list(row) for row in equations]
    pivots = reduce_rows(rows, n)
    if any(row[n] != 0 for row in rows[len(pivots):]):
        return None
    point = [Fraction(0)] * n
    for k, column in enumerate(pivots):
        point[column] = rows[k][n]
    directions = []
    for free in (c for c in range(n) if c not in pivots):
        direction = [Fraction(0)] * n
        direction[free] = Fraction(1)
        for k, column in enumerate(pivots):
            direction[column] = -rows[k][free]
        directions.append(direction)
    return point, directions


def dot(a, b):
    return sum((x * y for x, y in zip(a, b) if x != 0 and y != 0), Fraction(0))


class Network:
    """Elements: ("r", a, b, ohm), ("v", a, b, volt), ("i", a, b, ampere), ("d", a, b, (vfwd, ron)),
    ("c", a, b, _), open, ("l", a, b, _), a short. Node 0 is ground."""

    def __init__(self, n_nodes, elements):
        self.n_nodes = n_nodes
        self.elements = elements
        self.diodes = [k for k, e in enumerate(elements) if e[0] == "d"]
        carriers = [k for k, e in enumerate(elements) if e[0] in "vld"]
        self.current = {k: n_nodes - 1 + j for j, k in enumerate(carriers)}
        self.n = n_nodes - 1 + len(carriers)

    def voltage(self, a, b):
        """v(a) - v(b) as a row of coefficients and a constant."""
        row = [Fraction(0)] * (self.n + 1)
        for node, sign in ((a, 1), (b, -1)):
            if node > 0:
                row[node - 1] += sign
        return row

    def reverse_voltage(self, k):
        _, a, b, (vfwd, ron) = self.elements[k]
        row = self.voltage(b, a)
        row[self.current[k]] += ron
        row[self.n] += vfwd
        return row

    def forward_current(self, k):
        row = [Fraction(0)] * (self.n + 1)
        row[self.current[k]] = Fraction(1)
        return row

    def equations(self):
        kcl = [[Fraction(0)] * (self.n + 1) for _ in range(self.n_nodes)]
        rows = []
        for k, (kind, a, b, value) in enumerate(self.elements):
            for node, sign in ((a, 1), (b, -1)):
                if kind == "r":
                    through = [x / value for x in self.voltage(a, b)]
                    kcl[node] = [x + sign * y for x, y in zip(kcl[node], through)]
                elif kind == "i":
                    kcl[node][self.n] -= sign * value
                elif kind != "c":
                    kcl[node][self.current[k]] += sign
            if kind in "vl":
                row = self.voltage(a, b)
                row[self.n] = value if kind == "v" else Fraction(0)
                rows.append(row)
        return rows + kcl[1:]

    def answers(self, quantities):
        """quantities: rows of n coefficients. Returns None where there is no answer, else the interval
        of each quantity, and the currents and reverse voltages of the diodes where the norm of currents
        and voltages is least: reverse voltages count from where a diode has none, not from its knee."""
        common = solve(self.equations(), self.n)
        if common is None:
            return None
        start, basis = common

        def restrict(row, constant):
            """A function of all unknowns, as one of the coordinates along the basis."""
            return [dot(row[:self.n], d) for d in basis], dot(row[:self.n], start) + constant

        pairs, voltages = [], []
        for k in self.diodes:
            w = self.reverse_voltage(k)
            current = self.forward_current(k)
            pairs.append((restrict(current, Fraction(0)), restrict(w, w[self.n])))
            voltages.append(restrict(w, Fraction(0)))
        values = [restrict(q + [Fraction(0)], Fraction(0)) for q in quantities]
        bounds = [[INFINITY, -INFINITY] for _ in quantities]
        best = None
        for mode in itertools.product((False, True), repeat=len(pairs)):
            zero = [pair[1 if on else 0] for pair, on in zip(pairs, mode)]
            positive = [pair[0 if on else 1] for pair, on in zip(pairs, mode)]
            polyhedron = Polyhedron(len(basis), zero, positive)
            if not polyhedron.is_empty():
                polyhedron.widen(values, bounds)
                found = polyhedron.least([p[0] for p in pairs] + voltages,
                                         INFINITY if best is None else best[0])
                if found is not None:
                    best = (found[0], [at(p[0], found[1]) for p in pairs],
                            [at(p[1], found[1]) for p in pairs])
        return None if best is None else (bounds, best[1], best[2])


def at(function, point):
    return dot(function[0], point) + function[1]


class Polyhedron:
    """Points where the functions `zero` vanish and `positive` are none below 0."""

    def __init__(self, n, zero, positive):
        self.zero = [list(f[0]) + [-f[1]] for f in zero]
        self.n = n
        self.space = solve(self.zero, n)
        self.corners, self.rays, self.lines = [], [], []
        if self.space is not None:
            self.find(positive)

    def inside(self, function):
        """A function in coordinates of the space that the equations leave."""
        point, directions = self.space
        return [dot(function[0], d) for d in directions], at(function, point)

    def outside(self, coordinates):
        point, directions = self.space
        return [p + sum(c * d[k] for c, d in zip(coordinates, directions))
                for k, p in enumerate(point)]

    def find(self, positive):
        k = len(self.space[1])
        self.walls = [self.inside(f) for f in positive]
        if any(all(a == 0 for a in row) and constant < 0 for row, constant in self.walls):
            return
        walls = [(row, constant) for row, constant in self.walls if any(a != 0 for a in row)]
        rows = [list(row) + [Fraction(0)] for row, _ in walls]
        self.lines = solve(rows, k)[1]
        # across the lines the rest has corners
        across = [line + [Fraction(0)] for line in self.lines]
        rank = k - len(self.lines)
        for chosen in itertools.combinations(walls, rank):
            meet = solve([row + [-constant] for row, constant in chosen] + across, k)
            if meet is not None and not meet[1] and all(at(w, meet[0]) >= 0 for w in walls):
                self.corners.append(meet[0])
        for chosen in itertools.combinations(walls, rank - 1) if rank > 0 else ():
            meet = solve([row + [Fraction(0)] for row, _ in chosen] + across, k)
            if len(meet[1]) == 1:
                for sign in (1, -1):
                    ray = [sign * x for x in meet[1][0]]
                    if all(dot(row, ray) >= 0 for row, _ in walls):
                        self.rays.append(ray)

    def is_empty(self):
        return not self.corners

    def widen(self, functions, bounds):
        for function, bound in zip(functions, bounds):
            row, constant = self.inside(function)
            for corner in self.corners:
                value = dot(row, corner) + constant
                bound[0], bound[1] = min(bound[0], value), max(bound[1], value)
            slopes = [dot(row, ray) for ray in self.rays]
            slopes += [sign * dot(row, line) for line in self.lines for sign in (1, -1)]
            bound[0] = -INFINITY if any(slope < 0 for slope in slopes) else bound[0]
            bound[1] = INFINITY if any(slope > 0 for slope in slopes) else bound[1]

    def least(self, functions, below):
        """The least sum of squares and a point that has it: on each set of walls in turn. None when it
        is not below `below`."""
        k = len(self.space[1])
        functions = [self.inside(f) for f in functions]
        best = None
        for size in range(min(k, len(self.walls)) + 1):
            for chosen in itertools.combinations(self.walls, size):
                held = solve([row + [-constant] for row, constant in chosen], k)
                if held is None:
                    continue
                norm, candidate = least_squares(functions, held)
                if norm < below and all(at(w, candidate) >= 0 for w in self.walls):
                    best, below = (norm, self.outside(candidate)), norm
                if size == 0 and (best is not None or norm >= below):
                    return best  # walls only make it larger
        return best


def least_squares(functions, held):
    """The least sum of squares on the plane (point, directions)."""
    point, directions = held
    slopes = [[dot(f[0], d) for f in functions] for d in directions]
    values = [at(f, point) for f in functions]
    normal = [[dot(a, b) for b in slopes] + [-dot(a, values)] for a in slopes]
    steps = solve(normal, len(directions))[0]
    for step, slope in zip(steps, slopes):
        values = [v + step * s for v, s in zip(values, slope)]
    candidate = [p + sum(s * d[j] for s, d in zip(steps, directions))
                 for j, p in enumerate(point)]
    return dot(values, values), candidate
