"""The response of a switched circuit around an orbit by matrix exponentials: another way than the program's.

The circuit is a list of elements. In a mode, closed switches and conducting diodes are branches, open ones nothing;
capacitors are voltage sources and coils current sources of what they store, so that
    P x' = U z,   0 = B x + K z + F e(t) + f s(t)
with node voltages and branch currents z, the sources' functions e of time and the small signal s. With N and R the
left and right null spaces of K and G = N'B, a state that the mode does not allow is projected by
    1 - P^-1 U R (G P^-1 U R)^-1 G,
and what K leaves open follows from N'(B x' + F e' + f s') = 0. The times of events and the states at the start are
those that the program reports; that they are an orbit is checked here.
"""

import cmath
import math


# ---- Matrices: lists of rows ---------------------------------------------------------------------------

def zeros(n, m):
    return [[0.0] * m for _ in range(n)]


def eye(n):
    return [[1.0 if i == j else 0.0 for j in range(n)] for i in range(n)]


def mul(a, b):
    columns = list(zip(*b)) if b else []
    if not columns:
        return [[] for _ in a]
    return [[sum(x * y for x, y in zip(row, column) if x) for column in columns] for row in a]


def add(a, b, factor=1.0):
    return [[x + factor * y for x, y in zip(r, s)] for r, s in zip(a, b)]


def transpose(a, n):
    return [list(c) for c in zip(*a)] if a else [[] for _ in range(n)]


def eliminate(matrix, right):
    """Full pivoting: (rank, a solution of matrix z = right where there is one, right null space, left null space)."""
    n, m, k = len(matrix), len(matrix[0]) if matrix else 0, len(right[0]) if right else 0
    a = [list(row) + list(r) + [1.0 if i == j else 0.0 for j in range(n)]
         for i, (row, r) in enumerate(zip(matrix, right))]
    order = list(range(m))
    rank = 0
    largest = max((abs(x) for row in matrix for x in row), default=0.0)
    while rank < min(n, m):
        size, p, q = max((abs(a[i][order[j]]), i, j) for i in range(rank, n) for j in range(rank, m))
        if size <= 1e-11 * largest:
            break
        a[rank], a[p] = a[p], a[rank]
        order[rank], order[q] = order[q], order[rank]
        pivot = a[rank][order[rank]]
        a[rank] = [x / pivot for x in a[rank]]
        for i in range(n):
            factor = a[i][order[rank]]
            if i != rank and factor != 0:
                a[i] = [x - factor * y for x, y in zip(a[i], a[rank])]
        rank += 1
    z = zeros(m, k)
    for i in range(rank):
        z[order[i]] = a[i][m:m + k]
    null = zeros(m, m - rank)
    for c in range(rank, m):
        null[order[c]][c - rank] = 1.0
        for i in range(rank):
            null[order[i]][c - rank] = -a[i][order[c]]
    return rank, z, null, [a[i][m + k:] for i in range(rank, n)]


def solve(matrix, right):
    rank, z, _, _ = eliminate(matrix, right)
    assert rank == len(matrix), "singular"
    return z


def exponential(a):
    n = len(a)
    size = max((sum(abs(x) for x in row) for row in a), default=0.0)
    halvings = max(0, math.frexp(size)[1] + 2)
    a = [[x * 0.5 ** halvings for x in row] for row in a]
    result, term = eye(n), eye(n)
    for k in range(1, 15):
        term = [[x / k for x in row] for row in mul(term, a)]
        result = add(result, term)
    for _ in range(halvings):
        result = mul(result, result)
    return result


# ---- Circuits ------------------------------------------------------------------------------------------

class Circuit:
    """elements: (name, kind, nodes, value), kind of R L C V I G D S; value of V and I: {function: factor}, the functions
    1, and cos and sin of omega t; ac: the name of the source with the small signal; couplings: (coil, coil, k)."""

    def __init__(self, elements, ac=None, omega=0.0, couplings=()):
        self.elements, self.ac, self.omega = elements, ac, omega
        self.nodes = sorted({n for e in elements for n in e[2]} - {"0"})
        self.states = [e[0] for e in elements if e[1] in "LC"]
        n = len(self.states)
        self.P = zeros(n, n)
        value = {e[0]: e[3] for e in elements if e[1] in "LC"}
        for i, name in enumerate(self.states):
            self.P[i][i] = value[name]
        for one, other, k in couplings:
            i, j = self.states.index(one), self.states.index(other)
            self.P[i][j] = self.P[j][i] = k * math.sqrt(value[one] * value[other])
        self.modes = {}

    def mode(self, on):
        if on not in self.modes:
            self.modes[on] = Mode(self, on)
        return self.modes[on]

    def functions(self, t):
        return [1.0, math.cos(self.omega * t), math.sin(self.omega * t)]

    def rates(self, t):
        return [0.0, -self.omega * math.sin(self.omega * t), self.omega * math.cos(self.omega * t)]


class Mode:
    """x' = A x + E e + b s + c s',  z = Zx x + Ze e + Zs s + Zr s'; jump: x+ = J x- + Je e + Js s."""

    def __init__(self, circuit, on):
        self.circuit = circuit
        self.branch = [e[0] for e in circuit.elements
                       if e[1] in "VC" or (e[1] in "DS" and e[0] in on)]
        self.column = {name: len(circuit.nodes) + k for k, name in enumerate(self.branch)}
        self.column.update({node: k for k, node in enumerate(circuit.nodes)})
        self.n_z = len(circuit.nodes) + len(self.branch)
        self.stamp(on)
        self.reduce()

    def stamp(self, on):
        c = self.circuit
        n_x, n_z = len(c.states), self.n_z
        self.K, self.B, self.F = zeros(n_z, n_z), zeros(n_z, n_x), zeros(n_z, 4)
        self.U = zeros(n_x, n_z)
        for name, kind, nodes, value in c.elements:
            at = [self.column[n] if n != "0" else None for n in nodes]
            signed = [(p, s) for p, s in zip(at, (1.0, -1.0)) if p is not None]
            if kind == "R":
                for p, s in signed:
                    for q, r in signed:
                        self.K[p][q] += s * r / value
            elif name in self.column:  # V, C, and what conducts: its own row, v = what it is
                own = self.column[name]
                for p, s in signed:
                    self.K[p][own] += s
                    self.K[own][p] += s
                if kind == "C":
                    self.B[own][c.states.index(name)] = -1.0
                    self.U[c.states.index(name)][own] = 1.0
                elif kind == "V":
                    self.drive(own, value, -1.0, name)
                else:
                    self.K[own][own] -= value
            elif kind == "L":
                for p, s in signed:
                    self.B[p][c.states.index(name)] += s
                    self.U[c.states.index(name)][p] += s
            elif kind == "G":
                for p, s in signed:
                    for q, r in zip(at[2:], (1.0, -1.0)):
                        if q is not None:
                            self.K[p][q] += s * r * value
            elif kind == "I":
                for p, s in signed:
                    self.drive(p, value, s, name)
        self.on = on

    def drive(self, row, value, sign, name):
        for k in range(3):
            self.F[row][k] += sign * value.get(("1", "cos", "sin")[k], 0.0)
        self.F[row][3] += sign if name == self.circuit.ac else 0.0

    def reduce(self):
        n_x = len(self.circuit.states)
        right = [[-x for x in b + f] for b, f in zip(self.B, self.F)]
        _, z, R, N = eliminate(self.K, right)
        PU = solve(self.circuit.P, self.U) if n_x else []
        G, H = mul(N, self.B) if N else [], mul(N, self.F) if N else []
        Q = mul(PU, R) if R and R[0] else None
        rate = mul(PU, z)  # by x, e, s
        self.J, self.Jd = eye(n_x), zeros(n_x, 4)
        by_rate = zeros(self.n_z, 4)
        if G and Q:
            W = mul(G, Q)
            keep = solve_least(W, [g + h for g, h in zip(G, H)])
            back = mul(Q, keep)
            self.J = add(self.J, [row[:n_x] for row in back], -1.0)
            self.Jd = [[-x for x in row[n_x:]] for row in back]
            free = solve_least(W, [a + b for a, b in zip(mul(G, rate), H)])
            z = add(z, mul(R, [row[:n_x + 4] for row in free]), -1.0)
            by_rate = [[-x for x in row] for row in mul(R, [row[n_x + 4:] for row in free])]
        self.z, self.z_rate = z, by_rate
        self.f, self.f_rate = mul(PU, z), mul(PU, by_rate)

    def row(self, name):
        """Of a node, of a branch, of the voltage across a pair that is open, or of a state: (by x, by e and s, by
        e' and s')."""
        c = self.circuit
        if name in self.column:
            k = self.column[name]
            n = len(c.states)
            return self.z[k][:n], self.z[k][n:], self.z_rate[k]
        if name in c.states:
            k = c.states.index(name)
            return [1.0 if i == k else 0.0 for i in range(len(c.states))], [0.0] * 4, [0.0] * 4
        element = next(e for e in c.elements if e[0] == name)
        one, other = (self.row(n) if n != "0" else None for n in element[2])
        zero = ([0.0] * len(c.states), [0.0] * 4, [0.0] * 4)
        return tuple([a - b for a, b in zip(p, q)] for p, q in zip(one or zero, other or zero))

    def derivative(self, x, t):
        c = self.circuit
        given = list(x) + c.functions(t) + [0.0]
        rates = c.rates(t) + [0.0]
        return [dot(f, given) + dot(g, rates) for f, g in zip(self.f, self.f_rate)]

    def value(self, name, x, t):
        by_x, by_e, by_rate = self.row(name)
        c = self.circuit
        return dot(by_x, x) + dot(by_e, c.functions(t)) + dot(by_rate, c.rates(t))

    def rate(self, name, x, t):
        """The derivative by time of a quantity along the orbit."""
        by_x, by_e, by_rate = self.row(name)
        c = self.circuit
        second = [-c.omega ** 2 * v if k else 0.0 for k, v in enumerate(c.functions(t))]
        return dot(by_x, self.derivative(x, t)) + dot(by_e, c.rates(t)) + dot(by_rate, second)

    def flow(self, x, t, h):
        """x after h, with the functions of time as states."""
        n, w = len(x), self.circuit.omega
        a = zeros(n + 3, n + 3)
        a[n + 1][n + 2], a[n + 2][n + 1] = -w, w
        for i in range(n):
            rates = self.f_rate[i]
            a[i][:n] = self.f[i][:n]
            a[i][n:] = [self.f[i][n], self.f[i][n + 1] + w * rates[2], self.f[i][n + 2] - w * rates[1]]
        whole = exponential([[v * h for v in row] for row in a])
        return [dot(row, list(x) + self.circuit.functions(t)) for row in whole[:n]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def solve_least(w, right):
    """Where K leaves more open than states decide, any answer will do for what is determined."""
    _, z, _, _ = eliminate(w, right)
    return z


# ---- Responses -----------------------------------------------------------------------------------------

class Orbit:
    """events: (time, mode behind, what ends the mode before): None, ("ramp", slope by time of what the small signal is
    compared with), or ("guard", name, slope, by): the quantity of that name, plus a ramp, minus `by` of the signal."""

    def __init__(self, circuit, period, start, first, events):
        self.circuit, self.period = circuit, period
        self.spans = []
        mode, t, x = circuit.mode(first), 0.0, list(start)
        x = jump(mode, x, t)
        for time, behind, why in events + [(period, None, None)]:
            end = mode.flow(x, t, time - t)
            self.spans.append([mode, t, time, x, end, why, None, None])
            if behind is not None:
                mode, t, x = circuit.mode(behind), time, jump(circuit.mode(behind), end, time)
                self.spans[-1][6:] = [mode, x]
        self.end = self.spans[-1][4]
        self.turning, self.beside = [], 0.0

    def misses(self, start):
        """By how much it does not come back, over the size of the states of a kind."""
        c = self.circuit
        off = 0.0
        for kind in "LC":
            mine = [k for k, name in enumerate(c.states)
                    if next(e for e in c.elements if e[0] == name)[1] == kind]
            size = max((abs(s[3][k]) for s in self.spans for k in mine), default=1.0)
            off = max([off] + [abs(self.end[k] - start[k]) / size for k in mine])
        return off

    def response(self, frequency, outputs, sideband=0):
        """{name: component at the frequency, or so many of the orbit's higher} of a small signal of 1."""
        w, n = 2 * math.pi * frequency, len(self.circuit.states)
        self.beside = 2 * math.pi * sideband / self.period
        self.turning = [turning(span[0], w, self.beside, span[2] - span[1]) for span in self.spans]
        columns = [self.through([1.0 if i == k else 0.0 for i in range(n)], w, 0.0, ()) for k in range(n)]
        driven = self.through([0.0] * n, w, 1.0, ())
        turn = cmath.exp(1j * w * self.period)
        a = [[(turn if i == k else 0.0) - columns[k][0][i] for k in range(n)] for i in range(n)]
        d = [row[0] for row in solve(a, [[v] for v in driven[0]])] if n else []
        return self.through(d, w, 1.0, outputs)[1]

    def through(self, d, w, s, outputs):
        mean = {name: 0.0 for name in outputs}
        first = self.spans[0]
        d = jump_small(first[0], d, s)
        for (mode, t, end, _, x_end, why, behind, x_behind), whole in zip(self.spans, self.turning):
            d, integral = small_flow(whole, d, w, self.beside, s, t, end - t)
            phase = s * cmath.exp(1j * w * end)
            for name in outputs:
                by_x, by_e, by_rate = mode.row(name)
                mean[name] += (dot(by_x, integral) + (by_e[3] + 1j * w * by_rate[3]) * integral[-1]) / self.period
            if behind is None:
                continue
            dt = self.moves(mode, d, x_end, end, phase, w, why)
            if dt:
                f, g = mode.derivative(x_end, end), behind.derivative(x_behind, end)
                d = [v + (p - q) * dt for v, p, q in zip(d, f, g)]
                # the projection of f- dt is that of the jump; f+ of the mode behind is allowed in it
                for name in outputs:
                    gap = mode.value(name, x_end, end) - behind.value(name, x_behind, end)
                    mean[name] += gap * dt * cmath.exp(-1j * (w + self.beside) * end) / self.period
            d = jump_small(behind, d, phase)
        return d, mean

    @staticmethod
    def moves(mode, d, x, t, phase, w, why):
        if why is None:
            return 0.0
        if why[0] == "ramp":
            return phase / why[1]
        _, name, slope, by = why
        by_x, by_e, by_rate = mode.row(name)
        change = dot(by_x, d) + (by_e[3] + 1j * w * by_rate[3]) * phase - by * phase
        return -change / (mode.rate(name, x, t) + slope)


def jump(mode, x, t):
    e = mode.circuit.functions(t)
    return [dot(j, x) + dot(b[:3], e) for j, b in zip(mode.J, mode.Jd)]


def jump_small(mode, d, s):
    return [dot(j, d) + b[3] * s for j, b in zip(mode.J, mode.Jd)]


def turning(mode, w, beside, h):
    """The exponential of d' = A d + b s exp(j w t), of d that turns with w + beside and s with beside, and of both's
    integrals."""
    n = len(mode.circuit.states)
    a = [[0.0] * (2 * n + 2) for _ in range(2 * n + 2)]
    for i in range(n):
        for k in range(n):
            a[i][k] = (mode.f[i][k] - (1j * (w + beside) if i == k else 0.0)) * h
        a[i][n] = (mode.f[i][n + 3] + 1j * w * mode.f_rate[i][3]) * h
    a[n][n] = -1j * beside * h
    for i in range(n + 1):
        a[n + 1 + i][i] = h
    return exponential(a)


def small_flow(whole, d, w, beside, s, t, h):
    """d after h, and the integrals of exp(-j (w + beside) t) times d and times the signal."""
    n = len(d)
    start = [v * cmath.exp(-1j * (w + beside) * t) for v in d] + [s * cmath.exp(-1j * beside * t)]
    after = [dot(row, start + [0.0] * (n + 1)) for row in whole]
    return [v * cmath.exp(1j * (w + beside) * (t + h)) for v in after[:n]], after[n + 1:]
