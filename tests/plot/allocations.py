#!/usr/bin/env python3
"""Draws with each kind of allocation failing in turn: the program must end with a message and leave no file.

usage: allocations.py DALCS FAIL_MALLOC
"""

import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "alloc"))
sys.path.insert(0, str(ROOT / "tests" / "support"))

import dalcs_program  # noqa: E402
import preload  # noqa: E402

TABLE = "time,v(a),\"v(a,b)\",i(d1)\n" + "".join(f"{k},{k % 3},1,{k % 2}\n" for k in range(40))
REPORT = '{"events": [{"time": 3, "element": "d9", "state": "on"}], "jumps": [{"time": 4}]}'
DRAWINGS = {
    "terminal": ["-s", "v(a)*i(d1),v(a)-v(a,b)", "--from", "2.5"],
    "page": ["-o", "a.html"],
    "report": ["-o", "a.html", "--report", "a.json", "--events"],
    "spectrum": ["-o", "a.html", "-s", "v(a),i(d1)", "--spectrum", "2"],
    "mistake": ["-s", "v(aa)"],
    "tornado": ["-s", "v(a)", "--tornado=time,i(d1)"],
    "tornado of a column that is not there": ["-s", "v(a)", "--tornado=time,i(d2)"],
    "family": ["-s", "v(a)", "--family", "-o", "a.svg"],
}
STEPS = "r,time,v(a)\n" + "".join(f"{k // 20},{k % 20},{k % 3}\n" for k in range(40))


def main(program, library):
    checker = dalcs_program.Checker("allocations of dalcs plot")
    for name, options in DRAWINGS.items():
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "a.csv").write_text(STEPS if name == "family" else TABLE)
            (folder / "a.json").write_text(REPORT)
            command = [program, "plot", "a.csv", *options]
            done, tally, numbers = preload.calls_to_fail(library, command, folder)
            if b"without the library" in done.stderr:
                continue
            expected = done.returncode
            for made in "a.html", "a.svg":
                (folder / made).unlink(missing_ok=True)
            for run in preload.refused_runs(library, command, folder, [(at, preload.ONCE) for at in numbers]):
                where = f"{name}, allocation {run.number} of {tally.calls}"
                checker.check(run.returncode >= 0, f"{where}: signal {-run.returncode}")
                left = sorted(path.name for path in run.folder.iterdir())
                if run.returncode == 0:
                    checker.check(expected == 0, f"{where}: nothing was refused")
                else:
                    checker.check(run.stderr.startswith(b"dalcs: "), f"{where}: no message")
                    checker.check(left == ["a.csv", "a.json"], f"{where}: left {left}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
