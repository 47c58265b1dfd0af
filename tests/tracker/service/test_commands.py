import pytest

from tracker.errors import ConfigError
from tracker.service import Command, Verb


@pytest.mark.parametrize("verb", [verb for verb in Verb if verb is not Verb.CLEAR])
def test_a_command_is_read_as_it_is_written(verb):
    assert Command.parse(str(Command(verb, 12))) == Command(verb, 12)


def test_release_and_clear_need_no_number():
    assert Command.parse(" Release ") == Command(Verb.RELEASE)
    assert Command.parse("clear") == Command(Verb.CLEAR)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "is not a command"),
        ("fetch 3", "commands are serve, served, wait, release, ignore, clear"),
        ("serve", "needs a customer's number, as `serve 3`"),
        ("serve three", "'three' is not a customer's number"),
        ("serve -1", "is not a customer's number"),
        ("serve 1 2", "too many words"),
        ("clear 1", "too many words"),
    ],
)
def test_what_is_no_command_is_refused_with_the_reason(text, reason):
    with pytest.raises(ConfigError, match=reason):
        Command.parse(text)
