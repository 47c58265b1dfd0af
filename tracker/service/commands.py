"""Which commands change the waiting list?"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from tracker.errors import ConfigError
from tracker.wording import shown


class Verb(str, Enum):
    """The kinds of commands; the values are their words."""

    SERVE = "serve"
    SERVED = "served"
    WAIT = "wait"
    RELEASE = "release"
    IGNORE = "ignore"
    CLEAR = "clear"


#: Commands that make sense without a number: `release` then means the selected customer.
_WITHOUT_NUMBER = (Verb.RELEASE, Verb.CLEAR)


@dataclass(frozen=True, slots=True)
class Command:
    """One command.

    Attributes:
        verb: What should happen.
        caller_id: To whom, by the number on the list; None for `clear`, and for `release` of the
            selected customer.
    """

    verb: Verb
    caller_id: int | None = None

    def __str__(self) -> str:
        return self.verb.value + ("" if self.caller_id is None else f" {self.caller_id}")

    @staticmethod
    def parse(text: str) -> Command:
        """Read a command as `serve 3` or `clear`.

        Raises:
            ConfigError: There is no such command, or its number is missing or none.
        """
        words = text.split()
        verbs = {verb.value: verb for verb in Verb}
        verb = verbs.get(words[0].lower()) if words else None
        if verb is None:
            raise ConfigError(
                f"{shown(text)} is not a command; commands are {', '.join(verbs)}, for example "
                "`serve 3`."
            )
        numbers = words[1:]
        if len(numbers) > 1 or (numbers and verb is Verb.CLEAR):
            raise ConfigError(
                f"{shown(text)} has too many words; a command has at most one number."
            )
        if not numbers:
            if verb not in _WITHOUT_NUMBER:
                raise ConfigError(
                    f"`{verb.value}` needs a customer's number, as `{verb.value} 3`."
                )
            return Command(verb)
        if not (numbers[0].isascii() and numbers[0].isdigit() and len(numbers[0]) <= 18):
            raise ConfigError(f"{shown(numbers[0])} is not a customer's number, such as 3.")
        return Command(verb, int(numbers[0]))


@dataclass(frozen=True, slots=True)
class Answer:
    """What a command led to.

    Attributes:
        is_done: Whether it was followed; asking for what is so already counts as done.
        text: What happened, or why not, in words.
    """

    is_done: bool
    text: str
