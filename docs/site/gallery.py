"""The gallery: every scenario with its picture, its first sentence, its command, and a link to the live page."""

from __future__ import annotations

import base64
import importlib.util
import zlib
from pathlib import Path
from types import ModuleType

DOCS = Path(__file__).parents[1]

BEGINNING = """# Gallery

Every scenario that the package brings, with the command that runs it. The commands work in a folder with a copy of the
scenarios, which this line makes once:

```sh
arm3r examples --copy scenarios
```

In a picture, the left part shows the arm and the wall from the side, where darker is later; the right part shows a
quantity over time, dashed where it is a reference.
"""


def scenario_index() -> ModuleType:
    """tools/scenario_index.py, which knows topics, first sentences and pictures."""
    spec = importlib.util.spec_from_file_location("scenario_index", DOCS.parent / "tools" / "scenario_index.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def live_link(live: str, text: str) -> str:
    """The address of the live page with a scenario in it, in the form that web/page/src/scenario/link.js reads."""
    code = base64.urlsafe_b64encode(zlib.compress(text.encode(), 9)).decode().rstrip("=")
    return f"{live}#s={code}"


def card(index: ModuleType, path: Path, live: str) -> str:
    name = path.relative_to(index.SCENARIOS).as_posix()
    picture = f"/docs/{index.picture_of(path).relative_to(DOCS).as_posix()}"
    link = f' · <a href="{live_link(live, path.read_text())}">live</a>' if live else ""
    return (
        f"::::{{container}} scenario\n"
        f"![{index.alternative_text(path)}]({picture})\n\n"
        f"[{path.stem}](/scenarios/{name}){link}\n\n{index.summary(path)}\n\n"
        f"```sh\narm3r run scenarios/{name}\n```\n::::\n"
    )


def page(live: str = "") -> str:
    """The page as MyST Markdown. live: the address of the live page, empty where there is none."""
    index = scenario_index()
    parts, topic = [BEGINNING], None
    for path in index.files():
        if path.parent.name == "sweeps":
            continue
        if path.parent != topic:
            parts += [":::::\n"] if topic else []
            topic = path.parent
            parts.append(f"## {index.TITLES[topic.name]}\n\n:::::{{container}} gallery\n")
        parts.append(card(index, path, live))
    return "\n".join([*parts, ":::::\n"])
