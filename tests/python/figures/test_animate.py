"""Films of runs: what a frame shows, the pictures, the files, and the command that writes them."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path
from typing import Any

import arm3r_cpp as arm3r
import force_runs
import numpy as np
import pytest
from arm3r_cpp.animation import files as animation_files
from arm3r_cpp.animation.files import Film, write
from arm3r_cpp.animation.frames import Frames, frame_times, frames_of
from arm3r_cpp.animation.scene import Scene, newtons_per_metre, palette, sight
from arm3r_cpp.commands import animate as animate_cli
from arm3r_cpp.plot.run_part import part_of
from arm3r_cpp.plot.style import ARM, ON_WALL, TIP, WALL
from elbow_arms import WITH_OFFSETS, scenario_of
from elbow_truth import Truth, along
from matplotlib.colors import to_rgb
from PIL import Image

WIDTH, HEIGHT = 640, 480
LINK, FORCE, PATH, PLATE = (tuple(round(255 * part) for part in to_rgb(code)) for code in (ARM, ON_WALL, TIP, WALL))


@pytest.fixture(scope="module")
def hybrid() -> arm3r.Run:
    return force_runs.hybrid(every=50)


@pytest.fixture(scope="module")
def bounce() -> arm3r.Run:
    return force_runs.bounce()


@pytest.fixture(scope="module")
def lecture_run() -> arm3r.Run:
    return arm3r.Scenario(
        "{format: 1, wall: {}, controller: {type: gravity_compensation}, time: {log_every: 0.05}}"
    ).run()


def film_of(run: arm3r.Run, fps: float = 25.0, speed: float = 1.0) -> tuple[Scene, Frames]:
    scenario = arm3r.Scenario(run.summary["scenario"])
    frames = frames_of(run, scenario, frame_times(run, fps=fps, speed=speed, every=None))
    return Scene(run, scenario, frames), frames


def pixels(picture: Any, colour: Any) -> int:
    return int(np.all(picture[..., :3] == colour, axis=-1).sum())


# ---- frames ---------------------------------------------------------------------------------------------------------


def test_times_of_frames(hybrid: arm3r.Run) -> None:
    assert frame_times(hybrid, fps=25, speed=1, every=None) == pytest.approx(np.arange(101) / 25)
    slow = frame_times(hybrid, fps=10, speed=0.3, every=None)
    assert np.diff(slow)[:-1] == pytest.approx(0.03)
    assert slow[-1] == 4
    rows = frame_times(hybrid, fps=25, speed=1, every=7)
    assert rows.tolist() == [*hybrid.t[::7].tolist(), 4]


@pytest.mark.parametrize(
    ("options", "hint"), [({"speed": 0.01}, "--speed 0.033"), ({"speed": 1, "every": 1}, "--every 2")]
)
def test_too_many_frames(options: dict[str, Any], hint: str) -> None:
    t = np.linspace(0, 4, 5000)
    run = arm3r.Run({"t": t}, {"t": "s"}, {}, None)
    with pytest.raises(arm3r.UsageError, match=hint):
        frame_times(run, fps=25, **{"every": None, **options})


def test_the_arm_of_each_frame(hybrid: arm3r.Run) -> None:
    _, frames = film_of(hybrid)
    assert np.linalg.norm(np.diff(frames.joints, axis=1), axis=2) == pytest.approx(1, abs=1e-4)
    assert frames.joints[:, 0].tolist() == [[0, 0, 0]] * len(frames.t)
    for k in (0, 50, -1):
        row = np.searchsorted(hybrid.t, frames.t[k] - 1e-9)
        assert frames.joints[k, 2] == pytest.approx(hybrid["tip"][row])


def test_an_elbow_arm_of_each_frame() -> None:
    """Through both ends of each offset: where the truth has them. All bends are drawn."""
    run = scenario_of(WITH_OFFSETS, initial={"q": [0.4, -0.7, 1.1]}, time={"stop": 0.2, "log_every": 0.1}).run()
    scene, frames = film_of(run, fps=10)
    truth = Truth(WITH_OFFSETS)
    rotations, (base, _, shoulder, elbow), _ = truth.frames(run["q"])
    ends = [along((0.43, rotations[2][..., 0])), along((0.38, rotations[3][..., 0]), (0.05, rotations[3][..., 1]))]
    line = [base, shoulder, shoulder + ends[0], elbow, elbow + ends[1], truth.tip_position(run["q"])]
    assert frames.joints == pytest.approx(np.stack(line, axis=1), abs=1e-12)
    assert frames.joints[:, frames.marked] == pytest.approx(np.stack([shoulder, elbow, line[-1]], axis=1), abs=1e-12)
    picture = scene.draw(2)
    for view in scene.views:
        for x, y in view.ax.transData.transform(view.flat(frames.joints[2, [2, 4]])).round().astype(int):
            assert pixels(picture[HEIGHT - y - 2 : HEIGHT - y + 2, x - 2 : x + 2], LINK) > 4
    column = frames.joints[0, 0] - frames.foot
    assert column / np.linalg.norm(column) == pytest.approx(truth.frames(run["q"][0]).axes[0])


def test_the_plate_of_each_frame(hybrid: arm3r.Run) -> None:
    _, frames = film_of(hybrid)
    assert frames.plate is not None
    sides = np.diff(frames.plate, axis=1)
    assert np.linalg.norm(sides, axis=2) == pytest.approx(np.tile([1.0, 0.6, 1.0], (len(frames.t), 1)))
    assert sides @ force_runs.NORMAL == pytest.approx(0, abs=1e-12)
    assert frames.plate.mean(axis=1)[-1] == pytest.approx(force_runs.CENTRE + 4 * 0.05 * force_runs.NORMAL)


def test_a_contact_between_frames_is_shown_by_the_next_one(bounce: arm3r.Run) -> None:
    _, frames = film_of(bounce, fps=8)  # frames at 0.5 and 0.625 s; the contact ends at 0.506 s
    seen = np.flatnonzero(frames.contact).tolist()
    assert [frames.t[k] for k in seen] == [0.5, 0.625]
    _, frames = film_of(bounce, fps=3)
    k = int(frames.force.argmax())
    assert frames.t[k] == pytest.approx(2 / 3)
    assert frames.force[k] == pytest.approx(5)
    assert frames.force_on_wall[k] == pytest.approx(-5 * force_runs.NORMAL)
    assert np.flatnonzero(frames.contact).tolist() == [k]


def test_a_contact_that_goes_on_is_shown_as_it_is(hybrid: arm3r.Run) -> None:
    _, frames = film_of(hybrid, fps=1)  # its peak of 31 N lies before the frame at 1 s
    assert frames.force[1] == pytest.approx(np.interp(1, hybrid.t, hybrid["force"]))
    assert frames.force[1] < 21


def test_an_infinite_wall_has_a_size_to_be_drawn() -> None:
    scenario = arm3r.Scenario("{format: 1, wall: {size: infinite}, time: {stop: 0.1}}")
    run = scenario.run()
    frames = frames_of(run, scenario, run.t[:1])
    assert frames.plate is not None
    assert np.ptp(frames.plate[0], axis=0) == pytest.approx([0, 2.4, 2.4])


# ---- pictures -------------------------------------------------------------------------------------------------------


def test_a_picture_shows_contact(hybrid: arm3r.Run) -> None:
    scene, frames = film_of(hybrid)
    free, touching = scene.draw(0), scene.draw(len(frames.t) - 1)
    assert free.shape == (HEIGHT, WIDTH, 4)
    for picture in (free, touching):
        assert pixels(picture, LINK) > 500
    assert pixels(free, PLATE) == 0
    assert pixels(touching, PLATE) > 500
    assert pixels(touching, FORCE) > pixels(free, FORCE) + 50  # its arrow
    assert scene.clock.get_text() == "t = 4.00 s   force  20.00 N"
    assert scene.flag.get_text() == "contact"


def test_pictures_do_not_depend_on_those_before(hybrid: arm3r.Run) -> None:
    scene, frames = film_of(hybrid)
    once = scene.draw(30)
    scene.draw(len(frames.t) - 1)
    assert np.array_equal(scene.draw(30), once)


def test_the_arrow_is_as_long_as_its_scale_says(hybrid: arm3r.Run) -> None:
    scene, frames = film_of(hybrid)
    scene.draw(len(frames.t) - 1)
    side, above = scene.views
    assert above.arrow.U[0] == pytest.approx(20 / scene.newtons, rel=1e-3)
    assert side.arrow.U[0] == pytest.approx(20 / scene.newtons, rel=1e-3)
    assert f"arrow: {scene.newtons:g} N a metre" in scene.figure.axes[-1].get_title(loc="left")


def test_everything_stays_in_sight(hybrid: arm3r.Run) -> None:
    scene, frames = film_of(hybrid)
    for view in scene.views:
        arrows = frames.joints[:, 2] + frames.force_on_wall / scene.newtons
        points = view.flat(np.concatenate([frames.joints.reshape(-1, 3), frames.plate.reshape(-1, 3), arrows]))
        for values, limits in zip(points.T, (view.ax.get_xlim(), view.ax.get_ylim()), strict=True):
            assert limits[0] < values.min() and values.max() < limits[1]
    spans = [np.ptp(limits) for view in scene.views for limits in (view.ax.get_xlim(), view.ax.get_ylim())]
    assert spans == pytest.approx([spans[0]] * 4)


def test_the_wall_is_on_the_right(hybrid: arm3r.Run, lecture_run: arm3r.Run) -> None:
    right, name = sight(film_of(hybrid)[1])
    assert right == pytest.approx(-force_runs.NORMAL)
    assert name == "towards the wall"
    right, name = sight(film_of(lecture_run, speed=10)[1])
    assert (right.tolist(), name) == ([1, 0, 0], "x")


@pytest.mark.parametrize("wall", ["", "wall: {normal: [0, 0, 1], point: [1.7, 0, -1]}, "])
def test_without_an_upright_wall_the_arm_points_to_the_right(wall: str) -> None:
    run = arm3r.Scenario(f"{{format: 1, {wall}initial: {{q: [50 deg, -30 deg, 60 deg]}}, time: {{stop: 0.1}}}}").run()
    scene, frames = film_of(run)
    right, name = sight(frames)
    assert right == pytest.approx([np.cos(np.radians(50)), np.sin(np.radians(50)), 0])
    assert name == "ahead"
    assert len(scene.figure.axes) == (3 if wall else 2)
    assert scene.draw(0).shape == (HEIGHT, WIDTH, 4)


@pytest.mark.parametrize(
    ("force", "length", "scale"), [(31, 0.6, 100), (1.18, 0.6, 2), (0, 0.6, 1), (5, 1, 5), (5.1, 1, 10)]
)
def test_scales_are_round(force: float, length: float, scale: float) -> None:
    assert newtons_per_metre(force, length) == pytest.approx(scale)


# ---- files ----------------------------------------------------------------------------------------------------------


def test_a_gif(lecture_run: arm3r.Run, tmp_path: Path) -> None:
    arm3r.plot.animate(lecture_run, tmp_path / "film.gif")
    with Image.open(tmp_path / "film.gif") as film:
        assert film.size == (WIDTH, HEIGHT)
        assert film.info["loop"] == 0
        assert duration(film) == 10_040  # the last picture stays for its own time, too
    assert (tmp_path / "film.gif").stat().st_size < 5e6


def duration(film: Any) -> int:
    total = 0
    for k in range(film.n_frames):
        film.seek(k)
        total += film.info["duration"]
    return total


def test_a_gif_has_the_colours_of_its_pictures(hybrid: arm3r.Run, tmp_path: Path) -> None:
    arm3r.plot.animate(hybrid, tmp_path / "film.gif", speed=4)
    scene, frames = film_of(hybrid, speed=4)
    with Image.open(tmp_path / "film.gif") as film:
        film.seek(film.n_frames - 1)
        shown = np.asarray(film.convert("RGB"))
    picture = scene.draw(len(frames.t) - 1)[..., :3]
    for colour in (PLATE, FORCE, LINK, PATH, (255, 255, 255)):
        assert pixels(shown, colour) >= pixels(picture, colour) > 20
    assert np.abs(shown.astype(int) - picture).mean() < 1


def test_frames_that_take_no_whole_hundredths_end_in_time(tmp_path: Path) -> None:
    def draw(k: int) -> Any:
        return np.full((4, 4, 4), 10 * k, np.uint8)

    write(Film(draw, 20, 30.0, palette()), tmp_path / "film.gif")
    with Image.open(tmp_path / "film.gif") as film:
        assert duration(film) == 670  # 20 / 30 s


def test_the_same_film_is_the_same_bytes(hybrid: arm3r.Run, tmp_path: Path) -> None:
    for name in ("one", "two"):
        arm3r.plot.animate(hybrid, tmp_path / f"{name}.gif", speed=4)
        arm3r.plot.animate(hybrid, tmp_path / name, every=30)
    assert (tmp_path / "one.gif").read_bytes() == (tmp_path / "two.gif").read_bytes()
    for path in (tmp_path / "one").iterdir():
        assert path.read_bytes() == (tmp_path / "two" / path.name).read_bytes()


def test_a_folder_of_pictures(hybrid: arm3r.Run, tmp_path: Path) -> None:
    arm3r.plot.animate(hybrid, tmp_path / "new" / "folder", every=100)
    names = [f"frame_{k:04d}.png" for k in range(5)]
    assert sorted(path.name for path in (tmp_path / "new/folder").iterdir()) == names
    with Image.open(tmp_path / "new/folder/frame_0004.png") as last:
        shown = np.asarray(last)
    assert shown.shape == (HEIGHT, WIDTH, 3)
    assert pixels(shown, PLATE) > 500


def test_progress_counts_frames(hybrid: arm3r.Run, tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    arm3r.plot.animate(hybrid, tmp_path / "film.gif", every=100, progress=lambda done, of: told.append((done, of)))
    assert told == [(k + 1, 5) for k in range(5)]


@pytest.fixture
def ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A program called ffmpeg that keeps what it was told."""
    (tmp_path / "bin").mkdir()
    program = tmp_path / "bin" / "ffmpeg"
    program.write_text(f'#!/bin/sh\necho "$@" > {tmp_path}/told\nfor last; do :; done\ncat > "$last"\n')
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PATH", f"{tmp_path / 'bin'}:/bin:/usr/bin")
    return program


def test_an_mp4_by_ffmpeg(hybrid: arm3r.Run, tmp_path: Path, ffmpeg: Path) -> None:
    arm3r.plot.animate(hybrid, tmp_path / "film.mp4", every=100, fps=12.5)
    assert (tmp_path / "film.mp4").stat().st_size == 5 * WIDTH * HEIGHT * 4
    told = (tmp_path / "told").read_text()
    assert f"-s {WIDTH}x{HEIGHT} -r 12.5" in told


@pytest.mark.parametrize(
    "script", ["cat > /dev/null; echo no such codec >&2; exit 3", "echo no such codec >&2; exit 3"]
)
def test_an_ffmpeg_that_fails(hybrid: arm3r.Run, tmp_path: Path, ffmpeg: Path, script: str) -> None:
    ffmpeg.write_text(f"#!/bin/sh\n{script}\n")
    with pytest.raises(arm3r.OutputError, match="ffmpeg ended with 3: no such codec"):
        arm3r.plot.animate(hybrid, tmp_path / "film.mp4", every=100)
    assert {path.name for path in tmp_path.iterdir()} == {"bin"}


@pytest.mark.parametrize("name", ["film.gif", "folder"])
@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError(28, "No space left on device")])
def test_what_is_not_finished_is_not_there(name: str, error: Any, tmp_path: Path) -> None:
    def draw(k: int) -> Any:
        if k == 3:
            raise error
        return np.zeros((4, 4, 4), np.uint8)

    with pytest.raises((KeyboardInterrupt, arm3r.OutputError)):
        write(Film(draw, 5, 25.0, palette()), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


# ---- arm3r-animate --------------------------------------------------------------------------------------------------


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, hybrid: arm3r.Run) -> Path:
    monkeypatch.chdir(tmp_path)
    force_runs.stored(hybrid, tmp_path / "hybrid.csv")
    force_runs.stored(force_runs.changed(hybrid, {}, scenario=None), tmp_path / "bare.csv")
    return tmp_path


def test_a_film_of_a_csv(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert animate_cli.main(["hybrid.csv", "--speed", "4", "--fps", "10"]) == 0
    said = capsys.readouterr()
    assert said.out == "hybrid.gif\n"
    assert said.err == ""  # no bar without a terminal
    with Image.open("hybrid.gif") as film:
        assert film.n_frames == 11


def test_a_film_of_a_part_of_a_run(here: Path) -> None:
    assert animate_cli.main(["hybrid.csv", "--from", "0.3", "--to", "0.5", "--speed", "0.1", "--fps", "10"]) == 0
    with Image.open("hybrid.gif") as film:
        assert film.n_frames == 21  # 0.2 s, ten times slower


def test_the_frames_of_a_part_are_those_of_the_whole_film(hybrid: arm3r.Run) -> None:
    part = part_of(hybrid, 1.0, 3.0)
    _, whole = film_of(hybrid)
    scene, frames = film_of(part)
    shown = (whole.t > 1 - 1e-9) & (whole.t < 3 + 1e-9)
    assert frames.t == pytest.approx(whole.t[shown])
    assert frames.joints == pytest.approx(whole.joints[shown])
    assert frames.contact.tolist() == whole.contact[shown].tolist() == [1] * len(frames.t)
    assert scene.figure.axes[-1].get_xlim() == (1, 3)


def test_a_film_of_a_scenario_that_fails_shows_how_far_it_came(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    Path("short.yaml").write_text("{format: 1, solver: {max_steps: 20}, time: {stop: 5}}")
    assert animate_cli.main(["short.yaml", "-o", "short.gif"]) == 5
    assert "max_steps" in capsys.readouterr().err
    with Image.open("short.gif") as film:
        assert film.size == (WIDTH, HEIGHT)


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["missing.csv"], 2, "missing.csv"),
        (["bare.csv"], 2, "no scenario"),
        (["hybrid.csv", "-o", "film.avi"], 2, ".gif, .mp4"),
        (["hybrid.csv", "-o", "film.mp4"], 2, "ffmpeg"),
        (["hybrid.csv", "-o", "full"], 2, "give a new one"),
        (["hybrid.csv", "-o", "plain"], 2, "is a file"),
        (["hybrid.csv", "--fps", "0"], 2, "fps"),
        (["hybrid.csv", "--fps", "60"], 2, "50"),
        (["hybrid.csv", "--speed", "-1"], 2, "speed"),
        (["hybrid.csv", "--speed", "1e-3"], 2, "--speed 0.033"),
        (["hybrid.csv", "--every", "0"], 2, "every"),
        (["hybrid.csv", "--from", "5"], 2, "from 5 s to 4 s: there are 0 rows"),
        (["hybrid.csv", "-o", "hybrid.csv/film.gif"], 6, "hybrid.csv"),
    ],
)
def test_failures_say_why_and_write_nothing(
    arguments: list[str],
    code: int,
    words: str,
    here: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(animation_files.shutil, "which", lambda _: None)
    Path("full").mkdir()
    Path("full/old").touch()
    Path("plain").touch()
    before = set(here.rglob("*"))
    assert animate_cli.main(arguments) == code
    said = capsys.readouterr()
    assert said.err.startswith("arm3r-animate: ")
    assert words in said.err
    assert said.out == ""
    assert set(here.rglob("*")) == before


def test_pace_is_given_once(here: Path) -> None:
    with pytest.raises(SystemExit) as ended:
        animate_cli.main(["hybrid.csv", "--speed", "2", "--every", "3"])
    assert ended.value.code == 2


def test_the_installed_command(scripts: Path) -> None:
    done = subprocess.run([scripts / "arm3r-animate", "--help"], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0
    for option in ("-o", "--fps", "--speed", "--every", "--from", "--to", "ffmpeg"):
        assert option in done.stdout


AT_ONCE = "from arm3r_cpp import _progress_bar\n_progress_bar.DELAY = 0.0\n"


def test_a_bar_on_a_terminal(here: Path) -> None:
    """On a pseudo-terminal, without the second for which it waits: a quick machine has no film that takes longer."""
    leader, follower = os.openpty()
    code = f"{AT_ONCE}from arm3r_cpp.commands.animate import main\nraise SystemExit(main(['hybrid.csv']))"
    call = [sys.executable, "-c", code]
    with subprocess.Popen(call, stdout=subprocess.PIPE, stderr=follower) as command:
        os.close(follower)
        shown = read_terminal(leader)
    assert command.returncode == 0
    assert "animate [" in shown and "frames/s" in shown
    assert shown.endswith("\r\x1b[K")


def read_terminal(leader: int) -> str:
    """All that is said until its other end is closed."""
    said = b""
    with open(leader, "rb", buffering=0) as terminal:
        while True:
            try:
                said += terminal.read(4096)
            except OSError:  # so ends a pseudo-terminal
                return said.decode()
