#!/usr/bin/env python3
"""Files that .lib and .include name, and that are not where they were on the machine of the netlist's author.

usage: libraries.py PROGRAM LIBRARIES
"""

import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from dalcs_program import Checker  # noqa: E402

BODY = "V1 a 0 10\nX1 a b part\nR1 b 0 1k\n.save v(b)\n.op\n.end\n"
PART = ".subckt part p q\nR1 p q 1k\n.ends\n"
HERE = BODY.replace("X1 a b part", "R2 a b 1k")

# What the card names, and where the file lies; the netlist is sub/main.cir, and the program runs in the top folder.
FOUND = [
    (".lib parts.lib", "sub/parts.lib"),
    (".include parts.lib", "sub/parts.lib"),
    (".lib C:\\Users\\me\\Documents\\parts.lib", "sub/parts.lib"),
    (".lib C:\\Program Files (x86)\\LTC\\my parts.lib", "sub/my parts.lib"),
    (".include 'C:\\Program Files\\parts.txt'", "sub/parts.txt"),
    (".lib lib\\parts.sub", "sub/lib/parts.sub"),
    (".lib ..\\parts.sub", "parts.sub"),
    (".include lib/parts.mod", "lib/parts.mod"),
    (".lib /home/someone/spice/parts.mod", "sub/parts.mod"),
    (".lib \"D:\\parts\\parts.lib\"", "sub/parts.lib"),
    (".inc my parts.lib", "sub/my parts.lib"),
    (".inc my parts.txt", "sub/my parts.txt"),
    (".include C:\\Users\\me\\Octavo semestre\\parts.txt", "sub/parts.txt"),
    (".lib lib/parts.lib", "sub/lib/parts.lib"),
]

# Left out with a warning: the netlist needs nothing of it.
LEFT_OUT = [
    ".lib LTC.lib",
    ".lib ADI1.lib",
    ".lib \"nom.lib\"",
    ".lib C:\\PROGRA~1\\QSPICE\\Diode.txt",
    ".lib C:\\Users\\John Smith\\Documents\\LTspiceXVII\\lib\\cmp\\standard.dio",
    ".include 1N4007.lib",
    ".include \"C:\\KiCad\\models\\1N4148.mod\"",
    ".lib /usr/share/spice/models.sub",
    ".INC parts.MOD",
    ".lib models",
    ".include 'my own.lib'",
]

REFUSED = [
    (".include parts.inc", HERE, "cannot read"),
    (".include parts.cir", HERE, "cannot read"),
    (".lib parts.lib typical", HERE, "cannot read"),
    (".lib parts.lib", BODY, "it may be in 'parts.lib', which was not found"),
    (".include C:\\a b\\parts.lib", BODY, "it may be in 'C:\\a b\\parts.lib'"),
    (".lib parts.lib", "V1 a 0 1\nD1 a b special\nR1 b 0 1\n.op\n.end\n", "it may be in 'parts.lib'"),
    (".lib parts.lib", "V1 a 0 1\nS1 a b a 0 special\nR1 b 0 1\n.op\n.end\n",
     "it may be in 'parts.lib'"),
]

# The names of UniversalOpamp2 before and after LTspice 24: a follower.
OPAMP = "V1 p 0 5\nV2 n 0 -5\nV3 a 0 2\nX1 a b p n b {} Avol=1Meg\nR1 b 0 1k\n.save v(b)\n.op\n.end\n"
OPAMPS = [("UniversalOpamps2.sub", ("level.1", "level.2", "level.3a", "level.3b")),
          ("UniversalOpAmp2.lib", ("level1", "level2", "level3a", "level3b", "level.2")),
          ("UniversalOpAmp1.lib", ("level1",)), ("UniversalOpAmp3a.lib", ("level3a",)),
          ("C:\\Users\\me\\AppData\\Local\\LTspice\\lib\\sub\\UniversalOpAmp3b.lib", ("level3b",)),
          ("UniversalOpAmp1.lib\n.lib UniversalOpAmp2.lib\n.lib UniversalOpAmp3a.lib", ("level1", "level3a"))]

# Subcircuits whose .ends is missing in the file that is included; nested ones; an .ends in another file is none that is
# missing. The divider's half of 10 V.
HALF = "R1 a b 1k\nR2 b 0 1k\n"
HALVES = "V1 in 0 10\nX1 in b half\n.op\n.save v(b)\n.end\n"
UNENDED = [
    (".include half.sub", ".subckt half a b\n" + HALF, True),
    (".include half.sub", ".subckt half a b\n" + HALF + ".end half\n", True),
    (".lib half.sub", "* half\n.subckt half a b\n" + HALF + ".backanno\n.end\n", True),
    (".include half.sub", ".subckt half a b\nX1 a b inner\n.subckt inner a b\n" + HALF, True),
    (".include half.sub", ".subckt half a b\nX1 a b inner\n.subckt inner a b\n" + HALF + ".ends\n", True),
    (".include half.sub", ".macro half a b\n" + HALF, True),
    (".include half.sub\n.subckt other a\nR1 a 0 1\n.ends", ".subckt half a b\n" + HALF, True),
    (".include half.sub\n.ends", ".subckt half a b\n" + HALF, False),
    (".subckt half a b\n.include half.sub\n.ends", HALF, False),
    (".include half.sub\nR2 b 0 1k\n.eom half", ".subckt half a b\nR1 a b 1k\n", False),
]


def attempt(program, card, body, file=None, libraries="/nowhere", part=PART):
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "sub").mkdir()
        (folder / "sub/main.cir").write_text(f"title\n{card}\n{body}")
        if file is not None:
            (folder / file).parent.mkdir(exist_ok=True)
            (folder / file).write_text(part)
        done = subprocess.run([program, "run", "sub/main.cir", "-o", "out.csv"], cwd=folder,
                              env={**os.environ, "DALCS_LIBRARIES": libraries},
                              capture_output=True, text=True, check=False)
        out = folder / "out.csv"
        value = float(out.read_text().split("\n")[1].split(",")[-1]) if out.exists() else None
        return done.returncode, value, done.stderr


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    libraries = str(pathlib.Path(sys.argv[2]).resolve())
    checker = Checker("libraries")
    for card, file in FOUND:
        status, value, said = attempt(program, card, BODY, file)
        checker.check(status == 0 and value == 5, f"{card}: {status}, {value}\n{said}")
        elsewhere = "\\U" in card or "\\P" in card or "D:" in card or "/home" in card
        checker.check(not elsewhere or "is read in its place" in said, f"{card}: without a note\n{said}")
    for card in LEFT_OUT:
        status, value, said = attempt(program, card, HERE)
        checker.check(status == 0 and value == 5 and "was not found: it is left out" in said,
                      f"{card}: {status}, {value}\n{said}")
    for card, body, words in REFUSED:
        status, value, said = attempt(program, card, body)
        checker.check(status == 3 and value is None and words in said,
                      f"{card}: {status}, without '{words}'\n{said}")
    for card, part, lacks in UNENDED:
        status, value, said = attempt(program, card, HALVES, "sub/half.sub", part=part)
        checker.check(status == 0 and value == 5 and lacks == ("it ends with its file" in said),
                      f"{card} of {part}: {status}, {value}\n{said}")
    for file, names in OPAMPS:
        for name in names:
            status, value, said = attempt(program, f".lib {file}", OPAMP.format(name), None, libraries)
            checker.check(status == 0, f"{name}: {status}\n{said}")
            checker.close(value, 2.0, 1e-5, name)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
