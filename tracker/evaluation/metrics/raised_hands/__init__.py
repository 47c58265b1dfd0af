"""Was every raised hand reported, how soon, and as whom? Rows per raise, and their totals."""
