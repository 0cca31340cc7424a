#!/usr/bin/env python3
"""What a circuit without a clock comes to beside an orbit of its own that is unstable: Chua's.

usage: chua.py PROGRAM

* Chaos: how fast two runs part is known of the equations with the tangents of their lines, by Runge and Kutta's method.
* Behind a period doubling the orbit of two periods has 1 - 4 d as its factor where that of one has -1 - d.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

C1, C2, L, R0 = 10e-9, 100e-9, 18e-3, 12.5
OUTER, INNER, CORNER = 0.41e-3, 0.76e-3, 1.7
DURATION, STEP = 0.2, 4e-6  # s: the mean over 0.6 s is within 5 % of this one
NEAR = 0.2


def netlist(ohms):
    return (f"Chua's circuit\nC1 a 0 {C1!r} IC=0.1\nC2 b 0 {C2!r}\nR1 a b {ohms!r}\nL1 b l {L!r}\nR0 l 0 {R0!r}\n"
            f"B1 a 0 I=-{OUTER!r}*v(a)-{0.5 * (INNER - OUTER)!r}*(abs(v(a)+{CORNER})-abs(v(a)-{CORNER}))\n"
            ".pss osc uic\n.end\n")


def rates(state, ohms):
    """Of the states, and of a small difference beside them."""
    a, b, i, da, db, di = state
    line = INNER if abs(a) < CORNER else OUTER
    source = -OUTER * a - 0.5 * (INNER - OUTER) * (abs(a + CORNER) - abs(a - CORNER))
    return (((b - a) / ohms - source) / C1, ((a - b) / ohms - i) / C2, (b - R0 * i) / L,
            ((db - da) / ohms + line * da) / C1, ((da - db) / ohms - di) / C2, (db - R0 * di) / L)


def growth(ohms):
    """1/s, of a difference."""
    state, total = (0.1, 0.0, 0.0, 1.0, 0.3, 1e-3), 0.0
    n = int(DURATION / STEP)
    for k in range(n):
        k1 = rates(state, ohms)
        k2 = rates([x + 0.5 * STEP * r for x, r in zip(state, k1)], ohms)
        k3 = rates([x + 0.5 * STEP * r for x, r in zip(state, k2)], ohms)
        k4 = rates([x + STEP * r for x, r in zip(state, k3)], ohms)
        state = [x + STEP / 6 * (p + 2 * q + 2 * r + s) for x, p, q, r, s in zip(state, k1, k2, k3, k4)]
        size = math.hypot(state[3], state[4], 1e3 * state[5])
        total += math.log(size) if k >= n // 10 else 0.0
        state[3:] = [x / size for x in state[3:]]
    return total / (STEP * (n - n // 10))


def steady(checker, program, folder, ohms):
    (folder / "c.cir").write_text(netlist(ohms))
    done = subprocess.run([program, "steady", "c.cir", "-o", "none", "--report", "c.json"], cwd=folder,
                          capture_output=True, text=True, check=False)
    checker.check(done.returncode == 0 and done.stderr == "", f"{ohms} Ohm: {done.stderr}")
    return json.loads((folder / "c.json").read_text())["steady"]


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("Chua's circuit")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        found = steady(checker, program, folder, 1750.0)
        attractor = found.get("attractor", {})
        if checker.check(not found["stable"] and attractor.get("kind") == "chaos", found["verdict"]):
            rate, expected = math.log(attractor["growth"]) / found["period"], growth(1750.0)
            checker.check(abs(rate / expected - 1) <= NEAR, f"differences grow by {rate}/s, not {expected}/s")
        found = steady(checker, program, folder, 1870.0)
        doubled, factor = found.get("doubled", {}), found["multipliers"][0]["re"]
        if checker.check(factor < -1 and doubled.get("stable", False), found["verdict"]):
            other = math.hypot(doubled["multipliers"][0]["re"], doubled["multipliers"][0]["im"])
            checker.check(abs(other - (1 + 4 * (1 + factor))) <= 0.01, f"factors {factor}, {other}")
            checker.check(1e-5 < abs(doubled["period"] / found["period"] - 2) < 1e-2, f"periods {found['period']}, {doubled}")
            checker.check("periods=2" not in found["verdict"] and "attractor" not in found, found["verdict"])
        found = steady(checker, program, folder, 1900.0)
        checker.check(found["stable"] and "attractor" not in found, found["verdict"])
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
