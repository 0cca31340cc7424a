"""The list of what no answer may depend on: name and function of a circuit and random numbers."""

from additions import Change, ammeters, beside, cable, conductances, renamed, through, voltmeters
from scaling import Scaling


def scaled(**factors):
    def change(circuit, random):
        scaling = Scaling(**factors)
        found = Change(scaling.apply(circuit))
        found.factor, found.seconds = scaling.signal, factors.get("seconds", 1.0)
        return found
    return change


def with_tolerance(tolerance):
    def change(circuit, random):
        found = Change(circuit.copy())
        found.tolerance = found.arguments["tolerance"] = tolerance
        return found
    return change


def with_stages(stages):
    def change(circuit, random):
        found = Change(circuit.copy())
        found.arguments["stages"] = stages
        return found
    return change


def impedance(k):
    """Ohms times k at the same voltages."""
    return scaled(amperes=1 / k)


def all_of_them():
    table = {f"ohms*{k:g}": impedance(k) for k in (1e-3, 0.125, 3.7, 1e3)}
    table.update({f"time*{k:g}": scaled(seconds=k) for k in (2.0 ** -10, 1.37, 2.0 ** 7)})
    table.update({f"volts*{k:g}": scaled(volts=k, amperes=k) for k in (1e-3, 0.3, 1e3)})
    table.update({"names": renamed, "beside": beside, "voltmeters": voltmeters, "ammeters": ammeters,
                  "conductances": conductances})
    table.update({f"gates_{how}": through(how) for how in ("e", "b", "subcircuit", "rc")})
    for where in ("source", "meter"):
        for what in ("rc", "lc", "diodes"):
            for sections in (9, 20, 40, 70):
                table[f"cable_{where}_{what}_{sections}"] = cable(sections, where, what)
    table.update({f"tol={x:g}": with_tolerance(x) for x in (1e-4, 1e-5, 1e-7, 1e-8, 1e-9, 1e-10)})
    table.update({f"stages={n}": with_stages(n) for n in (3, 5, 7, 9)})
    return table
