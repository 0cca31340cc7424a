"""Circuits too long to be written by hand: text of any size."""


def cockcroft_walton(stages):
    """50 kHz; the compared nodes are the first ones, for the last stay near 0 at first."""
    lines = [f"Cockcroft-Walton multiplier with {stages} stages, 50 kHz, 20 periods from rest",
             "v1 ac 0 sin(0 100 50k)"]
    a, b = "ac", "0"
    for k in range(1, stages + 1):
        lines += [f"ca{k} {a} a{k} 1u", f"da{k} {b} a{k}", f"cb{k} {b} b{k} 1u",
                  f"db{k} a{k} b{k}"]
        a, b = f"a{k}", f"b{k}"
    return lines + [f"rl {b} 0 10meg", ".tran 100n 400u uic",
                    ".save v(a1) v(b1) v(b2) v(b5) v(b10)", ".end"]


def peak_detectors(nodes):
    """A wave runs down an RC line; each node charges a capacitor through a diode."""
    lines = [f"RC line with {nodes} peak detectors, 1 kHz, 2 periods from rest",
             "v1 n0 0 sin(0 10 1k)"]
    for k in range(1, nodes + 1):
        lines += [f"r{k} n{k - 1} n{k} 1", f"c{k} n{k} 0 10n", f"d{k} n{k} p{k}",
                  f"cp{k} p{k} 0 10n", f"rp{k} p{k} 0 1meg"]
    return lines + [".tran 1u 2m uic",
                    ".save v(n1) v(p1) v(n10) v(p10) v(n30) v(p30) v(n100) v(p100)", ".end"]


GENERATED = {
    "cockcroft_walton_100": lambda: cockcroft_walton(100),
    "cockcroft_walton_1000": lambda: cockcroft_walton(1000),
    "peak_detectors_1000": lambda: peak_detectors(1000),
}


def text(name):
    return "\n".join(GENERATED[name]() + [""])
