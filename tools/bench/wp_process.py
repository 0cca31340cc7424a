"""The whole process on the half-wave rectifier: from the netlist to a raw file that was not there."""

import os
import shutil
import statistics
import subprocess
import time

import ngspice_deck
from ngspice_deck import ngspice_batch

REPEATS = 101


def once(command, folder):
    """(wall s, CPU s)"""
    begin = time.perf_counter()
    child = subprocess.Popen(command, cwd=folder, stdin=subprocess.DEVNULL,
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    wall = time.perf_counter() - begin
    if child.returncode != 0:
        raise RuntimeError(f"{command} failed")
    return wall, usage.ru_utime + usage.ru_stime


def measure(dalcs, netlist, settings, methods, folder):
    """`settings`: of ngspice, from its search. dalcs is copied first, as installing does: a program as the linker
    has written it, piece by piece, takes 0.06 ms more, for it lies in the page cache in smaller pieces."""
    installed = shutil.copy(dalcs, folder / "dalcs")
    commands = {"true, which does nothing": (["/bin/true"], None)}
    choices = {"euler": ["--method", "euler", "--step", "2u"],
               "radau": ["--method", "radau"], "auto": ["--method", "auto"]}
    for method in methods:
        commands[f"dalcs {' '.join(choices[method])}"] = (
            [installed, "run", netlist, "--quiet", "-o", "dalcs.raw", *choices[method]], "dalcs.raw")
    for number, setting in enumerate(settings):
        path = folder / f"half_wave_{number}.cir"
        text = ngspice_deck.deck(netlist.read_text(encoding="utf-8"), setting, ["v(out)"], 0)
        path.write_text(text.split(".control", 1)[0] + ".end\n")
        commands[f"ngspice -b, {setting}"] = (
            ["ngspice", "-n", "-b", "-r", "ngspice.raw", path], "ngspice.raw")
    samples = {name: [] for name in commands}
    rows = {}
    for _ in range(REPEATS + 1):
        for name, (command, raw) in commands.items():
            if raw is not None:
                (folder / raw).unlink(missing_ok=True)
            samples[name].append(once(command, folder))
            if name not in rows:
                rows[name] = ngspice_batch.read_raw(folder / raw).n_rows if raw is not None else 0
    return {"repeats": REPEATS, "runs": [
        {"name": name, "rows": rows[name],
         "wall_s": statistics.median(wall for wall, _ in times[1:]),
         "cpu_s": statistics.median(cpu for _, cpu in times[1:])}
        for name, times in samples.items()]}
