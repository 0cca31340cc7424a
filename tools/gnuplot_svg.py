"""Pictures that gnuplot wrote as SVG and that stand in pages: smaller, and what text they have."""

import html
import re


def smaller(svg):
    """gnuplot's picture without what it does not use, and with its groups' common words once."""
    defined = re.search(r"<defs>.*?</defs>", svg, re.DOTALL)[0]
    if not re.search(r"url\(#|href='#", svg.replace(defined, "")):
        svg = svg.replace(defined, "")
    svg = re.sub(r"\s*\n\s*", "\n", svg)
    common = ('fill="none" color="black" stroke="currentColor" stroke-width="1.00" '
              'stroke-linecap="round" stroke-linejoin="round"')
    font = 'font-family="DejaVu Sans" font-size="14.00"'
    svg = svg.replace(f" {common}", "").replace(f" {font}", "")
    svg = svg.replace('<g id="gnuplot_canvas">', f"<g {common} {font}>")
    svg = re.sub(r"<text>\s*</text>\n?", "", re.sub(r' class="gridline" ', "", svg))
    before = None
    while before != svg:
        before, svg = svg, re.sub(r"<g [^>]*>\s*</g>\n?|<g>\s*</g>\n?", "", svg)
    svg = re.sub(r"<g>\s*(<path[^>]*/>)\s*</g>", r"\1", svg)
    return re.sub(r"(?<=\d)\.00\b", "", re.sub(r"rgb\( *(\d+), *(\d+), *(\d+)\)",
                                             r"rgb(\1,\2,\3)", svg))


def labels(path):
    text = path.read_text(encoding="utf-8")
    found = re.findall(r"<text[^>]*>(.*?)</text>", text, re.DOTALL)
    return sorted(html.unescape(re.sub(r"<[^>]*>", "", label)).strip() for label in found)
