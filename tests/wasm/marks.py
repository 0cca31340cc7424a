#!/usr/bin/env python3
"""The marks of a lesson's source that make its panel: what they mean, and what is said of wrong ones.

usage: marks.py
"""

import pathlib
import sys
import unittest

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "tools" / "wasm"))
import play  # noqa: E402  pylint: disable=wrong-import-position,import-error

NETLIST = "A title\nV1 in 0 SIN(0 10 50)\nR1 in 0 4.7Meg\nC1 in 0 1U ic=-2\n.end"
PLOT = "@plot 02-name -s 'v(a,b),i(l1)-i(d1)' -s 'i(d1)' --to 25m --no-bars | What it shows. | R1 a 0 2k | .tran 1u 1m\n"


class Marks(unittest.TestCase):
    def refused(self, mark, message):
        with self.assertRaisesRegex(play.Wrong, message):
            play.slider(mark, NETLIST)

    def test_slider(self):
        made = play.slider("R1 | 1k 10Meg log ohm | R1 in 0 {}", NETLIST)
        self.assertEqual(made, {"label": "R1", "from": 1e3, "to": 1e7, "log": True, "card": "R1 in 0 {}", "unit": "Ω",
                                "value": 4.7e6})
        self.assertEqual(play.slider("f | 20 200 Hz | V1 in 0 SIN(0 10 {})", NETLIST)["value"], 50.0)
        self.assertEqual(play.slider("start | -5 5 | c1 in 0 1u ic={}", NETLIST)["unit"], "")

    def test_wrong_sliders(self):
        self.refused("R1 | 1k 10Meg", "is not LABEL")
        self.refused("R1 | 1k | R1 in 0 {}", "is not LABEL")
        self.refused("R1 | 1k 10Meg | R1 in 0 4.7Meg", "is not LABEL")
        self.refused("R1 | 1k tenMeg | R1 in 0 {}", "'tenMeg' is not a number")
        self.refused("R1 | 1k 10Meg | R1 out 0 {}", "the netlist has no card like 'R1 out 0 {}'")
        self.refused("R1 | 1k 10k | R1 in 0 {}", "R1: the value 4.7Meg of the netlist is not between 1k and 10k")
        self.refused("C1 | -5 5 log | C1 in 0 1U ic={}", "is not between")

    def test_what_is_drawn(self):
        panels = [["v(a,b)", "i(l1)-i(d1)"], ["i(d1)"]]
        cards = ["R1 a 0 2k", ".tran 1u 1m"]
        self.assertEqual(play.what_is_drawn(PLOT), (panels, None, 25e-3, cards))
        self.assertEqual(play.what_is_drawn(PLOT + "@plot other -s 'v(x)' | Another.\n"), (panels, None, 25e-3, cards))
        self.assertEqual(play.what_is_drawn(PLOT + "@play -s 'v(x)' --from 1u | .op\n"), ([["v(x)"]], 1e-6, None, [".op"]))
        self.assertIsNone(play.what_is_drawn("# A lesson without a picture\n"))

    def test_described(self):
        told = play.describe(PLOT + "@slider R1 | 1k 10Meg log ohm | R1 in 0 {}\n", lambda cards: NETLIST + "\n* a comment\n")
        self.assertEqual(told["netlist"], NETLIST + "\n")
        self.assertEqual(len(told["sliders"]), 1)
        self.assertNotIn("<script>", play.panel({**told, "netlist": "</script><script>"}).split('id="lesson"')[1].split("</script>")[0])


if __name__ == "__main__":
    unittest.main()
