"""Who is a track: births, duplicates, deaths, and streaks of raised hands."""
