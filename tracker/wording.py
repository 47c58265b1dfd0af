"""How are values put into a sentence that somebody reads in a terminal?"""

from __future__ import annotations

import re
from collections.abc import Iterable


def shown(value: object, length: int = 100) -> str:
    """A value that somebody gave: as Python writes it, and not endless."""
    text = repr(value)
    return text if len(text) <= length else f"{text[: length - 3]}..."


def counted(number: int, what: str) -> str:
    """`1 image`, `2 images`."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def one_line(text: str) -> str:
    """A text with its control characters written out, and words that do not end cut."""
    plain = "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in text)
    return re.sub(r"(\S{200})\S{100,}", r"\1...", plain)


def listing(names: Iterable[str], most: int = 12) -> str:
    """Names with commas between; of many, the first and the number of the others."""
    found = list(names)
    told = ", ".join(one_line(name) for name in found[:most])
    return f"{told} and {len(found) - most} more" if len(found) > most else told
