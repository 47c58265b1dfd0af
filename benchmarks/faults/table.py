"""The verdicts by kind, as the table that is printed and stands in the documentation."""

from __future__ import annotations

from dataclasses import dataclass, field

from benchmarks.faults.attempt import LIMIT_BYTES, Outcome

_HEAD = (
    "kind", "attempts", "read whole", "read in part", "refused", "tracebacks", "most memory",
    "lost outside the damage",
)  # fmt: skip


@dataclass
class Row:
    """What came of the attempts on one kind.

    Attributes:
        kind: Its name.
        note: Why it was not run; empty where it was.
        findings: What violates the promises, each with how it came about.
    """

    kind: str
    note: str = ""
    findings: list[str] = field(default_factory=list)
    tries: int = 0
    whole: int = 0
    part: int = 0
    refused: int = 0
    crashes: int = 0
    lost: int | None = None
    peak_bytes: int = 0

    def add(
        self,
        outcome: Outcome,
        expected: set[tuple[str, int]],
        lost: int | None,
        how: str,
        *,
        must_say: bool,
    ) -> None:
        """Take in an attempt on a harmed recording.

        Args:
            outcome: What came of it.
            expected: The messages of the whole recording.
            lost: How many outside the damage were not read; None where that cannot be told.
            how: What was done to it.
            must_say: Something has to be said.
        """
        self.tries += 1
        self.peak_bytes = max(self.peak_bytes, outcome.peak_bytes)
        found = set(outcome.keys)
        if outcome.crash:
            self.crashes += 1
            self.findings.append(f"{how}: {outcome.crash}")
        elif expected <= found and found:
            self.whole += 1
        elif found:
            self.part += 1
        else:
            self.refused += 1
        if outcome.peak_bytes > LIMIT_BYTES:
            self.findings.append(f"{how}: {outcome.peak_bytes / 1e9:.2f} GB")
        if lost is not None:
            self.lost = (self.lost or 0) + lost
            if lost and not outcome.crash:
                what = f"{lost} messages lost outside the damage"
                self.findings.append(f"{how}: {what} ({outcome.said})")
        if must_say and not outcome.said and not outcome.crash:
            self.findings.append(f"{how}: no message about it")

    def judge(self, wrong: str, how: str) -> None:
        """Take in an attempt on a writer."""
        self.tries += 1
        self.part += not wrong
        if wrong:
            self.crashes += "Traceback" in wrong
            self.findings.append(f"{how}: {wrong}")

    @property
    def is_violated(self) -> bool:
        """A promise was broken."""
        return bool(self.findings)

    def cells(self) -> tuple[str, ...]:
        """For the table."""
        if self.note:
            return (self.kind, self.note, *[""] * (len(_HEAD) - 2))
        memory = f"{self.peak_bytes / 1e6:.0f} MB" if self.peak_bytes else "-"
        lost = "-" if self.lost is None else str(self.lost)
        counts = (self.tries, self.whole, self.part, self.refused, self.crashes)
        return (self.kind, *map(str, counts), memory, lost)


def as_text(rows: list[Row]) -> str:
    """A table in Markdown."""
    lines = [_HEAD, tuple("---" for _ in _HEAD), *(row.cells() for row in rows)]
    total = sum(row.tries for row in rows)
    table = "\n".join("| " + " | ".join(cells) + " |" for cells in lines)
    return f"{table}\n\n{total} attempts."
