#!/usr/bin/env python3
"""Programs that were built with an older and with a newer dalcs.h run with this library, or are told why not.

usage: versions.py BUILD_FOLDER HEADER

The headers are made of this one: the older lacks the last options of a run, the newer has one more.
"""

import ctypes
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

from public_header import text_of  # noqa: E402

PROGRAM = """
#include "dalcs.h"
#include <math.h>
#include <string.h>

static enum dalcs_status keep(void *user, double time, const double *value) {
    *(double *)user = time == 0.0 ? *(double *)user : value[1];
    return DALCS_OK;
}

int main(void) {
    static const char netlist[] = "RC\\nV1 in 0 1\\nR1 in out 1k\\nC1 out 0 1u\\n.tran 1u 1m uic\\n";
    struct { struct dalcs_run_options options; char behind[64]; } room;
    struct dalcs_session *s;
    double end = 0.0;
    const struct dalcs_sink sink = {.user = &end, .row = keep};
    memset(&room, 0x5a, sizeof room);
    room.options = dalcs_run_options_default();
    room.options.tolerance = 1e-9;
    SET;
    if (dalcs_session_create(&s) != DALCS_OK ||
        dalcs_session_read_text(s, "rc.cir", netlist, sizeof netlist - 1) != DALCS_OK) return 2;
    const enum dalcs_status status = dalcs_session_run(s, &room.options, &sink);
    printf("%d %d %zu %.9f %s\\n", (int)status, room.behind[0] == 0x5a, room.options.size, end,
           dalcs_session_n_messages(s) > 0 ? dalcs_session_message(s, 0, NULL) : "");
    dalcs_session_destroy(s);
    return 0;
}
"""
LAST = re.compile(r"    size_t only_step;.*?(?=\n};)", re.DOTALL)
BUILD = HEADER = ""


class Versions(unittest.TestCase):
    def run_with(self, header, then="(void)0"):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            (place / "dalcs.h").write_text(header)
            (place / "a.c").write_text(PROGRAM.replace("SET", then))
            built = subprocess.run(["gcc", "-std=c11", "-Wall", "-Werror", f"-I{place}", place / "a.c", "-o", place / "a",
                                    f"-L{BUILD}/src", "-ldalcs", f"-Wl,-rpath,{BUILD}/src"],
                                   capture_output=True, text=True, check=False)
            self.assertEqual((built.returncode, built.stderr), (0, ""))
            done = subprocess.run([place / "a"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            status, untouched, size, end, said = done.stdout.rstrip("\n").split(" ", 4)
            self.assertEqual(untouched, "1")
            return int(status), int(size), float(end), said

    def setUp(self):
        self.header = text_of(HEADER)
        self.assertEqual(len(LAST.findall(self.header)), 1, "the last options are others by now: name them in LAST")
        self.newer = LAST.sub(lambda found: found[0] + "\n    double later;", self.header)

    def test_older_same_and_newer(self):
        for header, apart in (LAST.sub("", self.header), -16), (self.header, 0), (self.newer, 8):
            status, size, end, said = self.run_with(header)
            self.assertEqual((status, said), (0, ""))
            self.assertEqual(size - self.run_with(self.header)[1], apart)
            self.assertAlmostEqual(end, 0.632120559, delta=1e-8)  # 1 - 1/e

    def test_what_this_library_does_not_have(self):
        status, _, _, said = self.run_with(self.newer, "room.options.later = 1.0")
        self.assertEqual(status, -4)
        self.assertIn("the program sets options of a run that this library", said)
        self.assertIn("hint: install the library that the program was built with", said)

    def test_without_a_size(self):
        status, _, _, said = self.run_with(self.header, "memset(&room.options, 0, sizeof room.options)")
        self.assertEqual(status, -4)
        self.assertIn("the options of the run have no size", said)

    def test_by_name(self):
        """From Python: options that end behind their third field have no later ones."""
        library = ctypes.CDLL(f"{BUILD}/src/libdalcs.so")
        room = (ctypes.c_double * 4)(0.0, 0.0, 0.0, 7.0)
        library.dalcs_run_options_init.argtypes = [ctypes.c_void_p, ctypes.c_size_t]
        library.dalcs_run_options_init(room, 24)
        for name, value, wanted in ((b"tol", b"1u", 0), (b"tol", b"x", -4), (b"stages", b"5", -4), (b"workers", b"2", -4)):
            self.assertEqual(library.dalcs_run_options_set(room, name, value), wanted, name)
        self.assertEqual((room[2], room[3]), (1e-6, 7.0))


if __name__ == "__main__":
    BUILD, HEADER = (str(pathlib.Path(path).resolve()) for path in sys.argv[1:])
    unittest.main(argv=sys.argv[:1])
