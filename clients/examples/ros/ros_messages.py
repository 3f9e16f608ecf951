#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every message type of Halocline as a ROS message of the same fields: ros_messages.py LCMTYPES OUT

Writes OUT/VehicleState.msg and so on, of LCMTYPES/vehicle_state_t.lcm: the folder msg of a package halocline_msgs, for ROS 1 and 2.

   an integer, float, double, string   as in ROS; byte is uint8, boolean bool
   a list, of one size or another      a list; of two dimensions: its rows, one after the other
   a constant                          a constant
   a type within                       halocline_msgs/VehicleState

A number that counts a list (num_peers) stays a field, and is set to the length of its list on the way to LCM.
"""
import pathlib
import re
import sys

PACKAGE = "halocline_msgs"
TYPES = {"int8_t": "int8", "int16_t": "int16", "int32_t": "int32", "int64_t": "int64", "byte": "uint8", "boolean": "bool",
         "float": "float32", "double": "float64", "string": "string"}
MEMBER = re.compile(r"^\s*(const\s+)?(\w+)\s+(\w+)\s*((?:\[\s*\w+\s*\])*)\s*(?:=\s*([^;]+))?;\s*(?://\s*(.*))?$", re.M)


class Field:
    def __init__(self, kind, name, sizes, note):
        self.name, self.sizes, self.note = name, sizes, note  # sizes: numbers, or names of fields that count
        self.nested = None if kind in TYPES else kind
        self.kind = TYPES.get(kind) or ros_type(kind)


class MessageType:
    """What a file of lcmtypes/ says."""

    def __init__(self, path):
        self.name = path.stem
        self.constants, self.fields = [], []
        for const, kind, name, sizes, value, note in MEMBER.findall(path.read_text().partition("{")[2]):
            if const:
                self.constants.append((TYPES[kind], name, value.strip(), note))
            else:
                sizes = [int(size) if size.isdigit() else size for size in re.findall(r"\w+", sizes)]
                self.fields.append(Field(kind, name, sizes, note))

    def definition(self):
        """The text of the .msg file."""
        lines = [f"{kind} {name}={value}  # {note}" for kind, name, value, note in self.constants]
        for f in self.fields:
            # ROS has one dimension: of rows of a fixed size as many as there are, of a list any number.
            length = "" if any(isinstance(size, str) for size in f.sizes) or not f.sizes else str(f.sizes[0])
            brackets = f"[{length}]" if f.sizes else ""
            lines.append(f"{f.kind}{brackets} {f.name}  # {f.note}")
        return "\n".join(lines) + "\n"


def ros_name(lcm_name):
    """vehicle_state_t: VehicleState."""
    return "".join(word.capitalize() for word in lcm_name.removesuffix("_t").split("_"))


def ros_type(lcm_name):
    """halocline_msgs/VehicleState."""
    return f"{PACKAGE}/{ros_name(lcm_name)}"


def message_types(folder):
    """All types of a folder by their LCM names."""
    return {path.stem: MessageType(path) for path in sorted(pathlib.Path(folder).glob("*.lcm"))}


class Converter:
    """Between LCM's and ROS's objects of one type. `lcm_class` and `ros_class` give the class of a type by its LCM name."""

    def __init__(self, types, lcm_class, ros_class):
        self.types, self.lcm_class, self.ros_class = types, lcm_class, ros_class

    def to_ros(self, name, message):
        out = self.ros_class(name)()
        for f in self.types[name].fields:
            value = getattr(message, f.name)
            if len(f.sizes) == 2:
                value = [element for row in value for element in row]
            if f.nested:
                value = [self.to_ros(f.nested, v) for v in value] if f.sizes else self.to_ros(f.nested, value)
            elif f.kind == "bool":
                value = [bool(v) for v in value] if f.sizes else bool(value)
            elif f.sizes and f.kind == "uint8":
                value = bytes(value)
            setattr(out, f.name, value)
        return out

    def to_lcm(self, name, message):
        out = self.lcm_class(name)()
        for f in self.types[name].fields:
            value = getattr(message, f.name)
            if f.nested:
                value = [self.to_lcm(f.nested, v) for v in value] if f.sizes else self.to_lcm(f.nested, value)
            elif f.sizes:
                value = bytes(value) if f.kind == "uint8" else list(value)
            if len(f.sizes) == 2:
                value = [value[i:i + f.sizes[1]] for i in range(0, len(value), f.sizes[1])]
            setattr(out, f.name, value)
            if f.sizes and isinstance(f.sizes[0], str):
                setattr(out, f.sizes[0], len(value))
        return out


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    out = pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    for name, message in message_types(sys.argv[1]).items():
        (out / f"{ros_name(name)}.msg").write_text(message.definition())


if __name__ == "__main__":
    main()
