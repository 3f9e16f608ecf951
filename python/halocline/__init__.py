# SPDX-License-Identifier: BSD-3-Clause
r"""Halocline in Python: logs as NumPy arrays, paths of sound, link budgets.

    import halocline
    log = halocline.read_log("results/seamount/seamount.lcm", channels=r"STATE\..*|OUTCOME")
    log["state"]["position_ned_m"]                 # metres, one row a message
    link = halocline.link("scenarios/seamount.toml", "auv-1", "auv-2")
    link.budget["snr_db"], link.paths["delay_s"]
    paths = halocline.arrivals(30, 50, 2000, sound_speed_mps=1500, bottom_depth_m=100).paths

Names and units are those of `halocline log export`, `halocline link --json` and `halocline arrivals --format json`, which compute
the same. What is wrong with an argument or a file is a ValueError whose text names the place and what is allowed.

The modules that lcm-gen makes of Halocline's message types form a package of this name as well. Where both are on the path, this
one first, it has their types too: halocline.vehicle_state_t.
"""
from __future__ import annotations

import importlib
import json
import os
import pathlib
import pkgutil
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Union

import numpy as np

from . import _halocline

__all__ = ["Arrivals", "Link", "arrivals", "link", "names_of", "read_log"]

Path = Union[str, "os.PathLike[str]"]
Place = Union[str, Sequence[float]]
Table = dict[str, np.ndarray]

__path__ = pkgutil.extend_path(__path__, __name__)
for _folder in __path__[1:]:
    for _file in sorted(pathlib.Path(_folder).glob("*_t.py")):
        globals()[_file.stem] = getattr(importlib.import_module(f".{_file.stem}", __name__), _file.stem)

# What is known of every path, also where there is none.
_PATH_COLUMNS = ("delay_s", "amplitude", "phase_deg", "launch_angle_deg", "arrival_angle_deg", "n_surface", "n_bottom", "n_caustic",
                 "path_length_m", "absorption_db", "surface_loss_db", "bottom_loss_db", "diffuse")


@dataclass(frozen=True)
class Arrivals:
    """The paths of sound of one link.

    paths    arrays of equal length, by delay: delay_s, amplitude (pressure re that at 1 m, without absorption), phase_deg,
             launch_angle_deg and arrival_angle_deg (positive down), n_surface, n_bottom, n_caustic, path_length_m,
             absorption_db, surface_loss_db, bottom_loss_db, diffuse; with modems also level_db (re 1 uPa), doppler_factor
    summary  the rest: solver, shadow, transmission_loss_db, first_delay_s, mean_delay_s, rms_delay_spread_s, ...; without a
             path its cause instead
    """

    paths: Table
    summary: dict[str, Any]

    def __len__(self) -> int:
        """The number of paths."""
        return len(self.paths["delay_s"])


@dataclass(frozen=True)
class Link:
    """One link of a scenario.

    budget    numbers by their names with units: range_m, delay_s, transmission_loss_db, snr_db, delivery_probability, ...; delivery_low and delivery_high
              are its 10 and 90 % over the hours of a slow sea
    arrivals  the paths, as the modems at both ends receive them
    notes     formulas that were taken beyond the range they were published for
    """

    budget: dict[str, Any]
    arrivals: Arrivals
    notes: list[str] = field(default_factory=list)

    @property
    def paths(self) -> Table:
        """The arrays of the paths: arrivals.paths."""
        return self.arrivals.paths


def read_log(paths: Path | Sequence[Path], channels: str = "") -> dict[str, Table]:
    """The messages of an LCM log, or of the parts of one in order, as arrays.

    channels is a regular expression (of RE2) for the whole name of a channel; empty: all. The result has a table for each
    channel family ("state", "outcome", ...), with a row for each message and the columns event (its number in the log), stamp_us,
    channel and the fields of its type (docs/messages.md): integers as int64, others as float64, texts as str. A field of fixed
    size has the shape (rows, size). A list is an array of objects, one array a row; a field of the messages in a list likewise,
    under "peers.snr_db"; bytes are bytes. What is damaged in the log is a warning.
    """
    names = [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
    tables, damage = _halocline.read_log([os.fspath(name) for name in names], channels)
    if damage:
        warnings.warn(damage.rstrip("\n"), stacklevel=2)
    return tables


def names_of(family: str, column: str) -> list[str]:
    """The names of an enumeration's values 0, 1, 2, ...: names_of("outcome", "outcome")[0] is "received"."""
    return _halocline.names_of(family, column)


def link(scenario: Path, source: Place, receiver: Place, overrides: Sequence[str] = (),
         source_velocity: Sequence[float] = (0, 0, 0), receiver_velocity: Sequence[float] = (0, 0, 0),
         ensemble: int = 20) -> Link:
    """The budget and the paths of one link, as `halocline link` has them.

    source and receiver are vehicles of the scenario (where they start, with their modems) or positions (north, east, down) in
    metres; velocities, for Doppler, are in m/s, north, east, down. overrides are "section.key=value". With ensemble above 0, a number of
    seas drawn from [uncertainty], budget["ensemble"] has 10, 50 and 90 % of received_level_db, snr_db and delivery_probability.
    """
    budget, paths, notes = _halocline.link(os.fspath(scenario), _place(source), _place(receiver), list(overrides),
                                           _vector(source_velocity), _vector(receiver_velocity), ensemble)
    return Link(json.loads(budget), _arrivals(paths), notes)


def arrivals(source_depth_m: float, receiver_depth_m: float, range_m: float, *, solver: str = "auto",
             water: Path | None = None, latitude: float | None = None, longitude: float | None = None,
             sound_speed_mps: float | None = None, bottom: Path | None = None,
             bottom_depth_m: float | None = None, sediment: str | None = None, bottom_density_ratio: float | None = None,
             bottom_sound_speed_mps: float | None = None, bottom_attenuation_db: float | None = None,
             crease_angle_deg: float | None = None, surface: str | None = None, wind_mps: float | None = None,
             absorption: str | None = None, frequency_khz: float | None = None, temperature_degc: float | None = None,
             salinity_psu: float | None = None, ph: float | None = None, max_launch_angle_deg: float | None = None,
             steep_direct: bool | None = None, max_bounces: int | None = None, min_boundary_factor: float | None = None,
             min_amplitude_db: float | None = None, diffuse_below_db: float | None = None) -> Arrivals:
    """The paths of sound through a sea given by numbers and tables, as `halocline arrivals` finds them.

    solver is auto, images, snell or arcs. The sea is given by the options of that command (`halocline arrivals --help`); None is
    their default. water and bottom name files, water also a built-in profile; latitude and longitude, degrees, are the place
    in a grid of water.
    """
    sea = {name: os.fspath(value) if isinstance(value, os.PathLike) else value for name, value in locals().items()
           if name not in ("source_depth_m", "receiver_depth_m", "range_m", "solver") and value is not None}
    return _arrivals(_halocline.arrivals(source_depth_m, receiver_depth_m, range_m, solver, **sea))


def _vector(values: Sequence[float]) -> tuple[float, float, float]:
    vector = tuple(float(value) for value in values)
    if len(vector) != 3:
        raise ValueError(f"{values!r} has {len(vector)} numbers; allowed are three: north, east, down")
    return vector


def _place(place: Place) -> str:
    return place if isinstance(place, str) else ",".join(map(repr, _vector(place)))


def _arrivals(text: str) -> Arrivals:
    summary = json.loads(text)[0]
    rows = summary.pop("paths")
    names = tuple(rows[0]) if rows else _PATH_COLUMNS
    return Arrivals({name: np.array([row[name] for row in rows], dtype=float) for name in names}, summary)
