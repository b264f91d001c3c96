"""The page, served to browsers of this computer alone."""

from __future__ import annotations

import signal
import threading
import webbrowser
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from ..errors import UsageError
from . import page

HOST = "127.0.0.1"
TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".json": "application/json",
    ".txt": "text/plain; charset=utf-8",
    ".wasm": "application/wasm",
    ".png": "image/png",
}


class _Server(ThreadingHTTPServer):
    """Ends at the next turn of its loop: raised anywhere, Ctrl-C may fall where Python drops exceptions."""

    is_to_end = False

    def service_actions(self) -> None:
        if self.is_to_end:
            raise KeyboardInterrupt

    def end(self, *_: object) -> None:
        self.is_to_end = True


@contextmanager
def _ended_by_ctrl_c(server: _Server) -> Iterator[None]:
    """In the main thread, the only one that a signal reaches."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, server.end)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def serve(index: str, *, port: int, browser: bool, say: Callable[[str], None]) -> None:
    """Serve the page until Ctrl-C.

    Args:
        index: the HTML that / answers.
        port: 0 takes a free one.
        browser: whether to open it.
        say: called with the line that tells the address.

    Raises:
        UsageError: the port cannot be used.
    """
    try:
        server = _Server((HOST, port), _handler(index.encode()))
    except OSError as error:
        raise UsageError(
            f"--port {port}: cannot be used: {error.strerror}; 0 takes a free one", code="usage"
        ) from error
    with server, _ended_by_ctrl_c(server):
        address = f"http://{HOST}:{server.server_port}/"
        say(f"{address} shows the page; Ctrl-C ends it")
        if browser:
            webbrowser.open(address)
        try:
            server.serve_forever()
        except KeyboardInterrupt:  # the way in which it ends
            return


def _handler(index: bytes) -> type[BaseHTTPRequestHandler]:
    files = {f"/{path.relative_to(page.FOLDER).as_posix()}": path for path in page.FOLDER.rglob("*")}

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            host, _, _ = self.headers.get("Host", "").rpartition(":")
            content = content_of(self.path.partition("?")[0]) if host in (HOST, "localhost") else None
            if content is None:
                self.send_error(HTTPStatus.NOT_FOUND)
                return
            kind, data = content
            self.send_response(HTTPStatus.OK)
            self.send_header("Content-Type", kind)
            self.send_header("Content-Length", str(len(data)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(data)

        def log_message(self, *_: object) -> None:
            """Nothing: the terminal keeps the address in sight."""

    def content_of(path: str) -> tuple[str, bytes] | None:
        """Type and bytes of what stands at a path; None: nothing that is served."""
        if path in ("/", "/index.html"):
            return TYPES[".html"], index
        file = files.get(path)
        return (TYPES[file.suffix], file.read_bytes()) if file and file.suffix in TYPES else None

    return Handler
