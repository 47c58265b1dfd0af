"""What is each number of a trial called in tables and plots? In words, with its unit."""

from __future__ import annotations

ROW_NAMES = {
    # Filter scenarios and known people.
    "mse_m2": "mean squared position error (m²)",
    "bound_m2": "Cramer-Rao bound, squared (m²)",
    "final_error_m": "position error at the end (m)",
    "final_nees": "NEES at the end (ideal 4)",
    "mean_nees": "NEES over time (ideal 4)",
    "wrong_share": "wrong measurements, share",
    "swapped_share": "people swapped, share",
    "lost_share": "people lost, share",
    # The whole tracker, by the names of `metrics.scores.score_trial`.
    "gospa_m": "GOSPA (m)",
    "gospa_localisation": "GOSPA, localisation (m²)",
    "gospa_missed": "GOSPA, missed (m²)",
    "gospa_false": "GOSPA, false (m²)",
    "ospa_m": "OSPA (m)",
    "missed_share": "missed share of people",
    "false_tracks": "false tracks in a frame",
    "identity_switches_per_min": "identity switches a minute",
    "track_purity": "track purity, share",
    "rmse_m": "RMSE of found people (m)",
    "nees_position": "NEES of the position (ideal 2)",
    "covered_share": "inside the 95 % ellipse, share",
    "time_to_raise_s": "time to raise (s)",
    "hands": "raised hands",
    "missed_raises": "missed raises",
    "false_raises": "false raises",
    "raised_again": "hands raised again",
    "same_identity": "raised again: same identity",
    "wrong_identity": "raised again: somebody else's",
}
