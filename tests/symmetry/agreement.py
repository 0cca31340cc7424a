"""Whether two runs have the same results: exit status, waveforms at common times, events, measurements.

A waveform is promised to the tolerance over its largest value, or over 1e-5 of the largest of its unit; two
runs may differ by twice that. An event is promised to the tolerance over the slope of what crosses: times
may differ by SLACK tolerances of the stop time, and so waveforms are compared as the ranges that they have
within that time."""

import bisect
import functools
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import run  # noqa: E402

from circuits import signal_text, write  # noqa: E402

TIMES = 300
SLACK = 1.0
TOLERANCE = 1e-6
NOTHING = 1e-6  # over the largest of its unit: a signal that stays below is what others leave of each other, such as
FLOOR = 1e-9  # the voltage of a star's middle; it is known to this, to which small parts are held, of the others
MANY_STEPS = 10  # of implicit Euler: so few pass by a tie, many are an answer of another accuracy


class Answer:
    """What one run said."""

    def __init__(self, program, circuit, times, seconds=1.0, tolerance=None, stages=None, options=(), lines=()):
        at = None if times is None else [t * seconds for t in times]
        self.text = write(circuit, list(lines))
        self.run = run(program, self.text, at=at, method=None, tolerance=tolerance, stages=stages,
                       options=list(options), environment={"LC_ALL": "C"})
        self.status = self.run.status
        self.seconds = seconds

    @functools.cached_property
    def time(self):
        return self.run.time

    def column(self, signal):
        index = self.run.names.index(signal_text(signal))
        return [row[index] for row in self.run.rows]

    def undetermined(self):
        return {entry["signal"] for entry in self.run.report["nonunique"]} if self.run.report else set()

    def events(self):
        """Of each element its events in the units of time of the other run."""
        found = {}
        for event in self.run.report["events"]:
            found.setdefault(event["element"], []).append((event["time"] / self.seconds, event["state"]))
        return found


def disagreement(x, y, stop):
    """Spans in which two lists of events say different things: (start, end, what the first one says)."""
    if not x and not y:
        return
    other = {"on": "off", "off": "on"}
    first = other[(x or y)[0][1]]
    states = [first, other[y[0][1]] if y else first]
    times = sorted([(t, 0, s) for t, s in x] + [(t, 1, s) for t, s in y])
    start = 0.0
    for t, which, state in times + [(stop, 0, "")]:
        if states[0] != states[1] and t > start:
            yield start, t, states[0]
        states[which] = state
        start = t


def tolerance_of(circuit):
    return max(circuit.options.get("reltol", TOLERANCE), 1e-12)


def chosen_times(circuit, random, slack):
    """Instants of no grid, each between two that are a slack away."""
    stop = circuit.stop
    middles = sorted(random.uniform(0.0, 1.0) * (stop - 3 * slack) + 1.5 * slack for _ in range(TIMES))
    times, last = [], -1.0
    for t in middles:
        if t - slack > last:
            times += [t - slack, t, t + slack]
            last = t + slack
    return times


def bad_words(answer):
    found = re.search(r"\(null\)|internal error|\bnan\b", answer.run.stderr)
    return f"says {found[0]}" if found else None


class Reference:
    """The runs of a netlist as it is: one at common times, one with its own rows for the scales."""

    def __init__(self, program, circuit, random):
        self.circuit = circuit
        self.tolerance = tolerance_of(circuit)
        self.slack = SLACK * self.tolerance * circuit.stop
        self.times = chosen_times(circuit, random, self.slack)
        self.answer = Answer(program, circuit, self.times)
        coarse = circuit.copy()
        coarse.step = circuit.stop / 500
        self.rows = Answer(program, coarse, None, options=["--fill", "0.01"])
        self.scale = {}
        self.traces = {}
        if self.answer.status == 0 and self.rows.status == 0:
            largest = {"v": 0.0, "i": 0.0}
            for s in circuit.signals:
                self.scale[s] = max((abs(x) for x in self.rows.column(s)), default=0.0)
                largest[s[0]] = max(largest[s[0]], self.scale[s])
            for e in circuit.of("l"):  # which hold a flux, though every voltage may be 0
                flux = abs(e.value) * max(map(abs, self.rows.column(("i", e.name))), default=0.0)
                largest["v"] = max(largest["v"], flux / circuit.stop)
            self.least = {s: 0.0 if x > NOTHING * largest[s[0]] else FLOOR * largest[s[0]]
                          for s, x in self.scale.items()}
            self.scale = {s: max(x, 1e-5 * largest[s[0]]) for s, x in self.scale.items()}

    def waveforms(self, answer, change, tolerance):
        """The worst signal, if one is beyond what the tolerance promises."""
        skipped = self.answer.undetermined()
        skipped_after = answer.undetermined()
        worst = (1.0, None)
        for s in self.circuit.signals:
            after = change.name(s)
            if s in change.without or signal_text(s) in skipped or signal_text(after) in skipped_after:
                continue
            factor = change.factor(s) if change.factor else 1.0
            x, y = self.answer.column(s), [v / factor for v in answer.column(after)]
            allowed = max(2 * tolerance * self.scale[s], self.least[s], 1e-300)
            for k in range(0, len(x) - 2, 3):
                gap = max(min(x[k:k + 3]) - max(y[k:k + 3]), min(y[k:k + 3]) - max(x[k:k + 3]), 0.0)
                if not gap / allowed <= worst[0]:
                    worst = (gap / allowed, f"{signal_text(s)} is {y[k + 1]:.9g}, not {x[k + 1]:.9g}, at "
                                            f"{self.times[k + 1]:.6g} s: {gap / allowed:.1e} times what is "
                                            f"allowed")
        return worst[1]

    def carries(self, e, state, start, end, tolerance):
        """Whether rows of the reference in a span show more than two runs may differ by: a current through what
        conducts, a voltage across what blocks."""
        if e.name not in self.traces:
            a, b = (self.voltage(n) for n in e.nodes[:2])
            self.traces[e.name] = {"on": (self.rows.column(("i", e.name)), self.scale[("i", e.name)]),
                                   "off": ([x - y for x, y in zip(a, b)], max(map(abs, a + b)))}
        values, scale = self.traces[e.name][state]
        first, last = bisect.bisect_left(self.rows.time, start), bisect.bisect_right(self.rows.time, end)
        return any(abs(x) > 4 * tolerance * scale for x in values[first:last])

    def voltage(self, node):
        signal = next((s for s in self.circuit.signals if s[0] == "v" and s[1] == node), None)
        return self.rows.column(signal) if signal else [0.0] * len(self.rows.run.rows)

    def open_ends(self, answer, change):
        """Of an element the states in which what it shows is not determined: where an island floats, any of the diodes
        around it may be the one that is still closed without a current."""
        after = answer.undetermined()
        signals = [s for s in self.circuit.signals if signal_text(s) in self.answer.undetermined()
                   or signal_text(change.name(s)) in after]
        nodes = {n for s in signals if s[0] == "v" for n in s[1:]} - {"0"}
        currents = {s[1] for s in signals if s[0] == "i"}

        def states(e):
            return (["off"] if nodes & set(e.nodes[:2]) else []) + (["on"] if e.name in currents else [])
        return states

    def events(self, answer, change, slack, tolerance):
        """The first time for which an element is on in one run and off in the other, and it matters."""
        before, after = self.answer.events(), answer.events()
        is_open = self.open_ends(answer, change)
        for e in self.circuit.of("dsw"):
            x, y = before.get(e.name, []), after.get(change.name(("i", e.name))[1], [])
            for start, end, state in disagreement(x, y, self.circuit.stop):
                lasts = end - start > slack and state not in is_open(e)
                if lasts and self.carries(e, state, start + slack, end - slack, tolerance):
                    return (f"{e.name} is {state} from {start:.9g} s to {end:.9g} s, and is not then: "
                            f"{len(x)} events, and {len(y)}")
        return None

    def measures(self, answer, change, tolerance):
        values = [{m["name"]: m["value"] for m in a.run.report["measurements"]} for a in (self.answer, answer)]
        for name, words in self.circuit.measures if change.circuit.measures else ():
            x, y = values[0].get(name), values[1].get(name)
            signal = next(s for s in self.circuit.signals if signal_text(s) in " ".join(map(str, words)))
            factor = change.factor(signal) if change.factor else 1.0
            if (x is None) != (y is None) or (x is not None and abs(y / factor - x)
                                              > 4 * tolerance * self.scale[signal]):
                return f"measurement {name} is {y!r}, not {x!r} times {factor!r}"
        return None

    def compare(self, program, change):
        """None, or in words what differs."""
        arguments = dict(change.arguments)
        answer = Answer(program, change.circuit, self.times, change.seconds, **arguments)
        if answer.status != self.answer.status:
            first = next((m for m in answer.run.stderr.splitlines() if "error" in m), "")
            return f"exit {answer.status}, not {self.answer.status}: {first.split('error:')[-1].strip()}"
        if bad_words(answer):
            return bad_words(answer)
        if answer.status != 0:
            return None
        tolerance = self.tolerance
        if change.tolerance is not None:
            tolerance = (self.tolerance + change.tolerance) / 2
        crowd = [a.run.report["work"]["euler_steps"] for a in (self.answer, answer)]
        if crowd[1] > 10 * (crowd[0] + MANY_STEPS):
            return f"{crowd[1]} steps of implicit Euler, not {crowd[0]}"
        slack = max(self.slack, SLACK * tolerance * self.circuit.stop) + change.lag
        return (self.waveforms(answer, change, tolerance) or self.events(answer, change, slack, tolerance)
                or self.measures(answer, change, tolerance))
