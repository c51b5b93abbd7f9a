"""Choices of the laboratory, to measure what they cost: how candidates are found, and solvers that can miss contacts.

    query = nearmiss.research.configure(nearmiss.Continuous(), solver="cubic-f64", broad_phase="tree")
    answer = detector.query(query)

The defaults are the fastest that were measured. No choice except the solver changes an answer.
"""

from ._native import configure

__all__ = ["configure"]
