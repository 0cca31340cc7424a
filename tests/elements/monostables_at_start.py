#!/usr/bin/env python3
"""A monostable whose clock is high as the run begins: a pulse from there on with uic, none without, and no false alarm.

usage: monostables_at_start.py PROGRAM

The area of the output over a run is that of its pulses, which follow from the times at which the clock rises. The audit
has not seen whether the clock rose at the start; what it finds later must not count as an error."""

import itertools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

SPAN = 60e-6
RISE, FALL = 10e-9, 20e-9
# cards of the clock c, and when it rises after the start; the first two are high at it
CLOCKS = {
    "a source": ("vc c 0 pulse(1 0 3u 0 0 2u 7u)", [5e-6 + 7e-6 * k for k in range(8)]),
    "a comparator of a capacitor": ("iq 0 q pulse(0 1m 1u 0 0 2u 20u)\ncq q 0 10n ic=0\nrq q 0 100k\n"
                                    "sq q 0 z 0 sw\nvz z 0 pulse(0 1 4u 0 0 1u 20u)\n.model sw sw(vt=0.5 ron=1)\n"
                                    "bc c 0 v=v(q) < 0.1 ? 1 : 0", None),
    "a source that is low": ("vc c 0 pulse(0 1 3u 0 0 2u 7u)", [3e-6 + 7e-6 * k for k in range(9)]),
    "short clocks": ("vc c 0 pulse(1 0 0.2u 0 0 0.15u 0.6u)", [0.35e-6 + 0.6e-6 * k for k in range(100)]),
}


def trapezoid(begins, ends):
    """The area before the end of the run under a ramp up from `begins` on and one down from `ends` on."""
    def under(t, start, length):  # of a ramp to 1 and what follows
        return 0.0 if t < start else 0.5 * (t - start) ** 2 / length if t < start + length else t - start - length / 2

    return under(SPAN, begins, RISE) - under(SPAN, ends, FALL)


def area_of(rises, rise_delay, fall_delay, width, retriggers):
    """A pulse is decided for its delay, its rise and its width; what was decided falls a delay later."""
    pulses = []
    for t in rises:
        if retriggers and pulses and t < pulses[-1][1]:
            pulses[-1][1] = t + rise_delay + RISE + width
        elif not pulses or t > pulses[-1][1] + (0.0 if retriggers else fall_delay + FALL):
            pulses.append([t, t + rise_delay + RISE + width])
    return sum(trapezoid(begins + rise_delay, ends + fall_delay) for begins, ends in pulses)


def main():
    checker = Checker("monostables_at_start")
    cases = itertools.product(CLOCKS.items(), (True, False), (0.0, 200e-9), (10e-9, 1e-6), (15e-6, 1.9e-6), (False, True))
    for (clock, (cards, rises)), uic, rise_delay, fall_delay, width, retriggers in some_of(list(cases)):
        what = f"{clock}, uic {uic}, delays {rise_delay} {fall_delay}, width {width}, retrig {retriggers}"
        text = "\n".join(["t", cards, "a1 c null null o m", "ro o 0 1k",
                          f".model m oneshot(cntl_array=[0 1] pw_array=[{width} {width}] rise_delay={rise_delay} "
                          f"fall_delay={fall_delay} rise_time={RISE} fall_time={FALL} retrig={'true' if retriggers else 'false'})",
                          f".tran 1u {SPAN} {'uic' if uic else ''}", ".meas tran area integ v(o)",
                          ".end", ""])
        outcome = run(sys.argv[1], text, method="auto", options=["--audit", "full"])
        if not checker.check(outcome.status == 0, f"{what}: {outcome.stderr[-300:]}") or rises is None:
            continue
        starts = [0.0] if uic and clock in ("a source", "short clocks") else []
        area = area_of(starts + rises, rise_delay, fall_delay, width, retriggers)
        found = {m["name"]: m["value"] for m in outcome.report["measurements"]}["area"]
        checker.close(found, area, 1e-6 * area + 1e-12, f"{what}: area")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
