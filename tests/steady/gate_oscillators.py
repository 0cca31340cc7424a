"""Circuits with gates that oscillate by themselves: (netlist, period in closed form or None)."""

import math

from kinds import between, part


def schmitt_delay():
    """A Schmitt inverter that is late, and drives its own input through an RC."""
    for k in range(10):
        volts, ohms = between(1, 50, k, 1), between(100, 1e6, k, 2)
        tau = between(1e-8, 1e-1, k, 3)
        middle, half = (0.4 + 0.2 * part(k, 4)) * volts, (0.02 + 0.25 * part(k, 5)) * volts
        late = tau * between(1e-3, 2, k, 6)
        low = (middle - half) * math.exp(-late / tau)
        high = volts - (volts - middle - half) * math.exp(-late / tau)
        period = 2 * late + tau * (math.log((volts - low) / (volts - middle - half)) +
                                   math.log(high / (middle - half)))
        yield (f"R1 q c {ohms!r}\nC1 c 0 {tau / ohms!r}\n"
               f"A1 c 0 0 0 0 q 0 0 SCHMTINV Vhigh={volts!r} Vt={middle!r} Vh={half!r} Td={late!r}\n", period)


def timer():
    """Two comparators and a latch, as in a 555: a capacitor is filled through two resistors and emptied by one."""
    for k in range(10):
        volts, fill, drain = between(3, 20, k, 1), between(1e3, 1e5, k, 2), between(1e3, 1e5, k, 3)
        store = between(1e-11, 1e-6, k, 4)
        low, high = (0.2 + 0.2 * part(k, 5)) * volts, (0.5 + 0.4 * part(k, 6)) * volts
        period = store * ((fill + drain) * math.log((volts - low) / (volts - high)) + drain * math.log(high / low))
        yield (f"V1 p 0 {volts!r}\nR1 p d {fill!r}\nR2 d c {drain!r}\nC1 c 0 {store!r}\n"
               f"A1 c 0 0 0 0 below 0 0 BUF Ref={low!r}\nA2 c 0 0 0 0 0 above 0 BUF Ref={high!r}\n"
               f"A3 above below 0 0 0 0 q 0 SRFLOP\nS1 d 0 q 0 sm\n.model sm SW(Ron=0 Vt=0.5)\n", period)


def late_hysteretic():
    """A buck converter whose comparator's edges come later, the switch of which takes time to turn over."""
    for k in range(10):
        volts, duty, ohms = between(5, 50, k, 1), 0.25 + 0.5 * part(k, 2), between(0.5, 20, k, 3)
        coil, store = ohms * between(2e-6, 2e-5, k, 4), between(2e-5, 2e-4, k, 5) / ohms
        rest, half = ohms * between(0.02, 0.2, k, 6), volts * between(1e-3, 1e-2, k, 7)
        late = coil / ohms * between(1e-3, 1e-2, k, 8)
        yield (f"Vin in 0 {volts!r}\nVref ref 0 {duty * volts!r}\nS1 in sw q 0 sm\nD1 0 sw\n"
               f"L1 sw out {coil!r}\nC1 out e {store!r}\nRe e 0 {rest!r}\nR1 out 0 {ohms!r}\n"
               f"A1 ref out 0 0 0 0 q 0 DIFFSCHMITT Vt=0 Vh={half!r} Td={late!r} Trise={late / 3!r} Tfall={late / 7!r}\n"
               ".model sm SW(Ron=1m Vt=0.6)\n", None)


def on_time():
    """A buck converter with a constant on-time: a latch that a comparator sets and its own late output resets."""
    for k in range(10):
        volts, duty, ohms = between(5, 50, k, 1), 0.1 + 0.3 * part(k, 2), between(0.5, 20, k, 3)
        coil, store = ohms * between(2e-6, 2e-5, k, 4), between(5e-5, 2e-4, k, 5) / ohms
        rest, pulse = ohms * between(0.05, 0.2, k, 6), coil / ohms * between(0.02, 0.1, k, 7)
        yield (f"Vin in 0 {volts!r}\nVref ref 0 {duty * volts!r}\nS1 in sw q 0 sm\nD1 0 sw\n"
               f"L1 sw out {coil!r} IC={duty * volts / ohms!r}\nC1 out e {store!r} IC={duty * volts!r}\nRe e 0 {rest!r}\nR1 out 0 {ohms!r}\n"
               f"A1 ref out 0 0 0 0 low 0 DIFFSCHMITT Vt=0 Vh=0 Td={pulse / 20!r}\nA2 low done 0 0 0 0 q 0 SRFLOP\n"
               f"A3 q 0 0 0 0 0 done 0 BUF Td={pulse!r}\n.model sm SW(Ron=1m Vt=0.5)\n", None)


def ring_of_gates():
    """Three or five inverters that read each other, with delays of their own, on a load with a memory of its own."""
    for k in range(10):
        n, body, period = 3 if k % 2 else 5, "", 0.0
        for j in range(n):
            late = between(1e-9, 1e-3, k, 1) * (0.5 + part(k + j, 2))
            period += 2 * late
            body += f"A{j} g{(j - 1) % n} 0 0 0 0 g{j} 0 0 INV Td={late!r}\n"
        yield body + f"R1 g0 c 1k\nC1 c 0 {between(1e-2, 1, k, 3) * period / 1e3!r}\n", period


KINDS = {f.__name__: f for f in (schmitt_delay, timer, late_hysteretic, on_time, ring_of_gates)}
