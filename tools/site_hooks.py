"""What MkDocs does not do with the pages by itself; tools/site names this file as its hooks."""

import importlib.machinery
import importlib.util
import pathlib
import re
import sys

TOP = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "tools" / "wasm"))
import play  # noqa: E402  pylint: disable=wrong-import-position,import-error

PICTURES = '<p><a href="../gallery/index.html">All of them with schematic and waveforms</a></p>'
PICTURE = re.compile(r'<img [^>]*src="([^"]+)"[^>]*>')


def on_page_markdown(markdown, **_):
    """Answers of exercises are Markdown too; a command that no test runs is shown as any other."""
    return markdown.replace("<details>", '<details markdown="1">').replace("```console by hand", "```console")


def on_page_content(html, page, config, **_):
    # a cell has \| for |, and the extension leaves it so in code
    html = re.sub(r"<t[dh]\b.*?</t[dh]>", lambda cell: cell[0].replace(r"\|", "|"), html, flags=re.DOTALL)
    html = PICTURE.sub(r'<a href="\1">\g<0></a>', html)  # a column may be narrower than a picture
    if page.file.src_path == "doc/gallery.md" and config["extra"]["has_gallery"]:
        html = html.replace("</h1>", f"</h1>\n{PICTURES}", 1)
    return html


def on_page_context(context, page, config, **_):
    panel = panel_of(page.file.src_path) if config["extra"]["has_engine"] else ""
    return {**context, "panel": panel, "panel_style": play.STYLE}


def script(path):
    """A program of Python without a suffix, as a module."""
    loader = importlib.machinery.SourceFileLoader(path.name, str(path))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(path.name, loader))
    loader.exec_module(module)
    return module


def panel_of(page):
    """The panel of a lesson that can be played with, else nothing."""
    if not page.startswith("doc/lessons/"):
        return ""
    text = (TOP / page.replace("lessons/", "lessons/src/").replace(".md", ".txt")).read_text(encoding="utf-8")
    circuit = re.search(r"^@circuit (.*)$", text, re.MULTILINE)
    if not circuit:
        return ""
    described = play.describe(text, script(TOP / "tools/lessons").Circuit(None, circuit[1]).changed)
    return play.panel(described) if described else ""
