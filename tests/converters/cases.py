"""What a converter is to the tests: a netlist without an analysis, and its equations."""

import collections

# name; netlist; circuit, states and mode at t = 0; seconds; {column of dalcs: its value of the states}; the tolerance of
# the run, where parts are too large to be held to 1e-9 in any case
Case = collections.namedtuple("Case", "name netlist circuit states mode stop signals tolerance", defaults=(None,))


def card_pulse(name, nodes, delay, width, period, low=0, high=1):
    return f"{name} {nodes} pulse({low} {high} {delay!r} 0 0 {width!r} {period!r})\n"
