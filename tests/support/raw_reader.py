"""Reads raw files as strictly as the published readers do: header lines in their order, a Command line
that tells the dialect, variables that are counted, points that are complete."""

import re
import struct

HEADER = ["Title", "Date", "Plotname", "Flags", "Command", "No. Variables", "No. Points"]
DIALECTS = ("ltspice", "qspice", "ngspice", "xyce")


def _line(data, at):
    end = data.index(b"\n", at)
    return data[at:end].decode("ascii"), end + 1


def _header(data, at):
    header = {}
    for key in HEADER:
        text, at = _line(data, at)
        name, colon, value = text.partition(": ")
        if name != key or not colon:
            raise ValueError(f"expected '{key}: ', found {text!r}")
        header[key] = value
    if not any(word in header["Command"].lower() for word in DIALECTS):
        raise ValueError(f"no dialect in {header['Command']!r}")
    text, at = _line(data, at)
    if text != "Variables:":
        raise ValueError(f"expected 'Variables:', found {text!r}")
    names = []
    for k in range(int(header["No. Variables"])):
        text, at = _line(data, at)
        fields = text.split("\t")
        if len(fields) != 4 or fields[0] != "" or int(fields[1]) != k:
            raise ValueError(f"variable {k}: {text!r}")
        if fields[3] not in ("time", "frequency", "voltage", "current"):
            raise ValueError(f"type of variable {k}: {text!r}")
        names.append(fields[2])
    return header, names, at


def _values(data, at, n_variables, n_points):
    points = []
    for index in range(n_points):
        row = []
        for k in range(n_variables):
            text, at = _line(data, at)
            found = re.fullmatch(r" ?(\d+)\t(\S+)" if k == 0 else r"\t(\S+)", text)
            if not found or (k == 0 and int(found.group(1)) != index):
                raise ValueError(f"point {index}, value {k}: {text!r}")
            row.append(float(found.group(found.lastindex)))
        text, at = _line(data, at)
        if text:
            raise ValueError(f"no blank line behind point {index}")
        points.append(row)
    return points, at


def read(path):
    """[(header, names, rows)] of each plot."""
    with open(path, "rb") as file:
        data = file.read()
    plots = []
    at = 0
    while at < len(data):
        header, names, at = _header(data, at)
        n_points = int(header["No. Points"])
        text, at = _line(data, at)
        if text == "Binary:":
            size = 8 * len(names)
            if len(data) < at + size * n_points:
                raise ValueError("the points are not complete")
            rows = [list(struct.unpack_from(f"<{len(names)}d", data, at + size * k))
                    for k in range(n_points)]
            at += size * n_points
        elif text == "Values:":
            rows, at = _values(data, at, len(names), n_points)
        else:
            raise ValueError(f"expected 'Binary:' or 'Values:', found {text!r}")
        plots.append((header, names, rows))
    return plots
