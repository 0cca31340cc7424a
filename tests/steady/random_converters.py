#!/usr/bin/env python3
"""Steady states of converters drawn at random, each against a run that is long enough, or refused for a true reason.

usage: random_converters.py PROGRAM SEED...      with FIRST-LAST for all the seeds from FIRST to LAST
       random_converters.py show SEED            prints the netlist of a seed

`random_converters.py build/dalcs 0-999` looks at a thousand.
"""

import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error
import drawn  # pylint: disable=import-error

NEAR = 1e-9
MOST_PERIODS = 20000  # that a run may settle; a slower orbit has to last for a hundred periods
LASTS = 100
MOST_GROWING = 1000000  # the same beside an unstable orbit
GROWS = 1e5  # what is beside an unstable orbit may have little of what grows
ROUNDING = 1e-15  # V, A


class Look:
    """At one converter."""

    def __init__(self, program, folder, checker, case):
        self.program, self.folder, self.checker, self.case = program, folder, checker, case

    def check(self, condition, message):
        return self.checker.check(condition, f"{self.case.name}: {message}")

    def run(self, verb, netlist, *options):
        (self.folder / "c.cir").write_text(f"{self.case.name}\n{netlist}.end\n")
        (self.folder / "c.json").unlink(missing_ok=True)
        done = subprocess.run([self.program, verb, "c.cir", "-q", "-o", "c.csv", "--report", "c.json", *options],
                              cwd=self.folder, capture_output=True, text=True, check=False)
        path = self.folder / "c.json"
        return done, json.loads(path.read_text()) if path.exists() else {}

    def after(self, netlist, periods, period):
        """The states at the end of a run from what the netlist says, or None."""
        stop = periods * period
        done, report = self.run("run", netlist + f".tran {stop!r} {stop!r} {stop * (1 - 1e-9)!r} uic\n", "--tol", "1e-11",
                                "--fill", "none")
        return report.get("final") if self.check(done.returncode == 0, f"the run: {done.stderr}") else None

    def off(self, one, other, steady):
        """The largest difference of states, over the largest rms value of their unit."""
        worst = 0.0
        for kind, unit in (("c", "v("), ("l", "i(")):
            scale = max((signal["rms"] or 0.0 for name, signal in steady["signals"].items() if name.startswith(unit)), default=0.0)
            scale = scale if scale > ROUNDING else 1.0  # where no diode conducts currents are rounding
            for name in other:
                if name.rsplit(".", 1)[-1][0] == kind:
                    worst = max(worst, abs(one[name] - other[name]) / (scale or 1.0))
        return worst

    def look(self):
        # parts of more than 64 unknowns are right to the tolerance alone
        large = ("--tol", "1e-10") if "six" in self.case.name else ()
        done, report = self.run("steady", self.case.netlist + ".pss uic\n", *large)
        steady = report.get("steady")
        said = done.stderr[done.stderr.find("dalcs: error"):]
        if self.case.expect == "no_common":
            self.check(done.returncode == 2 and "no common period" in said, f"status {done.returncode}: {said}")
            return "no common period"
        if self.case.expect == "drift":
            self.check(done.returncode == 1 and re.search(r"v\(c9y\) (rises|falls) by", said), f"{done.returncode}: {said}")
            return self.grows(said)
        if done.returncode == 1 and "no periodic steady state was found" in said:
            return self.repeats_nowhere(said)
        if done.returncode == 1 and "there is no periodic steady state" in said:
            return self.grows(said)
        if not self.check(done.returncode == 0 and steady, f"status {done.returncode}: {said}"):
            return "refused"
        sizes = [math.hypot(m["re"], m["im"]) for m in steady["multipliers"]]
        if self.case.expect == "kept":
            self.check(steady["conserved"], f"nothing is conserved: {sizes[:3]}")
        if steady["conserved"]:  # also what rests at the limit of a control
            sizes = [size for size in sizes if abs(size - 1) > 1e-9]
        largest = max(sizes, default=0.0)
        if steady.get("self_oscillating"):
            return self.lasts(steady, largest)
        if steady["stable"] or (steady["conserved"] and largest < 1.0):
            return self.settles(steady, largest)
        return self.leaves(steady, largest)

    def settles(self, steady, largest):
        """A multiplier mu leaves mu^n of what is off at first, and in defective cases n mu^n."""
        periods = 20 if largest < 0.1 else math.ceil(1.3 * math.log(1e-12) / math.log(largest)) + 20 if largest < 1 else 1e9
        if periods > MOST_PERIODS:
            return self.lasts(steady, largest)
        final = self.after(self.case.netlist, periods, steady["period"])
        if final is None:
            return "no run"
        worst = self.off(steady["states"], final, steady)
        if worst <= NEAR:
            return f"settles, {worst:.1e}, {periods} periods, {steady['newton']} steps"
        # some transients last longer than their multipliers say, and there may be several orbits
        return f"the run is off by {worst:.1e}, but it " + self.lasts(steady, largest)

    def lasts(self, steady, largest):
        """A run that begins on the orbit stays there."""
        states = steady["states"]
        if not self.can_begin(states):
            return self.stays(steady, largest)
        # a switch with a hysteresis may stand on either side then
        sides = ("on", "off") if " vh=" in self.case.netlist else ("",)
        finals = [self.after(begun(self.case.netlist, states, side), LASTS, steady["period"]) for side in sides]
        if None in finals:
            return "no run"
        # a period of its own is known to 1e-11 or so, and the run is off by as many of these
        near = NEAR * (LASTS if steady.get("self_oscillating") else 1) * max(1.0, largest ** LASTS)
        worst = min(self.off(states, final, steady) for final in finals)
        if worst > 0.1:  # these states may begin in other modes: where a closed switch keeps itself closed by what it does
            return self.stays(steady, largest)
        self.check(worst <= near, f"after {LASTS} periods it is off by {worst:.2g}; {steady['verdict']}")
        return f"lasts, {worst:.1e}"

    def stays(self, steady, largest):
        """The same where a netlist cannot say how to begin: the run leaves the orbit of its own search."""
        stop = LASTS * steady["period"]
        done, report = self.run("run", self.case.netlist + f".tran {stop!r} {stop!r} {stop * (1 - 1e-9)!r} uic=steady\n.pss uic\n",
                                "--tol", "1e-11", "--fill", "none")
        if not self.check(done.returncode == 0, f"the run from the orbit: {done.stderr}"):
            return "no run"
        worst = self.off(steady["states"], report["final"], steady)
        self.check(worst <= NEAR * max(1.0, largest ** LASTS), f"{LASTS} periods from the orbit it is off by {worst:.2g}")
        return f"stays, {worst:.1e}"

    def can_begin(self, states):
        """What a run can begin with: not what is inside of a source or a subcircuit, nor a source that is late."""
        late = re.search(r"(?m)^vg g 0 pulse\(0 1 ([0-9.e+-]+) .* ([0-9.e+-]+)\)$", self.case.netlist)
        return not (late and float(late[1]) > float(late[2])) and not any("x1(" in name for name in states)

    def leaves(self, steady, largest):
        """An orbit that is not stable: what is beside it leaves."""
        states = steady["states"]
        if not self.can_begin(states):
            return "not looked at"
        beside = {name: value * (1 + 1e-6) + (1e-9 if value == 0 else 0) for name, value in states.items()}
        periods = max(10, min(MOST_GROWING, math.ceil(math.log(GROWS) / math.log(largest)))) if largest > 1 else LASTS
        final = self.after(begun(self.case.netlist, beside), periods, steady["period"])
        if final is None:
            return "no run"
        worst = self.off(states, final, steady)
        before = self.off(states, beside, steady)
        self.check(worst > 10 * before, f"said to be unstable ({steady['verdict']}), but {before:.2g} beside it become "
                                        f"{worst:.2g} after {periods} periods")
        return f"leaves, {before:.1e} to {worst:.1e}: {steady['verdict'][:60]}"

    def grows(self, said):
        """What is said to change in each period does so in a run, once it has come to that."""
        if not self.check(changes(said), f"nothing grows: {said}"):
            return "no run"
        off = math.inf
        for n in (4000, 16000, 64000):  # what settles besides may do so slowly
            if off > 1e-5:
                ends = [self.after(self.case.netlist, k, self.clock()) for k in (n, n + 1)]
                if None in ends:
                    return "no run"
                off = max(abs(ends[1][name] - ends[0][name] - by) / abs(by) for name, by in changes(said))
        self.check(off <= 1e-5, f"what is said to grow is off by {off:.2g}: {said}")
        return f"grows: {', '.join(name for name, _ in changes(said))}"

    def clock(self):
        """The period of a netlist with one clock."""
        return max(float(p.split()[-1]) for p in re.findall(r"(?m)pulse\(([^)]*)\)", self.case.netlist))

    def repeats_nowhere(self, said):
        """1 to 8 periods of its clock later a long run is elsewhere; and what is said to have changed changes there."""
        ends = [self.after(self.case.netlist, 3000 + k, self.clock()) for k in range(9)]
        if None in ends:
            return "no run"
        nearest = min(max(abs(ends[0][n] - end[n]) / max(abs(ends[0][n]), 1e-30) for n in end) for end in ends[1:])
        self.check(nearest > 1e-7, f"no steady state was found, but a run repeats, but for {nearest:.2g}")
        for name, by in changes(said):
            moves = max(end[name] for end in ends) - min(end[name] for end in ends)
            self.check(abs(by) <= 10 * moves, f"{name} does not change by {by:.6g}: {moves:.6g} in 8 periods")
        return f"repeats nowhere, {nearest:.1e}"


def changes(said):
    """(state, by how much) of "v(c1) rises by 3 mV"; of a coil that others have a part in the name alone is said."""
    found = re.findall(r"(?:[iv]\()?(\w\S*?)\)? (rises|falls) by ([0-9.]+) ?([kmunp]?)[AV]", said)
    size = {"": 1, "k": 1e3, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12}
    return [(name, float(number) * size[prefix] * (1 if way == "rises" else -1)) for name, way, number, prefix in found]


def begun(netlist, states, side=""):
    """The netlist with these states at the start, and the switch on this side."""
    lines = []
    for line in netlist.splitlines():
        name = line.split()[0].lower()
        if name.startswith(".model") and "state(ax)" in states:
            line = re.sub(r"out_ic=[^ )]+", f"out_ic={states['state(ax)']!r}", line)
        if name in states:
            line = re.sub(r" ic=\S+", "", line, flags=re.IGNORECASE) + f" ic={states[name]!r}"
        lines.append(line + f" {side}" if name == "s1" else line)
    return "\n".join(lines) + "\n"


def seeds_of(words):
    for word in words:
        first, _, last = word.partition("-")
        yield from range(int(first), int(last or first) + 1)


def main():
    if sys.argv[1] == "show":
        case = drawn.drawn(int(sys.argv[2]))
        print(f"{case.name}\n{case.netlist}.pss uic\n.end")
        return 0
    checker = dalcs_program.Checker("random converters")
    for seed in dalcs_program.some_of(seeds_of(sys.argv[2:]), 1):
        case = drawn.drawn(seed)
        with tempfile.TemporaryDirectory() as folder:
            found = Look(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(folder), checker, case).look()
        print(f"{case.name}: {found}", flush=True)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
