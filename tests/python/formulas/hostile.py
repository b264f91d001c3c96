"""Files that do what no formula should, by what they do; each text is the body of `def jacobian(q):`.

{victim} is a file, {folder} its folder, {new} a path where nothing is, {seconds} marks the processes that are started.
"""

# ruff: noqa: E501

from __future__ import annotations

_RAISED = ("ValueError", "TypeError", "ZeroDivisionError", "MemoryError", "KeyboardInterrupt", "SystemExit",
           "GeneratorExit", "StopIteration", "RecursionError", "OSError", "UnicodeError", "BaseException")  # fmt: skip
_RETURNED = ("None", "'J'", "b'J'", "object()", "[object()]*9", "[1j]*9", "{{}}", "{{1: 2}}", "set('abc')", "print", "...",
             "NotImplemented", "float", "[None]*9", "[['1']*3]*3", "(i for i in 'abc')", "open", "q.tolist", "1 if 0 else ()",
             "[float('nan')]*9", "[[1e400]*3]*3", "[True, [False]]")  # fmt: skip
_SHAPES = ("1.0", "[]", "[[]]", "[1]*8", "[[1]*3]*2", "[[1]*4]*4", "[[[1]]]", "[[1, 2], [3]]", "[1]*10**6", "[[1]*9]*9")
_MODULES = "import os, sys, socket, subprocess, signal, ctypes, threading, shutil, tempfile, resource, gc, time, random"
_OTHERS: dict[str, tuple[str, ...]] = {
    "loops": (
        "while True: pass",
        "for _ in iter(int, 1): pass",
        "time.sleep(1e6)",
        "threading.Event().wait()",
        "sys.setrecursionlimit(10**9); f = lambda: f(); f()",
        "return 9**9**9",
        "lock = threading.Lock(); lock.acquire(); lock.acquire()",
        "signal.pause()",
        "sys.stdin.read(); input()",
        "[threading.Thread(target=time.sleep, args=(1e6,)).start() for _ in range(5)]",
    ),
    "ends": (
        "os._exit(0)", "os._exit(11)", "os.abort()", "os.kill(os.getpid(), 9)", "signal.raise_signal(signal.SIGSEGV)",
        "ctypes.string_at(0)", "sys.exit()", "sys.exit('right')", "os.kill(os.getpid(), signal.SIGSTOP)",
        "os.execv('/bin/true', ['true'])", "signal.alarm(1); time.sleep(5)",
        "resource.setrlimit(resource.RLIMIT_CPU, (1, 1))\n    while True: pass",
    ),
    "prints": (
        "print('right')", "print('x' * 10**7)", "sys.stderr.write('Traceback')", "os.write(1, b'[]')",
        "os.write(2, b'x' * 10**6)", "sys.__stdout__.write('right')", "print(chr(27) + '[2J')",
    ),
    "answers in the program's name": (
        "[os.write(n, b'x' * 5000) for n in range(3, 12)]",
        "import struct\n    [os.write(n, struct.pack('<II', 15, 72) + b'{{\"shape\":[1,9]}}') for n in range(3, 12)]",
        "[os.write(n, bytes(8)) for n in range(3, 12)]",
        "[os.write(n, bytes([255] * 8)) for n in range(3, 12)]",
        "[os.close(n) for n in range(3, 12)]",
        "os.closerange(0, 1000)",
        "[os.dup2(0, n) for n in range(3, 12)]",
    ),
    "files": (
        "open({new!r}, 'w').write('x')", "open({victim!r}, 'a').write('x')", "os.remove({victim!r})",
        "os.rename({victim!r}, {new!r})", "os.mkdir({new!r})", "os.symlink({victim!r}, {new!r})",
        "os.link({victim!r}, {new!r})", "os.mkfifo({new!r})", "os.chmod({victim!r}, 0)", "os.truncate({victim!r}, 0)",
        "os.utime({victim!r}, (0, 0))", "shutil.rmtree({folder!r}, ignore_errors=True)",
        "shutil.copy({victim!r}, {new!r})", "tempfile.NamedTemporaryFile(delete=False, dir={folder!r}).write(b'x')",
        "os.open({new!r}, os.O_CREAT | os.O_RDWR)", "os.chdir({folder!r}); open('other', 'w')",
        "open(__file__, 'w').write('x')", "subprocess.run(['touch', {new!r}])", "os.system('rm -rf {folder}')",
        "os.mknod({new!r})", "os.replace({victim!r}, {new!r})",
        "import sqlite3; sqlite3.connect({new!r}).execute('create table t (a)')",
        "import socket as s; s.socket(s.AF_UNIX).bind({new!r})",
    ),
    "processes": (
        "subprocess.Popen(['sleep', '{seconds}'], start_new_session=True)",
        "os.fork() or (os.setsid(), os.execvp('sleep', ['sleep', '{seconds}']))",
        "os.fork() or os.fork() or os.execvp('sleep', ['sleep', '{seconds}'])",
        "os.system('nohup sleep {seconds} &')",
        "os.system('setsid sleep {seconds} & setsid sleep {seconds} &')",
        "subprocess.Popen(['sleep', '{seconds}']); os._exit(0)",
        "os.fork() or os.execvp('sleep', ['sleep', '{seconds}'])\n    os.kill(os.getpid(), 9)",
        "while True: os.fork()",
        "os.kill(os.getppid(), 9)", "os.kill(-1, 9)", "os.killpg(0, 9)", "os.kill(1, 9)", "os.nice(-20)",
        "import multiprocessing; multiprocessing.Pool(50).map(abs, range(9))",
        "[threading.Thread(target=time.sleep, args=(9,)).start() for _ in range(10**4)]",
    ),
    "sockets": (
        "socket.create_connection(('127.0.0.1', 9), 1)", "socket.create_server(('127.0.0.1', 0)).accept()",
        "socket.getaddrinfo('example.org', 80)", "socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'x', ('127.0.0.1', 9))",
        "import urllib.request; urllib.request.urlopen('http://127.0.0.1:9', timeout=1)",
    ),
    "memory": (
        "x = bytearray(5 << 30)", "return [1] * 10**12", "x = [0]\n    while True: x += x", "return 'x' * 10**11",
        "import numpy; return numpy.zeros((10**5, 10**5))", "x = {{}}\n    for i in iter(int, 1): x[len(x)] = [0] * 10**6",
        "os.memfd_create('x'); x = b'x' * (4 << 30)",
    ),
    "the interpreter": (
        "sys.modules['numpy'] = None; sys.exit(3)", "import builtins; del builtins.len", "os.environ.clear(); os.putenv('HOME', 'x')",
        "gc.get_objects()[0].clear()", "sys.settrace(lambda *a: 1 / 0)", "import atexit; atexit.register(time.sleep, 1e6)",
        "signal.signal(signal.SIGTERM, signal.SIG_IGN)", "sys.stdout = None; sys.stderr = None", "os.umask(0); os.chdir('/')",
        "threading.settrace(exit); exit()", "import numpy; numpy.array = None; numpy.asarray = None",
        "raise type('E', (BaseException,), {{'__str__': lambda self: 1/0}})()",
        "return type('A', (), {{'__array__': lambda *a, **k: os._exit(0)}})()",
        "return type('A', (), {{'tolist': lambda self: self}})()", "exec('(' * 10**5)", "compile('x' + '+x' * 10**6, '', 'eval')",
    ),
    "different answers": (
        "return [[random.random()] * 3] * 3", "return [[time.time()] * 3] * 3", "return [[id(object()) + random.random()] * 3] * 3",
        "random.seed(); return [random.choice(([1] * 9, [2] * 9)) for _ in 'x'][0]", "return [[float(os.urandom(1)[0])] * 3] * 3",
    ),
}  # fmt: skip
BODIES: dict[str, tuple[str, ...]] = {
    "raises": tuple(f"raise {name}('no')" for name in _RAISED),
    "returns": tuple(f"return {text}" for text in _RETURNED),
    "shapes": tuple(f"return {text}" for text in _SHAPES),
    **_OTHERS,
}
WHOLE_FILES = (
    "def jacobian(q:\n", "", "\0", "x = 1\n", "import nothing_like_this\ndef jacobian(q): return q\n", "while True: pass\ndef jacobian(q): return q\n",
    "def jacobian(q): return " + "(" * 5000 + ")" * 5000 + "\n", "def jacobian(q): return q" + "+q" * 20000 + "\n",
    "raise SystemExit(0)\ndef jacobian(q): return q\n", "def jacobian(): return 1\n", "def jacobian(a, b, c, d, e): return 1\n",
    "jacobian = 3\ndef jacobian(q): return q\njacobian = 3\n", "class jacobian: pass\n", "async def jacobian(q): return q\n",
    "def jacobian(q):\n\treturn q\n        return q\n", "def jacobian(q):\n    yield from iter(int, 1)\n",
)  # fmt: skip
"""Files as a whole: what is no program, what runs on import, what has no such function."""


def files() -> list[tuple[str, str]]:
    """What a file does, and its text."""
    found = [
        (kind, f"{_MODULES}\n\ndef jacobian(q):\n    {body}\n") for kind, bodies in BODIES.items() for body in bodies
    ]
    return [*found, *(("whole files", text.replace("{", "{{").replace("}", "}}")) for text in WHOLE_FILES)]
