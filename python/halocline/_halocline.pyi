# SPDX-License-Identifier: BSD-3-Clause
"""The compiled part of halocline, which wraps it: use that."""
from typing import Any

import numpy as np

# Tables by channel family, and what is damaged in the log (empty: nothing).
def read_log(paths: list[str], channels: str) -> tuple[dict[str, dict[str, np.ndarray]], str]: ...
def names_of(family: str, field: str) -> list[str]: ...

# JSON of the budget, JSON of the paths, notes.
def link(
    scenario: str,
    source: str,
    receiver: str,
    overrides: list[str],
    source_velocity: tuple[float, ...],
    receiver_velocity: tuple[float, ...],
    ensemble: int,
) -> tuple[str, str, list[str]]: ...

# JSON of the paths.
def arrivals(source_depth_m: float, receiver_depth_m: float, range_m: float, solver: str, **sea: Any) -> str: ...
