"""Reads the matrices of a MATLAB file of level 5 (versions 5 to 7): numbers, and structures of them.

The layout is that of MathWorks, "MAT-File Format": elements of a type, a size and data, which lie within each other.
A reader of our own, since the known one ends the interpreter at a broken file.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

HEADER = 128
_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_MATRIX, _COMPRESSED = 14, 15
_STRUCTURE, _OF_NUMBERS = 2, range(6, 16)  # classes
_COMPLEX = 0x0800
_DEEPEST = 20
_MOST_BYTES = 1 << 30


class BrokenFile(ValueError):
    """It is no file of this format."""


class Element(NamedTuple):
    kind: int
    data: memoryview


class MatFile:
    """The variables of a file by their names; those that are no numbers are left out."""

    def __init__(self, content: bytes) -> None:
        """
        Raises:
            BrokenFile: it is none, or of another version.
        """
        if content[126:128] not in (b"IM", b"MI"):
            raise BrokenFile("it is no MATLAB file of version 5 to 7")
        self._order = "<" if content[126:128] == b"IM" else ">"
        if self._integer(content[124:126]) != 0x0100:
            raise BrokenFile("it is of version 7.3; in MATLAB: save('log.mat', 'q', 'tau', '-v7')")
        self._left = _MOST_BYTES
        self.variables: dict[str, Any] = {}
        for element in self._elements(memoryview(content)[HEADER:]):
            for one in self._elements(self._inflated(element.data)) if element.kind == _COMPRESSED else [element]:
                if one.kind == _MATRIX:
                    name, value = self._matrix(one.data, 0)
                    self.variables[name] = value

    def _integer(self, data: Any) -> int:
        return int.from_bytes(data, "little" if self._order == "<" else "big")

    def _inflated(self, data: memoryview) -> memoryview:
        stream = zlib.decompressobj()
        try:
            content = stream.decompress(data, self._left)
        except zlib.error as error:
            raise BrokenFile(f"a part of it cannot be unpacked: {error}") from None
        if not stream.eof:
            raise BrokenFile("a part of it is cut off, or larger than a gigabyte")
        self._left -= len(content)
        return memoryview(content)

    def _elements(self, data: memoryview) -> Iterator[Element]:
        """The elements of which data consist: up to four bytes share the first eight with their type."""
        while data:
            if len(data) < 8:
                raise BrokenFile("it is cut off")
            kind, size = self._integer(data[:4]), self._integer(data[4:8])
            if kind >> 16:
                kind, size, start, end = kind & 0xFFFF, kind >> 16, 4, 8
            else:
                start, end = 8, 8 + size + (0 if kind == _COMPRESSED else -size % 8)
            if start + size > min(end, len(data)):
                raise BrokenFile("it is cut off")
            yield Element(kind, data[start : start + size])
            data = data[end:]

    def _matrix(self, data: memoryview, depth: int) -> tuple[str, Any]:
        """A variable's name and its value: an array, a dict of fields, or None for what is no number."""
        if not data:  # an empty field
            return "", None
        parts = list(self._elements(data))
        if len(parts) < 3 or depth > _DEEPEST:
            raise BrokenFile("a matrix of it is incomplete, or too deep")
        flags, name = self._integer(parts[0].data[:4]), bytes(parts[2].data).decode("latin-1")
        size = tuple(int(one) for one in self._numbers(parts[1]))
        if flags & 0xFF == _STRUCTURE:
            return name, self._structure(parts[3:], size, depth)
        if flags & 0xFF not in _OF_NUMBERS or flags & _COMPLEX or len(parts) < 4:
            return name, None
        numbers = self._numbers(parts[3])
        if min(size, default=0) < 0 or int(np.prod(size, dtype=object)) != len(numbers):
            raise BrokenFile("a matrix of it has other numbers than its size says")
        return name, numbers.reshape(size, order="F").squeeze()

    def _numbers(self, element: Element) -> np.ndarray:
        if element.kind not in _NUMBERS:
            raise BrokenFile(f"it holds numbers of the unknown type {element.kind}")
        kind = np.dtype(self._order + _NUMBERS[element.kind])
        if len(element.data) % kind.itemsize:
            raise BrokenFile("it is cut off")
        return np.frombuffer(element.data, kind)

    def _structure(self, parts: list[Element], size: tuple[int, ...], depth: int) -> dict[str, Any] | None:
        """The fields of a single structure; None for an array of structures."""
        if int(np.prod(size, dtype=object)) != 1:
            return None
        if len(parts) < 2 or not (length := self._integer(parts[0].data)):
            raise BrokenFile("a structure of it is incomplete")
        words = bytes(parts[1].data)
        names = [words[at : at + length].split(b"\0")[0].decode("latin-1") for at in range(0, len(words), length)]
        if len(names) != len(parts) - 2:
            raise BrokenFile("a structure of it is incomplete")
        return {name: self._matrix(part.data, depth + 1)[1] for name, part in zip(names, parts[2:], strict=True)}
