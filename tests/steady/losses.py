#!/usr/bin/env python3
"""Losses of orbits: what comes in goes out or is lost, nothing is stored, and a settled run loses the same.

usage: losses.py PROGRAM
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import kinds  # pylint: disable=import-error

CASES = pathlib.Path(__file__).resolve().parent / "cases"
ROUNDING = 1e-9  # of what was moved
KINDS = ("buck_dcm", "boost_ccm", "slow_rectifier", "six_pulse", "coupled", "llc", "scales", "hard_edges")


class Case:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.checker = dalcs_program.Checker("losses of orbits")

    def run(self, verb, netlist, *options):
        (self.folder / "c.cir").write_text(netlist)
        (self.folder / "c.json").unlink(missing_ok=True)
        return subprocess.run([self.program, verb, "c.cir", "-o", "none", "--report", "c.json", *options],
                              cwd=self.folder, capture_output=True, text=True, check=False)

    def losses(self, verb, netlist, *options):
        done = self.run(verb, netlist, *options)
        if not self.checker.check(done.returncode == 0, f"{netlist}: {done.stderr}"):
            return None
        report = json.loads((self.folder / "c.json").read_text())
        self.checker.check(len(report.get("losses", [])) >= 1, f"{netlist}: no losses")
        return report

    def refuses(self, verb, netlist, words, status, *options):
        done = self.run(verb, netlist, *options)
        self.checker.check(done.returncode == status and words in done.stderr,
                           f"{netlist}: status {done.returncode}, {done.stderr!r}, not {words!r}")


def moved(loss):
    return (loss["to"] - loss["from"]) * sum(abs(e["power"]) for e in loss["elements"])


def balanced(case):
    """Without an end or a beginning an orbit stores nothing, jumps at its edges included."""
    for kind in KINDS:
        for name, body in dalcs_program.some_of(kinds.KINDS[kind]()):
            report = case.losses("steady", f"* {name}\n{body}.pss uic\n.losses\n")
            if report is None:
                continue
            loss, steady = report["losses"][0], report["steady"]
            case.checker.check(loss["analysis"] == "pss" and loss["from"] == 0 and loss["to"] == steady["period"],
                               f"{name}: from {loss['from']} to {loss['to']}")
            most = ROUNDING * moved(loss)
            case.checker.close(loss["balance"], 0.0, most, f"{name}: balance")
            case.checker.close(loss["stored_change"], 0.0, most, f"{name}: stored")
            for element in loss["elements"]:
                if element["kind"] in ("coil", "capacitor"):
                    case.checker.close(element["stored_change"], 0.0, most, f"{name}: in {element['element']}")


def settled(case):
    """The same numbers as a window of one period behind a run that has settled."""
    for kind in ("buck_dcm", "hard_edges"):
        for name, body in list(kinds.KINDS[kind]())[:3]:
            head = f"* {name}\n{body}"
            report = case.losses("steady", head + ".pss uic\n.losses\n")
            if report is None:
                continue
            period = report["steady"]["period"]
            largest = max(math.hypot(m["re"], m["im"]) for m in report["steady"]["multipliers"])
            n = math.ceil(math.log(1e-12) / math.log(largest)) + 20
            run = case.losses("run", f"{head}.tran {period!r} {(n + 1) * period!r} uic\n"
                              f".losses from={n * period!r} to={(n + 1) * period!r}\n", "--tol", "1e-10")
            if run is None:
                continue
            for of_orbit, of_run in zip(report["losses"][0]["elements"], run["losses"][0]["elements"]):
                scale = max(abs(e["power"]) for e in run["losses"][0]["elements"])
                case.checker.close(of_orbit["power"], of_run["power"], 1e-7 * scale, f"{name}: {of_run['element']}")


def figures(case):
    """Power factor and THD of the bridge of the study, from its harmonics; efficiency of a buck converter."""
    report = case.losses("steady", (CASES / "bridge.cir").read_text().replace(".end", ".losses\n.end"))
    source = next(e for e in report["losses"][0]["elements"] if e.get("thd") is not None)
    case.checker.close(source["power_factor"], 0.671539, 1e-6, "bridge: power factor")
    case.checker.close(source["thd"], 1.1034, 1e-4, "bridge: THD")
    buck = ("Buck\nVin in 0 12\nVg g 0 PULSE(0 1 0 0 0 4u 10u)\nS1 in sw g 0 sm\nD1 0 sw dm\nL1 sw out 50u\n"
            "C1 out 0 20u\nR1 out 0 2\n.model sm SW(Ron=0 Vt=0.5)\n.model dm D(Vfwd=0.5 Ron=0)\n.pss uic\n")
    loss = case.losses("steady", buck, "--losses")["losses"][0]
    mean = 0.4 * 12 - 0.6 * 0.5  # V at the output
    ampere = mean / 2
    ripple = (mean + 0.5) * 6e-6 / 50e-6
    case.checker.close(-next(e["power"] for e in loss["elements"] if e["element"] == "vin"), 12 * 0.4 * ampere,
                       1e-4 * ampere * ripple, "buck: power of the source")
    case.checker.close(loss["efficiency"], mean / (mean + 0.6 * 0.5), 1e-4, "buck: efficiency")
    both = case.losses("run", buck + ".tran 1u 200u uic\n.losses from=100u\n")["losses"]
    case.checker.check([one["analysis"] for one in both] == ["pss", "tran"] and both[1]["from"] == 100e-6,
                       f"both: {[(one['analysis'], one['from']) for one in both]}")
    stepped = case.losses("steady", buck + ".step r1 list 2 3\n.losses\n")["losses"]
    case.checker.check([one.get("step") for one in stepped] == ["r1 = 2", "r1 = 3"], f"steps: {stepped}")
    case.refuses("steady", buck + ".losses from=1u\n", "of its whole orbit", 3)
    case.refuses("steady", buck, "of its whole orbit", 2, "--losses=1u:2u")
    case.refuses("run", buck, "of its whole orbit", 3, "--losses=1u:2u")
    case.refuses("bode", buck, "--losses is an option of 'dalcs run' and 'dalcs steady'", 2, "--losses")


def main():
    with tempfile.TemporaryDirectory() as folder:
        case = Case(pathlib.Path(sys.argv[1]).resolve(), folder)
        for look in (balanced, settled, figures):
            look(case)
        return case.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
