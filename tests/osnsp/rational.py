"""A one-step problem from a system file, in rational numbers: has it a solution? If not, weights of its own equations
say so (J. Farkas, J. reine angew. Math. 124, 1902), and are looked at apart from how they were found."""

from fractions import Fraction


class Problem:
    """(sigma P - A) y = sigma P x_k + E s,  w = C y + F s, over the columns y = (x, z, lambda)."""

    def __init__(self, path):
        self.load(path)
        n_x, n_z, self.n_pairs, _, _ = self.size
        self.n = n_x + n_z
        n_columns = self.n + self.n_pairs
        self.rows = [{} for _ in range(self.n)]
        self.right = [Fraction(0)] * self.n
        for r, c, v in self.matrix["P"] if self.sigma else []:
            self.put(self.rows[r], c, self.sigma * v)
            self.right[r] += self.sigma * v * self.u[c]
        for r, c, v in self.matrix["A"]:
            self.put(self.rows[r], c, -v)
        for r, c, v in self.matrix["E"]:
            self.right[r] += v * self.u[n_x + c]
        self.w_rows = [{} for _ in range(self.n_pairs)]
        self.w_right = [Fraction(0)] * self.n_pairs
        for r, c, v in self.matrix["C"]:
            self.put(self.w_rows[r], c, v)
        for r, c, v in self.matrix["F"]:
            self.w_right[r] += v * self.u[n_x + c]
        for c in self.references:
            self.rows.append({c: Fraction(1)})
            self.right.append(Fraction(0))
        self.n_columns = n_columns

    @staticmethod
    def put(row, column, value):
        row[column] = row.get(column, 0) + value
        if row[column] == 0:
            del row[column]

    def load(self, path):
        with open(path, encoding="utf-8") as file:
            lines = iter(file.read().split("\n"))
        self.matrix, self.u, self.mode, self.is_diode, self.references = {}, [], [], [], []
        n_columns = 0
        for line in lines:
            words = line.split()
            if not words:
                continue
            if words[0] == "size":
                self.size = [int(word) for word in words[1:]]
            elif words[0] == "column":
                if words[1] == "reference":  # of an island: it must carry nothing
                    self.references.append(n_columns)
                n_columns += 1
            elif words[0] == "pair":
                self.is_diode.append(words[1] == "diode")
            elif words[0] == "matrix":
                entries = [next(lines).split() for _ in range(int(words[2]))]
                self.matrix[words[1]] = [(int(r), int(c), Fraction(float(v))) for r, c, v in entries]
            elif words[0] == "sigma":
                self.sigma = Fraction(float(words[1]))
            elif words[0] == "u":
                self.u.append(Fraction(float(words[1])))
            elif words[0] == "mode":
                self.mode.append(words[1] == "1")

    def equations(self):
        """[row], [right] over (x, z, lambda, w)."""
        rows = [dict(row) for row in self.rows]
        right = list(self.right)
        for d, row in enumerate(self.w_rows):
            rows.append({**row, self.n_columns + d: Fraction(-1)})
            right.append(-self.w_right[d])
        return rows, right

    def reduced(self):
        """Rows over (lambda, w) alone that say all of what the circuit says of the pairs: [(row, right)], lambda_d
        in column d and w_d in column n_pairs + d. Column -1 - i says how often equation i is in a row."""
        rows, right = self.equations()
        left = set(range(len(rows)))
        users = {}
        for i, row in enumerate(rows):
            for c in row:
                users.setdefault(c, set()).add(i)
            row[-1 - i] = Fraction(1)
        for _ in range(len(rows)):
            choice = [(len(rows[i]), len(users[c]), i, c) for i in left for c in rows[i] if 0 <= c < self.n]
            if not choice:
                break
            _, _, i, c = min(choice)
            left.discard(i)
            for j in [j for j in users[c] if j in left]:
                factor = rows[j][c] / rows[i][c]
                for k, v in rows[i].items():
                    self.put(rows[j], k, -factor * v)
                    users.setdefault(k, set()).add(j)
                    if k not in rows[j]:
                        users[k].discard(j)
                right[j] -= factor * right[i]
        return [({c - self.n if c >= 0 else c: v for c, v in rows[i].items()}, right[i]) for i in sorted(left)]

    def witness(self):
        """None: it has a solution, if it is passive, for then its linear programme is solvable where it is feasible
        (Cottle, Pang and Stone 1992, thm 3.1.2). Else weights of the equations that refute it, {equation: weight}."""
        table = []
        n = self.n_pairs
        for row, right in self.reduced():
            line = {}
            for c, v in row.items():
                if c < 0 or self.is_diode[c % n]:
                    line[c] = v
                elif (c < n) == self.mode[c % n]:  # lambda of a closed switch, w of an open one: free
                    line[c] = v
                    line[c + 2 * n] = -v
            table.append((line, right))
        marks = refutation(table)
        return None if marks is None else {-1 - c: v for c, v in marks.items()}

    def is_refuted_by(self, weights):
        """Do these weights sum up the equations to something negative, or 0, that has to be positive?"""
        rows, rights = self.equations()
        total, right = {}, Fraction(0)
        for i, weight in weights.items():
            right += weight * rights[i]
            for c, v in rows[i].items():
                self.put(total, c, weight * v)
        return right > 0 and all(self.may_be(c, v) for c, v in total.items())

    def may_be(self, column, value):
        """Is a multiple of the column never positive?"""
        if column < self.n:
            return value == 0
        is_current, pair = column < self.n_columns, (column - self.n) % self.n_pairs
        if self.is_diode[pair]:
            return value <= 0
        return value == 0 or is_current != self.mode[pair]  # current of an open switch, voltage of a closed one


def refutation(table):
    """Is there q >= 0 with these rows: [({column: value}, right)]? By phase one of the simplex method with Bland's
    rule. None: there is. Else the entries in columns below 0 of the sum of the rows that cannot be met."""
    rows = []
    for line, right in table:
        sign = -1 if right < 0 else 1
        rows.append([{c: sign * v for c, v in line.items()}, sign * right, None])
    while True:
        cost = {}
        for line, _, basic in rows:
            if basic is None:
                for c, v in line.items():
                    cost[c] = cost.get(c, 0) + v
        entering = min((c for c, v in cost.items() if v > 0 and c >= 0), default=None)
        if entering is None:
            is_met = all(right == 0 for _, right, basic in rows if basic is None)
            return None if is_met else {c: v for c, v in cost.items() if c < 0}
        _, _, best = min((right / line[entering], basic if basic is not None else -1, i)
                         for i, (line, right, basic) in enumerate(rows) if line.get(entering, 0) > 0)
        line, right, _ = rows[best]
        pivot = line[entering]
        line = {c: v / pivot for c, v in line.items()}
        right /= pivot
        rows[best] = [line, right, entering]
        for i, other in enumerate(rows):
            factor = other[0].get(entering, 0)
            if i != best and factor != 0:
                for c, v in line.items():
                    Problem.put(other[0], c, -factor * v)
                other[1] -= factor * right
