"""Blocks of control for the equations of converters."""


def limit(v, low, high):
    return low if v < low else high if v > high else v


class PI:
    """kp e + x within limits, x' = ki e within the same: as `pi` of control.lib. `held` is 1 or -1 where x rests at its
    upper or lower limit, else 0."""

    def __init__(self, kp, ki, low, high, ic=0.0):
        self.kp, self.ki, self.low, self.high, self.ic = kp, ki, low, high, ic

    def card(self, name, nodes):
        return f"x{name} {nodes} pi kp={self.kp!r} ki={self.ki!r} low={self.low!r} high={self.high!r} ic={self.ic!r}\n"

    def output(self, e, x):
        return limit(self.kp * e + x, self.low, self.high)

    def rate(self, e, held):
        return 0.0 if held else self.ki * e

    def guards(self, e, x, held):
        """Two of them."""
        e *= self.ki
        return [-e, -1.0] if held > 0 else [e, -1.0] if held < 0 else [x - self.high, self.low - x]

    def ends(self, x, place, held, which):
        """What of guard `which`: held, and x with x[place] on the limit that it has come to."""
        if held:
            return 0, x
        x = list(x)
        x[place] = self.low if which else self.high
        return 1 - 2 * which, x
