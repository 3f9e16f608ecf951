#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes everything that repeats the description of a message, from lcmtypes/*.lcm and lcmtypes/channels.toml.

The comment behind a field may limit its values; what decodes is checked against it (bus/messages/message_checks.h):

  double depth_m;       // below the surface, metres, 0..12000     inclusive; pi, 2pi and pi/2 are numbers; 1.. is open
  double layer_m[n];    // ascending                               each element above the one before
  string client_name;   // [a-z0-9_-]{1,24}                        a name; a range limits the length of a text
  int8_t beam_status;   // BEAM_*, or BEAM_LOCKED, ...             a constant of the block of constants that holds this one
  int8_t packet_kind;   // modem_receive_t.DATA, ...               likewise, of another type
  double offset_m[n];   // unchecked                               anything, NaN too: its receiver judges it

Every other double is finite; a utime lies within 100 years.
"""
import argparse
import math
import pathlib
import re
import sys
import textwrap
import tomllib

NUMBER = r"-?(?:\d+(?:\.\d+)?(?:e-?\d+)?(?:pi)?|pi)(?:/\d+)?"
RANGE = re.compile(rf"(?:, )?(?<![\w.])({NUMBER})\.\.({NUMBER})?(?![\w.])")
CONSTANT = re.compile(r"(?:(\w+_t)\.)?([A-Z][A-Z0-9_]*)(\*?)")
NAME = "[a-z0-9_-]{1,24}"
CENTURY_US = 3155760000000000  # sums of times within it cannot overflow
TYPES = ("boolean", "byte", "int8_t", "int16_t", "int32_t", "int64_t", "float", "double", "string")


def number(text):
    value, _, divisor = text.partition("/")
    factor = math.pi if value.endswith("pi") else 1
    return float({"": "1", "-": "-1"}.get(value := value.removesuffix("pi"), value)) * factor / float(divisor or 1)


class Field:
    def __init__(self, kind, name, dimensions, comment):
        self.kind, self.name, self.comment = kind, name, comment
        self.dimensions = re.findall(r"\[(\w+)\]", dimensions)
        self.is_count = False
        self.names = []  # of the values of its enumeration
        self.min, self.max = (-CENTURY_US, CENTURY_US) if re.fullmatch(r"(\w+_)?utime", name) else (-math.inf, math.inf)
        if found := RANGE.search(comment):
            self.min, self.max = number(found[1]), number(found[2]) if found[2] else math.inf
            if self.min > self.max:
                raise ValueError(f"{name}: the range {found[0]} is empty")

    def has(self, word):
        return re.search(rf"\b{word}\b", self.comment) is not None


class Message:
    def __init__(self, path):
        text = path.read_text()
        head, _, body = text.partition("{")
        self.name = path.stem
        self.purpose = " ".join(re.findall(r"^// ?(.*)", head.partition(";")[2], re.M))
        self.blocks = [[]]  # of constants: (name, value, comment)
        self.fields = []
        for line in body.split("\n"):
            if found := re.match(r"\s*const \w+ (\w+) = (-?\w+);\s*(?://\s*(.*))?$", line):
                self.blocks[-1].append((found[1], int(found[2]), found[3] or ""))
            elif found := re.match(r"\s*(\w+)\s+(\w+)((?:\[\w+\])*);\s*(?://\s*(.*))?$", line):
                self.fields.append(Field(found[1], found[2], found[3], found[4] or ""))
            elif not line.strip() and self.blocks[-1]:
                self.blocks.append([])
            elif line.strip() not in ("", "{", "}"):
                raise ValueError(f"{path}: neither a constant nor a field: {line.strip()}")

    def block_of(self, constant, prefix):
        for block in self.blocks:
            if any(name.startswith(constant) if prefix else name == constant for name, _, _ in block):
                return block
        raise ValueError(f"{self.name} has no constant {constant}")


def read_messages(folder):
    messages = {path.stem: Message(path) for path in sorted(folder.glob("*.lcm"))}
    for message in messages.values():
        count = None  # the integer that the arrays after it are counted by
        by_name = {field.name: field for field in message.fields}
        for field in message.fields:
            if field.kind not in TYPES and field.kind not in messages:
                raise ValueError(f"{message.name}.{field.name}: {field.kind} is no type")
            if field.kind == "int8_t" and (found := CONSTANT.match(field.comment)):
                block = messages[found[1] or message.name].block_of(found[2], found[3])
                field.min, field.max = block[0][1], block[-1][1]
                field.names = [name for name, _, _ in block]
            for size in (size for size in field.dimensions if not size.isdigit()):
                if size not in by_name or (by_name[size].is_count and size != count):
                    raise ValueError(f"{message.name}.{field.name}: {size} is not the count before it")
                by_name[size].is_count, count = True, size
    return messages


# C++ ------------------------------------------------------------------------------------------------------------------

def header(purpose, includes, body):
    return (f"// {purpose} Made by lcmtypes/generate.py.\n#pragma once\n\n" + "".join(f"#include {i}\n" for i in includes)
            + f"\n{body}")


def pascal(name):
    return "".join(word.capitalize() for word in re.split(r"[_.]+", name.removesuffix("_t")))


def spoken(names):
    """BEAM_LOCKED, BEAM_NO_BOTTOM -> locked, no bottom."""
    prefix = names[0].split("_")[0] + "_"
    shared = len(names) > 1 and all(name.startswith(prefix) for name in names)
    return [(name.removeprefix(prefix) if shared else name).lower().replace("_", " ") for name in names]


def messages_header(messages):
    types = ", ".join(messages)
    each = " ".join(f"X({name})" for name in messages)
    return header("All types of the bus, as lcm-gen made them.", ["<tuple>"] + [f"<halocline/{name}.hpp>" for name in messages],
                  f"namespace halocline {{\nusing AllMessages = std::tuple<{types}>;\n}}\n"
                  f"// X(type) for each.\n#define HALOCLINE_EACH_MESSAGE(X) {each}\n")


def cpp_field(message, field):
    parts = [f'.name = "{field.name}"']
    for name, value in ("min", field.min), ("max", field.max):
        if math.isfinite(value):
            parts.append(f".{name} = {float(value)!r}")
    if field.names:
        parts.append(f".enumeration = {enumeration_of(message, field)}")
    inner = [size for size in field.dimensions[1:] if size.isdigit()]
    for name, value in (("inner", inner[0] if inner else ""), ("is_count", field.is_count), ("is_name", NAME in field.comment),
                        ("is_ascending", field.has("ascending")), ("is_unchecked", field.has("unchecked"))):
        if value:
            parts.append(f".{name} = {str(value).lower()}")
    return "{" + ", ".join(parts) + "}"


def enumeration_of(message, field):
    return f"k{pascal(message.name)}{pascal(field.name)}Names"


def fields_header(messages):
    body = "namespace halocline {\n\n"
    for message in messages.values():
        for field in (field for field in message.fields if field.names):
            names = ", ".join(f'"{name}"' for name in spoken(field.names))
            body += (f"inline constexpr std::array<const char*, {len(field.names)}> {enumeration_of(message, field)}"
                     f"{{{names}}};\n")
    for message in messages.values():
        body += (f"\ntemplate <class Visitor, IsMessage<{message.name}> Message>\n"
                 "void visit_fields(Visitor& visit, Message&& m) {\n")
        body += "".join(f"  visit(MessageField{cpp_field(message, field)}, m.{field.name});\n" for field in message.fields)
        body += "}\n"
    return header("visit_fields(visitor, message) calls visitor(MessageField, value) for each field, in order.",
                  ["<array>", '"bus/messages/message_field.h"', '"bus/messages/messages.h"'], body + "\n}  // namespace halocline\n")


def is_family(channel):
    return "." in channel


def constant_of(channel):
    return "k" + pascal(channel.partition(".")[0].lower())


def channels_header(channels):
    body = "namespace halocline::bus::channels {\n"
    for channel, row in channels.items():
        value = f'Family {constant_of(channel)}{{"{channel.partition(".")[0]}."}}' if is_family(channel) else (
            f'std::string_view {constant_of(channel)} = "{channel}"')
        body += f"// From {row['from']}: {row['meaning']}.\ninline constexpr {value};\n"
    return header("The names of all channels, from lcmtypes/channels.toml.", ["<string_view>", '"bus/messages/channel_family.h"'],
                  body + "}  // namespace halocline::bus::channels\n")


def table_header(channels):
    calls = " ||\n         ".join(f"visit.template operator()<{row['type']}>(channels::{constant_of(channel)})"
                                  for channel, row in channels.items() if row["type"] != "any" and "plane" not in row)
    return header("Which type travels on which channel.", ['"bus/messages/channels.h"', '"bus/messages/messages.h"'],
                  "namespace halocline::bus {\n\n// Calls visit.operator()<Message>(channel or family) for each channel until one "
                  "returns true.\ntemplate <class Visitor>\nbool any_channel(Visitor&& visit) {\n  return " + calls
                  + ";\n}\n\n}  // namespace halocline::bus\n")


# The reference page ---------------------------------------------------------------------------------------------------

def table(titles, rows):
    cells = [titles, ["---"] * len(titles), *rows]
    return "".join("| " + " | ".join(str(cell).replace("|", "\\|") for cell in row) + " |\n" for row in cells) + "\n"


def allowed(field):
    if field.has("unchecked"):
        return "any"
    found = RANGE.search(field.comment)
    if not found:
        return ""
    return (f"{found[1]} to {found[2]}" if found[2] else f"{found[1]} and up") + " characters" * (field.kind == "string")


def linked(text, messages=(), this=""):
    """A comment as markdown: channels as code, pages and other messages as links."""
    text = re.sub(r"[A-Z_]+\.<[\w ]+>|^[A-Z_]+(?=, from)", r"`\g<0>`", text)
    text = re.sub(r"\bdocs/(\w+\.md)\b", r"[\1](\1)", text)
    return re.sub(r"\b\w+_t\b", lambda name: f"[`{name[0]}`](#{name[0]})" if name[0] in messages and name[0] != this else name[0], text)


def page(messages, channels):
    text = """# Channels and messages

Every channel of the bus, with the type of its messages, and every field with its unit and range. Look up a channel, then its type.
[architecture.md](architecture.md) explains what holds for all messages, for example sessions, sequence numbers and time.

A range is inclusive. A message with a value beyond it, or with a number that is not finite, is refused. A type that is part of another one has
no channel of its own. `lcmtypes/generate.py --doc docs/messages.md` makes this page from `lcmtypes/`.

## Channels

"""
    text += table(["channel", "type", "from", "rate", "meaning"],
                  [[f"`{channel}`", "that of `<channel>`" if row["type"] == "any" else f"[`{row['type']}`](#{row['type']})",
                    row["from"], row["rate"], row["meaning"]] for channel, row in channels.items()])
    for message in messages.values():
        purpose = linked(message.purpose, messages, message.name)
        text += f"## {message.name}\n\n{textwrap.fill(purpose, 140, break_on_hyphens=False, break_long_words=False)}\n\n"
        for block in filter(None, message.blocks):
            text += table(["constant", "value", "meaning"], [[f"`{name}`", value, linked(comment)] for name, value, comment in block])
        text += table(["field", "type", "allowed", "meaning, unit"],
                      [[f"`{field.name}`", f"`{field.kind}{''.join(f'[{size}]' for size in field.dimensions)}`", allowed(field),
                        linked(RANGE.sub("", field.comment))] for field in message.fields])
    return text.rstrip() + "\n"


def write(path, text):
    """Leaves a file alone that has this text already: nothing that includes it is compiled again."""
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text() != text:
        path.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--types", type=pathlib.Path, default=pathlib.Path(__file__).parent, help="folder of *.lcm and channels.toml")
    parser.add_argument("--cpp", type=pathlib.Path, metavar="FOLDER", help="write FOLDER/bus/*.h")
    parser.add_argument("--doc", type=pathlib.Path, metavar="FILE", help="write the reference page")
    parser.add_argument("--check", action="store_true", help="with --doc: write nothing, fail when FILE is stale")
    arguments = parser.parse_args()
    try:
        messages = read_messages(arguments.types)
        channels = tomllib.loads((arguments.types / "channels.toml").read_text())
        for channel, row in channels.items():
            if row["type"] != "any" and row["type"] not in messages:
                raise ValueError(f"{channel}: {row['type']} is no type")
    except ValueError as error:
        sys.exit(f"generate.py: {error}")
    if arguments.cpp:
        made = {"messages": messages_header(messages), "message_fields": fields_header(messages),
                "channels": channels_header(channels), "channel_table": table_header(channels)}
        for name, text in made.items():
            write(arguments.cpp / "bus/messages" / f"{name}.h", text)
    if arguments.doc and not arguments.check:
        write(arguments.doc, page(messages, channels))
    if arguments.doc and arguments.check and arguments.doc.read_text() != page(messages, channels):
        sys.exit(f"{arguments.doc} is stale: run lcmtypes/generate.py --doc {arguments.doc}")


if __name__ == "__main__":
    main()
