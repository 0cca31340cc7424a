#!/usr/bin/env python3
"""Sources with a formula: against closed forms, exact solutions, and the same circuits of diodes.

usage: behaviours.py PROGRAM
"""

import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import NETLISTS, Checker, run  # noqa: E402

REFERENCE = pathlib.Path(__file__).resolve().parents[1] / "reference"
FINE = 1e-11


def successful(checker, program, netlist, **options):
    result = run(program, netlist, **options)
    title = str(netlist).splitlines()[0]
    checker.check(result.status == 0, f"{title}: exit status {result.status}\n{result.stderr}")
    return result


# ---- The papers' switching DAE -------------------------------------------------------------------

def first_form(t):
    """x' = -x + z - 3, 0 = 0.5|x| + 0.5|z| - z + 1 - t/2, x(0) = 1: x and z at t."""
    t1 = math.sqrt(3) - 1  # x > 0 before: x' = -1 - t
    shift = 0.25 + t1 / 2  # x < 0, z > 0: x' = -2 x - 1 - t

    def second(s):
        return shift * math.exp(-2 * (s - t1)) - 0.25 - s / 2

    low, high = 4.0, 5.0   # z = 2 - t - x falls through 0
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if 2 - middle - second(middle) > 0 else (low, middle)
    if t < t1:
        x = 1 - t - t * t / 2
        return x, x + 2 - t
    if t < low:
        return second(t), 2 - t - second(t)
    # z < 0: x' = -4/3 x - 7/3 - t/3
    rest = second(low) + 25 / 16 + low / 4
    x = rest * math.exp(-4 / 3 * (t - low)) - 25 / 16 - t / 4
    return x, (2 - t - x) / 3


SWITCHING = """the first switching DAE, {form}
C1 x 0 1 ic=1
B1 0 x I=-v(x)+v(z)-3
{source}
.tran 10m 7 uic
"""


def check_switching_dae(checker, program):
    at = [0.01 * k for k in range(1, 701)]
    for source in ("B2 z 0 V=0.5*abs(v(x)) + 0.5*abs(v(z)) + 1 - time/2",
                   "B2 0 z I=0.5*abs(v(x)) + 0.5*abs(v(z)) - v(z) + 1 - 0.5*time",
                   "E2 z 0 VALUE={0.5*max(v(x),-v(x)) - 0.5*min(v(z),-v(z)) + 1 - 0.5*time}"):
        result = successful(checker, program, SWITCHING.format(form=source[:12], source=source),
                            at=at, method=None, tolerance=FINE)
        worst = max((max(abs(x - first_form(t)[0]), abs(z - first_form(t)[1])) for t, x, z in
                     zip(result.time, result.column("v(x)"), result.column("v(z)"))),
                    default=math.inf)
        checker.check(worst <= 1e-9, f"{source}: off by {worst:.2e}")
    # implicit Euler converges to it, of order 1
    errors = []
    for step in (1e-2, 1e-3):
        result = successful(checker, program, SWITCHING.format(form="Euler", source=source),
                            step=step)
        errors.append(max(abs(x - first_form(t)[0]) for t, x in
                          zip(result.time, result.column("v(x)"))))
    checker.check(errors[1] < 0.15 * errors[0] < 0.15 * 0.05, f"implicit Euler: errors {errors}")


def check_second_switching_dae(checker, program):
    case = json.loads((REFERENCE / "p63_var.json").read_text(encoding="utf-8"))
    signals = ["v(x1)", "v(x2)", "v(z)"]
    result = successful(checker, program, NETLISTS / "relays" / "switching_dae_2.cir",
                        at=[row[0] for row in case["rows"]], method=None, tolerance=FINE)
    for signal in signals:
        place = case["signals"].index(signal)
        worst = max((abs(x - row[1 + place]) / case["scale"][place] for x, row in
                     zip(result.column(signal), case["rows"])), default=math.inf)
        checker.check(worst <= 1e-9, f"the second switching DAE: {signal} is off by {worst:.2e}")
    turns = [event[0] for event in case["events"] if event[1] == "d1" and event[0] > 0]
    found = [event["time"] for event in result.report["events"]]
    checker.check(len(found) == len(turns), f"{len(found)} turns, not {len(turns)}")
    for wanted, time in zip(turns, found):
        checker.close(time, wanted, 2e-11, "a turn of v(x1)")


# ---- Hard cases, with diodes and with a formula ----------------------------------------------------

RELAY_UNDER_SINE = """a relay under a sinusoidal disturbance
I1 0 x SIN(0 0.9m 100)
C1 x 0 1u ic=0
B1 x 0 I=1m*sgn(v(x))
.save v(x) i(b1)
.tran 10u 20m uic
"""

# The bridge of hc17 behind 1 kohm: a conductance up to 1 mA.
BRIDGE_LIMITER = """a current limiter from a bridge
I1 0 x SIN(0 3m 100)
C1 x 0 1u ic=2
Rs x y 1k
D1 y p DI
D2 0 p DI
D3 n y DI
D4 n 0 DI
IB p n DC 1m
.save v(x) i(rs)
.model DI D(Ron=0 Vfwd=0)
.tran 10u 20m uic
"""
FORMULA_LIMITER = """a current limiter
I1 0 x SIN(0 3m 100)
C1 x 0 1u ic=2
B1 x 0 I=limit(v(x)/1k, -1m, 1m)
.save v(x) i(b1)
.tran 10u 20m uic
"""


def check_hard_cases(checker, program):
    hard, relays = NETLISTS / "hard", NETLISTS / "relays"
    for diodes, formula, signals in (
            (hard / "hc17.cir", relays / "relay.cir",
             {"v(x)": "v(x)", "i(d1)-i(d3)": "i(b1)"}),
            (hard / "hc18.cir", relays / "friction.cir",
             {"v(a)": "v(a)", "v(b)": "v(b)", "i(l1)": "i(l1)"}),
            (hard / "hc38.cir", RELAY_UNDER_SINE, {"v(x)": "v(x)", "i(d1)-i(d3)": "i(b1)"}),
            (BRIDGE_LIMITER, FORMULA_LIMITER, {"v(x)": "v(x)", "i(rs)": "i(b1)"})):
        name = str(formula).splitlines()[0]
        for method in (None, "euler"):
            tolerance = None if method else FINE
            stop = 15.0 if "friction" in name else 10e-3
            at = [(k + 0.5) * stop / 500 for k in range(500)]
            one = successful(checker, program, diodes, at=at, method=method, tolerance=tolerance)
            two = successful(checker, program, formula, at=at, method=method, tolerance=tolerance)
            for with_diodes, with_formula in signals.items():
                x, y = one.column(with_diodes), two.column(with_formula)
                scale = max(abs(value) for value in x) + 1e-6
                worst = max(abs(a - b) for a, b in zip(x, y)) / scale
                checker.check(worst <= 1e-9, f"{name}, {method}: {with_formula} is off by "
                              f"{worst:.2e} of its scale")
            balance, energy = two.report["energy"]["balance"], two.report["energy"]
            size = max(abs(value) for value in energy.values()) + 1e-12
            checker.check(abs(balance) <= 1e-9 * size, f"{name}, {method}: energies {energy}")
            # it slides and does not chatter
            checker.check(len(two.report["events"]) <= 12,
                          f"{name}, {method}: {len(two.report['events'])} events")
            if method is None:
                checker.check(two.report["work"]["steps"] <= 120,
                              f"{name}: {two.report['work']['steps']} steps")


NEGATIVE_RELAY = """the negative relay of hc30 as a formula
B1 x 0 I=-sgn(v(x))
C1 x 0 1 ic=0
.save v(x)
.tran 1m 1 uic
.end
"""


def check_negative_relay(checker, program):
    """Not passive: t, 0 and -t are solutions; one is taken, and that there are others is said."""
    for method in (None, "euler"):
        for netlist in (NEGATIVE_RELAY, NETLISTS / "hard" / "hc30.cir"):
            result = successful(checker, program, netlist, method=method)
            final = result.column("v(x)")[-1]
            checker.check(min(abs(final - wanted) for wanted in (-1, 0, 1)) < 1e-9,
                          f"negative relay, {method}: v(x) ends at {final}")
            checker.check("3 solutions of a circuit that is not passive" in result.stderr,
                          f"negative relay, {method}: {result.stderr}")


# ---- Values at an operating point, times of events ---------------------------------------------------

OPAMPS = """op-amps at rest
.subckt opamp p n out gain=1e6 rail=10
B1 out 0 V=limit(gain*v(p,n), -rail, rail)
.ends
.func clip(x,y) {min(max(x,-y),y)}
V1 in 0 LEVEL
X1 in f1 f1 opamp
R2 in n2 1k
R3 n2 o2 4k
X2 0 n2 o2 opamp rail=12
B3 o3 0 V=12*sgn(v(in,o3))
B4 o4 0 V=clip(2*v(in), 3)
E5 o5 0 TABLE {v(in)} = (-1,-2) (0,0) (1,8)
E6 o6 0 in 0 table=(-1,-2, 0,0, 1,8)
G7 0 o7 VALUE={abs(v(in))}
R7 o7 0 1
R8 o8 0 1
B8 0 o8 I = v(in) > 1 ? 3 : 1
.op
"""


def check_operating_points(checker, program):
    for level in (-4.0, -0.5, 0.25, 2.0, 5.0):
        result = successful(checker, program, OPAMPS.replace("LEVEL", repr(level)), method=None)
        table = 8 * min(max(level, 0), 1) + 2 * min(max(level, -1), 0)
        unlimited = -4 * level / (1 + 5e-6)
        for node, wanted in (("f1", level / (1 + 1e-6)), ("o2", min(max(unlimited, -12), 12)),
                             ("o3", level), ("o4", min(max(2 * level, -3), 3)), ("o5", table),
                             ("o6", table), ("o7", abs(level)), ("o8", 3 if level > 1 else 1)):
            checker.close(result.column(f"v({node})")[-1], wanted, 2e-12 * max(1, abs(wanted)),
                          f"{level} V: v({node})")


COMPARATOR = """a comparator, its edges and its events
V1 a 0 PWL(0 0 1m 3 2m -1)
V2 ref 0 1.5
B1 q 0 V=v(a) > v(ref) ? 5 : 0
R1 q 0 1k
B2 s 0 V=u(time-0.3m) - 2*(time > 1.7m)
R2 s 0 1k
.tran 10u 2m
"""


def check_events(checker, program):
    result = successful(checker, program, COMPARATOR, method=None)
    for signal, time, height in (("q", 0.5e-3, 5), ("q", 1.375e-3, 5), ("s", 0.3e-3, 1), ("s", 1.7e-3, 2)):
        sides = [x for t, x in zip(result.time, result.column(f"v({signal})")) if abs(t - time) < 1e-15]
        checker.check(len(sides) == 2 and abs(sides[0] - sides[1]) == height, f"no edge at {time}: {sides}")
    # What sources alone decide has edges; what the circuit decides has events.
    result = successful(checker, program, COMPARATOR.replace("V1 a 0", "R0 a0 a 1k\nV1 a0 0"), method=None)
    times = [event["time"] for event in result.report["events"]]
    checker.check(len(times) == 2, f"comparator: events at {times}")
    for time, wanted in zip(times, (0.5e-3, 1.375e-3)):
        checker.close(time, wanted, 1e-15, "comparator: an event")


OSCILLATOR = """a relaxation oscillator, whose trigger has infinite gain
B1 out 0 V=10*sgn(v(p,n))
R1 out p 1k
R2 p 0 1k
R3 out n 1k
C1 n 0 1u ic=0.1
.tran 10u 20m uic
"""


def check_oscillator(checker, program):
    result = successful(checker, program, OSCILLATOR, method=None, tolerance=FINE)
    times = [event["time"] for event in result.report["events"]]
    checker.check(len(times) in (17, 18), f"oscillator: {len(times)} events")
    for first, second in zip(times, times[1:]):
        checker.close(second - first, math.log(3) * 1e-3, 1e-12, "oscillator: a half-cycle")


# ---- Currents ----------------------------------------------------------------------------------------

CURRENTS = """the current of every kind of element
V1 a 0 SIN(0 10 1k)
R1 a b 3
L1 b c 1m
C1 c 0 10u
D1 c d DL
R2 d 0 5
S1 d e a 0 SW
R3 e 0 7
I1 0 e SIN(0 0.1 1k)
E1 f 0 c 0 2
R4 f 0 9
G1 0 g c 0 0.3
R5 g 0 1
F1 0 h V1 2
R6 h 0 1
H1 j 0 V1 3
R7 j 0 1
L2 k 0 1m
L3 a k 1m
K1 L2 L3 0.5
B9 0 m I=uramp(v(c))
R8 m 0 1
.model DL D(Ron=0.1 Roff=1k Vfwd=0.5)
.model SW SW(Ron=1 Roff=1k)
.tran 10u 3m
"""
ELEMENTS = ["v1", "r1", "l1", "c1", "d1", "s1", "i1", "e1", "g1", "f1", "h1", "l2", "l3", "b9"]


def check_currents(checker, program):
    readers = "".join(f"B{name} n{name} 0 V=2*i({name})-1\nR{name}x n{name} 0 1k\n"
                      for name in ELEMENTS)
    saved = ".save " + " ".join(f"i({name}) v(n{name})" for name in ELEMENTS) + "\n"
    for method in (None, "euler"):
        result = successful(checker, program, CURRENTS + readers + saved, method=method)
        for name in ELEMENTS:
            x, y = result.column(f"i({name})"), result.column(f"v(n{name})")
            scale = 1 + max(abs(value) for value in x)
            worst = max((abs(2 * a - 1 - b) for a, b in zip(x, y)), default=math.inf)
            checker.check(worst <= 1e-9 * scale and scale > 1.01,
                          f"{method}: i({name}) is read with an error of {worst:.2e}")


def main():
    checker = Checker("behaviours")
    program = sys.argv[1]
    check_switching_dae(checker, program)
    check_second_switching_dae(checker, program)
    check_hard_cases(checker, program)
    check_negative_relay(checker, program)
    check_operating_points(checker, program)
    check_events(checker, program)
    check_oscillator(checker, program)
    check_currents(checker, program)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
