#!/usr/bin/env python3
"""Runs what README.md and the pages of doc/ show, each page in a folder of its own.

usage: pages.py BUILD_FOLDER SOURCE_FOLDER [PAGE...]

```spice      a netlist: it runs without an error or a warning, and where a comment says
              `* v(out) ends at 2.5`, it does, to the digits that are written; where it says
              `* measured mean = 2.5m`, to 1e-10. A line
              `* ---- file NAME` starts another file of the example.
```console    lines that start with `$ ` are commands and run in a shell; what follows one is what it
              prints, if anything is shown. A line `...` stands for any lines, `...` in a line for any
              text; in lines of times, residuals and versions numbers are not compared. The command
              fails if `error:` is shown, else not.
```console by hand
              is shown only: it takes long, and only the pages in BY_HAND may do that.
A block after a paragraph that ends in "as `NAME`:" is also saved under that name. Commands find the
installed program, library and manual; `build`, `netlists` and the other folders of the source are
there. Elsewhere, in other blocks, a command is an error: nothing would run it.

Links lead to pages, headings and files that exist, and so do paths and functions in `code`.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import dalcs_program  # pylint: disable=wrong-import-position,import-error

BY_HAND = {"accuracy.md", "testing.md"}
BLOCK = re.compile(r"^```(.*)\n((?:.*\n)*?)```$", re.MULTILINE)
SAVED = re.compile(r"\bas `([\w.-]+)`[^\n]*:\s*\Z")
COMMAND = re.compile(r"^ *(?:\$ |(?:build/)?dalcs (?:run|steady|bode|envelope|check|plot|compare|converge|equations) |"
                     r"(?:\.ci|tools)/\w+|python3 |meson |ninja |gcc )", re.MULTILINE)
MEASURED = re.compile(r" cpu|residual|wall| s for ")


# ---- The place where a page runs ---------------------------------------------------------------


class Place:
    """What is installed, and helpers that keep a page from changing the machine."""

    def __init__(self, folder, build, source):
        self.folder, self.build, self.source = folder, build, source
        root, helpers = folder / "root", folder / "helpers"
        subprocess.run(["meson", "install", "-C", build, "--no-rebuild", "--destdir", root],
                       check=True, stdout=subprocess.DEVNULL)
        package = next(root.rglob("dalcs.pc")).parent
        helpers.mkdir()
        self.write_helper("sudo", 'exec "$@"')
        # installs nothing, but the packages must be those that tests and users need
        self.write_helper("apt-get", f"""
            . {source}/tools/packages.sh
            shift
            for name; do case $name in -*) ;; *) package_is_installed "$name" ||
                {{ echo "$name is not installed"; exit 1; }} ;; esac; done""")
        for name in "meson", "ninja":
            self.write_helper(name, f"""
                words=(); for word; do
                    [[ $word == build ]] && word={build} && cd {source}; words+=("$word"); done
                # a later Meson sets the options of a folder that is set up already: other tests run in it
                [[ ${{words[*]}} != "setup {build} "* ]] || exit 0
                exec {shutil.which(name)} "${{words[@]}}" """)
        self.environment = {
            **os.environ, "PKG_CONFIG_PATH": str(package), "PKG_CONFIG_SYSROOT_DIR": str(root),
            "LD_LIBRARY_PATH": str(package.parent),
            "DESTDIR": str(folder / "other"), "HOME": str(folder), "LC_ALL": "C.UTF-8", "COLUMNS": "72",
            "PATH": f"{helpers}:{next(root.rglob('bin/dalcs')).parent}:{os.environ['PATH']}"}

    def write_helper(self, name, text):
        path = self.folder / "helpers" / name
        path.write_text(f"#!/bin/bash\n{text}\n", encoding="utf-8")
        path.chmod(0o755)

    def open_page(self, name):
        folder = self.folder / name
        folder.mkdir()
        for entry in self.source.iterdir():
            if entry.is_dir() and not entry.name.startswith((".", "build", "out")):
                (folder / entry.name).symlink_to(entry)
        (folder / "build").symlink_to(self.build)
        return folder


# ---- Blocks ------------------------------------------------------------------------------------


def write_netlist(folder, block):
    """The files of a block; the path of the first."""
    parts = re.split(r"^\* ---- file (\S+)\n", block, flags=re.MULTILINE)
    names = ["example.cir"] + parts[1::2]
    for name, text in zip(names, parts[0::2]):
        (folder / name).write_text(text, encoding="utf-8")
    return folder / names[0]


def run_netlist(checker, program, block, where):
    with tempfile.TemporaryDirectory() as folder:
        run = dalcs_program.run(program, write_netlist(pathlib.Path(folder), block), method=None)
    checker.check(run.status == 0 and "warning" not in run.stderr, f"{where}: {run.stderr}")
    for signal, written in re.findall(r"^\* (\S+) ends at (\S+)$", block, re.MULTILINE):
        digits = len(written.partition(".")[2])
        if run.status == 0:
            checker.close(run.column(signal)[-1], float(written), 0.5 * 10.0 ** -digits,
                          f"{where}: {signal}")
    found = {entry["name"]: entry["value"] for entry in (run.report or {}).get("measurements", [])}
    for name, written, milli in re.findall(r"^\* measured (\S+) = ([-+.\de]+)(m?)$", block,
                                           re.MULTILINE):
        wanted = float(written) * (1e-3 if milli else 1.0)
        checker.close(found.get(name, float("nan")), wanted, 1e-10 * abs(wanted),
                      f"{where}: {name}")


def line_pattern(line):
    pieces = [re.escape(piece) for piece in line.split("...")]
    if MEASURED.search(line):
        number = re.compile(r"(?:\d|\\\.)+(?:e\\[-+]\d+)?")
        pieces = [number.sub(r"[\\d.e+-]+", piece) for piece in pieces]
        pieces = [re.sub(r"(?<=\\ )[mun]?s(?=\b)", r"\\w*s", piece) for piece in pieces]
    return ".*".join(pieces)


def matches(shown, printed):
    """Does what was printed look like what is shown?"""
    lines = [line.rstrip() for line in shown.rstrip("\n").split("\n")]
    pattern = "\n".join("@any@" if line.strip() == "..." else line_pattern(line) for line in lines)
    pattern = pattern.replace("@any@\n", "(?:.*\n)*?").replace("\n@any@", "(?:\n.*)*")
    text = "\n".join(line.rstrip() for line in printed.rstrip("\n").split("\n"))
    return re.fullmatch(pattern, text) is not None


def run_console(checker, environment, folder, block, where):
    for part in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
        command, _, shown = part.partition("\n")
        while command.endswith("\\"):
            more, _, shown = shown.partition("\n")
            command = command[:-1] + more
        done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, check=False)
        fails = "error:" in shown
        checker.check((done.returncode != 0) == fails,
                      f"{where}: $ {command}\nstatus {done.returncode}\n{done.stdout}")
        if shown.strip():
            checker.check(matches(shown, done.stdout),
                          f"{where}: $ {command}\nprints\n{done.stdout}and not\n{shown}")


# ---- Links and names ---------------------------------------------------------------------------


def anchors(text):
    """The headings of a page as links to them are written."""
    headings = re.findall(r"^#+ (.*)$", BLOCK.sub("", text), re.MULTILINE)
    plain = [re.sub(r"[^\w\- ]", "", re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", heading)).lower()
             for heading in headings]
    return {heading.strip().replace(" ", "-") for heading in plain}


def check_links(checker, source, page, text):
    prose = re.sub(r"`[^`\n]*`", "", BLOCK.sub("", text))
    for target in re.findall(r"\]\(([^)\s]+)\)", prose):
        if re.match(r"\w+:", target):
            continue
        name, _, anchor = target.partition("#")
        path = (page.parent / name).resolve() if name else page
        if checker.check(path.exists(), f"{page.name}: no {target}") and anchor:
            checker.check(anchor in anchors(path.read_text(encoding="utf-8")),
                          f"{page.name}: no heading for {target}")
    known = "".join(path.read_text(encoding="utf-8")
                    for path in (source / "src").rglob("*.[ch]"))
    for code in re.findall(r"`([^`\n]+)`", BLOCK.sub("", text)):
        if "NAME" in code:
            continue
        if re.fullmatch(r"(?:src|tests|tools|doc|netlists|\.ci)/[\w./-]+", code):
            checker.check((source / code).exists(), f"{page.name}: there is no {code}")
        elif re.fullmatch(r"dalcs_\w+", code):
            checker.check(re.search(rf"\b{code}\b", known), f"{page.name}: there is no {code}")


def run_page(checker, place, page):
    text = page.read_text(encoding="utf-8")
    folder = place.open_page("".join(page.relative_to(place.source).parts))
    for match in BLOCK.finditer(text):
        language, block = match.group(1).strip(), match.group(2)
        where = f"{page.name}:{text.count(chr(10), 0, match.start()) + 1}"
        saved = SAVED.search(text[:match.start()])
        if saved:
            (folder / saved.group(1)).write_text(block, encoding="utf-8")
        if language == "spice":
            run_netlist(checker, shutil.which("dalcs", path=place.environment["PATH"]), block,
                        where)
        elif language == "console":
            run_console(checker, place.environment, folder, block, where)
        elif language == "console by hand":
            checker.check(page.name in BY_HAND, f"{where}: nothing runs this")
        else:
            checker.check(not COMMAND.search(block), f"{where}: a command that nothing runs")
    bare = "\n".join(line for line in BLOCK.sub("", text).split("\n") if line.startswith("    "))
    checker.check(not COMMAND.search(bare), f"{page.name}: an indented command; nothing runs it")
    check_links(checker, place.source, page, text)


def main():
    build, source = (pathlib.Path(name).resolve() for name in sys.argv[1:3])
    pages = [source / name for name in sys.argv[3:]]
    pages = pages or [source / "README.md", *sorted((source / "doc").rglob("*.md"))]
    checker = dalcs_program.Checker("documentation")
    with tempfile.TemporaryDirectory() as folder:
        place = Place(pathlib.Path(folder), build, source)
        for page in pages:
            run_page(checker, place, page)
    return checker.finish()


if __name__ == "__main__":
    sys.exit(main())
