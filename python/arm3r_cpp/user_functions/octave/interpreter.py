"""GNU Octave's interpreter as a library of this process: a confined process can start no program.

The library is called as Octave's own command does it: an application is made of the words of a command line, and is
executed. It runs a loop that takes requests from standard input and answers to standard output.
"""

from __future__ import annotations

import ctypes
import os
import struct
import threading
from typing import NamedTuple

from ..programs import Unread

_OPTIONS = ("--no-gui", "--norc", "--no-history", "--no-line-editing", "--quiet", "--eval")
_MAKE, _EXECUTE = "_ZN6octave11applicationC2EiPPc", "_ZN6octave15cli_application7executeEv"
_TABLE_OF_METHODS = "_ZTVN6octave15cli_applicationE"
_OWN_METHODS = 2 * ctypes.sizeof(ctypes.c_void_p)  # behind two words about the class
_SIZE = 1 << 16  # bytes of an application, more than any version has
_STACK = 64 << 20  # bytes for functions that call themselves, up to Octave's own limit
_SIZES = struct.Struct("=2d")
_ANSWER = struct.Struct("=3d")
_MARK_BYTES = 16
_MOST_BYTES = 64 << 20
# A request: the length of its code, how many numbers it has, the code, the numbers. Its code sets `a__`, the numbers of
# an answer, or fails. What the user's function prints comes before the mark.
_LOOP = """
warning('off', 'all'); page_screen_output(false);
while true
  n__ = fread(stdin, 2, 'double');
  if numel(n__) < 2, break; end
  m__ = fread(stdin, 16, 'uint8');
  c__ = fread(stdin, n__(1), 'uint8=>char')';
  x__ = fread(stdin, n__(2), 'double');
  a__ = []; s__ = '';
  try
    eval(c__);
  catch e__
    s__ = sprintf('%s\\n', e__.identifier);
    for p__ = 1:numel(e__.stack)
      s__ = [s__ sprintf('%s|%s|%d\\n', e__.stack(p__).file, e__.stack(p__).name, e__.stack(p__).line)];
    end
    s__ = [s__ sprintf('\\n') e__.message]; a__ = [];
  end
  fwrite(stdout, m__, 'uint8');
  fwrite(stdout, [numel(s__), size(a__, 1), size(a__, 2)], 'double');
  fwrite(stdout, s__, 'uint8');
  fwrite(stdout, a__, 'double');
  fflush(stdout);
end
"""


class Answer(NamedTuple):
    """What the code of a request came to."""

    error: str
    """The identifier of what it raised, a line for each function on the way, an empty line, and the message; or ""."""
    numbers: bytes
    columns: int


class Interpreter:
    """Octave, in a thread of this process; standard input and output belong to it."""

    def __init__(self, library: str) -> None:
        """
        Raises:
            Unread: the library is no such interpreter.
        """
        try:
            octave = ctypes.CDLL(library, mode=ctypes.RTLD_GLOBAL)  # parts of Octave are loaded by its own names
            make, execute = octave[_MAKE], octave[_EXECUTE]
            methods = ctypes.addressof(ctypes.c_char.in_dll(octave, _TABLE_OF_METHODS)) + _OWN_METHODS
        except (OSError, AttributeError, ValueError) as error:
            raise Unread(f"GNU Octave cannot be used here: {error}") from None
        (theirs, self._requests), (self._answers, others) = os.pipe(), os.pipe()
        os.dup2(theirs, 0)
        os.dup2(others, 1)
        os.close(theirs)
        os.close(others)
        self._rest = b""
        os.environ["JAVA_HOME"] = os.devnull  # Java cannot start in a confined process, and would end it
        threading.stack_size(_STACK)
        threading.Thread(target=_run, args=(make, execute, methods), daemon=True).start()

    def ask(self, code: str, numbers: bytes = b"") -> Answer:
        """Have Octave run code that sets `a__`; the numbers of the request are `x__` there."""
        text, mark = code.encode(), os.urandom(_MARK_BYTES)
        self._write(_SIZES.pack(len(text), len(numbers) // 8) + mark + text + numbers)
        self._skip_to(mark)
        length, rows, columns = map(int, _ANSWER.unpack(self._read(_ANSWER.size)))
        error = self._read(length).decode(errors="replace")
        return Answer(error, self._read(rows * columns * 8), columns)

    def _write(self, text: bytes) -> None:
        while text:
            text = text[os.write(self._requests, text) :]

    def _skip_to(self, mark: bytes) -> None:
        """Past what the user's function has printed."""
        while mark not in self._rest:
            self._rest = self._rest[-len(mark) :]
            self._read_more()
        self._rest = self._rest.partition(mark)[2]

    def _read(self, count: int) -> bytes:
        if count > _MOST_BYTES:
            raise Unread("returns too many numbers")
        while len(self._rest) < count:
            self._read_more()
        found, self._rest = self._rest[:count], self._rest[count:]
        return found

    def _read_more(self) -> None:
        """Ends the process where Octave has closed its output."""
        self._rest += os.read(self._answers, 1 << 16) or os._exit(0)


def _run(make: ctypes._NamedFuncPointer, execute: ctypes._NamedFuncPointer, methods: int) -> None:
    """Run Octave to its end, which is that of the process."""
    words = [one.encode() for one in ("octave", *_OPTIONS, _LOOP)]
    arguments = (ctypes.c_char_p * (len(words) + 1))(*words, None)
    application = ctypes.create_string_buffer(_SIZE)
    make(application, ctypes.c_int(len(words)), arguments)
    ctypes.cast(application, ctypes.POINTER(ctypes.c_void_p))[0] = methods
    execute(application)
    os._exit(0)
