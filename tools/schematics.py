#!/usr/bin/env python3
"""Draws a circuit as SVG from a short description, and compares it with its netlist.

usage: tools/schematics.py [DESCRIPTION] NETLIST OUT.svg

Without a description its elements are placed by tools/layout.py.

A description has one part a line; a point is X,Y in units of the grid, with Y downwards:

  V1 sine 0,0 0,3 | 10 V, 50 Hz     an element of the netlist, its kind, its first and second node,
                                    and what is written beside it
  wire 0,0 2,0 2,3                  a line through these points
  node out 4,0                      the name of a node; ground 4,3 is node 0
  omit Vg                           elements of the netlist that are not drawn

Kinds: resistor capacitor inductor diode switch voltage sine pulse current controlled-voltage
controlled-current. `left`, `right`, `above` or `below` behind the points moves the words.

Each element of the netlist is drawn or omitted, and points that lines join are one node of the netlist, and
no other: else it is an error.
"""

import html
import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import layout  # noqa: E402  pylint: disable=wrong-import-position,import-error

UNIT, MARGIN, LETTER = 46, 26, 8  # pixels
INK, NAMES = "#303030", "#0072b2"
SIDES = ("left", "right", "above", "below")


class Wrong(Exception):
    """The description contradicts itself or its netlist."""


def path(*pieces):
    return f'<path d="{" ".join(pieces)}"/>'


def circle(x, y, r):
    return f'<circle cx="{x:g}" cy="{y:g}" r="{r:g}"/>'


def round_source(inside):
    return 15, [circle(0, 0, 15)] + inside


def diamond(inside):
    return 17, [path("M-17 0L0 -15L17 0L0 15Z")] + inside


POLES = [path("M-12 0h6M-9 -3v6M6 -3v6")]
ARROW = [path("M-9 0h16M2 -5L8 0L2 5")]
# Half the length along the line from the first node to the second, and what is drawn around 0,0.
SYMBOLS = {
    "resistor": (18, [path("M-18 -7h36v14h-36Z")]),
    "capacitor": (4, [path("M-4 -14v28M4 -14v28")]),
    "inductor": (20, [path("M-20 0", *["a5 5 0 0 1 10 0"] * 4)]),
    "diode": (10, ['<path d="M-10 -10L10 0L-10 10Z" fill="#ffffff"/>', path("M10 -10v20")]),
    "switch": (16, [circle(-14, 0, 2), circle(14, 0, 2), path("M-12.5 -1.5L12 -12")]),
    "voltage": round_source(POLES),
    "sine": round_source([path("M0 -9c-8 3 -8 6 0 9s8 6 0 9"), path("M-13 8M-25 -8h6M-22 -11v6")]),
    "pulse": round_source([path("M3 -8v4h-6v8h6v4"), path("M-25 -8h6M-22 -11v6")]),
    "current": round_source(ARROW),
    "controlled-voltage": diamond(POLES),
    "controlled-current": diamond(ARROW),
}


def point(word):
    match = re.fullmatch(r"(-?[\d.]+),(-?[\d.]+)", word)
    if not match:
        raise Wrong(f"'{word}' is not a point")
    return float(match[1]), float(match[2])


class Schematic:
    """The parts of a description."""

    def __init__(self, text):
        self.elements, self.wires, self.names, self.omitted = [], [], [], set()
        for line in text.split("\n"):
            words, _, value = (part.strip() for part in line.partition("|"))
            words = words.split()
            if not words or words[0].startswith("#"):
                continue
            if words[0] == "wire":
                self.wires += zip(map(point, words[1:]), map(point, words[2:]))
            elif words[0] in ("node", "ground"):
                name = words[1] if words[0] == "node" else "0"
                self.names.append((name, point(words[-1] if words[-1] not in SIDES else words[-2]),
                                   words[-1] if words[-1] in SIDES else "above"))
            elif words[0] == "omit":
                self.omitted |= {name.lower() for name in words[1:]}
            elif len(words) >= 4 and words[1] in SYMBOLS:
                side = words[4] if len(words) > 4 else None
                self.elements.append((words[0], words[1], point(words[2]), point(words[3]), side, value))
            else:
                raise Wrong(f"'{line}' is no part")

    # ---- The netlist ---------------------------------------------------------------------------

    def nets(self):
        """For each point its net, a number."""
        ends = {end for wire in self.wires for end in wire}
        ends |= {end for element in self.elements for end in element[2:4]}
        ends |= {where for _, where, _ in self.names}
        net = {end: k for k, end in enumerate(sorted(ends))}
        for a, b in self.wires:
            for c in ends:
                if on_line(a, b, c):
                    old, new = net[c], net[a]
                    net = {end: new if k == old else k for end, k in net.items()}
        return net

    def compare(self, netlist):
        """Raises Wrong unless elements and nodes are those of the netlist's cards."""
        cards = {}
        for line in netlist.split("\n")[1:]:
            words = line.split()
            if words and words[0][0].isalpha():
                cards[words[0].lower()] = words[1:3]
        net, known = self.nets(), {}
        drawn = [(name, (a, b)) for name, _, a, b, _, _ in self.elements]
        missing = set(cards) - self.omitted - {name.lower() for name, _ in drawn}
        if missing:
            raise Wrong(f"not drawn: {', '.join(sorted(missing))}")
        pairs = [(node, where, name) for name, ends in drawn
                 for node, where in zip(cards.get(name.lower()) or [None] * 2, ends)]
        for node, where, name in pairs + [(name, where, name) for name, where, _ in self.names]:
            if node is None:
                raise Wrong(f"the netlist has no {name}")
            if known.setdefault(net[where], node.lower()) != node.lower():
                raise Wrong(f"{name} at {where[0]:g},{where[1]:g} is on node "
                            f"{known[net[where]]}, in the netlist on {node}")
        grounded = {net[where] for name, where, _ in self.names if name == "0"}
        parts = [node for part, node in known.items() if node != "0" or part not in grounded]
        if len(parts) != len(set(parts)) or "0" in parts:
            raise Wrong("a node of the netlist is in two parts that no line joins")

    # ---- The picture ---------------------------------------------------------------------------

    def svg(self, title):
        lines, words, ends = [], [], {}
        for name, kind, a, b, side, value in self.elements:
            draw_element(lines, words, (name, kind, a, b, side, value))
            for end in (a, b):
                ends[end] = ends.get(end, 0) + 1
        for a, b in self.wires:
            lines.append(path(f"M{place(a)}L{place(b)}"))
            for end in (a, b):
                ends[end] = ends.get(end, 0) + 1
        for name, where, side in self.names:
            x, y = (UNIT * v for v in where)
            if name == "0":
                lines.append(path(f"M{x:g} {y:g}v10M{x - 11:g} {y + 10:g}h22M{x - 7:g} {y + 14:g}h14"
                                  f"M{x - 3:g} {y + 18:g}h6"))
                continue
            dx, dy, anchor = {"above": (0, -9, "middle"), "below": (0, 19, "middle"),
                              "left": (-9, 5, "end"), "right": (9, 5, "start")}[side]
            words.append(Label(x + dx, y + dy, anchor, plain=name,
                               style=f' fill="{NAMES}" font-style="italic"'))
            if ends.get(where, 0) < 2:
                lines.append(f'<circle cx="{x:g}" cy="{y:g}" r="2.5" fill="{INK}"/>')
        for (x, y), count in ends.items():
            inside = sum(on_line(a, b, (x, y)) and (x, y) not in (a, b) for a, b in self.wires)
            if count + 2 * inside > 2:
                lines.append(f'<circle cx="{UNIT * x:g}" cy="{UNIT * y:g}" r="3" fill="{INK}"/>')
        xs = [UNIT * x for x, _ in ends] + [x for label in words for x in label.extent()]
        ys = [UNIT * y for _, y in ends] + [label.y for label in words]
        left, top = min(xs) - MARGIN, min(ys) - MARGIN
        width, height = max(xs) + MARGIN - left, max(ys) + MARGIN - top
        return "\n".join([
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:g}" height="{height:g}" '
            f'viewBox="{left:g} {top:g} {width:g} {height:g}" font-family="DejaVu Sans, sans-serif" '
            'font-size="13">', f"<title>{html.escape(title)}</title>",
            f'<rect x="{left:g}" y="{top:g}" width="{width:g}" height="{height:g}" fill="#ffffff"/>',
            f'<g fill="none" stroke="{INK}" stroke-width="1.6" stroke-linecap="round" '
            'stroke-linejoin="round">', *lines, "</g>", f'<g fill="{INK}">', *(label.svg() for label in words), "</g>", "</svg>", ""])


def place(where):
    return f"{UNIT * where[0]:g} {UNIT * where[1]:g}"


def on_line(a, b, c):
    """Is c between a and b?"""
    cross = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    along = (c[0] - a[0]) * (c[0] - b[0]) + (c[1] - a[1]) * (c[1] - b[1])
    return abs(cross) < 1e-9 and along < 1e-9


class Label:
    """Words at a place: `bold`, a space, then `plain`."""

    def __init__(self, x, y, anchor, bold="", plain="", style=""):
        self.x, self.y, self.anchor, self.bold, self.plain, self.style = x, y, anchor, bold, plain, style

    def extent(self):
        length = LETTER * len(self.bold + self.plain)
        start = self.x - length * {"start": 0, "middle": 0.5, "end": 1}[self.anchor]
        return start, start + length

    def svg(self):
        words = f'<tspan font-weight="bold">{html.escape(self.bold)}</tspan>' if self.bold else ""
        words += "&#160;" if self.bold and self.plain else ""
        return (f'<text x="{self.x:g}" y="{self.y:g}" text-anchor="{self.anchor}"{self.style}>'
                f"{words}{html.escape(self.plain)}</text>")


def draw_element(lines, words, element):
    name, kind, a, b, side, value = element
    half, symbol = SYMBOLS[kind]
    (ax, ay), (bx, by) = ((UNIT * v for v in end) for end in (a, b))
    length = math.hypot(bx - ax, by - ay)
    if length < 2 * half:
        raise Wrong(f"{name} is too short")
    x, y, turn = (ax + bx) / 2, (ay + by) / 2, math.degrees(math.atan2(by - ay, bx - ax))
    lines.append(f'<g transform="translate({x:g} {y:g}) rotate({turn:g})">')
    lines.append(path(f"M{-length / 2:g} 0H{-half:g}M{half:g} 0H{length / 2:g}"))
    lines += symbol + ["</g>"]
    vertical = abs(by - ay) > abs(bx - ax)
    side = side or ("right" if vertical else "above")
    if side in ("left", "right"):
        sign, anchor = (-1, "end") if side == "left" else (1, "start")
        words.append(Label(x + sign * 22, y + (-1 if value else 5), anchor, bold=name))
        if value:
            words.append(Label(x + sign * 22, y + 15, anchor, plain=value))
    else:
        words.append(Label(x, y - 19 if side == "above" else y + 28, "middle", bold=name, plain=value))


def draw(description, netlist, title):
    """The picture of a description, which agrees with its netlist."""
    schematic = Schematic(description)
    schematic.compare(netlist)
    return schematic.svg(title)


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    *description, netlist, out = (pathlib.Path(name) for name in sys.argv[1:])
    try:
        deck = layout.plain(netlist.read_text(encoding="utf-8"))
        text = description[0].read_text(encoding="utf-8") if description else layout.describe(deck)[0]
        picture = draw(text, deck, deck.split("\n", maxsplit=1)[0])
    except (Wrong, layout.NoLayout) as error:
        sys.exit(f"{(description or [netlist])[0]}: {error}")
    except OSError as error:
        sys.exit(f"schematics: {error}")
    out.write_text(picture, encoding="utf-8")


if __name__ == "__main__":
    main()
