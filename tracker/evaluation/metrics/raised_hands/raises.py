"""Was every raised hand noticed, how soon, and as the same person as before?"""

from __future__ import annotations

from dataclasses import dataclass

from tracker.evaluation.metrics.raised_hands.episode_report import EpisodeReport


@dataclass(frozen=True, slots=True)
class Raises:
    """Counts over one run.

    Attributes:
        hands: Episodes of a raised hand that lasted long enough to be noticed.
        missed: Those that nothing reported.
        false: Times that a track was raised without a raised hand behind it.
        delays_s: From the hand being up to its report, of those reported.
        again: Reported episodes of people who had been reported before.
        same: Of these, those first reported under the identity the person had last.
        wrong: Of these, those first reported under an identity that stood for somebody else last.
    """

    hands: int
    missed: int
    false: int
    delays_s: tuple[float, ...]
    again: int
    same: int
    wrong: int


def count_raises(report: EpisodeReport) -> Raises:
    """Sum up what `EpisodeEvaluation` found.

    Args:
        report: Of one run.
    """
    again = same = wrong = 0
    identity_of: dict[int, int] = {}
    owner_of: dict[int, int] = {}
    for row in sorted(report.found, key=lambda row: row.reported_ns or 0):
        if row.identities and row.person in identity_of:
            first = row.identities[0]
            again += 1
            same += first == identity_of[row.person]
            is_theirs = owner_of.get(first, row.person) == row.person
            wrong += first != identity_of[row.person] and not is_theirs
        for identity in row.identities:
            identity_of[row.person] = identity
            owner_of[identity] = row.person
    return Raises(
        hands=len(report.episodes),
        missed=len(report.missed),
        false=len(report.invented),
        delays_s=tuple(row.delay_s for row in report.found if row.delay_s is not None),
        again=again,
        same=same,
        wrong=wrong,
    )
