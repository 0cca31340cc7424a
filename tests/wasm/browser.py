#!/usr/bin/env python3
"""Each lesson in a browser without a screen: what its panel shows is what the program computes.

usage: browser.py chromium|firefox DALCS ENGINE SITE
ENGINE is what tools/wasm/build made; SITE is tools/site. Status 77 (skipped) where ENGINE or Debian's packages are not
there: chromium, chromium-driver and python3-selenium, or firefox-esr. DALCS_LESSONS names lessons, else all are
looked at.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tests" / "support"))
sys.path.insert(1, str(TOP / "tools" / "wasm"))
BROWSER = sys.argv[1]
DALCS, ENGINE, SITE = (pathlib.Path(name).resolve() for name in sys.argv[2:5])
LARGEST_PAGE = 2_500_000  # bytes, with the engine
WAVEFORM, EVENT = 1e-9, 1e-9  # over the largest value; over the stop time

try:
    if BROWSER == "chromium":
        from selenium import webdriver
        from selenium.webdriver.chrome.service import Service
    import numpy
except ImportError:
    # Debian's packages are for Debian's Python, which need not be the first in PATH.
    DEBIANS = "/usr/bin/python3"
    if pathlib.Path(DEBIANS).exists() and "--debian" not in sys.argv:
        os.execv(DEBIANS, [DEBIANS, *sys.argv, "--debian"])
    print("python3-selenium or python3-numpy is not installed")
    sys.exit(SKIPPED)
import age  # noqa: E402  pylint: disable=wrong-import-position,import-error
import dalcs_program  # noqa: E402  pylint: disable=wrong-import-position,import-error
import marionette  # noqa: E402  pylint: disable=wrong-import-position,import-error
import play  # noqa: E402  pylint: disable=wrong-import-position,import-error

LESSONS = os.environ.get("DALCS_LESSONS", "").split() or sorted(
    path.stem for path in (TOP / "doc/lessons/src").glob("[0-9]*.txt"))


def chromium():
    options = webdriver.ChromeOptions()
    for argument in ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                     "--window-size=1500,900"]:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.site = pathlib.Path(cls.folder.name) / "site"
        subprocess.run([SITE, "--engine", ENGINE, cls.site], check=True, stdout=subprocess.DEVNULL)
        cls.driver = chromium() if BROWSER == "chromium" else marionette.Firefox()
        cls.millis = []

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        cls.folder.cleanup()
        if cls.millis:
            print(f"answers to sliders: median {numpy.median(cls.millis):.0f} ms, longest {max(cls.millis):.0f} ms")

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def wait(self, condition, *arguments):
        for _ in range(1200):
            if self.script("return " + condition, *arguments):
                return
            time.sleep(0.05)
        self.fail(f"did not come true: {condition}")

    def open(self, name):
        self.driver.get((self.site / "doc/lessons" / f"{name}.html").as_uri())
        self.wait("document.body.dataset.ready === 'yes'")

    def move(self, slider, place):
        """Moves a slider to a place from 0 to 1000, and gives the picture."""
        self.script("const r = document.querySelectorAll('#sliders input')[arguments[0]]; r.value = arguments[1];"
                    "r.dispatchEvent(new Event('input'));", slider, place)
        self.wait("document.body.dataset.ready === 'yes'")
        self.millis.append(self.script("return play.millis;"))
        return self.picture()

    def picture(self):
        return self.script("return document.getElementById('waveforms').innerHTML;")

    def type(self, netlist):
        self.script("const n = document.getElementById('netlist');"
                    "n.value = arguments[0]; n.dispatchEvent(new Event('input'));", netlist)
        self.wait("document.body.dataset.ready === 'yes'")

    def simulate(self, netlist, method="", step=0.0):
        """A run beside those of the page; its result is `found`."""
        self.script("window.found = null;"
                    "window.other = window.other || new Engine(({result}) => { window.found = result; }, alert);"
                    "other.ask({kind: 'run', netlist: arguments[0], method: arguments[1], step: arguments[2]});",
                    netlist, method, step)
        self.wait("found !== null")

    def compare(self, name):
        """The engine's result against the program's, of the netlist that the page has.

        Without rows that are added where curves bend: rounding decides whether there is one more."""
        netlist, status, shown = self.script(
            "return [withAllSignals(withCard(document.getElementById('netlist').value, '.options fill=none')),"
            "play.result.status, document.getElementById('messages').textContent];")
        self.simulate(netlist)
        run = dalcs_program.run(DALCS, netlist, method=None)
        self.assertEqual(status != 0, run.status != 0, f"{name}: {shown}{run.stderr}\n{netlist}")
        if status != 0:
            return
        at, signals, events = self.script(
            "return [[...found.time], Object.entries(found.signals).map(([n, v]) => [n, [...v]]),"
            "found.report.events];")
        self.assertEqual(sorted(signal for signal, _ in signals), sorted(run.names[1:]), name)
        stop = run.time[-1]
        here, there = numpy.array(at), numpy.array(run.time)
        for event in run.report["events"]:  # a row of the grid may coincide with one
            here, there = (numpy.where(abs(times - event["time"]) < EVENT * stop, numpy.nan, times)
                           for times in (here, there))
        self.assertEqual(numpy.isfinite(here).sum(), numpy.isfinite(there).sum(), f"{name}: number of rows")
        self.assertGreater(numpy.isfinite(here).sum(), 9, name)
        for signal, values in signals:
            wanted = numpy.array(run.column(signal))
            scale = max(numpy.abs(wanted).max(), 1e-12)
            found, wanted = numpy.array(values)[numpy.isfinite(here)], wanted[numpy.isfinite(there)]
            self.assertLessEqual(numpy.abs(found - wanted).max(), WAVEFORM * scale, f"{name}: {signal}")
        here, there = here[numpy.isfinite(here)], there[numpy.isfinite(there)]
        self.assertLessEqual(numpy.abs(here - there).max(), EVENT * stop, name)
        # those of one instant are in no order
        events, wanted = (sorted(list_of, key=lambda event: event["element"]) for list_of in (events, run.report["events"]))
        self.assertEqual([(event["element"], event["state"]) for event in events],
                         [(event["element"], event["state"]) for event in wanted], name)
        for event, same in zip(events, wanted):
            if abs(event["time"] - same["time"]) > EVENT * stop:  # a diode without a current may be on either side
                current = numpy.abs(run.column(f"i({same['element']})"))
                low, high = sorted((event["time"], same["time"]))
                between = [i for t, i in zip(run.time, current) if low + EVENT * stop < t < high - EVENT * stop]
                self.assertTrue(between and max(between) <= WAVEFORM * max(current), f"{name}: {event} and {same}")

    def test_results_are_those_of_the_program(self):
        for name in LESSONS:
            self.open(name)
            self.compare(name)
            count = self.script("return document.querySelectorAll('#sliders input').length;")
            self.assertIn(count, (2, 3, 4), name)
            for slider in range(count):
                before = self.picture()
                self.assertTrue(self.move(slider, 900) != before, f"{name}: slider {slider} moves nothing")
                self.compare(f"{name}, slider {slider}")

    def test_theory_is_that_of_the_program(self):
        for name in LESSONS:
            self.open(name)
            self.wait("document.body.dataset.theory === 'yes'")
            netlist = pathlib.Path(self.folder.name) / "netlist"
            netlist.write_text(self.script("return document.getElementById('netlist').value;"), encoding="utf-8")
            for command, place in (["equations"], "equations"), (["check"], "check"):
                done = subprocess.run([DALCS, *command, netlist], capture_output=True, text=True, check=True,
                                      env={**os.environ, "COLUMNS": "1000"})
                shown = self.script(f"return document.getElementById('{place}').textContent;")
                if place == "check":
                    summary = re.search(r"\n\n((?:  .*\n)+?)\n", done.stdout)[1]
                    self.assertIn(" ".join(summary.split()), " ".join(shown.split()), name)
                else:
                    self.assertEqual(shown.strip(), done.stdout.strip(), name)

    @unittest.skipUnless(BROWSER == "chromium", "its log names what a page loads")
    def test_pages_are_small_and_load_nothing_else(self):
        files = sum((self.site / "doc/lessons" / name).stat().st_size for name in ("dalcs-engine.js", *play.SCRIPTS))
        for name in LESSONS:
            pictures = sum(path.stat().st_size for path in (self.site / "doc/lessons/pictures").glob(f"{name}*"))
            size = files + pictures + (self.site / "doc/lessons" / f"{name}.html").stat().st_size
            self.assertLess(size, LARGEST_PAGE, name)
        self.driver.get_log("performance"), self.driver.get_log("browser")
        self.open(LESSONS[0])
        requests = [entry["message"] for entry in self.driver.get_log("performance")
                    if "Network.requestWillBeSent\"" in entry["message"]]
        self.assertTrue(requests)
        for request in requests:
            self.assertRegex(request, r'"url":"(file|data):')
        self.assertEqual([entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"], [])

    def test_modes_and_planes(self):
        """The rectifier conducts for the time that the closed form says, and stays on the corner of its rule."""
        if "02-ideal-diode" not in LESSONS:
            self.skipTest("not asked for")
        self.open("02-ideal-diode")
        rows = self.script("return [...document.querySelectorAll('#modes tr')].map((r) => "
                           "[...r.children].map((c) => c.textContent));")
        on = dict((row[0], row) for row in rows)["d1"]
        # from 0 to 5.50239 ms, then four times from 21.46634 ms to 25.50239 ms, of 100 ms
        self.assertEqual(on[1:], ["5", f"{5.50239 + 4 * (25.50239 - 21.46634):.1f} %"])
        self.assertEqual(self.script("return document.querySelectorAll('#planes svg').length;"), 1)
        off = self.script("const r = play.result, w = column(r, 'v(out,in)'), i = r.signals['i(d1)'];"
                          "return Math.max(...w.map((x, k) => Math.min(Math.abs(x), 100 * Math.abs(i[k]))));")
        self.assertLess(off, 1e-9)

    def test_a_relay_that_never_switches(self):
        """It has no events, so the panel does not know on which side it is, and does not say `none`."""
        if "10-relay" not in LESSONS:
            self.skipTest("not asked for")
        self.open("10-relay")
        self.move(0, 1000)
        self.assertEqual(self.script("return [...document.querySelectorAll('#modes td')].map((c) => c.textContent);"),
                         ["nothing changes sides", "1", "100.0 %"])

    def test_what_happened(self):
        """A jump and a steady state in words, with the numbers of closed forms."""
        for name, words in (("19-sweeping-process", "At 15 ms: l1 jumps from 1 A to 2 A, flux of d1 1 mWb; 500 µJ are lost."),
                            ("17-subharmonics", "Its factors: -1.66667.")):
            if name in LESSONS:
                self.open(name)
                self.wait("document.body.dataset.theory === 'yes'")
                self.assertIn(words, self.script("return document.getElementById('happenings').textContent;"))

    def test_an_answer_costs_one_run(self):
        """Many movements between two pictures of the screen are one run, with the last value and without .pss."""
        name = "17-subharmonics" if "17-subharmonics" in LESSONS else LESSONS[0]
        self.open(name)
        self.wait("document.body.dataset.theory === 'yes'")
        before = self.script("return play.runs;")
        runs, card = self.script(
            "const r = document.querySelector('#sliders input');"
            "for (const place of [100, 300, 500, 700]) { r.value = place; r.dispatchEvent(new Event('input')); }"
            "return [play.runs, document.getElementById('netlist').value];")
        self.assertEqual(runs, before)
        self.wait("document.body.dataset.ready === 'yes'")
        self.assertEqual(self.script("return play.runs;"), before + 1)
        self.assertFalse(self.script("return !!play.result.report.steady;"))
        self.wait("document.body.dataset.theory === 'yes'")
        self.assertEqual(self.script("return play.runs;"), before + 1)
        self.assertEqual(self.script("return document.getElementById('netlist').value;"), card)

    def test_the_newest_question_wins(self):
        """A run of many seconds ends when the netlist is changed again, and the page moves while it lasts."""
        self.open(LESSONS[0])
        first, good = self.script("return [document.getElementById('waveforms').innerHTML, document.getElementById('netlist').value];")
        slow = re.sub(r"(?im)^\.tran.*$", ".tran 1m 1000 uic", re.sub(r"(?im)^V1.*$", "V1 in 0 SIN(0 1 1Meg)", good))
        self.assertNotEqual(slow, good)
        self.script("const n = document.getElementById('netlist'); n.value = arguments[0]; request();", slow)
        self.wait("play.engine.asked !== null && play.engine.asked.shown === arguments[0]", slow)
        for _ in range(3):
            self.script("request();")
            self.wait("play.frame === 0")
        self.assertEqual(self.script("return document.body.dataset.ready;"), "no")
        self.type(good)
        self.assertTrue(self.picture() == first)
        self.assertGreater(self.script("return play.engine.threads;"), 1)

    def test_pictures_are_small_whatever_the_rows(self):
        """Four points for each column of pixels: a hundred times the rows are no more to draw."""
        self.open(LESSONS[0])
        good = self.script("return document.getElementById('netlist').value;")
        stop = re.search(r"^\.tran \S+ (\S+)", good, re.MULTILINE | re.IGNORECASE)[1]
        number, suffix = re.fullmatch(r"([\d.]+)(\D*)", stop).groups()
        self.type(re.sub(r"(?im)^\.tran \S+", f".tran {float(number) / 1e5:g}{suffix}", good))
        self.assertGreater(self.script("return play.result.time.length;"), 90_000)
        points = self.script("return [...document.querySelectorAll('.curve')].map((c) => "
                             "c.getAttribute('d').split(/[ML]/).length - 1);")
        self.assertTrue(points)
        self.assertLess(max(points), 4 * 640)
        self.assertLess(self.script("return document.querySelectorAll('#results *').length;"), 1000)

    def test_mistakes_and_back(self):
        self.open(LESSONS[0])
        first = self.picture()
        good = self.script("return document.getElementById('netlist').value;")
        self.type(good.replace(".tran", "Rwrong 1\n.tran"))
        self.assertRegex(self.script("return document.getElementById('messages').textContent;"), r"netlist:\d+:\d+: error")
        self.assertIn("stale", self.script("return document.getElementById('results').className;"))
        self.type(good)
        self.assertNotIn("stale", self.script("return document.getElementById('results').className;"))
        self.move(0, 100)
        self.script("document.getElementById('again').click();")
        self.wait("document.body.dataset.ready === 'yes'")
        self.assertTrue(self.picture() == first)

    def test_implicit_euler_from_the_steady_state(self):
        """It begins where the run begins, and with short steps stays near to it."""
        for name in LESSONS:
            self.open(name)
            self.script("document.getElementById('steps').value = 2000; const e = document.getElementById('euler');"
                        "e.checked = true; e.dispatchEvent(new Event('change'));")
            self.wait("document.body.dataset.ready === 'yes'")
            self.assertNotIn("implicit Euler", self.script("return document.getElementById('messages').textContent;"), name)
            states = self.script("return forEuler(document.getElementById('netlist').value).states;")
            for state in states:
                start, end, other, scale = self.script(
                    "const [plus, minus] = arguments, all = (r) => [...r.time].map((t, k) => "
                    "(r.signals[plus] ? r.signals[plus][k] : 0) - (r.signals[minus] ? r.signals[minus][k] : 0));"
                    "const run = all(play.result), euler = all(play.euler);"
                    "return [Math.abs(run[0] - euler[0]), run.at(-1), euler.at(-1), Math.max(...run.map(Math.abs))];",
                    state["plus"], state["minus"])
                self.assertLess(start, 0.01 * scale, f"{name}: {state}")
                self.assertLess(abs(end - other), 0.1 * scale, f"{name}: {state}")

    def test_implicit_euler_besides(self):
        if "08-implicit-euler" not in LESSONS:
            self.skipTest("not asked for")
        self.open("08-implicit-euler")
        self.script("const s = document.getElementById('steps'); s.value = 1000; s.dispatchEvent(new Event('input'));")
        self.wait("document.body.dataset.ready === 'yes'")
        dashed = self.script("return document.querySelectorAll('.curve[stroke-dasharray]').length;")
        self.assertEqual(dashed, 3)
        self.simulate(self.script("return document.getElementById('netlist').value;"), "euler", 5e-6)
        last = self.script("return found.signals['v(1)'].at(-1);")
        run = dalcs_program.run(DALCS, TOP / "netlists/tanks/lc_bridge.cir", method="euler", options=["--step", "5u"])
        self.assertAlmostEqual(last, run.column("v(1)")[-1], delta=1e-9)

    @unittest.skipUnless(BROWSER == "chromium", "its driver sets the size of a window")
    def test_narrow(self):
        self.driver.set_window_size(500, 900)
        try:
            self.open(LESSONS[0])
            self.assertLessEqual(*self.script("return [document.documentElement.scrollWidth, window.innerWidth];"))
        finally:
            self.driver.set_window_size(1500, 900)


def main():
    if not ENGINE.is_file():
        print(f"there is no {ENGINE}: tools/wasm/build makes it")
        return SKIPPED
    for program in ["chromium", "chromedriver"] if BROWSER == "chromium" else ["firefox-esr"]:
        if not shutil.which(program):
            print(f"{program} is not installed")
            return SKIPPED
    old = age.complaint(ENGINE)
    if old:
        print(old)
        return 1
    unittest.main(argv=sys.argv[:1])
    return 0


if __name__ == "__main__":
    sys.exit(main())
