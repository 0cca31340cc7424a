#!/usr/bin/env python3
"""Runs one netlist of tests/field and compares it with its entry in tests/field/expected.json.

usage: field_case.py PROGRAM CASE [option ...]

The netlists are what people drew, and its kind, at which the program once failed; the header of each says what the
right values are and where they come from. Options are handed to `dalcs run`. Keys of an entry:
  measured    {name: value} of .meas, to within "rtol" of the value or "atol"; null: it has none
  final       {signal: value} at the stop time, likewise
  events      times at which anything changes sides, all of them, likewise
  moves       {element: [times]} of one switch or diode alone, all of them, likewise
  says        parts of messages that must be there
  silent_of   parts that must not
  status      exit status, 0 when not given
  max_steps   no more steps than that
  max_events  no more events than that
  max_euler   no more steps of implicit Euler than that
"rtol" and "atol" stand beside them, 0 and 1e-12 when not given; "time_atol" is that of times.
"""

import json
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from dalcs_program import Checker, run  # noqa: E402

KEYS = {"measured", "final", "events", "moves", "says", "silent_of", "status", "max_steps", "max_events", "max_euler",
        "rtol", "atol", "time_atol"}


class FieldCase(Checker):
    def __init__(self, name, entry, outcome):
        super().__init__(name)
        self.entry = entry
        self.outcome = outcome

    def value(self, found, wanted, what):
        if found is None or wanted is None:
            self.check(found is None and wanted is None, f"{what} = {found}, not {wanted}")
            return
        allowed = max(self.entry.get("rtol", 0.0) * abs(wanted), self.entry.get("atol", 1e-12))
        self.close(found, wanted, allowed, what)

    def times(self, found, wanted, what):
        allowed = self.entry.get("time_atol", 1e-12)
        if self.check(len(found) == len(wanted), f"{what}: {len(found)} times, not {len(wanted)}: "
                                                 f"{found[:20]}"):
            for a, b in zip(found, wanted):
                self.close(a, b, allowed, f"{what}: time")

    def measured(self, wanted):
        found = {m["name"]: m.get("value") for m in self.outcome.report.get("measurements", [])}
        for name, value in wanted.items():
            if self.check(name in found, f"no measurement {name}"):
                self.value(found[name], value, name)

    def final(self, wanted):
        for name, value in wanted.items():
            self.value(self.outcome.column(name)[-1], value, f"{name} at the end")

    def events(self, wanted):
        self.times(sorted({e["time"] for e in self.outcome.report["events"]}), wanted, "events")

    def moves(self, wanted):
        for name, times in wanted.items():
            found = [e["time"] for e in self.outcome.report["events"] if e["element"] == name]
            self.times(found, times, name)

    def says(self, wanted):
        for part in wanted:
            self.check(part in self.outcome.stderr, f"does not say '{part}'")

    def silent_of(self, unwanted):
        for part in unwanted:
            self.check(part not in self.outcome.stderr, f"says '{part}'")

    def max_steps(self, most):
        steps = self.outcome.report["work"]["steps"]
        self.check(steps <= most, f"{steps} steps, no more than {most} allowed")

    def max_events(self, most):
        n = len(self.outcome.report["events"])
        self.check(n <= most, f"{n} events, no more than {most} allowed")

    def max_euler(self, most):
        steps = self.outcome.report["work"]["euler_steps"]
        self.check(steps <= most, f"{steps} steps of implicit Euler, no more than {most} allowed")

    def judge(self):
        wanted = self.entry.get("status", 0)
        self.check(self.outcome.status == wanted,
                   f"exit status {self.outcome.status}, not {wanted}: {self.outcome.stderr[:400]}")
        unknown = set(self.entry) - KEYS - {"note"}
        self.check(not unknown, f"unknown keys {sorted(unknown)}")
        if self.failures == 0:
            for key in sorted(set(self.entry) & KEYS - {"status", "rtol", "atol", "time_atol"}):
                getattr(self, key)(self.entry[key])
        return self.finish()


def main():
    program, name, *options = sys.argv[1:]
    entry = json.loads((HERE / "expected.json").read_text())[name]
    outcome = run(program, HERE / f"{name}.cir", options=options, method=None)
    return FieldCase(name, entry, outcome).judge()


sys.exit(main())
