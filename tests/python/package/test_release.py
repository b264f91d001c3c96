"""What a release publishes has the same bytes each time, and the workflows call what there is."""

from __future__ import annotations

import hashlib
import os
import re
import shlex
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path
from types import ModuleType

import pytest
import yaml
from conftest import QUICK, ROOT, script

WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))
TARGETS = set(re.search(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text(), re.M)[1].split())


@pytest.fixture(scope="module")
def dist() -> ModuleType:
    """tools/dist.py"""
    return script("tools/dist.py")


# ---- workflows ------------------------------------------------------------------------------------------------------


def steps_of(path: Path) -> list[dict[str, object]]:
    return [step for job in yaml.safe_load(path.read_text())["jobs"].values() for step in job["steps"]]


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_runs_targets_of_the_makefile_alone(path: Path) -> None:
    commands = [str(step["run"]) for step in steps_of(path) if "run" in step]
    assert commands
    for command in commands:
        words = command.split()
        assert words[0] == "make" and words[1] in TARGETS, command
        assert all(re.fullmatch(r"NEED=[\w,]+", word) for word in words[2:]), command


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_a_workflow_has_what_the_service_asks_for(path: Path) -> None:
    workflow = yaml.safe_load(path.read_text())
    assert set(workflow) == {"name", True, "permissions", "jobs"}  # YAML 1.1 reads `on` as true
    assert workflow["name"] == path.stem and workflow["permissions"] == {"contents": "read"}
    for job in workflow["jobs"].values():
        assert set(job.get("needs", "").split()) <= set(workflow["jobs"]) and job["runs-on"]
    for step in steps_of(path):
        assert ("run" in step) != ("uses" in step)
        assert "uses" not in step or re.fullmatch(r"[\w-]+/[\w-]+@(v\d+|release/v1)", str(step["uses"]))


def test_only_a_tag_publishes() -> None:
    release = yaml.safe_load((ROOT / ".github/workflows/release.yml").read_text())
    assert release[True] == {"push": {"tags": ["v*"]}}
    publishing = [name for name, job in release["jobs"].items() if "permissions" in job]
    assert publishing == ["package", "site"] and all("needs" in release["jobs"][name] for name in publishing)
    test = yaml.safe_load((ROOT / ".github/workflows/test.yml").read_text())
    assert [job for job in test["jobs"].values() if "permissions" in job] == []


def test_the_page_about_releases_names_what_there_is() -> None:
    page = (ROOT / "docs/releasing.md").read_text()
    assert len(re.findall(r"^\d+\. ", page, re.M)) == 15
    assert set(re.findall(r"`make (\w+)`", page)) <= TARGETS
    assert all((ROOT / ".github/workflows" / name).is_file() for name in re.findall(r"`(\w+\.yml)`", page))


# ---- the same bytes -------------------------------------------------------------------------------------------------


def test_an_archive_and_its_sums_depend_on_the_contents_alone(dist: ModuleType, tmp_path: Path) -> None:
    archives = []
    for parent, time in ((tmp_path / "one", 1), (tmp_path / "two", 2_000_000_000)):
        (parent / "site/inner").mkdir(parents=True)
        for name in ("b", "a", "inner/c") if time == 1 else ("inner/c", "a", "b"):
            (parent / "site" / name).write_text(name)
            os.utime(parent / "site" / name, (time, time))
        for name in (".buildinfo", "inner/__pycache__/c.pyc"):  # in these stands where they were made
            (parent / "site" / name).parent.mkdir(exist_ok=True)
            (parent / "site" / name).write_text(str(parent))
        archives.append(dist.packed(parent / "site", 1_700_000_000))
    assert archives[0] == archives[1] != dist.packed(tmp_path / "one/site", 1)
    (tmp_path / "one/site.tar.gz").write_bytes(archives[0])
    with tarfile.open(tmp_path / "one/site.tar.gz") as archive:
        assert archive.getnames() == ["site/a", "site/b", "site/inner/c"]
    (tmp_path / "one/SHA256SUMS").write_text(dist.sums(tmp_path / "one"))
    check = ["sha256sum", "--check", "--strict", "SHA256SUMS"]
    assert subprocess.run(check, cwd=tmp_path / "one", capture_output=True).returncode == 0
    (tmp_path / "one/site/a").write_text("changed")
    assert subprocess.run(check, cwd=tmp_path / "one", capture_output=True).returncode == 1


def test_wheels_that_are_published_are_not_those_of_this_processor_alone() -> None:
    wheels = script("tools/wheels.py")
    for platform in wheels.PLATFORMS:
        settings = wheels.settings(platform)
        assert settings["cmake.define.ARM3R_LANES"] == "all" and "build/ctest" not in settings["build-dir"]
    own = {name: value for name, value in os.environ.items() if name != "MAKEFLAGS"}  # of the make that runs the tests
    command = ["make", "--dry-run", "dist"]
    recipe = subprocess.run(command, cwd=ROOT, env=own, capture_output=True, text=True, check=True).stdout
    [line] = [line for line in recipe.splitlines() if "tools/dist.py" in line]
    assert line.endswith(" tools/dist.py build/wheels/*.whl")


def packages(clone: Path) -> dict[str, str]:
    """The sums of the source package and of a quickly compiled wheel, built in a clone."""
    calls = "from scikit_build_core import build; build.build_sdist('dist'); build.build_wheel('dist')"
    quick = shlex.join(f"-D{name}={value}" for name, value in QUICK.items())
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "SOURCE_DATE_EPOCH": "1700000000", "CMAKE_ARGS": quick, "PATH": path}
    done = subprocess.run([sys.executable, "-c", calls], cwd=clone, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in (clone / "dist").iterdir()}


@pytest.mark.gate
def test_source_package_and_wheel_have_the_same_bytes_in_two_folders(tmp_path: Path) -> None:
    clones = [tmp_path / "one", tmp_path / "a longer name"]
    for clone in clones:  # first, so that both are of one commit
        subprocess.run(["git", "clone", "-q", ROOT, clone], check=True)
    one, two = map(packages, clones)
    assert len(one) == 2 and one == two
    [wheel] = (clones[0] / "dist").glob("*.whl")
    assert re.fullmatch(r"arm3r_cpp-[\d.]+-cp310-abi3-linux_\w+\.whl", wheel.name)  # for all versions of Python
    names = set(zipfile.ZipFile(wheel).namelist())
    parts = "_arm3r.abi3.so bin/arm3r include/arm3r/arm3r.h lib/libarm3r.so lib/cmake/arm3r/arm3rConfig.cmake"
    assert {f"arm3r_cpp/{part}" for part in parts.split()} <= names
    files = [
        *clones[0].glob("scenarios/**/*.yaml"),
        *clones[0].glob("docs/*.schema.json"),
        *clones[0].glob("docs/*.md"),
    ]
    assert {f"arm3r_cpp/share/arm3r/{path.relative_to(clones[0]).as_posix()}" for path in files} <= names
