# SPDX-License-Identifier: BSD-3-Clause
"""LCM for Python in Python alone, for machines without LCM's own module, as Debian 12: the calls that a vehicle needs.

    bus = lcm.LCM()                          # LCM_DEFAULT_URL, or LCM("udpm://239.255.76.67:7667?ttl=0")
    bus.subscribe(r"RECEIVE\\.me", handler)   # handler(channel, data), called by handle() and handle_timeout()
    bus.publish("STATE.me", state.encode())
    bus.handle_timeout(100)                  # milliseconds; returns 0 when nothing came

Names and meaning are those of LCM's module, which takes its place unchanged: `pip install lcm`, and leave this file away.

A message is a UDP datagram to a multicast group, integers high byte first (LCM's page "UDP Multicast Protocol Description"):

    short     "LC02" | sequence u32 | channel, 0 | data
    fragment  "LC03" | sequence u32 | size of data u32 | offset in it u32 | number u16 | count u16 | part
              the part of fragment 0 begins with channel, 0

This reads udpm alone; a datagram that is neither is ignored.
"""
import os
import re
import select
import socket
import struct
import time
import urllib.parse

DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"
SHORT, FRAGMENT = b"LC02", b"LC03"
SHORT_HEADER, FRAGMENT_HEADER = struct.Struct(">4sI"), struct.Struct(">4sIIIHH")
MAX_SHORT = 65499  # bytes of channel, 0 and data, as LCM's own library
MAX_PART = 65487
MAX_CHANNEL = 63
MAX_UNFINISHED = 1 << 24  # bytes of messages whose fragments are not all there
MAX_SENDERS = 1000  # of such messages


class Subscription:
    def __init__(self, channel, handler):
        try:
            self.pattern = re.compile(channel)
        except re.error as error:
            raise ValueError(f"the channel '{channel}' is no regular expression: {error}") from None
        self.handler = handler

    def set_queue_capacity(self, messages):
        """Nothing to set: the only queue is the socket's (recv_buf_size)."""


class Unfinished:
    """A message of which fragments are missing."""

    def __init__(self, sequence, size, count):
        self.sequence, self.data, self.count = sequence, bytearray(size), count
        self.numbers, self.channel = set(), None

    def add(self, number, offset, part):
        """True when it is whole."""
        if number >= self.count:
            raise ValueError("a fragment beyond the count of its message")
        if number == 0:
            channel, end, part = part.partition(b"\0")
            if not end:
                raise ValueError("a channel without its end")
            self.channel = channel.decode("ascii")
        if offset + len(part) > len(self.data):
            raise ValueError("a fragment beyond the end of its message")
        self.data[offset:offset + len(part)] = part
        self.numbers.add(number)
        return len(self.numbers) == self.count


class LCM:
    """Throws ValueError for a URL that cannot be, OSError when the network refuses."""

    def __init__(self, provider=""):
        url = urllib.parse.urlsplit(provider or os.environ.get("LCM_DEFAULT_URL") or DEFAULT_URL)
        options = dict(urllib.parse.parse_qsl(url.query))
        if url.scheme != "udpm":
            raise ValueError(f"'{url.geturl()}': allowed is udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES")
        try:
            self._group = (url.hostname or "239.255.76.67", url.port or 7667)
            ttl, buffer_bytes = int(options.get("ttl", 0)), int(options.get("recv_buf_size", 0))
            membership = socket.inet_aton(self._group[0]) + socket.inet_aton("0.0.0.0")
        except (OSError, ValueError) as error:
            raise ValueError(f"'{url.geturl()}': {error}; allowed is udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES") from None
        self._sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
        self._receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if buffer_bytes:
            self._receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
        self._receiver.bind(self._group)  # to the group: other groups on this port are not received
        self._receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
        self._receiver.setblocking(False)
        self._sequence = 0
        self._subscriptions = []
        self._unfinished = {}  # by the sender's address, the oldest first

    def publish(self, channel, data):
        name = channel.encode("ascii")
        if len(name) > MAX_CHANNEL:
            raise ValueError(f"the channel '{channel}' has {len(name)} characters; allowed are {MAX_CHANNEL}")
        body = name + b"\0" + bytes(data)
        sequence, self._sequence = self._sequence, (self._sequence + 1) & 0xFFFFFFFF
        if len(body) <= MAX_SHORT:
            self._sender.sendto(SHORT_HEADER.pack(SHORT, sequence) + body, self._group)
            return
        parts = [body[i:i + MAX_PART] for i in range(0, len(body), MAX_PART)]
        if len(parts) > 0xFFFF:
            raise ValueError(f"a message of {len(data)} bytes on {channel} is too large")
        for number, part in enumerate(parts):
            offset = max(0, number * MAX_PART - len(name) - 1)
            header = FRAGMENT_HEADER.pack(FRAGMENT, sequence, len(data), offset, number, len(parts))
            self._sender.sendto(header + part, self._group)

    def subscribe(self, channel, handler):
        """`channel` is a regular expression of the whole name. An exception of the handler leaves handle()."""
        self._subscriptions.append(Subscription(channel, handler))
        return self._subscriptions[-1]

    def unsubscribe(self, subscription):
        self._subscriptions.remove(subscription)

    def fileno(self):
        return self._receiver.fileno()

    def handle(self):
        """Waits for one message that somebody subscribes to."""
        while not self.handle_timeout(1000):
            pass

    def handle_timeout(self, milliseconds):
        """The same for so long at most; returns 1, or 0 when nothing came."""
        end = time.monotonic() + milliseconds / 1000
        left_s = milliseconds / 1000
        while left_s >= 0 and select.select([self._receiver], [], [], left_s)[0]:
            try:
                message = self._message_in(*self._receiver.recvfrom(65536))
            except (ValueError, struct.error):  # no LCM
                message = None
            if message and self._dispatch(*message):
                return 1
            left_s = end - time.monotonic()
        return 0

    def _dispatch(self, channel, data):
        wanted = [s for s in self._subscriptions if s.pattern.fullmatch(channel)]
        for subscription in wanted:
            subscription.handler(channel, data)
        return bool(wanted)

    def _message_in(self, datagram, sender):
        """(channel, data), or None while fragments of it are missing."""
        if datagram[:4] == SHORT and len(datagram) >= SHORT_HEADER.size:
            channel, end, data = datagram[SHORT_HEADER.size:].partition(b"\0")
            return (channel.decode("ascii"), data) if end else None
        if datagram[:4] != FRAGMENT:
            return None
        _, sequence, size, offset, number, count = FRAGMENT_HEADER.unpack_from(datagram)
        if size > MAX_UNFINISHED:
            return None
        message = self._unfinished.get(sender)
        if message is None or message.sequence != sequence or len(message.data) != size:
            self._unfinished.pop(sender, None)
            message = self._unfinished[sender] = Unfinished(sequence, size, count)
            self._drop_oldest()
        if not message.add(number, offset, datagram[FRAGMENT_HEADER.size:]):
            return None
        del self._unfinished[sender]
        return message.channel, bytes(message.data)

    def _drop_oldest(self):
        while len(self._unfinished) > MAX_SENDERS or sum(len(m.data) for m in self._unfinished.values()) > MAX_UNFINISHED:
            del self._unfinished[next(iter(self._unfinished))]
