# SPDX-License-Identifier: BSD-3-Clause
"""What a figure shows, and how far it is from what is expected of it."""
import dataclasses

from paper.runs import ROOT, read_csv


@dataclasses.dataclass
class Comparison:
    figure: str
    quantity: str  # with its unit
    expected: float
    got: float
    bound: float  # of the difference
    relative: bool = False  # the difference is a share of the expected value
    digits: int = 6  # of both values in the table; 0: the value is the difference

    @property
    def difference(self):
        return (self.got - self.expected) / (self.expected if self.relative else 1)

    @property
    def holds(self):
        return abs(self.difference) <= self.bound  # also false for NaN

    def cells(self):
        """The row of the table. What rounding alone leaves differs between processors: it is not written out."""
        share = " of it" if self.relative else ""
        rounding = self.bound / 100
        difference = f"{self.difference:.1e}" if abs(self.difference) > rounding or self.bound == 0 else f"< {rounding:.0e}"
        got = f"{self.got:.{self.digits}g}" if self.digits else difference
        return (self.figure, self.quantity, f"{self.expected:.{self.digits or 1}g}", got, difference + share, f"{self.bound:.0e}" + share)


@dataclasses.dataclass
class Figure:
    name: str
    columns: tuple
    rows: list  # of numbers, as the columns
    marks: list  # (x, y) that are expected
    comparisons: list


def reference(name):
    """A table of tests/data/acoustics; its cells are numbers where they can be."""
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    return [{key: value(text) for key, text in row.items()} for row in read_csv(ROOT / "tests/data/acoustics" / name)]


def greatest_difference(figure, quantity, pairs, bound, relative=False):
    """Of many pairs (expected, got) the one that differs most, as the difference itself against 0."""
    differences = [got / expected - 1 if relative else got - expected for expected, got in pairs]
    return Comparison(figure, f"{quantity}, greatest {'relative ' if relative else ''}difference of {len(differences)}", 0,
                      max(map(abs, differences)), bound, digits=0)
