#!/usr/bin/env python3
"""doc/examples/load_sweep.c against the installed library, found by pkg-config alone.

usage: example.py BUILD_FOLDER SOURCE

Its numbers are those of the closed form: the diode opens where the capacitor would give more current
than the load takes, tan(w t) = -w R C, and closes where the decay meets the sine again.
"""

import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

AMPLITUDE, OMEGA, FARAD = 10.0, 2.0 * math.pi * 50.0, 100e-6
ERROR = 2e-5  # V: 1e-6 of 10 V, and rows that are 10 us apart


def lowest_voltage(ohm):
    opens = math.pi - math.atan(OMEGA * ohm * FARAD)
    low, high = 2.0 * math.pi, 2.5 * math.pi
    for _ in range(100):
        middle = 0.5 * (low + high)
        decayed = math.sin(opens) * math.exp(-(middle - opens) / (OMEGA * ohm * FARAD))
        low, high = (middle, high) if decayed > math.sin(middle) else (low, middle)
    return AMPLITUDE * math.sin(low)


def main():
    build, source = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["meson", "install", "-C", build, "--no-rebuild", "--destdir", folder],
                       check=True, stdout=subprocess.DEVNULL)
        package = next(pathlib.Path(folder).rglob("dalcs.pc")).parent
        program = pathlib.Path(folder) / "load_sweep"
        environment = {**os.environ, "PKG_CONFIG_PATH": str(package),
                       "PKG_CONFIG_SYSROOT_DIR": folder, "LD_LIBRARY_PATH": str(package.parent)}
        subprocess.run(f"cc -std=c11 -D_POSIX_C_SOURCE=200809L -Wall -Wextra -Werror {source} "
                       f"$(pkg-config --cflags --libs dalcs) -o {program}", shell=True, check=True,
                       env=environment)
        printed = subprocess.run([program], check=True, capture_output=True, text=True,
                                 env=environment).stdout
        rows = re.findall(r"^ *(\d+) ohm  ([\d.]+) V to ([\d.]+) V$", printed, re.MULTILINE)
        assert [int(row[0]) for row in rows] == [100, 200, 400, 800, 1600, 3200], printed
        for ohm, low, high in rows:
            wanted = lowest_voltage(float(ohm))
            assert abs(float(low) - wanted) < ERROR, f"{ohm} ohm: {low} V, not {wanted}"
            assert abs(float(high) - AMPLITUDE) < ERROR, f"{ohm} ohm: {high} V at most"
    print(f"{len(rows)} loads agree with the closed form")
    return 0


if __name__ == "__main__":
    sys.exit(main())
