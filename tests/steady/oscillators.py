#!/usr/bin/env python3
"""Circuits that oscillate by themselves: period and stability against closed forms, or runs as long as they take.

usage: oscillators.py PROGRAM KIND
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import gate_oscillators  # pylint: disable=wrong-import-position
from kinds import between, part  # pylint: disable=wrong-import-position

NEAR = 1e-9  # of the period
MOST_PERIODS = 3000


def relaxation():
    """A capacitor through a resistor, emptied by a switch with hysteresis into another resistor."""
    for k in range(10):
        volts, ohms = between(0.5, 500, k, 1), between(10, 1e6, k, 2)
        store = between(1e-12, 1e-3, k, 3)
        low, high = (0.1 + 0.3 * part(k, 4)) * volts, (0.5 + 0.4 * part(k, 5)) * volts
        into = ohms * between(1e-3, 0.05, k, 6)
        both, rest = ohms * into / (ohms + into), volts * into / (ohms + into)
        period = (ohms * store * math.log((volts - low) / (volts - high)) +
                  both * store * math.log((high - rest) / (low - rest)))
        yield (f"V1 in 0 {volts!r}\nR1 in c {ohms!r}\nC1 c 0 {store!r}\nS1 c d c 0 sm\n"
               f"R2 d 0 {into!r}\n.model sm SW(Ron=0 Vt={(low + high) / 2!r} "
               f"Vh={(high - low) / 2!r})\n", period)


def both_ways(middle, half, ohms):
    """Two models: closed above, and closed below with its control turned round."""
    return (f".model above SW(Ron={ohms!r} Vt={middle!r} Vh={half!r})\n"
            f".model below SW(Ron={ohms!r} Vt={-middle!r} Vh={half!r})\n")


def inverter():
    """A Schmitt inverter, which drives its own input through an RC."""
    for k in range(10):
        volts, ohms = between(1, 50, k, 1), between(100, 1e6, k, 2)
        store = between(1e-11, 1e-5, k, 3)
        middle, half = (0.4 + 0.2 * part(k, 4)) * volts, (0.02 + 0.3 * part(k, 5)) * volts
        low, high = middle - half, middle + half
        period = ohms * store * math.log((volts - low) / (volts - high) * high / low)
        yield (f"Vcc p 0 {volts!r}\nSp p y 0 c below\nSn y 0 c 0 above\nR1 y c {ohms!r}\n"
               f"C1 c 0 {store!r}\n" + both_ways(middle, half, 0.0), period)


def royer():
    """A coil between two supplies, turned round where its current reaches a limit."""
    for k in range(10):
        volts, coil = between(1, 400, k, 1), between(1e-6, 1e-1, k, 2)
        limit, sense = between(0.01, 10, k, 3), between(1e-3, 1e-1, k, 4)
        period = 2 * coil / sense * math.log((volts + limit * sense) / (volts - limit * sense))
        yield (f"Vp p 0 {volts!r}\nVn n 0 {-volts!r}\nL1 y s {coil!r} IC={1.5 * limit!r}\nRs s 0 {sense!r}\n"
               f"Sp p y 0 s below\nSn n y s 0 above\nRl y 0 {volts / limit!r}\n" +
               both_ways(0.0, limit * sense, 0.0), period)


def hysteretic_buck():
    for k in range(10):
        volts, duty, ohms = between(5, 50, k, 1), 0.25 + 0.5 * part(k, 2), between(0.5, 20, k, 3)
        coil, store = ohms * between(2e-6, 2e-5, k, 4), between(2e-5, 2e-4, k, 5) / ohms
        rest, half = ohms * between(0.02, 0.2, k, 6), volts * between(1e-3, 1e-2, k, 7)
        yield (f"Vin in 0 {volts!r}\nVref ref 0 {duty * volts!r}\nS1 in sw ref out sm\nD1 0 sw\n"
               f"L1 sw out {coil!r}\nC1 out e {store!r}\nRe e 0 {rest!r}\nR1 out 0 {ohms!r}\n"
               f".model sm SW(Ron=0 Vt=0 Vh={half!r})\n", None)


def bang_bang_boost():
    """A boost converter whose coil's current is kept within a band."""
    for k in range(10):
        volts, ohms = between(3, 100, k, 1), between(5, 200, k, 2)
        amperes = volts / ohms * between(2.5, 8, k, 3)
        coil, store = ohms * between(1e-6, 1e-5, k, 4), between(1e-5, 1e-4, k, 5) / ohms
        half = amperes * (0.1 + 0.3 * part(k, 6))
        yield (f"Vin in 0 {volts!r}\nL1 in s {coil!r}\nRs s sw 0.01\nEx x 0 s sw 100\n"
               f"S1 sw 0 0 x sm\nD1 sw out\nC1 out 0 {store!r}\nR1 out 0 {ohms!r}\n"
               f".model sm SW(Ron=0 Vt={-amperes!r} Vh={half!r})\n", None)


def ring():
    """Three or five Schmitt inverters one behind the other, each with an RC of its own."""
    for k in range(10):
        volts, n = between(1, 50, k, 1), 3 if k % 2 else 5
        middle, half = (0.45 + 0.1 * part(k, 2)) * volts, (0.02 + 0.15 * part(k, 3)) * volts
        body = f"Vcc p 0 {volts!r}\n"
        for j in range(n):
            at = f"c{(j - 1) % n}"
            ohms, store = between(100, 1e4, k, 4), between(1e-9, 1e-7, k, 5)
            body += (f"Sp{j} p y{j} 0 {at} below\nSn{j} y{j} 0 {at} 0 above\n"
                     f"R{j} y{j} c{j} {ohms * (0.5 + part(k + j, 6))!r}\n"
                     f"C{j} c{j} 0 {store!r} IC={volts * part(k + j, 8)!r}\n")
        yield body + both_ways(middle, half, 0.0), None


def negative_resistance():
    """An LC tank, which a comparator drives through a resistor."""
    for k in range(10):
        coil, store = between(1e-6, 1e-2, k, 1), between(1e-10, 1e-6, k, 2)
        ohms = math.sqrt(coil / store)
        volts = between(0.5, 50, k, 3)
        yield (f"Vp p 0 {volts!r}\nVn n 0 {-volts!r}\nL1 a 0 {coil!r}\n"
               f"C1 a 0 {store!r} IC={0.3 * volts!r}\nR1 a 0 {ohms * between(2, 8, k, 4)!r}\n"
               f"Sp p y a 0 above\nSn n y 0 a below\nR2 y a {ohms * between(1, 10, k, 5)!r}\n" +
               both_ways(0.0, 1e-3 * volts, 0.0), None)


def resonant():
    """A half-bridge whose frequency a slow loop sets: the small capacitor of the oscillator beside the tank's energies."""
    for k in range(10):
        slow, start = (30, 1.5) if k in (5, 7, 9) else (1, 2)
        volts, turns = between(20, 400, k, 1), 1 + 9 * part(k, 2)
        tank, store = between(10e-6, 100e-6, k, 3), between(10e-9, 100e-9, k, 4)
        wave, rate = math.sqrt(tank / store), 1 / (2 * math.pi * math.sqrt(tank * store))
        ohms, small = wave * between(0.3, 1, k, 5) / turns**2, between(100e-12, 2e-9, k, 6)
        volts_out = (0.2 + 0.2 * part(k, 7)) * volts / turns
        yield (f"Vin in 0 {volts!r}\nS1 in h q 0 sq\nS2 h 0 qn 0 sq\nEqn qn 0 value={{1-v(q)}}\n"
               f"Cr h a {store!r}\nLr a p {tank!r}\nLp p 0 {5 * tank!r}\nLs s 0 {5 * tank / turns**2!r}\n"
               f"Lt 0 t {5 * tank / turns**2!r}\nK1 Lp Ls Lt 1\nD1 s out dd\nD2 t out dd\n"
               f"C1 out 0 {30 / (ohms * rate)!r} IC={volts_out!r}\nR1 out 0 {ohms!r}\n"
               f"Bq 0 tr I={{(1-2*v(q))*v(ctl)*{small * rate!r}}}\nCt tr 0 {small!r} IC=0.1\nRt tr 0 100meg\n"
               "Vone one 0 1\nSq one q tr 0 sch\nRq q 0 1k\n"
               f"G1 0 ctl out ref {1e-3 / volts_out!r}\nRz ctl z 3k\nCz z 0 {10 * slow / (3e3 * rate)!r} IC={start}\nRo ctl 0 1meg\n"
               f"Vref ref 0 {volts_out!r}\n.model sq SW(Ron={0.01 * wave!r} Vt=0.5 Roff=10meg)\n"
               ".model sch SW(Ron=1u Vt=0.5 Vh=0.5 Roff=1g)\n.model dd D(Ron=1m)\n", None)


def emptied():
    """Saws: a switch without resistance closes and opens in one instant, and leaves its mode as it was."""
    saw = "S1 c 0 c 0 sw\n.model sw SW(Vt={!r} Vh={!r})\n"
    for k in range(3):
        amperes, store, high = between(1e-6, 1, k, 1), between(1e-12, 1e-3, k, 2), between(0.1, 300, k, 3)
        yield f"I1 0 c {amperes!r}\nC1 c 0 {store!r}\n" + saw.format(0.55 * high, 0.45 * high), store * high / amperes
        volts, ohms = high / 0.7, between(10, 1e6, k, 4)
        yield (f"V1 in 0 {volts!r}\nR1 in c {ohms!r}\nC1 c 0 {store!r}\n" + saw.format(0.55 * high, 0.45 * high),
               ohms * store * math.log(1 / 0.3))
    yield ("I1 0 c 1m\nC1 c 0 10n\nS1 c 0 q 0 sg\nA1 c 0 0 0 0 0 q 0 SCHMITT Vt=1 Vh=0.5\n.model sg SW(Vt=0.5)\n", 1.5e-5)
    # no charge is left in the filter over a period
    yield ("I1 0 c 0.3m\nC1 c 0 1n\nR1 c o 100k\nC2 o 0 10n\n" + saw.format(1.6, 1.4), 1e-5)
    # into a larger capacitor, until both have one voltage: what goes in is what its load takes
    yield ("I1 0 a 1m\nC1 a 0 1u\nS1 a b a b sw\nC2 b 0 10u\nR2 b 0 3k\n.model sw SW(Vt=0.55 Vh=0.45)\n", 10e-3 / 11)
    # the dual: the current of a coil is cut off in no time
    yield ("V1 in 0 10\nL1 in a 1m\nR1 a x 5\nS1 x 0 c 0 sw\nB1 c 0 V=-i(L1)\n.model sw SW(Vt=-0.55 Vh=0.45)\n",
           2e-4 * math.log(2))


KINDS = {f.__name__: f for f in (emptied, resonant, relaxation, inverter, royer, hysteretic_buck, bang_bang_boost,
                                 ring, negative_resistance)}
KINDS.update(gate_oscillators.KINDS)


def run(program, folder, netlist, verb, *options):
    (folder / "c.cir").write_text(netlist)
    done = subprocess.run([program, verb, "c.cir", "-o", "c.csv", "--report", "c.json", "-q",
                           *options], cwd=folder, capture_output=True, text=True, check=False)
    return done, json.loads((folder / "c.json").read_text()) if done.returncode == 0 else {}


def settled_period(program, folder, body, steady):
    """The time between events of a run; None: it would take too long. Some lie nearer than a period."""
    largest = max([math.hypot(m["re"], m["im"]) for m in steady["multipliers"]], default=0.0)
    periods = 30 if largest < 0.1 else math.ceil(1.3 * math.log(1e-12) / math.log(largest)) + 30
    if periods > MOST_PERIODS:
        return None
    stop = periods * steady["period"]
    card = f".tran {stop!r} {stop!r} {stop * (1 - 1e-9)!r} uic\n.end\n"
    done, settled = run(program, folder, "* run\n" + body + card, "run", "--tol", "1e-11",
                        "--fill", "none")
    if done.returncode != 0:
        return done.stderr
    last = settled["events"][-1]
    times = [e["time"] for e in settled["events"]
             if (e["element"], e["state"]) == (last["element"], last["state"])]
    return min((times[-1] - t for t in times[-40:-1]),
               key=lambda T: abs(T - steady["period"]), default="no event comes again")


def main():
    program, kind = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    checker = dalcs_program.Checker(kind)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        cases = [(f"{kind}_{k}", case) for k, case in enumerate(KINDS[kind]())]
        for label, (body, period) in dalcs_program.some_of(cases):
            done, report = run(program, folder, f"* {label}\n{body}.pss uic\n.end\n", "steady")
            if not checker.check(done.returncode == 0, f"{label}: {done.stderr}"):
                continue
            steady = report["steady"]
            checker.check(steady["self_oscillating"] and steady["stable"],
                          f"{label}: {steady['verdict']}")
            checker.check(abs(steady["flow"] - 1) < 1e-7, f"{label}: flow {steady['flow']!r}")
            closed = [e for e in report["events"] if (e["element"], e["state"]) == ("sq", "on")]
            checker.check(kind != "resonant" or len(closed) == 1, f"{label}: {len(closed)} turns")
            if period is None:
                period = settled_period(program, folder, body, steady)
            if period is None:
                continue
            if not checker.check(not isinstance(period, str), f"{label}: {period}"):
                continue
            off = abs(steady["period"] / period - 1)
            checker.check(off <= NEAR, f"{label}: {steady['period']!r} s, not {period!r}: {off:.2g}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
