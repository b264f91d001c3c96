"""Files of the Python package: whole or not at all, and what messages say about them."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import arm3r_cpp as arm3r
import pytest
from arm3r_cpp._files import replacing
from arm3r_cpp._messages import describe, did_you_mean, no_column, place


def test_a_file_that_is_replaced_is_the_old_one_until_the_block_ends(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("old")
    with replacing(path) as part:
        part.write_text("new")
        assert path.read_text() == "old" and part.suffix == ".part"
    assert path.read_text() == "new" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("fault", [ValueError("not written"), KeyboardInterrupt()])
def test_a_block_that_raises_leaves_nothing(tmp_path: Path, fault: BaseException) -> None:
    (tmp_path / "a.csv").write_text("old")
    for name in ("a.csv", "b.csv", "folder"):
        with pytest.raises(type(fault)), replacing(tmp_path / name) as part:
            if name == "folder":
                part.mkdir()
                (part / "frame.png").write_text("half")
            else:
                part.write_text("half")
            raise fault
    assert [path.read_text() for path in tmp_path.iterdir()] == ["old"]


def test_what_cannot_be_written_is_an_output_error_with_the_name(tmp_path: Path) -> None:
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").touch()
    for path in (tmp_path / "no" / "folder.csv", tmp_path / "full"):
        with pytest.raises(arm3r.OutputError, match=f"{path.name}: cannot be written: "), replacing(path) as part:
            part.write_text("new")
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["file", "full"]


def test_threads_that_write_to_one_path_leave_one_whole_file(tmp_path: Path) -> None:
    path, meeting = tmp_path / "table.csv", threading.Barrier(4)

    def write(letter: str) -> None:
        with replacing(path) as part, part.open("w") as file:
            meeting.wait()
            file.write(letter * 10000)

    threads = [threading.Thread(target=write, args=(letter,)) for letter in "abcd"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    text = path.read_text()
    assert text in [letter * 10000 for letter in "abcd"] and os.listdir(tmp_path) == [path.name]


def test_a_place_has_what_is_known() -> None:
    assert place("s.yaml", 3, 14) == "s.yaml:3:14"
    assert place(Path("run.csv"), 7) == "run.csv:7"
    assert place("run.npz") == "run.npz"


def test_the_library_and_the_package_describe_a_problem_in_the_same_words() -> None:
    with pytest.raises(arm3r.ScenarioError) as raised:
        arm3r.Scenario(
            "format: 1\nwall: {contact: {stiffness: -5, dampin: 1}}\narm: {lenght: 3}\n", file="s.yaml"
        ).validate()
    assert len(raised.value.problems) >= 2
    assert "\n".join(map(describe, raised.value.problems)) == str(raised.value)


def test_a_column_that_there_is_not() -> None:
    run = arm3r.Scenario("format: 1\ntime: {stop: 0}\n").run()
    with pytest.raises(KeyError, match=r"no column 'tip_c'; did you mean tip_\w\?"):
        run["tip_c"]
    assert did_you_mean("peak_forc", ["outcome", "peak_force"]) == "did you mean peak_force?"
    assert did_you_mean("xyz", ["outcome", "peak_force"]) == ""
    assert str(no_column("xyz", ["outcome", "t"])) == "no column 'xyz'; there are outcome, t"
