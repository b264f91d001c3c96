"""What the heads of compiled files say: for which processor they are, and of macOS's the oldest version they run on."""

from __future__ import annotations

import struct
from collections.abc import Iterator

MACH_O = 0xFEEDFACF
PROCESSORS = {  # kind of file: number of the processor: name
    "ELF": {62: "x86_64", 183: "aarch64"},
    "PE": {0x8664: "x86_64"},
    "Mach-O": {0x01000007: "x86_64", 0x0100000C: "arm64"},
}
LC_CODE_SIGNATURE, LC_BUILD_VERSION, LC_RPATH = 0x1D, 0x32, 0x8000001C
EMBEDDED_SIGNATURE, CODE_DIRECTORY, AD_HOC = 0xFADE0CC0, 0xFADE0C02, 0x2


def processor(data: bytes) -> str:
    """For example "ELF x86_64"; "" where the file is no compiled one."""
    if data.startswith(b"\x7fELF"):
        kind, number = "ELF", struct.unpack_from("<H", data, 18)[0]
    elif data.startswith(b"MZ"):
        kind, number = "PE", struct.unpack_from("<H", data, struct.unpack_from("<I", data, 60)[0] + 4)[0]
    elif data[:4] == struct.pack("<I", MACH_O):
        kind, number = "Mach-O", struct.unpack_from("<I", data, 4)[0]
    else:
        return ""
    return f"{kind} {PROCESSORS[kind].get(number, number)}"


def load_commands(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Of a file of macOS: the number of each load command, and all its bytes."""
    offset = 32
    for _ in range(struct.unpack_from("<I", data, 16)[0]):
        command, size = struct.unpack_from("<II", data, offset)
        yield command, data[offset : offset + size]
        offset += size


def oldest_macos(data: bytes) -> str:
    [command] = [command for number, command in load_commands(data) if number == LC_BUILD_VERSION]
    version = struct.unpack_from("<I", command, 12)[0]
    return f"{version >> 16}.{version >> 8 & 255}"


def search_paths(data: bytes) -> list[str]:
    """Where a file of macOS looks for the libraries that it names by @rpath."""
    paths = [command[12:] for number, command in load_commands(data) if number == LC_RPATH]
    return [path.rstrip(b"\0").decode() for path in paths]


def has_ad_hoc_signature(data: bytes) -> bool:
    places = [command for number, command in load_commands(data) if number == LC_CODE_SIGNATURE]
    if len(places) != 1:
        return False
    start = struct.unpack_from("<I", places[0], 8)[0]
    magic, _, count = struct.unpack_from(">III", data, start)
    offsets = [struct.unpack_from(">II", data, start + 12 + 8 * i)[1] for i in range(count)]
    directories = [struct.unpack_from(">IIII", data, start + offset) for offset in offsets]
    flags = [flag for blob, _, _, flag in directories if blob == CODE_DIRECTORY]
    return magic == EMBEDDED_SIGNATURE and bool(flags) and all(flag & AD_HOC for flag in flags)
