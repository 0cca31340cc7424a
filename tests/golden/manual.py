#!/usr/bin/env python3
"""The man page and the completions, which are made from the help texts.

usage: manual.py DALCS FOLDER

Where mandoc, zsh or fish is missing, its part is left out.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import unittest

DALCS, FOLDER = "", pathlib.Path()


def output_of(*command):
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False)
    if done.returncode != 0 or done.stderr:
        raise AssertionError(f"{command}: {done.returncode} {done.stdout}{done.stderr}")
    return done.stdout


def verbs():
    found = re.findall(r"^  ([a-z][a-z-]*) {2,}\S", output_of(DALCS, "--help"), re.MULTILINE)
    assert {"run", "as-ngspice"} <= set(found)
    return found


def options(verb):
    """The long options in a verb's help, and those with a value."""
    text = output_of(DALCS, verb, "--help")
    found = re.findall(r"^ {2,6}(?:-\w, )?(--[\w-]+)(?: (\S+))?", text, re.MULTILINE)
    assert ("--help", None) in [(name, value or None) for name, value in found], verb
    return found


def needs(program):
    return unittest.skipUnless(shutil.which(program), f"{program} is not installed")


class Help(unittest.TestCase):
    def test_each_verb_has_examples(self):
        for verb in verbs():
            text = output_of(DALCS, verb, "--help")
            self.assertTrue(text.startswith(f"usage: dalcs {verb} "), text)
            self.assertRegex(text, rf"\n\nexamples:\n  dalcs {verb} ")
            self.assertRegex(text, r"\n\nexit status: (0 ok, |that of the command)")
            self.assertEqual(output_of(DALCS, "help", verb), text)
        self.assertEqual(output_of(DALCS, "help"), output_of(DALCS, "--help"))

    def test_help_of_no_verb(self):
        done = subprocess.run([DALCS, "help", "stedy"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout), (2, ""))
        self.assertIn("unknown verb 'stedy'; did you mean 'steady'?", done.stderr)

    def test_options_are_those_of_the_program(self):
        """Each option that a verb's help names is taken, and each that the source takes is in some help."""
        named = set()
        for verb in verbs():
            if verb == "as-ngspice":
                continue  # what follows are words of the command
            for name, _ in options(verb):
                named.add(name)
                done = subprocess.run([DALCS, verb, name], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                      check=False)
                self.assertNotIn("unknown option", done.stderr, f"{verb} {name}")
        taken = set()
        for source in (pathlib.Path(__file__).resolve().parents[2] / "src" / "cli").glob("*.c"):
            if source.name == "batch.c":
                continue  # all of ngspice's options are taken there
            entry = (r'\{"([\w-]+)",\s*(?:(?:0|\'\w\'),\s*)?(?:no|required|optional)_argument'
                     r'|\b(?:READ|FLAG|TEXT|COUNT)\("([\w-]+)"')  # of getopt_long's table, or argument_options.c's
            taken |= {f"--{''.join(name)}" for name in re.findall(entry, source.read_text())}
        self.assertGreater(len(taken), 40)
        self.assertEqual(sorted(taken - named), [])

    def test_no_line_is_too_long(self):
        for verb in verbs():
            for line in output_of(DALCS, verb, "--help").splitlines():
                self.assertLessEqual(len(line), 96, f"{verb}: {line}")


class ManPage(unittest.TestCase):
    @needs("mandoc")
    def test_lint(self):
        lint = subprocess.run(["mandoc", "-Tlint", "-Wstyle", FOLDER / "dalcs.1"],
                              capture_output=True, text=True, check=False)
        # whether pages that it refers to are installed is not the page's matter
        told = [line for line in lint.stdout.splitlines()
                if "referenced manual not found" not in line]
        self.assertEqual(told, [])

    @needs("mandoc")
    def test_says_what_the_help_says(self):
        page = output_of("mandoc", "-Tascii", "-Owidth=500", FOLDER / "dalcs.1")
        page = " ".join(re.sub(r".\x08", "", page).split())
        for verb in verbs():
            self.assertIn(f"DALCS {verb.upper()}", page)
            for line in output_of(DALCS, verb, "--help").splitlines():
                words = " ".join(line.split())
                if words.startswith(("usage:", "exit status:", "examples:")):
                    continue
                for part in re.split(r" {2,}", line.strip()):
                    self.assertIn(" ".join(part.split()), page)


class Completion(unittest.TestCase):
    def bash(self, *words):
        script = ('source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _dalcs; '
                  'printf "%s\\n" "${COMPREPLY[@]}"')
        return output_of("bash", "-c", script, "bash", FOLDER / "dalcs.bash", *words).split()

    def test_bash(self):
        self.assertLessEqual(set(verbs()), set(self.bash("dalcs", "")))
        self.assertEqual(self.bash("dalcs", "ru"), ["run"])
        self.assertEqual(self.bash("dalcs", "help", "conv"), ["converge"])
        for verb in verbs():
            names = {name for name, _ in options(verb)}
            self.assertLessEqual(names, set(self.bash("dalcs", verb, "-")))
        self.assertEqual(self.bash("dalcs", "run", "--method", "e"), ["euler"])
        self.assertEqual(self.bash("dalcs", "run", "--tol", ""), [])
        self.assertEqual(self.bash("dalcs", "run", str(FOLDER / "dalcs.f")),
                         [str(FOLDER / "dalcs.fish")])
        self.assertEqual(self.bash("dalcs", "run", "-o", str(FOLDER / "dalcs.f")),
                         [str(FOLDER / "dalcs.fish")])

    @needs("fish")
    def test_fish(self):
        def complete(line):
            listed = output_of("fish", "--no-config", "-c", f"source {FOLDER}/dalcs.fish; "
                               f"complete -C '{line}'")
            return {row.split("\t")[0] for row in listed.splitlines()}

        self.assertLessEqual(set(verbs()), complete("dalcs "))
        for verb in verbs():
            self.assertLessEqual({name for name, _ in options(verb)}, complete(f"dalcs {verb} --"))
        self.assertEqual(complete("dalcs run --method e"), {"euler"})
        self.assertEqual(complete("dalcs help conv"), {"converge"})

    @needs("zsh")
    def test_zsh(self):
        """What it tells zsh's own functions; these need a terminal to do more."""
        def told(*words):
            script = ("_arguments() { print -rl -- $@ }; _describe() { print -rl -- ${(P)2} }; "
                      "completion() { source $1 }; words=(${@:2}); CURRENT=$#words; completion $1")
            return output_of("zsh", "-fc", script, "zsh", FOLDER / "_dalcs", *words, "x")

        self.assertIn("run:simulate a netlist", told("dalcs"))
        for verb in verbs():
            text = told("dalcs", verb)
            for name, value in options(verb):
                # _arguments takes a name, a text in brackets, and for a value two more fields
                self.assertRegex(text, rf"(?m)^(\([^)]*\))?{name}\[[^\]]+\]"
                                 + (r":[^:]+:" if value else "$"))
        self.assertIn("--method[how to integrate]:auto|radau|lobatto|euler:(auto radau lobatto euler)",
                      told("dalcs", "run"))


if __name__ == "__main__":
    DALCS, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=sys.argv[:1])
