#!/usr/bin/env python3
"""Loops whose controls are saturated at first, and resonant converters: steps of Newton's method lead far away.

A loop with an integrator has no error on average, whatever its values: the mean of the output is the reference. A series
resonant converter below its resonance, without losses, and an LLC converter are compared with runs.

usage: saturated.py PROGRAM
"""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

MOST_STEPS, MOST_PERIODS = 14, 70
NEAR = 1e-9

BOOST = """boost converter, PI controller with limits
Vin in 0 {vin}
Vref ref 0 {ref}
Vtri tri 0 PULSE(0 1 0 {{0.999*{t}}} {{0.001*{t}}} 0 {t})
Bi 0 z I={ki}*(v(ref)-v(out))
Cz z 0 1
B1 ctl 0 V=min(max(v(z)+{kp}*(v(ref)-v(out)),0),0.8)
L1 in sw {l}
S1 sw 0 ctl tri s0
D1 sw out
C1 out 0 {c}
R1 out 0 {r}
.model s0 SW(Ron=10m Vt=0)
.options dialect=ltspice
.pss uic
.end
"""

TYPE_3 = """buck converter, type 3 compensator, gain of 1e5
Vin in 0 {vin}
Vref ref 0 {ref}
Vtri tri 0 PULSE(0 1 0 {{{t}/2}} {{{t}/2}} 0 {t})
R1 out m 10k
R3 out y {r3}
C3 y m {c3}
R2 m q {r2}
C1 q ctl {c1}
C2 m ctl {c2}
E1 ctl 0 ref m 1e5
S1 in sw ctl tri s0
S2 sw 0 tri ctl s0
L1 sw out {l}
C9 out e {c}
Re e 0 {esr}
R9 out 0 {r}
.model s0 SW(Ron=10m Vt=0)
.options dialect=ltspice
.pss uic
.end
"""

PEAK = """buck converter, peak current mode, with its voltage loop
Vin in 0 {vin}
Vref ref 0 {ref}
G1 0 c ref out 1m
Rz c z {rz}
Cz z 0 {cz}
Vclk clk 0 PULSE(0 1 0 0 0 {{0.02*{t}}} {t})
Vr ramp 0 PULSE(0 {ramp} 0 {t} 0 0 {t})
B1 lim 0 V=v(c)-v(ramp)-0.5*i(L1)
A1 lim 0 0 0 0 over 0 0 BUF Ref=0
A2 clk over 0 0 0 0 q 0 SRFLOP Td={{0.004*{t}}}
S1 in sw q 0 sm
D1 0 sw
L1 sw out {l}
C1 out e {c}
Re e 0 {esr}
R1 out 0 {r}
.model sm SW(Ron=50m Vt=0.5)
.pss uic
.end
"""

RESONANT = """half bridge, series resonant
Vin in 0 134
Vg1 g1 0 PULSE(0 1 0 0 0 {{{t}/2}} {t})
Vg2 g2 0 PULSE(0 1 {{{t}/2}} 0 0 {{{t}/2}} {t})
S1 in a g1 0 sm
S2 a 0 g2 0 sm
D8 a in
D9 0 a
Lr a x {l}
Cr x p {c}
R3 p q {loss}
D1 q out
D2 o2 q
D3 0 out
D4 o2 0
C1 out o2 {co}
R1 out o2 {r}
.model sm SW(Ron=0 Vt=0.5)
{analysis}
.end
"""

# The loops hold the output at `ref`.
LOOPS = [
    (BOOST, {"vin": 6.69, "ref": 16.6, "t": 11.3e-6, "ki": 0.86, "kp": 2.6e-3, "l": 24e-6, "c": 34e-6, "r": 14.3}),
    (BOOST, {"vin": 73.8, "ref": 184.0, "t": 3.95e-6, "ki": 0.03, "kp": 1e-4, "l": 50e-6, "c": 2e-6, "r": 57.0}),
    (BOOST, {"vin": 24.0, "ref": 40.0, "t": 20e-6, "ki": 0.05, "kp": 5e-4, "l": 300e-6, "c": 40e-6, "r": 100.0}),
    (BOOST, {"vin": 12.0, "ref": 30.0, "t": 5e-6, "ki": 1.2, "kp": 3e-3, "l": 9e-6, "c": 20e-6, "r": 45.0}),
    (TYPE_3, {"vin": 39.0, "ref": 17.15, "t": 1.24e-6, "r3": 573.0, "c3": 765e-12, "r2": 424.0, "c1": 36e-9, "c2": 1.04e-9,
              "l": 5.83e-6, "c": 10e-6, "esr": 0.021, "r": 2.1}),
    (TYPE_3, {"vin": 12.0, "ref": 5.0, "t": 5e-6, "r3": 700.0, "c3": 2.2e-9, "r2": 3e3, "c1": 15e-9, "c2": 820e-12,
              "l": 15e-6, "c": 33e-6, "esr": 0.015, "r": 1.5}),
    (TYPE_3, {"vin": 48.0, "ref": 30.0, "t": 10e-6, "r3": 600.0, "c3": 3.3e-9, "r2": 800.0, "c1": 68e-9, "c2": 5.6e-9,
              "l": 120e-6, "c": 20e-6, "esr": 0.1, "r": 10.0}),
    (PEAK, {"vin": 8.21, "ref": 4.19, "t": 1.31e-6, "rz": 14.4e3, "cz": 1.8e-9, "ramp": 0.62, "l": 3.1e-6, "c": 50e-6,
            "esr": 0.015, "r": 1.51}),
    (PEAK, {"vin": 48.0, "ref": 12.0, "t": 4e-6, "rz": 1.8e3, "cz": 40e-9, "ramp": 0.5, "l": 22e-6, "c": 20e-6, "esr": 0.02,
            "r": 4.0}),
    (PEAK, {"vin": 24.0, "ref": 15.0, "t": 10e-6, "rz": 1.5e3, "cz": 130e-9, "ramp": 1.0, "l": 60e-6, "c": 40e-6, "esr": 0.05,
            "r": 5.0}),
]

RESONANCES = [
    {"t": 6.1e-6, "l": 20.6e-6, "c": 29.2e-9, "loss": 0.27, "co": 6.9e-6, "r": 52.8},
    {"t": 9e-6, "l": 30e-6, "c": 56e-9, "loss": 0.3, "co": 15e-6, "r": 20.0},
    {"t": 2.1e-6, "l": 4e-6, "c": 33e-9, "loss": 0.1, "co": 4e-6, "r": 16.0},
]


def few(checker, name, done):
    if not checker.check(done.status == 0, f"{name}: status {done.status}\n{done.stderr}"):
        return None
    steady = done.report["steady"]
    checker.check(steady["newton"] <= MOST_STEPS and steady["periods"] <= MOST_PERIODS,
                  f"{name}: {steady['newton']} steps, {steady['periods']} periods")
    return steady


def main():
    checker = Checker("saturated")
    for netlist, values in LOOPS:
        name = f"{netlist.splitlines()[0]}, {values['vin']} V"
        steady = few(checker, name, run(sys.argv[1], netlist.format(**values), method=None))
        if steady is not None:
            mean = steady["signals"]["v(out)"]["average"]
            error = 1e-4 if netlist is TYPE_3 else NEAR  # volts per volt: an amplifier's gain is not endless
            checker.check(abs(mean - values["ref"]) <= error * values["ref"], f"{name}: {mean} V, not {values['ref']}")
    for values in RESONANCES:
        name = f"resonant, {values['r']} Ohm"
        steady = few(checker, name, run(sys.argv[1], RESONANT.format(analysis=".pss uic", **values), method=None))
        if steady is None:
            continue
        stop = 2000 * values["t"]
        done = run(sys.argv[1], RESONANT.format(analysis=f".tran {stop} {stop} {stop * (1 - 1e-9)} uic", **values), method=None,
                   options=("--tol", "1e-11"))
        for state, value in steady["states"].items():
            away = abs(done.report["final"][state] - value)
            checker.check(away <= NEAR * 134, f"{name}: {state} is off by {away:.2g} behind 2000 periods")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
