#!/usr/bin/env python3
"""Sources that only read change nothing of what they read.

usage: readers.py PROGRAM

Each circuit is run as it is and with readers of several kinds: voltages of nodes by E, by G into a resistor and by B,
currents by H and F, and a chain of these. What was there before must be there after, event by event and at each time.
Most of these circuits were refused with a reader, or lost digits.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

# name, cards, stop, nodes that are read, and a source whose current is read (None: there is none)
CIRCUITS = [
    ("a coil that its diode cuts off", "l1 n m 20u ic=4\nd1 m 0\nr1 n f 0.8", "20u", ["f", "f"], None),
    ("an open winding that floats",
     "v1 in 0 20\nl1 in 0 20u ic=0\nl2 0 a 80u ic=0\nl3 b c 77u ic=0\nk1 l1 l2 0.999999\nk2 l1 l3 0.999999\n"
     "k3 l2 l3 0.999999", "20u", ["b", "a"], "v1"),
    ("a flyback with two outputs from rest",
     "v1 in 0 47\nvg g 0 pulse(0 1 0 50n 100n 2.7u 5.2u)\nl1 x sw 30u ic=0\nr1 in x 47m\ns1 sw 0 g 0 sw\n"
     "c1 sw 0 58p ic=0\nl2 0 a 1.9u ic=0\nd2 a o dv\nc2 o 0 4.7u ic=0\nr2 o 0 102\nl3 0 b 1.9u ic=0\nd3 b q di\n"
     "c3 q 0 2u ic=0\nr3 q 0 100\nk1 l1 l2 0.999999\nk2 l1 l3 0.999999\nk3 l2 l3 0.999999", "52u", ["o", "sw"], "v1"),
    ("a flyback with a clamp",
     "v1 in 0 72\nvg g 0 pulse(0 1 0 0 0 1.3u 3.5u)\nl1 in sw 365u ic=0\ns1 sw 0 g 0 sr\nd1 sw cl di\nc1 cl 0 52n ic=0\n"
     "r1 cl 0 10.6k\nl2 0 a 365u ic=0\nd2 a o dr\nc2 o 0 22u ic=0\nr2 o 0 1.2\nl3 0 b 3.65u ic=0\nd3 b q di\n"
     "c3 q 0 0.6u ic=0\nr3 q 0 392\nk1 l1 l2 0.9999\nk2 l1 l3 0.9999\nk3 l2 l3 0.9999", "35u", ["o", "cl"], "v1"),
    ("a bridge that floats", "v1 a b sin(0 325 50)\nd1 a p\nd2 b p\nd3 n a\nd4 n b\nc1 p n 100u ic=0\nr1 p n 100", "40m",
     ["p", "n"], "v1"),
    ("a star without a neutral",
     "v1 a 0 sin(0 325 50)\nv2 b 0 sin(0 325 50 0 0 -120)\nv3 c 0 sin(0 325 50 0 0 120)\nl1 a x 1m\nl2 b y 1m\nl3 c z 1m\n"
     "d1 x p\nd2 y p\nd3 z p\nd4 n x\nd5 n y\nd6 n z\nr1 p n 20\nc1 p n 50u ic=0", "40m", ["p", "x"], "v1"),
    ("charge that a diode shares", "c1 a 0 1u ic=10\nd1 a b\nc2 b 0 3u ic=2\nr1 b 0 1k\nr2 a 0 10k", "5m", ["a", "b"], None),
    ("a buck of milliohms at 600 V",
     "v1 in 0 600\nvg g 0 pulse(0 1 0 0 0 40u 100u)\ns1 in sw g 0 sm\nd1 0 sw dm\nl1 sw o 1m ic=0\nc1 o 0 47u ic=0\n"
     "r1 o 0 5", "2m", ["sw", "o"], "v1"),
    ("a ladder of diodes",
     "v1 a 0 sin(0 100 1k)\nc1 a b 1u ic=0\nd1 0 b\nd2 b c\nc2 c 0 1u ic=0\nc3 b d 1u ic=0\nd3 c d\nd4 d e\n"
     "c4 e c 1u ic=0\nr1 e 0 1meg", "5m", ["e", "b"], "v1"),
    ("a tank that rings", "i1 0 a pulse(0 1m 1u 0 0 1u)\nl1 a 0 1u ic=0\nc1 a 0 1n ic=0\nr1 a 0 100k\nd1 a b\nc2 b 0 10p ic=0\n"
     "r2 b 0 1meg", "20u", ["a", "b"], None),
    ("a hysteretic converter",
     "v1 in 0 12\ns1 in sw ref o sh\nvr ref 0 5\nd1 0 sw\nl1 sw o 100u ic=0\nc1 o 0 10u ic=0\nr1 o 0 5\n"
     ".model sh sw(ron=10m vt=0 vh=20m)", "2m", ["sw", "o"], "v1"),
    ("a Marx generator of two stages",
     "v1 in 0 1k\nr1 in a 10k\nc1 a b 1u ic=900\nr2 b 0 10k\nr3 a c 10k\nc2 c d 1u ic=900\nr4 d 0 10k\n"
     "vg g 0 pulse(0 1 1m 0 0 1m)\ns1 a d g 0 si\nd1 c o\nr5 o 0 1k\nr6 b 0 10", "3m", ["c", "o"], "v1"),
    # what is open while all diodes block, from millivolts to kilovolts
    ("a bridge of millivolts that floats", "v1 a b sin(0 20m 1meg)\nd1 a p\nd2 b p\nd3 n a\nd4 n b\nc1 p n 1n ic=0\n"
     "r1 p n 1k", "2u", ["p", "n"], "v1"),
    ("two bridges in series",
     "v1 a b sin(0 50 50)\nd1 a p\nd2 b p\nd3 n a\nd4 n b\nc1 p n 100u ic=0\nr1 p n 200\nv2 e f sin(0 30 50 0 0 40)\n"
     "d5 e n\nd6 f n\nd7 q e\nd8 q f\nc2 n q 47u ic=0\nr2 n q 330", "40m", ["p", "q"], "v1"),
    ("three phases on a load",
     "v1 a s sin(0 325 50)\nv2 b s sin(0 325 50 0 0 -120)\nv3 c s sin(0 325 50 0 0 120)\nd1 a p\nd2 b p\nd3 c p\n"
     "d4 n a\nd5 n b\nd6 n c\nr1 p n 20\nc1 p n 50u ic=0", "40m", ["p", "a"], "v1"),
    ("a doubler that floats",
     "v1 a b sin(0 100 400)\nd1 a p\nd2 n a\nc1 p b 10u ic=0\nc2 b n 10u ic=0\nd3 p q\nc3 q n 1u ic=0\nr1 q n 10k",
     "10m", ["q", "n"], "v1"),
    # voltages of coils that are cut off
    ("a star of 28 V and 400 Hz",
     "v1 a 0 sin(0 28 400)\nv2 b 0 sin(0 28 400 0 0 -120)\nv3 c 0 sin(0 28 400 0 0 120)\nl1 a x 50u\nl2 b y 50u\n"
     "l3 c z 50u\nd1 x p\nd2 y p\nd3 z p\nd4 n x\nd5 n y\nd6 n z\nr1 p n 5\nc1 p n 470u ic=0", "5m", ["p", "x"], "v1"),
    ("a star of 8 kV",
     "v1 a 0 sin(0 8k 50)\nv2 b 0 sin(0 8k 50 0 0 -120)\nv3 c 0 sin(0 8k 50 0 0 120)\nl1 a x 100m\nl2 b y 100m\n"
     "l3 c z 100m\nd1 x p\nd2 y p\nd3 z p\nd4 n x\nd5 n y\nd6 n z\nr1 p n 1k\nc1 p n 5u ic=0", "60m", ["n", "y"], "v1"),
    ("two coils behind diodes",
     "v1 a 0 sin(0 100 1k)\nl1 a x 1m ic=0\nd1 x y\nl2 y z 2m ic=0\nd2 z p\nc1 p 0 4.7u ic=0\nr1 p 0 330", "10m",
     ["x", "y"], "v1"),
    # currents that jump, for capacitors follow a source
    ("a doubler", "v1 a 0 sin(0 100 1k)\nc1 a b 1u ic=0\nd1 0 b\nd2 b c\nc2 c 0 1u ic=0\nr1 c 0 1meg", "5m", ["c", "b"],
     "v1"),
    ("a ladder with a load",
     "v1 a 0 sin(0 100 1k)\nc1 a b 1u ic=0\nd1 0 b\nd2 b c\nc2 c 0 1u ic=0\nc3 b d 1u ic=0\nd3 c d\nd4 d e\n"
     "c4 e c 1u ic=0\nr1 e 0 10k", "5m", ["e", "b"], "v1"),
    ("a ladder of six diodes",
     "v1 a 0 sin(0 100 1k)\nc1 a b 1u ic=0\nd1 0 b\nd2 b c\nc2 c 0 1u ic=0\nc3 b d 1u ic=0\nd3 c d\nd4 d e\n"
     "c4 e c 1u ic=0\nc5 d f 1u ic=0\nd5 e f\nd6 f h\nc6 h e 1u ic=0\nr1 h 0 1meg", "5m", ["h", "d"], "v1"),
]

ROWS = ["--fill", "none"]  # those of .tran: no others are compared

MODELS = """.model d d
.model di d(ron=0)
.model dv d(vfwd=0.7)
.model dr d(ron=6m vfwd=0.7 roff=1meg)
.model dm d(ron=1m roff=1meg)
.model sw sw(ron=0 vt=0.5)
.model sr sw(ron=10m vt=0.5)
.model sm sw(ron=1m roff=1meg vt=0.5)
.model si sw(ron=0 vt=0.5)"""


def readers(nodes, source):
    """Name and cards of each kind of reader."""
    first, second = nodes
    yield "E", f"ez z1 0 {first} 0 1\nrz z1 0 1k"
    yield "E between nodes, loaded by a diode", f"ez z1 0 {first} {second} 2\ndz z1 z2 d\nrz z2 0 1k"
    yield "G", f"gz 0 z1 {second} 0 1m\nrz z1 0 1k"
    yield "B", f"bz z1 0 v=max(v({first}),2*v({second}))+abs(v({first}))\nrz z1 0 1k"
    yield "E of E", f"ez z1 0 {first} 0 1\nrz z1 0 1k\ney z2 0 z1 0 -3\nry z2 0 2k\nbz z3 0 v=limit(v(z2),-1,1)\nrx z3 0 1"
    if source:
        yield "H and F", f"hz z1 0 {source} 5\nrz z1 0 1k\nfz 0 z2 {source} 2\nry z2 0 1k"


def detectors(nodes, source, stop):
    """Readers that drive states, which jump where what is read jumps."""
    first, second = nodes
    farads = stop * 1e-5  # with 1 kohm a hundredth of the run
    yield "a peak detector", f"ez z1 0 {first} {second} 1\ndz z1 z2 d\ncz z2 0 {farads!r} ic=0\nrz z2 0 1k"
    yield "a cell that doubles", (f"ez z1 0 {second} 0 -1\ncy z1 z2 {farads!r} ic=0\ndy 0 z2 d\ndz z2 z3 d\n"
                                  f"cz z3 0 {farads / 3!r} ic=0\nrz z3 0 5k")
    yield "a cable of diodes", f"ez zz 0 {first} 0 1\n" + "\n".join(
        f"dz{k} {a} z{k} d\nrz{k} {a} z{k} 1k\ncz{k} z{k} 0 {farads / 10!r} ic=0"
        for k, a in enumerate(["zz", *(f"z{k}" for k in range(11))])) + "\nrz z11 0 30"
    if source:
        yield "a peak of a current", f"hz z1 0 {source} 5\ndz z1 z2 d\ncz z2 0 {farads!r} ic=0\nrz z2 0 1k"


def cards_of(cards, stop, extra):
    lines = [line + " d" if line.startswith("d") and len(line.split()) == 3 else line for line in cards.split("\n")]
    return "\n".join(["readers", *lines, MODELS, *extra, f".tran {float_of(stop) / 200!r} {stop} uic", ".end", ""])


def float_of(text):
    return float(text[:-1]) * {"u": 1e-6, "m": 1e-3, "n": 1e-9}[text[-1]]


def grid(outcome, stop):
    """The rows at 200 times, of two at one time the one behind."""
    rows = {}
    for k, t in enumerate(outcome.time):
        place = t / stop * 200
        if abs(place - round(place)) < 1e-12 * 200:
            rows[round(place)] = k
    return [rows[k] for k in sorted(rows)]


def compare(checker, what, plain, read, stop):
    """Events within 1e-9 of the run, waveforms within 1e-8 of the largest voltage or current."""
    events = [(e["element"], e["state"], e["time"]) for e in plain.report["events"]]
    names = {e[0] for e in events}
    others = [(e["element"], e["state"], e["time"]) for e in read.report["events"] if e["element"] in names]
    # a pair of events more or less where a ringing ends: the waveforms below show whether that matters
    if checker.check(abs(len(events) - len(others)) <= len(events) / 1000,
                     f"{what}: {len(others)} events, not {len(events)}") and len(events) == len(others):
        late = max((abs(a[2] - b[2]) for a, b in zip(events, others)), default=0.0)
        checker.check(late <= 1e-9 * stop, f"{what}: an event {late:.3g} s off")
    before, after = grid(plain, stop), grid(read, stop)
    checker.check(len(before) == len(after) == 201, f"{what}: {len(before)} and {len(after)} rows")
    for name in plain.names[1:]:
        a, b, scale = plain.column(name), read.column(name), plain.scale(name)
        off = max(abs(a[i] - b[k]) for i, k in zip(before, after))
        checker.check(off <= 1e-8 * scale + 1e-15, f"{what}: {name} is {off:.3g} off, of {scale:.3g}")


def main():
    checker = Checker("readers")
    for name, cards, stop, nodes, source in some_of(CIRCUITS):
        plain = run(sys.argv[1], cards_of(cards, stop, []), method=None, options=ROWS)
        if not checker.check(plain.status == 0, f"{name}: {plain.stderr}"):
            continue
        for kind, extra in [*readers(nodes, source), *detectors(nodes, source, float_of(stop))]:
            what = f"{name}, with {kind}"
            read = run(sys.argv[1], cards_of(cards, stop, [extra]), method=None, options=ROWS)
            if checker.check(read.status == 0, f"{what}: {read.stderr}"):
                compare(checker, what, plain, read, float_of(stop))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
