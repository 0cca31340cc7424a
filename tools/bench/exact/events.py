"""From event to event: the exact trajectory of a circuit with ideal diodes.

Between events the state is a Taylor polynomial of order 30; an event is where a diode's current or
reverse voltage comes to zero. Behind each event a micro-step of implicit Euler, a linear
complementarity problem, says which diodes conduct next."""

from matrices import D, ZERO, Singular, solve_vector, times, times_vector
from mode import Mode

ORDER = 30
SAMPLES = 16  # of each guard, in each step
NOTHING = D("1e-45")  # a sign below this part of the largest value is none
FLOATING = D("1e-70")  # a pivot as small as this is that of a part held by the leaks of network.py


class Failure(Exception):
    """The reference cannot follow this circuit."""


def polynomial(coefficients, tau):
    value = coefficients[-1] * 0
    for coefficient in reversed(coefficients):
        value = value * tau + coefficient
    return value


class Trajectory:
    def __init__(self, network, unit):
        self.network, self.unit = network, unit
        self.e, self.storage = network.storage()
        self.modes, self.guards = {}, {}
        self.events = []  # (time, element, on)

    def micro_step(self, on_diodes, closed, time):
        """The diodes that conduct at the end of a tiny step of implicit Euler."""
        length = self.unit * D("1e-10")
        n = self.network.n
        right = [-value / length for value in self.storage]
        on, tried = set(on_diodes), 0
        fewest, patience = len(self.network.diodes) + 1, 8
        while True:
            a = self.network.dynamics(on | closed, time, leak=True)
            x = solve_vector([[a[i][j] - self.e[i][j] / length if self.e[i][j] else a[i][j]
                               for j in range(n)] for i in range(n)], right, FLOATING)
            volts = max((abs(x[k]) for name, k in self.network.index.items() if name[0] == "v"),
                        default=ZERO)
            amperes = max((abs(x[k]) for name, k in self.network.index.items() if name[:2] == "i("),
                          default=ZERO)
            wrong = []
            for diode in self.network.diodes:
                value = sum(g * v for g, v in zip(self.network.guard(diode, on), x) if g)
                if value < -NOTHING * (amperes if diode in on else volts):
                    wrong.append(diode)
            if not wrong:
                return on
            if len(wrong) < fewest:
                fewest, patience = len(wrong), 8
            else:
                patience -= 1
            on ^= set(wrong if patience > 0 else wrong[-1:])  # Murty's rule in the end
            tried += 1
            if tried > 2000:
                raise Failure(f"no mode at {float(time)!r} s")

    def mode(self, on, levels, time):
        key = (frozenset(on), levels)
        if key not in self.modes:
            try:
                made = Mode(self.e, self.network.dynamics(on, time), self.unit)
            except Singular:  # a part floats: held in the middle
                made = Mode(self.e, self.network.dynamics(on, time, leak=True), self.unit, FLOATING)
            rows = [self.network.guard(diode, on) for diode in self.network.diodes]
            self.modes[key] = made, times(rows, made.v), times(self.e, made.v)
        return self.modes[key]

    def settle(self, on_diodes, time):
        """Mode and state just behind `time`, through any jumps."""
        closed = self.network.closed_switches(time)
        levels = tuple(gate.level(time) for gate in self.network.gates.values())
        for _ in range(20):
            on_diodes = self.micro_step(on_diodes, closed, time)
            mode, guards, storage = self.mode(on_diodes | closed, levels, time)
            y = mode.project(self.storage)
            after = times_vector(storage, y)
            size = max(map(abs, self.storage))
            jumped = any(abs(p - q) > D("1e-20") * size for p, q in zip(after, self.storage))
            self.storage = after
            if not jumped:
                return on_diodes, mode, guards, storage, y
        raise Failure(f"jumps without end at {float(time)!r} s")

    def first_crossing(self, guards, terms, length):
        """(tau, diodes) of the first guard that becomes negative within the step; None if none."""
        found = None
        for diode, row in zip(self.network.diodes, guards):
            exact = [sum((g * c for g, c in zip(row, term) if g), ZERO) for term in terms]
            scaled = [float(c * length ** k) for k, c in enumerate(exact)]
            size = max(map(abs, scaled))
            if size < 1e-35:  # both 0, and what rounding leaves of it
                continue
            before = 0.0
            for k in range(1, SAMPLES + 1):
                here = k / SAMPLES
                if polynomial(scaled, here) < -1e-15 * size:
                    tau = self.refine(exact, before * length if before else ZERO,
                                      D(k) / SAMPLES * length)
                    if found is None or tau < found[0]:
                        found = tau, diode
                    break
                before = D(k) / SAMPLES
        return found

    @staticmethod
    def refine(coefficients, low, high):
        """The root between low (not negative) and high (negative): bisection, then Newton."""
        for _ in range(40):
            middle = (low + high) / 2
            if polynomial(coefficients, middle) < 0:
                high = middle
            else:
                low = middle
        slope = [k * c for k, c in enumerate(coefficients)][1:]
        root = (low + high) / 2
        for _ in range(5):
            derivative = polynomial(slope, root)
            if not derivative:
                break
            root -= polynomial(coefficients, root) / derivative
        return root if low - (high - low) <= root <= high + (high - low) else high

    def run(self, times_wanted, rows_wanted):
        """Rows of signals at ascending times; their signals as rows of x."""
        edges = self.network.edges() + [self.network.stop]
        wanted = list(times_wanted)
        table = []
        time, on_diodes, quick = ZERO, set(), 0
        on_diodes, mode, guards, storage, y = self.settle(on_diodes, time)
        while time < self.network.stop:
            length = min(self.unit, edges[0] - time)
            if mode.fastest:
                length = min(length, 1 / mode.fastest)
            terms = mode.taylor(y, ORDER)
            crossing = self.first_crossing(guards, terms, length)
            end = length if crossing is None else crossing[0]
            while wanted and wanted[0] <= time + end:
                at = polynomials(terms, wanted[0] - time)
                x = times_vector(mode.v, at)
                table.append([sum((s * v for s, v in zip(row, x) if s), ZERO)
                              for row in rows_wanted])
                wanted.pop(0)
            y = polynomials(terms, end)
            edge = crossing is None and time + length == edges[0]
            time = edges[0] if edge else time + end
            if edge:
                edges.pop(0)
            if time >= self.network.stop:
                break
            if edge or crossing is not None:
                before = set(on_diodes)
                self.storage = times_vector(storage, y)
                if crossing is not None:
                    on_diodes = on_diodes ^ {crossing[1]}
                on_diodes, mode, guards, storage, y = self.settle(on_diodes, time)
                self.events += [(time, diode, diode in on_diodes)
                                for diode in sorted(before ^ on_diodes)]
                if edge:
                    self.events.append((time, "edge", None))
                quick = quick + 1 if end < self.unit * D("1e-12") else 0
                if quick > 50:
                    raise Failure(f"events without end at {float(time)!r} s")
        return table


def polynomials(terms, tau):
    value = list(terms[-1])
    for term in reversed(terms[:-1]):
        value = [v * tau + c for v, c in zip(value, term)]
    return value
