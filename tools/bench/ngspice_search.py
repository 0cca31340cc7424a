"""Looks for the ngspice settings that reach an error in the least time.

First a grid: method, reltol, the diodes' N, and for each a descent through finer and finer steps
until nothing is gained. Then, for each target error, variations around the fastest settings found.
Whatever was tried is kept, with its error and time; the choice is made by time alone."""

import dataclasses
import json
import math

import ngspice_deck
from ngspice_deck import Setting

TARGETS = (1e-3, 5e-4, 1e-4, 1e-5, 1e-6)
METHODS = ("trap", "gear")
EMISSIONS = (1e-2, 1e-3, 1e-4, 3e-5, 1e-5)
EDGES = (1e-9, 1e-11, 1e-12)  # s, of gates
RELTOLS = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
STEPS = (5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000)  # in a period
LONGEST = 3.0  # s; a setting that takes longer has no place in a table of milliseconds
LONGEST_OF_LARGE = 5.0
RESCUE = "gmin=1e-9"  # what gets ngspice through where it gives up
SHORT = 0.05  # s; the time of a run as short as this is taken from many
NEAR = 1.5  # times the smallest error reached counts as ngspice's best


def with_option(options, name, value):
    """Of .options, an option set or replaced."""
    kept = [option for option in options.split() if not option.startswith(f"{name}=")]
    return " ".join(sorted(kept + [f"{name}={value}"]))


class Search:
    def __init__(self, text, reference, period, gated, large=False):
        self.runner = ngspice_deck.Runner(text, reference)
        self.period, self.gated = period, gated
        self.longest = LONGEST_OF_LARGE if large else LONGEST
        self.reltols = RELTOLS[::2] if large else RELTOLS
        self.emissions = EMISSIONS[::2] if large else EMISSIONS
        self.rounds, self.candidates = (1, 1) if large else (2, 2)  # of the variations
        self.tried = {}

    def edge(self, emission):
        return EDGES[0 if emission >= 1e-3 else 1] if self.gated else 0.0

    def attempt(self, setting):
        if setting not in self.tried:
            self.tried[setting] = self.runner.run(setting, self.longest + 1)
        return self.tried[setting]

    def descend(self, method, reltol, emission):
        """Ever finer steps until they gain nothing or take too long."""
        best, in_vain, extra = math.inf, 0, ""
        seconds, before = 0.0, STEPS[0]
        for steps in STEPS:
            if seconds * steps / before > self.longest:
                return
            setting = Setting(method, reltol, self.period / steps, emission, self.edge(emission),
                              extra)
            result = self.attempt(setting)
            if result.reason and not extra:
                rescued = dataclasses.replace(setting, extra=RESCUE)
                result = self.attempt(rescued)
                extra = "" if result.reason else RESCUE
            if not result.reason:
                seconds, before = result.seconds, steps
            in_vain = 0 if result.error < 0.8 * best else in_vain + 1
            best = min(best, result.error)
            if best < TARGETS[-1] or in_vain == 3:
                return

    def fastest(self, target, count):
        good = [setting for setting, result in self.tried.items() if result.error <= target]
        return sorted(good, key=lambda setting: (self.tried[setting].seconds,
                                                 self.tried[setting].points))[:count]

    def vary(self, setting):
        change = dataclasses.replace
        for factor in (1.25, 1.6, 2.5, 0.7):
            yield change(setting, tmax=setting.tmax * factor)
        for factor in (3.0, 10.0, 0.3):
            yield change(setting, reltol=setting.reltol * factor)
        yield change(setting, reltol=setting.reltol * 3, tmax=setting.tmax * 1.6)
        for factor in (3.0, 0.3):
            yield change(setting, emission=setting.emission * factor)
        yield change(setting, extra=with_option(setting.extra, "trtol", 1),
                     tmax=setting.tmax * 2.5)
        yield change(setting, extra=with_option(setting.extra, "trtol", 50))
        if setting.method == "gear":
            for order in (3, 4, 6):
                yield change(setting, extra=with_option(setting.extra, "maxord", order))
        if self.gated:
            for edge in EDGES:
                yield change(setting, edge=edge)

    def time_again(self, target):
        """The likely ones, each among many runs of itself."""
        for setting in self.fastest(target, 12):
            result = self.tried[setting]
            if result.seconds < SHORT and not result.timed:
                result.seconds, result.timed = self.runner.time(setting, result.seconds), True

    def targets(self):
        """The given ones, and where ngspice falls short of the last one its own best."""
        nearly = NEAR * min((result.error for result in self.tried.values()), default=math.inf)
        falls_short = math.isfinite(nearly) and all(target > nearly or target < nearly / NEAR
                                                    for target in TARGETS)
        return TARGETS + ((nearly,) if falls_short and nearly > TARGETS[-1] else ())

    def narrow(self, target, say):
        """Variations around the fastest settings for a target."""
        for _ in range(self.rounds):
            self.time_again(target)
            for setting in self.fastest(target, self.candidates):
                for variation in self.vary(setting):
                    self.attempt(variation)
        self.time_again(target)
        for setting in self.fastest(target, 1):
            say(f"  {target:.2g}: {setting}: {self.tried[setting].error:.2e} in "
                f"{1e3 * self.tried[setting].seconds:.2f} ms")

    def run(self, say=print):
        for emission in self.emissions:
            for method in METHODS:
                for reltol in self.reltols:
                    self.descend(method, reltol, emission)
        for target in TARGETS:
            self.narrow(target, say)
        for target in self.targets()[len(TARGETS):]:
            self.narrow(target, say)

    def winners(self):
        """For each target the two fastest settings; what they are timed for again decides."""
        return list(dict.fromkeys(setting for target in self.targets()
                                  for setting in self.fastest(target, 2)))

    def summary(self):
        """What is kept of a search, in the form of the settings file."""
        return {"tried": len(self.tried),
                "given_up": sum(bool(result.reason) for result in self.tried.values()),
                "smallest_error": min((result.error for result in self.tried.values()),
                                      default=math.inf),
                "settings": [dataclasses.asdict(setting) for setting in self.winners()]}


def save(path, name, summary):
    known = json.loads(path.read_text()) if path.exists() else {}
    known[name] = summary
    path.write_text(json.dumps(known, indent=1) + "\n")


def load(search, path, name):
    """Tries the settings that an earlier search found; its summary, None where there was none."""
    summary = json.loads(path.read_text()).get(name) if path.exists() else None
    for setting in summary["settings"] if summary else []:
        search.attempt(Setting(**setting))
    return summary
