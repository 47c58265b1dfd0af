"""What do the figures of a trial mean? Words with units, for tables and plots.

The keys are those of `Study.rows`, and the columns of trials.csv and trials.parquet.
"""

from __future__ import annotations

_WORDS = {
    "mse_m2": "mean squared error of the position (m²)",
    "bound_m2": "Cramer-Rao bound of that (m²)",
    "final_error_m": "error at the end (m)",
    "final_nees": "NEES at the end (ideal 4)",
    "mean_nees": "NEES over time (ideal 4)",
    "wrong_share": "wrong measurements (share)",
    "swapped_share": "people taken for each other (share)",
    "lost_share": "people lost (share)",
    "gospa_m": "GOSPA (m)",
    "gospa_localisation": "GOSPA: error of places (m²)",
    "gospa_missed": "GOSPA: people missed (m²)",
    "gospa_false": "GOSPA: false tracks (m²)",
    "ospa_m": "OSPA (m)",
    "missed_share": "people missed (share)",
    "false_tracks": "false tracks in a frame",
    "identity_switches_per_min": "identity switches a minute",
    "track_purity": "track purity (share)",
    "rmse_m": "RMSE of found people (m)",
    "nees_position": "NEES of the position (ideal 2)",
    "covered_share": "inside the 95 % ellipse (share)",
    "time_to_raise_s": "time until a raise is told (s)",
    "hands": "raised hands",
    "missed_raises": "missed raises",
    "false_raises": "false raises",
    "raised_again": "raised again",
    "same_identity": "raised again: same identity",
    "wrong_identity": "raised again: somebody else's",
}


def trial_words(name: str) -> str:
    """A figure's name for readers; its own where it is unknown."""
    return _WORDS.get(name, name)
