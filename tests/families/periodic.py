#!/usr/bin/env python3
"""What comes back with the sources' period is computed once, and where nothing comes back, nothing is.

usage: periodic.py PROGRAM [TOLERANCE...]

A sine that is damped by 1e-30 /s is the same in doubles, but has no period, nor has a PULSE of a million pulses:
so each run has a twin that computes every step. Their waveforms and events must agree far better than the tolerance, with the
ledger of energies and without it.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

HALF_WAVE = """D1 in out
R1 out 0 1k
C1 out 0 20u
"""
BRIDGE = """Rs in b 0.5
D1 b p
D2 0 p
D3 m b
D4 m 0
Cf p m 470u
Rl p m 200
Rg m 0 1meg
"""
SIX_PULSE = """La a1 a 1m
Lb b1 b 1m
Lc c1 c 1m
D1 a p
D3 b p
D5 c p
D4 m a
D6 m b
D2 m c
Ld p d 5m
Rd d m 10
Rg m 0 100k
"""
DOUBLER = """Rs in s 1
C1 s x 10u
D1 0 x
D2 x out
C2 out 0 10u
R1 out 0 5k
"""
THRESHOLD = """R1 in x 100
S1 x out in 0 SWM
.model SWM SW(VT=2 VH=0.5 RON=1)
C1 out 0 10u
R2 out 0 1k
D1 out y
Rd y 0 500
"""
# 40 s beside periods of 20 ms: what is left of the start at the end is 0.95 of it.
SLOW = HALF_WAVE + """R2 in slow 10meg
C2 slow 0 4u IC=1
"""
ONE = "Vin in 0 SIN(0 10 50 {delay} {damping})\n"
PHASES = "".join(f"V{name} {name}1 0 SIN(0 100 50 0 {{damping}} {angle})\n"
                 for name, angle in (("a", 0), ("b", -120), ("c", 120)))
TONES = ("Vin in i1 SIN(0 10 50 0 {damping})\nV2 i1 i2 SIN(1 2 150 0 {damping} 30)\n"
         "V3 i2 0 SIN(0 1 20 0 {damping})\n")
BEATS = "Vin in i1 SIN(0 10 50 0 {damping})\nV2 i1 0 SIN(0 2 71.371371 0 {damping} 30)\n"

BUCK = """Vin in 0 12
Vg g 0 PULSE(0 1 {delay} 0 0 3u 10u {pulses})
S1 in sw g 0 SM
D1 0 sw
L1 sw out 10u
C1 out 0 10u
R1 out 0 {load}
.model SM SW(VT=0.5)
"""
RESONANT = """Vin in 0 24
Vg g 0 PULSE(0 1 0 0 0 5u 10u {pulses})
Vh h 0 PULSE(0 1 5u 0 0 5u 10u {pulses})
S1 in sw g 0 SM
S2 sw 0 h 0 SM
Lr sw a 10u
Cr a b 300n
Lp b 0 100u
D1 b p
D2 n b
Co p n 2u
Ro p n 40
Rn n 0 10m
.model SM SW(VT=0.5 RON=50m)
"""
TWO_CLOCKS = BUCK.replace(".model", "Vh h 0 PULSE(0 1 0 0 0 4u 13.1u)\nS3 out x h 0 SM\n"
                          "R3 x 0 1k\n.model")

# Whether it comes back: at loose tolerances only.
LOOSE = "loose"

# name: sources and circuit, s, whether it comes back
CASES = {
    "half wave": (ONE + HALF_WAVE, 0.5, True),
    "half wave, delayed": (ONE.replace("{delay}", "13m") + HALF_WAVE, 0.5, True),
    "half wave, damped": (ONE.replace("{damping}", "1") + HALF_WAVE, 0.5, False),
    "half wave, 2000 periods": (ONE + HALF_WAVE.replace("D1", ".save v(out)\nD1"), 40.0, True),
    "load steps": (ONE + HALF_WAVE + "I1 out 0 PWL(0 0 0.31 0 0.3101 5m)\n", 0.6, True),
    "load steps late": (ONE + HALF_WAVE + "I1 out 0 PWL(0 0 0.451 0 0.4511 5m)\n", 0.5, False),
    "bridge": (ONE + BRIDGE, 0.6, True),
    "six-pulse": (PHASES + SIX_PULSE, 0.4, True),
    "doubler": (ONE + DOUBLER, 2.0, True),
    "switch with hysteresis": (ONE + THRESHOLD, 0.5, True),
    "three tones": (TONES + HALF_WAVE, 1.5, True),
    "beats": (BEATS + HALF_WAVE, 0.5, False),
    "slow beside fast": (ONE + SLOW, 2.0, None),
    "buck, discontinuous": (BUCK.replace("{load}", "50"), 0.02, LOOSE),
    "buck, delayed": (BUCK.replace("{load}", "50").replace("{delay}", "13u"), 0.02, LOOSE),
    "buck, load steps": (BUCK.replace("{load}", "50") + "I1 out 0 PWL(0 0 8m 0 8.0013m 0.1)\n",
                         0.02, LOOSE),
    "resonant": (RESONANT, 0.01, LOOSE),
    "two clocks": (TWO_CLOCKS.replace("{load}", "50"), 0.005, False),
}
LOOSEST_EXACT = 1e-7  # below, what rounding leaves may be too much
TOLERANCES = ["1e-3", "1e-6", "1e-9", "1e-11"]


def events(result):
    return [(event["element"], event["state"], event["time"]) for event in result.report["events"]]


def largest_difference(names, rows, others):
    """Over the largest value of each signal, and of currents over the largest of all."""
    worst = 0.0
    ampere = max((abs(row[k]) for row in rows for k, name in enumerate(names) if name[0] == "i"),
                 default=0.0)
    for k in range(1, len(names)):
        scale = ampere if names[k][0] == "i" else max(abs(row[k]) for row in rows)
        difference = max(abs(row[k] - other[k]) for row, other in zip(rows, others))
        worst = max(worst, difference / scale if scale > 0.0 else difference)
    return worst


def least_currents(program, netlist, tolerance):
    """Of each diode, over the largest of all: rows are on both sides of every event, and beside those of
    the grid, which must not fall on zeros of the sources, for the largest is to be a peak."""
    result = run(program, netlist.replace(".tran 100u", ".tran 1.7m"), method=None, tolerance=tolerance)
    current = {name: result.column(name) for name in result.names if name.startswith("i(d")}
    largest = max((max(values) for values in current.values()), default=1.0)
    return {name: min(values) / largest for name, values in current.items()}


def check_signs(program, checker, case, netlist, twin, tolerance):
    """No diode conducts backwards any more than in the twin: a period ends where its event is."""
    theirs = least_currents(program, twin, tolerance)
    for name, least in least_currents(program, netlist, tolerance).items():
        checker.check(least >= 2.0 * theirs[name] - 1e-12, f"{case}: {name} is down to {least:.1e}")


def check_case(program, checker, name, tolerance):
    circuit, stop, comes_back = CASES[name]
    case = f"{name}, {tolerance}"
    text = f"{name}\n{circuit}.tran 100u {stop} uic\n.end\n".replace("{delay}", "0")
    netlist = text.replace("{damping}", "0").replace("{pulses}", "")
    twin = text.replace("{damping}", "1e-30").replace("{pulses}", "1e6")
    times = [stop * (k + 0.37) / 700 for k in range(700)]
    plain = run(program, netlist, at=times, method=None, tolerance=tolerance)
    exact = run(program, twin, at=times, method=None, tolerance=tolerance)
    if not checker.check(plain.status == 0 and exact.status == 0, f"{case}: {plain.stderr}"):
        return
    steps, repeated = (plain.report["work"][key] for key in ("steps", "periodic_steps"))
    checker.check(exact.report["work"]["periodic_steps"] == 0, f"{case}: the twin repeats")
    if comes_back == LOOSE:
        comes_back = True if float(tolerance) > LOOSEST_EXACT else None
    if comes_back is not None:
        checker.check((repeated > steps / 4) == comes_back and (repeated > 0) == comes_back,
                      f"{case}: {repeated} of {steps} steps repeated")
    difference = largest_difference(plain.names, plain.rows, exact.rows)
    checker.check(difference <= max(0.1 * float(tolerance), 1e-11), f"{case}: off by {difference:.1e}")
    ours, theirs = events(plain), events(exact)
    checker.check([event[:2] for event in ours] == [event[:2] for event in theirs],
                  f"{case}: {len(ours)} events, not {len(theirs)}")
    late = max((abs(a[2] - b[2]) for a, b in zip(ours, theirs)), default=0.0)
    checker.check(late <= max(0.1 * float(tolerance), 1e-12) * stop, f"{case}: late by {late:.1e} s")
    no_ledger = run(program, netlist, at=times, method=None, tolerance=tolerance, report=False)
    alone = largest_difference(plain.names, plain.rows, no_ledger.rows)
    checker.check(alone <= 1e-10, f"{case}: {alone:.1e} from the run without a ledger")
    check_signs(program, checker, case, netlist, twin, tolerance)
    print(f"{case}: {repeated} of {steps} steps, {difference:.1e}, events {late / stop:.1e}, "
          f"without a ledger {alone:.1e}", flush=True)


def main():
    checker = Checker("periodic")
    for name, tolerance in some_of([(name, tolerance) for name in CASES for tolerance in sys.argv[2:] or TOLERANCES], 4):
        check_case(sys.argv[1], checker, name, tolerance)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
