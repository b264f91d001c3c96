"""The folder of a sweep: what was asked, finished shards, and the ledger that says which of them can be trusted."""

from __future__ import annotations

import hashlib
import json
import os
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from io import FileIO
from itertools import zip_longest
from pathlib import Path
from typing import Any

from .._files import regular, replacing, writing
from ..answers.refusals import Refusal, merged
from ..errors import IncompatibleError, OutputError, UsageError
from ..system.file_lock import try_lock

NEEDED = {"table", "mode", "columns", "axes", "runs", "scenario", "version"}  # of the manifest, for readers
MANIFEST, LEDGER, LOCK, SHARDS = "sweep.json", "ledger.jsonl", "lock", "shards"


def sha256(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


class _Damaged(Exception):
    """A shard's file is not what the ledger says; the message says in what."""


class SweepFolder:
    """A folder that this process holds the lock of.

    A shard counts as finished when the ledger has a whole line of it, and its file has the size and the checksum that
    the line says.
    """

    def __init__(self, path: Path, manifest: Mapping[str, Any]) -> None:
        """`SweepFolder.open` makes folders."""
        self.path, self.manifest = path, manifest
        self._manifest_hash = sha256(json.dumps(manifest).encode())
        self.finished: dict[int, tuple[int, str]] = {}  # size and checksum of a shard
        self.runs_done = 0

    @classmethod
    @contextmanager
    def open(cls, path: Path, manifest: Mapping[str, Any], *, resume: bool) -> Iterator[SweepFolder]:
        """The folder for a sweep, new or resumed.

        Raises:
            OutputError: it cannot be written, another process works in it, or it is not empty without `resume`.
            IncompatibleError: it was begun with something else; all that differs is listed.
        """
        folder = cls(path, manifest)
        with writing(path):
            path.mkdir(parents=True, exist_ok=True)
            folder._begun(resume)  # before anything is written: it may be a folder of another kind
            lock = (path / LOCK).open("a+b", buffering=0)  # nothing is left for close() to write
        with lock:
            with writing(path):
                _lock(lock, path)
                folder._begin(resume)
            yield folder

    def _begun(self, resume: bool) -> bool:
        """Whether a sweep was begun here. OutputError: the folder is not for this sweep."""
        inside = {entry.name for entry in self.path.iterdir() if not entry.name.endswith(".part")}
        begun = MANIFEST in inside
        if inside - {LOCK} and not resume:
            raise OutputError(f"{self.path}: exists; give another folder, or --resume to go on in it", code="output")
        if inside - {LOCK} and not begun:
            raise OutputError(
                f"{self.path}: there is no {MANIFEST} in it: it is not the folder of a sweep", code="output"
            )
        return begun

    def _begin(self, resume: bool) -> None:
        if self._begun(resume):
            self._compare(read_manifest(self.path))
        else:
            publish(self.path / MANIFEST, json.dumps(self.manifest, indent=1).encode() + b"\n")
        (self.path / SHARDS).mkdir(exist_ok=True)
        self._clear()
        self._read_ledger()

    def _compare(self, begun: Mapping[str, Any]) -> None:
        lines = sorted(_differences(begun, self.manifest), key=lambda line: line.startswith("hashes"))
        if lines:
            raise IncompatibleError(
                f"{self.path}: was begun with something else; resume with the same, or give another folder"
                + "".join(f"\n  {line}" for line in lines),
                code="sweep.differs",
            )

    def _clear(self) -> None:
        """Remove the unfinished files of a process that was killed."""
        for part in [*self.path.glob("*.part"), *(self.path / SHARDS).glob("*.part")]:
            part.unlink()

    # ---- shards

    def shard(self, number: int) -> Path:
        return self.path / SHARDS / f"{number:06}.{self.manifest['table']}"

    def store(self, number: int, first: int, count: int, data: bytes, outcomes: Mapping[str, int],
              refusals: Sequence[Refusal] = ()) -> None:  # fmt: skip
        """Write a finished shard, then its line of the ledger. A shard that is stored already stays as it is."""
        if number in self.finished:
            return
        file = self.shard(number)
        publish(file, data)
        line = {"first": first, "count": count, "file": f"{SHARDS}/{file.name}", "size": len(data)}
        line |= {"sha256": sha256(data), "outcomes": dict(outcomes)}
        line |= {"refusals": [list(one) for one in refusals]} if refusals else {}
        with writing(self.path), (self.path / LEDGER).open("ab") as ledger:
            ledger.write(_with_checksum(line, self._manifest_hash))
        self._acknowledge(number, line)

    def read(self, number: int) -> bytes:
        """A finished shard, read back.

        Raises:
            OutputError: the file no longer holds what was stored.
        """
        file = self.shard(number)
        try:
            return _checked(file, *self.finished[number])
        except (_Damaged, OSError) as fault:
            message = f"{file}: {fault}; resuming does its runs again"
            raise OutputError(message, code="output") from None

    def _acknowledge(self, number: int, line: Mapping[str, Any]) -> None:
        self.finished[number] = line["size"], line["sha256"]
        self.runs_done += line["count"]

    def _read_ledger(self) -> None:
        """Read the finished shards, warn about lines and files that are damaged, and write the ledger without them."""
        path = self.path / LEDGER
        path.touch()
        with writing(path):
            regular(path)
        with path.open("rb") as ledger, replacing(path) as part, part.open("wb") as clean:
            for text in ledger:
                line = _without_checksum(text, self._manifest_hash)
                if line is None:
                    warnings.warn(f"{path}: a line is torn or of another sweep; its runs are done again", stacklevel=2)
                    continue
                number = line["first"] // self.manifest["shard"]
                try:
                    _checked(self.path / line["file"], line["size"], line["sha256"])
                except _Damaged as fault:
                    runs = f"runs {line['first']} to {line['first'] + line['count'] - 1}"
                    warnings.warn(f"{line['file']}: {fault}; {runs} are done again", stacklevel=2)
                else:
                    if number not in self.finished:
                        clean.write(_with_checksum(line, self._manifest_hash))
                        self._acknowledge(number, line)


def _checked(path: Path, size: int, checksum: str) -> bytes:
    """What a shard's file holds. _Damaged: it is not what the ledger says."""
    if not path.is_file():
        raise _Damaged("is missing")
    data = path.read_bytes()
    if len(data) != size:
        raise _Damaged(f"has {len(data)} bytes, not {size}")
    if sha256(data) != checksum:
        raise _Damaged("does not have the checksum that the ledger says")
    return data


def count_outcomes(lines: Iterable[Mapping[str, Any]]) -> dict[str, int]:
    """How many runs ended in which way, by the lines of a ledger."""
    counts: Counter[str] = Counter()
    for line in lines:
        counts.update(line["outcomes"])
    return dict(sorted(counts.items()))


def refusals_in(lines: Iterable[Mapping[str, Any]]) -> list[Refusal]:
    """Why runs are invalid, by the lines of a ledger, in the order of the runs: shards are finished in any."""
    in_order = sorted(lines, key=lambda line: line["first"])
    return merged([Refusal(*one) for one in line.get("refusals", [])] for line in in_order)


def publish(path: Path, data: bytes) -> None:
    """Write a file whole or not at all."""
    with replacing(path) as part:
        part.write_bytes(data)


def _lock(lock: FileIO, path: Path) -> None:
    """Lock the folder until this process ends, in whatever way it ends."""
    if not try_lock(lock):
        lock.seek(0)
        holder = lock.read().decode(errors="replace").strip()
        raise OutputError(f"{path}: in use by pid {holder or '?'}", code="output.in_use")
    lock.seek(0)
    lock.truncate()
    lock.write(f"{os.getpid()}\n".encode())


def read_manifest(path: Path) -> dict[str, Any]:
    """What was asked of the sweep in a folder.

    Raises:
        UsageError: it cannot be read, or is damaged.
    """
    try:
        manifest = json.loads(regular(path / MANIFEST).read_bytes())
        if isinstance(manifest, dict) and manifest.keys() >= NEEDED:
            return manifest
    except OSError as error:
        raise UsageError(f"{path}: {MANIFEST} cannot be read: {error.strerror}", code="file") from error
    except (ValueError, RecursionError):
        pass
    raise UsageError(f"{path}: {MANIFEST} is damaged; run the sweep in another folder", code="file")


def _with_checksum(line: Mapping[str, Any], manifest_hash: str) -> bytes:
    """A line of the ledger with a checksum of it and of the sweep that it belongs to."""
    check = sha256(f"{manifest_hash} {json.dumps(line)}".encode())[:16]
    return json.dumps({**line, "check": check}).encode() + b"\n"


def _without_checksum(text: bytes, manifest_hash: str) -> dict[str, Any] | None:
    """A line of the ledger; None: it is damaged, or it belongs to another sweep."""
    try:
        line = json.loads(text)
        del line["check"]
        return line if _with_checksum(line, manifest_hash).rstrip() == text.rstrip() else None
    except (ValueError, RecursionError, KeyError, AttributeError, TypeError):
        return None


def _differences(then: Any, now: Any) -> Iterator[str]:
    """What differs between two manifests, a line each: of maps part by part, of texts the first line that differs."""
    if isinstance(then, Mapping) and isinstance(now, Mapping):
        for key in dict.fromkeys([*then, *now]):
            yield from (f"{key}: {line}" for line in _differences(then.get(key), now.get(key)))
    elif isinstance(then, str) and isinstance(now, str) and "\n" in now and then.splitlines() != now.splitlines():
        pairs = enumerate(zip_longest(then.splitlines(), now.splitlines()), 1)
        number, (before, after) = next((number, pair) for number, pair in pairs if pair[0] != pair[1])
        yield from (f"line {number}: {line}" for line in _differences(before, after))
    elif then != now:
        yield "{} then, {} now".format(*_excerpts(json.dumps(then), json.dumps(now)))


def _excerpts(then: str, now: str) -> tuple[str, str]:
    """Of two texts that are too long to be shown, what stands around their first difference."""
    before, after = 20, 40
    if max(len(then), len(now)) <= before + after:
        return then, now
    same = next((i for i, (a, b) in enumerate(zip(then, now, strict=False)) if a != b), min(len(then), len(now)))
    first = max(same - before, 0)
    head = "..." if first else ""
    part = slice(first, first + before + after)
    return tuple(head + text[part] + ("..." if len(text) > part.stop else "") for text in (then, now))  # type: ignore
