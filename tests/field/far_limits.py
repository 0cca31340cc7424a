#!/usr/bin/env python3
"""Limits that nothing comes near, which people write for "none": 1e9 V in an integrator or a diode.

usage: far_limits.py PROGRAM

Signals are measured by the largest voltage of their circuit, and a limit is none of these. Circuits whose events are
told by millivolts are run with limits of 1e3 to 1e12 V and without: events and waveforms are the same."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

CIRCUITS = {
    "the middle of three phases": (
        "va a1 0 sin(0 1 60)\nvb b1 0 sin(0 1 60 0 0 -120)\nvc c1 0 sin(0 1 60 0 0 120)\nra a1 a 1k\nca a 0 1u\n"
        "rb b1 b 1k\ncb b 0 1u\nrc c1 c 1k\ncc c 0 1u\nb1 u 0 v=0.5*(max(v(a),max(v(b),v(c)))+min(v(a),min(v(b),v(c))))\n"
        "r1 u o 1k\nc1 o 0 100n", "a", ("v(u)", "v(o)"), 40e-3),
    "a rectifier of millivolts": (
        "v1 a1 0 sin(0 20m 1k)\nr1 a1 a 10\nd1 a o d\nc1 o 0 10u\nr2 o 0 1k\n.model d d", "o", ("v(o)", "v(a)"), 5e-3),
    "a comparator": (
        "v1 in 0 sin(0 2 200)\nr1 in x 1k\nc1 x 0 100n\ns1 p y x 0 m\nvp p 0 3\nr2 y 0 1k\nc2 y 0 1u\n"
        ".model m sw(ron=1 roff=1meg vt=0.5 vh=0.1)", "y", ("v(y)", "v(x)"), 20e-3),
}
# what is idle beside it, by its limit; it reads node {n}
LIMITS = {
    "int": "ai{k} {n} z{k} mi{k}\n.model mi{k} int(gain=1 out_lower_limit=-{l} out_upper_limit={l})\nri{k} z{k} 0 1k",
    "a zener": "dz{k} {n} 0 mz{k}\n.model mz{k} d(vfwd={l} vrev={l})",
    "a forward voltage": "df{k} {n} 0 mf{k}\n.model mf{k} d(vfwd={l})",
}


def main():
    program = sys.argv[1]
    checker = Checker("far limits")
    for name, limit, volts in some_of([(n, m, v) for n in CIRCUITS for m in LIMITS for v in ("1e3", "1e6", "1e9", "1e12")]):
        cards, node, signals, stop = CIRCUITS[name]
        case = f"{name} beside {limit} of {volts} V"
        extra = LIMITS[limit].format(k=1, n=node, l=volts)
        times = [stop * (k + 0.37) / 400 for k in range(400)]
        both = [run(program, f"{name}\n{cards}\n{more}\n.save {' '.join(signals)}\n.tran {stop / 400!r} {stop!r} uic\n.end\n",
                    at=times, method=None, options=["--audit", "full"]) for more in ("", extra)]
        if not checker.check(all(r.status == 0 for r in both), f"{case}: {[r.stderr for r in both]}"):
            continue
        for signal in signals:
            plain, beside = (r.column(signal) for r in both)
            worst = max(abs(x - y) for x, y in zip(plain, beside)) / max(map(abs, plain))
            checker.check(worst <= 1e-8, f"{case}: {signal} differs by {worst:.1e}")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
