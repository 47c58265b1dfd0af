"""Which parameters may change while it runs, and what the page needs to show them."""

from __future__ import annotations

from typing import Any

from tracker.config import Config, parameter_extra


def live_parameters(config: Config) -> list[dict[str, Any]]:
    """Name, value, group, unit, meaning, and choices or range of every live parameter."""
    return [
        _described(name, getattr(config, name))
        for name in Config.model_fields
        if parameter_extra(name)["live"]
    ]


def changed(config: Config, name: str, value: object) -> Config:
    """The configuration with one live parameter changed.

    Raises:
        ConfigError: There is no such parameter, it is fixed while it runs, or the value is off.
    """
    if name in Config.model_fields and not parameter_extra(name)["live"]:
        return Config.from_mapping({f"{name} (cannot change now)": value}, "dashboard")
    return config.replace(**{name: value})


def _described(name: str, value: object) -> dict[str, Any]:
    info, extra = Config.model_fields[name], parameter_extra(name)
    bounds: dict[str, float] = {}
    for item in info.metadata:
        for attribute, key in (("gt", "min"), ("ge", "min"), ("lt", "max"), ("le", "max")):
            bound = getattr(item, attribute, None)
            if bound is not None:
                bounds[key] = float(bound)
    return {
        "name": name,
        "value": value,
        "group": extra["group"],
        "unit": extra["unit"],
        "meaning": info.description,
        "choices": list(getattr(info.annotation, "__args__", ())),
        "whole": info.annotation is int,
        **bounds,
    }
