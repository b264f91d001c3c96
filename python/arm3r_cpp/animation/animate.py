"""A run as a film."""

from __future__ import annotations

import math
import os
from pathlib import Path

from ..core.run import Run
from ..errors import UsageError
from .files import Film, Progress, check_target, write

MAX_RATE = 120.0  # frames a second


def animate(
    run: Run,
    path: str | os.PathLike[str],
    *,
    fps: float = 25.0,
    speed: float = 1.0,
    every: int | None = None,
    start: float | None = None,
    end: float | None = None,
    progress: Progress | None = None,
) -> None:
    """The arm and the wall from the side and from above, force and contact, over time.

    Args:
        run: a finished or partial run with its scenario in the summary.
        path: NAME.gif, NAME.mp4 (by ffmpeg, which has to be on PATH), or a new folder for PNG files.
        fps: frames a second of the film; at most 50 for a GIF.
        speed: how many seconds of the run pass in one of the film.
        every: show one row of this many instead; speed is then not used.
        start, end: of the part of the run that is shown, s; None: its first or last row.
        progress: called as progress(frames_done, frames) after each frame.

    Raises:
        UsageError: an argument is out of range, the frames are too many, too few rows lie from start to end, or there
            is no scenario or no ffmpeg.
        OutputError: it cannot be written; then nothing is.
    """
    from ..core.scenario import Scenario
    from ..plot.run_part import part_of
    from .frames import frame_times, frames_of
    from .scene import Scene, palette

    path = Path(path)
    check(fps, speed, every)
    check_target(path, fps)
    if not run.summary.get("scenario"):
        raise UsageError(
            "the run's summary holds no scenario, so that its arm is not known; run it again", code="usage"
        )
    scenario = Scenario(run.summary["scenario"])
    run = part_of(run, start, end)
    frames = frames_of(run, scenario, frame_times(run, fps=fps, speed=speed, every=every))
    scene = Scene(run, scenario, frames)
    write(Film(scene.draw, len(frames.t), fps, palette(), progress), path)


def check(fps: float, speed: float, every: int | None) -> None:
    if not 0 < fps <= MAX_RATE:
        raise UsageError(
            f"fps: more than 0 and at most {MAX_RATE:g} frames a second are possible, got {fps:g}", code="usage"
        )
    if not 0 < speed < math.inf:
        raise UsageError(f"speed: a positive number is needed, got {speed:g}", code="usage")
    if every is not None and every < 1:
        raise UsageError(f"every: 1 or more is needed, got {every}", code="usage")
