"""An element beside one resistor and a source: a current that rises with its voltage, or a voltage with its current."""

from dalcs_program import run

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
