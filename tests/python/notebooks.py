#!/usr/bin/env python3
"""The notebooks of doc/notebooks and of the lessons run and print what they show; without Jupyter.

usage: notebooks.py SOURCE_FOLDER, with PYTHONPATH=build/src/python

A notebook's code cells are one session, in its folder, as Jupyter would run them. What a cell prints has to be what is
stored; pictures are drawn and not compared.
"""

import contextlib
import importlib.util
import io
import json
import os
import pathlib
import sys
import unittest

DOC = pathlib.Path(sys.argv[1]).resolve() / "doc"
NEEDED = ("matplotlib", "scipy")


def printed(cell):
    return "".join(line for output in cell["outputs"] for line in output.get("text", ()))


@unittest.skipUnless(all(importlib.util.find_spec(name) for name in NEEDED), f"needs {', '.join(NEEDED)}")
class Notebooks(unittest.TestCase):
    def run_notebook(self, path):
        import matplotlib.pyplot as plt  # pylint: disable=import-outside-toplevel
        folder, name = path.parent, path.name
        notebook = json.loads(path.read_text(encoding="utf-8"))
        self.assertEqual((notebook["nbformat"], notebook["nbformat_minor"]), (4, 5))
        os.chdir(folder)
        session, count, before = {"__name__": "__main__"}, 0, sorted(os.listdir(folder))
        for number, cell in enumerate(notebook["cells"], 1):
            if cell["cell_type"] != "code":
                continue
            count += 1
            self.assertEqual(cell["execution_count"], count)
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                # pylint: disable-next=exec-used
                exec(compile("".join(cell["source"]), f"{name}, cell {number}", "exec"), session)
            self.assertEqual(out.getvalue(), printed(cell), f"{name}, cell {number}")
        plt.close("all")
        self.assertEqual(sorted(os.listdir(folder)), before)
        return count

    def run_all(self, folder, count):
        paths = sorted((DOC / folder).glob("*.ipynb"))
        self.assertEqual(len(paths), count)
        for path in paths:
            with self.subTest(path.name):
                self.assertGreaterEqual(self.run_notebook(path), 3)

    def test_examples(self):
        self.run_all("notebooks", 5)

    def test_lessons(self):
        self.run_all("lessons", 20)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
