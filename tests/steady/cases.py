#!/usr/bin/env python3
"""The reference circuits: states, multipliers, means and events against values of another program.

usage: cases.py PROGRAM

cases/NAME.json is what a prototype with matrix exponentials and an event logic of its own has found.
"""

import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

CASES = pathlib.Path(__file__).resolve().parent / "cases"
MOST_STEPS = 10


def steady(program, folder, netlist, *options):
    (folder / "c.cir").write_text(netlist)
    (folder / "c.json").unlink(missing_ok=True)
    done = subprocess.run([program, "steady", "c.cir", "-o", "c.csv", "--report", "c.json", *options],
                          cwd=folder, capture_output=True, text=True, check=False)
    path = folder / "c.json"
    return done, json.loads(path.read_text()) if path.exists() else {}


def compare_states(checker, name, expected, report):
    states = report["steady"]["states"]
    for unit in "cl":
        mine = {k: v for k, v in expected.items() if k[0] == unit}
        scale = max((abs(v) for v in mine.values()), default=0.0)
        for element, value in mine.items():
            off = abs(states[element] - value)
            # a coil that is empty is so to the last digits of its largest current
            checker.check(off <= 1e-9 * max(scale, 1e-3), f"{name}: {element} is off by {off:.3g}")


def compare_multipliers(checker, name, expected, report):
    mine = [complex(m["re"], m["im"]) for m in report["steady"]["multipliers"]]
    mine = [m for m in mine if abs(m) > 1e-9]
    checker.check(len(mine) == len(expected), f"{name}: multipliers {mine}")
    for re_part, im_part in expected:
        off = min(abs(m - complex(re_part, im_part)) for m in mine)
        checker.check(off <= 1e-7, f"{name}: the multiplier {re_part}+{im_part}j is off by {off:.2g}")


def compare_signals(checker, name, expected, report):
    signals = report["steady"]["signals"]
    for signal, value in expected.items():
        if signal not in signals:
            continue
        scale = max(abs(value["min"]), abs(value["max"]))
        for mine, its in (("average", "mean"), ("rms", "rms")):
            off = abs(signals[signal][mine] - value[its]) / scale
            checker.check(off <= 1e-9, f"{name}: {its} of {signal} is off by {off:.2g}")


def compare_events(checker, name, expected, report):
    period = report["steady"]["period"]
    for event in expected:
        if event["time"] <= 0.0:
            continue
        off = min((abs(e["time"] - event["time"]) for e in report["events"]
                   if e["element"] == event["element"] and e["state"] == event["state"]),
                  default=period)
        checker.check(off <= 1e-9 * period, f"{name}: {event} is off by {off:.2g} s")


def look_at(checker, program, folder, name, netlist, expected):
    for options in ([], ["--tol", "1e-3"], ["--tol", "1e-11"]):
        done, report = steady(program, folder, netlist, *options)
        if not checker.check(done.returncode == 0, f"{name} {options}: {done.stderr}"):
            continue
        found = report["steady"]
        checker.check(found["newton"] <= MOST_STEPS, f"{name}: {found['newton']} Newton steps")
        checker.check(found["periods"] <= 20, f"{name}: {found['periods']} periods")
        checker.check(found["defect"] <= 1e-10, f"{name}: the defect is {found['defect']:.2g}")
        checker.check("audit" in report, f"{name}: not audited")
        compare_states(checker, name, expected["states"], report)
        compare_multipliers(checker, name, expected["multipliers"], report)
        compare_signals(checker, name, expected.get("signals", {}), report)
        compare_events(checker, name, expected.get("events", []), report)
        if "stable" in expected:
            checker.check(found["stable"] == expected["stable"], f"{name}: {found['verdict']}")


def slopes(checker, program, folder):
    """Slope compensation: the multiplier passes -1 at a ramp of 50 mV."""
    netlist = (CASES / "buck_pcm.cir").read_text()
    for row in json.loads((CASES / "buck_pcm_ramp.json").read_text())["rows"]:
        ramp = re.sub(r"Vramp x3 x2 PULSE\(0 0", f"Vramp x3 x2 PULSE(0 {-row['ramp']!r}", netlist)
        ramp = re.sub(r"DC 0\.66", f"DC {row['vc']!r}", ramp)
        done, report = steady(program, folder, ramp)
        name = f"ramp of {row['ramp']}"
        if checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
            compare_states(checker, name, row["states"], report)
            compare_multipliers(checker, name, [[row["fast_multiplier"], 0],
                                                [row["slow_multiplier"], 0]], report)
            is_doubled = "two periods" in report["steady"]["verdict"]
            checker.check(is_doubled == (row["fast_multiplier"] < -1), f"{name}: {is_doubled}")


def doubled(checker, program, folder):
    """At 40 mV the orbit of one period is unstable, and one of two periods is not: a run settles there."""
    netlist = (CASES / "buck_pcm.cir").read_text()
    netlist = netlist.replace("PULSE(0 0", "PULSE(0 -0.04").replace("DC 0.66", "DC 0.684")
    done, single = steady(program, folder, netlist)
    checker.check("periods=2" in done.stdout, f"doubled: {done.stdout}")
    done, double = steady(program, folder, netlist, "--period", "20u")
    if not checker.check(done.returncode == 0 and double["steady"]["stable"],
                         f"20 us: {done.stderr}{done.stdout}"):
        return
    checker.check(abs(double["steady"]["period"] - 20e-6) < 1e-18, "the period is not 20 us")
    apart = abs(double["steady"]["states"]["l1"] - single["steady"]["states"]["l1"])
    checker.check(apart > 0.01, f"the two orbits are the same but for {apart:.2g} A")
    with open(folder / "c.csv", encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    middle = next(float(row["i(l1)"]) for row in rows if float(row["time"]) >= 10e-6 * (1 - 1e-12))
    (folder / "c.cir").write_text(netlist.replace(".pss uic", ".tran 8m 20m uic"))
    subprocess.run([program, "run", "c.cir", "-q", "--tol", "1e-11", "--report", "c.json", "-o",
                    "c.csv"], cwd=folder, capture_output=True, check=False)
    final = json.loads((folder / "c.json").read_text())["final"]["l1"]
    # the run may be in either of the two periods
    off = min(abs(double["steady"]["states"]["l1"] - final), abs(middle - final))
    checker.check(off < 1e-8, f"i(l1) is off by {off:.2g} from where a run settles")


def slow(checker, program, folder):
    """The bridge with 100 F: a multiplier of 1 - 6e-6, where a residual of 1e-11 would leave 2e-6."""
    netlist = (CASES / "bridge.cir").read_text().replace("10m", "100")
    done, report = steady(program, folder, netlist)
    if checker.check(done.returncode == 0, f"slow: {done.stderr}"):
        found = report["steady"]
        checker.check(found["distance"] <= 1e-9, f"slow: within {found['distance']:.2g}")
        checker.check(found["newton"] <= MOST_STEPS, f"slow: {found['newton']} Newton steps")
        mean = found["signals"]["v(out)"]["average"]
        # the mean hardly depends on the ripple, which is of 10 mF in the reference
        checker.check(abs(mean - 15.36008) < 1e-3, f"slow: v(out) is {mean}")


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("cases")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for case in dalcs_program.kinds_of(("bridge", "buck_ccm", "buck_dcm", "buck_pcm", "buck_vm", "floating_charge",
                                            "llc")):
            look_at(checker, program, folder, case, (CASES / f"{case}.cir").read_text(),
                    json.loads((CASES / f"{case}.json").read_text()))
        slopes(checker, program, folder)
        doubled(checker, program, folder)
        slow(checker, program, folder)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
