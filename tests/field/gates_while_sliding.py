#!/usr/bin/env python3
"""Gates that drive a circuit in which a switch slides along its threshold: energies.

usage: gates_while_sliding.py PROGRAM

A current limit without hysteresis holds the current of a coil, so that all but the switch and its diode has one current and
one voltage from edge to edge of the gates. An output of a gate ends the segment at its own time, and that segment, which was
made further, counts up to there, once. What sources give and resistors take has closed forms, or follows from means, which
are exact where one factor of a product is constant.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SIZES = (("volts", 10.0, 1.0, 1e-6), ("kilovolts", 4e3, 250.0, 1e-4), ("millivolts", 5e-3, 2e-4, 1e-8))
LIMIT = "v1 a 0 {volt!r}\ns1 a x 0 m sw\nd1 0 x d\nl1 x y {henry!r} ic={ampere!r}\nvs y o 0\nh1 m 0 vs 1\n" \
        ".model d d(ron=0)\n.model sw sw(vt={limit!r} ron={ron!r} roff={roff!r})\n"
LOAD = "r1 o q {r02!r}\nr2 q 0 {r01!r}\n"
ON = 0.05  # ohm, over that of the size


class Gates(Checker):
    def energies(self, name, size, cards, wanted, measured=(), stop=200):
        """wanted: what sources give and resistors take, from the values of `measured`, in volts times amperes times times."""
        title, volt, ampere, time = size
        ohm = volt / ampere
        values = {"volt": volt, "ampere": ampere, "limit": -ampere, "high": 0.1 * volt,
                  "henry": 100 * ohm * time, "ron": ON * ohm, "roff": 1e9 * ohm, "r01": 0.1 * ohm,
                  "r02": 0.2 * ohm, "r05": 0.5 * ohm, "farad": 5 * time / ohm}
        lines = [f"{name}, {title}", *cards.format(**values).splitlines(), f".tran {time!r} {stop * time!r} uic",
                 *(f".meas tran m{k} INTEG {what}" for k, what in enumerate(measured)), ".end", ""]
        outcome = run(sys.argv[1], "\n".join(lines), method=None)
        if not self.check(outcome.status == 0, f"{lines[0]}: {outcome.stderr}"):
            return
        unit = volt * ampere * time
        energy = outcome.report["energy"]
        integrals = [m["value"] / unit for m in outcome.report["measurements"]]
        for what, value in zip(("sources", "resistors"), wanted(*integrals)):
            self.close(energy[what] / unit, value, 1e-8 * value, f"{lines[0]}: {what}")
        self.close(energy["balance"] / unit, 0.0, 1e-9 * wanted(*integrals)[0], f"{lines[0]}: balance")


def clock(time, rise=13.0, width=17.0, period=41.0):
    return f"vc c 0 pulse(0 {{high!r}} {rise * time!r} 0 0 {width * time!r} {period * time!r})\n"


def buffer(name, source, output, delay):
    return f"a{name} {source} 0 0 0 0 0 {output} 0 BUF Vhigh={{high!r}} Td={delay!r}\n"


def time_high(delay, rise=13.0, width=17.0, period=41.0, stop=200.0):
    return sum(max(0.0, min(at + width, stop) - at) for at in (rise + delay + period * k for k in range(5)))


def current_of_a_gate(c, size):
    """Half of the ampere is drawn between the resistors while the gate is high; the source that draws it takes 0.025."""
    high = time_high(3.0)
    low = 200.0 - high
    on = (0.3 * low + 0.25 * high) / (1.0 - ON)
    c.energies("a gate that draws current", size, LIMIT + LOAD + clock(size[3]) + buffer(1, "c", "g", 3 * size[3])
               + "b1 q 0 i=5*v(g)/{volt!r}*{ampere!r}\n",
               lambda: (on - 0.025 * high, 0.3 * low + 0.225 * high + ON * on))


def switch_of_a_gate(c, size):
    """A resistor as large as the one below is put beside it."""
    high = time_high(3.0)
    taken = 0.3 * (200.0 - high) + 0.25 * high
    on = taken / (1.0 - ON)
    c.energies("a gate that closes a switch", size, LIMIT + LOAD + clock(size[3]) + buffer(1, "c", "g", 3 * size[3])
               + "sg q 0 g 0 sg\n.model sg sw(vt=%r ron={r01!r} roff={roff!r})\n" % (0.05 * size[1]),
               lambda: (on, taken + ON * on))


def gates_that_feed(c, size):
    """Two gates with delays of their own feed the load: what they give, and what the switch does."""
    c.energies("gates that feed", size, LIMIT + LOAD + clock(size[3]) + buffer(1, "c", "g", 3 * size[3])
               + buffer(2, "g", "h", 7.7 * size[3]) + "rg g q {r05!r}\nrh h o {r05!r}\n",
               lambda a, g, h: (g + h - a, g + h - a), ("v(a)*i(v1)", "v(g)*i(rg)", "v(h)*i(rh)"))


RING = "a1 h 0 0 0 0 g 0 0 INV Vhigh={{high!r}} Td={0!r}\na2 g 0 0 0 0 0 h 0 BUF Vhigh={{high!r}} Td={1!r}\n" \
       "rg g q {{r05!r}}\nrh h o {{r05!r}}\n"


def ring_of_gates(c, size):
    """A ring of gates feeds the load."""
    c.energies("a ring", size, LIMIT + LOAD + RING.format(3.3 * size[3], 2.1 * size[3]), lambda a, g, h: (g + h - a, g + h - a),
               ("v(a)*i(v1)", "v(g)*i(rg)", "v(h)*i(rh)"))


def gate_that_reads(c, size):
    """A gate reads the capacitor that the load charges, and feeds the load: its segment begins anew at that instant."""
    c.energies("a gate that reads", size, LIMIT + LOAD + "rc q p {r05!r}\ncp p 0 {farad!r}\nrg g q {r05!r}\n"
               + "a1 p 0 0 0 0 0 g 0 SCHMITT Vhigh={high!r} Vt=%r Vh=%r\n" % (0.06 * size[1], 0.01 * size[1]),
               lambda a, g: (g - a,), ("v(a)*i(v1)", "v(g)*i(rg)"))


def main():
    c = Gates("gates_while_sliding")
    for size in some_of(SIZES):
        current_of_a_gate(c, size)
        switch_of_a_gate(c, size)
        gates_that_feed(c, size)
        ring_of_gates(c, size)
        gate_that_reads(c, size)
    return c.finish()


if __name__ == "__main__":
    sys.exit(main())
