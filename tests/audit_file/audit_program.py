"""Runs `dalcs audit` for the tests, and makes tables of waveforms."""

import csv
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "support"))
import dalcs_program  # noqa: E402


class Table:
    """Names and rows of a file of waveforms."""

    def __init__(self, names, rows):
        self.names = list(names)
        self.rows = [list(row) for row in rows]

    def copy(self):
        return Table(self.names, self.rows)

    def index(self, name):
        return self.names.index(name)

    def without(self, *names):
        kept = [k for k, name in enumerate(self.names) if name not in names]
        return Table([self.names[k] for k in kept], [[row[k] for k in kept] for row in self.rows])

    def scaled(self, name, factor):
        made, k = self.copy(), self.index(name)
        for row in made.rows:
            row[k] *= factor
        return made

    def nudged(self, name, time, amount):
        """One number: that of the first row at or behind a time. The table and the row's time."""
        made, k = self.copy(), self.index(name)
        row = next(row for row in made.rows if row[0] >= time)
        row[k] += amount
        return made, row[0]

    def csv(self, form=repr):
        lines = [",".join(f'"{name}"' if "," in name else name for name in self.names)]
        lines += [",".join(form(value) for value in row) for row in self.rows]
        return "\n".join(lines) + "\n"


def simulate(program, netlist, options=()):
    done = dalcs_program.run(program, netlist, method=None, report=False, options=options)
    assert done.status == 0, done.stderr
    reader = csv.reader(done.output.decode("utf-8").splitlines())
    names = next(reader)
    return Table(names, [[float(x) for x in row] for row in reader])


class Audit:
    """What an audit said."""

    def __init__(self, done):
        self.status = done.returncode
        self.stderr = done.stderr
        self.answer = json.loads(done.stdout) if done.stdout.startswith("{") else None
        self.text = done.stdout

    @property
    def broken(self):
        """(law, where) of the laws that are broken, the worst first."""
        return [(law["law"], law["where"]) for law in self.answer["laws"] if law["broken"]]

    def law(self, name, where):
        return next((law for law in self.answer["laws"] if (law["law"], law["where"]) == (name, where)),
                    None)

    @property
    def not_asked(self):
        return {(gap["law"], gap["where"]): gap["because"] for gap in self.answer["not_asked"]}


def audit(program, folder, netlist, content, name="waves.csv", options=("--json",)):
    """content: text, bytes, or a Table, which becomes a .csv file."""
    folder = pathlib.Path(folder)
    (folder / "circuit.cir").write_text(netlist)
    content = content.csv() if isinstance(content, Table) else content
    path = folder / name
    if isinstance(content, bytes):
        path.write_bytes(content)
    else:
        path.write_text(content)
    done = subprocess.run([program, "audit", folder / "circuit.cir", path, *options],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    assert done.returncode >= 0, f"signal {-done.returncode}\n{done.stderr}"
    return Audit(done)
