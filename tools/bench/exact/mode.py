"""One mode of a circuit as an ordinary differential equation, whatever its index.

E x' = A x has solutions in a subspace only, x = V y with y' = F y. With K = (A - s E)^-1 E the
subspace is the range of K^k, k the index, and K V = V M gives F = 1/M + s. A state that is not in
it jumps along the null space of K^k, which is the limit of small steps of implicit Euler."""

from matrices import D, ONE, RANK, ZERO, Singular, column_basis, solve, times, times_vector


class Mode:
    def __init__(self, e, a, unit, least=RANK):
        """`unit`: a time of the order of what happens, s; `least`: see solve."""
        n = len(e)
        shift = ONE / unit
        self.shifted = [[a[i][j] - shift * e[i][j] for j in range(n)] for i in range(n)]
        self.least = least
        k_matrix = solve(self.shifted, e, least)
        v, rows = column_basis(k_matrix)
        self.index = 1
        while True:
            image = times(k_matrix, v)
            smaller, smaller_rows = column_basis(image)
            if len(smaller_rows) == len(rows):
                break
            v, rows = smaller, smaller_rows
            self.index += 1
        self.k_matrix, self.v, self.rows = k_matrix, v, rows
        self.m = [image[r] for r in rows]
        n_states = len(rows)
        identity = [[ONE if i == j else ZERO for j in range(n_states)] for i in range(n_states)]
        self.f = solve(self.m, identity)
        for k in range(n_states):
            self.f[k][k] += shift
        self.fastest = spectral_size(self.f)

    def project(self, storage):
        """y of a state given by E x, jumped into the mode where it does not fit."""
        # K x = (A - sE)^-1 E x needs E x only.
        x = [row[0] for row in solve(self.shifted, [[value] for value in storage], self.least)]
        for _ in range(self.index - 1):
            x = times_vector(self.k_matrix, x)
        y = [[x[r]] for r in self.rows]
        for _ in range(self.index):
            y = solve(self.m, y)
        return [row[0] for row in y]

    def taylor(self, y, order):
        """Coefficients of y(t + tau) in powers of tau."""
        terms = [y]
        for k in range(1, order + 1):
            terms.append([value / k for value in times_vector(self.f, terms[-1])])
        return terms


def spectral_size(f):
    """About the spectral radius, from the 32nd power."""
    power, exponent = f, 1
    for _ in range(5):
        power, exponent = times(power, power), 2 * exponent
    largest = max((abs(value) for row in power for value in row), default=ZERO)
    return largest ** (D(1) / exponent) if largest else ZERO


__all__ = ["Mode", "Singular"]
