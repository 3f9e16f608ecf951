#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests the Python package against the halocline command: tests/python/package_test.py BIN

BIN has the programs; PYTHONPATH leads to the package of the same build.
"""
import ast
import contextlib
import csv
import inspect
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import warnings

import numpy as np

import halocline
from halocline import _halocline

TREE = pathlib.Path(__file__).resolve().parents[2]
SCENARIO = TREE / "scenarios/harbour.toml"
BIN = pathlib.Path(sys.argv.pop(1))
FLOAT32 = set(re.findall(r"^\s*float\s+(\w+)", "".join(p.read_text() for p in TREE.glob("lcmtypes/*.lcm")), re.M))


def command(*arguments):
    done = subprocess.run([BIN / "halocline", *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, done.args))}: {done.stderr}")
    return done.stdout


def elements(value):
    """A column's value as [(suffix of the name, value)]."""
    if isinstance(value, np.ndarray):
        return [(f"_{i}", element) for i, element in enumerate(value)]
    return [("", value)]


def rows_of(table):
    """A table as the rows that `halocline log export` writes."""
    for row in range(len(table["event"])):
        values = {name: column[row] for name, column in table.items()}
        lists = {name for name in values if table[name].dtype == object and isinstance(values[name], np.ndarray)}
        for k in range(max([1] + [len(values[name]) for name in lists])):
            cells = {}
            for name, value in values.items():
                if name not in lists:
                    cells.update((name + suffix, element) for suffix, element in elements(value))
                elif value.ndim == 1:
                    cells[name] = value[k] if k < len(value) else None
                else:
                    cells.update((f"{name}_{i}", value[k, i] if k < len(value) else None) for i in range(value.shape[1]))
            yield cells


def agrees(name, text, value):
    if value is None:
        return text == ""
    if isinstance(value, bytes):
        return text == value.hex()
    if isinstance(value, np.floating) and name.rpartition(".")[2] in FLOAT32:
        return np.float32(text) == np.float32(value)
    return type(value)(text) == value


def setUpModule():
    PackageTest.folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(PackageTest.folder.cleanup)
    PackageTest.log = PackageTest.folder.name + "/log"
    command("run", SCENARIO, "--duration", 40, "--quiet", "--no-csv", "--no-report", "--log", PackageTest.log)
    command("log", "export", PackageTest.log, "--out", PackageTest.folder.name + "/csv")
    PackageTest.tables = halocline.read_log(PackageTest.log)


class PackageTest(unittest.TestCase):
    maxDiff = None

    def refuses(self, *words, error=ValueError):
        return self.assertRaisesRegex(error, "(?s)" + ".*".join(map(re.escape, words)))


class Logs(PackageTest):
    def test_tables_hold_what_log_export_writes(self):
        files = {path.stem: path for path in pathlib.Path(self.folder.name, "csv").glob("*.csv")}
        self.assertEqual(set(files), set(self.tables))
        self.assertLessEqual({"state", "outcome", "links", "receive", "send"}, set(files))
        for family, path in files.items():
            with open(path, newline="") as file:
                header, *lines = csv.reader(file)
            ours = list(rows_of(self.tables[family]))
            self.assertEqual(list(ours[0]), header)
            self.assertEqual(len(ours), len(lines), family)
            for line, cells in zip(lines, ours):
                for text, (name, value) in zip(line, cells.items()):
                    self.assertTrue(agrees(name, text, value), f"{family} {name}: {value!r} is not {text}")

    def test_columns_have_the_shape_and_type_of_their_fields(self):
        state, links = self.tables["state"], self.tables["links"]
        rows = len(state["event"])
        self.assertEqual(state["position_ned_m"].shape, (rows, 3))
        self.assertEqual(state["position_ned_m"].dtype, np.float64)
        self.assertEqual(state["utime"].dtype, np.int64)
        self.assertEqual(state["channel"].dtype.kind, "U")
        peers = next(name for name in links if name.endswith("snr_db"))
        self.assertEqual([len(values) for values in links[peers]], list(links["num_peers"]))
        self.assertIsInstance(self.tables["send"]["payload"][0], bytes)

    def test_a_pattern_chooses_channels(self):
        some = halocline.read_log([pathlib.Path(self.log)], channels=r"STATE\..*|OUTCOME")
        self.assertEqual(set(some), {"state", "outcome"})
        np.testing.assert_array_equal(some["state"]["position_ned_m"], self.tables["state"]["position_ned_m"])

    def test_names_are_those_of_the_enumeration(self):
        names = halocline.names_of("outcome", "outcome")
        values = self.tables["outcome"]["outcome"]
        self.assertEqual(names[0], "received")
        self.assertLess(values.max(), len(names))
        printed = command("outcomes", self.log)
        for value in np.unique(values):
            self.assertIn(names[value], printed)

    def test_what_is_wrong_is_named(self):
        with self.refuses("nowhere.lcm"):
            halocline.read_log("nowhere.lcm")
        with self.refuses("'STATE.('", "no regular expression"):
            halocline.read_log(self.log, channels="STATE.(")
        with self.refuses("'outcomes' is no channel family"):
            halocline.names_of("outcomes", "outcome")
        with self.refuses("'utime' is no enumeration of outcome", "outcome"):
            halocline.names_of("outcome", "utime")

    def test_damage_is_a_warning(self):
        broken = pathlib.Path(self.folder.name, "broken")
        data = pathlib.Path(self.log).read_bytes()
        broken.write_bytes(data[:len(data) * 2 // 3])
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            part = halocline.read_log(broken)
        self.assertEqual(len(caught), 1)
        self.assertLess(len(part["state"]["event"]), len(self.tables["state"]["event"]))


class Sound(PackageTest):
    def assert_arrivals(self, ours, printed):
        theirs, = json.loads(printed)
        rows = theirs.pop("paths")
        self.assertEqual(ours.summary, theirs)
        self.assertEqual(len(ours), len(rows))
        for name, column in ours.paths.items():
            self.assertEqual(column.tolist(), [row[name] for row in rows], name)
        if rows:
            self.assertEqual(set(ours.paths), set(rows[0]))

    def test_arrivals_are_those_of_the_command(self):
        water = pathlib.Path(self.folder.name, "water.csv")
        water.write_text("depth_m,sound_speed_mps\n0,1520\n50,1490\n200,1500\n")
        seas = [dict(sound_speed_mps=1500, bottom_depth_m=100),
                dict(water=water, bottom_depth_m=150, sediment="MediumSand", surface="eckart", wind_mps=5, absorption="thorp"),
                dict(sound_speed_mps=1500, bottom_depth_m=100, steep_direct=False, max_bounces=3, solver="images"),
                dict(water=water, bottom_depth_m=4000, max_launch_angle_deg=0.1)]
        for sea in seas:
            flags = [flag for name, value in sea.items() for flag in
                     (["--no-" + name.replace("_", "-")] if value is False else ["--" + name.replace("_", "-"), value])]
            printed = command("arrivals", "--source-depth-m", 30, "--receiver-depth-m", 50, "--range-m", 2000, "--format", "json", *flags)
            self.assert_arrivals(halocline.arrivals(30, 50, 2000, **sea), printed)
        self.assertGreater(len(halocline.arrivals(30, 50, 2000, **seas[0])), 5)
        self.assertEqual(len(halocline.arrivals(30, 50, 2000, **seas[3])), 0)

    def test_links_are_those_of_the_command(self):
        vehicles = sorted(re.findall(r"STATE\.(\S+)", " ".join(np.unique(self.tables["state"]["channel"]))))
        one, two = vehicles[:2]
        place = (0.0, 100.5, 5.0)
        for source, receiver, text in [(one, two, two), (one, place, "0.0,100.5,5.0")]:
            asked = ["link", SCENARIO, "--from", one, "--to", text, "--from-velocity", "1,0,0"]
            link = halocline.link(SCENARIO, source, receiver, source_velocity=(1, 0, 0))
            self.assertEqual(link.budget, json.loads(command(*asked, "--json")))
            self.assert_arrivals(link.arrivals, command(*asked, "--arrivals", "--format", "json"))
            self.assertIs(link.paths, link.arrivals.paths)

    def test_bands_of_a_link_are_those_of_the_command(self):
        link = halocline.link(SCENARIO, (0.0, 0.0, 5.0), (0.0, 100.0, 5.0), ensemble=4)
        printed = command("link", SCENARIO, "--from", "0.0,0.0,5.0", "--to", "0.0,100.0,5.0", "--ensemble", 4, "--json")
        self.assertEqual(link.budget, json.loads(printed))
        low, median, high = link.budget["ensemble"]["snr_db"]
        self.assertLessEqual(low, median)
        self.assertLess(low, high)

    def test_overrides_change_the_scenario(self):
        quiet = halocline.link(SCENARIO, (0, 0, 5), (0, 100, 5))
        loud = halocline.link(SCENARIO, (0, 0, 5), (0, 100, 5), overrides=["environment.wind_mps=15"])
        self.assertGreater(loud.budget["noise_level_db"], quiet.budget["noise_level_db"])

    def test_what_is_wrong_is_named(self):
        with self.refuses("nobody"):
            halocline.link(SCENARIO, "nobody", (0, 0, 5))
        with self.refuses("nowhere.toml"):
            halocline.link("nowhere.toml", "a", "b")
        with self.refuses("has 2 numbers", "north, east, down"):
            halocline.link(SCENARIO, (0, 5), (0, 0, 5))
        with self.refuses("'guess' is no solver", "images"):
            halocline.arrivals(30, 50, 2000, solver="guess", sound_speed_mps=1500, bottom_depth_m=100)
        with self.refuses("sound_speed_mps", "'fast'", "wrong type"):
            halocline.arrivals(30, 50, 2000, sound_speed_mps="fast", bottom_depth_m=100)
        with self.refuses("'depth' is no option", "bottom_depth_m"):
            _halocline.arrivals(30, 50, 2000, "auto", depth=3)
        with self.refuses("unexpected keyword argument 'depth'", error=TypeError):
            halocline.arrivals(30, 50, 2000, depth=3)


class Interface(PackageTest):
    def test_arrivals_take_the_options_of_the_command(self):
        options = set(re.findall(r"^  --([a-z-]+)", command("arrivals", "--help"), re.M))
        ours = set(inspect.signature(halocline.arrivals).parameters)
        self.assertEqual({option.replace("-", "_") for option in options} - {"links", "format", "out", "plot", "force"}, ours)

    def test_the_stub_has_every_name_and_signature_of_the_module(self):
        tree = ast.parse(pathlib.Path(_halocline.__file__).with_name("_halocline.pyi").read_text())
        stubs = {node.name: [a.arg for a in node.args.args] + (["**"] if node.args.kwarg else [])
                 for node in tree.body if isinstance(node, ast.FunctionDef)}
        module = {}
        for name, function in inspect.getmembers(_halocline, callable):
            if not name.startswith("__"):
                inside = re.match(rf"{name}\((.*)\) ->", function.__doc__.splitlines()[0])[1]
                module[name] = [re.sub(r"^\*\*\w+$", "**", word) for word in re.findall(r"(?:^|, )(\*\*\w+|\w+)(?=:|$)", inside)]
        self.assertEqual(stubs, module)

    def test_every_name_is_documented_and_typed(self):
        self.assertEqual(set(halocline.__all__),
                         {name for name, value in vars(halocline).items()
                          if getattr(value, "__module__", "") == "halocline" and callable(value) and not name.startswith("_")})
        for name in halocline.__all__:
            value = getattr(halocline, name)
            self.assertTrue(inspect.getdoc(value), name)
            if inspect.isfunction(value):
                signature = inspect.signature(value)
                self.assertNotIn(inspect.Signature.empty,
                                 [p.annotation for p in signature.parameters.values()] + [signature.return_annotation], name)
        self.assertTrue(pathlib.Path(halocline.__file__).with_name("py.typed").exists())

    def test_message_types_of_lcm_gen_are_in_the_same_package(self):
        types = pathlib.Path(self.folder.name, "types")
        subprocess.run(["lcm-gen", "-p", "--ppath", types, *TREE.glob("lcmtypes/*.lcm")], check=True)
        code = ("import halocline; state = halocline.vehicle_state_t(); state.vehicle_id = 7;"
                "print(halocline.vehicle_state_t.decode(state.encode()).vehicle_id, len(halocline.names_of('outcome', 'outcome')) > 1)")
        paths = os.environ["PYTHONPATH"] + os.pathsep + str(types)
        said = subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": paths}, check=True, capture_output=True, text=True)
        self.assertEqual(said.stdout, "7 True\n")

    def test_the_example_looks_at_a_run(self):
        picture = pathlib.Path(self.folder.name, "first_look.png")
        example = TREE / "clients/examples/python/first_look.py"
        said = subprocess.run([sys.executable, example, SCENARIO, self.log, picture], check=True, capture_output=True, text=True).stdout
        self.assertRegex(said, r"went \d+ m\n")
        self.assertRegex(said, r"received +\d+\n")
        self.assertRegex(said, r"\d\.\d{3} s, -?\d+\.\d dB SNR, \d+ paths\n")
        self.assertEqual(picture.exists(), str(picture) in said)

    def test_the_example_of_its_page_runs(self):
        page = re.search(r"^```python\n(.*?)^```", (TREE / "python/README.md").read_text(), re.M | re.S)[1]
        place, found = pathlib.Path(self.folder.name, "page"), {}
        (place / "results/harbour").mkdir(parents=True)
        (place / "results/harbour/harbour.lcm").symlink_to(self.log)
        (place / "scenarios").symlink_to(TREE / "scenarios")
        with contextlib.chdir(place):
            exec(page, found)
        self.assertGreater(np.count_nonzero(found["state"]["channel"] == "STATE.scout-1"), 100)
        self.assertGreater(found["link"].paths["delay_s"].size, 0)
        self.assertGreater(found["paths"]["delay_s"].size, 1)


if __name__ == "__main__":
    unittest.main()
