# SPDX-License-Identifier: BSD-3-Clause
"""Scenarios of vehicles at rest, run by `halocline run`, and what the channel server published in them."""
import csv
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


class Refusal(Exception):
    """Something that the user has to change."""


class Runs:
    """Runs scenarios with `program` in `folder`; `changes`: keys that are set in all of them, section.key=value."""

    def __init__(self, program, folder, changes=()):
        self._program, self._folder, self._changes = program, folder, changes

    def messages(self, name, scenario, channels, changes=()):
        """The rows that `halocline log export` makes of these channels (a regular expression), by family of channels."""
        folder = self._folder / name
        folder.mkdir()
        file, log = folder / f"{name}.toml", folder / "run.lcm"
        file.write_text(scenario)
        sets = [word for change in (*changes, *self._changes) for word in ("--set", change)]
        self._call("run", file, *sets, "--log", log, "--out", folder, "--no-csv", "--no-report", "--quiet", "--log-level", "error")
        self._call("log", "export", log, "--out", folder / "csv", "--channel", channels)
        return {file.stem: read_csv(file) for file in (folder / "csv").glob("*.csv")}

    def links(self, name, scenario, changes=()):
        """The last row of LINKS for each pair of vehicles, however quiet, by (id of transmitter, id of receiver), after three seconds."""
        rows = self.messages(name, scenario, r"LINKS\..*", (*changes, "scenario.duration_s=3", 'channel_server.reach="none"'))["links"]
        return {(int(row["peers.transmitter_id"]), int(row["peers.receiver_id"])): Link(row) for row in rows}

    def _call(self, *arguments):
        done = subprocess.run([self._program, *arguments], capture_output=True, text=True)
        if done.returncode != 0:
            raise Refusal(f"halocline {arguments[0]}: {done.stderr.strip()}")


class Link:
    """A row of a link table; its numbers by name: link["delay_s"]."""

    def __init__(self, row):
        self._row = row

    def __getitem__(self, name):
        return float(self._row["peers." + name])


def read_csv(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def vehicle(number, north_m, depth_m, **modem):
    keys = "".join(f"{key} = {value!r}\n" for key, value in modem.items())
    return (f'[[vehicle]]\nname = "at-{number}"\nid = {number}\nmodel = "fixed"\nstart_ned_m = [{north_m!r}, 0.0, {depth_m!r}]\n'
            + ("[vehicle.modem]\n" + keys if keys else ""))


def traffic(start_s, destination):
    """The one packet that the vehicle above it sends."""
    return f'[vehicle.traffic]\nperiod_s = 100\nstart_s = {start_s}\ndestination = "at-{destination}"\npayload_bytes = 8\n'
