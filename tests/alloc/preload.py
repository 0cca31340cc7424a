"""Runs a program with the preloaded allocator of fail_malloc.c.

A program that allocates for each of its elements fails for each of them in the same way. So an allocation is made to
fail once for each path of calls that leads to one: the first time the program comes there, and the last.
"""

import os
import pathlib
import struct
import subprocess


class Tally:
    """struct tally of fail_malloc.c."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        self.calls, self.refused, self.live, self.peak, self.peak_rss = struct.unpack("5q", data)


def run_preloaded(library, command, folder, stdin=os.devnull, **variables):
    """Returns (finished process, Tally); variables are those of fail_malloc.c."""
    tally = pathlib.Path(folder) / "tally"
    tally.unlink(missing_ok=True)
    command = [os.path.abspath(command[0]), *command[1:]]
    environment = {**os.environ, "LD_PRELOAD": os.path.abspath(library), "DALCS_TALLY": str(tally)}
    environment.update({name: str(value) for name, value in variables.items()})
    with open(stdin, "rb") as given:
        done = subprocess.run(command, stdin=given, capture_output=True, check=False, env=environment, cwd=folder)
    return done, Tally(tally)


def calls_to_fail(library, command, folder, stdin=os.devnull):
    """Runs the command; returns (finished process, Tally, numbers of the first allocation of each path of calls,
    numbers of the first and the last one of each)."""
    paths = pathlib.Path(folder) / "paths"
    done, tally = run_preloaded(library, command, folder, stdin, DALCS_PATHS=paths.resolve())
    data = paths.read_bytes()
    paths.unlink()
    first, last = {}, {}
    for number, path in enumerate(struct.unpack(f"{len(data) // 8}Q", data), 1):
        first.setdefault(path, number)
        last[path] = number
    assert len(data) == 8 * tally.calls and last, f"{len(data)} bytes of paths for {tally.calls} allocations"
    return done, tally, sorted(first.values()), sorted({*first.values(), *last.values()})
