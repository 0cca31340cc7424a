"""Reads raw files by the rules of spicelib's reader (RawRead, versions 1.3 and 1.4) and of the package
ltspice, as their documentation and sources state them; written anew, no code is theirs.

* The first six bytes are "Title:" in UTF-8, or "Tit" in UTF-16 with the low byte first.
* Header lines are "Key: value" up to "Variables:"; "Binary:" or "Values:" ends the header.
* "No. Points:" and "No. Variables:" are whole numbers above 0; blanks around them do not count.
* "Command:" must name ltspice, qspice, ngspice or xyce, else the dialect must be given.
* Numbers are complex where Flags say so or the plot is "AC Analysis"; else doubles, but for LTspice
  without the flag "double": a double for the scale and floats for the rest.
* A variable is tab, number, tab, name, tab, type; names are the fields of a record, so each is there
  once. The package ltspice splits the line at any blank, so a name has none.
* All plots but "Operating Point" and two others have a scale, the first variable.
* "fastaccess": variable after variable instead of point after point.
* "stepped": a step starts wherever the scale is what it was at the first point; without a scale each
  point is a step. The package ltspice wants the scale to fall back there.
* Values as text: the number of the point, a tab, the scale, then a value on each line, "re,im" where
  complex; empty lines do not count.
* 1.3 reads the first plot of a file only, and its data must end with the file. Later versions read
  plot after plot.
"""

import struct

DIALECTS = ("ltspice", "qspice", "ngspice", "xyce")
WITHOUT_SCALE = ("operating point", "transfer function", "integrated noise")


class Refused(Exception):
    """What those readers would say, or get wrong without a word."""


def expect(condition, message):
    if not condition:
        raise Refused(message)


class Plot:
    def __init__(self, fields, names, types, columns):
        self.fields, self.names, self.types, self.columns = fields, names, types, columns
        self.flags = fields["Flags"].split()
        self.has_scale = fields["Plotname"].lower() not in WITHOUT_SCALE

    def starts(self):
        """The first point of each step."""
        scale = self.columns[0]
        if "stepped" not in self.flags:
            return [0]
        if not self.has_scale:
            return list(range(len(scale)))
        found = [k for k, at in enumerate(scale) if at == scale[0]]
        falls = [0] + [k + 1 for k, (a, b) in enumerate(zip(scale, scale[1:]))
                       if abs(a) > abs(b) and b == scale[0]]
        expect(found == falls, f"steps start at {found}, the scale falls back at {falls}")
        return found

    def step(self, name, index):
        starts = self.starts() + [len(self.columns[0])]
        return self.columns[self.names.index(name)][starts[index]:starts[index + 1]]


def _encoding(data):
    if data[:6] == b"Title:":
        return "utf-8", 1
    expect(data[:6] == "Tit".encode("utf-16-le"), f"no raw file starts with {data[:6]!r}")
    return "utf-16-le", 2


def _header(data, at, encoding, unit):
    lines = []
    while not lines or lines[-1].lower() not in ("binary:", "values:"):
        end = data.find("\n".encode(encoding), at)
        while unit == 2 and end >= 0 and (end - at) % 2:
            end = data.find("\n".encode(encoding), end + 1)
        expect(end >= 0, "the header does not end")
        lines.append(data[at:end].decode(encoding).rstrip("\r"))
        at = end + unit
    return lines, at


def _fields(lines):
    fields = {}
    for line in lines:
        key, _, value = line.partition(":")
        if key.lower() == "variables":
            break
        fields[key.strip()] = value.strip()
    for key in ("Title", "Date", "Plotname", "Flags", "No. Variables", "No. Points"):
        expect(key in fields, f"no '{key}:'")
    for key in ("No. Variables", "No. Points"):
        expect(fields[key].isdigit() and int(fields[key]) > 0, f"{key}: {fields[key]}")
    return fields


def _variables(lines, n):
    block = lines[lines.index("Variables:") + 1:-1]
    expect(len(block) == n, f"{n} variables, {len(block)} lines")
    names, types = [], []
    for k, line in enumerate(block):
        parts = line.lstrip().split("\t")
        expect(len(parts) >= 3 and parts[0] == str(k), f"variable {k}: {line!r}")
        expect(line.split() == parts[:3], f"a blank in {line!r}")
        names.append(parts[1])
        types.append(parts[2])
    expect(len(set(names)) == n, "a name stands twice")
    return names, types


def _formats(fields, dialect):
    """One letter of struct for each variable, and whether pairs are complex."""
    n = int(fields["No. Variables"])
    flags = fields["Flags"].lower()
    is_ac = fields["Plotname"].lower() == "ac analysis"
    if "complex" in flags or is_ac:
        expect("complex" in flags, "an AC Analysis that is not complex")
        return ["dd"] * n
    expect("real" in flags, f"flags {flags}")
    if dialect == "ltspice" and "double" not in flags:
        return ["d"] + ["f"] * (n - 1)
    return ["d"] * n


def _number(values):
    return complex(*values) if len(values) == 2 else values[0]


def _binary(data, at, fields, formats):
    n_points = int(fields["No. Points"])
    size = [struct.calcsize("<" + f) for f in formats]
    end = at + n_points * sum(size)
    expect(end <= len(data), "the points are not complete")
    columns = []
    before = 0
    for f, bytes_each in zip(formats, size):
        if "fastaccess" in fields["Flags"].lower():
            places = [at + n_points * before + bytes_each * k for k in range(n_points)]
        else:
            places = [at + sum(size) * k + before for k in range(n_points)]
        columns.append([_number(struct.unpack_from("<" + f, data, place)) for place in places])
        before += bytes_each
    return columns, end


def _text(data, at, fields, formats, encoding, unit):
    columns = [[] for _ in formats]
    newline = "\n".encode(encoding)

    def line():
        nonlocal at
        end = data.find(newline, at)
        expect(end >= 0, "the values end too early")
        found = data[at:end].decode(encoding).strip()
        at = end + unit
        return found

    for point in range(int(fields["No. Points"])):
        for k, f in enumerate(formats):
            value = line()
            while not value:
                value = line()
            if k == 0:
                index, tab, value = value.partition("\t")
                expect(tab and int(index) == point, f"point {index} in place of {point}")
            parts = value.split(",")
            expect(len(parts) == len(f), f"{value!r} of {fields['Plotname']}")
            columns[k].append(_number([float(part) for part in parts]))
    while data[at:at + unit] == newline:
        at += unit
    return columns, at


def read(path, dialect=None, only_first=False):
    """The plots of a file; only_first: as version 1.3 and the package ltspice do."""
    with open(path, "rb") as file:
        data = file.read()
    encoding, unit = _encoding(data)
    plots, at = [], 0
    while at < len(data):
        lines, at = _header(data, at, encoding, unit)
        fields = _fields(lines)
        found = [d for d in DIALECTS if d in fields.get("Command", "").lower()]
        expect(dialect or len(found) == 1, f"dialect of {fields.get('Command')}: {found}")
        names, types = _variables(lines, int(fields["No. Variables"]))
        formats = _formats(fields, dialect or found[0])
        if lines[-1].lower() == "binary:":
            columns, at = _binary(data, at, fields, formats)
        else:
            columns, at = _text(data, at, fields, formats, encoding, unit)
        plots.append(Plot(fields, names, types, columns))
        expect(not only_first or at == len(data), "data behind the first plot")
    return plots
