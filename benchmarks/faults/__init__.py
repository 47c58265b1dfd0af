"""A campaign that harms recordings and kills writers: `python -m benchmarks.faults`."""
