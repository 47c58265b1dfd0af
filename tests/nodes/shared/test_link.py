import pytest

from nodes.shared.link import Link


@pytest.mark.parametrize(
    ("link", "silence"),
    [
        (Link(0), ", which has no publisher"),
        (Link(0, refusal="2 were refused"), "; 2 were refused"),
        (Link(1), "; 1 publisher connected"),
        (Link(3, loss="all was lost"), "; 3 publishers connected, but all was lost"),
        (Link(1, "1 was refused"), "; 1 publisher connected, but 1 was refused"),
    ],
    ids=["nobody", "refused alone", "connected", "lost", "refused beside another"],
)
def test_silence_is_told_by_what_the_wire_knows(link, silence):
    assert link.silence == silence
