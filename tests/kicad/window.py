#!/usr/bin/env python3
"""KiCad's own simulator window over dalcs's libngspice.so.0, as a person uses it, on a virtual screen.

usage: window.py FORWARDER LIBRARY DALCS DEMOS

FORWARDER notes what KiCad calls and hands it to LIBRARY. The rectifier of KiCad's DEMOS is run and two of its signals are
drawn: their largest values are those that DALCS gives for the netlist that KiCad sent. A circuit with transistors is
refused in KiCad's window, and KiCad goes on."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker, run  # noqa: E402

# The dialogs of KiCad 6 at its first start.
SETTINGS = {"sym-lib-table": "(sym_lib_table)\n", "fp-lib-table": "(fp_lib_table)\n",
            "kicad_common.json": '{"meta": {"filename": "kicad_common.json", "version": 3}}\n',
            "eeschema.json": '{"meta": {"filename": "eeschema.json", "version": 1}}\n'}
PATIENCE = 90  # s, for a window or a call, on a busy machine


def until(condition, what):
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        found = condition()
        if found:
            return found
        time.sleep(0.3)
    raise AssertionError(f"no {what} within {PATIENCE} s")


class Screen:
    """An X server with a window manager, and keys for its windows."""

    def __init__(self, folder):
        reading, writing = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "1280x900x24"],
                                       pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            display = f":{pipe.readline().strip()}"
        # Of memory filled with what meson test draws KiCad makes no window now and then.
        environment = {name: value for name, value in os.environ.items() if not name.startswith("MALLOC_")}
        self.environment = {**environment, "DISPLAY": display, "HOME": str(folder), "GDK_BACKEND": "x11",
                            "XDG_CONFIG_HOME": str(folder / ".config"), "NO_AT_BRIDGE": "1"}
        self.manager = self.start("openbox")

    def start(self, *command, **variables):
        return subprocess.Popen(command, env={**self.environment, **variables}, stdin=subprocess.DEVNULL,
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def tell(self, *words):
        return subprocess.run(["xdotool", *words], env=self.environment, capture_output=True, text=True, check=False)

    def window(self, name):
        return until(lambda: self.tell("search", "--onlyvisible", "--name", name).stdout.split(), f"window {name}")[-1]

    def keys(self, window, *keys):
        self.tell("windowactivate", "--sync", window)
        for key in keys:
            time.sleep(0.5)
            self.tell("key", "--clearmodifiers", key)

    def close(self):
        for process in (self.manager, self.server):
            process.terminate()
            process.wait()


class KiCad:
    """The schematic editor on a copy of a demo, and what it has called so far."""

    def __init__(self, screen, arguments, folder, demo):
        forwarder, library, _, demos = arguments
        self.screen, self.log = screen, folder / f"{demo}.log"
        shutil.copytree(pathlib.Path(demos) / demo, folder / demo)
        place = folder / "library"
        place.mkdir(exist_ok=True)
        shutil.copy(forwarder, place / "libngspice.so.0")
        self.program = screen.start("eeschema", str(folder / demo / f"{demo}.kicad_sch"), FORWARD_LOG=str(self.log),
                                    FORWARD_TO=library, LD_LIBRARY_PATH=str(place))
        self.simulator = until(self.open_simulator, "simulator")

    def open_simulator(self):
        """The last entry of the menu Inspect; the editor takes no keys before it has drawn its page."""
        self.screen.keys(self.screen.window("Schematic Editor"), "Escape", "alt+i", "Up", "Return")
        time.sleep(5)
        found = self.screen.tell("search", "--onlyvisible", "--name", "Spice Simulator").stdout.split()
        return found[-1] if found else None

    def called(self, what):
        text = self.log.read_text(encoding="utf-8", errors="replace") if self.log.exists() else ""
        lines = [line.split(" ", 2) for line in text.splitlines()]
        return [(float(line[1]), line[2] if len(line) > 2 else "") for line in lines if line[0] == what]

    def run(self):
        self.screen.keys(self.simulator, "ctrl+r")
        return until(lambda: [status for status, _ in self.called("circuit")][1:], "circuit from KiCad")[-1]

    def netlist(self):
        """The lines of the last circuit."""
        lines = self.called("line")
        first = max(k for k, (number, _) in enumerate(lines) if number == 0)
        return "\n".join(text for _, text in lines[first:]) + "\n"

    def draw(self, place):
        """The signal that has this place in KiCad's list of them: its name and largest value."""
        before = len(self.called("vector"))
        self.screen.keys(self.simulator, "ctrl+a")
        time.sleep(3)
        for key in ["Home"] + ["Down"] * place + ["Return"]:
            self.screen.tell("key", key)
        time.sleep(1)
        self.screen.tell("key", "Escape")
        most, name = until(lambda: [v for v in self.called("vector")[before:] if v[1] != "time"], "signal")[-1]
        return name, most

    def close(self):
        self.program.kill()
        self.program.wait()


def rectifier(checker, screen, arguments, folder):
    kicad = KiCad(screen, arguments, folder, "rectifier")
    try:
        checker.check(kicad.run() == 0, "the rectifier is refused")
        until(lambda: [c for _, c in kicad.called("command") if c == "bg_run"], "run in the background")
        found = dict(kicad.draw(place) for place in (5, 6))
        checker.check(len(found) == 2, f"one signal is drawn twice: {found}")
        measured = [name if "(" in name else f"i({name[1:].partition('[')[0]})" for name in found]  # @r1[i]
        text = kicad.netlist().replace("\n.end", "".join(f"\n.meas tran m{k} max {m}" for k, m in enumerate(measured))
                                       + "\n.end")
        wanted = run(arguments[2], text, method=None).report["measurements"]
        for (signal, value), m in zip(found.items(), wanted):
            # KiCad draws rows; between two of 1 us a sine of 1 kHz is higher by (pi 1e-3)^2 / 2 at most.
            checker.close(value, m["value"], 5e-6 * abs(m["value"]), f"the largest {signal}")
    finally:
        kicad.close()


def transistors(checker, screen, arguments, folder):
    kicad = KiCad(screen, arguments, folder, "laser_driver")
    try:
        checker.check(kicad.run() != 0, "a circuit with transistors is taken")
        time.sleep(3)
        checker.check(kicad.program.poll() is None, "KiCad has ended")
        checker.check(screen.window("Spice Simulator"), "KiCad's window is gone")
    finally:
        kicad.close()


def main():
    checker = Checker("kicad")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        settings = folder / ".config" / "kicad" / "6.0"
        settings.mkdir(parents=True)
        for name, text in SETTINGS.items():
            (settings / name).write_text(text, encoding="utf-8")
        screen = Screen(folder)
        try:
            rectifier(checker, screen, sys.argv[1:], folder)
            transistors(checker, screen, sys.argv[1:], folder)
        finally:
            screen.close()
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
