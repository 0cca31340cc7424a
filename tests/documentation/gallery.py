#!/usr/bin/env python3
"""The gallery: a schematic of each netlist that agrees with it, a card for each circuit, and their place in the site.

usage: gallery.py SOURCE_FOLDER BUILD_FOLDER
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = (pathlib.Path(name).resolve() for name in sys.argv[1:3])
sys.path += [str(SOURCE / "tools")]
import layout  # noqa: E402  pylint: disable=wrong-import-position,import-error
import schematics  # noqa: E402  pylint: disable=wrong-import-position,import-error


def run(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False)


class Schematics(unittest.TestCase):
    def test_every_netlist(self):
        """schematics.draw() compares elements, their ends and nodes."""
        for path in sorted((SOURCE / "netlists").rglob("*.cir")):
            deck = layout.plain(path.read_text(encoding="utf-8"))
            self.assertIn("</svg>", schematics.draw(layout.describe(deck)[0], deck, "title"), path)

    def test_places(self):
        """Neighbours on the line, what is at ground below, what goes past others in a lane above."""
        deck = "Buck\nV1 in 0 12\nVg g 0 PULSE(0 1 0 0 0 4u 10u)\nS1 in sw g 0 sm\nD1 0 sw\nL1 sw out 50u\n" \
               "C1 out 0 20u\nR1 in out 2k\n.tran 1u 1m\n"
        deck = layout.plain(deck)
        text, omitted = layout.describe(deck)
        where = {words[0]: [tuple(map(float, word.split(","))) for word in words[2:4]]
                 for words in map(str.split, text.split("\n")) if len(words) > 3 and words[0] != "wire"}
        self.assertEqual(omitted, ["Vg"])
        for name in "S1", "L1":
            self.assertEqual([y for _, y in where[name]], [0.0, 0.0], name)
            self.assertLess(where[name][0][0], where[name][1][0], name)
        for name in "V1", "C1":
            self.assertEqual([y for _, y in where[name]], [0.0, layout.DEPTH], name)
        self.assertEqual([y for _, y in where["D1"]], [layout.DEPTH, 0.0])
        self.assertTrue(all(y < 0.0 for _, y in where["R1"]))
        self.assertIn("| 2 kΩ", text)
        wrong = text.replace("D1 diode", "D2 diode")
        with self.assertRaises(schematics.Wrong):
            schematics.draw(wrong, deck, "title")

    def test_transistors(self):
        """By the nodes of their currents; sources that only drive gates are left out; gnd is ground."""
        deck = "Half bridge\nV1 p gnd 400\nM1 p gh sw fet\nM2 sw gl\n+ 0 fet\nVh gh sw PULSE(0 12 0 1n 1n 5u 10u)\n" \
               "Vl gl GND PULSE(12 0 0 1n 1n 5u 10u)\nL1 sw o 100u\nR1 o 0 10\n.subckt no a b\nR1 a b 1\n.ends\n" \
               ".control\nrun\n.endc\n.end\n"
        deck = layout.plain(deck)
        text, omitted = layout.describe(deck)
        self.assertEqual(omitted, ["Vh", "Vl"])
        self.assertIn("</svg>", schematics.draw(text, deck, "title"))
        self.assertRegex(text, "M1 switch .*\n")
        with self.assertRaises(layout.NoLayout):
            layout.describe("title\nX1 a b two\nR1 a b 1\n")

    def test_subcircuits(self):
        """Their elements, with the names and nodes that they have outside, also of one in another."""
        deck = "Two\n.subckt leg p out params: r=1\nS1 p out g 0 sm\nXd out p body\n.ends\n.SUBCKT body a k\nD1 a k\n.ENDS\n" \
               "V1 in 0 12\nX1 in o leg r=2\nX2 in o leg PARAMS: r=3\nR1 o 0 1\n"
        deck = layout.plain(deck)
        self.assertEqual([line.split()[:3] for line in deck.split("\n")[2:6]],
                         [["X1.S1", "in", "o"], ["X1.Xd.D1", "o", "in"], ["X2.S1", "in", "o"], ["X2.Xd.D1", "o", "in"]])
        self.assertIn("</svg>", schematics.draw(layout.describe(deck)[0], deck, "title"))

    def test_no_wire_crosses_a_name(self):
        """A name stands where wires up to the lanes leave room for it; 'out' has one beside its middle."""
        deck = layout.plain("Bridge\nVsource ac1 w 17\nRw w ac2 0.5\nD1 ac1 out d\nD2 ac2 out d\nD3 0 ac1 d\nD4 0 ac2 d\n"
                            "C1 out 0 1m\nR1 out 0 50\n")
        text, _ = layout.describe(deck)
        lines = [line.split() for line in text.split("\n")]
        corners = [[tuple(map(float, point.split(","))) for point in words[1:]] for words in lines if words[:1] == ["wire"]]
        risers = {a[0] for wire in corners for a, b in zip(wire, wire[1:]) if a[0] == b[0] and min(a[1], b[1]) < 0.0}
        self.assertTrue(risers)
        for words in lines:
            if words and words[0] == "node":
                at, half = float(words[2].split(",")[0]), layout.LETTER * len(words[1]) / 2
                self.assertTrue(all(abs(at - x) >= half for x in risers), f"{words} {risers}")

    def test_lanes_do_not_touch(self):
        """Two that pass over each other are in two lanes: the comparison would see one node."""
        deck = "Ring\n" + "".join(f"R{i}{j} {i} {j} 1k\n" for i in range(1, 8) for j in range(i + 1, 8)) + "C1 1 0 1u\n"
        self.assertIn("</svg>", schematics.draw(layout.describe(deck)[0], deck, "title"))


class Page(unittest.TestCase):
    def test_list(self):
        done = run(SOURCE / "tools/gallery", "--build", BUILD, "--check")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_cards_and_site(self):
        with tempfile.TemporaryDirectory() as place:
            place = pathlib.Path(place)
            done = run(SOURCE / "tools/gallery", "--build", BUILD, "--only", "hc11", place / "gallery")
            self.assertEqual(done.returncode, 0, done.stderr)
            index = (place / "gallery/index.html").read_text(encoding="utf-8")
            self.assertEqual(len(re.findall("<article", index)), 3)
            self.assertEqual(len(re.findall("Refused: .*no solution", index)), 3)
            for only, what in ("hc01a", "jump at t=0: c1 10 V -&gt; 4 V"), ("hc07", r"v\(a\) +0\.000  V"):
                done = run(SOURCE / "tools/gallery", "--build", BUILD, "--only", only, place / "values")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertRegex((place / "values/index.html").read_text(encoding="utf-8"), what)
            done = run(SOURCE / "tools/gallery", "--build", BUILD, "--only", "full_bridge_r.cir", place / "gallery")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertTrue((place / "gallery/rectifiers_full_bridge_r.png").read_bytes().startswith(b"\x89PNG"))
            self.assertIn("</svg>", (place / "gallery/rectifiers_full_bridge_r.svg").read_text(encoding="utf-8"))
            site = [SOURCE / "tools/site", "--gallery", place / "gallery", place / "site"]
            done = run(*site)
            if "mkdocs is not installed" in done.stderr:
                self.skipTest("mkdocs is not installed")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn('href="../gallery/index.html"', (place / "site/doc/gallery.html").read_text(encoding="utf-8"))
            self.assertRegex((place / "site/index.html").read_text(encoding="utf-8"),
                             r'<a href="(doc/pictures/full_bridge\.png)"><img [^>]*src="\1"')
            self.assertIn("[ON|OFF]", (place / "site/doc/netlist.html").read_text(encoding="utf-8"))
            (place / "gallery/rectifiers_full_bridge_r.svg").unlink()
            self.assertIn("leads nowhere", run(*site).stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
