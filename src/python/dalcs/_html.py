"""What Jupyter shows of results: plain tables."""

from __future__ import annotations

import html
from typing import Iterable, Sequence


def table_of(title: str, header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """An HTML table; numbers with six digits."""
    def cell(tag: str, value: object) -> str:
        text = f"{value:.6g}" if isinstance(value, float) else str(value)
        return f"<{tag}>{html.escape(text)}</{tag}>"

    lines = ["".join(cell("th", name) for name in header)]
    lines += ["".join(cell("td", value) for value in row) for row in rows]
    return f"<p>{html.escape(title)}</p><table>" + "".join(f"<tr>{line}</tr>" for line in lines) + "</table>"
