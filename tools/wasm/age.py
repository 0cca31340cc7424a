#!/usr/bin/env python3
"""Of which sources an engine was made, so that it does not fall behind the library unseen.

usage: age.py [ENGINE]

Without ENGINE it prints a digest of the sources, which tools/wasm/build writes into the engine. With it the exit
status is 1 where the engine was made of others.
"""

import hashlib
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
NOT_IN_IT = ("src/cli/", "src/main.c", "src/ngspice_library/", "src/plot/", "src/python/")
MARK = re.compile(rb"^// of the sources ([0-9a-f]{64})$", re.MULTILINE)


def digest():
    """Of the library's sources and of what is compiled and linked with them."""
    paths = [path for path in (TOP / "src").rglob("*") if path.suffix in (".c", ".h")]
    paths += [*(TOP / "tools/wasm/lapack").glob("*.[ch]"), TOP / "tools/wasm/engine.c", TOP / "tools/wasm/build"]
    made = hashlib.sha256()
    for name, path in sorted((path.relative_to(TOP).as_posix(), path) for path in paths):
        if not name.startswith(NOT_IN_IT):
            made.update(f"{name} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return made.hexdigest()


def complaint(engine):
    """What is wrong with an engine's age; '': nothing."""
    found = MARK.search(engine.read_bytes())
    if found and found[1].decode() == digest():
        return ""
    return f"{engine} was made of other sources than those here: tools/wasm/build makes it anew"


def main():
    if len(sys.argv) == 1:
        print(digest())
        return 0
    wrong = complaint(pathlib.Path(sys.argv[1]))
    if wrong:
        print(wrong)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
