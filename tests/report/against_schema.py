#!/usr/bin/env python3
"""Holds the reports of many runs to doc/report.schema.json: every netlist of the tree and every
circuit with an exact solution, with either method; runs that are refused, interrupted, or have
nothing to do.

usage: against_schema.py PROGRAM SOURCE_ROOT

The schema allows no key that it does not describe, and no word where a number belongs: a NaN in a
report fails. What src/report/report.c and the files of its parts write must be all that the schema has, and nothing else.
"""

import json
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import jsonschema

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, some_of  # noqa: E402

METHODS = ("auto", "euler")
# name: the netlist, the exit status, the kind of what is infeasible
MADE = {
    "loop": ("a diode across a source\nV1 a 0 1\nD1 a 0\n.op\n.end\n", 1, "loop"),
    "cutset": ("a diode against a current source\nI1 a 0 1\nD1 a 0\n.op\n.end\n", 1, "cutset"),
    "late": ("a loop that turns forward later\nV1 a 0 PWL(0 -1 1m 1)\nD1 a 0\nR1 a b 1\nC1 b 0 1u\n"
             ".tran 10u 2m\n.end\n", 1, "loop"),
    "ball": ("a ball below the floor\nC1 1 0 1 ic=-1\nG1 0 1 2 0 1\nC2 2 0 1\nE1 3 0 1 0 1\nVs 4 3 0\n"
             "D1 0 4\nF1 0 2 Vs 1\n.tran 1m 2 uic\n.end\n", 1, "derivative"),
    "both": ("\"quotes\\ \u00b5 and no diode\nV1 a 0 1\nR1 a b 1k\nC1 b 0 1u\n.op\n.tran 10u 1m\n"
             ".end\n", 0, None),
    "parts": ("three parts, one of each kind\nV1 a 0 1\nR1 a 0 1k\nC2 b 0 1u ic=1\nR2 b 0 1k\n"
              "I3 0 c 1\nL3 c 0 1m\nR3 c 0 1\n.tran 10u 1m uic\n.end\n", 0, None),
    "charge": ("a charge and a flux\nC1 a 0 1u ic=10\nD1 a b\nC2 b 0 3u\nL1 c 0 1m ic=1\nD2 c 0\n"
               ".tran 10u 1m uic\n.end\n", 0, None),
    "losses": ("steps of losses, a table that is too small\n.param c=1\nV1 a 0 SIN(0 1 1k)\nS1 a b c 0 m\n"
               "R1 b 0 {r}\nVc c 0 PULSE(0 1 0 0 0 0.1m 0.3m)\n.model m SW(Vt=0.5)\n.param r=1\n"
               ".step param r list 1 2\n.tran 10u 1m\n.losses out=r1\n"
               ".switchloss m eon v=(0 0.1) i=(0 0.1) e=(0 0 0 1n)\n.end\n", 0, None),
    "steps": ("a step with a short\n.options dialect=ltspice\nV1 a 0 SIN(0 1 1k)\nD1 a b\nR1 b 0 {r}\n.param r=1\n"
              ".step param r list 1 0 2\n.tran 10u 1m\n.meas tran v max v(b)\n.end\n", 1, "loop"),
    "equal": ("what is not unique\nI1 0 a 1\nD1 a 0\nD2 a 0\nD3 0 m\nD4 m n\nV1 n 0 1\n.op\n.end\n",
              0, None),
}
LONG = ("a run that takes long\nV1 a 0 SIN(0 10 50)\nD1 a b\nC1 b 0 1u\nR1 b 0 1k\n"
        ".tran 0.1 1e6 uic\n.end\n")  # more rows would not fit on small disks
WRONG = "an element that cannot be\nR1 a 0 abc\n.op\n.end\n"


def no_constant(word):
    raise ValueError(f"{word} is no JSON")


def written_keys(source):
    """The keys that report.c names, those of elements and components not counted."""
    found = re.findall(r'\(&?json,\s+(?:[^",;]*\? )?"(\w+)"(?: : "(\w+)")?', source)
    return {key for keys in found for key in keys if key}


def described_keys(schema):
    keys = set()
    for name, part in schema.items() if isinstance(schema, dict) else enumerate(schema):
        if name == "properties":
            keys |= set(part)
        if isinstance(part, (dict, list)):
            keys |= described_keys(part)
    return keys


def open_objects(schema, where="report"):
    """The objects of the schema that let unknown keys pass."""
    found = []
    if isinstance(schema, dict) and schema.get("type") == "object" and (
            schema.get("additionalProperties", True) is True):
        found.append(where)
    items = schema.items() if isinstance(schema, dict) else enumerate(schema)
    for name, part in items:
        if isinstance(part, (dict, list)):
            found += open_objects(part, f"{where}.{name}")
    return found


def kind_of(value):
    """The properties of a value that the schema checks: its type, its sign and whether it is 1."""
    if isinstance(value, dict):
        return tuple((name, kind_of(part)) for name, part in value.items())
    if isinstance(value, list):
        return tuple(kind_of(part) for part in value)
    if isinstance(value, (bool, str)) or value is None:
        return repr(value)
    return (type(value), value == int(value), value > 0, value < 0, value >= 1)


def without_repetition(value):
    """The same with one object of each kind in each list: a run may have thousands of equal events, and to
    validate one takes longer than to simulate it."""
    if isinstance(value, dict):
        return {name: without_repetition(part) for name, part in value.items()}
    if isinstance(value, list) and value and all(isinstance(part, dict) for part in value):
        return [without_repetition(part) for part in {kind_of(part): part for part in value}.values()]
    return value


class Reports:
    def __init__(self, program, validator, folder):
        self.program = program
        self.validator = validator
        self.folder = folder
        self.checker = Checker("report")

    def command(self, netlist, method):
        return [self.program, "run", str(netlist), "-q", "-o", "out.csv", "--report", "report.json",
                "--method", method]

    def validated(self, label, status):
        """Reads, checks and removes the report."""
        saved = self.folder / "report.json"
        if not self.checker.check(saved.exists(), f"{label}: no report, exit {status}"):
            return {}
        report = json.loads(saved.read_text(encoding="utf-8"), parse_constant=no_constant)
        saved.unlink()
        for error in self.validator.iter_errors(without_repetition(report)):
            self.checker.check(False, f"{label}: {error.json_path}: {error.message[:200]}")
        self.checker.check((report.get("status") == "ok") == (status == 0),
                           f"{label}: exit {status} with status {report.get('status')}")
        return report

    def run(self, netlist, method):
        done = subprocess.run(self.command(netlist, method), cwd=self.folder, check=False,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True)
        label = f"{netlist.name} with {method}"
        self.checker.check(done.returncode in (0, 1),
                           f"{label}: exit {done.returncode}: {done.stderr}")
        return done.returncode, self.validated(label, done.returncode)

    def made(self, name, text, wanted, kind):
        netlist = self.folder / f"{name}.cir"
        netlist.write_text(text, encoding="utf-8")
        for method in METHODS:
            status, report = self.run(netlist, method)
            self.checker.check(status == wanted, f"{name} with {method}: exit {status}")
            found = report.get("infeasible", {}).get("kind")
            self.checker.check(found == kind, f"{name} with {method}: infeasible {found}")

    def interrupted(self, method):
        netlist = self.folder / "long.cir"
        netlist.write_text(LONG)
        with subprocess.Popen(self.command(netlist, method), cwd=self.folder,
                              stderr=subprocess.DEVNULL) as process:
            deadline = time.monotonic() + 60
            while time.monotonic() < deadline and not any(
                    path.stat().st_size > 1 << 16 for path in self.folder.glob("*.partial-*")):
                time.sleep(0.02)
            process.send_signal(signal.SIGINT)
            process.wait(timeout=60)
        report = self.validated(f"interrupted {method}", process.returncode)
        self.checker.check(report.get("status") == "cancelled", f"ended as {report.get('status')}")

    def wrong(self):
        """A netlist with errors has no report."""
        netlist = self.folder / "wrong.cir"
        netlist.write_text(WRONG)
        done = subprocess.run(self.command(netlist, "auto"), cwd=self.folder, check=False,
                              capture_output=True)
        self.checker.check(done.returncode == 3 and not (self.folder / "report.json").exists(),
                           f"a wrong netlist: exit {done.returncode}, or a report was left")


DETAILS = {"at", "with", "targ", "trig"}  # of measurements, by the kind of each


def main():
    program, root = (pathlib.Path(name).resolve() for name in sys.argv[1:])
    schema = json.loads((root / "doc" / "report.schema.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    source = "".join((root / "src" / "report" / name).read_text(encoding="utf-8")
                     for name in ("report.c", "losses_json.c", "measurements_json.c", "response_json.c",
                                  "sensitivity_json.c", "steady_json.c", "worst_case_json.c", "failed_steps_json.c"))
    netlists = sorted((root / "netlists").glob("**/*.cir")) + sorted(
        (root / "tests" / "reference").glob("*.cir"))
    with tempfile.TemporaryDirectory() as name:
        reports = Reports(str(program), jsonschema.Draft202012Validator(schema), pathlib.Path(name))
        check = reports.checker.check
        written, described = written_keys(source), described_keys(schema)
        check(written, "no keys were found in report.c")
        check(written <= described, f"not in the schema: {sorted(written - described)}")
        check(described <= written | {"because"} | DETAILS,
              f"in the schema alone: {sorted(described - written)}")
        check(not open_objects(schema), f"any key may be in {open_objects(schema)}")
        check(len(netlists) >= 80, f"only {len(netlists)} netlists were found")
        for netlist in some_of(netlists):
            for method in METHODS:
                reports.run(netlist, method)
        for netlist in sorted((root / "tests" / "steady" / "cases").glob("*.cir")):
            if netlist.stem != "two_clocks":  # which are refused before a run
                reports.run(netlist, "auto")
        loop = reports.folder / "loop.cir"
        text = (root / "tests" / "steady" / "cases" / "buck_vm.cir").read_text(encoding="utf-8")
        loop.write_text(text.replace("\n.end", "\n.ac dec 5 100 500k loop=vinj\n.sens\n.four 100k 3 v(out)\n"),
                        encoding="utf-8")
        report = reports.run(loop, "auto")[1]
        check(report.get("response", {}).get("crossovers"), f"no margins: {report.get('response')}")
        check(report.get("sensitivity", {}).get("results"), f"no sensitivities: {report.get('sensitivity')}")
        worst = reports.folder / "worst.cir"
        worst.write_text("tolerances\nV1 in 0 1\nR1 in a 1k DEV=5%\nC1 a 0 {aunif(1u,0.5u)}\n.tran 1u 1m\n"
                         ".meas tran v max v(a)\n.wcase\n.end\n", encoding="utf-8")
        status, report = reports.run(worst, "auto")
        check(status == 0 and report.get("worst_case", {}).get("results"), f"no worst case: {report}")
        for name, (text, status, kind) in MADE.items():
            reports.made(name, text, status, kind)
        for method in METHODS:
            reports.interrupted(method)
        reports.wrong()
    return reports.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
