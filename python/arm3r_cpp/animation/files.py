"""Frames into a GIF, an MP4 by ffmpeg, or a folder of PNG files: whole, or not at all."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._files import check_folder, folder_named, make_folder, replacing
from ..errors import OutputError, UsageError

MAX_GIF_RATE = 50.0  # frames a second: what viewers still show

Picture = NDArray[np.uint8]
Progress = Callable[[int, int], None]
"""Called with the number of finished frames and the number of all frames."""


def check_target(path: Path, fps: float) -> None:
    """
    Raises:
        UsageError: nothing can be written there.
    """
    if path.suffix not in ("", ".gif", ".mp4"):
        raise UsageError(f"-o {path}: cannot write {path.suffix}; use .gif, .mp4, or a folder's name for PNG files")
    if path.suffix == ".gif" and fps > MAX_GIF_RATE:
        raise UsageError(
            f"--fps {fps:g}: viewers show at most {MAX_GIF_RATE:g} frames a second of a GIF; use .mp4 or fewer"
        )
    if path.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise UsageError(f"-o {path}: the program ffmpeg is needed and not on PATH; install it or write a .gif")
    if path.suffix == "":
        folder_named(path)
    if path.suffix == "" and path.is_dir() and any(path.iterdir()):
        raise UsageError(f"-o {path}: there are files in this folder; give a new one")
    if path.suffix == "" and path.exists() and not path.is_dir():
        raise UsageError(f"-o {path}: is a file; give a folder's name, or one that ends in .gif or .mp4")


class Film(NamedTuple):
    draw: Callable[[int], Picture]
    """Frame k as (height, width, 4), RGBA."""
    frames: int
    fps: float
    palette: Picture
    """(up to 256, 3), RGB: what a GIF's colours are taken from"""
    progress: Progress | None = None

    def pictures(self) -> Iterator[Picture]:
        for k in range(self.frames):
            yield self.draw(k)
            if self.progress:
                self.progress(k + 1, self.frames)


def write(film: Film, path: Path) -> None:
    """Write a film into a file or a folder. The same pictures give the same bytes.

    Raises:
        OutputError: it cannot be written; then nothing is.
    """
    kinds = {".gif": _write_gif, ".mp4": _write_mp4, "": _write_folder}
    (check_folder if path.suffix else make_folder)(path.parent)
    with replacing(path) as part:
        kinds[path.suffix](film, part)


def _write_gif(film: Film, part: Path) -> None:
    """Times are whole hundredths of a second in this format: each frame ends at the one nearest to its own."""
    ends = [round(100 * (k + 1) / film.fps) for k in range(film.frames)]
    durations = [10 * (end - start) for start, end in zip([0, *ends], ends, strict=False)]
    first, *rest = _reduced(film)
    options: Any = {"append_images": rest, "duration": durations, "loop": 0, "optimize": False}
    first.save(part, format="GIF", save_all=True, **options)


def _reduced(film: Film) -> Iterator[Any]:
    """The pictures in the palette's colours."""
    from PIL import Image

    nearest = _nearest(film.palette)
    for picture in film.pictures():
        reduced = Image.fromarray(nearest[_cell(picture)])
        reduced.putpalette(film.palette.tobytes())
        yield reduced


def _nearest(palette: Picture) -> Picture:
    """For each cell of the space of colours, 4 by 4 by 4 of them, the place of the palette's nearest one."""
    middles = 4 * np.arange(64, dtype=np.int32) + 2
    offsets = [(middles[:, None] - palette[:, i].astype(np.int32)) ** 2 for i in range(3)]
    nearest = np.empty((64, 64, 64), np.uint8)
    for red in range(64):
        nearest[red] = (offsets[0][red] + offsets[1][:, None] + offsets[2]).argmin(axis=-1)
    flat: Picture = nearest.reshape(-1)
    flat[_cell(palette)] = np.arange(len(palette))
    return flat


def _cell(colours: Picture) -> NDArray[np.int32]:
    """(..., 3 or 4) to (...)"""
    high = (colours >> 2).astype(np.int32)
    return (high[..., 0] << 12) | (high[..., 1] << 6) | high[..., 2]


def _write_folder(film: Film, part: Path) -> None:
    from PIL import Image

    part.mkdir()
    for k, frame in enumerate(film.pictures()):
        Image.fromarray(frame[..., :3]).save(part / f"frame_{k:04d}.png")


def _write_mp4(film: Film, part: Path) -> None:
    height, width, _ = film.draw(0).shape
    raw = ["-f", "rawvideo", "-pix_fmt", "rgba", "-s", f"{width}x{height}", "-r", f"{film.fps:g}", "-i", "-"]
    coded = ["-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "20", "-threads", "1", "-fflags", "+bitexact"]
    call = ["ffmpeg", "-v", "error", "-y", *raw, *coded, "-map_metadata", "-1", "-f", "mp4", str(part)]
    with tempfile.TemporaryFile() as said:
        with subprocess.Popen(call, stdin=subprocess.PIPE, stderr=said) as ffmpeg, suppress(BrokenPipeError):
            assert ffmpeg.stdin is not None
            for frame in film.pictures():
                ffmpeg.stdin.write(frame.tobytes())
            ffmpeg.stdin.close()
        if ffmpeg.returncode:
            said.seek(0)
            lines = said.read().decode(errors="replace").strip().splitlines() or ["it said nothing"]
            raise OutputError(f"ffmpeg ended with {ffmpeg.returncode}: {lines[-1]}")
