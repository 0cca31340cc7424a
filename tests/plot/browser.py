#!/usr/bin/env python3
"""The page of dalcs plot in a browser without a screen: it loads nothing from a network, shows every
peak of a million rows with few points, zooms, reads values and lists its signals.

usage: browser.py DALCS
Status 77 (skipped) where Debian's chromium, chromium-driver and python3-selenium are not there, or
where dalcs was built without dygraphs.
"""

import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
N_ROWS = 1_000_000
STEP = 1e-8
HIGH, LOW = 123_456, 777_777  # rows of two peaks
TITLE = "</script><b>\"peaks\" & 'signs'"
DALCS = ""

try:
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.chrome.service import Service
except ImportError:
    # Debian's packages are for Debian's Python, which need not be the first in PATH.
    DEBIANS = "/usr/bin/python3"
    if pathlib.Path(DEBIANS).exists() and "--debian" not in sys.argv:
        os.execv(DEBIANS, [DEBIANS, *sys.argv, "--debian"])
    print("python3-selenium is not installed")
    sys.exit(SKIPPED)


def v_out(row):
    return {HIGH: 42.0, LOW: -8.0}.get(row, 12.0 + 0.1 * math.sin(2e5 * row * STEP))


def write_waveforms(path):
    """A million rows of five columns; one row each has a peak up and down."""
    names = ["time time", "v(out) voltage", "v(<in>) voltage", "i(l1) current", "i(d1) current"]
    with path.open("wb") as file:
        file.write(f"Title: {TITLE}\nPlotname: Transient Analysis\nFlags: real\n"
                   f"No. Variables: {len(names)}\nNo. Points: {N_ROWS}\nVariables:\n".encode())
        file.writelines(f"\t{k}\t{name}\n".encode() for k, name in enumerate(names))
        file.write(b"Binary:\n")
        for row in range(N_ROWS):
            sine = math.sin(6e4 * row * STEP)
            file.write(struct.pack("=5d", row * STEP, v_out(row), 10 * sine, 2 + sine,
                                   max(0.0, sine)))


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(cls.folder.name)
        write_waveforms(folder / "a.raw")
        subprocess.run([DALCS, "plot", folder / "a.raw", "-o", folder / "a.html", "-q"], check=True)
        options = webdriver.ChromeOptions()
        for argument in ["--headless=new", "--no-sandbox", "--disable-gpu",
                         "--disable-dev-shm-usage", "--window-size=1400,900"]:
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        cls.driver = webdriver.Chrome(options=options,
                                      service=Service(shutil.which("chromedriver")))
        cls.driver.get((folder / "a.html").as_uri())

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.folder.cleanup()

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def wait(self, condition):
        for _ in range(200):
            if self.script("return " + condition):
                return
            time.sleep(0.05)
        self.fail(f"did not come true: {condition}")

    def setUp(self):
        self.wait("document.body.dataset.ready === 'yes'")
        self.script("view.cursor.a = view.cursor.b = null; showAll();")
        self.wait("view.from === start && view.to === stop && !waiting")
        self.box = self.driver.find_elements(By.CLASS_NAME, "panel")[0]

    def act(self):
        return ActionChains(self.driver)

    def offset(self, part):
        """Pixels from the middle of the first panel to a part of its plotting area."""
        return int(self.script("const a = panels[0].graph.getArea();"
                               "return a.x + arguments[0] * a.w - panels[0].box.clientWidth / 2;",
                               part))

    def drag(self, first, last, *keys):
        actions = self.act()
        for key in keys:
            actions.key_down(key)
        actions.move_to_element_with_offset(self.box, self.offset(first), 0).click_and_hold()
        actions.move_to_element_with_offset(self.box, self.offset((first + last) / 2), 0)
        actions.move_to_element_with_offset(self.box, self.offset(last), 0).release()
        for key in keys:
            actions.key_up(key)
        actions.perform()

    def drawn(self):
        """The values of the first signal that the first graph was given."""
        return self.script("return panels[0].graph.rawData_.map((row) => row[1]);")

    def test_loads_nothing_else(self):
        self.driver.refresh()
        self.wait("document.body.dataset.ready === 'yes'")
        requests = [entry["message"] for entry in self.driver.get_log("performance")
                    if "Network.requestWillBeSent\"" in entry["message"]]
        self.assertTrue(requests)
        for request in requests:
            self.assertRegex(request, r'"url":"(file|data):')
        self.assertEqual([entry for entry in self.driver.get_log("browser")
                          if entry["level"] == "SEVERE"], [])

    def test_names_are_text(self):
        self.assertEqual(self.driver.title, TITLE)
        labels = [label.text.strip() for label in
                  self.driver.find_elements(By.CSS_SELECTOR, "#signals label")]
        self.assertEqual(labels, ["v(out)", "v(<in>)", "i(l1)", "i(d1)"])

    def test_every_peak_of_few_points(self):
        values = self.drawn()
        self.assertLess(len(values), 8000)
        self.assertGreater(len(values), 1000)
        self.assertEqual(max(values), 42.0)
        self.assertEqual(min(values), -8.0)

    def test_zoom_by_dragging_and_back(self):
        self.drag(0.1, 0.15)
        self.wait("view.to - view.from < 0.1 * (stop - start)")
        low, high = self.script("return [view.from, view.to];")
        self.assertAlmostEqual(low, 0.1 * N_ROWS * STEP, delta=2e-5)
        self.assertAlmostEqual(high, 0.15 * N_ROWS * STEP, delta=2e-5)
        self.assertEqual(max(self.drawn()), 42.0)
        self.assertLess(max(self.script("return panels[0].graph.rawData_.map((row) => row[0]);")),
                        high + 1e-6)
        text = self.driver.find_element(By.ID, "range").text
        self.assertRegex(text, r"^(99\d|1)[\d.]* (m|µ)s to 1\.[45]\d* ms$")
        # Both graphs have one range, and so have the bars.
        self.assertEqual(self.script("return panels[0].graph.xAxisRange();"),
                         self.script("return panels[1].graph.xAxisRange();"))
        self.act().move_to_element_with_offset(self.box, self.offset(0.5), 0).double_click().perform()
        self.wait("view.from === start && view.to === stop")

    def test_zoom_by_wheel_shows_rows(self):
        for _ in range(60):
            self.script("panels[0].box.dispatchEvent(new WheelEvent('wheel', {deltaY: -1,"
                        "clientX: panels[0].box.getBoundingClientRect().left + 400,"
                        "cancelable: true}));")
        self.wait("!waiting && view.to - view.from < 1e-4 * (stop - start)")
        # So near that every row is a point.
        rows = self.script("return panels[0].graph.rawData_.map((row) => row[0]);")
        for before, after in zip(rows, rows[1:]):
            self.assertAlmostEqual(after - before, STEP, delta=1e-3 * STEP)

    def test_moving(self):
        self.drag(0.4, 0.5)
        self.wait("view.to - view.from < 0.2 * (stop - start)")
        before = self.script("return [view.from, view.to];")
        self.drag(0.5, 0.3, Keys.SHIFT)
        self.wait(f"view.from > {before[0] + 1e-4}")
        after = self.script("return [view.from, view.to];")
        self.assertAlmostEqual(after[1] - after[0], before[1] - before[0], delta=1e-8)

    def test_cursors(self):
        for part, key in [(0.25, None), (0.75, Keys.SHIFT)]:
            actions = self.act()
            if key:
                actions.key_down(key)
            actions.move_to_element_with_offset(self.box, self.offset(part), 0).click()
            if key:
                actions.key_up(key)
            actions.perform()
        self.wait("view.cursor.a !== null && view.cursor.b !== null")
        a, b = self.script("return [view.cursor.a, view.cursor.b];")
        self.assertAlmostEqual(a, 0.25 * N_ROWS * STEP, delta=2e-5)
        self.assertAlmostEqual(b, 0.75 * N_ROWS * STEP, delta=2e-5)
        cells = [[cell.text for cell in row.find_elements(By.CSS_SELECTOR, "td, th")]
                 for row in self.driver.find_elements(By.CSS_SELECTOR, "#cursors tr")]
        self.assertEqual([row[0] for row in cells], ["time", "v(out)", "v(<in>)", "i(l1)", "i(d1)"])
        self.assertEqual(cells[0][4:], ["mean", "rms", "min", "max"])
        for text, at in [(cells[3][1], a), (cells[3][2], b)]:
            self.assertAlmostEqual(float(text.split()[0]) * (1e-3 if "m" in text else 1.0),
                                   2 + math.sin(6e4 * at), delta=1e-3)
        mean = (2 * (b - a) - (math.cos(6e4 * b) - math.cos(6e4 * a)) / 6e4) / (b - a)
        self.assertAlmostEqual(float(cells[3][4].split()[0]), mean, delta=1e-3)
        sine = (math.cos(6e4 * a) - math.cos(6e4 * b)) / 6e4 / (b - a)
        half = 0.5 - (math.sin(12e4 * b) - math.sin(12e4 * a)) / 24e4 / (b - a)
        for text, wanted in zip(cells[3][5:], (math.sqrt(4 + 4 * sine + half), 1, 3)):
            self.assertAlmostEqual(float(text.split()[0]), wanted, delta=1e-3)

    def test_list_of_signals(self):
        boxes = self.driver.find_elements(By.CSS_SELECTOR, "#signals input")
        boxes[0].click()
        self.assertLess(max(self.drawn()), 10.1)  # v(<in>) alone
        boxes[1].click()
        self.assertFalse(self.box.is_displayed())
        self.assertTrue(self.driver.find_elements(By.CLASS_NAME, "panel")[1].is_displayed())
        boxes[1].click()
        boxes[0].click()
        self.assertTrue(self.box.is_displayed())
        self.assertEqual(max(self.drawn()), 42.0)

    def test_what_is_hidden_is_wider(self):
        """Where two signals lie on each other the first is wider; one alone has its plain width."""
        widths = "return widthsOf(arguments[0], 2);"
        same = [[self.script("return start;"), 1, 1], [self.script("return stop;"), 2, 2]]
        self.assertGreater(self.script(widths, same)[0], self.script(widths, same)[1])
        apart = [[row[0], row[1], -row[2]] for row in same]
        self.assertEqual(*self.script(widths, apart))

    def test_nothing_on_the_edge(self):
        """The least value of i(d1), 0, is above the lower end of its axis."""
        self.assertLess(self.script("return panels[1].graph.yAxisRange()[0];"), 0)

    def test_narrow(self):
        self.driver.set_window_size(500, 900)
        try:
            self.wait("panels[0].box.clientWidth < 500 && "
                      "panels[0].graph.getArea().w > panels[0].box.clientWidth - 120")
            self.assertLessEqual(*self.script("return [document.documentElement.scrollWidth,"
                                              "document.documentElement.clientWidth];"))
            self.assertGreater(self.script("return panels[0].box.clientWidth;"), 420)
        finally:
            self.driver.set_window_size(1400, 900)

    def test_runs_of_a_sweep(self):
        """A slider shows one run after the other, with its label, its values and when its diode conducts."""
        self.assertTrue(self.script("return document.getElementById('runs').hidden;"))
        folder = pathlib.Path(self.folder.name)
        (folder / "s.cir").write_text("t\n.options dialect=ltspice\n.param load=1k\nV1 in 0 SIN(0 10 50)\nD1 in out\n"
                                      "C1 out 0 47u\nR1 out 0 {load}\n.tran 0.1m 60m uic\n.step param load list 200 1k 5k\n")
        for step in ["run", "s.cir", "-o", "s.raw", "-q"], ["plot", "s.raw", "-s", "v(out),i(d1)", "-o", "s.html"]:
            done = subprocess.run([DALCS, *step], cwd=folder, check=True, capture_output=True, text=True)
            self.assertEqual(done.stderr, "")
        old = self.driver.current_url
        try:
            self.driver.get((folder / "s.html").as_uri())
            self.wait("document.body.dataset.ready === 'yes'")
            self.assertFalse(self.script("return document.getElementById('runs').hidden;"))
            seen = []
            for run in 0, 2, 1, 0:
                self.script("const s = document.getElementById('run'); s.value = arguments[0];"
                            "s.dispatchEvent(new Event('input'));", run)
                seen.append(self.script("const v = run.signals.find((s) => s.name === 'v(out)').value;"
                                        "return [document.getElementById('label').textContent, v[v.length - 1],"
                                        "conducted(run.bars[0], stop) / stop];"))
            self.assertEqual([row[0] for row in seen], ["load = 200", "load = 5000", "load = 1000", "load = 200"])
            self.assertEqual(seen[0], seen[3])
            self.assertTrue(seen[0][1] < seen[2][1] < seen[1][1] < 10.0, seen)
            self.assertTrue(0.9 > seen[0][2] > seen[2][2] > seen[1][2] > 0.05, seen)
        finally:
            self.driver.get(old)

    def test_values_without_a_place(self):
        """An infinite value is a gap in a panel with a scale; labels of what has no prefix stay on one line."""
        folder = pathlib.Path(self.folder.name)
        (folder / "g.csv").write_text("time,v(a),i(b),x\n0,1,1e18,1e9\n1,inf,2e18,2e40\n2,3,-1e18,3\n3,-inf,nan,-1e9\n4,5,0,1e-9\n")
        subprocess.run([DALCS, "plot", "g.csv", "-o", "g.html", "-q"], cwd=folder, check=True, capture_output=True)
        old = self.driver.current_url
        try:
            self.driver.get((folder / "g.html").as_uri())
            self.wait("document.body.dataset.ready === 'yes'")
            self.assertEqual(self.script("return panels.map((p) => p.graph.yAxisRange().every(Number.isFinite));"), [True] * 3)
            self.assertEqual(self.script("return run.signals[0].value.length;"), 5)
            self.assertLess(self.script("return panels[0].graph.yAxisRange()[1];"), 6.0)
            heights = self.script("return [...document.querySelectorAll('.dygraph-axis-label-y')].map((e) => e.offsetHeight);")
            self.assertGreater(len(heights), 5)
            self.assertEqual(len(set(heights)), 1, heights)
            self.assertEqual(self.script("return [quantity(-1e18, 'A'), quantity(2e40, ''), quantity(2.5e-12, 'V'), quantity(1500, ''),"
                                         "quantity(-123, 'dB'), quantity(1e-21, 'V')];"),
                             ["-1e+18 A", "2e+40", "2.5 pV", "1500", "-123 dB", "1e-21 V"])
        finally:
            self.driver.get(old)

    def test_bars_and_themes(self):
        self.assertEqual(self.script("return run.bars.map((bar) => bar.name);"), ["d1"])
        # The current conducts half of the time: half of the bar is dark.
        half = ("const c = document.getElementById('bars'), a = panels[0].graph.getArea();"
                "const p = c.getContext('2d').getImageData(a.x, c.height / 2, a.w, 1).data;"
                "let sum = 0; for (let i = 3; i < p.length; i += 4) sum += p[i] / 255;"
                "return sum / a.w;")
        self.assertAlmostEqual(self.script(half), 0.5, delta=0.03)
        back = "return getComputedStyle(document.body).backgroundColor;"
        self.assertEqual(self.script(back), "rgb(255, 255, 255)")
        self.driver.find_element(By.ID, "theme").click()
        self.assertEqual(self.script(back), "rgb(22, 24, 28)")
        self.driver.find_element(By.ID, "theme").click()


def main():
    for program in ["chromium", "chromedriver"]:
        if not shutil.which(program):
            print(f"{program} is not installed")
            return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        table, page = pathlib.Path(folder, "a.csv"), pathlib.Path(folder, "a.html")
        table.write_text("time,v(a)\n0,0\n1,1\n")
        done = subprocess.run([DALCS, "plot", table, "-o", page, "-q"], capture_output=True,
                              text=True, check=False)
        if "without the library dygraphs" in done.stderr:
            print(done.stderr)
            return SKIPPED
    unittest.main(argv=sys.argv[:1])
    return 0


if __name__ == "__main__":
    DALCS = str(pathlib.Path(sys.argv[1]).resolve())
    sys.exit(main())
