#!/usr/bin/env python3
"""A program's calls with each kind of allocation failing in turn: it gets answers or errors, and goes on.

usage: allocations.py CLIENT LIBRARY FAIL_MALLOC

A value that is given must be the right one, whatever failed before it; what cannot be given is none.
"""

import pathlib
import re
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT / "alloc"), str(ROOT / "support")]

import dalcs_program  # noqa: E402
import preload  # noqa: E402

CALLS = """< a divider and a capacitor
< v1 in 0 sin(0 1 1k) dc 1 ac 1
< r1 in out 1k
< c1 out 0 100n
< d1 out 0 dm
< .model dm d(vfwd=0.5)
< .tran 0.1m 1m
< .tran 0.1m 0.5m
< .control
< op
< let x = v(out)*2
< .endc
< .end
circ
last x
! run
last tran1.time
! let y = vecmax(v(in)) + tran1.v(in)[0]
! linearize v(in)
! fft v(in)
plots
! alter r1 = 2k
! meas tran top MAX v(out)
! setplot tran1
vecs tran1
! display
! destroy all
! op
last in
! quit
! echo $curplot
"""
RUN = re.compile(r"^(?:last|at|most) (\S+) = (.*)$", re.MULTILINE)


def main():
    client, library, fail_malloc = (str(pathlib.Path(name).resolve()) for name in sys.argv[1:4])
    checker = dalcs_program.Checker("allocations of the library")
    with tempfile.TemporaryDirectory() as folder:
        calls = pathlib.Path(folder) / "calls"
        calls.write_text(CALLS)
        command = [client, library]
        done, tally, numbers = preload.calls_to_fail(fail_malloc, command, folder, calls)
        chosen = dalcs_program.some_of(numbers)
        failed = 0
        wanted = dict(RUN.findall(done.stdout.decode()))
        checker.check(done.returncode == 0 and len(wanted) == 3 and b": 1\n" not in done.stdout, f"{done.stdout}")
        for run in preload.runs_apart(fail_malloc, command, folder, chosen, calls):
            where = f"allocation {run.number} of {tally.calls}"
            text = run.stdout.decode(errors="replace")
            if "init " not in text:
                continue  # the loader and constructors of other libraries: none of the library's functions was called
            if not checker.check(run.returncode == 0, f"{where}: ends with {run.returncode} {run.stderr}"):
                continue
            if ": 1\n" in text or "circ 1" in text:
                failed += 1
            for name, value in RUN.findall(text):
                if name == "tran1.time" and "! run: 1" in text:
                    continue  # as far as the run went
                checker.check(value in (wanted.get(name), "none"), f"{where}: {name} = {value}")
        checker.check(failed > len(chosen) / 4, f"only {failed} calls failed of {len(chosen)} allocations")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
