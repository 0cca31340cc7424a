#!/usr/bin/env python3
"""Raw files by the rules of readers that count, split and match in ways of their own, written anew from what their
sources do. spicelib, the package ltspice and spyci are in raw_readers.py.

usage: other_readers.py PROGRAM

By keys: gwave and gaw, xschem's Tcl and C, two of MATLAB, the reader of many gists, Qucs-S. By the number of the line:
VLSIR of 2025, PySpice, a MATLAB one of six lines; these read what ngspice wrote up to version 43, which had no line
Command, and so they do once that line is left out.
"""

import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM = str(pathlib.Path(sys.argv[1]).resolve())
CIRCUIT = """a filter
V1 in 0 PULSE(0 1 1m 0 0 1m 2m) AC 1
R1 in /sw 1k
C1 /sw 0 1u
.save v(in) v(/sw) v(in,/sw) i(r1)
"""
NAMES = ["v(in)", "v(/sw)", "v(in,/sw)", "i(r1)"]
CARDS = {".tran 0.5m 3m": "time", ".ac dec 2 1 100": "frequency", ".dc V1 0 1 0.5": "v-sweep"}
WITHOUT_COMMAND = ["env", "LC_ALL=C", "sed", r"/^Command: \* ngspice-compatible/d"]


def lines_of(data):
    """Header lines and what is behind the one that ends it."""
    end = re.search(rb"^(Binary|Values):\n", data, re.M)
    return data[:end.start()].decode().split("\n")[:-1], end[1].decode(), data[end.end():]


def doubles(data, n_points, n_variables, is_complex):
    """Columns, of complex numbers as pairs; all bytes are of them."""
    width = n_variables * (2 if is_complex else 1)
    values = struct.unpack(f"<{n_points * width}d", data)
    step = 2 if is_complex else 1
    return [[values[row * width + step * k:row * width + step * (k + 1)] for row in range(n_points)]
            for k in range(n_variables)]


def of_gwave(data):
    """Keys before a colon, others are passed over; names between blanks; the first variable is the scale."""
    lines, _, rest = lines_of(data)
    assert lines[0].startswith("Title:")
    at = lines.index("Variables:")
    values = dict(line.split(":", 1) for line in lines[:at])
    n, points = int(values["No. Variables"]), int(values["No. Points"])
    names = []
    for k, line in enumerate(lines[at + 1:]):
        number, name, kind = line.split()
        assert int(number) == k and kind in ("time", "voltage", "current", "frequency"), line
        names.append(name)
    return names, doubles(rest, points, n, "complex" in values["Flags"].split())


def of_xschem(data):
    """Tcl: the last word of the two counts, names by the second word; C: plots by the beginning of their names."""
    lines, _, rest = lines_of(data)
    counts, names, starts = {}, [], False
    for line in lines:
        found = re.match(r"No\. (Variables|Points):", line)
        if found:
            counts[found[1]] = int(line.split()[-1])
        if starts:
            names.append(line.split()[1].lower())
        starts = starts or line.startswith("Variables:")
    plot = next(line for line in lines if line.startswith("Plotname:"))
    assert re.match(r"Plotname: (Tran|AC |DC |Oper)", plot), plot
    assert len(names) == counts["Variables"]
    return names, doubles(rest, counts["Points"], counts["Variables"], "Flags: complex" in lines)


def of_matlab_tabs(data):
    """Names between the second and the third tab of their lines, which therefore have three."""
    lines, _, rest = lines_of(data)
    points = int(re.match(r"No\. Points: (\d+)", next(line for line in lines if line.startswith("No. Points:")))[1])
    names = [line.split("\t")[2] for line in lines[lines.index("Variables:") + 1:] if line.count("\t") == 3]
    return names, doubles(rest, points, len(names), "Flags: complex" in lines)


def of_matlab_patterns(data):
    """Each field by a pattern of its own in the whole header; nothing but blanks behind a count."""
    lines, _, rest = lines_of(data)
    header = "\n".join(lines)
    field = {}
    for key in ("Date", "Plotname", "Flags", r"No\. Variables", r"No\. Points"):
        field[key] = re.search(rf"(?m)^{key}:\s*(\w.*?\w|\w)\s*$", header)[1]
    assert re.fullmatch(r"\w{3} \w{3} [ \d]\d \d\d:\d\d:\d\d +\d{4}", field["Date"]), field["Date"]
    names = re.findall(r"(?m)^\t\d+\t(\S+)\t\w+$", header)
    return names, doubles(rest, int(field[r"No\. Points"]), int(field[r"No\. Variables"]), field["Flags"] == "complex")


def of_gists(data):
    """Fields that are known, by their first word in small letters; behind "Variables:" so many lines as there are."""
    lines, _, rest = lines_of(data)
    known = ("title", "date", "plotname", "flags", "no. variables", "no. points", "dimensions", "command", "option")
    plot, names = {}, []
    for line in lines:
        key, colon, value = line.partition(":")
        if colon and key.lower() in known:
            plot[key.lower()] = value.strip()
        elif line.startswith("\t"):
            number, name = line.strip().split()[:2]
            assert int(number) == len(names)
            names.append(name)
        else:
            assert line == "Variables:", line
    return names, doubles(rest, int(plot["no. points"]), int(plot["no. variables"]), "complex" in plot["flags"])


def of_seven_lines(data):
    """VLSIR and PySpice: seven lines whose names and order are fixed."""
    lines, kind, rest = lines_of(data)
    values = []
    for name, line in zip(("Title", "Date", "Plotname", "Flags", "No. Variables", "No. Points"), lines):
        key, _, value = line.partition(":")
        if key != name:
            raise ValueError(f"{name} is missing: {line}")
        values.append(value.strip())
    assert lines[6] == "Variables:" and kind == "Binary"
    names = [line.split("\t")[2] for line in lines[7:]]
    return names, doubles(rest, int(values[5]), int(values[4]), values[3] == "complex")


def of_six_lines(data):
    """MATLAB: what is behind the colon of the first six lines, by their numbers."""
    lines, _, rest = lines_of(data)
    six = [line.split(":", 1)[1].strip() for line in lines[:6]]
    names = [line.split()[1] for line in lines if re.match(r"\t\d+\t", line)]
    return names, doubles(rest, int(six[5]), int(six[4]), "complex" in six[3])


def of_qucs(text):
    """Text: counts by their keys, then so many numbers as there are, blanks and lines between them do not count; a pair
    with a comma is complex, the number of a point stands before its scale."""
    lines, kind, rest = lines_of(text)
    assert kind == "Values"
    count = {key: int(value) for key, value in re.findall(r"(?m)^No\. (\w+): *(\d+) *$", "\n".join(lines))}
    words = rest.decode().split()
    names = [line.split()[1] for line in lines if re.match(r"\t\d+\t", line)]
    width = count["Variables"] + 1
    assert len(words) == width * count["Points"]
    for point in range(count["Points"]):
        assert words[point * width] == str(point)
    return names, [[tuple(float(part) for part in words[row * width + 1 + k].split(","))
                    for row in range(count["Points"])] for k in range(count["Variables"])]


class Readers(unittest.TestCase):
    def setUp(self):
        # pylint: disable-next=consider-using-with
        self.kept = tempfile.TemporaryDirectory(prefix="dalcs-readers-")
        self.addCleanup(self.kept.cleanup)
        self.folder = pathlib.Path(self.kept.name)

    def raw(self, card, *options):
        (self.folder / "c.cir").write_text(CIRCUIT + card + "\n.end\n")
        subprocess.run([PROGRAM, "run", "c.cir", "-q", "-o", "c.raw", *options], cwd=self.folder, check=True)
        return (self.folder / "c.raw").read_bytes()

    def test_by_keys(self):
        for card, scale in CARDS.items():
            data = self.raw(card)
            whole = of_qucs(self.raw(card, "--ascii"))
            self.assertEqual(whole[0], [scale, *NAMES])
            for reader in of_gwave, of_xschem, of_matlab_tabs, of_matlab_patterns, of_gists:
                self.assertEqual(reader(data), whole, (card, reader.__doc__))

    def test_by_numbers_of_lines(self):
        """Once the line Command is left out, by the command that the manual has for it."""
        for card in CARDS:
            data = self.raw(card)
            with self.assertRaises(ValueError):
                of_seven_lines(data)
            (self.folder / "six.raw").write_bytes(subprocess.run(
                [*WITHOUT_COMMAND, "c.raw"], cwd=self.folder, check=True, capture_output=True).stdout)
            data = (self.folder / "six.raw").read_bytes()
            self.assertEqual(of_seven_lines(data), of_gwave(data))
            self.assertEqual(of_six_lines(data), of_gwave(data))
            self.assertEqual(of_gwave(data), of_gwave(self.raw(card)))

    def test_operating_point(self):
        """No scale: a row of voltages and currents."""
        self.assertEqual(of_xschem(self.raw(".op"))[0], NAMES)
        self.assertEqual(of_gists(self.raw(".op"))[1], of_qucs(self.raw(".op", "--ascii"))[1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
