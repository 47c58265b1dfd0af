"""Which raised hands are found in pictures, and which are invented? Rendered scenes and photos."""
