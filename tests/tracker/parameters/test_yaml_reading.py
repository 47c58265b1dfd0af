import math

import pytest

from tracker.errors import ConfigError
from tracker.parameters.yaml_reading import MAX_BYTES, MAX_DEPTH, parse_yaml, read_yaml, scalar


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("2e-3", 0.002),
        ("4E+2", 400.0),
        ("3.", 3.0),
        (".25", 0.25),
        ("-7", -7),
        ("+7", 7),
        ("0x1C", 28),
        ("-0x1c", -28),
        ("017", 15),
        ("08", 8.0),
        ("0x1p3", 8.0),
        ("Infinity", math.inf),
        ("-.inf", -math.inf),
        ("9223372036854775807", 2**63 - 1),
        ("9223372036854775808", 2.0**63),
        ("y", True),
        ("Off", False),
        ("oFF", "oFF"),
        ("1_000", "1_000"),
        ("1e999", "1e999"),
        ("0b11", "0b11"),
        ("12:30", "12:30"),
        ("2031-02-03", "2031-02-03"),
        ("~", None),
        ("", None),
    ],
)
def test_scalars_have_the_types_that_rcl_gives_them(text, value):
    got = scalar(text)
    assert got == value
    assert type(got) is type(value)


def test_quoted_and_tagged_texts_stay_texts():
    document = parse_yaml("{a: '5', b: \"yes\", c: !!str 1e3, d: .nan}", "x")
    assert (document["a"], document["b"], document["c"]) == ("5", "yes", "1e3")
    assert math.isnan(document["d"])


def test_a_section_that_stands_twice_is_merged_and_a_value_refused():
    assert parse_yaml("a: {b: 1}\na: {c: 2}\n", "x") == {"a": {"b": 1, "c": 2}}
    with pytest.raises(ConfigError, match=r"x: has `b` twice; keep one of them \(line 4\)"):
        parse_yaml("a:\n  b: 1\n  c: 2\n  b: 1\n", "x")
    with pytest.raises(ConfigError, match="has `b` twice"):
        parse_yaml("a: {b: 1}\na: {b: 1}\n", "x")


def test_aliases_stand_for_what_they_name():
    text = "base: &base {x: 1, y: 2}\nother: {<<: *base, y: 3}\nlist: [*base]\n"
    document = parse_yaml(text, "x")
    assert document["other"] == {"x": 1, "y": 3}
    assert document["list"] == [{"x": 1, "y": 2}]


def test_aliases_that_multiply_are_refused():
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 12)]
    with pytest.raises(ConfigError, match="holds more than 100000 values, aliases counted"):
        parse_yaml("\n".join(lines), "x")


@pytest.mark.parametrize("text", ["*a", "&a [*a]"], ids=["unknown", "itself"])
def test_an_alias_of_nothing_is_refused(text):
    with pytest.raises(ConfigError, match=r"names `\*a`, which is not defined"):
        parse_yaml(text, "x")


@pytest.mark.parametrize("opening", ["[", "{a: ", "- "], ids=["lists", "mappings", "blocks"])
def test_nesting_is_bounded(opening):
    with pytest.raises(ConfigError, match=f"is nested more than {MAX_DEPTH} deep"):
        parse_yaml(opening * (MAX_DEPTH + 1), "x")
    with pytest.raises(ConfigError, match="nest"):  # or by libyaml itself
        parse_yaml(opening * 100_000, "x")


def test_a_file_that_is_too_large_is_not_read(tmp_path):
    path = tmp_path / "large.yaml"
    path.write_text("a: 1\n" * (MAX_BYTES // 4))
    with pytest.raises(ConfigError, match=r"large\.yaml: is larger than 1 MB"):
        read_yaml(path)


def test_a_mark_of_byte_order_is_passed_over(tmp_path):
    path = tmp_path / "marked.yaml"
    path.write_bytes(b"\xef\xbb\xbfa: 1\n")
    assert read_yaml(path) == {"a": 1}


@pytest.mark.parametrize("text", ["@x", "[", "a: b: c", "? [a]\n: b"])
def test_what_is_no_yaml_is_one_line(text):
    with pytest.raises(ConfigError) as caught:
        parse_yaml(text, "-p speed")
    assert str(caught.value).startswith("-p speed: ")
    assert "\n" not in str(caught.value)
