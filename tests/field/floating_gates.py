#!/usr/bin/env python3
"""High-side gates: sources between floating nodes that command switches, at a node that a coil kicks to millions of volts.

usage: floating_gates.py PROGRAM

The voltage between two nodes that a chain of sources joins is known whatever the voltages of the nodes are. So each
circuit must give what the same circuit gives with its gates referred to ground.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

NEAR = 1e-9
IN_LARGE = 1e-7  # a part with a cable is held to 1e-6
POINTS = 60

# A gate's sources between g and s. The value is a pulse of `offset` and `scale`.
WAYS = {
    "a source": "vg{k} g{k} {s} {one}\n",
    "upside down": "vg{k} {s} g{k} {minus}\n",
    "two in series": "vh{k} h{k} {s} -0.25\nvg{k} g{k} h{k} {above}\nrh{k} g{k} h{k} 1k\n",
    "an E from ground": "vq{k} q{k} 0 {one}\neg{k} g{k} {s} q{k} 0 1\n",
    "an E from a floating source": "vf{k} f{k} {s} {half}\nrf{k} f{k} {s} 1k\neg{k} g{k} {s} f{k} {s} 2\n",
    "an E written before its source": "eg{k} g{k} {s} f{k} b{k} 2\nvf{k} f{k} b{k} {half}\nrf{k} b{k} {s} 1k\n",
    "below a supply": "vb{k} b{k} {s} 15\nvg{k} b{k} g{k} {below}\nrb{k} b{k} {s} 1k\n",
}
GROUND = "vg{k} g{k} 0 {one}\n"


class Clock:
    """Gate k of a circuit: clocks without a common period, ramps of two lengths."""

    def __init__(self, k, period):
        own = period * (1.0 + 0.271 * k)
        self.shape = f"{0.07 * own * (k + 1)!r} {0.01 * own!r} {0.02 * own!r} {0.37 * own!r} {own!r}"

    def pulse(self, offset, scale):
        return f"pulse({offset!r} {offset + scale!r} {self.shape})"


def gate(way, k, s, period):
    clock = Clock(k, period)
    text = (GROUND if way is None else WAYS[way]).format(
        k=k, s=s, one=clock.pulse(0.0, 1.0), minus=clock.pulse(0.0, -1.0), half=clock.pulse(0.0, 0.5),
        above=clock.pulse(0.25, 1.0), below=clock.pulse(15.0, -1.0))
    return text, f"g{k} {'0' if way is None else s}"


def legs(way, n, volts, ohms, period, kick):
    """Switches side by side from a supply to a coil, none of which leaves the coil a way when all are open."""
    cards = [f"vin in 0 {volts!r}\nll sw out {3.0 * ohms * period!r}\nrl out 0 {ohms!r}\n"
             f".model sm sw(ron={1e-3 * ohms!r} roff={kick / volts * ohms!r} vt=0.5)\n"]
    for k in range(n):
        sources, control = gate(way, k, "sw", period)
        cards.append(f"r{k} in a{k} {ohms * (k + 1)!r}\ns{k} a{k} sw {control} sm\n{sources}")
    return "".join(cards), ["v(out)"] + [f"i(s{k})" for k in range(n)]


def half_bridge(way, n, volts, ohms, period, kick):
    """Each leg has a switch on either side, so that the gate of the upper one floats with the output."""
    cards = [f"vin in 0 {volts!r}\n.model sm sw(ron={1e-3 * ohms!r} roff={kick / volts * ohms!r} vt=0.5)\n"]
    for k in range(n):
        sources, control = gate(way, 2 * k, f"m{k}", period)
        lower, lower_control = gate(None, 2 * k + 1, "0", period)
        cards.append(f"s{k}h in m{k} {control} sm\nd{k} 0 m{k} dm\nr{k} m{k} a{k} {ohms!r}\n"
                     f"s{k}l a{k} x{k} {lower_control} sm\nl{k} x{k} com {2.0 * ohms * period!r}\n{sources}{lower}")
    cards.append(f"rc com 0 {ohms!r}\n.model dm d(ron={1e-3 * ohms!r})\n")
    return "".join(cards), ["v(com)"] + [f"i(l{k})" for k in range(n)]


def stacked(way, n, volts, ohms, period, kick):
    """Switches in series, each with its gate at its own lower node, and a resistor that lets each leave the chain."""
    cards = [f"vin n0 0 {volts!r}\n.model sm sw(ron={1e-3 * ohms!r} roff={kick / volts * ohms!r} vt=0.5)\n"]
    for k in range(n):
        sources, control = gate(way, k, f"n{k + 1}", period)
        cards.append(f"s{k} n{k} n{k + 1} {control} sm\nr{k} n{k} n{k + 1} {ohms * (5 + k)!r}\n{sources}")
    cards.append(f"ll n{n} out {5.0 * ohms * period!r}\nrl out 0 {ohms!r}\nlk out kk {ohms * period!r}\n"
                 f"sk kk 0 gk 0 sm\nvk gk 0 {Clock(n, period).pulse(0.0, 1.0)}\n")
    return "".join(cards), ["v(out)", "i(ll)", "i(lk)"]


CIRCUITS = (legs, half_bridge, stacked)
SIZES = ((100.0, 1.0, 1e-5, 1e8), (600.0, 47.0, 1e-3, 3e10), (3.3, 1e3, 1e-7, 1e7), (24.0, 0.1, 2e-5, 1e10))
COUNTS = (2, 3, 5)


def netlist(name, circuit, way, n, size, cable):
    cards, signals = circuit(way, n, *size)
    for k in range(cable):   # a reader that makes the part large
        cards += f"rw{k} {'in' if k == 0 and circuit is not stacked else 'n0' if k == 0 else f'w{k - 1}'} w{k} 1k\n" \
                 f"cw{k} w{k} 0 1p\n"
    return f"{name}\n{cards}", signals


def nearness(n, cable):
    """Of maps; a cable, or five legs, make a part that is solved on factors."""
    return IN_LARGE if cable or n == max(COUNTS) else NEAR


class Gates(Checker):
    def look_at(self, circuit, way, n, size, cable):
        name = f"{circuit.__name__}, {way}, {n} gates, {size[0]:g} V, kick of {size[3]:g} V, {cable} sections"
        stop = 17.3 * size[2]
        times = [stop * (k + 0.37) / POINTS for k in range(POINTS)]
        values = []
        for of in (way, None):
            text, signals = netlist(name, circuit, of, n, size, cable)
            done = run(sys.argv[1], f"{text}.tran {stop / 10!r} {stop!r} uic\n.end\n", at=times, method=None)
            if not self.check(done.status == 0, f"{name}: {done.stderr}"):
                return
            values.append([done.column(s) for s in signals])
        for signal, found, wanted in zip(signals, *values):
            scale = max(map(abs, wanted))
            off = max(abs(f - w) for f, w in zip(found, wanted)) / scale
            self.check(len(found) == len(wanted) and off <= nearness(n, cable), f"{name}: {signal} is off by {off:.2g}")


def main():
    gates = Gates("floating_gates")
    cases = [(c, way, n, size, cable) for c in CIRCUITS for way in WAYS for n in COUNTS for size in SIZES
             for cable in (0, 60)]
    for case in some_of(cases[2::5]):
        gates.look_at(*case)
    return gates.finish()


if __name__ == "__main__":
    sys.exit(main())
