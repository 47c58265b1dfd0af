"""Lasting errors are added to the published covariance, not used in the gain (Schmidt, 1966).

With measurements h(x) + D b + v and a constant bias b, the filter errs by S b more than it
believes: S+ = (I - K H) S - K D, and P + S cov(b) S' is published. A track begins with
S = -inv(H) D, which neither prediction nor measurements with the same bias change: S cov(b) S' is
their `bias_covariance`. Where others take over, theirs comes in by the share of the position's
variance that they take out, the mean of K H over all directions. Mixing variances errs high.
"""

from __future__ import annotations

from tracker.compiling.loops import loop
from tracker.containers import FloatArray, IntArray
from tracker.tracking.association.gating import Pairs
from tracker.tracking.people import BIAS_XX, BIAS_XY, BIAS_YY, People
from tracker.tracking.sensing.claims import Claims

#: Rows of `People.spans`, and where they stand in a matrix.
BIAS = ((BIAS_XX, 0, 0), (BIAS_XY, 0, 1), (BIAS_XY, 1, 0), (BIAS_YY, 1, 1))


@loop
def consider_bias(
    people: People, before: FloatArray, chosen: IntArray, pairs: Pairs, claims: Claims
) -> None:
    """Update everybody's lasting error after a round, in place.

    Args:
        people: N people, corrected.
        before: Shape (1, N, 4, 4): their covariance before that.
        chosen: Shape (N,): row of each track's pair, or -1.
        pairs: P pairs.
        claims: M claims.
    """
    for person in range(len(chosen)):
        if chosen[person] < 0:
            continue
        left, bias = 0.0, claims.bias[pairs.claim[chosen[person]]]
        for mode in range(len(people.weight)):
            x, y = people.covariance[mode, person, 0, 0], people.covariance[mode, person, 1, 1]
            left += people.weight[mode, person] * (x + y)
        was = before[0, person, 0, 0] + before[0, person, 1, 1]
        share, spans = min(max(1.0 - left / was, 0.0), 1.0), people.spans[:, person]
        spans[BIAS_XX] += share * (bias[0, 0] - spans[BIAS_XX])
        spans[BIAS_XY] += share * (bias[0, 1] - spans[BIAS_XY])
        spans[BIAS_YY] += share * (bias[1, 1] - spans[BIAS_YY])
