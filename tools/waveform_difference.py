"""How far two waveforms are apart, whatever their grids.

Two simulators put an edge at slightly different times, and round or ring at it; a difference there
says nothing. So what is measured at a time is the distance from one waveform's value to the range
that the other one passes through within a small window around that time, and beside the largest
there is the `usual` difference, which 99 % of the time it stays below.
"""

import dataclasses
import math


USUAL = 0.99


@dataclasses.dataclass
class Difference:
    signal: str
    scale: float  # > 0
    largest: float
    usual: float
    rms: float
    time: float  # of the largest

    def relative(self, value):
        return value / self.scale

    def within(self, tolerance):
        """The rms may be half of the tolerance: a waveform that is off all the time is wrong."""
        return (self.relative(self.usual) <= tolerance
                and self.relative(self.rms) <= tolerance / 2)

    def as_dict(self):
        return {"scale": self.scale, "max": self.largest, "time": self.time, "usual": self.usual,
                "rms": self.rms, "relative_max": self.relative(self.largest),
                "relative_usual": self.relative(self.usual),
                "relative_rms": self.relative(self.rms)}


def interpolate(times, values, grid):
    """Values at the ascending times of `grid`; between equal times the later row."""
    result, k, last = [], 0, len(times) - 1
    for t in grid:
        while k < last and times[k + 1] <= t:
            k += 1
        if k == last or times[k] >= t:
            result.append(values[k])
        else:
            part = (t - times[k]) / (times[k + 1] - times[k])
            result.append(values[k] + part * (values[k + 1] - values[k]))
    return result


def ranges(times, values, grid, window):
    """Lowest and highest value within `window` of each time of `grid`."""
    before = interpolate(times, values, [t - window for t in grid])
    after = interpolate(times, values, [t + window for t in grid])
    result, first, end = [], 0, 0
    for t, a, b in zip(grid, before, after):
        while first < len(times) and times[first] < t - window:
            first += 1
        end = max(end, first)
        while end < len(times) and times[end] <= t + window:
            end += 1
        inside = values[first:end]
        result.append((min(a, b, *inside), max(a, b, *inside)))
    return result


def compare(signal, ours, theirs, grid, window, scale):
    """`ours` and `theirs` are (times, values)."""
    errors = []
    for value, (low, high) in zip(interpolate(*theirs, grid), ranges(*ours, grid, window)):
        finite = math.isfinite(value) and math.isfinite(low) and math.isfinite(high)
        errors.append(max(low - value, value - high, 0.0) if finite else math.inf)
    largest = max(errors)
    usual = sorted(errors)[int(USUAL * (len(errors) - 1))]
    rms = math.sqrt(sum(error * error for error in errors) / len(errors))
    return Difference(signal, scale, largest, usual, rms, grid[errors.index(largest)])


def compare_points(signal, ours, theirs, scale):
    """Two single values, of an operating point."""
    error = abs(ours - theirs)
    return Difference(signal, scale, error, error, error, 0.0)
