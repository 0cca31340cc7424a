"""Runs everything of the work-precision table: dalcs, ngspice and Siconos by turns."""

import json
import math
import os
import statistics
import subprocess

import ngspice_search

DEBIAN_PYTHON = "/usr/bin/python3"  # the one that python3-siconos belongs to
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10)
FINEST = {1: 1e-4, 3: 1e-8, 5: 1e-10, 7: 1e-10}  # by stages: below, the order is too low
LONGEST = 10.0  # s on the wall, of one run


class Row:
    """One setting of one method: its error, work, and CPU times."""

    def __init__(self, method, setting, error=math.inf, worst="", steps=None, factors=None):
        self.method, self.setting = method, setting
        self.error, self.worst, self.steps, self.factors = error, worst, steps, factors
        self.cpu = []
        self.target = None

    @property
    def median(self):
        return statistics.median(self.cpu) if self.cpu else math.inf

    def as_dict(self):
        return {"method": self.method, "setting": self.setting, "error": self.error,
                "worst": self.worst, "cpu_s": self.median, "cpu_min_s": min(self.cpu, default=None),
                "repeats": len(self.cpu), "steps": self.steps, "factorizations": self.factors,
                "target": self.target}


def dalcs_rows(circuit, methods):
    """By bench_radau's text for it."""
    rows = {}
    if "euler" in methods:
        for step in circuit.euler:
            rows[f"method=euler,step={step!r}"] = Row("euler", f"step {step:g} s")
    tolerances = TOLERANCES[:5] if circuit.large else TOLERANCES
    if "radau" in methods:
        for stages, finest in FINEST.items():
            for tolerance in [t for t in tolerances if t >= finest]:
                rows[f"method=radau,stages={stages},tol={tolerance!r}"] = Row(
                    f"radau {stages}", f"tol {tolerance:g}")
    if "auto" in methods:
        for tolerance in tolerances:
            rows[f"method=auto,tol={tolerance!r}"] = Row("auto", f"tol {tolerance:g}")
    return rows


def read_answers(text, rows):
    for line in text.splitlines():
        answer = json.loads(line)
        if "error" in answer:
            row = rows[answer["configuration"]]
            row.error, row.worst = answer["error"], answer["worst"]
            row.steps, row.factors = answer["steps"], answer["factorizations"]
            row.cpu += answer["cpu_s"]


def weed(program, netlist, circuit, rows):
    """Drops what fails or takes too long; returns why, a line each."""
    complaints = []
    for text in list(rows):
        try:
            done = subprocess.run([program, netlist, circuit.values(), "0", text], timeout=LONGEST,
                                  capture_output=True, text=True, check=True)
            read_answers(done.stdout, rows)
            complaint = done.stderr.strip()
        except subprocess.TimeoutExpired:
            complaint = f"{text}: no end within {LONGEST:g} s"
        if rows[text].steps is None:
            complaints.append(complaint)
            del rows[text]
    return complaints


def run_dalcs(program, netlist, circuit, repeats, rows):
    if rows:
        done = subprocess.run([program, netlist, circuit.values(), str(repeats), *rows],
                              capture_output=True, text=True, check=True)
        read_answers(done.stdout, rows)


def search_ngspice(circuit, reference, settings, again, say):
    """The search, made now or recalled from the settings file, and its summary."""
    search = ngspice_search.Search(circuit.text(), reference, circuit.period, circuit.gated,
                                   circuit.large)
    summary = None if again else ngspice_search.load(search, settings, circuit.name)
    if summary is None:
        search.run(say)
        summary = search.summary()
        ngspice_search.save(settings, circuit.name, summary)
    return search, summary


def ngspice_rows(search):
    return {setting: Row("ngspice", str(setting), search.tried[setting].error,
                         search.tried[setting].worst, search.tried[setting].points)
            for setting in search.winners()}


def run_ngspice(search, rows):
    for setting, row in rows.items():
        row.cpu.append(search.runner.time(setting, search.tried[setting].seconds))


def choose_ngspice(search, rows):
    """The fastest row for each target, marked with the sharpest target that it serves."""
    chosen = []
    for target in search.targets():
        good = [row for row in rows.values() if row.error <= target and row.cpu]
        if good:
            best = min(good, key=lambda row: row.median)
            best.target = target
            if best not in chosen:
                chosen.append(best)
    return chosen


def siconos_installed():
    try:
        return subprocess.run([DEBIAN_PYTHON, "-c", "import siconos.kernel"], capture_output=True,
                              check=False).returncode == 0
    except OSError:
        return False


def siconos_rows(circuit):
    return {(theta, step): Row("Siconos", f"theta {theta:g}, step {step:g} s")
            for theta, step in circuit.siconos}


def run_siconos(circuit, here, rows):
    for (theta, step), row in rows.items():
        done = subprocess.run([DEBIAN_PYTHON, here / "siconos_bridges.py", circuit.name,
                               circuit.values(), "1", str(theta), repr(step)],
                              capture_output=True, text=True, check=False,
                              env=os.environ | {"OPENBLAS_NUM_THREADS": "1"})
        lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
        if lines:
            answer = json.loads(lines[0])
            row.error, row.steps = answer["error"], answer["steps"]
            row.cpu += answer["cpu_s"]
