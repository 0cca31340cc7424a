#!/usr/bin/env python3
"""Gates that open and close switches while another switch slides along its threshold.

usage: commands_while_sliding.py PROGRAM

A current limit without hysteresis holds the current of a coil. Where a source moves other switches beside it, the current
stays, and what these switches do with it has closed forms. What takes its supply away ends the slide.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SIZES = (("volts", 12.0, 2.0, 1e-5), ("kilovolts", 5e3, 800.0, 1e-3), ("microvolts", 5e-6, 1e-9, 1e-8))
SLIDES = "v1 a 0 {volts!r}\ns1 p x 0 m sw\nd1 0 x d\nl1 x y {henry!r} ic={ampere!r}\nvs y o 0\nh1 m 0 vs 1\n" \
         ".model d d(ron=0)\n.model sw sw(vt={limit!r} ron=0)\n.model sg sw(vt=0.5 ron={ron!r})\n"


def edges(report, element):
    return sum(e["element"] == element for e in report["events"])


class Commands(Checker):
    def sliding(self, name, size, cards, moved, wanted, stop=10.05):
        """A period of the gates is the size's time; moved: element -> how often, wanted: what to measure -> value."""
        _, volts, ampere, period = size
        values = {"volts": volts, "ampere": ampere, "limit": -ampere, "henry": 0.1 * volts * period / ampere,
                  "ron": 1e-4 * volts / ampere}
        lines = [f"{name}, {size[0]}", *SLIDES.format(**values).splitlines(), *cards.format(**values).splitlines(),
                 f".tran {period!r} {stop * period!r} uic", *(f".meas tran m{k} {what}" for k, what in enumerate(wanted)), ".end", ""]
        outcome = run(sys.argv[1], "\n".join(lines), method=None, options=("--audit", "full"))
        if not self.check(outcome.status == 0, f"{lines[0]}: {outcome.stderr}"):
            return
        for element, n in moved.items():
            self.check(edges(outcome.report, element) == n, f"{lines[0]}: {edges(outcome.report, element)} events of {element}")
        for m, (what, value) in zip(outcome.report["measurements"], wanted.items()):
            self.close(m.get("value", math.nan), value, 1e-8 * max(abs(value), 1e-3 * ampere), f"{lines[0]}: {what}")


def gate(name, period, delay=0.25, width=0.5):
    return f"v{name} {name} 0 pulse(0 1 {delay * period!r} 0 0 {width * period!r} {period!r})\n"


def load_changes(c, size):
    """0.3 ohm of the unit, and 0.6 besides for half of the time: the current stays, and so does all that it heats."""
    _, volts, ampere, period = size
    both = 0.3 * (0.6 + 1e-4) / (0.9 + 1e-4) * volts
    c.sliding("a second load", size, f"r0 a p {{ron!r}}\nr1 o 0 {0.3 * volts / ampere!r}\ns2 o q g 0 sg\n"
              f"r2 q 0 {0.6 * volts / ampere!r}\n" + gate("g", period), {"s2": 20}, {
                  f"MAX i(l1) FROM={period!r}": ampere, f"MIN i(l1) FROM={period!r}": ampere,
                  f"AVG v(o) FROM={period!r} TO={10 * period!r}": 0.5 * (both + 0.3 * volts)})


def two_gates(c, size):
    """Two resistors in series with a switch across each, clocks of 1 and 1/3 periods."""
    _, volts, ampere, period = size
    short = 0.3 * 1e-4 / (0.3 + 1e-4) * volts
    c.sliding("resistors that are shorted", size, f"r0 a p {{ron!r}}\nr1 o q {0.3 * volts / ampere!r}\ns2 o q g 0 sg\n"
              f"r2 q 0 {0.3 * volts / ampere!r}\ns3 q 0 k 0 sg\nr9 k 0 1k\n"
              + gate("g", period) + gate("k", period / 3, 0.5, 0.25), {"s2": 20, "s3": 60}, {
                  f"MAX i(l1) FROM={period!r}": ampere, f"MIN i(l1) FROM={period!r}": ampere,
                  f"AVG v(o) FROM={period!r} TO={10 * period!r}": 0.5 * (short + 0.3 * volts) + 0.25 * short + 0.225 * volts})


def supply_fails(c, size):
    """A main switch opens for a quarter of each period: the current falls behind it, rises again and slides on."""
    _, volts, ampere, period = size
    ohm, henry = 0.3 * volts / ampere, 0.1 * volts * period / ampere
    least = ampere * math.exp(-0.25 * period * ohm / henry)
    c.sliding("a main switch", size, f"s2 a p g 0 sg on\nr1 o 0 {ohm!r}\n"
              f"vg g 0 pulse(1 0 {0.25 * period!r} 0 0 {0.25 * period!r} {period!r})\n", {"s2": 20}, {
                  f"MIN i(l1) FROM={0.1 * period!r}": least, "MAX i(l1)": ampere,
                  f"AVG i(l1) FROM={4.2 * period!r} TO={4.25 * period!r}": ampere})


def main():
    c = Commands("commands_while_sliding")
    for size in some_of(SIZES):
        load_changes(c, size)
        two_gates(c, size)
        supply_fails(c, size)
    return c.finish()


if __name__ == "__main__":
    sys.exit(main())
