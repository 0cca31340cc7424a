#!/usr/bin/env python3
"""Nothing allocates between steps of implicit Euler, and whatever the method a long run needs no more
memory than a short one.

usage: stepping_memory.py PROGRAM LIBRARY

DALCS_TEST_LONG=1 adds a run of 1e7 steps.
"""

import os
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "support")]
from dalcs_program import Checker  # noqa: E402
from preload import run_preloaded  # noqa: E402

# A few hundred steps a period: the same modes come back in every period.
CIRCUITS = {
    "full bridge": """Full bridge with a floating DC side
V1 a b SIN(0 10 50)
R0 b 0 1
D1 a p
D2 b p
D3 m a
D4 m b
C1 p m 100u
R1 p m 1k
.tran 20m {stop} 0 100u uic
.save v(p,m) i(d1)
.end
""",
    "buck": """Buck converter
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 8m 20m)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 100m
C1 out 0 40m
R1 out 0 2
.model sm SW(Ron=0 Vt=0.5)
.tran 20m {stop} 0 100u uic
.save v(out) i(l1)
.end
""",
}
# Events without a step given: four in a period. They are counted, not kept, without a report. With a ledger of
# energies every segment is taken, without it whole periods are leapt over.
SWITCHING = """Buck converter, 100 kHz
Vin in 0 12
Vg g 0 PULSE(0 1 0 0 0 4u 10u)
S1 in sw g 0 sm
D1 0 sw
L1 sw out 47u
C1 out 0 10u
R1 out 0 4
.model sm SW(Vt=0.5)
.tran 10u {stop} uic
.save v(out) i(l1)
.end
"""
PERIOD = 10e-6
EVENTS_A_PERIOD = 4
STEP = 100e-6
EXTRA_CALLS = 2        # nothing is known to need them
EXTRA_RSS = 1024       # kB
EXTRA_HEAP = 4096      # bytes
MORE = 0.1             # steps and modes kept by the default method, which come and go


def measure(program, library, netlist, steps):
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "circuit.cir").write_text(netlist.format(stop=steps * STEP))
        done, tally = run_preloaded(library, [program, "run", "circuit.cir", "--method", "euler",
                                              "-o", "out.csv", "--quiet"], folder)
        if done.returncode != 0:
            raise AssertionError(f"status {done.returncode}: {done.stderr.decode()}")
        print(f"{steps:>9} steps: {tally.calls} allocations, peak {tally.peak} bytes, "
              f"{tally.peak_rss} kB resident, {tally.live} bytes never freed")
        return tally


def measure_events(program, library, events, options):
    stop = events / EVENTS_A_PERIOD * PERIOD
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "circuit.cir").write_text(SWITCHING.format(stop=stop))
        (folder / "times").write_text(f"{stop / 3}\n{stop}\n")
        done, tally = run_preloaded(library, [program, "run", "circuit.cir", "-o", "out.csv",
                                              "--at", "times", *options], folder)
        if done.returncode != 0:
            raise AssertionError(f"status {done.returncode}: {done.stderr.decode()}")
        print(f"{events:>9} events: {tally.calls} allocations, peak {tally.peak} bytes, "
              f"{tally.peak_rss} kB resident, {tally.live} bytes never freed")
        return tally


def main():
    program, library = sys.argv[1:]
    checker = Checker("stepping_memory")
    ladder = [10**4, 10**5, 10**6]
    if os.environ.get("DALCS_TEST_LONG") == "1":
        ladder.append(10**7)
    for name, netlist in CIRCUITS.items():
        print(name)
        tallies = [measure(program, library, netlist, steps) for steps in ladder]
        for steps, tally in zip(ladder[1:], tallies[1:]):
            first = tallies[0]
            for what, more, allowed in (
                    ("allocations", tally.calls - first.calls, EXTRA_CALLS),
                    ("bytes at the peak", tally.peak - first.peak, EXTRA_HEAP),
                    ("kB resident", tally.peak_rss - first.peak_rss, EXTRA_RSS)):
                checker.check(more <= allowed, f"{name}: {more} more {what} for {steps} steps")
            checker.check(tally.peak_rss > 0 and tally.calls > 0, f"{name}: nothing was counted")
    for options in ([], ["--energy"]):
        print("events of the default method", *options)
        tallies = [measure_events(program, library, events, options) for events in ladder[:3]]
        for events, tally in zip(ladder[1:], tallies[1:]):
            for what, now, before in (("bytes at the peak", tally.peak, tallies[0].peak),
                                      ("kB resident", tally.peak_rss, tallies[0].peak_rss)):
                checker.check(now <= (1 + MORE) * before,
                              f"{now} {what} for {events} events, {before} for {ladder[0]}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
