"""The same circuit in other units: of impedance, of time, of voltage.

With `volts`, `amperes` and `seconds` as factors every signal is that factor times the one before, at times
`seconds` as late. Ohms grow by volts/amperes, farads by amperes seconds/volts and so on: whatever a card
holds is scaled by its dimension."""

import re

from circuits import map_formula

# Of each argument: v the source's own unit, t a time, f a frequency (a damping is one), 1 a number.
ARGUMENTS = {"pulse": "vvttttt1", "sin": "vvftf11", "exp": "vvtttt", "am": "v1fft", "sffm": "vvf1f11"}
MODEL = {"ron": "r", "roff": "r", "rrev": "r", "vfwd": "v", "vrev": "v", "ilimit": "i", "revilimit": "i",
         "epsilon": "v", "revepsilon": "v", "vt": "v", "vh": "v", "it": "i", "ih": "i"}


class Scaling:
    def __init__(self, volts=1.0, amperes=1.0, seconds=1.0):
        ohms = volts / amperes
        self.factor = {"v": volts, "i": amperes, "t": seconds, "f": 1 / seconds, "r": ohms, "1": 1.0,
                       "c": seconds / ohms, "l": seconds * ohms, "g": 1 / ohms}

    def signal(self, signal):
        return self.factor[signal[0]]

    def function(self, function, unit):
        kind, numbers = function
        t, x = self.factor["t"], self.factor[unit]
        if kind == "pwl":
            points, repeat = numbers
            return kind, ([p * (x if k % 2 else t) for k, p in enumerate(points)],
                          None if repeat is None else repeat * t)
        return kind, [p * (x if u == "v" else self.factor[u]) for p, u in zip(numbers, ARGUMENTS[kind])]

    def formula(self, formula):
        def of_signal(signal):
            names = signal[1:] if signal[0] == "i" or signal[2] != "0" else signal[1:2]
            text = f"{signal[0]}({','.join(names)})"
            return text if self.factor[signal[0]] == 1 else f"({text}*{1 / self.factor[signal[0]]!r})"

        def of_rest(text):
            if self.factor["t"] == 1:
                return text
            return re.sub(r"(?<!\w)time(?!\w)", f"(time*{1 / self.factor['t']!r})", text)

        unit, text = formula
        text = map_formula(text, of_signal, of_rest)
        return unit, text if self.factor[unit] == 1 else f"({text})*{self.factor[unit]!r}"

    def element(self, e):
        f = self.factor
        unit = {"r": "r", "c": "c", "l": "l", "g": "g", "h": "r"}.get(e.kind, "1")
        if e.value is not None:
            e.value *= f[unit]
        if e.initial is not None:
            e.initial *= f["v" if e.kind == "c" else "i"]
        if e.dc is not None:
            e.dc *= f[e.kind]
        if e.function is not None:
            e.function = self.function(e.function, e.kind)
        if e.formula is not None:
            e.formula = self.formula(e.formula)

    def measure(self, words):
        """Numbers behind from, to and at are times; behind val the signal's."""
        words, unit = list(words), "1"
        for k, word in enumerate(words):
            if isinstance(word, str):
                unit = {"from=": "t", "to=": "t", "at=": "t", "td=": "t"}.get(word, "1")
                unit = "v" if word.endswith("=") and "v(" in word else unit
                unit = "i" if word.endswith("=") and "i(" in word else unit
            else:
                words[k] = word * self.factor[unit]
        return words

    def apply(self, circuit):
        circuit = circuit.copy()
        for e in circuit.elements:
            self.element(e)
        for name, (kind, values) in circuit.models.items():
            circuit.models[name] = (kind, {key: x * self.factor[MODEL[key]] for key, x in values.items()})
        circuit.initial = [(s, x * self.factor[s[0]]) for s, x in circuit.initial]
        circuit.step *= self.factor["t"]
        circuit.stop *= self.factor["t"]
        circuit.measures = [(name, self.measure(words)) for name, words in circuit.measures]
        return circuit

