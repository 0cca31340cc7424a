"""Reads raw files as ngspice writes them, and refuses whatever it would not write."""

import pathlib
import struct

HEADER = ["Title", "Date", "Plotname", "Flags", "Command", "No. Variables", "No. Points"]
TYPES = {"time", "frequency", "voltage", "current", "notype"}


class Plot:
    """One plot: names of columns in order, rows of floats or of complex numbers."""

    def __init__(self, fields, names, types, rows):
        self.fields = fields
        self.name = fields["Plotname"]
        self.flags = fields["Flags"].split()
        self.names = names
        self.types = types
        self.rows = rows

    def column(self, name):
        index = self.names.index(name)
        return [row[index] for row in self.rows]

    def steps(self):
        """The rows of each step: the scale starts again."""
        starts = [k for k, row in enumerate(self.rows) if row[0] == self.rows[0][0]
                  and (k == 0 or self.rows[k - 1][0] != row[0])]
        return [self.rows[a:b] for a, b in zip(starts, starts[1:] + [len(self.rows)])]


def expect(condition, message):
    if not condition:
        raise ValueError(f"raw file: {message}")


def read_line(data, at):
    end = data.index(b"\n", at)
    return data[at:end].decode("utf-8"), end + 1


def read_plot(data, at):
    fields = {}
    for name in HEADER:
        line, at = read_line(data, at)
        expect(line.startswith(name + ":"), f"'{name}:' expected, not '{line}'")
        fields[name] = line[len(name) + 1:].strip()
    expect("ngspice" in fields["Command"], "no dialect in Command, which spicelib looks for")
    flags = fields["Flags"].split()
    expect(flags[0] in ("real", "complex") and flags[1:] in ([], ["stepped"]), f"flags {flags}")
    line, at = read_line(data, at)
    expect(line == "Variables:", line)
    names, types = [], []
    for k in range(int(fields["No. Variables"])):
        line, at = read_line(data, at)
        empty, index, name, kind = line.split("\t")
        expect(empty == "" and index == str(k) and name and kind in TYPES, f"variable '{line}'")
        names.append(name)
        types.append(kind)
    expect(len(set(names)) == len(names), "a name stands twice")
    line, at = read_line(data, at)
    expect(line == "Binary:", line)
    n_points = int(fields["No. Points"])
    width = len(names) * (2 if flags[0] == "complex" else 1)
    size = 8 * width * n_points
    expect(at + size <= len(data), "it is cut short")
    numbers = struct.unpack(f"<{width * n_points}d", data[at:at + size])
    rows = [numbers[k * width:(k + 1) * width] for k in range(n_points)]
    if flags[0] == "complex":
        rows = [tuple(complex(*row[k:k + 2]) for k in range(0, width, 2)) for row in rows]
    return Plot(fields, names, types, rows), at + size


def read(path):
    """All plots of a file."""
    data = pathlib.Path(path).read_bytes()
    plots, at = [], 0
    while at < len(data):
        plot, at = read_plot(data, at)
        plots.append(plot)
    return plots
