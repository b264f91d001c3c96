"""Expressions of sympy become functions of their symbols."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any


def is_expression(value: Any) -> bool:
    return (
        not isinstance(value, type) and type(value).__module__.split(".")[0] == "sympy" and hasattr(value, "xreplace")
    )


def function_of(expression: Any) -> tuple[Callable[..., Any], list[str]]:
    """A function of the symbols of an expression, and their names, which tell their order."""
    import sympy

    expression = _without_time(expression)
    symbols = sorted(expression.free_symbols, key=lambda symbol: symbol.name)
    return sympy.lambdify(symbols, expression, "numpy"), [symbol.name for symbol in symbols]


def _without_time(expression: Any) -> Any:
    """Functions of time, as `dynamicsymbols` makes them, become symbols: q1(t) is q1, its derivatives qd1 and qdd1."""
    import sympy

    of_time = sympy.core.function.AppliedUndef
    rates = {
        rate: sympy.Symbol(re.sub(r"(?=\d*$)", "d" * rate.derivative_count, rate.expr.func.__name__, count=1))
        for rate in expression.atoms(sympy.Derivative)
        if isinstance(rate.expr, of_time)
    }
    expression = expression.xreplace(rates)
    return expression.xreplace({one: sympy.Symbol(one.func.__name__) for one in expression.atoms(of_time)})
