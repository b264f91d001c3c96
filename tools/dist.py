"""python tools/dist.py WHEEL...: what a release publishes, into dist/, with SHA256SUMS.

dist/python is what the package index gets: the source package, and the wheels that are named. Beside it lie the site
and the live page, as far as they are built. Times come from the last commit, so that
the same commit gives the same bytes."""

from __future__ import annotations

import gzip
import hashlib
import io
import os
import shutil
import subprocess
import sys
import tarfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
DIST = ROOT / "dist"
PYTHON = DIST / "python"


def git(*arguments: str) -> str:
    return subprocess.run(["git", *arguments], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()


LEFT_OUT = {".buildinfo", "__pycache__"}  # of Sphinx and Python, who write into them where the folder lies


def packed(folder: Path, time: int) -> bytes:
    """A folder as .tar.gz: names in order, one time, nobody's files."""
    files = [
        path for path in folder.rglob("*") if path.is_file() and not LEFT_OUT & set(path.relative_to(folder).parts)
    ]
    tar = io.BytesIO()
    with tarfile.open(fileobj=tar, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for path in sorted(files):
            member = tarfile.TarInfo(f"{folder.name}/{path.relative_to(folder).as_posix()}")
            member.size, member.mtime, member.mode = path.stat().st_size, time, 0o644
            with path.open("rb") as file:
                archive.addfile(member, file)
    return gzip.compress(tar.getvalue(), mtime=0)


def build_source_package() -> None:
    call = f"from scikit_build_core import build; build.build_sdist({str(PYTHON)!r})"
    subprocess.run([sys.executable, "-c", call], cwd=ROOT, check=True, stdout=sys.stderr)


def sums(folder: Path) -> str:
    """A line for each file, as sha256sum writes and reads them."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.name != "SHA256SUMS")
    names = {path: path.relative_to(folder).as_posix() for path in files}
    return "".join(f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {name}\n" for path, name in names.items())


def main(wheels: list[str]) -> int:
    if changed := git("status", "--porcelain"):
        print(f"make dist publishes a commit, and these files are not committed:\n{changed}", file=sys.stderr)
        return 2
    time = int(git("log", "-1", "--format=%ct"))
    os.environ["SOURCE_DATE_EPOCH"] = str(time)
    shutil.rmtree(DIST, ignore_errors=True)
    PYTHON.mkdir(parents=True)
    build_source_package()
    for wheel in wheels:
        shutil.copy(wheel, PYTHON)
    if (site := ROOT / "build/site").is_dir():
        (DIST / "site.tar.gz").write_bytes(packed(site, time))
    if (page := ROOT / "build/page/live.html").is_file():
        shutil.copy(page, DIST)
    (DIST / "SHA256SUMS").write_text(sums(DIST))
    print((DIST / "SHA256SUMS").read_text(), end="")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
