"""A rectifier with a closed form: its diode opens where the capacitor would give more current than the load
takes, tan(w t) = -w R C, and closes where the decay meets the sine again."""

import math

AMPLITUDE, OMEGA, FARAD = 10.0, 2.0 * math.pi * 50.0, 20e-6
NETLIST = """Half-wave rectifier
.param rload=1k
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 20u
R1 out 0 {rload}
.tran 20u 40m uic
.meas tran vlow min v(out) from=20m to=40m
.meas tran none find v(out) when v(out)=99
"""


def opens(ohm):
    """s, for the first time."""
    return (math.pi - math.atan(OMEGA * ohm * FARAD)) / OMEGA


def closes(ohm):
    """s, for the second time."""
    start = opens(ohm)
    low, high = 2.0 * math.pi / OMEGA, 2.5 * math.pi / OMEGA
    for _ in range(100):
        middle = 0.5 * (low + high)
        decayed = math.sin(OMEGA * start) * math.exp(-(middle - start) / (ohm * FARAD))
        low, high = (middle, high) if decayed > math.sin(OMEGA * middle) else (low, middle)
    return low


def output(ohm, t):
    """V, up to where the diode closes for the second time."""
    if t <= opens(ohm):
        return AMPLITUDE * math.sin(OMEGA * t)
    return AMPLITUDE * math.sin(OMEGA * opens(ohm)) * math.exp(-(t - opens(ohm)) / (ohm * FARAD))
