"""dalcs.h as one text: each line that includes one of its parts is that part."""

import pathlib
import re

PART = re.compile(r'^#include "(libdalcs/\w+\.h)"$', re.MULTILINE)


def text_of(header):
    header = pathlib.Path(header)
    return PART.sub(lambda found: (header.parent / found[1]).read_text(encoding="utf-8"),
                    header.read_text(encoding="utf-8"))
