#!/usr/bin/env python3
"""What `dalcs equations --format latex` writes compiles, without an error, and keeps to its page.

usage: latex.py DALCS [FOLDER]

Every netlist and system file of netlists/, or of its FOLDER, and those beside this test, in each form. LaTeX takes
far longer to start than to set a page. So of each form one document is compiled as it is; all others must
begin as that one does, and what follows is set in one run, each in a group of its own. Where there is no pdflatex
the test is skipped; tools/test installs it."""

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
BEGIN, END = "\\begin{document}\n", "\\end{document}\n"
STARTS = "dalcs document "  # in the log, before each of many
# the document's own text, that is not a formula's
UNDEFINED = re.compile(r"^! |LaTeX Error|Missing character", re.MULTILINE)
OVERFULL = re.compile(r"^Overfull \\hbox \(([0-9.]+)pt", re.MULTILINE)


def documents(checker, program, netlists, form):
    """(name, text) of each netlist that can be read."""
    for netlist in netlists:
        name = f"{netlist.name} as {form[1]}"
        done = subprocess.run([program, "equations", str(netlist), "--format", "latex", *form], check=False,
                              capture_output=True, text=True)
        if done.returncode != 3 and checker.check(done.returncode == 0, f"{name}: {done.stderr}"):
            yield name, done.stdout


def compiled(text, folder):
    """Whether LaTeX came to its end, and its log."""
    (folder / "e.tex").write_text(text)
    made = subprocess.run(["pdflatex", "-halt-on-error", "-interaction=nonstopmode", "e.tex"], cwd=folder,
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          check=False)
    return made.returncode == 0, (folder / "e.log").read_text(encoding="latin-1")


def check_log(checker, name, log):
    checker.check(not UNDEFINED.search(log), f"{name}: {log[-2000:]}")
    wide = [float(width) for width in OVERFULL.findall(log)]
    checker.check(not wide, f"{name}: {max(wide, default=0)} pt beyond the margin")


def check_one(checker, name, text, folder):
    ended, log = compiled(text, folder)
    checker.check(ended, f"{name}: {log[-2000:]}")
    check_log(checker, name, log)


def check_all(checker, named, folder):
    """Those that begin alike, at once; an error is the last one's that the log names."""
    begin = named[0][1].partition(BEGIN)[0]
    text = begin + BEGIN
    for k, (name, whole) in enumerate(named):
        before, _, body = whole.partition(BEGIN)
        if checker.check(before == begin and body.endswith(END), f"{name}: begins or ends as no other"):
            text += f"\\typeout{{{STARTS}{k}}}\n\\begingroup\n{body.removesuffix(END)}\\clearpage\n\\endgroup\n"
    ended, log = compiled(text + END, folder)
    parts = re.split(rf"^{STARTS}(\d+)$", log, flags=re.MULTILINE)
    numbers = [int(number) for number in parts[1::2]]
    checker.check(ended, f"{named[numbers[-1]][0] if numbers else 'none'}: {log[-2000:]}")
    checker.check(not ended or numbers == list(range(len(named))), f"LaTeX saw {len(numbers)} of {len(named)}")
    for number, part in zip(numbers, parts[2::2]):
        check_log(checker, named[number][0], part)


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
        for form in FORMS:
            named = list(documents(checker, program, netlists, form))
            if checker.check(len(named) > 0.8 * len(netlists), f"only {len(named)} of {len(netlists)}, {form}"):
                check_one(checker, *named[0], pathlib.Path(folder))
                check_all(checker, named, pathlib.Path(folder))
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
