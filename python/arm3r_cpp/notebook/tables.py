"""Runs and batches as objects of pandas and xarray."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import UsageError

if TYPE_CHECKING:
    import pandas
    import xarray
    from numpy.typing import NDArray

    from ..core.batch import Batch
    from ..core.run import Run


def _library(name: str) -> Any:
    """UsageError: it is not installed."""
    try:
        return import_module(name)
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
        raise UsageError(
            f"{name} is not installed; install it with `pip install 'arm3r_cpp[{name}]'`", code="extra"
        ) from None


def run_to_pandas(run: Run) -> pandas.DataFrame:
    frame = _library("pandas").DataFrame({name: run[name] for name in run.columns if name != "t"})
    frame.index = _library("pandas").Index(run.t, name="t")
    frame.attrs = {"name": run.summary["name"], "outcome": run.outcome, "units": dict(run.units)}
    return frame


def run_to_xarray(run: Run) -> xarray.Dataset:
    variables = {name: ("t", run[name], {"units": run.units[name]}) for name in run.columns}
    time = {"t": variables.pop("t")}
    about = {"name": run.summary["name"], "outcome": run.outcome, "hash": run.summary["hash"]}
    return _library("xarray").Dataset(variables, coords=time, attrs=about)


def batch_to_pandas(batch: Batch[Any]) -> pandas.DataFrame:
    columns: dict[str, Any] = {}
    for axis in batch.varied:
        values = np.broadcast_to(axis.values, (*batch.shape, axis.values.shape[-1]))
        columns |= {name: values[..., i].ravel() for i, name in enumerate(axis.names)}
    columns["outcome"] = batch.outcomes.ravel()
    columns |= {name: batch[name].ravel() for name in batch.names if name != "outcome"}
    frame = _library("pandas").DataFrame(columns)
    frame.index.name = "run"
    frame.attrs = {"units": dict(batch.units)}
    return frame


def batch_to_xarray(batch: Batch[Any]) -> xarray.Dataset:
    dimensions = _dimensions(batch)
    variables: dict[str, Any] = {n: (dimensions, batch[n], {"units": batch.units[n]}) for n in batch.names}
    variables["outcome"] = (dimensions, batch.outcomes, {})
    return _library("xarray").Dataset(variables, coords=_coordinates(batch, dimensions))


def _dimensions(batch: Batch[Any]) -> tuple[str, ...]:
    """A dimension has the key of the one axis that varies along it and nowhere else; if not, "run" or "axis_0", ..."""
    names = []
    for place in range(len(batch.shape)):
        along = [(axis.key, places) for axis in batch.varied if place in (places := _varies(batch, axis.values))]
        is_own = len(along) == 1 and along[0][1] == [place]
        names.append(along[0][0] if is_own else "run" if len(batch.shape) == 1 else f"axis_{place}")
    return tuple(names)


def _varies(batch: Batch[Any], values: NDArray[Any]) -> list[int]:
    """The places in the shape of the batch along which an axis (..., numbers) has values of its own."""
    own = values.shape[:-1]
    first = len(batch.shape) - len(own)
    return [first + i for i, size in enumerate(own) if size > 1 or batch.shape[first + i] == 1]


def _coordinates(batch: Batch[Any], dimensions: tuple[str, ...]) -> dict[str, Any]:
    coordinates: dict[str, Any] = {}
    for axis in batch.varied:
        places = _varies(batch, axis.values)
        here = tuple(dimensions[place] for place in places)
        values = axis.values.reshape(*(batch.shape[place] for place in places), axis.values.shape[-1])
        for i, name in enumerate(axis.names):
            coordinates[name] = (here, values[..., i], {"units": axis.unit})
        if len(axis.names) > 1 and axis.key in dimensions:  # a dimension's own coordinate is one number a place
            coordinates[axis.key] = ((axis.key,), np.arange(batch.shape[dimensions.index(axis.key)]))
    return coordinates
