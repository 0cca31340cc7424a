#!/usr/bin/env python3
"""Orbits of two periods of the clock, of a voltage-mode buck converter whose supply is raised (Hamill and Deane); orbits beside
which runs fail.

usage: doubling.py PROGRAM
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

PERIOD = 400e-6  # s
BUCK = """* Its comparator has a gain of 8.4 and a ramp from 3.8 V to 8.2 V
Vin in 0 {volts!r}
S1 in sw ramp con sm
D1 0 sw
L1 sw out 20m
C1 out 0 47u
R1 out 0 22
Vref ref 0 11.3
E1 con 0 out ref 8.4
Vramp ramp 0 PULSE(3.8 8.2 0 400u 0 0 400u)
.model sm SW(Ron=0 Vt=0)
{card}
.end
"""


def run(program, folder, volts, card, verb="steady", options=()):
    (folder / "c.cir").write_text(BUCK.format(volts=volts, card=card))
    done = subprocess.run([program, verb, "c.cir", "-o", "c.csv", "--report", "c.json", "-q",
                           *options], cwd=folder, capture_output=True, text=True, check=False)
    return done, json.loads((folder / "c.json").read_text()) if done.returncode == 0 else {}


def size(multipliers):
    return max(math.hypot(m["re"], m["im"]) for m in multipliers)


def settled(program, folder, checker, volts, steady):
    """One of two runs, the second longer by a period, ends where the orbit begins."""
    periods = 2 * math.ceil(0.65 * math.log(1e-12) / math.log(size(steady["multipliers"])) + 50)
    ends = []
    for n in (periods, periods + 1):
        stop = n * PERIOD
        done, report = run(program, folder, volts, f".tran {stop!r} {stop!r} {stop * 0.999!r} uic",
                           "run", ("--tol", "1e-11", "--fill", "none"))
        if not checker.check(done.returncode == 0, f"{volts} V, run: {done.stderr}"):
            return
        ends.append(report["final"])
    off = min(max(abs(steady["states"][name] / end[name] - 1) for name in end) for end in ends)
    checker.check(off < 1e-9, f"{volts} V: off by {off:.2g} from a run of {periods} periods")


def look_at(program, folder, checker, volts):
    done, report = run(program, folder, volts, ".pss uic")
    if not checker.check(done.returncode == 0, f"{volts} V: {done.stderr}"):
        return
    one = report["steady"]
    checker.check(abs(one["period"] / PERIOD - 1) < 1e-12, f"{volts} V: period {one['period']}")
    done, report = run(program, folder, volts, ".pss periods=2 uic")
    if not checker.check(done.returncode == 0, f"{volts} V, two periods: {done.stderr}"):
        return
    two = report["steady"]
    checker.check(abs(two["period"] / PERIOD - 2) < 1e-12, f"{volts} V: period {two['period']}")
    if volts < 24.5:  # where the orbit of one period is stable, it is that of two, with squares of its multipliers
        checker.check(one["stable"] and "doubled" not in one, f"{volts} V: {one['verdict']}")
        off = max(abs(one["states"][x] / two["states"][x] - 1) for x in one["states"])
        checker.check(off < 1e-9, f"{volts} V: two periods differ by {off:.2g}")
        checker.check(abs(size(one["multipliers"]) ** 2 - size(two["multipliers"])) < 1e-9,
                      f"{volts} V: multipliers of two periods")
        return
    checker.check(not one["stable"] and "periods=2" in one["verdict"], f"{volts} V: {one['verdict']}")
    if not checker.check("doubled" in one and one["doubled"]["stable"],
                         f"{volts} V: {one['verdict']}"):
        return
    off = abs(size(one["doubled"]["multipliers"]) - size(two["multipliers"]))
    checker.check(off < 1e-7, f"{volts} V: multipliers of the two searches differ by {off:.2g}")
    checker.check(two["stable"], f"{volts} V, two periods: {two['verdict']}")
    settled(program, folder, checker, volts, two)


def near_the_border(program, folder, checker):
    """The orbit of two periods leaves that of one as the root of what the supply is beyond the border. As little as they
    are apart, they are two; before the border they are one."""
    border = 24.516572832815474  # V: the multiplier is -1
    apart = []
    for beyond in (1e-5, 1e-4, 1e-3):
        done, report = run(program, folder, border + beyond, ".pss uic")
        one = report.get("steady", {})
        checker.check(done.returncode == 0 and one["doubled"]["stable"], f"{beyond} V beyond: {done.stderr}, {one}")
        done, report = run(program, folder, border + beyond, ".pss periods=2 uic")
        two = report.get("steady", {})
        checker.check(done.returncode == 0 and two["stable"], f"{beyond} V beyond, two: {done.stderr}, {two}")
        apart.append(max(abs(two["states"][x] - one["states"][x]) for x in one["states"]))
        done, report = run(program, folder, border - beyond, ".pss periods=2 uic")
        two = report.get("steady", {})
        checker.check(done.returncode == 0 and two["stable"], f"{beyond} V before, two: {done.stderr}, {two}")
        done, report = run(program, folder, border - beyond, ".pss uic")
        off = max(abs(two["states"][x] - report["steady"]["states"][x]) for x in two["states"])
        checker.check(off < 1e-2 * apart[-1], f"{beyond} V before: {off} apart, not {apart[-1]} as beyond")
    for small, large in zip(apart, apart[1:]):
        checker.close(large / small, math.sqrt(10.0), 0.05, f"{apart} apart")


def beside_gates(program, folder, checker):
    """Peak current control into a battery: a multiplier of -m2/m1, the slopes of the current. Where it is below -1 a run comes to
    where the current is at its peak while the clock is high: the latch does not settle, and the orbit is there all the same."""
    boost, buck, both = ("L1 in sw {1} IC={2}\nS1 sw 0 q 0 sm\nD1 sw out\nVo out 0 {0}\n", "S1 in sw q 0 sm\nD1 0 sw\nL1 sw out {1} IC={2}\nVo out 0 {0}\n",
                         "S1 in sw q 0 sm\nL1 sw 0 {1} IC={2}\nD1 out sw\nVo out 0 -{0}\n")
    for power, vin, vout, coil, peak, multiplier in ((boost, 10, 25, 1e-3, 2.5, -1.5), (boost, 10, 20.1, 1e-3, 2.5, -1.01),
                                                     (buck, 12, 9, 440e-6, 5, -3.0), (buck, 48, 40, 5e-3, 1, -5.0),
                                                     (both, 12, 24, 500e-6, 4, -2.0), (boost, 10, 15, 1e-3, 2.5, -0.5)):
        (folder / "c.cir").write_text(f"* peak\nVin in 0 {vin}\n{power.format(vout, coil, 0.8 * peak)}B1 lim 0 V={peak}-i(L1)\n"
                                      """Vclk clk 0 PULSE(0 1 0 0 0 4u 100u)
A1 lim 0 0 0 0 over 0 0 BUF Ref=0
A2 clk over 0 0 0 0 q 0 SRFLOP
.model sm SW(Ron=0 Vt=0.5)
.pss uic
""")
        done = subprocess.run([program, "steady", "c.cir", "-o", "c.csv", "--report", "c.json", "-q"], cwd=folder, capture_output=True,
                              text=True, check=False)
        name = f"{vin} V, {vout} V"
        if checker.check(done.returncode == 0 and done.stderr == "", f"{name}: {done.returncode}, {done.stderr}"):
            steady = json.loads((folder / "c.json").read_text())["steady"]
            checker.close(steady["multipliers"][0]["re"], multiplier, 1e-9, name)
            checker.check(steady["stable"] == (multiplier > -1), f"{name}: {steady['verdict']}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("doubling")
    with tempfile.TemporaryDirectory() as name:
        for volts in (18.0, 20.5, 22.0, 23.4, 24.2, 25.0, 25.7, 26.5, 27.3, 28.0, 29.1, 30.0):
            look_at(program, pathlib.Path(name), checker, volts)
        near_the_border(program, pathlib.Path(name), checker)
        beside_gates(program, pathlib.Path(name), checker)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
