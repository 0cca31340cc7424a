"""Runs a program with the preloaded allocator of fail_malloc.c."""

import os
import pathlib
import struct
import subprocess


class Tally:
    """struct tally of fail_malloc.c."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        self.calls, self.refused, self.live, self.peak, self.peak_rss = struct.unpack("5q", data)


def run_preloaded(library, command, folder, **variables):
    """Returns (finished process, Tally); variables are those of fail_malloc.c."""
    tally = pathlib.Path(folder) / "tally"
    tally.unlink(missing_ok=True)
    command = [os.path.abspath(command[0]), *command[1:]]
    environment = {**os.environ, "LD_PRELOAD": os.path.abspath(library), "DALCS_TALLY": str(tally)}
    environment.update({name: str(value) for name, value in variables.items()})
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, check=False,
                          env=environment, cwd=folder)
    return done, Tally(tally)
