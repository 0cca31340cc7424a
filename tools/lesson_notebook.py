"""From a lesson to a notebook for Jupyter: its text, its netlist in Python, and a function for its sliders.

tools/lessons writes the notebooks beside the pages. Their outputs are what the program says of the same netlist, and
tests/python/notebooks.py runs the cells.
"""

import json
import re

SIGNAL = re.compile(r"[vi]\([^()]*\)")
MOST_EVENTS = 6


def identifier(label, taken):
    """A slider's name in Python: "start of L1" becomes start_of_l1."""
    name = re.sub(r"\W+", "_", label.lower()).strip("_")
    name = name if name[:1].isalpha() else f"value_of_{name}"
    return f"{name}_{len(taken) + 1}" if name in taken else name


def with_signals(netlist, panels):
    """The netlist that saves what is drawn."""
    names = sorted({name for panel in panels for drawn in panel for name in SIGNAL.findall(drawn)})
    netlist, count = re.subn(r"^\.save .*$", f".save {' '.join(names)}", netlist, flags=re.MULTILINE | re.IGNORECASE)
    differences = [name for name in names if "," in name]
    if count or not differences:
        return netlist
    return re.sub(r"^\.end\b", f".save all {' '.join(differences)}\n.end", netlist, flags=re.MULTILINE | re.IGNORECASE)


def drawing(panels):
    """Lines that draw each panel."""
    for number, panel in enumerate(panels):
        axes = f"axes[{number}]" if len(panels) > 1 else "axes"
        signals = [name for name in panel if SIGNAL.fullmatch(name)]
        if signals:
            yield f"    result.plot({', '.join(map(repr, signals))}, ax={axes})".replace("'", '"')
        for formula in (name for name in panel if not SIGNAL.fullmatch(name)):
            value = SIGNAL.sub(lambda name: f'result["{name[0]}"]', formula).replace("]-", "] - ").replace("]+", "] + ")
            yield f'    {axes}.plot(result.t, {value}, label="{formula}")'
            yield f"    {axes}.legend()"


def with_names(card, places):
    """The card as an f-string, with names in the places (begin, end, name) of values."""
    for begin, end, name in sorted(places, reverse=True):
        card = f"{card[:begin]}{{{name}:g}}{card[end:]}"
    return card


def function(described):
    """play(), a run with the sliders' values and its picture; and the sliders as a call of ipywidgets."""
    arguments, places = {}, {}
    for slider in described["sliders"]:
        name = identifier(slider["label"], arguments)
        arguments[name] = slider
        before, after = slider["card"].split("{}")
        card = re.search(rf"^{re.escape(before)}\S+?{re.escape(after)}$", described["netlist"], re.MULTILINE | re.IGNORECASE)[0]
        places.setdefault(card, []).append((len(before), len(card) - len(after), name))
    changes = [f'    text = text.replace("{card}", f"{with_names(card, there)}")' for card, there in places.items()]
    defaults = ", ".join(f"{name}={slider['value']:g}" for name, slider in arguments.items())
    lines = [f"def play({defaults}):",
             "    text = netlist", *changes,
             "    result = dalcs.run(text)",
             f"    figure, axes = plt.subplots({len(described['panels'])}, sharex=True)",
             *drawing(described["panels"])]
    last = "axes[-1]" if len(described["panels"]) > 1 else "axes"
    if described["from"] is not None or described["to"] is not None:
        lines.append(f"    {last}.set_xlim({described['from']}, {described['to']})")
    lines.append("    return result")
    ranges = ", ".join(f"{name}=({slider['from']:g}, {slider['to']:g}, {(slider['to'] - slider['from']) / 100:g})"
                       for name, slider in arguments.items())
    return "\n".join(lines), f"from ipywidgets import interact\ninteract(play, {ranges});"


def verdicts(report):
    return "".join(f"{part['summary']}\n" for part in report["parts"])


def happened(run_report):
    """What the cell of the run prints."""
    events = run_report["events"]
    lines = [f"{event['element']} {event['state']} at {event['time']:.4g} s" for event in events[:MOST_EVENTS]]
    return "".join(f"{line}\n" for line in [f"events: {len(events)}", *lines])


PRINT_EVENTS = f"""print("events:", len(result.events))
for time, element, on in result.events[:{MOST_EVENTS}]:
    print(f"{{element}} {{'on' if on else 'off'}} at {{time:.4g}} s")"""
PRINT_CHECK = """for part in dalcs.check(netlist)["parts"]:
    print(part["summary"])"""


class Book:
    def __init__(self):
        self.cells, self.count = [], 0

    def text(self, source):
        if source.strip():
            self.add("markdown", source.strip("\n"))

    def code(self, source, output):
        self.count += 1
        outputs = [{"name": "stdout", "output_type": "stream", "text": output.splitlines(True)}] if output else []
        self.add("code", source, execution_count=self.count, outputs=outputs)

    def add(self, kind, source, **more):
        self.cells.append({"cell_type": kind, "id": f"cell-{len(self.cells) + 1}", "metadata": {}, **more,
                           "source": source.splitlines(True)})

    def written(self):
        kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
        return json.dumps({"cells": self.cells, "metadata": {"kernelspec": kernel, "language_info": {"name": "python"}},
                           "nbformat": 4, "nbformat_minor": 5}, indent=1, ensure_ascii=False) + "\n"


def notebook(page, described, run_report, check_report):
    """page: the lesson's page; described: what its panel is told (play.py), with the netlist of with_signals; and the
    program's reports of that netlist."""
    beginning, _, rest = page.partition("\n```\n")
    rest = rest.partition("\n```\n")[2]
    lesson, _, exercises = rest.partition("\n## Exercises")
    play, sliders = function(described)
    book = Book()
    book.text(beginning)
    book.code(f'import matplotlib.pyplot as plt\nimport dalcs\n\nnetlist = """{described["netlist"]}"""', "")
    book.text("`play()` runs the netlist and draws it. Give it other values.")
    book.code(f"{play}\n\nresult = play()\n{PRINT_EVENTS}", happened(run_report))
    book.text(f"With the package `ipywidgets` each value gets a slider:\n\n```python\n{sliders}\n```")
    book.text(lesson)
    book.text("What theory says of this netlist, before it runs:")
    book.code(PRINT_CHECK, verdicts(check_report))
    book.text(f"## Exercises\n{exercises}" if exercises else "")
    return book.written()
