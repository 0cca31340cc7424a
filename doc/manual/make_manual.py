#!/usr/bin/env python3
"""Makes the man page and the shell completions from what the program prints as its help.

usage: make_manual.py DALCS FOLDER

Writes FOLDER/dalcs.1, dalcs.bash, _dalcs and dalcs.fish. The help texts are the only place where verbs
and options are described. They have blocks with empty lines between:

    usage: dalcs VERB ...        the synopsis
    text                         a paragraph
      -o, --output FILE   text   a list of options or words; the text goes on in deeper lines
    examples:                    then lines with two blanks, each a command
    exit status: ...             the same for all verbs

The word after an option says what completes it: FILE a file name, a|b|c one of these, another
nothing.
"""

import datetime
import os
import pathlib
import re
import subprocess
import sys
import textwrap

HELP = "options and examples of a verb"
ITEM = re.compile(r"^( {2,6})(\S.*?)(?:  +(\S.*))?$")
OPTION = re.compile(r"^(?:(-\w)(?:, )?)?(--[\w-]+)?(?:(?:[ =]|(?=\[=))(\S.*))?$")


class Option:
    def __init__(self, left, text):
        self.short, self.long, self.shown = OPTION.match(left).groups()
        self.value = None if (self.shown or "").startswith("[") else self.shown  # of --x[=Y] none needs to follow
        self.text = text

    @property
    def names(self):
        return [name for name in (self.short, self.long) if name]

    @property
    def choices(self):
        return self.value.split("|") if self.value and "|" in self.value else []

    @property
    def summary(self):
        """The first words of the text, for a menu."""
        return re.split(r"[;:(]|\. |, \.", self.text)[0].strip()


def read_items(block):
    """[left, text] of a list; a deeper line goes on with the text before it."""
    items = []
    for line in block.split("\n"):
        item = ITEM.match(line)
        if item:
            items.append([item[2], item[3] or ""])
        elif items:
            items[-1][1] = f"{items[-1][1]} {line.strip()}".strip()
    return items


class Help:
    """The help of the program, or of one verb."""

    def __init__(self, program, *verb):
        text = subprocess.run([program, *verb, "--help"], stdin=subprocess.DEVNULL, check=True,
                              capture_output=True, text=True).stdout
        self.usage, self.exit_status = [], ""
        self.examples = []
        self.body = []  # paragraphs as text, lists as [left, text] items
        for block in text.rstrip("\n").split("\n\n"):
            if block.startswith("usage:"):
                self.usage = [re.sub(r"^(usage:)? *", "", line) for line in block.split("\n")]
            elif block.startswith("exit status:"):
                self.exit_status = " ".join(block.partition(":")[2].split())
            elif block.startswith("examples:"):
                self.examples = [line.strip() for line in block.split("\n")[1:]]
            elif block.startswith("  "):
                self.body.append(read_items(block))
            else:
                self.body.append(" ".join(block.split()))

    def items(self):
        return [item for block in self.body if isinstance(block, list) for item in block]

    def options(self):
        return [Option(*item) for item in self.items() if item[0].startswith("-")]


# ---- The man page ------------------------------------------------------------------------------


def roff(text):
    """Text that mdoc takes as it is."""
    text = text.replace("\\", "\\e").replace("-", "\\-").replace("|", "\\*(Ba")
    return "\\&" + text if text[:1] in (".", "'") else text


def sentences(text):
    """mdoc wants each sentence on a line of its own, and short lines."""
    lines = []
    for sentence in re.split(r"(?<=[.!?]) +(?=[A-Z])", text):
        lines += textwrap.wrap(sentence, 70, break_on_hyphens=False, break_long_words=False)
    return "\n".join(map(roff, lines))


def option_head(left):
    option = Option(left, "")
    names = " , ".join("Fl " + roff(name[1:]) for name in option.names)
    joint = " Ns Ar " if (option.shown or "").startswith("[") else " Ar "
    return names + (joint + roff(option.shown) if option.shown else "")


def page_body(page):
    for block in page.body:
        if isinstance(block, str):
            yield f".Pp\n{sentences(block)}"
            continue
        yield ".Bl -tag -width Ds"
        for left, text in block:
            head = option_head(left) if left.startswith("-") else f"Cm {roff(left)}"
            yield f".It {head}\n{sentences(text)}"
        yield ".El"


def man_page(top, verbs):
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    day = (datetime.datetime.fromtimestamp(int(epoch), datetime.timezone.utc) if epoch
           else datetime.datetime.now(datetime.timezone.utc))
    lines = [f".Dd {day:%B} {day.day}, {day:%Y}", ".Dt DALCS 1", ".Os",
             ".Sh NAME", ".Nm dalcs",
             ".Nd simulate circuits with ideal diodes and switches", ".Sh SYNOPSIS"]
    for usage in top.usage + [line for page in verbs.values() for line in page.usage]:
        starts = usage.startswith("dalcs ")
        lines += [*([".Nm"] if starts else []), roff(usage.removeprefix("dalcs "))]
    lines.append(".Sh DESCRIPTION")
    # a section or list starts without .Pp
    lines += re.sub(r"^\.Pp\n", "", "\n".join(page_body(top))).split("\n")
    for name, page in verbs.items():
        lines += [f".Sh DALCS {name.upper()}"]
        lines += re.sub(r"^\.Pp\n", "", "\n".join(page_body(page))).split("\n")
        if page.examples:
            lines += [".Pp", "Examples:", ".Bd -literal -offset indent",
                      *map(roff, page.examples), ".Ed"]
    lines += [".Sh EXIT STATUS", sentences(top.exit_status[:1].upper() + top.exit_status[1:]) + ".",
              ".Sh SEE ALSO", ".Xr gnuplot 1 ,", ".Xr ngspice 1"]
    return "\n".join(lines) + "\n"


# ---- Completions -------------------------------------------------------------------------------


def quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def bash(top, verbs):
    def choice(name, words):
        return f"        {name}) COMPREPLY=($(compgen -W {quoted(words)} -- \"$word\")) ;;"

    values, words = [], []
    for verb, page in verbs.items():
        for option in page.options():
            names = "|".join(f"{verb}:{name}" for name in option.names)
            if option.choices:
                values.append(choice(names, " ".join(option.choices)))
            elif option.value == "FILE":
                values.append(f"        {names}) COMPREPLY=($(compgen -f -- \"$word\")) ;;")
            elif option.value:
                values.append(f"        {names}) ;;")
        names = " ".join(name for option in page.options() for name in option.names)
        words.append(choice(verb, names))
    top_words = " ".join([*verbs, "help", *(n for option in top.options() for n in option.names)])
    return "\n".join([
        "# bash completion of dalcs, made from its help texts", "_dalcs() {",
        "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}",
        "    COMPREPLY=()",
        "    if ((COMP_CWORD == 1)); then",
        f"        COMPREPLY=($(compgen -W {quoted(top_words)} -- \"$word\"))",
        "        return", "    fi",
        "    if [[ ${COMP_WORDS[1]} == help ]]; then",
        f"        COMPREPLY=($(compgen -W {quoted(' '.join(verbs))} -- \"$word\"))",
        "        return", "    fi",
        "    case ${COMP_WORDS[1]}:$before in", *values, "        *)",
        "            if [[ $word != -* ]]; then",
        "                COMPREPLY=($(compgen -f -- \"$word\"))",
        "                return", "            fi",
        "            case ${COMP_WORDS[1]} in",
        *(("        " + line) for line in words),
        "            esac", "            ;;", "    esac", "}",
        "complete -o filenames -F _dalcs dalcs", ""])


def zsh(top, verbs):
    def plain(text):
        return re.sub(r"([\[\]:\\])", r"\\\1", text)

    def spec(option):
        value = ""
        if option.value:
            action = f"({' '.join(option.choices)})" if option.choices else ""
            action = "_files" if option.value == "FILE" else action
            value = f":{plain(option.value)}:{action}"
        tail = f"[{plain(option.summary)}]{value}"
        if option.short and option.long:
            names = " ".join(option.names)
            return f"'({names})'{{{names.replace(' ', ',')}}}{quoted(tail)}"
        return quoted(option.names[0] + tail)

    lines = ["#compdef dalcs", "# zsh completion of dalcs, made from its help texts", "",
             "if ((CURRENT == 2)); then", "    local -a verbs=("]
    lines += [f"        {quoted(plain(name) + ':' + plain(text))}"
              for name, text in top.items() if name in verbs]
    lines += [f"        {quoted(name + ':' + plain(option.text))}"
              for option in top.options() for name in option.names]
    lines += [f"        {quoted('help:' + HELP)}"]
    lines += ["    )", "    _describe verb verbs", "    return", "fi",
              "local verb=$words[2]", "shift words", "((CURRENT--))", "case $verb in"]
    lines += ["    help)", f"        _arguments '1:verb:({' '.join(verbs)})'", "        ;;"]
    for verb, page in verbs.items():
        lines += [f"    {verb})", "        _arguments -s \\"]
        lines += [f"            {spec(option)} \\" for option in page.options()]
        lines += ["            '*:file:_files'", "        ;;"]
    return "\n".join(lines + ["esac", ""])


def fish(top, verbs):
    lines = ["# fish completion of dalcs, made from its help texts"]
    for name, text in top.items():
        if name in verbs:
            lines.append(f"complete -c dalcs -n __fish_use_subcommand -f -a {name} "
                         f"-d {quoted(text)}")
    lines += [f"complete -c dalcs -n __fish_use_subcommand -f -a help -d {quoted(HELP)}",
              f"complete -c dalcs -n '__fish_seen_subcommand_from help' -f -a {quoted(' '.join(verbs))}"]
    for verb, page in verbs.items():
        for option in page.options():
            line = f"complete -c dalcs -n '__fish_seen_subcommand_from {verb}'"
            line += f" -s {option.short[1:]}" if option.short else ""
            line += f" -l {option.long[2:]}" if option.long else ""
            if option.choices:
                line += f" -x -a {quoted(' '.join(option.choices))}"
            elif option.value:
                line += " -r -F" if option.value == "FILE" else " -x"
            lines.append(f"{line} -d {quoted(option.summary)}")
    return "\n".join(lines + [""])


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    top = Help(program)
    verbs = {name: Help(program, name) for name, _ in top.items() if re.fullmatch(r"[a-z][a-z-]*", name)}
    for name, text in [("dalcs.1", man_page(top, verbs)), ("dalcs.bash", bash(top, verbs)),
                       ("_dalcs", zsh(top, verbs)), ("dalcs.fish", fish(top, verbs))]:
        (folder / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
