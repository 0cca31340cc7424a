"""Runs a program with the preloaded allocator of fail_malloc.c.

A program that allocates for each of its elements fails for each of them in the same way. So an allocation is made to
fail once for each path of calls that leads to one: the first time the program comes there, and in the long run
(tools/test --long) also the last, and paths are told apart by more calls. The program runs once for all of them: a child
of it goes on where one fails (branch.c).
"""

import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import types

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import IS_LONG  # noqa: E402

ONCE, FROM_THERE = 1, 2        # enum branch_way of branch.h
DEPTH = 12 if IS_LONG else 8   # three calls are of fail_malloc.c


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


def paths_of_calls(library, command, folder, stdin=os.devnull, depth=12):
    """Runs the command; returns (finished process, Tally, first and last): dictionaries that have for each path of calls
    the numbers of the first and of the last allocation that it led to. Paths are of the `depth` innermost calls."""
    paths = pathlib.Path(folder) / "paths"
    done, tally = run_preloaded(library, command, folder, stdin, DALCS_PATHS=paths.resolve(), DALCS_DEPTH=depth)
    data = paths.read_bytes()
    paths.unlink()
    first, last = {}, {}
    for number, path in enumerate(struct.unpack(f"{len(data) // 8}Q", data), 1):
        first.setdefault(path, number)
        last[path] = number
    assert len(data) == 8 * tally.calls and last, f"{len(data)} bytes of paths for {tally.calls} allocations"
    return done, tally, first, last


def calls_to_fail(library, command, folder, stdin=os.devnull):
    """Runs the command; returns (finished process, Tally, numbers of the first allocation of each path of calls, and in
    the long run of the last one too)."""
    done, tally, first, last = paths_of_calls(library, command, folder, stdin, DEPTH)
    return done, tally, sorted({*first.values(), *(last.values() if IS_LONG else [])})


def refused_runs(library, command, folder, points, stdin=os.devnull):
    """Yields what became of the command where allocation N failed, for each (N, ONCE or FROM_THERE) of `points`: number,
    way, status, stdout and stderr (bytes), tally, and folder, the copy of `folder` that it ran in."""
    folder = pathlib.Path(folder).resolve()
    with tempfile.TemporaryDirectory() as made:
        made = pathlib.Path(made)
        (made / "points").write_bytes(b"".join(struct.pack("2q", *point) for point in sorted(points)))
        environment = {**os.environ, "LD_PRELOAD": os.path.abspath(library), "DALCS_TALLY": str(folder / "tally"),
                       "DALCS_POINTS": str(made / "points"), "DALCS_BRANCHES": str(made)}
        with open(stdin, "rb") as given, open(folder / "stdout", "wb") as output, open(folder / "stderr", "wb") as error:
            subprocess.run([os.path.abspath(command[0]), *command[1:]], stdin=given, stdout=output, stderr=error,
                           check=False, env=environment, cwd=folder)
        ended = list(struct.iter_unpack("3q", (made / "ended").read_bytes()))
        if [outcome[:2] for outcome in ended] != sorted(points):
            raise AssertionError(f"{len(points)} allocations were to fail, and {len(ended)} runs ended:\n"
                                 f"{(folder / 'stderr').read_text(errors='replace')}")
        for number, way, status in ended:
            own = made / f"{number}.{way}"
            output, error = own / "stdout", own / "stderr"
            run = types.SimpleNamespace(number=number, way=way, returncode=status, stdout=output.read_bytes(),
                                        stderr=error.read_bytes(), tally=Tally(own / "tally"), folder=own)
            for name in output, error, own / "tally":
                name.unlink()
            yield run
            shutil.rmtree(own)
        for name in "stdout", "stderr", "tally":
            (folder / name).unlink()


def runs_apart(library, command, folder, numbers, stdin=os.devnull):
    """The same for a program with threads or with processes that it starts, which a child of it has not: each run is one
    from the start, in `folder`."""
    for number in numbers:
        done, tally = run_preloaded(library, command, folder, stdin, DALCS_FAIL_AT=number)
        yield types.SimpleNamespace(number=number, way=ONCE, returncode=done.returncode, stdout=done.stdout,
                                    stderr=done.stderr, tally=tally, folder=pathlib.Path(folder))
