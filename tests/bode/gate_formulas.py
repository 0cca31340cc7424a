#!/usr/bin/env python3
"""Responses of gates, latches and samples in closed form.

usage: gate_formulas.py PROGRAM

Peak current control with a latch between two constant voltages: with slopes m1 and m2 of the current in V/s at the comparator, ma of the ramp, the sampled-data model (Brown and Middlebrook
1981) is exact here: an error of the current at a clock is multiplied by (ma - m2)/(m1 + ma). With a signal exp(jwt) on the
threshold the comparator moves by d = 1/(m1 + ma + (m1 + m2)/(exp(jwT) - 1)), and the current steps by (m1 + m2) d at the
end of each pulse, the latch's delay later.

A hold makes (1 - exp(-jwT))/(jwT) of what it samples, each one behind it on the same clock exp(-jwT) besides. A comparator
with a sawtooth of 1 V moves one edge of its output by T: that is 1 at all frequencies, exp(-jw Td) behind a delay, and
(1 - exp(-jw Tf))/(jw Tf) besides where the edge takes the time Tf.
"""

import cmath
import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "steady"))
import kinds  # pylint: disable=wrong-import-position,import-error

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

TOLERANCE = 1e-9
FREQUENCIES = (1e-3, 0.02, 0.3, 0.49, 0.77, 1.9)  # of the clock's


def circuit(k):
    between, part = kinds.between, kinds.part
    period, volts, duty = kinds.clock(k), between(3, 800, k, 2), 0.1 + 0.8 * part(k, 1)
    ripple, level = between(1e-2, 10, k, 3), between(1.5, 5, k, 4)
    ohms = between(0.02, 2, k, 5)
    coil = volts * (1 - duty) * duty * period / ripple
    up, down = ohms * volts * (1 - duty) / coil, ohms * volts * duty / coil
    ramp = down * (0.3 + 0.9 * part(k, 6))
    late = period * 0.05 * part(k, 7)
    # the current's peak where the comparator acts, above all of its ripple
    threshold = ohms * ripple * level + ramp * (duty * period - late)
    text = (f"Vin in 0 {volts!r}\nVo out 0 {volts * duty!r}\nL1 sw out {coil!r} IC={ripple * (level - 1)!r}\nD1 0 sw\n"
            f"S1 in sw q 0 sm\n.model sm SW(Ron=0 Vt=0.5)\nVclk clk 0 PULSE(0 1 0 0 0 {0.02 * period!r} {period!r})\n"
            f"Vr r 0 PULSE(0 {ramp * period!r} 0 {period!r} 0 0 {period!r})\nVc c 0 {threshold!r} AC 1\n"
            f"B1 below 0 V=v(c)-v(r)-{ohms!r}*i(L1)\nA1 below 0 0 0 0 over 0 0 BUF Ref=0\n"
            f"A2 clk over 0 0 0 0 q 0 SRFLOP Td={late!r}\n")
    return text, period, ohms, up, down, ramp, late


def rows_of(checker, program, folder, text, period, signal):
    """(jw, response) at each frequency."""
    asked = [f / period for f in FREQUENCIES]
    (folder / "c.cir").write_text(f"* c\n{text}.save {signal}\n.pss uic\n.ac list {' '.join(map(repr, asked))}\n")
    done = subprocess.run([program, "run", "c.cir", "-q", "-o", "c.csv", "--report", "c.json"], cwd=folder,
                          capture_output=True, text=True, check=False)
    if not checker.check(done.returncode == 0, f"{text}: {done.stderr}"):
        return []
    rows = [[float(v) for v in line.split(",")] for line in (folder / "c.csv").read_text().splitlines()[1:]]
    return [(2j * math.pi * row[0], complex(row[1], row[2])) for row in rows]


def holds(checker, program, folder, k):
    period, n = kinds.clock(k), 1 + k % 3
    text = (f"Vc h0 0 {kinds.between(1e-3, 1e3, k, 2)!r} AC 1\nVclk clk 0 PULSE(0 1 {kinds.part(k, 3) * period!r} 0 0 "
            f"{0.3 * period!r} {period!r})\n")
    for j in range(n):
        text += f"A{j} h{j} 0 clk 0 0 0 h{j + 1} 0 SAMPLEHOLD\n"
    text += f"R1 h{n} 0 1k\n"
    for jw, found in rows_of(checker, program, folder, text, period, f"v(h{n})"):
        response = (1 - cmath.exp(-jw * period)) / (jw * period) * cmath.exp(-jw * period * (n - 1))
        checker.check(abs(found - response) <= TOLERANCE, f"{n} holds at {jw}: {found} for {response}")


def edges(checker, program, folder, k):
    period = kinds.clock(k)
    late, falls = period * kinds.between(1e-3, 3, k, 2), period * (0.0 if k % 3 == 0 else 0.2 * kinds.part(k, 3))
    text = (f"Vc c 0 {0.3 + 0.4 * kinds.part(k, 4)!r} AC 1\nVt t 0 PULSE(0 1 0 {period!r} 0 0 {period!r})\n"
            f"A1 c t 0 0 0 0 q 0 DIFFSCHMITT Vt=0 Vh=0 Td={late!r} Tfall={falls!r}\nR1 q 0 1k\n")
    for jw, found in rows_of(checker, program, folder, text, period, "v(q)"):
        response = cmath.exp(-jw * late) * ((1 - cmath.exp(-jw * falls)) / (jw * falls) if falls > 0 else 1)
        checker.check(abs(found - response) <= TOLERANCE, f"edges {k} at {jw}: {found} for {response}")


def look_at(checker, program, folder, k):
    text, period, ohms, up, down, ramp, late = circuit(k)
    rows = rows_of(checker, program, folder, text, period, "i(l1)")
    if not rows:
        return
    factors = json.loads((folder / "c.json").read_text())["steady"]["multipliers"]
    expected = (ramp - down) / (up + ramp)
    checker.check(len(factors) == 1 and abs(factors[0]["re"] - expected) <= TOLERANCE, f"{k}: {factors} for {expected}")
    for jw, found in rows:
        d = 1 / (up + ramp + (up + down) / (cmath.exp(jw * period) - 1))
        response = (up + down) * d * cmath.exp(-jw * late) / (jw * period) / ohms
        checker.check(abs(found - response) <= TOLERANCE * abs(response), f"{k} at {jw}: {found} for {response}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("gate_formulas")
    with tempfile.TemporaryDirectory() as name:
        for k in range(10):
            for look in (look_at, holds, edges):
                look(checker, program, pathlib.Path(name), k)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
