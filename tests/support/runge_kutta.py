"""The classic method of order 4 of Runge and Kutta, for references of tests."""


def step(rates, t, x, h):
    """The states at t + h from those at t, x; rates(t, x): their derivatives."""
    a = rates(t, x)
    b = rates(t + h / 2, [y + h / 2 * k for y, k in zip(x, a)])
    c = rates(t + h / 2, [y + h / 2 * k for y, k in zip(x, b)])
    d = rates(t + h, [y + h * k for y, k in zip(x, c)])
    return [y + h / 6 * (p + 2 * q + 2 * r + s) for y, p, q, r, s in zip(x, a, b, c, d)]
