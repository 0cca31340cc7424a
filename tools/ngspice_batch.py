"""Runs ngspice in batch mode and reads its raw file."""

import array
import dataclasses
import re
import shutil
import subprocess
import sys
import time

NGSPICE = "ngspice"


class NoNgspice(Exception):
    """ngspice is not installed."""


@dataclasses.dataclass
class Table:
    """Columns by name; "time" is the first for a transient analysis."""

    names: list
    columns: list  # of array('d')

    def column(self, name):
        return self.columns[self.names.index(name)]

    def _parts(self, name):
        """The columns that a signal is made of: v(a,b) may be one of its own or two voltages."""
        if name in self.names or not name.startswith("v("):
            return [name]
        return [f"v({node})" for node in name[2:-1].split(",") if node != "0"]

    def has(self, name):
        return all(part in self.names for part in self._parts(name))

    def signal(self, name):
        """A column, or the difference of two for v(a,b)."""
        first, *second = (self.column(part) for part in self._parts(name))
        if name.startswith("v(0,") and name not in self.names:
            return [-a for a in first]
        return [a - b for a, b in zip(first, second[0])] if second else first

    @property
    def n_rows(self):
        return len(self.columns[0]) if self.columns else 0


def read_raw(path):
    """The last plot of a binary raw file with real values."""
    data = path.read_bytes()
    place, table = 0, None
    while place < len(data):
        marker = data.find(b"Binary:\n", place)
        if marker < 0:
            break
        header = data[place:marker].decode("utf-8", "replace").splitlines()
        fields = dict(line.split(":", 1) for line in header if ":" in line and line[0] != "\t")
        n_names, n_points = int(fields["No. Variables"]), int(fields["No. Points"])
        names = [line.split("\t")[2].lower() for line in header if line.startswith("\t")]
        start = marker + len(b"Binary:\n")
        place = start + 8 * n_names * n_points
        values = array.array("d")
        values.frombytes(data[start:place][:8 * n_names * ((len(data) - start) // (8 * n_names))])
        if sys.byteorder != "little":
            values.byteswap()
        table = Table(names, [values[k::n_names] for k in range(n_names)])
    return table


@dataclasses.dataclass
class Outcome:
    table: Table  # None when it failed
    seconds: float
    reason: str  # why it failed, in ngspice's words


def reason_in(log):
    for line in log.splitlines():
        low = line.lower()
        if any(word in low for word in ("timestep too small", "singular", "error", "fatal",
                                        "no convergence", "aborted")):
            return line.strip()
    return "no reason given"


def version():
    """39 for ngspice-39, 0 when it does not say."""
    if not shutil.which(NGSPICE):
        raise NoNgspice
    said = subprocess.run([NGSPICE, "--version"], stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=60, check=False).stdout
    found = re.search(r"ngspice-(\d+)", said)
    return int(found[1]) if found else 0


def in_its_order(netlist_text):
    """Version 44 reads AM(a b c f g delay) and SFFM(a b g index f delay phases) where dalcs and version 39 read
    a source of a and AM(c b/c f g delay), and SFFM(a b f index g phases)."""
    if version() < 44:
        return netlist_text

    def am(found):
        amplitude, offset, *rest = found[1].split()
        return f"AM(0 {float(amplitude) * float(offset)!r} {amplitude} {' '.join(rest)})"

    def sffm(found):
        offset, amplitude, carrier, index, signal, *phases = found[1].split()
        phases = ["0", *(phases + ["0"])[1::-1]] if phases else []
        return f"SFFM({' '.join([offset, amplitude, signal, index, carrier, *phases])})"

    return re.sub(r"\bSFFM\(([^)]*)\)", sffm, re.sub(r"\bAM\(([^)]*)\)", am, netlist_text))


def run(netlist_text, folder, stop, timeout):
    """Simulates; `stop` is the time that the results must reach, None for an operating point."""
    if not shutil.which(NGSPICE):
        raise NoNgspice
    netlist, raw = folder / "ngspice.cir", folder / "ngspice.raw"
    netlist.write_text(netlist_text)
    raw.unlink(missing_ok=True)
    started = time.perf_counter()
    try:
        done = subprocess.run([NGSPICE, "-n", "-b", "-r", str(raw), str(netlist)], cwd=folder,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=timeout,
                              check=False)
    except subprocess.TimeoutExpired:
        return Outcome(None, timeout, f"no end within {timeout:g} s")
    seconds = time.perf_counter() - started
    log = (done.stdout + done.stderr).decode("utf-8", "replace")
    table = read_raw(raw) if raw.exists() else None
    if table is None or table.n_rows == 0:
        return Outcome(None, seconds, reason_in(log))
    if stop is not None and table.column("time")[-1] < stop * (1 - 1e-9):
        return Outcome(None, seconds, f"stopped at {table.column('time')[-1]:.4g} s: "
                                      f"{reason_in(log)}")
    return Outcome(table, seconds, "")
