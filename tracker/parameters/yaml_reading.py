"""What does a YAML text say? Its scalars are typed as ROS 2 does it (rcl_yaml_param_parser).

PyYAML reads by YAML 1.1, where `1e-3` is a text. The text is read event by event, so that deep
nesting and aliases that multiply are refused before they cost memory.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tracker.errors import ConfigError

if TYPE_CHECKING:
    import yaml

#: A file of every parameter with its comments has 17 kB.
MAX_BYTES = 1_000_000
MAX_DEPTH = 40
MAX_VALUES = 100_000

_STRING_TAG = "tag:yaml.org,2002:str"
_NOTHING = ("", "~", "null", "Null", "NULL")
_TRUTH = {
    spelling: value
    for value, words in ((True, ("y", "yes", "true", "on")), (False, ("n", "no", "false", "off")))
    for word in words
    for spelling in (word, word.capitalize(), word.upper())
}
_WHOLE = re.compile(r"[+-]?(0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
_NUMBER = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?")
_HEXADECIMAL = re.compile(r"[+-]?0[xX]([0-9a-fA-F]+\.?[0-9a-fA-F]*|\.[0-9a-fA-F]+)([pP][+-]?\d+)?")
_NOT_FINITE = re.compile(r"[+-]?\.?(inf|nan|(?<!\.)infinity)", re.IGNORECASE)


def read_yaml(path: Path) -> Any:
    """The content of a file, as `parse_yaml` gives it.

    Raises:
        ConfigError: The file cannot be read, is too large, or as `parse_yaml`.
    """
    try:
        with path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:  # a name with a zero in it, for one
        reason = getattr(error, "strerror", None) or error
        raise ConfigError(f"{path}: cannot be read ({reason}).") from error
    if len(content) > MAX_BYTES:
        raise ConfigError(
            f"{path}: is larger than {MAX_BYTES / 1e6:g} MB, too large for such a file; is it "
            "the wrong file?"
        )
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path}: is not UTF-8 text; expected a YAML file.") from error
    return parse_yaml(text, str(path))


def parse_yaml(text: str, origin: str) -> Any:
    """Mappings, lists and scalars of a YAML text; None where it is empty.

    Keys are texts, as they are written. A section (a mapping) that stands twice is merged, as in
    rcl; any other key that stands twice is refused.

    Args:
        text: YAML.
        origin: Where it came from, for the message.

    Raises:
        ConfigError: It is no YAML, nested too deeply or too large, or a key stands twice.
    """
    import yaml  # the core imports with numpy, scipy and pydantic alone

    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # ten times as fast, where it is there
    try:
        return _document(yaml.parse(text, Loader=loader), origin)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f" at line {mark.line + 1}, column {mark.column + 1}" if mark else ""
        what = getattr(error, "problem", None) or "syntax error"
        raise ConfigError(f"{origin}: is not YAML{where}: {what}.") from error


def scalar(text: str) -> Any:
    """The value of an unquoted scalar: None, bool, int, float or str."""
    if text in _NOTHING:
        return None
    if text in _TRUTH:
        return _TRUTH[text]
    if _WHOLE.fullmatch(text) and len(text) < 64:
        digits = text.lstrip("+-")
        is_octal = len(digits) > 1 and digits.isdigit() and digits[0] == "0"
        whole = int(text, 8) if is_octal else int(text, 0)
        if -(2**63) <= whole < 2**63:
            return whole
    if _NOT_FINITE.fullmatch(text):
        return float(text.replace(".", ""))
    if _NUMBER.fullmatch(text) and math.isfinite(number := float(text)):
        return number
    if _HEXADECIMAL.fullmatch(text) and len(text) < 64:
        return float.fromhex(text)
    return text


@dataclass(slots=True)
class _Collection:
    """A mapping or a list that is still open; its size counts what its aliases stand for."""

    value: dict[str, Any] | list[Any]
    anchor: str | None
    key: str | None = None
    size: int = 1


@dataclass(slots=True)
class _Reader:
    origin: str
    line: int = 0
    opened: list[_Collection] = field(default_factory=list)
    anchors: dict[str, tuple[Any, int]] = field(default_factory=dict)
    document: Any = None

    def take(self, value: Any, size: int, anchor: str | None) -> None:
        """Put a value where it belongs."""
        if anchor is not None:
            self.anchors[anchor] = value, size
        if not self.opened:
            is_more = isinstance(self.document, dict) and isinstance(value, dict)
            self.document = self.merged(self.document, value) if is_more else value
            return
        parent = self.opened[-1]
        parent.size += size
        if parent.size > MAX_VALUES:
            raise self.error(f"holds more than {MAX_VALUES} values, aliases counted")
        if isinstance(parent.value, list):
            parent.value.append(value)
        elif parent.key is None:
            if not isinstance(value, str):
                raise self.error("has a key that is not text")
            parent.key = value
        else:
            self.put(parent.value, parent.key, value)
            parent.key = None

    def put(self, mapping: dict[str, Any], key: str, value: Any) -> None:
        if key not in mapping:
            mapping[key] = value
        elif isinstance(mapping[key], dict) and isinstance(value, dict):
            mapping[key] = self.merged(mapping[key], value)
        else:
            raise self.error(f"has `{key}` twice; keep one of them")

    def merged(self, first: dict[str, Any], second: dict[str, Any]) -> dict[str, Any]:
        both = dict(first)
        for key, value in second.items():
            self.put(both, key, value)
        return both

    def error(self, what: str) -> ConfigError:
        return ConfigError(f"{self.origin}: {what} (line {self.line}).")


def _document(events: Iterable[yaml.Event], origin: str) -> Any:
    import yaml

    reader = _Reader(origin)
    for event in events:
        if event.start_mark is not None:
            reader.line = event.start_mark.line + 1
        if isinstance(event, yaml.CollectionStartEvent):
            empty: Any = {} if isinstance(event, yaml.MappingStartEvent) else []
            reader.opened.append(_Collection(empty, event.anchor))
            if len(reader.opened) > MAX_DEPTH:
                raise reader.error(f"is nested more than {MAX_DEPTH} deep")
        elif isinstance(event, yaml.CollectionEndEvent):
            done = reader.opened.pop()
            reader.take(_inherited(done.value), done.size, done.anchor)
        elif isinstance(event, yaml.ScalarEvent):
            parent = reader.opened[-1] if reader.opened else None
            is_key = parent and isinstance(parent.value, dict) and parent.key is None
            is_text = is_key or event.style in ("'", '"') or event.tag == _STRING_TAG
            reader.take(event.value if is_text else scalar(event.value), 1, event.anchor)
        elif isinstance(event, yaml.AliasEvent):
            if event.anchor not in reader.anchors:
                raise reader.error(f"names `*{event.anchor}`, which is not defined")
            reader.take(*reader.anchors[event.anchor], None)
    return reader.document


def _inherited(value: dict[str, Any] | list[Any]) -> dict[str, Any] | list[Any]:
    """With what YAML's merge key brings in, where the mapping has one."""
    if isinstance(value, dict) and isinstance(value.get("<<"), dict):
        return {**value.pop("<<"), **value}
    return value
