#!/usr/bin/env python3
"""Derivatives of what does not move, which are 0 but for rounding over the length of a step, and what reads them.

usage: resting_derivatives.py PROGRAM

No such value may turn a diode or a switch, however short the step is: a step that ends there is followed by a shorter one,
in which there is more of it. Beside some stands a circuit that moves, which must be as it is alone.
"""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run, some_of  # noqa: E402

VOLTS = ("1e-12", "0.003", "5", "400", "1e6")
STOPS = (33e-6, 2.0, 5e-10)
MOST_RATE = 1e12  # V/s: what is left of more is 1 mV, which may well turn a switch
MODELS = ".model dm D(Ron=1m Roff=1Meg Vrev=10)\n.model dn D(Ron=1m)\n.model sm sw(vt=0.1 vh=0.05)\n"
RATES = {
    "ddt": "v1 a 0 {v}\nb1 b 0 v=ddt(v(a))\n",
    "ddt of a formula": "v1 a 0 {v}\nb1 b 0 v=3*ddt(2*v(a)+1)\n",
    "a capacitor's current by H": "v1 a 0 {v}\nvs a x 0\nc1 x 0 1u\nh1 y 0 vs 1e6\nry y b 1m\n",
}
READERS = {
    "breakdown": "d1 0 b dm\n",
    "a diode": "d1 b 0 dm\n",
    "a diode behind a resistor": "d1 0 c dm\nrc c b 1k\n",
    "a diode to a load": "d1 b c dn\nr1 c 0 1\n",
    "a switch": "s1 p 0 b 0 sm\nrp p 0 1\n",
}
BESIDE = ("vq q 0 sin(0 {volts!r} {hertz!r})\nd9 q k dn\nc9 k 0 {farads!r}\nr9 k 0 10\nr8 k b 1meg\n")


class Resting(Checker):
    def look_at(self, rate, reader, volts, stop):
        name = f"{rate}, {reader}, {volts} V, {stop:g} s"
        done = run(sys.argv[1], f"{name}\n{RATES[rate].format(v=volts)}{READERS[reader]}{MODELS}"
                                f".tran {stop / 10!r} {stop!r}\n.end\n", method=None)
        if not self.check(done.status == 0, f"{name}: {done.stderr}"):
            return
        events = [e for e in done.report["events"] if e["time"] > 0.0]
        self.check(not events and done.report["work"]["steps"] <= 60,
                   f"{name}: {len(events)} events, {done.report['work']['steps']} steps")
        # the last digit of what charges, over steps of a 16th of the run at least
        most = 1e-12 * max(abs(float(volts)), 1.0) / stop * 64
        self.check(max(map(abs, done.column("v(b)"))) <= most,
                   f"{name}: {max(map(abs, done.column('v(b)'))):.2g} V, at most {most:.2g}")

    def look_beside(self, volts, stop):
        name = f"beside a rectifier, {volts} V, {stop:g} s"
        moves = BESIDE.format(volts=float(volts) * 1e-3 + 1.0, hertz=5 / stop, farads=stop / 100)
        times = [stop * (k + 0.5) / 20 for k in range(20)]
        with_rate = run(sys.argv[1], f"{name}\n{RATES['ddt'].format(v=volts)}d1 0 b dm\n{moves}{MODELS}"
                                     f".tran {stop / 10!r} {stop!r}\n.end\n", at=times, method=None)
        alone = run(sys.argv[1], f"{name}\n{moves.replace('k b 1meg', 'k 0 1meg')}{MODELS}.tran {stop / 10!r} {stop!r}\n.end\n",
                    at=times, method=None)
        if not self.check(with_rate.status == alone.status == 0, f"{name}: {with_rate.stderr}{alone.stderr}"):
            return
        off = max(abs(a - b) for a, b in zip(with_rate.column("v(k)"), alone.column("v(k)")))
        self.check(off <= 1e-9 * max(map(abs, alone.column("v(k)"))), f"{name}: v(k) is off by {off:.2g} V")
        self.check(len(with_rate.report["events"]) == len(alone.report["events"]),
                   f"{name}: {len(with_rate.report['events'])} events, {len(alone.report['events'])} alone")


def main():
    resting = Resting("resting_derivatives")
    for case in some_of([(rate, reader, volts, stop) for rate in RATES for reader in READERS for volts in VOLTS
                         for stop in STOPS if float(volts) / stop < MOST_RATE]):
        resting.look_at(*case)
    for volts in VOLTS[:-1]:
        for stop in STOPS[:2]:
            resting.look_beside(volts, stop)
    return resting.finish()


if __name__ == "__main__":
    sys.exit(main())
