"""Files that are read must be regular ones: reading a FIFO would wait for its writer, a device may never end."""

from __future__ import annotations

import errno
import os
from pathlib import Path


def regular(path: Path) -> Path:
    """The path of a file that can be opened and read to its end; one that does not exist is left to `open`.

    Raises:
        OSError: it is something else than a regular file.
    """
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if path.exists() and not path.is_file():
        raise OSError(errno.EINVAL, "not a regular file", str(path))
    return path
