#!/usr/bin/env python3
"""Each function of LAPACK that the library calls is one of those that its engine for browsers has.

usage: lapack_names.py SOURCES LAPACKE_H
"""

import pathlib
import re
import sys

CALL = re.compile(r"\bLAPACKE_(\w+)\s*\(")


def main():
    sources, header = (pathlib.Path(name) for name in sys.argv[1:3])
    known = set(CALL.findall(header.read_text(encoding="utf-8")))
    missing, called = [], set()
    for path in sorted(sources.rglob("*.c")):
        for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
            for name in CALL.findall(line):
                called.add(name)
                if name not in known:
                    missing.append(f"{path}:{number}: LAPACKE_{name} is not in {header}: write it there, "
                                   "compare it with LAPACK's in tests/wasm/lapack.c")
    missing += [f"{header}: nothing calls LAPACKE_{name}" for name in sorted(known - called)]
    print("\n".join(missing) or f"{len(called)} functions, all there")
    return 1 if missing or not called else 0


if __name__ == "__main__":
    sys.exit(main())
