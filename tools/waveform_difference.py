"""How far two waveforms are apart, whatever their grids.

Two simulators put an edge at slightly different times; a difference there says nothing. So what is
measured at a time is the distance from one waveform's value to the range that the other one passes
through within a small window around that time.
"""

import dataclasses
import math


@dataclasses.dataclass
class Difference:
    signal: str
    scale: float
    largest: float
    rms: float
    time: float  # of the largest

    @property
    def relative_largest(self):
        return self.largest / self.scale if self.scale > 0 else 0.0

    @property
    def relative_rms(self):
        return self.rms / self.scale if self.scale > 0 else 0.0


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
    other = interpolate(*theirs, grid)
    total, largest, at = 0.0, 0.0, grid[0]
    for t, value, (low, high) in zip(grid, other, ranges(*ours, grid, window)):
        error = max(low - value, value - high, 0.0)
        if math.isnan(value) or math.isnan(low):
            error = math.inf
        total += error * error
        if error > largest:
            largest, at = error, t
    return Difference(signal, scale, largest, math.sqrt(total / len(grid)), at)


def compare_points(signal, ours, theirs, scale):
    """Two single values, of an operating point."""
    error = abs(ours - theirs)
    return Difference(signal, scale, error, error, 0.0)
