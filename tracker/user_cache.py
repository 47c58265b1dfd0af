"""Where may this program keep what takes long to get, such as models and machine code?"""

from pathlib import Path


def user_cache() -> Path | None:
    """A folder, which need not be there yet; None for a user without a home."""
    import platformdirs

    folder = platformdirs.user_cache_path("raised-hand-tracker", appauthor=False)
    return folder if folder.is_absolute() else None  # `~` stays where nobody knows the home
