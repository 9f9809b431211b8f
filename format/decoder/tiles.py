"""Sums."""


def sum_of(values):
    """In their order, in f64."""
    total = 0.0
    for value in values:
        total = total + value
    return total
