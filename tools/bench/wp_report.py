"""The work-precision results as the generated section of doc/accuracy.md and as gnuplot's picture."""

import math
import subprocess

BEGIN, END = "<!-- work_precision begin -->", "<!-- work_precision end -->"
SHOWN = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10)  # a method has a row for each that it reaches
PRECISE, MODEST = "tol 1e-09", 5.05e-4  # of the summary; what rounds to 5e-4 is that
# A colour for each method; the numbers of stages are shades of radau's.
COLOURS = {"euler": "#7f7f7f", "radau 1": "#9ecae1", "radau 3": "#6baed6", "radau 5": "#2171b5",
           "radau 7": "#08306b", "auto": "#000000", "ngspice": "#d62728", "Siconos": "#ff7f0e"}


def family(row):
    return row["method"].split()[0]


def shown(rows):
    """Of each method the fastest row for each target, and all of ngspice and Siconos."""
    chosen = []
    for method in ("euler", "radau", "auto"):
        of_method = [row for row in rows if family(row) == method]
        for target in SHOWN:
            good = [row for row in of_method if row["error"] <= target]
            if good:
                best = min(good, key=lambda row: row["cpu_s"])
                if best not in chosen:
                    chosen.append(best)
    return chosen + [row for row in rows if family(row) in ("ngspice", "Siconos")]


def ratio(row, rows):
    """To dalcs' fastest row that is at least as accurate, in CPU time."""
    rivals = [other["cpu_s"] for other in rows
              if family(other) in ("euler", "radau", "auto") and other["error"] <= row["error"]]
    return row["cpu_s"] / min(rivals) if rivals else None


def digits(value):
    """Three digits, without an exponent."""
    if value is None:
        return ""
    places = max(0, 2 - math.floor(math.log10(value))) if value > 0 else 0
    return f"{value:.{places}f}"


def nearest(rows):
    """How far dalcs confirms the reference."""
    errors = [(row["error"], f"{row['method']}, {row['setting']}") for row in rows
              if family(row) in ("euler", "radau", "auto")]
    return f"The nearest run of dalcs ({min(errors)[1]}) differs by {min(errors)[0]:.0e}."


def table(circuit, result):
    rows = result["rows"]
    lines = [f"### {circuit.title}", "",
             f"`{circuit.name}`. Reference: {result['reference']}. {nearest(rows)}",
             ""]
    if result.get("ngspice"):
        lines += [result["ngspice"], ""]
    if result.get("siconos"):
        lines += [result["siconos"], ""]
    lines += ["| method | setting | error | CPU ms | steps | factorisations | ratio |",
              "|---|---|---|---|---|---|---|"]
    for row in shown(rows):
        setting = row["setting"] + (f" (target {row['target']:.2g})" if row["target"] else "")
        lines.append(f"| {row['method']} | {setting} | {row['error']:.1e} | "
                     f"{digits(1e3 * row['cpu_s'])} | "
                     f"{'' if row['steps'] is None else row['steps']} | "
                     f"{'' if row['factorizations'] is None else row['factorizations']} | "
                     f"{digits(ratio(row, rows))} |")
    return lines + [""]


def summary(circuits, results):
    """What ngspice needs over --tol 1e-9, where it gets to MODEST and where its error is smallest."""
    lines = [f"### ngspice over dalcs {PRECISE.replace('tol', '--tol')}", "",
             f"ngspice with its fastest setting for an error of {MODEST:.0e} or less, and with the "
             "one of its smallest error.", "",
             "| circuit | dalcs' error | its CPU ms | error of ngspice | its CPU ms | ratio "
             "| smallest error | its CPU ms | ratio |", "|---|---|---|---|---|---|---|---|---|"]
    for circuit in circuits:
        rows = results[circuit.name]["rows"]
        ours = [row for row in rows if (row["method"], row["setting"]) == ("auto", PRECISE)]
        theirs = [row for row in rows if row["method"] == "ngspice"]
        if not ours or not theirs:
            continue
        modest = [row for row in theirs if row["error"] <= MODEST]
        cells = [f"{ours[0]['error']:.1e}", digits(1e3 * ours[0]["cpu_s"])]
        for row in (min(modest, key=lambda row: row["cpu_s"], default=None),
                    min(theirs, key=lambda row: row["error"])):
            cells += [f"{row['error']:.1e}", digits(1e3 * row["cpu_s"]),
                      digits(row["cpu_s"] / ours[0]["cpu_s"])] if row else ["none", "", ""]
        lines.append(f"| {circuit.title} | {' | '.join(cells)} |")
    return lines + [""]


def process_table(process):
    lines = ["### The whole process", "",
             "Half-wave RC, from the netlist to the raw file, medians of "
             f"{process['repeats']} runs by turns.", "",
             "| program | rows written | wall ms | CPU ms |", "|---|---|---|---|"]
    lines += [f"| {run['name']} | {run['rows']} | {digits(1e3 * run['wall_s'])} | "
              f"{digits(1e3 * run['cpu_s'])} |" for run in process["runs"]]
    return lines + [""]


def write_section(document, lines):
    """Between the markers."""
    text = document.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN, 1)
    _, after = rest.split(END, 1)
    document.write_text("\n".join([before + BEGIN] + lines + [END + after]), encoding="utf-8")


def quoted(text):
    return text.replace("'", "''")


def style(method):
    """Siconos' two thetas are no curve."""
    shape = {"Siconos": "points pt 9 ps 1.1",
             "ngspice": "linespoints lw 1.6 pt 13 ps 0.9"}.get(method, "linespoints lw 1.6 pt 7 ps 0.7")
    return f"with {shape} lc '{COLOURS[method]}'"


def script(circuits, results, picture):
    """One panel for each circuit, one for the key."""
    methods = [m for m in COLOURS
               if any(row["method"] == m for circuit in circuits
                      for row in results[circuit.name]["rows"])]
    panels = len(circuits) + 1
    columns = 3
    height = math.ceil(panels / columns)
    lines = [f"set terminal pngcairo size {columns * 430},{height * 340} font 'DejaVu Sans,10'",
             f"set output '{quoted(str(picture))}'",
             f"set multiplot layout {height},{columns} margins 0.07,0.985,0.045,0.965 "
             "spacing 0.075,0.075",
             "set logscale xy", "set format x '10^{%T}'", "set format y '%g'",
             "set grid lc '#dddddd'", "set tics nomirror", "set border 3", "unset key"]
    for number, circuit in enumerate(circuits):
        rows = results[circuit.name]["rows"]
        plots = []
        for method in methods:
            points = [(row["error"], 1e3 * row["cpu_s"]) for row in rows  # coarse to fine
                      if row["method"] == method and 0 < row["error"] < 1]
            if points:
                lines.append(f"$data{len(plots)} << EOD")
                lines += [f"{error!r} {cpu!r}" for error, cpu in points] + ["EOD"]
                plots.append(f"$data{len(plots)} {style(method)}")
        lines += [f"set title '{quoted(circuit.title)}' offset 0,-0.6",
                  "set xlabel 'error' offset 0,0.6" if number >= len(circuits) - columns
                  else "unset xlabel",
                  "set ylabel 'CPU ms' offset 1.5,0" if number % columns == 0 else "unset ylabel",
                  "set autoscale", "set xrange [*:*] reverse", "plot " + ", ".join(plots)]
    lines += ["unset logscale", "unset border", "unset tics", "unset xlabel", "unset ylabel",
              "unset grid", "unset title", "set key center center samplen 3 spacing 1.4",
              "set xrange [0:1] noreverse", "set yrange [0:1]",
              "plot " + ", ".join(f"-1 {style(method)} title '{method}'" for method in methods),
              "unset multiplot"]
    return "\n".join(lines + [""])


def draw(circuits, results, picture, folder):
    path = folder / "work_precision.gp"
    path.write_text(script(circuits, results, picture), encoding="utf-8")
    subprocess.run(["gnuplot", path], check=True)
