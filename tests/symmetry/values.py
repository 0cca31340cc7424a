"""Numbers and expressions of netlists, for the subset that circuits.py reads."""

import math
import re


class Unsupported(Exception):
    """The netlist holds something that no transformation here handles."""


SUFFIX = {"t": 1e12, "g": 1e9, "meg": 1e6, "k": 1e3, "mil": 25.4e-6, "m": 1e-3, "u": 1e-6, "µ": 1e-6,
          "n": 1e-9, "p": 1e-12, "f": 1e-15, "a": 1e-18}
NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?"
FUNCTIONS = {name: getattr(math, name) for name in
             ("sin", "cos", "tan", "exp", "sqrt", "atan", "atan2", "log10", "floor", "ceil", "hypot")}
FUNCTIONS.update(abs=abs, min=min, max=max, int=int, ln=math.log, pi=math.pi, e=math.e,
                 pow=pow, sqr=lambda x: x * x)


def number(text):
    """A number of SPICE: 4.7k, 10Meg, 20ms."""
    match = re.fullmatch(rf"([+-]?{NUMBER})(t|g|meg|k|mil|m|u|µ|n|p|f|a)?[a-zµ]*", text)
    if not match:
        if text in ("inf", "+inf"):
            return math.inf
        raise Unsupported(f"number {text}")
    return float(match[1]) * SUFFIX[match[2] or "a"] if match[2] else float(match[1])


def plain_numbers(text):
    """An expression with its suffixes written out: 2*10k becomes 2*10000.0."""
    pattern = rf"(?<![\w.])({NUMBER}(?:meg|mil|[tgkmuµnpfa])?[a-zµ]*)"
    return re.sub(pattern, lambda m: repr(number(m[1])), text)


class Scope:
    """Parameters, each evaluated when it is used; a scope has a link to its caller."""

    def __init__(self, outer=None, texts=None):
        self.outer = outer
        self.texts = dict(texts or {})

    def __contains__(self, name):
        return name in self.texts or (self.outer is not None and name in self.outer)

    def __getitem__(self, name):
        if name in self.texts:
            found = self.texts[name]
            if isinstance(found, str):
                found = self.texts[name] = self.value(found)
            return found
        if self.outer is not None:
            return self.outer[name]
        raise KeyError(name)

    def value(self, text):
        """A number, {expression} or the bare name of a parameter."""
        text = text.strip()
        if text[:1] in "{'":
            text = text[1:-1]
        try:
            return number(text)
        except Unsupported:
            pass
        known = {name: self[name] for name in set(re.findall(r"[a-z_]\w*", text)) if name in self}
        try:
            return float(eval(plain_numbers(text).replace("^", "**"),
                              {"__builtins__": {}, **FUNCTIONS}, known))
        except (SyntaxError, NameError, TypeError, ValueError, ArithmeticError) as problem:
            raise Unsupported(f"expression {text}: {problem}") from None

    def formula(self, text):
        """A formula of voltages and currents with its parameters put in."""
        text = text.strip()
        if text[:1] in "{'" and text[-1] in "}'":
            text = text[1:-1]
        text = re.sub(r"([vi])\s*\(\s*([^()]*?)\s*\)",
                      lambda m: m[1] + "(" + re.sub(r"\s*,\s*", ",", m[2]) + ")", text)
        pieces = re.split(r"((?<!\w)[vi]\([^()]*\))", text)
        for k in range(0, len(pieces), 2):
            pieces[k] = re.sub(r"(?<![\w.])[a-z_]\w*",
                               lambda m: f"({self[m[0]]!r})" if m[0] in self else m[0],
                               plain_numbers(pieces[k]))
        return "".join(pieces).strip()
