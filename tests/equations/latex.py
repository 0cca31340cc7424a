#!/usr/bin/env python3
"""What `dalcs equations --format latex` writes compiles as it is, without an error, and keeps to its page.

usage: latex.py DALCS [FOLDER]

Every netlist and system file of netlists/, or of its FOLDER, and those beside this test, in each form. Where
there is no pdflatex the test is skipped; tools/test installs it."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))

import dalcs_program  # noqa: E402

SKIPPED = 77
FORMS = [["--form", "dalcs"], ["--form", "lcs"], ["--form", "osnsp", "--step", "1u"]]
# the document's own text, that is not a formula's
UNDEFINED = re.compile(r"^! |LaTeX Error|Missing character", re.MULTILINE)
OVERFULL = re.compile(r"^Overfull \\hbox \(([0-9.]+)pt", re.MULTILINE)


def check(checker, program, netlist, form, folder):
    name = f"{netlist.name} as {form[1]}"
    done = subprocess.run([program, "equations", str(netlist), "--format", "latex", *form], check=False,
                          capture_output=True, text=True)
    if done.returncode == 3:  # refused when it is read
        return
    if not checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
        return
    (folder / "e.tex").write_text(done.stdout)
    made = subprocess.run(["pdflatex", "-halt-on-error", "-interaction=nonstopmode", "e.tex"], cwd=folder,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          check=False)
    log = (folder / "e.log").read_text(encoding="latin-1")
    checker.check(made.returncode == 0 and not UNDEFINED.search(log), f"{name}: {log[-2000:]}")
    wide = [float(width) for width in OVERFULL.findall(log)]
    checker.check(not wide, f"{name}: {max(wide, default=0)} pt beyond the margin")


def main():
    program = sys.argv[1]
    checker = dalcs_program.Checker("latex")
    packages = (dalcs_program.ROOT / "tools" / "packages.sh").read_text()
    checker.check("latex) echo texlive-latex-base" in packages, "tools/packages.sh has no LaTeX")
    needed = re.search(r"^need_packages .*", (dalcs_program.ROOT / "tools" / "test").read_text(), re.MULTILINE)
    checker.check(needed and "latex" in needed.group().split(), "tools/test does not install LaTeX")
    if shutil.which("pdflatex") is None:
        print("latex: there is no pdflatex")
        return checker.finish() or SKIPPED
    netlists = [path for path in sorted(dalcs_program.NETLISTS.joinpath(*sys.argv[2:]).rglob("*"))
                if path.suffix in (".cir", ".dalcs")]
    netlists += sorted(pathlib.Path(__file__).parent.glob("*.cir"))
    with tempfile.TemporaryDirectory() as folder:
        for netlist in netlists:
            for form in FORMS:
                check(checker, program, netlist, form, pathlib.Path(folder))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
