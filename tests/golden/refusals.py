#!/usr/bin/env python3
"""What cannot be run is refused before anything is written: exit status 2 and the option for a bad
command line, 3 and file:line:column for a bad netlist.

usage: refusals.py PROGRAM
"""

import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

NETLIST = """half-wave rectifier
V1 in 0 SIN(0 10 50)
D1 in out
C1 out 0 100u
R1 out 0 1k
.tran 100u 1m
.end
"""
USAGE, BAD_NETLIST = 2, 3
# arguments, what the first line of stderr must hold
OPTIONS = [(["--tol", "0"], "--tol: '0'"), (["--tol", "1"], "--tol: '1'"),
           (["--tol", "-1u"], "--tol: '-1u'"), (["--tol", "abc"], "--tol: 'abc'"),
           (["--tol", "nan"], "--tol: 'nan'"), (["--tol"], "'--tol' needs a value"),
           (["--stages", "2"], "--stages: '2'"), (["--stages", "0"], "--stages: '0'"),
           (["--stages", "abc"], "--stages: 'abc'"), (["--method", "rado"], "'rado'")]
# the card in place of .tran, the column of what is wrong with it, and the word for it
CARDS = [(".tran 1u 1m 0 0", 15, "largest step"), (".tran 1u 1m 0 0 uic", 15, "largest step"),
         (".tran 1u 1m 0 -1u", 15, "largest step"), (".tran 1u 1m 2m", 13, "start time"),
         (".tran 1u 1m 1m", 13, "start time"), (".tran 1u 0", 10, "stop time"),
         (".tran 1u -1m", 10, "stop time"), (".tran -1u 1m", 7, "step"),
         (".tran abc 1m", 7, "abc")]


def main():
    program, checker = str(pathlib.Path(sys.argv[1]).resolve()), Checker("refusals")

    def refused(folder, arguments, status, starts, holds):
        done = subprocess.run([program, "run", "a.cir", *arguments], cwd=folder, timeout=60,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        first = done.stderr.partition("\n")[0]
        checker.check(done.returncode == status and first.startswith(starts) and holds in first,
                      f"{arguments}: exit {done.returncode}, not {status}, or no {holds!r} after "
                      f"{starts!r}: {done.stderr}")
        checker.check(not done.stdout, f"{arguments}: printed {done.stdout}")
        left = sorted(path.name for path in folder.iterdir())
        checker.check(left == ["a.cir"], f"{arguments}: left {left}")

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "a.cir").write_text(NETLIST)
        for arguments, holds in OPTIONS:
            refused(folder, arguments, USAGE, "dalcs: error: ", holds)
        for card, column, holds in CARDS:
            (folder / "a.cir").write_text(NETLIST.replace(".tran 100u 1m", card))
            refused(folder, ["-o", "out.csv", "--report", "r.json"], BAD_NETLIST,
                    f"a.cir:6:{column}: error: ", holds)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
