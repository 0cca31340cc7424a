#!/usr/bin/env python3
"""A tank without loss keeps its energy: a thousand periods with the default method and tolerance.

usage: tank.py PROGRAM

The energy must stay within 1e-6 at 16 times in each of 50 periods spread over the run, the last one
included. The error in phase is printed, and must not exceed 1e-5: ten times what the tolerance of
1e-6 allows the waveform, so that a method which keeps energy and not time does not pass.
"""

import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

C, L, V0, PERIODS = 1e-6, 1e-3, 10.0, 1000
OMEGA = 1 / math.sqrt(L * C)
PERIOD = 2 * math.pi / OMEGA
STOP = PERIODS * PERIOD
NETLIST = f"""An LC tank
C1 a 0 {C!r} IC={V0!r}
L1 a 0 {L!r}
.tran 1u {STOP!r} uic
.end
"""
ENERGY, PHASE = 1e-6, 1e-5


def main():
    checker = Checker("tank")
    times = [min((20 * k + 19 + part / 16) * PERIOD, STOP) for k in range(50)
             for part in range(1, 17)]
    result = run(sys.argv[1], NETLIST, at=times, method=None)
    if not checker.check(result.status == 0 and len(result.rows) == len(times),
                         f"exit {result.status}, {len(result.rows)} rows: {result.stderr}"):
        return checker.finish()
    full, energies, phases = C * V0 ** 2 / 2, [], []
    for t, v, i in zip(times, result.column("v(a)"), result.column("i(l1)")):
        energies.append((C * v * v + L * i * i) / 2 / full - 1)
        phase = math.atan2(i * math.sqrt(L / C), v) - OMEGA * t
        phases.append(math.remainder(phase, 2 * math.pi))
    worst = max(energies, key=abs)
    print(f"energy {worst:+.2e}, phase {max(phases, key=abs):+.2e} rad after {PERIODS} periods, "
          f"{result.report['work']['steps']} steps")
    checker.check(abs(worst) <= ENERGY, f"the energy is off by {worst:.2e}")
    checker.check(max(map(abs, phases)) <= PHASE, f"the phase is off by {max(phases, key=abs):.2e}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
