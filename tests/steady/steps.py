#!/usr/bin/env python3
""".step of steady states: each as if it were alone, and the same bytes whatever threads, parts and runs they come from.

usage: steps.py PROGRAM
"""

import csv
import io
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import gate_circuits  # pylint: disable=import-error
import kinds  # pylint: disable=import-error
import oscillators  # pylint: disable=import-error

CASES = pathlib.Path(__file__).resolve().parent / "cases"
NEAR = 1e-9  # of the largest of a column
FACTORS = (0.3, 0.45, 0.6, 0.8, 1.0, 1.2, 1.4, 1.7, 2.0, 2.4, 2.9, 3.5, 4.1, 5.0, 6.2, 7.5, 9.0)


def value_of(netlist, element):
    for line in netlist.splitlines():
        words = line.split()
        if words and words[0].lower() == element:
            return float(words[3])
    raise KeyError(element)


def sweep(element, value):
    return f".step {element} list " + " ".join(repr(factor * value) for factor in FACTORS) + "\n"


def circuits():
    """(name, netlist, element whose value is stepped, what is measured)."""
    for kind, element in (("buck_ccm", "r1"), ("buck_dcm", "l1"), ("boost_ccm", "c1"), ("slow_rectifier", "r2"),
                          ("six_pulse", "rd"), ("multiplier", "ro"), ("coupled", "r1"), ("llc", "ro"),
                          ("hard_edges", "r1")):
        name, body = list(kinds.KINDS[kind]())[1]
        signal = {"multiplier": "b1", "slow_rectifier": "out"}.get(kind, "out")
        yield name, body + ".pss uic\n", element, f".meas pss mean avg v({signal})\n.meas pss most max v({signal})\n"
    for name, body, element, signal in (
            ("hysteretic", list(oscillators.KINDS["hysteretic_buck"]())[1][0], "r1", "out"),
            ("late comparator", list(oscillators.KINDS["late_hysteretic"]())[1][0], "r1", "out"),
            ("latch", gate_circuits.PEAK_CURRENT.split("\n", 1)[1].replace("{S}", "5"), "r1", "out"),
            ("counter", gate_circuits.DIVIDED.split("\n", 1)[1].replace("{S}", "0.5"), "r1", "out")):
        yield name, body + ".pss uic\n", element, f".meas pss mean avg v({signal})\n.meas pss most max v({signal})\n"
    # a controller that saturates; a charge that nothing determines; an orbit that no run stays on
    for name, element, signal in (("buck_vm", "r1", "out"), ("floating_charge", "r1", "m"),
                                  ("buck_pcm", "r1", "out")):
        text = (CASES / f"{name}.cir").read_text().split("\n", 1)[1].replace(".end", "")
        yield name, text, element, f".meas pss mean avg v({signal})\n.meas pss most max v({signal})\n"


class Case:
    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.checker = dalcs_program.Checker("steps")

    def table(self, netlist, *options):
        (self.folder / "c.cir").write_text(netlist)
        (self.folder / "t.csv").unlink(missing_ok=True)
        done = subprocess.run([self.program, "run", "c.cir", "-q", "-o", "none", "--measures", "t.csv", *options],
                              cwd=self.folder, capture_output=True, text=True, check=False)
        self.checker.check(done.returncode == 0, f"{netlist}: {done.stderr}")
        return (self.folder / "t.csv").read_text() if (self.folder / "t.csv").exists() else ""

    def parts(self, netlist, n):
        """Parts that begin within a stretch of steps with a common start."""
        tables = [self.table(netlist, "--shard", f"{k + 1}/{n}") for k in range(n)]
        return tables[0] + "".join(table.split("\n", 1)[1] for table in tables[1:] if table)

    def look_at(self, name, netlist, element, measures):
        value = value_of(netlist, element)
        all_steps = f"* {name}\n{netlist}{measures}{sweep(element, value)}.end\n"
        whole = self.table(all_steps, "--jobs", "1")
        for how, text in (("3 threads", self.table(all_steps, "--jobs", "3")), ("5 parts", self.parts(all_steps, 5)),
                          ("7 parts", self.parts(all_steps, 7))):
            self.checker.check(text == whole, f"{name}: {how} give\n{text}\nnot\n{whole}")
        rows = list(csv.DictReader(io.StringIO(whole)))
        self.checker.check(len(rows) == len(FACTORS), f"{name}: {len(rows)} rows")
        for row in rows[1::3]:
            own = self.table(f"* {name}\n{netlist}{measures}.end\n", "--set", f"{element}={row[element]}")
            alone = next(csv.DictReader(io.StringIO(own)))
            for column in ("mean", "most"):
                largest = max(abs(float(r[column])) for r in rows)
                self.checker.close(float(row[column]), float(alone[column]), NEAR * largest,
                                   f"{name}: {element} = {row[element]}: {column}")


def others(case):
    """The response around each orbit, and a run that leaves it: bytes alone, for both are exact in their orbit."""
    name, body = list(kinds.KINDS["buck_dcm"]())[2]
    text = body.replace("Vin in 0 ", "Vin in 0 DC ").replace("\nVg", " AC 1\nVg", 1)
    steps = sweep("r1", value_of(body, "r1"))
    response = f"* {name}\n{text}.pss uic\n.ac dec 3 10 100k\n.meas ac most max vm(out)\n{steps}.end\n"
    period = 1.0 / 1e5
    leaving = (f"* {name}\n{body}Iload out 0 PWL(0 0 {period} 0 {2 * period} 1m)\n.tran {period} {20 * period} uic=steady\n"
               f".meas tran low min v(out)\n{steps}.end\n")
    for netlist in (response, leaving):
        whole = case.table(netlist, "--jobs", "1")
        case.checker.check(whole.count("\n") == len(FACTORS) + 1 and ",," not in whole, f"{netlist}: {whole}")
        case.checker.check(case.table(netlist, "--jobs", "4") == whole, f"{netlist}: threads differ")
        case.checker.check(case.parts(netlist, 3) == whole, f"{netlist}: parts differ")


def conserved(case):
    """What each step begins with stays as it is in its own orbit, whatever that of another begins with."""
    text = (CASES / "floating_charge.cir").read_text().replace("ic=3", "ic={q}").replace(".end", "")
    netlist = f"{text}.param q=3\n.meas pss mean avg v(m)\n.step q list 1 2 3 4 5 6 7 8 9 10\n"
    rows = list(csv.DictReader(io.StringIO(case.table(netlist))))
    slope = float(rows[1]["mean"]) - float(rows[0]["mean"])
    case.checker.close(slope, 2.0 / 3.0, 1e-9, "charge: of 2 uF beside 1 uF")
    for k, row in enumerate(rows):
        case.checker.close(float(row["mean"]), float(rows[0]["mean"]) + k * slope, 1e-9, f"charge: q = {k + 1}")


def main():
    with tempfile.TemporaryDirectory() as folder:
        case = Case(pathlib.Path(sys.argv[1]).resolve(), folder)
        for name, netlist, element, measures in dalcs_program.some_of(circuits()):
            case.look_at(name, netlist, element, measures)
        others(case)
        conserved(case)
        return case.checker.finish()


if __name__ == "__main__":
    sys.exit(main())
