"""Names that are looked up: in any case, and one that is not there is told with those that are."""

from __future__ import annotations

import difflib
from typing import Any, Dict, Iterable, Mapping


def no_such(what: str, name: object, known: Iterable[str]) -> KeyError:
    """No `what` of this name: which one was meant, else all that there are."""
    lower = {each.lower(): each for each in known}
    near = difflib.get_close_matches(str(name).lower(), lower, 1)
    if near:
        return KeyError(f"no {what} {name!r}; did you mean {lower[near[0]]!r}?")
    return KeyError(f"no {what} {name!r} " + (f"among {', '.join(lower.values())}" if lower else "at all"))


def find(what: str, name: object, known: Mapping[str, Any]) -> Any:
    """The value of a name that was written in another case than those that are known; KeyError: of none."""
    for each, value in known.items():
        if each.lower() == str(name).lower():
            return value
    raise no_such(what, name, known)


class Measures(Dict[str, Any]):
    """What each .meas gave: names are in lower case, and are found in any."""

    def __missing__(self, name: object) -> Any:
        return find("measurement", name, self)
