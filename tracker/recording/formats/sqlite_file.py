"""How are rosbag2's databases read? Row by row in log-time order, past damaged pages."""

from __future__ import annotations

import sqlite3
from collections import Counter
from collections.abc import Collection, Iterator
from contextlib import suppress
from pathlib import Path
from urllib.parse import quote

from tracker.errors import RecordingError
from tracker.recording.formats.damage import Damage
from tracker.recording.formats.unpacking import DamagedError, unpack_message
from tracker.recording.sources import RawMessage, topics_of, unreadable

_REMEDY = (
    "Is it a rosbag2 database? If it is damaged, repair it with "
    "`sqlite3 old.db3 .recover | sqlite3 new.db3`."
)
_ROWS = "SELECT id, topic_id, timestamp FROM messages WHERE id BETWEEN ? AND ?"

#: A row takes more bytes of the file than this, so that there are fewer rows.
_SMALLEST_ROW_BYTES = 16


#: So many failing queries are made to find what lies between damaged rows.
_MOST_FAILURES = 20_000


class SqliteSource:
    """A .db3 file, whole or damaged.

    Args:
        path: The file.

    Raises:
        RecordingError: Nothing of it can be read.
    """

    kind = "ROS 2 recording"

    def __init__(self, path: Path) -> None:
        self._path = path
        self.notes = _notes(path)
        try:
            address = f"file:{quote(str(path.resolve()))}?mode=ro&immutable=1"
            self._database = sqlite3.connect(address, uri=True, check_same_thread=False)
        except sqlite3.Error as error:
            raise unreadable(path, error, _REMEDY) from error
        try:
            self._read_topics()
        except sqlite3.Error as error:
            self.close()
            raise unreadable(path, error, _REMEDY) from error
        except RecordingError:
            self.close()
            raise

    def messages(self, topics: Collection[str]) -> Iterator[RawMessage]:
        """As `Source.messages`."""
        wanted = {key for key, (topic, _) in self._topic_of.items() if topic in topics}
        damage, read = Damage(), Counter[str]()
        for place_ns, reason in self._damages:
            damage.add(place_ns, reason)
        for log_ns, row, key in self._rows:
            if key not in wanted:
                continue
            topic, type_name = self._topic_of[key]
            try:
                data = unpack_message(self._data(row))
            except (sqlite3.Error, DamagedError) as error:
                damage.add(log_ns, str(error))
                continue
            read[topic] += 1
            yield RawMessage(topic, type_name, log_ns, data)
        counted = {topic: info.count for topic, info in self.topics.items() if topic in topics}
        damage.tell(self._path, self.start_ns, counted, read)

    def close(self) -> None:
        """As `Source.close`."""
        self._database.close()

    def _read_topics(self) -> None:
        self._database.text_factory = lambda text: text.decode("utf-8", "replace")
        # Else SQLite refuses a file that lost its end as a whole.
        self._database.execute("PRAGMA writable_schema = ON")
        named = self._database.execute("SELECT id, name, type FROM topics").fetchall()
        self._topic_of = {key: (str(name), str(type_name)) for key, name, type_name in named}
        self._damages: list[tuple[int, str]] = []
        found, counts = [], Counter[int]()
        for row, key, log_ns in self._listed(*self._range()):
            if key in self._topic_of and isinstance(log_ns, int) and log_ns >= 0:
                found.append((log_ns, row, key))
                counts[key] += 1
            else:
                self._note("a row is invalid")
        self._rows = sorted(found)
        if self._damages and not found:
            raise unreadable(self._path, self._damages[0][1], _REMEDY)
        self.start_ns = self._rows[0][0] if found else 0
        self.end_ns = self._rows[-1][0] if found else 0
        self._damages = [(self.start_ns, reason) for _, reason in self._damages]
        self.topics = topics_of((*self._topic_of[key], counts[key]) for key in self._topic_of)

    def _range(self) -> tuple[int, int]:
        """The smallest and the largest number of a row, or what surely encloses them."""
        try:
            first, last = self._database.execute(
                "SELECT min(id), max(id) FROM messages"
            ).fetchone()
        except sqlite3.DatabaseError:
            return 1, self._path.stat().st_size // _SMALLEST_ROW_BYTES
        return (1, 0) if first is None else (first, last)

    def _listed(self, first: int, last: int) -> Iterator[tuple[int, int, int]]:
        """The rows in a range of numbers; a range that fails is halved, down to single rows."""
        ranges, failures = [(first, last)], 0
        while ranges and failures < _MOST_FAILURES:
            low, high = ranges.pop()
            seen = low - 1
            try:
                for row, key, log_ns in self._database.execute(_ROWS, (low, high)):
                    if not seen < row <= high:  # damaged pages lead back to others
                        raise sqlite3.DatabaseError("rows are out of order")
                    seen = row
                    yield row, key, log_ns
            except sqlite3.DatabaseError as error:
                low, failures = seen + 1, failures + 1
                if low >= high:
                    self._note(str(error))
                    continue
                middle = (low + high) // 2
                ranges += [(middle + 1, high), (low, middle)]

    def _note(self, reason: str) -> None:
        if not self._damages or self._damages[-1][1] != reason:
            self._damages.append((0, reason))

    def _data(self, row: int) -> bytes:
        found = self._database.execute("SELECT data FROM messages WHERE id = ?", (row,)).fetchone()
        if found is None or not isinstance(found[0], bytes):
            raise DamagedError("a row holds no message")
        return found[0]


def _notes(path: Path) -> list[str]:
    log = path.with_name(f"{path.name}-wal")
    with suppress(OSError):
        if log.stat().st_size:
            return [
                f"{path}: its last messages are still in {log.name} and are not read; "
                f"`sqlite3 {path.name} 'PRAGMA wal_checkpoint'` moves it into the database."
            ]
    return []
