#!/usr/bin/env python3
"""Every element and source that dalcs writes for ngspice: both give the same waveforms.

usage: elements.py PROGRAM NETLIST
"""

import pathlib
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

WITHIN = 1e-3  # of the worst of 54 signals; a switch that closes 1 us late makes 1e-2


def main():
    program, netlist = sys.argv[1:]
    checker = Checker("compare_elements")
    done = subprocess.run([program, "compare", netlist, "--methods", "auto", "--within",
                           repr(WITHIN), "--limit", "20"], capture_output=True, text=True, check=False)
    checker.check(done.returncode == 0, f"status {done.returncode}: {done.stderr}\n{done.stdout}")
    checker.check("54 signals" in done.stdout, f"not all signals were compared:\n{done.stdout}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
