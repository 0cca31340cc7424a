"""An element beside one resistor and a source: a current that rises with its voltage, or a voltage with its current."""

import math

from dalcs_program import kinds_of, run, some_of

AT = [k / 16 for k in range(17)]  # s


def meet(f, right, slope):
    """x with f(x) + slope x = right, f rising."""
    low, high = -(abs(right) + 10) / slope, (abs(right) + 10) / slope
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if f(middle) + slope * middle < right else (low, middle)
    return 0.5 * (low + high)


def cards(law, is_current, source, ohms):
    """law: a formula of X."""
    law = law.replace("X", "v(1)" if is_current else "i(b1)")
    return ([f"I1 0 1 {source}", f"B1 1 0 I={law}", f"R1 1 0 {ohms!r}"] if is_current else
            [f"V1 2 0 {source}", f"B1 1 0 V={law}", f"R1 2 1 {ohms!r}"])


def check(checker, program, lines, wanted, allowed):
    """lines: a title and cards(). wanted: of what the element reads, at a time in s."""
    title, is_current = lines[0], lines[1].startswith("I1")
    netlist = "\n".join([*lines, ".tran 0.05 1", ""])
    result = run(program, netlist, method=None, at=AT, options=["--audit", "full"])
    if not checker.check(result.status == 0, f"{title}: exit {result.status}: {result.stderr}"):
        return
    for t, value in zip(AT, result.column("v(1)" if is_current else "i(b1)")):
        checker.close(value, wanted(t), allowed, f"{title} at {t:g} s")


def check_at_scale(checker, program, text, law, scale, is_current, source, allowed):
    """text: of X, `law`, whose argument is X over scale. source: offset and amplitude of a sine of 1 Hz, beside a slope of
    0.1. allowed: over scale."""
    offset, amplitude = source
    title = f"{text} as a {'current' if is_current else 'voltage'}, {scale:g}"
    lines = [title, *cards(text.replace("X", f"(X/{scale!r})"), is_current, f"SIN({offset} {amplitude} 1)",
                           10 * scale if is_current else 0.1 / scale)]

    def wanted(t):
        return scale * meet(law, offset + amplitude * math.sin(2 * math.pi * t), 0.1)

    check(checker, program, lines, wanted, allowed * scale)


def check_scales(checker, program, laws, scales, source, allowed):
    """All of `laws`, by their texts, at some of the scales, as currents and as voltages."""
    for text in kinds_of(laws):
        for scale in some_of(scales, 2):
            for is_current in (True, False):
                check_at_scale(checker, program, text, laws[text], scale, is_current, source, allowed)
