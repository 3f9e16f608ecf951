# SPDX-License-Identifier: BSD-3-Clause
"""What a log lacks, by the numbers of its messages: each publisher numbers those of a channel 0, 1, 2, ..., and
its heartbeats name the last."""
import collections
import mmap
import pathlib
import struct
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "lcmtypes"))
from generate import read_messages

EVENT = struct.Struct(">Iqqii")  # word, number, stamp, lengths of channel and data
WORD = 0xEDA1DA01


def events(log):
    """Channel and data of each event."""
    with open(log, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        at = 0
        while at + EVENT.size <= len(data):
            word, _, _, channel_size, size = EVENT.unpack_from(data, at)
            if word != WORD:
                raise ValueError(f"{log}, byte {at}: no event")
            at += EVENT.size
            yield data[at:at + channel_size].decode(), data[at + channel_size:at + channel_size + size]
            at += channel_size + size


def listed_flows(data):
    """(channel, session, last number) of each flow of a HEARTBEAT."""
    count, = struct.unpack_from(">i", data, 44)
    at, channels = 48, []
    for _ in range(count):
        size, = struct.unpack_from(">i", data, at)
        channels.append(data[at + 4:at + 3 + size].decode())
        at += 4 + size
    numbers = struct.unpack_from(f">{2 * count}q", data, at)
    return zip(channels, numbers[:count], numbers[count:])


def numbered_families():
    messages = read_messages(ROOT / "lcmtypes")
    channels = tomllib.loads((ROOT / "lcmtypes/channels.toml").read_text())
    numbered = {name for name, message in messages.items()
                if [field.name for field in message.fields[:3]] == ["utime", "session", "sequence"]}
    families = {channel.split(".")[0] for channel, row in channels.items() if row["type"] in numbered}
    return families - {"HEARTBEAT"}


def counts(log):
    """[published, in the log] of each family of channels, of the flows of which the log has anything."""
    families, numbers, last = numbered_families(), collections.defaultdict(set), {}
    for channel, data in events(log):
        family = channel.split(".")[0]
        if family == "HEARTBEAT":
            for name, session, number in listed_flows(data):
                last[name, session] = max(number, last.get((name, session), -1))
        elif family in families:
            _, session, number = struct.unpack_from(">qqq", data, 8)
            numbers[channel, session].add(number)
    totals = collections.defaultdict(lambda: [0, 0])
    for flow, present in numbers.items():
        total = totals[flow[0].split(".")[0]]
        total[0] += max(max(present), last.get(flow, -1)) + 1
        total[1] += len(present)
    return dict(totals)
