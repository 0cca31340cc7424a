#!/usr/bin/env python3
"""The module's structs, constants and calls are those of dalcs.h; its types are complete.

usage: layouts.py SOURCE_FOLDER, with PYTHONPATH=build/src/python
"""

import ctypes
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

from public_header import text_of  # noqa: E402

import dalcs  # noqa: E402
from dalcs import _library as library  # noqa: E402

SOURCE = pathlib.Path(sys.argv[1])
HEADER = SOURCE / "src" / "dalcs.h"
STRUCTS = {"dalcs_plot": library.Plot, "dalcs_row_table": library.RowTable,
           "dalcs_measurement": library.Measurement, "dalcs_sink": library.Sink}
CONSTANTS = {"DALCS_OK": library.OK, "DALCS_SINGULAR": library.SINGULAR,
             "DALCS_NOT_CONVERGED": library.NOT_CONVERGED, "DALCS_INFEASIBLE": library.INFEASIBLE,
             "DALCS_REFUTED": library.REFUTED,
             "DALCS_E_NOMEM": library.E_NOMEM, "DALCS_E_NETLIST": library.E_NETLIST,
             "DALCS_E_OPTION": library.E_OPTION, "DALCS_E_CANCELLED": library.E_CANCELLED, "DALCS_E_INTERNAL": library.E_INTERNAL,
             "DALCS_OPERATING_POINT": library.ANALYSES.index("op"),
             "DALCS_TRANSIENT": library.ANALYSES.index("tran"),
             "DALCS_DC_SWEEP": library.ANALYSES.index("dc"), "DALCS_AC": library.ANALYSES.index("ac"),
             "DALCS_PERIODIC": library.ANALYSES.index("pss"),
             "DALCS_TRANSFER": library.ANALYSES.index("tf"), "DALCS_N_ANALYSES": len(library.ANALYSES),
             "DALCS_VOLT": library.UNITS.index("V"), "DALCS_AMPERE": library.UNITS.index("A"),
             "DALCS_UNIT_SECOND": library.UNITS.index("s"), "DALCS_UNIT_HERTZ": library.UNITS.index("Hz"),
             "DALCS_UNIT_OHM": library.UNITS.index("ohm"), "DALCS_UNIT_NONE": library.UNITS.index(""),
             "DALCS_FORM_DALCS": library.FORMS["dalcs"], "DALCS_FORM_LCS": library.FORMS["lcs"]}


def printed_by(lines):
    """What a program in C prints that sees the header."""
    text = (f'#include "{HEADER}"\n#include <stddef.h>\n#include <stdio.h>\n'
            "int main(void) {\n" + "\n".join(lines) + "\nreturn 0;\n}\n")
    with tempfile.TemporaryDirectory() as folder:
        source, program = pathlib.Path(folder) / "a.c", pathlib.Path(folder) / "a"
        source.write_text(text)
        subprocess.run(["cc", "-std=c11", source, "-o", program], check=True)
        return subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()


class Layouts(unittest.TestCase):
    def test_structs(self):
        wanted, lines = [], []
        for name, struct in STRUCTS.items():
            wanted.append(f"{name} {ctypes.sizeof(struct)}")
            lines.append(f'printf("{name} %zu\\n", sizeof(struct {name}));')
            for field, *_ in struct._fields_:
                offset = getattr(struct, field).offset
                wanted.append(f"{name}.{field} {offset} {getattr(struct, field).size}")
                lines.append(f'printf("{name}.{field} %zu %zu\\n", offsetof(struct {name}, {field}), '
                             f"sizeof(((struct {name} *)0)->{field}));")
        self.assertEqual(printed_by(lines), wanted)

    def test_constants(self):
        found = printed_by([f'printf("{name} %d\\n", (int){name});' for name in CONSTANTS])
        self.assertEqual(found, [f"{name} {value}" for name, value in CONSTANTS.items()])

    def test_calls(self):
        """As many arguments as the header has."""
        plain = re.sub(r"/\*.*?\*/|\(\*\w+\)\([^)]*\)", "", text_of(HEADER), flags=re.DOTALL)
        for name, (_, arguments) in library.CALLS.items():
            declared = re.search(rf"\b{name}\(([^)]*)\)", plain)
            self.assertIsNotNone(declared, name)
            count = 0 if declared[1].strip() == "void" else declared[1].count(",") + 1
            self.assertEqual(len(arguments), count, name)

    def test_version(self):
        self.assertEqual(dalcs.__version__, re.search(r"version: '([\d.]+)'",
                                                      (SOURCE / "meson.build").read_text())[1])

    @unittest.skipUnless(shutil.which("mypy") and os.environ.get("DALCS_TEST_SHORT") != "1", "no mypy, or a short run")
    def test_types(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                ["mypy", "--strict", "--ignore-missing-imports", "--no-error-summary", "--cache-dir", folder,
                 pathlib.Path(dalcs.__file__).parent], capture_output=True, text=True, check=False)
        self.assertEqual((done.stdout, done.returncode), ("", 0), done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
