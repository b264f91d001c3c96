"""Chains, and the files that they come from."""

from __future__ import annotations

import os

from .chain import SerialChain
from .dh import read_dh
from .urdf import read_urdf


class Chain(SerialChain):
    """A serial chain of up to seven joints.

    >>> chain = Chain.from_dh("ur5.csv")
    >>> verdict = verify.jacobian(my_jacobian, chain)
    """

    @classmethod
    def from_urdf(cls, path: str | os.PathLike[str], *, tip: str | None = None) -> Chain:
        """The chain from the base link of a URDF to a link, by default the last one."""
        return read_urdf(path, tip, cls)

    @classmethod
    def from_dh(cls, path: str | os.PathLike[str]) -> Chain:
        """The chain of a DH table, see `arm3r docs verify`."""
        return read_dh(path, cls)
