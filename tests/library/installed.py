#!/usr/bin/env python3
"""What `meson install` gives: a program in C and one in C++ are built against it and run.

usage: installed.py BUILD_FOLDER HEADER
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

from public_header import text_of  # noqa: E402

NETLIST = "half a volt\nV1 in 0 1\nR1 in out 1\nR2 out 0 1\nD1 0 out\n.op\n.end\n"
PROGRAM = """
#include <dalcs.h>
#include <stdio.h>

static enum dalcs_status print_row(void *user, double time, const double *value) {
    (void)user;
    printf("%g %g\\n", time, value[1]);
    return DALCS_OK;
}

int main(int argc, char **argv) {
    struct dalcs_session *session = NULL;
    struct dalcs_run_options options = dalcs_run_options_default();
    struct dalcs_sink sink = {0};
    sink.row = print_row;
    enum dalcs_status status = dalcs_session_create(&session);
    if (status == DALCS_OK) {
        status = dalcs_session_read_file(session, argc > 1 ? argv[1] : "");
    }
    if (status == DALCS_OK) {
        status = dalcs_session_run(session, &options, &sink);
    }
    dalcs_session_destroy(session);
    return status == DALCS_OK ? 0 : 1;
}
"""
BUILD = HEADER = ""


def output_of(command, **variables):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False, env={**os.environ, **variables})
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}: {done.stdout}{done.stderr}")
    return done.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.place = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.place.cleanup)
        cls.root = pathlib.Path(cls.place.name)
        output_of(["meson", "install", "-C", BUILD, "--no-rebuild", "--destdir", cls.root])
        cls.libraries = next(cls.root.rglob("libdalcs.a")).parent
        package = next(cls.root.rglob("dalcs.pc"))
        cls.flags = {"PKG_CONFIG_PATH": str(package.parent), "PKG_CONFIG_SYSROOT_DIR": cls.place.name}
        (cls.root / "a.cir").write_text(NETLIST)

    def build_and_run(self, compiler, name, *pkg_config):
        source, program = self.root / name, self.root / "program"
        source.write_text(PROGRAM)
        flags = output_of(["pkg-config", "--cflags", "--libs", *pkg_config, "dalcs"], **self.flags)
        if pkg_config:
            flags = flags.replace("-ldalcs", "-l:libdalcs.a")
        output_of([*compiler, "-Wall", "-Wextra", "-Werror", source, "-o", program, *flags.split()])
        printed = output_of([program, self.root / "a.cir"], LD_LIBRARY_PATH=str(self.libraries))
        self.assertEqual(printed, "0 0.5\n")

    def test_is_found(self):
        """README's line for C sets no variable: below /usr/local pkg-config looks where the file is."""
        searched = output_of(["pkg-config", "--variable", "pc_path", "pkg-config"]).strip().split(":")
        folder = "/" + str(next(self.root.rglob("dalcs.pc")).parent.relative_to(self.root))
        if folder.startswith("/usr/local/") and any(path.startswith("/usr/local/") for path in searched):
            self.assertIn(folder, searched)

    def test_c(self):
        self.build_and_run(["gcc", "-std=c11", "-pedantic"], "a.c")

    def test_c_with_the_static_library(self):
        self.build_and_run(["gcc", "-std=c11", "-pedantic"], "a.c", "--static")

    def test_cxx(self):
        self.build_and_run(["g++", "-std=c++17", "-Wno-missing-field-initializers"], "a.cc")

    def test_program(self):
        program = next(self.root.rglob("bin/dalcs"))
        self.assertRegex(output_of([program, "--version"]), r"^dalcs \d")

    def test_nothing_else_is_visible(self):
        symbols = output_of(["nm", "-D", "--defined-only", self.libraries / "libdalcs.so"])
        visible = {line.split()[-1] for line in symbols.splitlines()}
        text = re.sub(r"/\*.*?\*/", "", text_of(HEADER), flags=re.DOTALL)
        inline = re.compile(r"static inline [^{]*\b(dalcs_\w+)\(.*?\n}\n", re.DOTALL)
        declared = set(re.findall(r"\b(dalcs_\w+)\(", text)) - set(inline.findall(text))
        self.assertLessEqual({"dalcs_session_run", "dalcs_version"}, visible)
        self.assertEqual(visible, declared)


if __name__ == "__main__":
    BUILD, HEADER = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
