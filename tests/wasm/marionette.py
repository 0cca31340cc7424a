"""Firefox without a screen, driven over its Marionette protocol: Debian has no geckodriver.

A message is LENGTH:JSON. A command is [0, number, name, parameters], its answer [1, number, error, value].
"""

import json
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time

PREFERENCES = {
    "marionette.port": 0,  # any that is free; MarionetteActivePort in the profile says which
    "browser.shell.checkDefaultBrowser": False, "browser.startup.page": 0,
    "datareporting.policy.dataSubmissionEnabled": False, "toolkit.telemetry.enabled": False,
    "app.update.enabled": False, "app.normandy.enabled": False, "extensions.getAddons.cache.enabled": False,
    "network.captive-portal-service.enabled": False, "network.connectivity-service.enabled": False,
}


def program():
    """Debian's Firefox; None where there is none."""
    return shutil.which("firefox-esr")


class Firefox:
    """What the tests need of a selenium.webdriver: get(), execute_script(), quit()."""

    def __init__(self, patience=120):
        self.folder = tempfile.TemporaryDirectory()
        profile = pathlib.Path(self.folder.name)
        (profile / "user.js").write_text("".join(
            f"user_pref({json.dumps(name)}, {json.dumps(value)});\n" for name, value in PREFERENCES.items()),
            encoding="ascii")
        self.process = subprocess.Popen(
            [program(), "--headless", "--marionette", "--no-remote", "--profile", profile],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={"HOME": str(profile), "PATH": "/usr/bin:/bin"})
        self.socket, self.number = None, 0
        try:
            self.socket = socket.create_connection(("127.0.0.1", self._port(profile, patience)), timeout=patience)
            self.stream = self.socket.makefile("rb")
            self._read()  # the greeting
            self._call("WebDriver:NewSession", {})
            self._call("WebDriver:SetTimeouts", {"script": 1000 * patience, "pageLoad": 1000 * patience})
        except BaseException:
            self.quit()
            raise

    def _port(self, profile, patience):
        for _ in range(20 * patience):
            if (profile / "MarionetteActivePort").is_file():
                text = (profile / "MarionetteActivePort").read_text(encoding="ascii").strip()
                if text:
                    return int(text)
            if self.process.poll() is not None:
                raise RuntimeError(f"Firefox ended with status {self.process.returncode}")
            time.sleep(0.05)
        raise TimeoutError("Firefox names no port")

    def _read(self):
        digits = b""
        while (byte := self.stream.read(1)) != b":":
            if not byte:
                raise ConnectionError("Firefox hung up")
            digits += byte
        return json.loads(self.stream.read(int(digits)))

    def _call(self, name, parameters):
        self.number += 1
        text = json.dumps([0, self.number, name, parameters]).encode()
        self.socket.sendall(f"{len(text)}:".encode() + text)
        _, number, error, value = self._read()
        if error or number != self.number:
            raise RuntimeError(f"{name}: {error}")
        return value

    def get(self, address):
        self._call("WebDriver:Navigate", {"url": address})

    def execute_script(self, text, *arguments):
        """In the page's own scope: that of Marionette does not see its constants."""
        code = f"JSON.stringify((function () {{{text}}})(...{json.dumps(arguments)}))"
        answer = self._call("WebDriver:ExecuteScript", {
            "script": "return window.eval(arguments[0]);", "args": [code]})["value"]
        return None if answer is None else json.loads(answer)

    def quit(self):
        if self.socket is not None:
            self.socket.close()
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self.folder.cleanup()
