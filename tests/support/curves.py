"""Curves through the rows of a run, drawn from the rows alone."""

import bisect


def line(times, values, k, t):
    part = (t - times[k]) / (times[k + 1] - times[k])
    return values[k] + part * (values[k + 1] - values[k])


def cubic(times, values, k, t):
    """Through the rows from k - 1 to k + 2; None where two of them have the same time, or there are fewer."""
    if k < 1 or k + 2 >= len(times) or any(times[i] == times[i + 1] for i in range(k - 1, k + 2)):
        return None
    total = 0.0
    for i in range(k - 1, k + 3):
        weight = 1.0
        for j in range(k - 1, k + 3):
            weight *= (t - times[j]) / (times[i] - times[j]) if j != i else 1.0
        total += weight * values[i]
    return total


def error_at(times, values, t, wanted, by_lines=False):
    """How far the curve is off at t: of the cubic and the line the better one, which at a corner of a source, where
    there is one row, is the line."""
    k = min(max(bisect.bisect_right(times, t) - 1, 0), len(times) - 2)
    found = [line(times, values, k, t)] + ([] if by_lines else [cubic(times, values, k, t)])
    return min(abs(value - wanted) for value in found if value is not None)
