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
# what is idle beside it, by its limit; it reads node {n}. Some tell it: v(z1) is the factor times v(n), plus the number.
LIMITS = {
    "int": "ai{k} {n} z{k} mi{k}\n.model mi{k} int(gain=1 out_lower_limit=-{l} out_upper_limit={l})\nri{k} z{k} 0 1k",
    "a zener": "dz{k} {n} 0 mz{k}\n.model mz{k} d(vfwd={l} vrev={l})",
    "a forward voltage": "df{k} {n} 0 mf{k}\n.model mf{k} d(vfwd={l})",
    "limit()": "bl{k} z{k} 0 v=limit(v({n}),-{l},{l})\nrl{k} z{k} 0 1k",
    "min and max": "bm{k} z{k} 0 v=min(max(2*v({n}),-{l}),{l})\nrm{k} z{k} 0 1k",
    "max of one side": "bo{k} z{k} 0 v=max(v({n}),-{l})\nro{k} z{k} 0 1k",
    "limit": "al{k} {n} z{k} ml{k}\n.model ml{k} limit(gain=1 out_lower_limit=-{l} out_upper_limit={l})\nrl{k} z{k} 0 1k",
    "an offset": "bl{k} z{k} 0 v=limit(v({n})+0.25,-{l},{l})\nrl{k} z{k} 0 1k",
    "a comparison": "bl{k} z{k} 0 v=u(limit(v({n})-1u,-{l},{l}))\nrl{k} z{k} 0 1k",
    "a steep limit": "bl{k} z{k} 0 v=limit(5*v({n}),-{l},{l})\nrl{k} z{k} 0 1k",
    "a table": "et{k} z{k} 0 table {{v({n})}} = (-{l},-{l}) (0,0) ({l},{l})\nrt{k} z{k} 0 1k",
}
TELLS = {"limit()": (1, 0), "min and max": (2, 0), "max of one side": (1, 0), "limit": (1, 0), "an offset": (1, 0.25),
         "a steep limit": (5, 0), "a table": (1, 0)}
# A factor and a limit on v(n), what drives n, and the value. One that is reached below 1 V is exact on its rails, one
# beyond it around 0.
EXACT = [(0.37, "0.3", 777777.7, 0.3), (3.7, "1.3", -777777.7, -1.3), (0.7, "0.11", 3.3e5, 0.11), (1, "2", 1.1e-9, 1.1e-9),
         (1, "9", -3.3e-9, -3.3e-9), (1, "1e9", 1e-3, 1e-3)]
# Tables with narrow pieces, what drives n, and the value; and how many corners one with wider pieces has.
NARROW = [("-1,0.1,0,0.3,3e-4,1.7,6e-4,1.9", -900.0, 0.1), ("0,0.2,2e-4,-1.1,5e-4,0.7,1,0.9", 800.0, 0.9)]
WIDER = ("0,0,5e-3,1,1e-2,1.5,15e-3,1.75", 4)


def main():
    program = sys.argv[1]
    checker = Checker("far limits")
    for name, limit, volts in some_of([(n, m, v) for n in CIRCUITS for m in LIMITS for v in ("1e3", "1e6", "1e9", "1e12")]):
        cards, node, signals, stop = CIRCUITS[name]
        case = f"{name} beside {limit} of {volts} V"
        extra = LIMITS[limit].format(k=1, n=node, l=volts)
        times = [stop * (k + 0.37) / 400 for k in range(400)]
        told = "v(z1)" if limit in TELLS else ""
        both = [run(program, f"{name}\n{cards}\n{more}\n.save {' '.join(signals)} v({node}) {told if more else ''}\n.tran {stop / 400!r} {stop!r} uic\n.end\n",
                    at=times, method=None, options=["--audit", "full"]) for more in ("", extra)]
        if not checker.check(all(r.status == 0 for r in both), f"{case}: {[r.stderr for r in both]}"):
            continue
        for signal in signals:
            plain, beside = (r.column(signal) for r in both)
            worst = max(abs(x - y) for x, y in zip(plain, beside)) / max(map(abs, plain))
            checker.check(worst <= 1e-8, f"{case}: {signal} differs by {worst:.1e}")
        if told:
            factor, offset = TELLS[limit]
            read, made = (both[1].column(of) for of in (f"v({node})", told))
            worst = max(abs(factor * x + offset - y) for x, y in zip(read, made)) / max(map(abs, made))
            checker.check(worst <= 1e-9, f"{case}: {told} is off by {worst:.1e}")
    for factor, limit, volts, value in EXACT:
        load = "r3 n 0 1meg\n" if abs(volts) > 1 else ""
        ran = run(program, f"exact\nv1 m 0 {volts!r}\nr2 m n 1k\n{load}b1 z 0 v=limit({factor}*v(n),-{limit},{limit})\nr1 z 0 1k\n.tran 1u 2u\n.end\n",
                  at=[1e-6], method=None, options=["--audit", "full"])
        found = ran.column("v(z)")[0]
        checker.check(abs(found - value) <= 1e-12 * abs(value), f"limit {limit} V of {factor} times {volts!r} V is {found!r}")
    for points, volts, value in NARROW:
        ran = run(program, f"narrow\nv1 m 0 {volts!r}\nr2 m n 1k\nb1 z 0 v=table(v(n),{points})\nr1 z 0 1k\n.tran 1u 2u\n.end\n",
                  at=[1e-6], method=None, options=["--audit", "full"])
        found = ran.column("v(z)")[0]
        checker.check(abs(found - value) <= 1e-12, f"table {points} at {volts!r} V is {found!r}")
    points, corners = WIDER
    ran = run(program, f"wider\nv1 m 0 1\nr2 m n 1k\nb1 z 0 v=table(v(n),{points})\nr1 z 0 1k\n.tran 1u 2u\n.end\n", method=None)
    found = ran.report["size"]["lambda"]
    checker.check(found == corners, f"table {points} has {found} corners")
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
