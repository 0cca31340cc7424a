"""Converters of each kind with small signals, ten unlike ones of each.

Each yields Case(name, elements, controls, ends, ac, outputs, ...): elements are those of exact.Circuit, of which the
netlist is made too, with the lines of `controls` besides, which do not load them; ends[(switch, "off")] says what ends
a mode there, as exact.Orbit wants it. Numbers are spread by quotients of the golden section, which repeat nowhere.
"""

import collections
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "steady"))
from kinds import between, clock, part  # pylint: disable=wrong-import-position,import-error

Case = collections.namedtuple(
    "Case", "name elements controls ends ac outputs period omega couplings", defaults=(0.0, ()))


def source(name, kind, nodes, case):
    value = {e[0]: e[3] for e in case.elements}[name]
    text = f"{name} {nodes[0]} {nodes[1]} "
    if "cos" in value or "sin" in value:
        size = math.hypot(value.get("cos", 0.0), value.get("sin", 0.0))
        phase = math.degrees(math.atan2(value.get("cos", 0.0), value.get("sin", 0.0)))
        hertz = case.omega / (2 * math.pi)
        text += f"SIN({value.get('1', 0.0)!r} {size!r} {hertz!r} 0 0 {phase!r})"
    else:
        text += f"DC {value.get('1', 0.0)!r}"
    return text + (" AC 1" if name == case.ac else "") + "\n"


def netlist(case):
    text = f"{case.name}\n"
    models = {}
    for name, kind, nodes, value in case.elements:
        if kind in "VI":
            text += source(name, kind, nodes, case)
        elif kind == "D":
            model = models.setdefault(("D", value), f"m{len(models)}")
            text += f"{name} {nodes[0]} {nodes[1]} {model}\n"
        elif kind == "S":
            continue  # of the controls, which have its command
        elif kind == "G":
            text += f"{name} {' '.join(nodes)} {value!r}\n"
        else:
            text += f"{name} {nodes[0]} {nodes[1]} {value!r}\n"
    for k, (one, other, factor) in enumerate(case.couplings):
        text += f"K{k} {one} {other} {factor!r}\n"
    for (kind, value), model in models.items():
        text += f".model {model} {kind}(Ron={value!r})\n"
    return text + case.controls


SWITCH = ".model sm SW(Ron=0 Vt=0)\n"
POWER = ("buck", "boost", "buckboost", "boost_esr", "buck_filter")


def power(shape, volts, ohms, coil, store, load):
    """(elements, the node that is regulated); load: (name, kind, nodes, value) beside the resistor, or None."""
    out = [("c1", "C", ("out", "0"), store), ("r1", "R", ("out", "0"), ohms)]
    ins = [("vin", "V", ("in", "0"), {"1": volts})]
    if shape == "buck_filter":
        ins += [("rf", "R", ("in", "f0"), ohms / 50), ("lf", "L", ("f0", "fin"), coil / 9),
                ("cf", "C", ("fin", "0"), store * 3)]
    if shape in ("boost_esr",):
        out = [("c1", "C", ("out", "esr"), store), ("re", "R", ("esr", "0"), ohms / 60),
               ("r1", "R", ("out", "0"), ohms)]
    at = "fin" if shape == "buck_filter" else "in"
    middle = {"buck": [("s1", "S", (at, "sw"), 0.0), ("d1", "D", ("0", "sw"), 0.0),
                       ("l1", "L", ("sw", "out"), coil)],
              "boost": [("l1", "L", (at, "sw"), coil), ("s1", "S", ("sw", "0"), 0.0),
                        ("d1", "D", ("sw", "out"), 0.0)],
              "buckboost": [("s1", "S", (at, "sw"), 0.0), ("l1", "L", ("sw", "0"), coil),
                            ("d1", "D", ("out", "sw"), 0.0)]}[shape.split("_")[0]]
    return ins + middle + out + ([load] if load else [])


def border(shape, duty, ohms, period):
    shape = shape.split("_")[0]
    return ohms * period / 2 * {"buck": 1 - duty, "boost": duty * (1 - duty) ** 2,
                                "buckboost": (1 - duty) ** 2}[shape]


def nodes_of_switch(elements):
    return " ".join(next(e[2] for e in elements if e[0] == "s1"))


def saw(k, period, duty):
    """(card of a carrier that ctl is above for `duty` of the period, its slopes where the switch opens and closes)."""
    if k % 3 == 0:  # trailing edge
        return f"Vtri tri 0 PULSE(0 1 0 {period!r} 0 0 {period!r})\n", duty, 1 / period, None
    if k % 3 == 1:  # leading edge: closes on the falling ramp
        return f"Vtri tri 0 PULSE(1 0 0 {period!r} 0 0 {period!r})\n", duty, None, -1 / period
    half = period / 2
    return (f"Vtri tri 0 PULSE(0 1 0 {half!r} {half!r} 0 {period!r})\n", duty, 1 / half, -1 / half)


def open_loop(continuous):
    for k in range(10):
        shape, period = POWER[k % 5], clock(k, 5e3, 1e6)
        duty = (0.2 + 0.45 * part(k, 1)) * (1.0 if continuous else 0.7)
        volts, ohms = between(3, 400, k, 2), between(0.5, 200, k, 3)
        coil = border(shape, duty, ohms, period) * (3.3 if continuous else 0.21)
        store = between(10, 100, k, 4) * period / ohms
        load = ("iac", "I", ("out", "0"), {}) if k % 4 == 3 else None
        elements = power(shape, volts, ohms, coil, store, load)
        ac = "iac" if load else "vin" if k % 4 == 2 else "vctl"
        carrier, level, opens, closes = saw(k, period, duty)
        controls = (f"Vctl ctl 0 DC {level!r}{' AC 1' if ac == 'vctl' else ''}\n{carrier}"
                    f"E1 cmp 0 ctl tri 1\nS1 {nodes_of_switch(elements)} cmp 0 sm\n{SWITCH}")
        by_control = ac == "vctl"
        ends = {("s1", "off"): ("ramp", opens) if opens and by_control else None,
                ("s1", "on"): ("ramp", closes) if closes and by_control else None}
        yield Case(f"{'ccm' if continuous else 'dcm'}_{k}", elements, controls, ends, ac,
                   ("out", "sw", "l1"), period)


def closed_loop():
    """A buck converter with an OTA and a network of R and C: the control follows the output, and so do the events."""
    for k in range(10):
        period, duty = clock(k, 5e3, 1e6), 0.25 + 0.4 * part(k, 1)
        volts, ohms = between(3, 60, k, 2), between(0.5, 50, k, 3)
        coil, store = ohms * period * between(1, 4, k, 4), between(8, 40, k, 5) * period / ohms
        # crossover about 1/15 of the clock: gain of the modulator times that of the controller, some lead by an ESR
        omega0 = 1 / math.sqrt(coil * store)
        cross = 2 * math.pi / period / between(12, 30, k, 6)
        gain = (cross / omega0) ** 2 / volts / 1.5
        zero = omega0 * 0.4
        esr = 1 / (store * cross * 0.7)
        elements = [("vin", "V", ("in", "0"), {"1": volts}), ("s1", "S", ("in", "sw"), 0.0),
                    ("d1", "D", ("0", "sw"), 0.0), ("l1", "L", ("sw", "out"), coil),
                    ("c1", "C", ("out", "esr"), store), ("re", "R", ("esr", "0"), esr),
                    ("r1", "R", ("out", "0"), ohms), ("vinj", "V", ("out", "fb"), {}),
                    ("vref", "V", ("ref", "0"), {"1": volts * duty}),
                    ("g1", "G", ("0", "ctl", "ref", "fb"), 1e-3), ("rz", "R", ("ctl", "z"), gain / 1e-3),
                    ("cz", "C", ("z", "0"), 1e-3 / gain / zero), ("iac", "I", ("out", "0"), {})]
        ac = ("vinj", "vref", "iac", "vin")[k % 4]
        controls = (f"Vtri tri 0 PULSE(0 1 0 {period!r} 0 0 {period!r})\nE1 cmp 0 ctl tri 1\n"
                    f"S1 in sw cmp 0 sm\n{SWITCH}")
        ends = {("s1", "off"): ("guard", "ctl", -1 / period, 0.0), ("s1", "on"): None}
        yield Case(f"closed_{k}", elements, controls, ends, ac, ("out", "fb", "ctl", "sw", "l1"), period)


def peak_current():
    """The switch is its own latch: a clock closes it, the current above a command and a falling ramp opens it."""
    for k in range(10):
        shape, period = ("buck", "boost", "buckboost", "buck", "boost_esr")[k % 5], clock(k, 5e3, 1e6)
        duty = 0.2 + 0.5 * part(k, 1)
        volts, ohms = between(5, 200, k, 2), between(0.5, 50, k, 3)
        coil = border(shape, duty, ohms, period) * 5
        store = between(10, 60, k, 4) * period / ohms
        ratio = {"buck": duty, "boost": 1 / (1 - duty), "buckboost": -duty / (1 - duty)}[shape.split("_")[0]]
        rise = {"buck": volts * (1 - duty), "boost": volts, "buckboost": volts}[shape.split("_")[0]] / coil
        fall = rise * duty / (1 - duty)
        mean = abs(ratio) * volts / ohms * {"buck": 1.0, "boost": abs(ratio),
                                            "buckboost": 1 + abs(ratio)}[shape.split("_")[0]]
        slope = fall * (0.3 + 0.5 * part(k, 5))  # A/s, of the compensation
        peak = mean + rise * duty * period / 2 + slope * duty * period
        sense = 1.0 / peak  # ohm: 1 V in the end
        load = ("iac", "I", ("out", "0"), {}) if k % 3 == 2 else None
        elements = power(shape, volts, ohms, coil, store, load)
        cut = {"buck": ("sw", "out"), "boost": ("in", "sw"), "buckboost": ("sw", "0")}[shape.split("_")[0]]
        elements = [("l1", "L", ("x", cut[1]), coil) if e[0] == "l1" else e for e in elements]
        elements.append(("vs", "V", (cut[0], "x"), {}))
        ac = "iac" if load else "vin" if k % 3 == 1 else "vc"
        controls = (f"Hs x1 0 vs {-sense!r}\nVc x2 x1 DC {sense * peak!r}{' AC 1' if ac == 'vc' else ''}\n"
                    f"Vramp x3 x2 PULSE(0 {-sense * slope * period!r} 0 {period!r} 0 0 {period!r})\n"
                    f"Vclk cmp x3 PULSE(0 10 0 0 0 {period / 200!r} {period!r})\n"
                    f"S1 {nodes_of_switch(elements)} cmp 0 latch\n.model latch SW(Ron=0 Vt=2.5 Vh=2.5)\n")
        ends = {("s1", "off"): ("guard", "l1", slope, 1 / sense if ac == "vc" else 0.0), ("s1", "on"): None}
        yield Case(f"peak_{k}", elements, controls, ends, ac, ("out", "sw", "l1"), period)


def llc():
    for k in range(10):
        volts, ohms = between(20, 800, k, 1), between(1, 50, k, 2)
        resonance = between(2e4, 5e5, k, 3)
        quality, factor = 0.2 + 0.6 * part(k, 4), 0.7 + 0.7 * part(k, 5)
        coil = quality * ohms * 0.81 / (2 * math.pi * resonance)
        store = 1 / (coil * (2 * math.pi * resonance) ** 2)
        magnet, period = coil * between(3, 8, k, 6), 1 / (factor * resonance)
        ron = ohms / 100
        elements = [("vdc", "V", ("d", "0"), {"1": volts}), ("s1", "S", ("d", "sw"), ron),
                    ("s2", "S", ("sw", "0"), ron), ("lr", "L", ("sw", "r"), coil),
                    ("cr", "C", ("r", "p"), store), ("lm", "L", ("p", "0"), magnet),
                    ("ls1", "L", ("s1n", "0"), magnet), ("ls2", "L", ("0", "s2n"), magnet),
                    ("d1", "D", ("s1n", "out"), ron / 2), ("d2", "D", ("s2n", "out"), ron / 2),
                    ("co", "C", ("out", "0"), 20 * period / ohms), ("ro", "R", ("out", "0"), ohms),
                    ("iac", "I", ("out", "0"), {})]
        controls = (f"Vg g 0 PULSE(1 -1 0 0 0 {period / 2!r} {period!r})\nS1 d sw g 0 sw\nS2 sw 0 0 g sw\n"
                    f".model sw SW(Ron={ron!r} Vt=0)\n")
        couplings = (("lm", "ls1", 0.998), ("lm", "ls2", 0.998), ("ls1", "ls2", 0.998))
        yield Case(f"llc_{k}", elements, controls, {}, "iac" if k % 2 else "vdc",
                   ("out", "ls1") if k % 2 else ("out", "p", "lr"), period,
                   0.0, couplings)


def six_pulse():
    for k in range(10):
        volts, hertz = between(20, 500, k, 1), between(40, 1e3, k, 2)
        ohms = between(1, 100, k, 3)
        line = ohms / hertz * between(1e-4, 1e-2, k, 4)
        coil, store = ohms / hertz * between(0.03, 1, k, 5), between(0.1, 3, k, 6) / hertz / ohms
        elements = []
        for p in range(3):
            turn = math.radians(90.0 - 120 * p - 25.0)  # no commutation at t = 0
            value = {"cos": volts * math.cos(turn), "sin": volts * math.sin(turn)}
            elements += [(f"v{p}", "V", (f"n{p}", "0"), value),
                         (f"r{p}", "R", (f"n{p}", f"b{p}"), ohms / 40) if k % 2 else
                         (f"l{p}", "L", (f"n{p}", f"a{p}"), line),
                         (f"d{p}", "D", (f"b{p}" if k % 2 else f"a{p}", "p"), 0.0),
                         (f"d{p + 3}", "D", ("m", f"b{p}" if k % 2 else f"a{p}"), 0.0)]
        elements += [("vdc", "V", ("p", "q"), {}), ("ld", "L", ("q", "out"), coil),
                     ("cd", "C", ("out", "m"), store), ("rd", "R", ("out", "m"), ohms),
                     ("iac", "I", ("out", "m"), {})]
        yield Case(f"six_pulse_{k}", elements, "", {}, "iac" if k % 3 else "vdc", ("out", "q", "ld"),
                   1 / hertz, 2 * math.pi * hertz)


def parasitic(jumps):
    """Beside the switch a snubber, of time constants down to 1e-5 of the period and resonances up to 100 times the
    clock; or a capacitor alone, which the switch empties at once."""
    for k in range(10):
        shape, period = POWER[k % 5], clock(k, 5e3, 1e6)
        duty = 0.25 + 0.4 * part(k, 1)
        volts, ohms = between(3, 400, k, 2), between(0.5, 200, k, 3)
        coil = border(shape, duty, ohms, period) * (3.3 if k % 2 else 0.4)
        store = between(10, 100, k, 4) * period / ohms
        elements = power(shape, volts, ohms, coil, store, None)
        far = "0" if shape.startswith("boost") else ("fin" if shape == "buck_filter" else "in")
        small = between(1e-3, 3e-2, k, 5) * period / ohms
        if jumps:
            elements.append(("cs", "C", ("sw", far), small))
        else:
            tau = between(1e-5, 1e-2, k, 6) * period
            elements += [("rs", "R", ("sw", "sn"), tau / small), ("cs", "C", ("sn", far), small)]
            if k % 3 == 0:
                elements = [("s1", "S", (e[2][0], "sx") if e[2][1] == "sw" else ("sx", e[2][1]), e[3])
                            if e[0] == "s1" else e for e in elements]
                elements += [("lp", "L", ("sx", "sw"), coil / 3e3), ("rp", "R", ("sx", "sw"), ohms * 3)]
        ac = ("vctl", "vin")[k % 2]
        carrier, level, opens, closes = saw(k, period, duty)
        controls = (f"Vctl ctl 0 DC {level!r}{' AC 1' if ac == 'vctl' else ''}\n{carrier}"
                    f"E1 cmp 0 ctl tri 1\nS1 {nodes_of_switch(elements)} cmp 0 sm\n{SWITCH}")
        by_control = ac == "vctl"
        ends = {("s1", "off"): ("ramp", opens) if opens and by_control else None,
                ("s1", "on"): ("ramp", closes) if closes and by_control else None}
        yield Case(f"{'jumping' if jumps else 'stiff'}_{k}", elements, controls, ends, ac,
                   ("out", "sw", "l1") if jumps else ("out", "sw", "l1", "sn"), period)


KINDS = {"stiff": lambda: parasitic(False), "jumping": lambda: parasitic(True), "ccm": lambda: open_loop(True), "dcm": lambda: open_loop(False), "closed_loop": closed_loop,
         "peak_current": peak_current, "llc": llc, "six_pulse": six_pulse}
