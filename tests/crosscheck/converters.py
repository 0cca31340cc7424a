#!/usr/bin/env python3
"""A converter of netlists/converters in dalcs and in ngspice.

usage: converters.py DALCS SPICE_OF TOOLS NETLIST WAY [SIGNAL ...]

WAY says how ngspice takes the file, and is not chosen here: a file that ngspice took as it is must stay one.
  plain    as it is, but for reltol
  lt, ps   as it is, in ngspice's own mode for files of LTspice or PSpice
  flat     as dalcs tells it to ngspice: what is in the way is another dialect (see the list in meson.build)
After a comma, `free` means that no clock ties the two together, and `tmax=10n` is ngspice's longest step, where
its comparator is not to wait for the netlist's; `reltol=1e-3` is for where its steps get too small with less.

Compared are the signals that dalcs records and ngspice has too, or those that are named, over the whole run:
  the mean of each of 20 windows,
  but for `free`, the values, which may stay apart for 1 % of the time: about edges, which ngspice has within a
  step of its own and dalcs where they are (tools/waveform_difference.py),
  with `free`, the lowest and highest value of each window after the first: phases drift apart, a swing does not.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
sys.path.insert(0, sys.argv[3])
import ngspice_batch  # noqa: E402
import waveform_difference  # noqa: E402
from dalcs_program import IS_LONG, Checker, run  # noqa: E402

SKIPPED = 77  # what meson takes for "skipped"
MODES = {"plain": [], "lt": ["-D", "ngbehavior=lta"], "ps": ["-D", "ngbehavior=psa"]}
N_WINDOWS, N_VALUES = 20, 4000
LIMIT = 100  # s
# With ngspice's own 1e-3 i(l1) of the SEPIC is off by 7 % as it starts; Euler with steps of 5 ns and ngspice with
# 1e-5 and steps of 10 ns, by either method, are within 0.4 % of dalcs.
RELTOL = "1e-5"
# Diodes of N = 0.01 drop 4 to 8 mV that dalcs's do not, of at least 4.8 V, and ngspice's switches move at the
# end of the step that finds their threshold passed: at most two steps of 50 ns late in 10 us, on or off.
MEAN = 0.01
VALUE = 0.02
# A signal's scale is at least this part of the largest of its unit.
SMALL = 1e-2


class Waveforms:
    """Columns by name beside their times."""

    def __init__(self, times, columns):
        self.times, self.columns = times, columns


def run_ngspice(text, mode, folder):
    """The table of a run that came to its end, or why there is none."""
    (folder / "n.cir").write_text(text, encoding="utf-8")
    raw = folder / "n.raw"
    raw.unlink(missing_ok=True)
    try:
        done = subprocess.run([ngspice_batch.NGSPICE, "-n", *mode, "-b", "-r", "n.raw", "n.cir"], cwd=folder,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=LIMIT, check=False)
    except subprocess.TimeoutExpired:
        return None, f"no end within {LIMIT} s"
    table = ngspice_batch.read_raw(raw) if raw.exists() else None
    if done.returncode != 0 or table is None or table.n_rows < 2:
        return None, ngspice_batch.reason_in((done.stdout + done.stderr).decode("utf-8", "replace"))
    return table, None


def simulate_as_is(netlist, way, settings, signals, folder):
    """ngspice's waveforms of the signals that it has, or why there are none."""
    text = netlist.read_text(encoding="utf-8")
    text = re.sub(r"(?mi)^\.end$", f".options reltol={settings['reltol']}\n.end", text)
    if settings["tmax"]:
        text = re.sub(r"(?mi)^\.tran (\S+ \S+ \S+) \S+", rf".tran \1 {settings['tmax']}", text)
    table, reason = run_ngspice(text, MODES[way], folder)
    if table is None:
        return None, reason
    return Waveforms(table.column("time"),
                     {name: table.signal(name) for name in signals if table.has(name)}), None


def simulate_flat(netlist, writer, signals, folder):
    """The same with the netlist that dalcs writes, in the first setting that ngspice gets through with."""
    reasons = []
    while True:
        done = subprocess.run([writer, str(len(reasons)), str(netlist), *signals], capture_output=True, text=True,
                              check=False)
        if done.returncode != 0:
            return None, "\n".join(reasons + [done.stderr])
        table, reason = run_ngspice(done.stdout, [], folder)
        if table is not None:
            break
        print(f"setting {len(reasons)}: {reason}")
        reasons.append(reason)
    found = {}
    for line in done.stdout.splitlines()[:len(signals)]:
        _, name, _, plus, minus = line.split()
        zero = [0.0] * table.n_rows
        first, second = (zero if part == "-" else table.column(part) for part in (plus, minus))
        found[name] = [a - b for a, b in zip(first, second)]
    return Waveforms(table.column("time"), found), None


def windows(times, values):
    """Mean, lowest and highest of each window."""
    start, stop = times[0], times[-1]
    result, k, last = [], 0, values[0]
    for i in range(N_WINDOWS):
        end = start + (stop - start) * (i + 1) / N_WINDOWS
        begin = t = start + (stop - start) * i / N_WINDOWS
        area, low, high = 0.0, last, last
        while k < len(times) and times[k] <= end:
            area += (times[k] - t) * (values[k] + last) / 2
            t, last = times[k], values[k]
            low, high = min(low, last), max(high, last)
            k += 1
        if k < len(times) and times[k] > t:
            value = last + (values[k] - last) * (end - t) / (times[k] - t)
            area += (end - t) * (value + last) / 2
            last, low, high = value, min(low, value), max(high, value)
        result.append((area / (end - begin), low, high))
    return result


def compare(checker, name, ours, theirs, scale, free):
    mine = windows(ours.times, ours.columns[name])
    other = windows(theirs.times, theirs.columns[name])
    off = max(abs(a[0] - b[0]) for a, b in zip(mine, other)) / scale
    checker.check(off <= MEAN, f"{name}: a mean is off by {100 * off:.3f} % of {scale:.4g}")
    if free:
        swing = max(abs(a[k] - b[k]) for a, b in zip(mine[1:], other[1:]) for k in (1, 2)) / scale
        checker.check(swing <= VALUE, f"{name}: a swing is off by {100 * swing:.3f} % of {scale:.4g}")
        return f"{name}: means {100 * off:.3f} %, swings {100 * swing:.3f} % of {scale:.4g}"
    start, stop = ours.times[0], ours.times[-1]
    grid = [start + (stop - start) * (k + 0.5) / N_VALUES for k in range(1, N_VALUES - 1)]
    d = waveform_difference.compare(name, (ours.times, ours.columns[name]), (theirs.times, theirs.columns[name]),
                                    grid, 1e-4 * (stop - start) / 10, scale)
    checker.check(d.relative(d.usual) <= VALUE, f"{name}: off by {100 * d.relative(d.usual):.3f} % of {scale:.4g} "
                  f"more than 1 % of the time; worst at {d.time}")
    return f"{name}: means {100 * off:.3f} %, 99 % of the time {100 * d.relative(d.usual):.3f} % of {scale:.4g}"


def main():
    program, writer, netlist = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[4])
    way, *words = sys.argv[5].split(",")
    if "long" in words and not IS_LONG:
        return SKIPPED
    settings = {"tmax": None, "reltol": RELTOL, **dict(word.split("=") for word in words if "=" in word)}
    checker = Checker(netlist.stem)
    ours = run(program, netlist, method=None, report=False)
    if not checker.check(ours.status == 0, ours.stderr):
        return checker.finish()
    named = sys.argv[6:]
    signals = named or ours.names[1:]
    with tempfile.TemporaryDirectory() as folder:
        try:
            theirs, reason = (simulate_flat(netlist, writer, signals, pathlib.Path(folder)) if way == "flat" else
                              simulate_as_is(netlist, way, settings, signals, pathlib.Path(folder)))
        except FileNotFoundError:
            print("ngspice is not installed")
            return SKIPPED
    if not checker.check(theirs is not None, f"ngspice: {reason}"):
        return checker.finish()
    checker.check(abs(theirs.times[-1] - ours.time[-1]) <= 1e-6 * ours.time[-1],
                  f"ngspice stops at {theirs.times[-1]}")
    common = [name for name in signals if name in theirs.columns]
    checker.check(common and (not named or common == named), f"ngspice has of {signals} only {common}")
    mine = Waveforms(ours.time, {name: ours.column(name) for name in common})
    largest = {name: max(map(abs, mine.columns[name])) for name in common}
    for name in common:
        scale = max(largest[name], SMALL * max(x for other, x in largest.items() if other[0] == name[0]))
        print(compare(checker, name, mine, theirs, scale, "free" in words))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
