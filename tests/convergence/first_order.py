#!/usr/bin/env python3
"""Measures the order of `--method euler` against closed forms.

usage: first_order.py PROGRAM CIRCUIT

Each circuit is run with six steps, each half the one before. The error is the largest difference
from the exact solution over the compared times and signals, each over its scale; the slope of
log(error) over log(step), fitted by least squares, must be 1.00 +- 0.05.
"""

import cmath
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import NETLISTS, Checker, run  # noqa: E402

SLOPE, SLOPE_TOLERANCE = 1.0, 0.05
LADDER = 6


class Circuit:
    """What to run and what is exact.

    exact(t) returns {signal: value}; scale gives each signal's unit of error; the coarsest step is
    stop/first_steps, and the compared times are the multiples of stop/points, or the stop time
    alone when points is 1.
    """

    def __init__(self, netlist, stop, exact, scale, first_steps, points):
        self.netlist, self.stop, self.exact, self.scale = netlist, stop, exact, scale
        self.first_steps, self.points = first_steps, points


def damped(a, b, c, d, u, x, t):
    """x(t) of x1' = a x1 + b x2 + u1, x2' = c x1 + d x2 + u2, for distinct eigenvalues."""
    determinant, trace = a * d - b * c, a + d
    rest = ((-d * u[0] + b * u[1]) / determinant, (c * u[0] - a * u[1]) / determinant)
    root = cmath.sqrt(trace * trace / 4 - determinant)
    first, second = trace / 2 + root, trace / 2 - root
    e1, e2 = cmath.exp(first * t), cmath.exp(second * t)
    one = (first * e2 - second * e1) / (first - second)   # exp(M t) = one I + many M
    many = (e1 - e2) / (first - second)
    y = (x[0] - rest[0], x[1] - rest[1])
    return (rest[0] + (one * y[0] + many * (a * y[0] + b * y[1])).real,
            rest[1] + (one * y[1] + many * (c * y[0] + d * y[1])).real)


def rc():
    netlist = """RC charged by a constant voltage
V1 in 0 1
R1 in out 1k
C1 out 0 1u
.tran 50u 5m uic
.end
"""
    return Circuit(netlist, 5e-3, lambda t: {"v(out)": 1 - math.exp(-t / 1e-3)}, {"v(out)": 1},
                   200, 50)


def rlc():
    netlist = """Free oscillation of a series RLC
C1 1 0 1u IC=10
R1 1 2 20
L1 2 0 10m
.tran 20u 2m uic
.end
"""
    def exact(t):
        v, i = damped(0, -1 / 1e-6, 1 / 10e-3, -20 / 10e-3, (0, 0), (10, 0), t)
        return {"v(1)": v, "i(l1)": i}
    return Circuit(netlist, 2e-3, exact, {"v(1)": 10, "i(l1)": 0.1}, 8000, 100)


def lc_bridge():
    def exact(t):
        v, i = damped(-1 / 1e-3, -1 / 1e-6, 1 / 10e-3, 0, (0, 0), (10, 0), t)
        return {"v(1)": v, "i(l1)": i, "v(2,3)": abs(v)}
    return Circuit(NETLISTS / "tanks" / "lc_bridge.cir", 5e-3, exact,
                   {"v(1)": 10, "i(l1)": 0.1, "v(2,3)": 10}, 25000, 100)


def charge_then_decay():
    def exact(t):
        v = 4 * math.exp(-t / 4e-3)
        return {"v(1)": v, "v(2)": v, "i(d1)": 1e-3 * v / 4}
    return Circuit(NETLISTS / "hard" / "hc02a.cir", 10e-3, exact,
                   {"v(1)": 4, "v(2)": 4, "i(d1)": 1e-3}, 200, 50)


def half_wave_rc():
    omega, tau, period = 100.0, 10e-3, 2 * math.pi / 100
    off = (math.pi - math.atan(1)) / omega
    on = 62.969276265e-3

    def exact(t):
        phase = t if t < on else t - period
        if phase <= off:
            return {"v(out)": 10 * math.sin(omega * phase)}
        return {"v(out)": 10 * math.sin(omega * off) * math.exp(-(phase - off) / tau)}
    return Circuit(NETLISTS / "hard" / "hc16.cir", 100e-3, exact, {"v(out)": 10}, 2000, 100)


def freewheel():
    netlist = """Switched RL with a freewheeling diode
V1 in 0 10
Vg g 0 PULSE(0 1 0 0 0 1m 2m)
S1 in a g 0 sm
D1 0 a
L1 a b 10m
R1 b 0 10
.model sm SW(Ron=0 Vt=0.5)
.tran 100u 10m uic
.end
"""
    def exact(t):
        i, start = 0.0, 0.0
        while True:
            final = 1.0 if round(start / 1e-3) % 2 == 0 else 0.0
            span = min(t - start, 1e-3)
            i = final + (i - final) * math.exp(-span / 1e-3)
            if t <= start + 1e-3 * (1 + 1e-9):
                return {"i(l1)": i}
            start = (round(start / 1e-3) + 1) * 1e-3
    return Circuit(netlist, 10e-3, exact, {"i(l1)": 1}, 1000, 100)


def buck():
    netlist = """Buck converter in continuous conduction
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 50u IC=2
C1 out 0 20u IC=4
R1 out 0 2
.model sm SW(Ron=0 Vt=0.5)
.tran 1u 100u uic
.end
"""
    def exact(t):
        i, v, start = 2.0, 4.0, 0
        edges = [k * 10e-6 + d for k in range(11) for d in (0, 4e-6)]
        for start, end, level in zip(edges, edges[1:], [12, 0] * 11):
            span = min(t, end) - start
            if span > 0:
                i, v = damped(0, -1 / 50e-6, 1 / 20e-6, -1 / 40e-6, (level / 50e-6, 0), (i, v),
                              span)
        return {"i(l1)": i, "v(out)": v}
    return Circuit(netlist, 100e-6, exact, {"i(l1)": 2.4, "v(out)": 4.8}, 2000, 50)


def full_bridge_rl():
    omega, r, inductance = 100 * math.pi, 10.0, 50e-3
    z = complex(r, omega * inductance)
    tau = inductance / r

    def driven(t):  # the response to 10 sin(omega t) after its transient
        return (10 * cmath.exp(1j * omega * t) / z).imag

    def exact(t):
        i, half = 0.0, 10e-3
        for k in range(100):
            span = min(t - k * half, half)
            i = driven(span) + (i - driven(0)) * math.exp(-span / tau)
            if t <= (k + 1) * half * (1 + 1e-12):
                return {"i(l1)": i}
        raise ValueError(t)
    return Circuit(NETLISTS / "rectifiers" / "full_bridge_rl.cir", 100e-3, exact, {"i(l1)": 0.64},
                   2000, 100)


def rlcd():
    netlist = """An LC tank with a diode and a resistor: Siconos' CircuitRLCD
C1 1 0 1u IC=10
L1 1 0 10m
D1 1 2
R1 2 0 1k
.tran 50u 5m uic
.end
"""
    # Sixteen events; the end point from an event-driven solution with matrix exponentials.
    return Circuit(netlist, 5e-3, lambda t: {"v(1)": 2.80040334, "i(l1)": -8.43962e-3},
                   {"v(1)": 10, "i(l1)": 0.1}, 25000, 1)


def lc_bridge_capfilter():
    # Thirty-one events; the end point from an event-driven solution with matrix exponentials.
    end = {"v(1)": -0.19091138465719, "i(l1)": -5.72121251685e-3, "v(2,3)": 0.42008910010395}
    return Circuit(NETLISTS / "tanks" / "lc_bridge_capfilter.cir", 5e-3, lambda t: end,
                   {"v(1)": 10, "i(l1)": 0.1, "v(2,3)": 10}, 25000, 1)


CIRCUITS = {make.__name__: make for make in (rc, rlc, lc_bridge, charge_then_decay, half_wave_rc,
                                             freewheel, buck, full_bridge_rl, rlcd,
                                             lc_bridge_capfilter)}


def fitted_slope(steps, errors):
    x, y = [math.log(h) for h in steps], [math.log(e) for e in errors]
    x_mean, y_mean = sum(x) / len(x), sum(y) / len(y)
    return (sum((a - x_mean) * (b - y_mean) for a, b in zip(x, y))
            / sum((a - x_mean) ** 2 for a in x))


def main():
    program, name = sys.argv[1:]
    circuit, checker = CIRCUITS[name](), Checker(name)
    times = [circuit.stop * (k + 1) / circuit.points for k in range(circuit.points)]
    steps, errors = [], []
    for rung in range(LADDER):
        step = circuit.stop / (circuit.first_steps * 2 ** rung)
        result = run(program, circuit.netlist, step=step, at=times)
        if not checker.check(result.status == 0, f"exit {result.status}: {result.stderr}"):
            return checker.finish()
        error = 0.0
        for signal, scale in circuit.scale.items():
            for t, value in zip(result.time, result.column(signal)):
                error = max(error, abs(value - circuit.exact(t)[signal]) / scale)
        print(f"step {step:.3e} error {error:.3e}")
        steps.append(step)
        errors.append(error)
    slope = fitted_slope(steps, errors)
    print(f"slope {slope:.4f}")
    checker.close(slope, SLOPE, SLOPE_TOLERANCE, "slope")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
