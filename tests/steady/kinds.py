"""Converters of each kind, ten or so unlike ones, as netlists without an analysis.

Each function yields (name, netlist). The numbers are spread over sizes, duty cycles, loads and scales by
quotients of the golden section, which repeat nowhere.
"""

import gate_circuits

GOLDEN = 0.6180339887498949


def part(k, seed):
    """A number in (0, 1), another one for each k and seed."""
    return (0.5 + (k + 1) * GOLDEN * (seed + 1)) % 1.0


def between(low, high, k, seed):
    """The same between two positive numbers, by ratios."""
    return low * (high / low) ** part(k, seed)


def clock(k, low=2e3, high=2e6):
    return 1.0 / between(low, high, k, 7)


def pulse(node, period, duty):
    return f"Vg{node} g{node} 0 PULSE(0 1 0 0 0 {duty * period!r} {period!r})\n"


SWITCH = ".model sm SW(Ron=0 Vt=0.5)\n"


def buck(continuous):
    for k in range(10):
        period, duty = clock(k), 0.15 + 0.7 * part(k, 1)
        volts, ohms = between(3, 800, k, 2), between(0.5, 500, k, 3)
        # the border between the two kinds of conduction is at 2 L / (R T) = 1 - D
        border = (1 - duty) * ohms * period / 2
        coil = border * (3 if continuous else 0.3)
        store = between(20, 200, k, 4) * period / ohms
        yield (f"buck_{'ccm' if continuous else 'dcm'}_{k}",
               f"Vin in 0 {volts!r}\n" + pulse("1", period, duty) +
               f"S1 in sw g1 0 sm\nD1 0 sw\nL1 sw out {coil!r}\nC1 out 0 {store!r}\n"
               f"R1 out 0 {ohms!r}\n" + SWITCH)


def boost(continuous):
    for k in range(10):
        period, duty = clock(k), 0.2 + 0.5 * part(k, 1)
        volts, ohms = between(3, 200, k, 2), between(2, 500, k, 3)
        border = duty * (1 - duty) ** 2 * ohms * period / 2
        coil = border * (4 if continuous else 0.25)
        store = between(20, 100, k, 4) * period / ohms
        yield (f"boost_{'ccm' if continuous else 'dcm'}_{k}",
               f"Vin in 0 {volts!r}\n" + pulse("1", period, duty) +
               f"L1 in sw {coil!r}\nS1 sw 0 g1 0 sm\nD1 sw out\nC1 out 0 {store!r}\n"
               f"R1 out 0 {ohms!r}\n" + SWITCH)


def flyback(continuous):
    for k in range(10):
        period, duty = clock(k), 0.2 + 0.4 * part(k, 1)
        volts, ohms = between(10, 400, k, 2), between(1, 100, k, 3)
        ratio = between(0.1, 3, k, 5)  # turns of the secondary over those of the primary
        border = (1 - duty) ** 2 * ohms / ratio ** 2 * period / 2
        coil = border * (4 if continuous else 0.25)
        store = between(20, 100, k, 4) * period / ohms
        yield (f"flyback_{'ccm' if continuous else 'dcm'}_{k}",
               f"Vin in 0 {volts!r}\n" + pulse("1", period, duty) +
               f"L1 in sw {coil!r}\nL2 0 s {coil * ratio ** 2!r}\nK1 L1 L2 1\nS1 sw 0 g1 0 sm\n"
               f"D1 s out\nC1 out 0 {store!r}\nR1 out 0 {ohms!r}\n" + SWITCH)


def slow_rectifier():
    for k in range(10):
        volts, hertz = between(5, 500, k, 1), between(16, 20e3, k, 2)
        ohms = between(5, 5e3, k, 3)
        source = ohms * between(1e-3, 5e-2, k, 4)
        store = between(10, 200, k, 5) / hertz / ohms
        if k % 2:
            diodes = "D1 a out\n" if k % 4 == 1 else "D1 a out\nD2 b out\nVb b 0 SIN(0 " \
                f"{volts!r} {hertz!r} 0 0 180)\n"
            yield (f"slow_rectifier_{k}",
                   f"V1 s 0 SIN(0 {volts!r} {hertz!r})\nR1 s a {source!r}\n{diodes}"
                   f"C1 out 0 {store!r}\nR2 out 0 {ohms!r}\n")
        else:
            yield (f"slow_rectifier_{k}",
                   f"V1 s w SIN(0 {volts!r} {hertz!r})\nR1 s a {source!r}\nD1 a out\nD2 w out\n"
                   f"D3 0 a\nD4 0 w\nC1 out 0 {store!r}\nR2 out 0 {ohms!r}\n")


def six_pulse():
    for k in range(10):
        volts, hertz = between(20, 500, k, 1), between(40, 1e3, k, 2)
        ohms = between(1, 100, k, 3)
        line = ohms / hertz * between(1e-4, 1e-2, k, 4)
        coil, store = ohms / hertz * between(0.01, 1, k, 5), between(0.1, 3, k, 6) / hertz / ohms
        lines = "".join(f"V{p} n{p} 0 SIN(0 {volts!r} {hertz!r} 0 0 {-120 * p})\n"
                        f"L{p} n{p} a{p} {line!r}\nD{p} a{p} p\nD{p + 3} m a{p}\n"
                        for p in range(3))
        yield (f"six_pulse_{k}",
               lines + f"Ld p out {coil!r}\nCd out m {store!r}\nRd out m {ohms!r}\n")


def coupled():
    for k in range(10):
        period, duty = clock(k), 0.2 + 0.25 * part(k, 1)
        volts, ohms = between(10, 400, k, 2), between(1, 100, k, 3)
        factor = 0.9 + 0.099 * part(k, 4)
        coil = ohms * period * between(3, 30, k, 5)
        store = between(10, 50, k, 6) * period / ohms
        # forward converter: the third winding takes the flux back
        yield (f"forward_{k}",
               f"Vin in 0 {volts!r}\n" + pulse("1", period, duty) +
               f"L1 in sw {coil!r}\nL2 s 0 {coil!r}\nL3 0 r {coil!r}\n"
               f"K1 L1 L2 {factor!r}\nK2 L1 L3 {factor!r}\nK3 L2 L3 {factor!r}\n"
               f"S1 sw 0 g1 0 sm\nD1 s f\nD2 0 f\nD3 r in\nDc sw cl\nRc cl in {ohms * 20!r}\n"
               f"Cc cl in {period / ohms!r}\n"
               f"Lo f out {coil / 4!r}\nC1 out 0 {store!r}\nR1 out 0 {ohms!r}\n" + SWITCH)


def llc():
    for k in range(10):
        volts, ohms = between(20, 800, k, 1), between(1, 50, k, 2)
        resonance = between(2e4, 5e5, k, 3)
        quality, factor = 0.2 + 0.6 * part(k, 4), 0.7 + 0.7 * part(k, 5)
        coil = quality * ohms * 0.81 / (6.283185307179586 * resonance)
        store = 1 / (coil * (6.283185307179586 * resonance) ** 2)
        magnet, period = coil * between(3, 8, k, 6), 1 / (factor * resonance)
        yield (f"llc_{k}",
               f"Vdc d 0 {volts!r}\nVg g 0 PULSE(1 -1 0 0 0 {period / 2!r} {period!r})\n"
               f"S1 d sw g 0 sw\nS2 sw 0 0 g sw\nLr sw r {coil!r}\nCr r p {store!r}\n"
               f"Lm p 0 {magnet!r}\nLs1 s1 0 {magnet!r}\nLs2 0 s2 {magnet!r}\n"
               f"K1 Lm Ls1 0.998\nK2 Lm Ls2 0.998\nK3 Ls1 Ls2 0.998\nD1 s1 out\nD2 s2 out\n"
               f"Co out 0 {20 * period / ohms!r}\nRo out 0 {ohms!r}\n"
               f".model sw SW(Ron={ohms / 100!r} Vt=0)\n")


def tank():
    for k in range(10):
        hertz, quality = between(50, 5e6, k, 1), between(20, 300, k, 2)
        coil = between(1e-7, 1e-2, k, 3)
        omega = 6.283185307179586 * hertz
        store, ohms = 1 / (coil * omega ** 2), omega * coil / quality
        drive = hertz * (1 + (part(k, 4) - 0.5) / quality)
        side = "D1 t o\n" if k % 2 else "D1 t o\nD2 x t\nRx x 0 " f"{30 * omega * coil * quality!r}\n"
        yield (f"tank_{k}",
               f"V1 s 0 PULSE(-1 1 0 0 0 {0.5 / drive!r} {1 / drive!r})\nR1 s a {ohms!r}\n"
               f"L1 a t {coil!r}\nC1 t 0 {store!r}\n{side}"
               f"Co o 0 {store / 10!r}\nRo o 0 {20 * omega * coil * quality!r}\n")


def multiplier():
    for k in range(10):
        volts, hertz, stages = between(1, 1e4, k, 1), between(50, 1e5, k, 2), 1 + k % 4
        ohms = between(1e3, 1e6, k, 3)
        store = between(2, 10, k, 4) / hertz / ohms
        ladder, up, down = "", "s", "0"
        for n in range(stages):
            ladder += (f"Ca{n} {up} a{n} {store!r}\nD{2 * n} {down} a{n}\n"
                       f"D{2 * n + 1} a{n} b{n}\nCb{n} {down} b{n} {store!r}\n")
            up, down = f"a{n}", f"b{n}"
        yield (f"multiplier_{k}",
               f"V1 v 0 SIN(0 {volts!r} {hertz!r})\nR1 v s {ohms * 1e-3!r}\n{ladder}"
               f"Ro {down} 0 {ohms!r}\n")


def scales():
    """A buck converter of the same shape in units of a micro- and of a megawatt, of nano- and kiloseconds."""
    for k, (volts, ohms, period) in enumerate([(1e-3, 1e3, 1e-6), (1e3, 1e-2, 1e-3), (1e5, 1e4, 1),
                                               (1e-6, 1e-3, 1e-9), (1, 1, 1e3), (12, 1e6, 1e-5),
                                               (1e6, 1, 1e-4), (5e-3, 5e-2, 1e-8), (2, 1e5, 20),
                                               (300, 1e-4, 1e-2)]):
        yield (f"scales_{k}",
               f"Vin in 0 {volts!r}\n" + pulse("1", period, 0.3 + 0.05 * k) +
               f"S1 in sw g1 0 sm\nD1 0 sw\nL1 sw out {ohms * period * (0.2 if k % 2 else 4)!r}\n"
               f"C1 out 0 {30 * period / ohms!r}\nR1 out 0 {ohms!r}\n" + SWITCH)


def hard_edges():
    """Jumps: capacitors that a switch puts together each period, and an interrupted coil."""
    for k in range(10):
        period, volts = clock(k), between(1, 100, k, 1)
        ohms = between(1, 1e4, k, 2)
        store = period / ohms
        yield (f"hard_edges_{k}",
               f"Vin in 0 {volts!r}\n" + pulse("1", period, 0.4) +
               f"Vg2 g2 0 PULSE(0 1 {0.5 * period!r} 0 0 {0.4 * period!r} {period!r})\n"
               f"S1 in a g1 0 sm\nC1 a 0 {store * between(0.05, 2, k, 3)!r}\nS2 a out g2 0 sm\n"
               f"C2 out 0 {store * between(1, 30, k, 4)!r}\nR1 out 0 {ohms!r}\n" + SWITCH)


def interleaved():
    """Phases of a buck converter on one output: too many unknowns for dense maps."""
    for k, (phases, loaded) in enumerate([(14, 1), (20, 1), (16, 0.05), (24, 0.05)]):
        period, volts, ohms = clock(k), between(5, 50, k, 2), between(0.05, 5, k, 3)
        duty = 0.2 + 0.5 * part(k, 1)
        text = f"Vin in 0 {volts!r}\nC1 out 0 {3 * period / ohms!r}\nR1 out 0 {ohms / loaded!r}\n"
        for n in range(phases):
            text += (f"Vg{n} g{n} 0 PULSE(0 1 {n * period / phases!r} 0 0 {duty * period!r} "
                     f"{period!r})\nS{n} in w{n} g{n} 0 sm\nD{n} 0 w{n}\n"
                     f"L{n} w{n} x{n} {ohms * period * phases!r}\nR{n}0 x{n} out {ohms / 10!r}\n")
        yield f"interleaved_{k}", text + SWITCH


def gates():
    """Circuits with gates, latches and samples."""
    for name, text, level, _, _, _ in gate_circuits.CIRCUITS:
        yield name, text.replace("{S}", repr(level)).split("\n", 1)[1]


def ideal_pumps():
    """Diodes that charge a capacitor in an instant, and are left with neither voltage nor current: doublers, two loads each."""
    for level, period, store, out in ((5.0, 10e-6, 100e-9, 10e-6), (2e3, 1e-3, 10e-9, 33e-9), (1.2, 50e-9, 1e-12, 3e-12),
                                      (48.0, 2e-6, 2.2e-6, 4.7e-6), (12.0, 0.1, 1e-3, 5e-3)):
        for name, load in (("resistor", f"R1 out 0 {100 * period / store!r}"), ("current", f"I1 out 0 {0.01 * level * store / period!r}")):
            yield (f"{name}, {level:g} V", f"Vin in 0 {level!r}\nVck ck 0 PULSE(0 {level!r} 0 0 0 {period / 2!r} {period!r})\nD1 in a\n"
                   f"C1 ck a {store!r}\nD2 a out\nC2 out 0 {out!r}\n{load}\n")
    for load in (300.0, 1e3, 2e4):
        yield (f"Greinacher, {load:g} Ohm", f"V1 in 0 PULSE(-5 5 0 0 0 5u 10u)\nC1 in a 100n\nD1 0 a\nD2 a out\nC2 out 0 1u\nR1 out 0 {load!r}\n")


KINDS = {
    "gates": gates,
    "buck_ccm": lambda: buck(True), "buck_dcm": lambda: buck(False),
    "boost_ccm": lambda: boost(True), "boost_dcm": lambda: boost(False),
    "flyback_ccm": lambda: flyback(True), "flyback_dcm": lambda: flyback(False),
    "slow_rectifier": slow_rectifier, "six_pulse": six_pulse, "coupled": coupled, "llc": llc,
    "tank": tank, "multiplier": multiplier, "scales": scales, "hard_edges": hard_edges, "interleaved": interleaved,
    "ideal_pumps": ideal_pumps,
}
