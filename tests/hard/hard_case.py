#!/usr/bin/env python3
"""Runs one hard case of netlists/hard and compares it with tests/hard/expected.json.

usage: hard_case.py PROGRAM CASE euler|default

Kinds of entries, for `--method euler`:
  be          the value at time t, exact at every step: checked for h, h/2 and h/5. A string is an
              expression in h, t and n = t/h (a closed form of the implicit Euler sequence).
  diff        the same, to 1e-6: a combination of quantities that the least-norm choice fixes
  tran        the value at time t with a first-order error: tol at h, tol/2 at h/2, tol/5 at h/5
  mean, sum   time average over the whole run; sum of h times the value over all steps
  range, op   an operating point, or the value at time t: inside an interval, and at the
              least-norm value when one is given; exactly the value. The interval must be that of
              the report, to 1e-9; a signal that the report does not list has one value. "frozen"
              holds sources at what they have then: the report's intervals are those of an
              operating point, for it keeps silent about single instants. "reported" is the
              interval that the report has for the signal where that is not "val", as for a sum
              of signals, or at its first time.
  rcp         just after t = 0: x_NAME state, q_NAME charge, f_NAME flux impulse, loss in J
  event       an element turns on or off at t, up to two steps; t null: it never does
  infeasible  the run is refused with exit status 1, naming the elements
  multi       the final value is one of those listed
  hmax        runs with a step of a tenth of the largest one
Without "tol" the tolerance is 1e-12 of the value, or of the scale (the largest voltage or current
of the run, or "scale") where the value is zero.

The default method has no step of its own: it runs with tolerances of 1e-6 and of 1e-9. Small
circuits are right to 1e-9 with either, so each value of be, tran and diff must be the exact one to
1e-9 of the largest value of its signal (of the largest voltage or current of the run for a sum of
signals and for what is zero). "exact" is a closed form of the circuit where "val" is one of implicit
Euler, or an approximation. range, op, mean, rcp, infeasible and multi mean the same as above; event
times are exact to 1e-11 of the stop time; sum, hmax and what has a "step" belong to implicit Euler
alone.
"""

import json
import math
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import NETLISTS, Checker, run  # noqa: E402

EXACT = 1e-12        # relative, h-exact values
CERTIFIED = 2e-13    # scaled residual of every step
JUMP = 1e-9          # relative, states after jumps and impulses
LEAST_NORM = 1e-6    # of the scale, least-norm values
INTERVAL = 1e-9      # relative, bounds of what is not determined
FRACTIONS = (1, 2, 5)
DEFAULT = 1e-6       # the default tolerance
FINE = 1e-9
EVENT_TIME = 1e-11   # of the stop time
NOTHING = 1e-9       # of the largest signal of its kind: a signal that is zero


class HardCase:
    method = "euler"

    def __init__(self, program, name, entries):
        self.program = program
        self.netlist = NETLISTS / "hard" / f"{name}.cir"
        self.entries = entries
        self.checker = Checker(name)
        self.runs = {}

    def stop(self):
        """The stop time of .tran, None when there is only .op."""
        card = re.search(r"^\.tran\s+(\S+)\s+(\S+)", self.netlist.read_text(), re.M | re.I)
        if card is None:
            return None
        number = re.fullmatch(r"([0-9.]+)([munp]?)", card.group(2))
        return float(number.group(1)) * {"": 1, "m": 1e-3, "u": 1e-6, "n": 1e-9,
                                         "p": 1e-12}[number.group(2)]

    def run(self, step=None, grid=None):
        """One accepted run, kept for other entries; rows at the multiples of grid."""
        key = (step, grid)
        if key not in self.runs:
            at = None
            if grid is not None:
                stop = self.stop()
                count = min(round(stop / grid), 20000)
                at = [min(k * grid, stop) for k in range(count + 1)]
            self.runs[key] = self.accepted(f"step {step}", step=step, at=at)
        return self.runs[key]

    def accepted(self, label, **options):
        """A run that must succeed, with certified steps and finite values."""
        result = run(self.program, self.netlist, **options, quiet=False)
        if not self.checker.check(result.status == 0 and result.rows,
                                  f"exit {result.status} at {label}: {result.stderr}"):
            raise SystemExit(self.checker.finish())
        worst = result.report["certificate"]["worst"]
        self.checker.check(worst <= CERTIFIED, f"certificate {worst:.2e} at {label}")
        self.checker.check(all(math.isfinite(x) for row in result.rows for x in row),
                           f"a value is not finite at {label}")
        return result

    def stepped(self, entry):
        """Runs at h, h/2 and h/5, on the output grid of h."""
        h = entry["h"]
        return [(h / part, self.run(h / part, h)) for part in FRACTIONS]

    def value_of(self, entry, step, key="val"):
        value = entry[key]
        if isinstance(value, str):
            names = {name: getattr(math, name) for name in ("sin", "cos", "exp", "pi")}
            names.update(t=entry["t"], max=max, min=min, abs=abs)
            if step is not None:
                names.update(h=step, n=round(entry["t"] / step))
            value = eval(value, {"__builtins__": {}}, names)  # our own file
        return float(value)

    def be(self, entry):
        for step, result in self.stepped(entry):
            wanted = self.value_of(entry, step)
            size = abs(wanted) or max(result.scale(entry["q"]), entry.get("scale", 0))
            self.checker.close(result.at(entry["q"], entry["t"]), wanted,
                               entry.get("tol", EXACT * size),
                               f"{entry['q']} at {entry['t']} with step {step:g}")

    def diff(self, entry):
        for step, result in self.stepped(entry):
            size = abs(entry["val"]) or result.scale(entry["q"])
            self.checker.close(result.at(entry["q"], entry["t"]), entry["val"], LEAST_NORM * size,
                               f"{entry['q']} at {entry['t']} with step {step:g}")

    def tran(self, entry):
        for step, result in self.stepped(entry):
            self.checker.close(result.at(entry["q"], entry["t"]), entry["val"],
                               entry["tol"] * step / entry["h"],
                               f"{entry['q']} at {entry['t']} with step {step:g}")

    def mean(self, entry):
        result = self.run(entry["h"], entry["h"])
        time, value = result.time, result.column(entry["q"])
        area = sum((time[k + 1] - time[k]) * (value[k] + value[k + 1]) / 2
                   for k in range(len(time) - 1))
        self.checker.close(area / (time[-1] - time[0]), entry["val"], entry["tol"],
                           f"mean of {entry['q']}")

    def sum(self, entry):
        for step in (entry["h"] / part for part in FRACTIONS):
            result = self.run(step, step)
            self.checker.close(step * sum(result.column(entry["q"])[1:]), entry["val"],
                               EXACT * abs(entry["val"]), f"sum of h {entry['q']}, step {step:g}")

    def range(self, entry):
        low, high = (float(bound) for bound in entry["val"])
        results = [self.run()] if "t" not in entry else [r for _, r in self.stepped(entry)]
        for result in results:
            value = (result.at(entry["q"], entry["t"]) if "t" in entry
                     else result.column(entry["q"])[-1])
            scale = result.scale(entry["q"])
            slack = EXACT * max(scale, *(abs(b) for b in (low, high) if math.isfinite(b)), 0)
            if "least_norm" in entry:
                slack = max(slack, LEAST_NORM * scale)
                self.checker.close(value, entry["least_norm"], slack, f"least-norm {entry['q']}")
            self.checker.check(low - slack <= value <= high + slack,
                               f"{entry['q']} = {value!r} is outside [{low}, {high}]")
        if "frozen" in entry:
            results = [self.frozen(entry["frozen"])]
        for result in results:
            for signal, wanted in entry.get("reported", {entry["q"]: entry["val"]}).items():
                self.interval(result, signal, wanted)

    def frozen(self, sources):
        """The operating point with some sources at constant values."""
        def hold(card):
            name = card.split()[0].lower() if card.split() else ""
            if name in sources:
                return " ".join(card.split()[:3] + [f"DC {sources[name]!r}"])
            return ".op" if name == ".tran" else card
        text = "\n".join(hold(card) for card in self.netlist.read_text().splitlines())
        result = run(self.program, text + "\n", method=self.method, quiet=False)
        self.checker.check(result.status == 0, f"exit {result.status}: {result.stderr}")
        return result

    def interval(self, result, signal, wanted):
        """What the report says of a signal; nothing means that it is unique."""
        listed = [n for n in result.report["nonunique"] if n["signal"] == signal]
        self.checker.check(len(listed) <= 1, f"{signal} is reported {len(listed)} times")
        value = result.column(signal)[-1]
        found = listed[0] if listed else {"lower": value, "upper": value, "value": value}
        scale = result.scale(signal)
        for key, bound in zip(("lower", "upper"), map(float, wanted)):
            reported = float(found[key])
            if math.isinf(bound):
                self.checker.check(reported == bound, f"{key} bound of {signal}: {reported!r}")
            else:
                self.checker.close(reported, bound, INTERVAL * (abs(bound) or scale),
                                   f"{key} bound of {signal}")
        self.checker.check(not listed or signal in result.stderr,
                           f"no warning names {signal}: {result.stderr}")

    def op(self, entry):
        result = self.run()
        size = abs(entry["val"]) or max(result.scale(entry["q"]), entry.get("scale", 0))
        self.checker.close(result.column(entry["q"])[-1], entry["val"], EXACT * size, entry["q"])

    def rcp(self, entry):
        result = self.run()
        if entry["q"] == "loss":
            found = result.loss()
        else:
            kind, element = entry["q"].split("_", 1)
            found = {"x": lambda: result.report["start"][element],
                     "q": lambda: result.impulse(element, "charge"),
                     "f": lambda: result.impulse(element, "flux")}[kind]()
        others = [abs(e["val"]) for e in self.entries if e["kind"] == "rcp"]
        size = abs(entry["val"]) or max(others + [1e-3])
        self.checker.close(found, entry["val"], JUMP * size, f"{entry['q']} after t = 0")

    def event(self, entry):
        state = "on" if entry["on"] else "off"
        for step, result in self.stepped(entry):
            times = [event["time"] for event in result.report["events"]
                     if event["element"] == entry["q"] and event["state"] == state]
            if entry["t"] is None:
                self.checker.check(not times, f"{entry['q']} turns {state} at {times[:3]}")
            else:
                nearest = min(times, key=lambda t: abs(t - entry["t"]), default=math.inf)
                self.checker.close(nearest, entry["t"], 2 * step,
                                   f"time when {entry['q']} turns {state}, step {step:g}")

    def infeasible(self, entry):
        result = run(self.program, self.netlist, step=entry.get("step"), method=self.method)
        self.checker.check(result.status == 1, f"exit {result.status}, not refused")
        self.checker.check(result.output is None, "an output file was left")
        for element in entry["elements"]:
            self.checker.check(re.search(rf"\b{element}\b", result.stderr, re.I),
                               f"{element} is not named: {result.stderr}")
        if not self.checker.check(result.report is not None and "infeasible" in result.report,
                                  "the report has no key 'infeasible'"):
            return
        refused = result.report["infeasible"]
        self.checker.check(set(entry["elements"]) <= set(refused["elements"]),
                           f"the report names {refused['elements']}")
        self.checker.check(0 <= refused["time"] <= entry.get("t", entry.get("step", 0)),
                           f"refused at {refused['time']}")

    def multi(self, entry):
        listed = [n for n in self.run().report["nonunique"] if n["signal"] == entry["q"]]
        solutions = f"{len(entry['val'])} solutions"
        if self.checker.check(len(listed) == 1, f"{entry['q']} is reported {len(listed)} times"):
            self.checker.check(solutions in listed[0]["because"], listed[0]["because"])
            self.checker.check(listed[0]["lower"] < 0 < listed[0]["upper"], f"{listed[0]}")
        value = self.run().column(entry["q"])[-1]
        error = min(abs(value - wanted) for wanted in entry["val"])
        self.checker.check(error <= EXACT, f"{entry['q']} = {value!r}, not in {entry['val']}")

    def hmax(self, entry):
        self.run(0.1 * entry["val"])

    def finish(self):
        for entry in self.entries:
            getattr(self, entry["kind"])(entry)
        return self.checker.finish()


class DefaultCase(HardCase):
    """The same entries for the default method: what they say about the circuit itself."""

    method = None

    def times(self):
        """Where some entry looks, and enough between to know how large a signal gets."""
        stop = self.stop()
        if stop is None:
            return None
        wanted = {entry["t"] for entry in self.entries
                  if entry["kind"] in ("be", "tran", "diff", "range") and "t" in entry}
        return sorted(wanted | {min(stop * k / 200, stop) for k in range(201)})

    def run(self, step=None, grid=None):
        return self.toleranced(None, grid)

    def toleranced(self, tolerance, grid=None):
        key = (tolerance, grid)
        if key not in self.runs:
            if grid is None:
                at = self.times()
            else:
                at = [min(k * grid, self.stop()) for k in range(round(self.stop() / grid) + 1)]
            self.runs[key] = self.accepted(f"tolerance {tolerance or DEFAULT:g}",
                                           at=at, method=None, tolerance=tolerance)
        return self.runs[key]

    def be(self, entry):
        key = "exact" if "exact" in entry else "val"
        if key == "val" and re.search(r"\b[hn]\b", str(entry["val"])):
            return  # a closed form of implicit Euler, not of the circuit
        for tolerance in (None, FINE):
            result = self.toleranced(tolerance)
            wanted = self.value_of(entry, None, key)
            largest = max(abs(value) for value in result.column(entry["q"]))
            scale = max(result.scale(entry["q"]), entry.get("scale", 0))
            if re.search(r"\)[+-]", entry["q"]) or largest <= NOTHING * scale:
                largest = scale
            self.checker.close(result.at(entry["q"], entry["t"]), wanted,
                               FINE * largest,
                               f"{entry['q']} at {entry['t']}, tolerance {tolerance or DEFAULT:g}")

    tran = be
    diff = be

    def stepped(self, entry):
        return [(None, self.toleranced(FINE))]

    def event(self, entry):
        for tolerance in (None, FINE):
            self.event_at(entry, self.toleranced(tolerance))

    def event_at(self, entry, result):
        state = "on" if entry["on"] else "off"
        times = [event["time"] for event in result.report["events"]
                 if event["element"] == entry["q"] and event["state"] == state]
        if entry["t"] is None:
            self.checker.check(not times, f"{entry['q']} turns {state} at {times[:3]}")
        else:
            nearest = min(times, key=lambda t: abs(t - entry["t"]), default=math.inf)
            self.checker.close(nearest, entry["t"], EVENT_TIME * self.stop(),
                               f"time when {entry['q']} turns {state}")

    def infeasible(self, entry):
        if "step" not in entry:
            super().infeasible(entry)

    def sum(self, entry):
        pass

    def hmax(self, entry):
        pass

    def finish(self):
        # A case of which nothing else is left must at least run.
        if not any(entry["kind"] == "infeasible" and "step" not in entry for entry in self.entries):
            self.toleranced(None)
            self.toleranced(FINE)
        return super().finish()


def main():
    program, name, method = sys.argv[1:]
    entries = json.loads((HERE / "expected.json").read_text())
    entries = [entry for entry in entries if entry["case"] == name]
    return {"euler": HardCase, "default": DefaultCase}[method](program, name, entries).finish()


if __name__ == "__main__":
    sys.exit(main())
