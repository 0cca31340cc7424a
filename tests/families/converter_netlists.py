"""Power converters drawn at random: 36 topologies, whose values and parasitics a seed decides.

Seed s is topology s modulo their number. A seed gives the same netlist for ever, so that it can be cited:
this is why some functions below draw a number that they do not use.
"""

from converter_parts import Circuit

TURN = 6.2832  # 2 pi, with which the netlists began


def buck(circuit):
    circuit.supply()
    circuit.switch(circuit.wire("in"), "sw", circuit.gate(circuit.duty))
    circuit.diode("0", "sw")
    circuit.coil("sw", "out", circuit.inductance, circuit.current * circuit.duty)
    circuit.load(ratio=circuit.duty)


def boost(circuit):
    circuit.supply()
    circuit.coil("in", "sw", circuit.inductance, circuit.current)
    circuit.switch("sw", "0", circuit.gate(circuit.duty))
    circuit.diode("sw", "out")
    circuit.load(ratio=1 / (1 - circuit.duty))


def buck_boost(circuit):
    circuit.supply()
    circuit.switch("in", "sw", circuit.gate(circuit.duty))
    circuit.coil("sw", "0", circuit.inductance)
    circuit.diode("out", "sw")
    circuit.load(ratio=-circuit.duty / (1 - circuit.duty))


def cuk(circuit):
    circuit.supply()
    circuit.coil("in", "a", circuit.inductance)
    circuit.switch("a", "0", circuit.gate(circuit.duty))
    circuit.capacitor("a", "b", circuit.capacitance / 5, circuit.voltage / (1 - circuit.duty))
    circuit.diode("b", "0")
    circuit.coil("b", "out", circuit.inductance * circuit.spread(0.3, 3))
    circuit.load(ratio=-circuit.duty / (1 - circuit.duty))


def sepic(circuit):
    circuit.supply()
    circuit.coil("in", "a", circuit.inductance)
    circuit.switch("a", "0", circuit.gate(circuit.duty))
    circuit.capacitor("a", "b", circuit.capacitance / 5, circuit.voltage)
    circuit.coil("b", "0", circuit.inductance * circuit.spread(0.3, 3))
    circuit.diode("b", "out")
    circuit.load(ratio=circuit.duty / (1 - circuit.duty))


def zeta(circuit):
    circuit.supply()
    circuit.switch("in", "a", circuit.gate(circuit.duty))
    circuit.coil("a", "0", circuit.inductance)
    circuit.capacitor("a", "b", circuit.capacitance / 5,
                      -circuit.voltage * circuit.duty / (1 - circuit.duty))
    circuit.diode("0", "b")
    circuit.coil("b", "out", circuit.inductance)
    circuit.load(ratio=circuit.duty / (1 - circuit.duty))


def sync_buck(circuit):
    circuit.supply()
    circuit.leg(circuit.wire("in"), "0", "sw", circuit.duty)
    circuit.coil("sw", "out", circuit.inductance)
    circuit.load(ratio=circuit.duty)


def half_bridge(circuit):
    circuit.supply()
    circuit.capacitor("in", "mid", circuit.capacitance, circuit.voltage / 2)
    circuit.capacitor("mid", "0", circuit.capacitance, circuit.voltage / 2)
    circuit.leg("in", "0", "a", 0.5)
    circuit.coil("a", "b", circuit.inductance)
    circuit.resistor("b", "mid", circuit.resistance)
    circuit.stray_capacitor("b", "0")


def full_bridge(circuit):
    circuit.supply()
    circuit.leg("in", "0", "a", circuit.duty)
    circuit.leg("in", "0", "b", 1 - circuit.duty, circuit.duty)
    circuit.coil("a", "out", circuit.inductance)
    circuit.load("out", "b", 2 * circuit.duty - 1)


def phase_shifted(circuit):
    circuit.supply()
    circuit.leg("in", "0", "a", 0.5)
    circuit.leg("in", "0", "b", 0.5, circuit.random.uniform(0.05, 0.45))
    circuit.coil("a", "p", circuit.inductance * circuit.spread(0.003, 0.1))
    ratio = circuit.spread(0.1, 3)
    primary = circuit.inductance * circuit.spread(3, 100)
    secondary = primary * ratio ** 2
    circuit.transformer(("p", "b", primary), ("s", "0", secondary), ("0", "t", secondary))
    circuit.diode("s", "x")
    circuit.diode("t", "x")
    circuit.coil("x", "out", circuit.inductance)
    circuit.load(ratio=ratio * 0.5)


def forward(circuit):
    circuit.duty = min(circuit.duty, 0.48)
    circuit.supply()
    primary = circuit.inductance * circuit.spread(3, 100)
    ratio = circuit.spread(0.1, 2)
    circuit.transformer(("in", "sw", primary), ("0", "r", primary), ("s", "0", primary * ratio ** 2))
    circuit.chance(0.5)
    circuit.diode("r0", "in")
    circuit.resistor("r", "r0", circuit.spread(1e-3, 0.1))
    circuit.switch("sw", "0", circuit.gate(circuit.duty))
    circuit.capacitor("sw", "0", circuit.spread(1e-11, 1e-8))
    circuit.diode("s", "x")
    circuit.diode("0", "x")
    circuit.coil("x", "out", circuit.inductance)
    circuit.load(ratio=ratio * circuit.duty)


def flyback(circuit):
    circuit.supply()
    ratio = circuit.spread(0.05, 2)
    circuit.transformer(("in", "sw", circuit.inductance), ("0", "s", circuit.inductance * ratio ** 2))
    circuit.switch("sw", "0", circuit.gate(circuit.duty))
    circuit.diode("s", "out")
    circuit.load(ratio=ratio * circuit.duty / (1 - circuit.duty))
    circuit.diode("sw", "cl")
    circuit.capacitor("cl", "in", circuit.spread(1e-9, 1e-6), circuit.voltage)
    circuit.resistor("cl", "in", circuit.resistance * circuit.spread(1, 100))


def two_switch_forward(circuit):
    circuit.duty = min(circuit.duty, 0.48)
    circuit.supply()
    primary = circuit.inductance * circuit.spread(3, 100)
    ratio = circuit.spread(0.1, 2)
    gate = circuit.gate(circuit.duty)
    circuit.switch("in", "a", gate)
    circuit.switch("b", "0", gate)
    circuit.diode("b", "in")
    circuit.diode("0", "a")
    circuit.transformer(("a", "b", primary), ("s", "0", primary * ratio ** 2))
    circuit.diode("s", "x")
    circuit.diode("0", "x")
    circuit.coil("x", "out", circuit.inductance)
    circuit.load(ratio=ratio * circuit.duty)


def push_pull(circuit):
    circuit.duty = min(circuit.duty, 0.48)
    circuit.supply()
    primary = circuit.inductance * circuit.spread(3, 100)
    ratio = circuit.spread(0.1, 2)
    secondary = primary * ratio ** 2
    circuit.transformer(("in", "a", primary), ("b", "in", primary),
                        ("s", "0", secondary), ("0", "t", secondary))
    circuit.switch("a", "0", circuit.gate(circuit.duty), True)
    circuit.switch("b", "0", circuit.gate(circuit.duty, 0.5), True)
    if circuit.chance(0.5):
        for end in "ab":
            snubber = circuit.node()
            circuit.resistor(end, snubber, circuit.spread(1, 100))
            circuit.card("C", snubber, "0", circuit.spread(1e-11, 1e-8))
    circuit.diode("s", "x")
    circuit.diode("t", "x")
    circuit.coil("x", "out", circuit.inductance)
    circuit.load(ratio=2 * ratio * circuit.duty)


def resonant(circuit, is_llc):
    circuit.supply()
    frequency = circuit.frequency * circuit.spread(0.6, 2)
    impedance = circuit.resistance * circuit.spread(0.1, 3)
    inductance = impedance / (TURN * frequency)
    circuit.leg("in", "0", "a", 0.5)
    circuit.coil("a", "b", inductance)
    circuit.capacitor("b", "p", 1 / (TURN * frequency * impedance), circuit.voltage / 2)
    primary = inductance * (circuit.spread(2, 15) if is_llc else 300)
    ratio = circuit.spread(0.1, 2)
    if is_llc or circuit.chance(0.5):
        secondary = primary * ratio ** 2
        circuit.transformer(("p", "0", primary), ("s", "0", secondary), ("0", "t", secondary))
        circuit.diode("s", "out")
        circuit.diode("t", "out")
        circuit.load(ratio=ratio / 2)
    else:
        circuit.bridge(["p", "0"], "o", "q")
        circuit.load("o", "q", 0.5)


def llc(circuit):
    resonant(circuit, True)


def series_resonant(circuit):
    resonant(circuit, False)


def pfc(circuit):
    circuit.use_mains()
    period = circuit.period / circuit.random.choice([50, 100, 200])
    inductance = circuit.voltage * period / circuit.current * circuit.spread(0.1, 2)
    circuit.sine("a", "b")
    circuit.bridge(["a", "b"], "r", "0")
    circuit.stray_capacitor("a", "0", 0.5)
    if circuit.chance(0.6):
        circuit.capacitor("r", "0", circuit.current / circuit.voltage * period * circuit.spread(0.1, 10))
    circuit.coil("r", "sw", inductance)
    if circuit.chance(0.7):
        circuit.card("C", "sw", "0", circuit.spread(1e-12, 1e-9))
    circuit.switch("sw", "0", circuit.gate(circuit.random.uniform(0.2, 0.7), 0, period))
    circuit.diode("sw", "out")
    circuit.load(ratio=1.3)
    circuit.resistor("a", "0", circuit.resistance * circuit.spread(1e2, 1e4))


def dc_link(circuit):
    circuit.use_mains()
    circuit.sine("a", "b")
    circuit.bridge(["a", "b"], "p", "0")
    circuit.coil("p", "out", circuit.inductance * circuit.spread(0.01, 1))
    circuit.load()
    circuit.resistor("a", "0", circuit.resistance * circuit.spread(1e3, 1e5))
    circuit.stray_capacitor("p", "0")
    circuit.stray_capacitor("a", "0")


def six_pulse(circuit):
    circuit.use_mains()
    for k, phase in enumerate("abc"):
        circuit.sine(phase, "y", -120 * k)
        circuit.stray_capacitor(phase, "0")
    circuit.resistor("y", "0", circuit.resistance * circuit.spread(1e3, 1e5))
    circuit.bridge("abc", "p", "m")
    circuit.resistor("m", "0", circuit.resistance * 100)
    if circuit.chance(0.6):
        circuit.coil("p", "out", circuit.inductance)
    else:
        circuit.resistor("p", "out", circuit.spread(1e-3, 0.1))
    circuit.load("out", "m", 1.6)


def twelve_pulse(circuit):
    circuit.use_mains()
    ratio = circuit.spread(0.3, 3)
    primary = circuit.inductance * 100
    secondary = primary * ratio ** 2
    for k, phase in enumerate("abc"):
        circuit.sine(phase, "0", -120 * k)
    star = "xyz"
    delta = "uvw"
    for k in range(3):
        circuit.transformer(("abc"[k], "q", primary), (star[k], "e", secondary),
                            (delta[k], delta[(k + 1) % 3], 3 * primary * ratio ** 2))
    circuit.resistor("q", "0", circuit.resistance * 1e3)
    circuit.bridge(star, "p", "mid")
    circuit.bridge(delta, "mid", "0")
    circuit.resistor("e", "0", circuit.resistance * 1e3)
    circuit.coil("p", "out", circuit.inductance)
    circuit.load("out", "0", 3.2 * ratio)


def thyristor(circuit):
    circuit.use_mains()
    angle = circuit.random.uniform(0.03, 0.35)
    circuit.sine("a", "b")
    circuit.resistor("b", "0", circuit.resistance * 1e4)
    for k, (anode, cathode) in enumerate([("a", "p"), ("m", "b"), ("b", "p"), ("m", "a")]):
        inner = circuit.node()
        circuit.switch(anode, inner, circuit.gate(0.49 - angle, angle + 0.5 * (k > 1)))
        circuit.diode(inner, cathode)
        if circuit.chance(0.4):
            snubber = circuit.node()
            circuit.resistor(anode, snubber, circuit.spread(1, 1e3))
            circuit.card("C", snubber, cathode, circuit.spread(1e-9, 1e-7))
    circuit.resistor("m", "0", circuit.resistance * 1e3)
    circuit.diode("m", "p")
    circuit.coil("p", "out", circuit.inductance)
    circuit.load("out", "m", 0.4)


def cockcroft_walton(circuit):
    circuit.period *= 10
    circuit.stop *= 3
    circuit.frequency /= 10
    stages = circuit.random.randint(1, 4)
    circuit.sine("a0", "0")
    last = "0"
    for k in range(1, stages + 1):
        pump, level = f"a{k}", f"b{k}"
        circuit.capacitor(f"a{k - 1}", pump, circuit.capacitance)
        circuit.diode(last, pump)
        circuit.diode(pump, level)
        circuit.capacitor(last, level, circuit.capacitance)
        last = level
        if circuit.chance(0.5):
            circuit.card("C", pump, "0", circuit.spread(1e-12, 1e-9))
    circuit.resistor(last, "0", circuit.resistance * circuit.spread(3, 1000))


def doubler(circuit):
    circuit.use_mains()
    circuit.sine("a", "0")
    circuit.diode("a", "p")
    circuit.diode("m", "a")
    circuit.capacitor("p", "0", circuit.capacitance, circuit.voltage)
    circuit.capacitor("0", "m", circuit.capacitance, circuit.voltage)
    circuit.resistor("p", "m", circuit.resistance)
    circuit.stray_capacitor("a", "0")
    circuit.stray_capacitor("p", "m")


def charge_pump(circuit):
    circuit.supply()
    gates = circuit.gate(0.48), circuit.gate(0.48, 0.5)
    last = "in"
    for k in range(circuit.random.randint(1, 3)):
        top, bottom = f"a{k}", f"b{k}"
        circuit.switch("in", bottom, gates[1 - k % 2])
        circuit.switch(bottom, "0", gates[k % 2])
        circuit.diode(last, top)
        circuit.capacitor(top, bottom, circuit.capacitance)
        last = top
    circuit.diode(last, "out")
    circuit.load(ratio=1.5)


def totem_pole(circuit):
    circuit.use_mains()
    period = circuit.period / circuit.random.choice([50, 100])
    inductance = circuit.voltage * period / circuit.current * circuit.spread(0.1, 2)
    circuit.sine("a", "b")
    circuit.coil("a", "x", inductance)
    circuit.leg("p", "0", "x", circuit.random.uniform(0.4, 0.8), 0, period)
    circuit.bridge(["b"], "p", "0")
    circuit.resistor("b", "0", circuit.resistance * circuit.spread(1e2, 1e4))
    circuit.load("p", "0", 1.5)


def interleaved(circuit):
    circuit.supply()
    phases = circuit.random.randint(2, 4)
    for k in range(phases):
        circuit.coil("in", f"x{k}", circuit.inductance)
        circuit.switch(f"x{k}", "0", circuit.gate(circuit.duty, k / phases))
        circuit.diode(f"x{k}", "out")
    circuit.load(ratio=1 / (1 - circuit.duty))


def npc(circuit):
    circuit.supply("p")
    circuit.capacitor("p", "o", circuit.capacitance, circuit.voltage / 2)
    circuit.capacitor("o", "0", circuit.capacitance, circuit.voltage / 2)
    duty = min(circuit.duty, 0.45)
    inner = 1 - duty - 0.02
    gates = [circuit.gate(duty), circuit.gate(inner, -0.5 * (1 - 2 * duty) + 0.01),
             circuit.gate(inner, duty + 0.01), circuit.gate(duty, 0.5)]
    for pair, gate in zip(["pu", "ux", "xw", "w0"], gates):
        circuit.switch(pair[0], pair[1], gate, True)
    circuit.diode("o", "u")
    circuit.diode("w", "o")
    circuit.coil("x", "y", circuit.inductance)
    circuit.resistor("y", "o", circuit.resistance)
    circuit.stray_capacitor("y", "0")


def vienna(circuit):
    circuit.use_mains()
    period = circuit.period / circuit.random.choice([20, 40])
    inductance = circuit.voltage * period / circuit.current * circuit.spread(0.3, 3)
    for k, phase in enumerate("abc"):
        inner = f"x{phase}"
        circuit.sine(phase, "y", -120 * k)
        circuit.coil(phase, inner, inductance)
        circuit.diode(inner, "p")
        circuit.diode("m", inner)
        name = circuit.node()
        plus, minus = f"{name}p", f"{name}m"
        circuit.diode(inner, plus)
        circuit.diode(minus, inner)
        circuit.diode("o", plus)
        circuit.diode(minus, "o")
        circuit.switch(plus, minus, circuit.gate(circuit.random.uniform(0.2, 0.6), k / 3, period))
    circuit.resistor("y", "0", circuit.resistance * 1e3)
    circuit.resistor("o", "0", circuit.resistance * 1e3)
    circuit.load("p", "o", 1.2)
    circuit.load("o", "m", 1.2)


def current_doubler(circuit):
    circuit.supply()
    circuit.leg("in", "0", "a", 0.5)
    circuit.leg("in", "0", "b", 0.5, circuit.random.uniform(0.1, 0.5))
    primary = circuit.inductance * circuit.spread(3, 100)
    ratio = circuit.spread(0.1, 2)
    circuit.transformer(("a", "b", primary), ("s", "t", primary * ratio ** 2))
    circuit.resistor("a", "b", circuit.resistance * 1e3)
    circuit.diode("0", "s")
    circuit.diode("0", "t")
    circuit.coil("s", "out", circuit.inductance)
    circuit.coil("t", "out", circuit.inductance)
    circuit.load(ratio=ratio * 0.3)


def diode_matrix(circuit):
    circuit.use_mains()
    circuit.sine("a", "0")
    for k in range(circuit.random.randint(2, 5)):
        anode, cathode = f"q{k}", f"w{k}"
        if circuit.chance(0.5):
            circuit.resistor("a", anode, circuit.spread(1e-3, 1))
        else:
            circuit.card("L", "a", anode, circuit.spread(1e-8, 1e-4))
        circuit.diode(anode, cathode)
        if circuit.chance(0.5):
            circuit.diode(anode, cathode)
        if circuit.chance(0.7):
            circuit.resistor(cathode, "out", circuit.spread(1e-4, 1))
        else:
            circuit.diode(cathode, "out")
        circuit.resistor(anode, "out", circuit.resistance * circuit.spread(1e2, 1e6))
        circuit.stray_capacitor(anode, cathode)
    circuit.load()


def snubbers(circuit):
    circuit.supply()
    circuit.coil("in", "sw", circuit.inductance)
    circuit.switch("sw", "0", circuit.gate(circuit.duty))
    circuit.diode("sw", "out")
    circuit.load(ratio=1 / (1 - circuit.duty))
    capacitance = circuit.current * circuit.period / circuit.voltage * circuit.spread(1e-4, 0.1)
    if circuit.chance(0.6):
        circuit.diode("sw", "d")
        circuit.resistor("sw", "d", circuit.spread(1, 1e3))
        circuit.capacitor("d", "0", capacitance)
    if circuit.chance(0.6):
        circuit.resistor("sw", "e", circuit.spread(0.1, 100))
        circuit.capacitor("e", "0", capacitance)
    if circuit.chance(0.5):
        circuit.diode("sw", "h")
        circuit.capacitor("h", "0", capacitance * 100, circuit.voltage)
        circuit.resistor("h", "out", circuit.spread(10, 1e4))


def peak_chain(circuit):
    circuit.use_mains()
    circuit.sine("a", "0")
    last = "a"
    for k in range(circuit.random.randint(2, 6)):
        node = f"q{k}"
        circuit.chance(0.5)
        circuit.diode(last, node)
        circuit.capacitor(node, "0", circuit.capacitance * circuit.spread(1e-3, 1))
        circuit.resistor(node, "0", circuit.resistance * circuit.spread(1, 1e4))
        last = node
        if circuit.chance(0.5):
            last = f"{node}r"
            circuit.resistor(node, last, circuit.resistance * circuit.spread(1e-3, 1))


def motor_leg(circuit):
    circuit.supply()
    circuit.leg("in", "0", "x", circuit.duty)
    circuit.coil("x", "m", circuit.inductance * circuit.spread(1, 30))
    circuit.resistor("m", "e", circuit.resistance)
    circuit.source("e", "0", f"{circuit.voltage * circuit.random.uniform(0, 0.8):.4g}")
    circuit.stray_capacitor("x", "0")


def stiff_input(circuit):
    circuit.supply(resistance=0.001)
    circuit.leg(circuit.wire("in"), "0", "sw", circuit.duty)
    circuit.coil("sw", "out", circuit.inductance)
    circuit.load(ratio=circuit.duty)


def three_phase_inverter(circuit):
    circuit.supply()
    for k, phase in enumerate("abc"):
        circuit.leg("in", "0", phase, circuit.random.uniform(0.2, 0.8), k / 3)
        circuit.coil(phase, f"r{phase}", circuit.inductance)
        circuit.resistor(f"r{phase}", "y", circuit.resistance)
    circuit.stray_capacitor("y", "0")


def inductive_capacitors(circuit):
    circuit.parasitics = 0.35
    circuit.supply()
    circuit.coil("in", "sw", circuit.inductance)
    circuit.switch("sw", "0", circuit.gate(circuit.duty))
    circuit.diode("sw", "o")
    for _ in range(circuit.random.randint(2, 4)):
        inner = circuit.node()
        circuit.card("L", "o", inner, circuit.spread(1e-9, 2e-8))
        plate = circuit.node()
        circuit.resistor(inner, plate, circuit.spread(1e-4, 0.1))
        circuit.card("C", plate, "0", circuit.capacitance * circuit.spread(0.01, 1),
                     circuit.initial(circuit.voltage))
    circuit.resistor("o", "0", circuit.resistance)


TOPOLOGIES = [buck, boost, buck_boost, cuk, sepic, zeta, sync_buck, half_bridge, full_bridge, phase_shifted,
              forward, flyback, two_switch_forward, push_pull, llc, series_resonant, pfc, dc_link, six_pulse,
              twelve_pulse, thyristor, cockcroft_walton, doubler, charge_pump, totem_pole, interleaved, npc,
              vienna, current_doubler, diode_matrix, snubbers, peak_chain, motor_leg, stiff_input,
              three_phase_inverter, inductive_capacitors]


def topology(seed):
    """The name of what a seed makes."""
    return TOPOLOGIES[seed % len(TOPOLOGIES)].__name__


def netlist(seed):
    circuit = Circuit(seed)
    TOPOLOGIES[seed % len(TOPOLOGIES)](circuit)
    return circuit.text(f"{topology(seed)}, seed {seed} of converters.py")
