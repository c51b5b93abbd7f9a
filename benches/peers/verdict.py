"""What is said of a distance, beside the exact one."""

import math
from decimal import Decimal, getcontext
from fractions import Fraction

getcontext().prec = 60

# Above this relative error an answer is printed bold: what no rounding of f32 explains.
WRONG = 1e-5


def root(squared: Fraction) -> Decimal:
    return (Decimal(squared.numerator) / Decimal(squared.denominator)).sqrt()


def of(distance, squared):
    """'exact' to the nearest double, a relative error, or in bold what is wrong."""
    if not math.isfinite(distance) or distance < 0:
        return f"**{distance:g}**"
    if squared == 0:
        return "exact" if distance == 0 else f"**{distance:.2g} for 0**"
    if distance == 0:
        return "**0**"
    truth = root(squared)
    if distance == float(truth):
        return "exact"
    error = abs(float(Decimal(distance) / truth - 1))
    return f"{error:.1e}" if error <= WRONG else f"**{error:.2g}**"
