#!/usr/bin/env python3
"""Transmission lines and delay() against closed forms: lattice diagrams, exponentials, the method of steps.

usage: lines.py PROGRAM

The lattice knows nothing of the program: with resistors at both ends a wave comes back after 2 TD, times both reflection
coefficients. Sizes go from picoseconds and millivolts to seconds and kilovolts.
"""

import bisect
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

# ohms, seconds, volts
SIZES = [(50.0, 10e-9, 1.0), (300.0, 1e-3, 1e4), (1.0, 2.0, 1e-3), (75.0, 20e-12, 3.3), (2e3, 1e-6, 400.0)]
# resistances at the source and at the load, over Z0
ENDS = [(1.0, 3.0), (0.2, 5.0), (4.0, 0.1), (0.0, 1.5), (0.05, 1e4), (1.0, 1.0)]


def relative(r):
    return (r - 1) / (r + 1)


def lattice(source, ends, delay, t):
    """v at the source's end and at the load, of a source (a function of time) that was source(-1) for ever."""
    back, forth = relative(ends[0]), relative(ends[1])
    into = 1 / (1 + ends[0])
    before = source(-1.0)
    rest = before * ends[1] / (ends[0] + ends[1])
    near = far = rest
    factor = into
    arrives = 0.0
    while arrives <= t:
        near += factor * (source(t - arrives) - before) * (1 if arrives == 0 else (1 + 1 / back if back else 1))
        if t >= arrives + delay:
            far += factor * (1 + forth) * (source(t - arrives - delay) - before)
        if back == 0:
            if t >= arrives + 2 * delay and arrives == 0:
                near += factor * forth * (source(t - 2 * delay) - before)
            break
        factor *= back * forth
        arrives += 2 * delay
        if abs(factor) < 1e-18:
            break
    return near, far


def grid(stop, n, edges):
    """Times that keep off the edges, where a row is either limit."""
    times = [(k + 0.371) * stop / n for k in range(n)]
    edges = sorted(edges)
    kept = []
    for t in times:
        k = bisect.bisect(edges, t)
        near = [e for e in edges[max(0, k - 1):k + 1] if abs(e - t) < 1e-6 * stop]
        kept += [] if near else [t]
    return kept


def resistive(checker, program):
    for ohms, delay, volts in SIZES:
        for number, ends in enumerate(ENDS):
            sine = number % 2 == 1
            first = 0.3 * delay
            if sine:
                card = f"sin({0.2 * volts!r} {volts!r} {0.37 / delay!r})"
                source = lambda t: volts * (0.2 + (math.sin(2 * math.pi * 0.37 / delay * t) if t > 0 else 0))
            else:
                card = f"pulse({0.1 * volts!r} {volts!r} {first!r} 0 0 {2.6 * delay!r} {50 * delay!r})"
                source = lambda t: volts if first <= t < first + 2.6 * delay else 0.1 * volts
            text = (f"line\nv1 s 0 {card}\nr1 s a {ends[0] * ohms!r}\nt1 a 0 b 0 z0={ohms!r} td={delay!r}\n"
                    f"r2 b 0 {ends[1] * ohms!r}\n.save v(a) v(b)\n.tran {delay / 7!r} {9 * delay!r}\n.end\n")
            edges = [0.0] if sine else [first, first + 2.6 * delay]
            edges = [e + k * delay for e in edges for k in range(10)]
            times = grid(9 * delay, 60, edges)
            result = run(program, text, at=times, method=None)
            name = f"{ohms:g} ohm, {delay:g} s, ends {ends}"
            if not checker.check(result.status == 0, f"{name}: {result.status}: {result.stderr}"):
                continue
            for k, t in enumerate(times):
                near, far = lattice(source, ends, delay, t)
                checker.close(result.column("v(a)")[k], near, 3e-9 * volts, f"{name}: v(a) at {t:g}")
                checker.close(result.column("v(b)")[k], far, 3e-9 * volts, f"{name}: v(b) at {t:g}")


def capacitive(checker, program):
    """A matched step into a capacitor or a coil: one exponential behind the edge, and nothing comes back."""
    for ohms, delay, volts in SIZES:
        for kind, ratio in (("c", 0.2), ("c", 3.0), ("l", 0.5), ("l", 7.0)):
            tau = ratio * delay
            value = tau / ohms if kind == "c" else tau * ohms
            text = (f"load\nv1 s 0 pulse(0 {volts!r} {delay!r} 0 0 1e9)\nr1 s a {ohms!r}\n"
                    f"t1 a 0 b 0 f={0.25 / delay!r} z0={ohms!r}\n{kind}1 b 0 {value!r}\n.save v(a) v(b)\n"
                    f".tran {delay / 7!r} {8 * delay!r}\n.end\n")
            times = grid(8 * delay, 50, [delay * k for k in range(9)])
            result = run(program, text, at=times, method=None)
            name = f"{kind} of {ratio} delays at {ohms:g} ohm"
            if not checker.check(result.status == 0, f"{name}: {result.status}: {result.stderr}"):
                continue

            def load(t):
                fades = math.exp(-t / tau) if t > 0 else 0.0
                return 0.0 if t <= 0 else volts * (1 - fades if kind == "c" else fades)

            for k, t in enumerate(times):
                far = load(t - 2 * delay)
                sent = 0.5 * volts if t >= delay else 0.0
                near = sent + load(t - 3 * delay) - (0.5 * volts if t >= 3 * delay else 0.0)
                checker.close(result.column("v(b)")[k], far, 3e-9 * volts, f"{name}: v(b) at {t:g}")
                checker.close(result.column("v(a)")[k], near, 3e-9 * volts, f"{name}: v(a) at {t:g}")


def diode_and_switch(checker, program):
    """At its end a line that is matched behind is a source of 2 v+ behind Z0."""
    for ohms, delay, volts in SIZES:
        f = 0.23 / delay
        knee = 0.3 * volts
        text = (f"rectifier\nv1 s 0 sin(0 {volts!r} {f!r})\nr1 s a {ohms!r}\nt1 a 0 b 0 z0={ohms!r} td={delay!r}\n"
                f"d1 b c dm\nr2 c 0 {ohms!r}\n.model dm d(ron=0 roff=inf vfwd={knee!r})\n"
                f"v2 g 0 pwl(0 0 {6 * delay!r} 0 {6.5 * delay!r} 1)\ns1 c 0 g 0 sm\nrg g 0 1\n"
                f".model sm sw(ron={0.5 * ohms!r} roff=inf vt=0.5)\n.save v(b) v(c)\n"
                f".tran {delay / 7!r} {9 * delay!r}\n.end\n")
        times = grid(9 * delay, 80, [6.25 * delay])
        result = run(program, text, at=times, method=None)
        name = f"rectifier at {ohms:g} ohm"
        if not checker.check(result.status == 0, f"{name}: {result.status}: {result.stderr}"):
            continue
        for k, t in enumerate(times):
            open_voltage = volts * math.sin(2 * math.pi * f * (t - delay)) if t > delay else 0.0
            load = ohms / 3 if t > 6.25 * delay else ohms
            current = max(0.0, (open_voltage - knee) / (ohms + load))
            checker.close(result.column("v(c)")[k], load * current, 1e-8 * volts, f"{name}: v(c) at {t:g}")
            checker.close(result.column("v(b)")[k], open_voltage - ohms * current, 1e-8 * volts, f"{name}: v(b) at {t:g}")


def others(checker, program):
    """Lines in a row, a port across nothing that is grounded, a start that is given."""
    text = ("row\nv1 s 0 pulse(0 1 1n 0 0 1)\nr1 s a 50\nt1 a 0 m 0 z0=50 td=4n\nt2 m 0 b 0 z0=100 td=3n\n"
            "r2 b 0 100\n.save v(a) v(m) v(b)\n.tran 1n 30n\n.end\n")
    result = run(program, text, at=[4.5e-9, 5.5e-9, 7.5e-9, 8.5e-9, 9.5e-9, 25e-9], method=None)
    through = 2 / 3
    for k, wanted in enumerate([(0.5, 0, 0), (0.5, through, 0), (0.5, through, 0), (0.5, through, through),
                                (0.5 * (1 + 1 / 3), through, through), (0.5 * 4 / 3, through, through)]):
        for name, value in zip(("v(a)", "v(m)", "v(b)"), wanted):
            checker.close(result.column(name)[k], value, 1e-9, f"row: {name}")
    text = ("cross\nv1 s 0 pulse(0 1 1n 0 0 1)\nr1 s a 50\nt1 a 0 0 b z0=50 td=4n\nr2 b 0 50\n.save v(b)\n"
            ".tran 1n 30n\n.end\n")
    result = run(program, text, at=[4e-9, 6e-9, 29e-9], method=None)
    for k, wanted in enumerate([0, -0.5, -0.5]):
        checker.close(result.column("v(b)")[k], wanted, 1e-9, "crossed port")
    text = ("given\nr1 a 0 50\nt1 a 0 b 0 z0=50 td=4n ic=1,0.02,3,-0.02\nr2 b 0 1meg\n.save v(a) v(b)\n.tran 1n 30n uic\n.end\n")
    result = run(program, text, at=[2e-9, 3.9e-9, 4.1e-9], method=None)
    gain = 2 * 1e6 / (1e6 + 50)
    checker.close(result.column("v(b)")[0], 0.5 * (1 + 1) * gain, 1e-9, "ic: v(b)")
    checker.close(result.column("v(a)")[1], 0.5 * (3 - 1), 1e-9, "ic: v(a)")


def delays(checker, program):
    """v' = -v(t - T): polynomials, interval by interval (Bellman); formulas of what was."""
    for delay, volts in ((1.0, 1.0), (1e-6, 1e3), (1e-10, 1e-2)):
        text = (f"steps\nc1 x 0 {delay!r} ic={volts!r}\ng1 x 0 d 0 1\nb1 d 0 v=delay(v(x),{delay!r})\n"
                f".ic v(x)={volts!r}\n.save v(x)\n.tran {delay / 10!r} {8 * delay!r}\n.end\n")
        times = [(k + 0.5) * delay / 5 for k in range(40)]
        result = run(program, text, at=times, method=None)
        if not checker.check(result.status == 0, f"steps: {result.status}: {result.stderr}"):
            continue
        for k, t in enumerate(times):
            s = t / delay
            wanted = sum((-1) ** n * (s - (n - 1)) ** n / math.factorial(n) for n in range(int(s) + 2) if s > n - 1)
            checker.close(result.column("v(x)")[k], volts * wanted, 1e-9 * volts, f"steps: at {t:g}")
    text = ("formula\nv1 a 0 sin(1 1 1k)\nr1 a x 1k\nc1 x 0 100n\nb1 d 0 v=delay(2*v(x)+1,0.3m)\nr2 d 0 1k\n"
            "b2 e 0 v=absdelay(i(v1)*v(x),50u)\nr3 e 0 1k\n.save v(x) v(d) v(e) i(v1)\n.tran 10u 2m\n.op\n.end\n")
    times = [k * 10e-6 for k in range(1, 200)]
    result = run(program, text, at=times, method=None)
    if checker.check(result.status == 0, f"formula: {result.status}: {result.stderr}"):
        x, i = result.column("v(x)"), result.column("i(v1)")
        for k in range(199):
            late, soon = k - 30, k - 5
            checker.close(result.column("v(d)")[k], 2 * (x[late] if late >= 0 else 1.0) + 1, 1e-8, f"v(d) at {k}")
            checker.close(result.column("v(e)")[k], i[soon] * x[soon] if soon >= 0 else 0.0, 1e-10, f"v(e) at {k}")


def exponential(checker, program):
    """Tangents of exponential diodes are found by runs of their own, which have lines and delays, too: 0 = V - R i - n Vt ln."""
    thermal = 1.380649e-23 * 300.15 / 1.602176634e-19
    cards = [(ohms, delay, line) for ohms, delay, _ in SIZES
             for line in ("t1 a 0 b 0 z0={0!r} td={1!r}", "b1 b 0 v=delay(v(a),{1!r})")]
    for number, (ohms, delay, line) in enumerate(cards):
        volts, saturation, emission = 0.9 + 3 * number, 10.0**(-16 + number), 1 + number / 10
        text = (f"diode\nv1 a 0 {volts!r}\n{line.format(ohms, delay)}\nr1 b c {ohms!r}\nd1 c 0 dm\n"
                f".model dm d(is={saturation!r} n={emission!r})\n.save v(c) i(d1)\n.tran {delay!r} {8 * delay!r}\n.end\n")
        result = run(program, text, method=None)
        name = f"exponential diode of {saturation:g} A, {line}"
        if not checker.check(result.status == 0, f"{name}: {result.status}: {result.stderr}"):
            continue
        low, high = 0.0, volts
        for _ in range(200):
            v = 0.5 * (low + high)
            too_much = saturation * math.expm1(v / (emission * thermal)) > (volts - v) / ohms if v < 50 * thermal * emission else True
            low, high = (low, v) if too_much else (v, high)
        checker.close(result.column("v(c)")[-1], low, 1e-4 * low, f"{name}: v(c)")
        checker.close(result.column("i(d1)")[-1], (volts - low) / ohms, 1e-4 * volts / ohms, f"{name}: i(d1)")


def echoes(checker, program):
    """What went through a line and comes back is no rougher for it: steps do not get shorter from echo to echo."""
    for ohms, delay, volts in SIZES:
        for back, forth, behind in ((0.1, 9.0, ""), (7.0, 0.2, ""), (0.05, 30.0, "c2 b 0 {c!r}\n"), (0.3, 4.0, "d1 b c\nr3 c 0 {r!r}\n")):
            added = behind.format(c=0.3 * delay / ohms, r=ohms)
            steps = []
            for n in (24, 96):
                text = (f"echoes\nv1 s 0 sin(0 {volts!r} {0.21 / delay!r})\nr1 s a {back * ohms!r}\n"
                        f"t1 a 0 b 0 z0={ohms!r} td={delay!r}\nr2 b 0 {forth * ohms!r}\n{added}"
                        f".save v(b)\n.tran {delay!r} {n * delay!r}\n.end\n")
                result = run(program, text, method=None)
                if checker.check(result.status == 0, f"echoes: {result.status}: {result.stderr}"):
                    steps.append(result.report["work"]["steps"])
            checker.check(len(steps) == 2 and steps[1] <= 6 * steps[0], f"{back} {forth} {added}: {steps} steps for 24 and 96 delays")


def refusals(checker, program):
    line = "t1 a 0 b 0 z0=50 td=1n"
    for card, analysis, message in (("t1 a 0 b 0 td=1n", ".tran 1n 10n", "Z0 above 0"),
                                    ("t1 a 0 b 0 z0=50", ".tran 1n 10n", "delay above 0"),
                                    ("t1 a 0 b 0 z0=50 td=0", ".tran 1n 10n", "delay above 0"),
                                    ("t1 a 0 b 0 z0=50 td=1n len=3", ".tran 1n 10n", "no parameter 'len'"),
                                    (line, ".ac dec 3 1 1k", "is a delay"), (line, ".dc v1 0 1 0.5", "is a delay"),
                                    (line, ".pss 1u", "is a delay"),
                                    (line, ".options method=euler step=1n\n.tran 1n 10n", "is a delay")):
        text = f"refused\nv1 a 0 1 ac 1\n{card}\nr1 b 0 50\n{analysis}\n.end\n"
        result = run(program, text, method=None)
        checker.check(result.status == 3 and message in result.stderr, f"{card} {analysis}: {result.status} {result.stderr}")


def main():
    checker = Checker("lines")
    for cases in (resistive, capacitive, diode_and_switch, others, delays, exponential, echoes, refusals):
        cases(checker, sys.argv[1])
    return checker.finish()


sys.exit(main())
