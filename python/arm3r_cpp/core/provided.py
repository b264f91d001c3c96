"""What methods of scenarios, runs and batches do by rooms above this one: the package says where, and it is loaded when
it is first asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from operator import attrgetter
from typing import Any

_places: dict[str, str] = {}


def provide(places: Mapping[str, str]) -> None:
    """places: of each function its module and its name there, such as "arm3r_cpp.live.show:write"."""
    _places.update(places)


def provided(name: str) -> Callable[..., Any]:
    module, function = _places[name].split(":")
    found: Callable[..., Any] = attrgetter(function)(import_module(module))
    return found
