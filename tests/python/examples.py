#!/usr/bin/env python3
"""What docstrings and pages show of Python runs and prints that.

usage: examples.py SOURCE_FOLDER, with PYTHONPATH=build/src/python

```pycon blocks of README.md, doc/python.md and doc/sweeps.md are one session for each page, in a folder of its own, where the
netlists that the page saves "as `NAME`:" are, and the folder netlists.
"""

import doctest
import importlib
import os
import pathlib
import pkgutil
import re
import sys
import tempfile

import dalcs

SOURCE = pathlib.Path(sys.argv[1])
PAGES = ("README.md", "doc/python.md", "doc/sweeps.md")
BLOCK = re.compile(r"^```(.*)\n((?:.*\n)*?)```$", re.MULTILINE)
SAVED = re.compile(r"\bas `([\w.-]+)`[^\n]*:\s*\Z")
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def session_of(page):
    """The page's blocks, what is between them left out but for its lines, so that places are right."""
    text, lines, at = page.read_text(encoding="utf-8"), [], 0
    for block in BLOCK.finditer(text):
        if block[1].strip() == "pycon":
            lines += [""] * (text.count("\n", at, block.start(2))) + block[2].split("\n")[:-1]
            at = block.end(2)
        saved = SAVED.search(text[:block.start()])
        if saved:
            pathlib.Path(saved[1]).write_text(block[2], encoding="utf-8")
    return "\n".join(lines) + "\n"


def run_page(page):
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        (pathlib.Path(folder) / "netlists").symlink_to(SOURCE / "netlists")
        test = doctest.DocTestParser().get_doctest(session_of(page), {}, page.name, str(page), 0)
        result = doctest.DocTestRunner(optionflags=FLAGS).run(test)
        os.chdir("/")
    return result


def main():
    failed = 0
    names = [name for _, name, _ in pkgutil.iter_modules(dalcs.__path__, "dalcs.")]
    for module in [dalcs, *map(importlib.import_module, names)]:
        failed += doctest.testmod(module, optionflags=FLAGS).failed
    attempted = len(doctest.DocTestParser().get_examples(dalcs.__doc__))
    for name in PAGES:
        result = run_page(SOURCE / name)
        if result.attempted == 0:
            print(f"{name} shows nothing")
        failed += result.failed + (result.attempted == 0)
        attempted += result.attempted
    print(f"{attempted} examples, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
