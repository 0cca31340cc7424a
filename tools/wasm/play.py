"""The panel of a lesson that runs in the browser, from the marks of its source (tools/lessons).

The netlist is that of @circuit with the cards of @play, else of the first @plot. @slider gives what can be moved.
"""

import json
import pathlib
import re
import shlex
import sys

TOP = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
SUFFIXES = {"meg": 1e6, "k": 1e3, "": 1.0, "m": 1e-3, "u": 1e-6, "n": 1e-9, "p": 1e-12}
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
STYLE = """
body.playing{flex-wrap:nowrap}.playing main{flex:1 1 36em;max-width:44em;padding:1em 1.5em 4em}
#play{flex:1 1 46em;max-width:56em;height:100vh;overflow:auto;position:sticky;top:0;box-sizing:border-box;padding:1em;
  border-left:1px solid #ddd;background:#fcfcfa;font-size:14px}
#play h2{margin:.9em 0 .3em;font-size:1em}#play svg{display:block;width:100%;height:auto;font:12px sans-serif}
#planes{display:flex;flex-wrap:wrap}#play svg.plane{width:190px}#results.stale,body[data-theory=no] :is(#equations,#check){opacity:.35}
body[data-ready=no] #results{opacity:.35;transition:opacity 0s .4s}
#sliders label{display:grid;grid-template-columns:11em 1fr 6em;gap:.8em;align-items:center}
#netlist{width:100%;box-sizing:border-box;font:13px/1.35 monospace}
#messages{white-space:pre-wrap;background:none;color:#a33;max-height:11em;padding:0}#messages.notes{color:#555}#messages:empty{display:none}
#play .grid{stroke:#e4e4e0}#play .zero{stroke:#999}#play .curve{fill:none;stroke-width:1.6;clip-path:url(#inside)}
#play .bar{fill:#404040}#play .rule{fill:none;stroke:#e69f00;stroke-width:7;stroke-opacity:.35}
#play .dot{stroke:#0072b2;stroke-width:3;stroke-linecap:round}#play td.yes{color:#060}#play td.no{color:#a00}
@media(max-width:80em){body.playing nav{display:none}}
@media(max-width:60em){#play{position:static;height:auto;max-width:none;border:0}}
"""
FORM = """<aside id="play"><h2>Play</h2><div id="sliders"></div>
<p><label><input type="checkbox" id="euler"> implicit Euler too, dashed</label>
<input type="range" id="steps" min="10" max="2000" value="100"> <span id="stepsize"></span></p>
<textarea id="netlist" rows="10" spellcheck="false" aria-label="netlist"></textarea>
<p><button id="again">as it was</button> <span id="millis"></span></p><pre id="messages"></pre><div id="results">
<div id="waveforms"></div><div id="happenings"></div><section><h2>Each diode in the plane of its rule: reverse voltage w,
current λ</h2><div id="planes"></div></section><h2>Modes</h2><table id="modes"></table><h2>Equations</h2><pre id="equations"></pre>
<h2>What <code>dalcs check</code> says</h2><div id="check"></div></div></aside>"""

SCRIPTS = ("threads.js", "draw.js", "play.js")  # beside the engine, in this order


class Wrong(Exception):
    """A mark contradicts its netlist."""


def number(text):
    match = re.fullmatch(rf"({NUMBER})(meg|[kmunp]?)", text.strip(), re.IGNORECASE)
    if not match:
        raise Wrong(f"'{text}' is not a number")
    return float(match[1]) * SUFFIXES[match[2].lower()]


def slider(mark, netlist):
    """LABEL | FROM TO [log] [UNIT] | CARD, in which {} is the value: what the page is told of it."""
    try:
        label, bounds, card = (part.strip() for part in mark.split(" | "))
        low, high, *more = bounds.split()
        before, after = card.split("{}")
    except ValueError as error:
        raise Wrong(f"'@slider {mark}' is not LABEL | FROM TO [log] [UNIT] | CARD with one {{}}") from error
    found = re.search(rf"^{re.escape(before)}({NUMBER}(?:meg|[kmunp])?){re.escape(after)}$", netlist,
                      re.MULTILINE | re.IGNORECASE)
    if not found:
        raise Wrong(f"the netlist has no card like '{card}'")
    unit = [word for word in more if word != "log"]
    made = {"label": label, "from": number(low), "to": number(high), "log": "log" in more, "card": card,
            "unit": "Ω" if unit == ["ohm"] else "".join(unit), "value": number(found[1])}
    if not made["from"] <= made["value"] <= made["to"] or made["log"] and made["from"] <= 0:
        raise Wrong(f"@slider {label}: the value {found[1]} of the netlist is not between {low} and {high}")
    return made


def what_is_drawn(source):
    """(panels, from, to, cards) of @play, else of the first @plot."""
    marks = {name: re.search(rf"^@{name} (.*)$", source, re.MULTILINE) for name in ("play", "plot")}
    mark = marks["play"] or marks["plot"]
    if not mark:
        return None
    options, *cards = mark[1].split(" | ")
    words = shlex.split(options)
    option = dict(zip(words, words[1:]))
    panels = [re.findall(r"(?:[^,(]|\([^)]*\))+", after) for word, after in zip(words, words[1:]) if word == "-s"]
    return (panels, *(number(option[name]) if name in option else None for name in ("--from", "--to")),
            cards[0 if marks["play"] else 1:])


def describe(source, changed):
    """What the page of a source is told; None where it draws nothing. changed(cards) is its netlist with cards."""
    drawn = what_is_drawn(source)
    if drawn is None:
        return None
    panels, start, stop, cards = drawn
    netlist = "\n".join(line for line in changed(cards).split("\n") if line and not line.startswith("*"))
    return {"netlist": netlist + "\n", "panels": panels, "from": start, "to": stop,
            "sliders": [slider(mark, netlist) for mark in re.findall(r"^@slider (.*)$", source, re.MULTILINE)]}


def panel(description):
    """The panel as HTML, with what it is told and the scripts, which lie beside the page."""
    told = json.dumps(description).replace("<", "\\u003c")
    scripts = "".join(f'<script src="{name}"></script>' for name in ("dalcs-engine.js", *SCRIPTS))
    return f'{FORM}<script type="application/json" id="lesson">{told}</script>{scripts}'


if __name__ == "__main__":
    sys.exit(__doc__)
