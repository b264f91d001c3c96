"""Rewrites Python programs without changing their values: other orders of sums, expanded products, other sines."""

from __future__ import annotations

import ast
import random


class _Rewriter(ast.NodeTransformer):
    """Changes some expressions to equivalent ones; `scalars` are the only ones that are commuted in products."""

    def __init__(self, choose: random.Random, share: float) -> None:
        self.choose, self.share = choose, share

    def visit_BinOp(self, node: ast.BinOp) -> ast.AST:
        self.generic_visit(node)
        if self.choose.random() > self.share or _has_arrays(node):
            return node
        text = ast.unparse(node)
        left, right = ast.unparse(node.left), ast.unparse(node.right)
        if isinstance(node.op, ast.Add):
            return _parsed(
                self.choose.choice([f"({right}) + ({left})", f"({left}) - (-({right}))", f"-(-({left}) - ({right}))"])
            )
        if isinstance(node.op, ast.Sub):
            return _parsed(
                self.choose.choice([f"-({right}) + ({left})", f"-(({right}) - ({left}))", f"({left}) + (-1)*({right})"])
            )
        if isinstance(node.op, ast.Mult):
            if isinstance(node.right, ast.BinOp) and isinstance(node.right.op, ast.Add):
                one, other = ast.unparse(node.right.left), ast.unparse(node.right.right)
                return _parsed(f"({left})*({one}) + ({left})*({other})")
            return _parsed(self.choose.choice([f"({right})*({left})", f"-(({left})*(-({right})))", f"({text})*1.0"]))
        if isinstance(node.op, ast.Div):
            return _parsed(f"({left})*(1/({right}))")
        return node

    def visit_Call(self, node: ast.Call) -> ast.AST:
        self.generic_visit(node)
        name = ast.unparse(node.func)
        prefix, _, function = name.rpartition(".")
        if function not in ("sin", "cos") or self.choose.random() > self.share:
            return node
        prefix = prefix + "." if prefix else ""
        (angle,) = node.args
        x = ast.unparse(angle)
        sine, cosine = f"{prefix}sin", f"{prefix}cos"
        if isinstance(angle, ast.BinOp) and isinstance(angle.op, ast.Add):
            a, b = ast.unparse(angle.left), ast.unparse(angle.right)
            sums = {
                "sin": f"({sine}({a})*{cosine}({b}) + {cosine}({a})*{sine}({b}))",
                "cos": f"({cosine}({a})*{cosine}({b}) - {sine}({a})*{sine}({b}))",
            }
            return _parsed(sums[function])
        others = {
            "sin": [f"(-{sine}(-({x})))", f"(2*{sine}(({x})/2)*{cosine}(({x})/2))"],
            "cos": [f"{cosine}(-({x}))", f"(1 - 2*{sine}(({x})/2)**2)"],
        }
        return _parsed(self.choose.choice(others[function]))


def _parsed(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def _has_arrays(node: ast.AST) -> bool:
    return any(isinstance(one, (ast.MatMult, ast.List)) for one in ast.walk(node))


def rewritten(text: str, seed: int) -> str:
    """An equivalent text."""
    choose = random.Random(seed)
    tree = ast.parse(text)
    rewriter = _Rewriter(choose, choose.choice([0.2, 0.5, 0.9]))
    for function in tree.body:
        if isinstance(function, ast.FunctionDef):
            for statement in function.body:
                if not (isinstance(statement, ast.Assign) and isinstance(statement.value, ast.Constant)):
                    rewriter.visit(statement)
    return ast.unparse(ast.fix_missing_locations(tree)) + "\n"
