"""The hash in a run's summary: 64-bit FNV-1a over the bytes of all columns."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

START, PRIME = 0xCBF29CE484222325, 0x100000001B3
PIECE = 1 << 16  # bytes at a time: they stay in the processor's cache


def fnv1a64(columns: Iterable[NDArray[np.float64]]) -> str:
    """ "fnv1a64:hex" of arrays of float64, one after the other, low bytes first."""
    state = START
    for column in columns:
        data = np.ascontiguousarray(column, "<f8").view(np.uint8)
        for start in range(0, data.size, PIECE):
            state = _extended(state, data[start : start + PIECE])
    return f"fnv1a64:{state:016x}"


def _extended(state: int, data: NDArray[np.uint8]) -> int:
    """The hash after more bytes: for each, state = (state ^ byte) * PRIME, modulo 2^64.

    The xor changes nothing but the low byte: it adds (low ^ byte) - low. The rest is then linear: a sum with powers of
    PRIME as weights.
    """
    low = _low_bytes(state, data)
    added = (low ^ data).astype(np.uint64) - low
    powers = np.multiply.accumulate(np.full(data.size, PRIME, np.uint64))
    total = np.sum(added * powers[::-1], dtype=np.uint64)
    return (state * int(powers[-1]) + int(total)) % 2**64


def _low_bytes(state: int, data: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """The low byte of the hash before each byte of data, bit by bit: PRIME is odd, so that bit k of a product is bit k
    of the factor, flipped by what the bits below it carry; and a chain of flips is an accumulated xor."""
    low = np.zeros_like(data)
    for bit in (1 << k for k in range(8)):
        below = (low ^ data) & np.uint8(bit - 1)
        flips = (below * np.uint8(PRIME & 0xFF) ^ data) & np.uint8(bit)
        low |= np.bitwise_xor.accumulate(np.concatenate([[np.uint8(state & bit)], flips[:-1]]))
    return low
