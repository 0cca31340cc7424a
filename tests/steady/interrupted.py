#!/usr/bin/env python3
"""A search of minutes, whose passes have few events each, ends soon after SIGTERM.

usage: interrupted.py PROGRAM
"""

import pathlib
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

COPIES = 120  # of a converter in chaos: thousands of passes, none of which comes back
CONVERTER = """Vin{k} in{k} 0 {volts!r}
S1{k} in{k} sw{k} ramp con{k} sm
D1{k} 0 sw{k}
L1{k} sw{k} out{k} 20m
C1{k} out{k} 0 47u
R1{k} out{k} 0 22
E1{k} con{k} 0 out{k} ref 8.4
"""
CLOCK = "Vref ref 0 11.3\nVramp ramp 0 PULSE(3.8 8.2 0 400u 0 0 400u)\n.model sm SW(Ron=0 Vt=0)\n.pss periods=7 uic\n"
SOON = 60  # s, of a busy machine


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    checker = dalcs_program.Checker("interrupted")
    text = "* chaos\n" + "".join(CONVERTER.format(k=k, volts=33 + 0.01 * k) for k in range(COPIES)) + CLOCK
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "c.cir").write_text(text)
        with subprocess.Popen([program, "run", "c.cir", "-q", "-o", "c.csv"], cwd=folder, stderr=subprocess.PIPE,
                              text=True) as process:
            time.sleep(2)
            checker.check(process.poll() is None, "it has ended before it was interrupted")
            process.send_signal(signal.SIGTERM)
            try:
                _, said = process.communicate(timeout=SOON)
                checker.check("dalcs: interrupted" in said, f"it says {said!r}")
            except subprocess.TimeoutExpired:
                process.kill()
                checker.check(False, f"it still runs {SOON} s later")
        checker.check(not (pathlib.Path(folder) / "c.csv").exists(), "a table is left")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
