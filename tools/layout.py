"""Places the elements of a netlist for a schematic: tools/schematics.py draws it.

Nodes lie on a line, in the order in which the fewest elements pass over others; elements between neighbours lie on
this line, others in lanes above it, and those at ground hang below it. A transistor is the switch that it is, a
subcircuit its elements, x1.d1; what has more ends is not drawn.
"""

import itertools
import re

SLOT, LANE, DEPTH, REACH = 1.5, 1.4, 2.6, 1.2  # units of the grid
LETTER = 0.17  # width of one
KINDS = {"r": ("resistor", "Ω"), "c": ("capacitor", "F"), "l": ("inductor", "H"), "d": ("diode", ""),
         "s": ("switch", ""), "w": ("switch", ""), "v": ("voltage", "V"), "i": ("current", "A"),
         "e": ("controlled-voltage", ""), "h": ("controlled-voltage", ""), "g": ("controlled-current", ""),
         "f": ("controlled-current", ""), "b": ("controlled-current", ""),
         "m": ("switch", ""), "z": ("switch", ""), "q": ("switch", "")}
GROUND = ("0", "gnd")
PERMUTED = 7  # nodes of which all orders are tried
PREFIXES = {"meg": "M", "k": "k", "": "", "m": "m", "u": "µ", "µ": "µ", "n": "n", "p": "p"}


class NoLayout(Exception):
    """The netlist has what this cannot place."""


class Part:
    """An element: its name, kind, nodes and what is written beside it."""

    def __init__(self, words):
        self.name, self.letter, self.words = words[0], letter_of(words[0]), words
        self.kind, unit = KINDS[self.letter]
        self.ends = tuple(word.lower() for word in words[1:3])
        rest = " ".join(words[3:])
        shape = re.match(r"(sin|pulse|pwl|exp|am|sffm)\b", rest, re.IGNORECASE)
        self.value = ""
        if self.letter == "b":
            self.kind = "controlled-voltage" if re.match(r"v *=", rest, re.IGNORECASE) else self.kind
            formula = rest.partition("=")[2].strip()
            self.value = formula if len(formula) <= 18 else formula[:17] + "…"
        elif shape and self.letter == "v":
            self.kind = "sine" if shape[1].lower() == "sin" else "pulse"
        if shape and shape[1].lower() == "sin":
            numbers = re.findall(r"[^\s(),]+", rest)[2:4]
            self.value = ", ".join(filter(None, map(quantity, numbers, (unit, "Hz"))))
        elif self.letter in "rclvi" and not shape and len(words) > 3:
            self.value = quantity(words[4] if words[3].lower() == "dc" and len(words) > 4 else words[3], unit)

    def width(self):
        return SLOT + LETTER * max(len(self.name), len(self.value))

    def line(self, a, b, side=""):
        (ax, ay), (bx, by) = a, b
        value = f" | {self.value}" if self.value else ""
        return f"{self.name} {self.kind} {ax:g},{ay:g} {bx:g},{by:g} {side}{value}"


def quantity(word, unit):
    """50u as 50 µH; nothing for what is no number."""
    match = re.match(r"([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)(meg|[kmunpµ]?)", word, re.IGNORECASE)
    if not match:
        return ""
    number = match[1] if len(match[1]) <= 7 else f"{float(match[1]):.6g}"
    return f"{number} {PREFIXES[match[2].lower()]}{unit}".replace("-", "−")


def letter_of(name):
    """The family of an element, d of x1.d1."""
    return name.rsplit(".", maxsplit=1)[-1][0].lower()


def definitions(lines):
    """(The lines outside of subcircuits; for each name of one its ports and its lines.)"""
    outside, found, inside = [], {}, None
    for line in lines:
        words = line.split()
        if re.match(r"\.subckt\b", line, re.IGNORECASE) and len(words) > 1:
            ports = [word for word in itertools.takewhile(lambda word: "=" not in word and word.lower() != "params:", words[2:])]
            inside = found[words[1].lower()] = ([port.lower() for port in ports], [])
        elif re.match(r"\.ends\b", line, re.IGNORECASE):
            inside = None
        elif inside:
            inside[1].append(line)
        else:
            outside.append(line)
    return outside, found


def expanded(words, found):
    """The elements of a subcircuit that a card calls, with the names and nodes that they have outside."""
    called = [k for k, word in enumerate(words) if word.lower() in found and k > 0]
    if not called or len(words[1:called[-1]]) != len(found[words[called[-1]].lower()][0]):
        return [words]
    ports, lines = found[words[called[-1]].lower()]
    outer, cards = dict(zip(ports, words[1:called[-1]])), []
    for inner in (line.split(";")[0].split() for line in lines):
        if inner and inner[0][0].isalpha():
            n_nodes = {"x": len(inner) - 2, "s": 4, "e": 4, "g": 4, "m": 4, "q": 3, "z": 3}.get(letter_of(inner[0]), 2)
            inner[1:1 + n_nodes] = [node if node.lower() in GROUND else outer.get(node.lower(), f"{words[0]}.{node}")
                                    for node in inner[1:1 + n_nodes]]
            inner[0] = f"{words[0]}.{inner[0]}"
            cards += expanded(inner, found) if letter_of(inner[0]) == "x" else [inner]
    return cards


def plain(netlist):
    """The title and the elements, each on one line, transistors by the two nodes that their current flows between."""
    text = re.sub(r"\n\+", " ", netlist)
    text = re.sub(r"^\.control\b.*?^\.endc\b.*?$", "", text, flags=re.IGNORECASE | re.MULTILINE | re.DOTALL)
    title, *lines = text.split("\n")
    lines, found = definitions(lines)
    cards = []
    for card in (line.split(";")[0].split() for line in lines):
        for words in expanded(card, found) if card and card[0][0].lower() == "x" else [card]:
            if words and words[0][0].isalpha():
                if letter_of(words[0]) in "mzq" and len(words) > 4:
                    words[2:4] = words[3], words[2]
                words[1:3] = ["0" if word.lower() in GROUND else word for word in words[1:3]]
                cards.append(" ".join(words))
    return "\n".join([title, *cards, ""])


def parts_of(deck):
    """(elements to draw, names that are not drawn) of what plain() gives."""
    parts, omitted, controls = [], [], set()
    for words in map(str.split, deck.split("\n")[1:-1]):
        letter = letter_of(words[0])
        if letter in KINDS and len(words) > 3 or letter in "ds" and len(words) > 2:
            parts.append(Part(words))
        elif letter in "ka":
            omitted.append(words[0])
        else:
            raise NoLayout(f"{words[0]} is not drawn: it has inner elements, or more than two ends")
        controls |= {word.lower() for word in words[3:4 + (letter == "s")]} if letter in "smzq" else set()
    for part in list(parts):  # what does nothing but drive a gate
        gates = [node for node in part.ends if node in controls and sum(node in p.ends for p in parts) == 1]
        if part.letter in "vbe" and gates:
            parts.remove(part)
            omitted.append(part.name)
    if not parts or any(part.ends[0] == part.ends[1] for part in parts):
        raise NoLayout("nothing to draw, or an element with both ends at one node")
    return parts, omitted


def order_of(nodes, edges, first):
    """The order of nodes in which edges pass over the fewest others; `first` come early, where nothing else matters."""
    def cost(order):
        at = {node: k for k, node in enumerate(order)}
        return sum((abs(at[a] - at[b]) - 1) ** 1.5 for a, b in edges) + 1e-3 * sum(at[node] for node in first)

    if len(nodes) <= PERMUTED:
        return list(min(itertools.permutations(nodes), key=cost))
    order, best = list(nodes), cost(nodes)
    improved = True
    while improved:
        improved = False
        for i, j in itertools.permutations(range(len(order)), 2):
            tried = order[:]
            tried.insert(j, tried.pop(i))
            now = cost(tried)
            if now < best - 1e-9:
                order, best, improved = tried, now, True
    return order


class Layout:
    """Where everything is; lines() is a description for tools/schematics.py."""

    def __init__(self, parts):
        nodes = list(dict.fromkeys(node for part in parts for node in part.ends))
        degree = {node: sum(node in part.ends for part in parts) for node in nodes}
        self.bottom = "0" if "0" in nodes else max(nodes, key=degree.get)
        self.hanging = [part for part in parts if self.bottom in part.ends]
        self.across = [part for part in parts if self.bottom not in part.ends]
        sources = [part.ends[0] for part in parts if part.letter in "vi" and part.ends[0] != self.bottom]
        self.order = order_of([node for node in nodes if node != self.bottom],
                              [part.ends for part in self.across], sources)
        self.text, self.left, self.right, self.slots, self.names = [], {}, {}, [], []
        self.place_nodes()
        self.place_names(self.place_lanes())

    def top_of(self, part):
        return part.ends[0] if part.ends[1] == self.bottom else part.ends[1]

    def sides_of(self, node, k):
        """Does anything come to a node, the k-th, from before and from behind?"""
        places = [self.order.index(end) for part in self.across if node in part.ends
                  for end in part.ends if end != node]
        return any(place < k for place in places), any(place > k for place in places)

    def place_nodes(self):
        """Along the line, with what hangs on each."""
        self.on_line, x = set(), 0.0
        for k, node in enumerate(self.order):
            below = [part for part in self.hanging if self.top_of(part) == node]
            before, behind = self.sides_of(node, k)
            self.left[node], at = x, x + (0.5 if before or not below else 0.0)
            for part in below:
                top, low = (at, 0.0), (at, DEPTH)
                self.text.append(part.line(*((top, low) if part.ends[0] == node else (low, top))))
                self.slots.append(at)
                self.right[node] = at + (0.5 if behind else 0.0)
                at += part.width()
            self.right.setdefault(node, x + 1.0)
            middle = (x + (self.right[node] if not below else self.slots[-len(below)])) / 2
            self.names.append((node, middle))
            after = self.order[k + 1] if k + 1 < len(self.order) else None
            between = [part for part in self.across if set(part.ends) == {node, after}]
            joined = after is not None and self.sides_of(after, k + 1)[0]
            x = max(self.right[node] + (between[0].width() if between else 0.6), at - 0.5 * joined)
            if between:
                self.on_line.add(between[0])
                self.text.append(between[0].line(*self.directed(between[0], node, (self.right[node], 0.0), (x, 0.0))))
        if self.slots:
            self.text.append(f"wire {min(self.slots):g},{DEPTH:g} {max(self.slots):g},{DEPTH:g}")
            self.text.append(f"ground {min(self.slots):g},{DEPTH:g}" if self.bottom == "0" else
                             f"node {self.bottom} {min(self.slots):g},{DEPTH:g} below")

    @staticmethod
    def directed(part, node, a, b):
        return (a, b) if part.ends[0] == node else (b, a)

    def place_lanes(self):
        """What is left, each in the lowest lane that is free. Returns where wires go up to the lanes."""
        lanes, spans = [], []
        for part in self.across:
            if part not in self.on_line:
                begin, end = sorted(part.ends, key=self.order.index)
                spans.append((self.right[begin], self.left[end], begin, part))
        risers = sorted({x for span in spans for x in span[:2]})
        for a, b, begin, part in sorted(spans, key=lambda span: span[1] - span[0]):
            lane = next((k for k, taken in enumerate(lanes) if all(b <= c or d <= a for c, d in taken)), len(lanes))
            lanes[lane:lane] = [[]] if lane == len(lanes) else []
            lanes[lane].append((a, b))
            y = -LANE * (lane + 1) - 0.2
            inside = [a] + [x for x in risers if a < x < b] + [b]
            c, d = max(zip(inside, inside[1:]), key=lambda gap: gap[1] - gap[0])
            middle, half = (c + d) / 2, min(0.6, (d - c) / 2 - 0.05)  # its ends touch no wire up to a lane
            self.text += [f"wire {a:g},0 {a:g},{y:g} {middle - half:g},{y:g}",
                          f"wire {middle + half:g},{y:g} {b:g},{y:g} {b:g},0",
                          part.line(*self.directed(part, begin, (middle - half, y), (middle + half, y)))]
        return risers

    def place_names(self, risers):
        """Above the line of each node, where no wire up to a lane crosses the name; else below it."""
        for node, middle in self.names:
            begin, end = self.left[node], self.right[node]
            half = LETTER * (len(node) + 1) / 2
            places = sorted([middle, begin, end, *(x + side * half for x in risers for side in (-1, 1))],
                            key=lambda x, middle=middle: abs(x - middle))
            free = [x for x in places if begin <= x <= end and all(abs(x - riser) >= half - 1e-9 for riser in risers)]
            at = free[0] if free else middle
            side = "" if free or any(abs(at - slot) < half for slot in self.slots) else " below"
            self.text += [f"wire {begin:g},0 {at:g},0 {end:g},0", f"node {node} {at:g},0{side}"]

    def lines(self):
        return self.text


def describe(deck):
    """(A description of the schematic of what plain() gives, the names of elements that it leaves out.)"""
    parts, omitted = parts_of(deck)
    lines = Layout(parts).lines()
    return "\n".join(lines + ["omit " + " ".join(omitted)] * bool(omitted)) + "\n", omitted
