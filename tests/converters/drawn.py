"""Values of converters drawn at random, a row for each kind as the lists of cases have them."""


def spread(rng, low, high):
    """As likely in one decade as in another."""
    return low * (high / low) ** rng.random()


def six_pulse(rng):
    volts, hertz = spread(rng, 20, 2e4), spread(rng, 16, 1e3)
    ohms = spread(rng, 0.5, 50)
    turn = 6.283185307179586 * hertz
    line = spread(rng, 0.002, 0.08) * ohms / turn
    alpha = rng.uniform(5, 125)
    battery = -rng.uniform(0.7, 1.3) * volts if alpha > 85 else rng.choice([0, rng.uniform(0, 0.8) * volts])
    return volts, hertz, alpha, line, spread(rng, 0.2, 20) * ohms / turn, ohms, battery, rng.uniform(65, 118), rng.randint(2, 6)


def ac_controller(rng):
    volts, hertz, ohms = spread(rng, 5, 2e4), spread(rng, 16, 2e3), spread(rng, 0.5, 200)
    return volts, hertz, rng.uniform(20, 170), spread(rng, 0.05, 20) * ohms / 6.28 / hertz, ohms, \
        rng.uniform(1, 110), rng.randint(3, 8)


def gto_inverter(rng):
    volts, hertz, ohms = spread(rng, 12, 5e3), spread(rng, 20, 5e3), spread(rng, 0.5, 50)
    turn = 6.283185307179586 * hertz
    return volts, hertz, rng.uniform(25, 180), rng.uniform(0.5, 15), spread(rng, 0.2, 5) * ohms / turn, \
        rng.choice([1, 1 / (spread(rng, 0.2, 5) * ohms * turn)]), ohms, rng.randint(3, 7)


def peak_current(rng):
    duty = rng.uniform(0.15, 0.75)
    return spread(rng, 3, 800), spread(rng, 500, 2e6), duty, spread(rng, 0.1, 4), spread(rng, 0.2, 100), \
        rng.uniform(0.3, 0.6) if duty > 0.45 else rng.choice([0, 0.2]), rng.randint(30, 80)


def power_factor(rng):
    volts, hertz = spread(rng, 12, 1e3), spread(rng, 16, 500)
    return volts, hertz, volts * rng.uniform(1.15, 2.5), spread(rng, 10, 1e4), hertz * rng.uniform(150, 500), \
        rng.uniform(1.2, 3)


def charger(rng):
    volts = spread(rng, 5, 1e3)
    return volts, volts * rng.uniform(0.3, 0.85), spread(rng, 0.1, 200), spread(rng, 2e3, 2e6), rng.randint(150, 300)


def forward(rng):
    reset = rng.uniform(0.7, 1.6)
    return spread(rng, 5, 1e3), spread(rng, 1e3, 1e6), spread(rng, 0.05, 5), reset, rng.uniform(0.3, 0.6), \
        spread(rng, 0.1, 50), rng.choice([1, 1, rng.uniform(3, 40)]), rng.randint(30, 60)


def llc(rng):
    volts, wanted = spread(rng, 12, 1e3), spread(rng, 3, 500)
    return volts, spread(rng, 2e4, 2e6), wanted, spread(rng, 5, 1e4), rng.uniform(0.2, 0.7), rng.randint(40, 80)


def svpwm(rng):
    hertz = spread(rng, 10, 500)
    return spread(rng, 24, 5e3), hertz, hertz * rng.uniform(45, 120), spread(rng, 1, 500), rng.uniform(0.3, 0.85), \
        rng.uniform(0.5, 1.2)


def active_rectifier(rng):
    peak, hertz = spread(rng, 20, 5e3), spread(rng, 16, 500)
    return peak, hertz, peak * rng.uniform(1.95, 3), spread(rng, 50, 1e5), hertz * rng.uniform(60, 140), \
        rng.uniform(-2.2, 2.2), rng.uniform(0.3, 0.6)


def machine(rng):
    hertz = spread(rng, 15, 300)
    depth = rng.choice([None, rng.uniform(0.4, 0.98)])
    return spread(rng, 24, 5e3), hertz, spread(rng, 100, 1e6), rng.randint(1, 4), depth, \
        depth and hertz * rng.uniform(15, 60), rng.randint(2, 5)
