"""Which parameters are searched, and where? The ranges stand in `tracker.config`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from tracker.config import Config, Search, parameter_search
from tracker.errors import ConfigError

if TYPE_CHECKING:
    from optuna import Trial

#: Searched where nothing else is asked for; the methods are a decision of their own.
DEFAULT_KINDS = ("process", "measurement", "clutter", "life")


def tunable() -> dict[str, Search]:
    """Every parameter that can be searched, in the configuration's order."""
    searches = {name: parameter_search(name) for name in Config.model_fields}
    return {name: search for name, search in searches.items() if search is not None}


def choose_parameters(words: Sequence[str]) -> tuple[str, ...]:
    """The parameters that are meant, in the configuration's order.

    Args:
        words: Names, and kinds (process, measurement, clutter, life, method) for all of a kind.

    Raises:
        ConfigError: A word is neither; the message names those there are.
    """
    searches = tunable()
    kinds = list(dict.fromkeys(search.kind for search in searches.values()))
    for word in words:
        if word not in searches and word not in kinds:
            raise ConfigError(
                f"`{word}` cannot be tuned; there are the kinds {', '.join(sorted(kinds))} and "
                f"the parameters {', '.join(searches)}."
            )
    return tuple(
        name for name, search in searches.items() if name in words or search.kind in words
    )


def suggest(trial: Trial, names: Sequence[str]) -> dict[str, Any]:
    """Values that the study wants tried."""
    return {name: _suggest(trial, name) for name in names}


def within_search(name: str, value: Any) -> bool:
    """Whether the search can come upon a value."""
    search = tunable()[name]
    return search.low == search.high or search.low <= value <= search.high


def _suggest(trial: Trial, name: str) -> Any:
    search = tunable()[name]
    kind = Config.model_fields[name].annotation
    if kind is float:
        return trial.suggest_float(name, search.low, search.high, log=search.log)
    if kind is int:
        return trial.suggest_int(name, int(search.low), int(search.high), log=search.log)
    return trial.suggest_categorical(name, kind.__args__)  # type: ignore[union-attr]
