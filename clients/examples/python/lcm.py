"""LCM for Python where the module of LCM itself is not installed, as on Debian: its calls that a vehicle needs, by ctypes.

    bus = lcm.LCM()                       # LCM_DEFAULT_URL, or LCM("udpm://239.255.76.67:7667?ttl=0")
    bus.subscribe("RECEIVE\\\\.me", handler)  # handler(channel, data), called by handle_timeout()
    bus.publish("STATE.me", state.encode())
    bus.handle_timeout(100)               # milliseconds; returns 0 when nothing came

Names and meaning are those of LCM's module (https://lcm-proj.github.io), which takes its place unchanged.
"""
import ctypes


class _ReceiveBuffer(ctypes.Structure):
    # lcm_recv_buf_t of lcm/lcm.h, as far as it is read here.
    _fields_ = [("data", ctypes.c_void_p), ("data_size", ctypes.c_uint32)]


_HANDLER = ctypes.CFUNCTYPE(None, ctypes.POINTER(_ReceiveBuffer), ctypes.c_char_p, ctypes.c_void_p)

_library = ctypes.CDLL("liblcm.so.1")
_library.lcm_create.restype = ctypes.c_void_p
_library.lcm_create.argtypes = [ctypes.c_char_p]
_library.lcm_destroy.argtypes = [ctypes.c_void_p]
_library.lcm_publish.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_char_p, ctypes.c_uint]
_library.lcm_subscribe.restype = ctypes.c_void_p
_library.lcm_subscribe.argtypes = [ctypes.c_void_p, ctypes.c_char_p, _HANDLER, ctypes.c_void_p]
_library.lcm_handle_timeout.argtypes = [ctypes.c_void_p, ctypes.c_int]


class LCM:
    def __init__(self, provider=""):
        self._lcm = _library.lcm_create(provider.encode() or None)
        if not self._lcm:
            raise RuntimeError(f"LCM cannot open '{provider or 'LCM_DEFAULT_URL'}'")
        self._handlers = []  # ctypes keeps no reference to them
        self._error = None

    def __del__(self):
        if self._lcm:
            _library.lcm_destroy(self._lcm)

    def publish(self, channel, data):
        if _library.lcm_publish(self._lcm, channel.encode(), data, len(data)) != 0:
            raise OSError(f"LCM cannot publish on {channel}")

    def subscribe(self, channel, handler):
        """`channel` is a regular expression of the whole name. An exception of the handler leaves handle_timeout()."""
        def receive(buffer, name, _):
            try:
                handler(name.decode(), ctypes.string_at(buffer.contents.data, buffer.contents.data_size))
            except Exception as error:  # cannot pass through C
                self._error = error

        self._handlers.append(_HANDLER(receive))
        if not _library.lcm_subscribe(self._lcm, channel.encode(), self._handlers[-1], None):
            raise ValueError(f"LCM cannot subscribe to '{channel}'")

    def handle_timeout(self, milliseconds):
        result = _library.lcm_handle_timeout(self._lcm, milliseconds)
        if self._error:
            error, self._error = self._error, None
            raise error
        if result < 0:
            raise OSError("LCM cannot receive")
        return result
