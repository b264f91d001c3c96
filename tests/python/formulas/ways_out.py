"""Ways out of the process that runs a user's file: each is a body of Python that must raise there.

At hand are `own`, `other`, `table`, `fifo`, `path` and `name` of Unix sockets, `package` and `library` (of this
package), the modules that are imported below, `c` (the C library), and `call(number, ...)`, a bare system call of
x86_64; both raise OSError where they fail.
"""

# ruff: noqa: E501

from __future__ import annotations

HEAD = """
import ctypes, fcntl, gc, glob, mmap, os, resource, select, signal, socket, struct, subprocess, sys, threading, time
import platform

OWN, OTHER, TABLE, FIFO, PATH, NAME, PACKAGE, LIBRARY = {names!r}
own, other, table, fifo, path, name, package, library = OWN, OTHER, TABLE, FIFO, PATH, NAME, PACKAGE, LIBRARY
_libc = ctypes.CDLL(None, use_errno=True)

def _checked(result):
    if result == -1:
        raise OSError(ctypes.get_errno(), "refused")
    return result

class c:
    def __getattr__(self, word):
        return lambda *arguments: _checked(getattr(_libc, word)(*arguments))

c = c()

def call(number, *arguments):
    if platform.machine() != "x86_64":
        raise OSError("numbers of x86_64")
    return _checked(_libc.syscall(*(ctypes.c_long(one) if isinstance(one, int) else one for one in (number, *arguments))))

def gravity(way):
    try:
        exec(WAYS[int(way)], globals())
    except Exception:
        return 0.0
    return 1.0
"""
_WRITE = {
    "write": "open(own, 'a')", "write and read": "os.open(own, os.O_RDWR)", "truncate by opening": "os.open(own, os.O_RDONLY | os.O_TRUNC)",
    "truncate": "os.truncate(own, 0)", "ftruncate": "os.ftruncate(os.open(own, os.O_RDONLY), 0)", "create": "open(own + 'x', 'x')",
    "openat2": "call(437, -100, own.encode(), struct.pack('QQQ', 1, 0, 0), 24)", "unnamed file": "os.open(os.path.dirname(own), os.O_TMPFILE | os.O_RDWR)",
    "shared mapping": "mmap.mmap(os.open(own, os.O_RDONLY), 0, mmap.MAP_SHARED, mmap.PROT_READ | mmap.PROT_WRITE)",
    "mapping made writable": "f = os.open(own, os.O_RDONLY); _libc.mmap.restype = ctypes.c_void_p; a = _libc.mmap(None, ctypes.c_size_t(1), 1, 1, f, 0); c.mprotect(ctypes.c_void_p(a), ctypes.c_size_t(1), 3)",
    "remove": "os.remove(own)", "rename": "os.rename(own, own + 'x')", "renameat2": "call(316, -100, own.encode(), -100, (own + 'x').encode(), 0)",
    "link": "os.link(own, own + 'x')", "symbolic link": "os.symlink(own, own + 'x')", "folder": "os.mkdir(own + 'x')", "remove folder": "os.rmdir(os.path.dirname(own))",
    "FIFO": "os.mkfifo(own + 'x')", "device": "os.mknod(own + 'x', 0o600 | 0o020000, os.makedev(1, 1))", "mode": "os.chmod(own, 0)", "mode of an open file": "os.fchmod(os.open(own, os.O_RDONLY), 0)",
    "fchmodat2": "call(452, -100, own.encode(), 0, 0)", "owner": "os.chown(own, 1, 1)", "times": "os.utime(own, (0, 0))", "attribute": "os.setxattr(own, 'user.x', b'x')",
    "lock": "fcntl.flock(os.open(own, os.O_RDONLY), fcntl.LOCK_EX | fcntl.LOCK_NB)", "lease": "fcntl.fcntl(os.open(own, os.O_RDONLY), fcntl.F_SETLEASE, fcntl.F_RDLCK)",
    "preallocate": "os.posix_fallocate(3, 0, 9)", "shared memory file": "open('/dev/shm/arm3r_way_out', 'w')", "temporary": "open('/tmp/arm3r_way_out', 'w')",
    "swap": "c.swapon(own.encode(), 0)", "quota": "call(179, 0, None, 0, None)", "watch": "c.inotify_init()", "watch all": "c.fanotify_init(0, 0)",
    "splice": "os.splice(3, 4, 1)", "copy range": "os.copy_file_range(3, 4, 1)", "write from elsewhere": "c.process_madvise(3, None, 0, 0, 0)",
}  # fmt: skip
_READ = {
    "another submission": "open(other)", "folders of others": "os.listdir(os.path.dirname(os.path.dirname(other)))", "found by a pattern": "glob.glob(os.path.dirname(other) + '/*')[0]; open(other)",
    "a link to another submission": "open(os.path.join(os.path.dirname(own), 'link'))", "another submission by a path": "open(os.path.join(os.path.dirname(own), '..', 'other', os.path.basename(other)))",
    "mapped": "os.open(other, os.O_RDONLY)", "path alone, then its copy": "f = os.open(other, os.O_PATH); os.open(f'/proc/self/fd/{f}', os.O_RDONLY)", "the marks": "open(table)",
    "hidden": "open(os.path.join(os.path.dirname(own), '.hidden'))", "users": "open('/etc/passwd')", "passwords": "open('/etc/shadow')", "keys": "os.listdir('/root/.ssh')", "homes": "os.listdir('/home')",
    "root": "os.listdir('/')", "temporary files": "os.listdir('/tmp')", "processes": "os.listdir('/proc')", "status": "open('/proc/self/status')", "parent's environment": "open(f'/proc/{os.getppid()}/environ')",
    "parent's memory": "open(f'/proc/{os.getppid()}/mem', 'rb')", "own memory map": "open('/proc/self/maps')", "own files": "os.listdir('/proc/self/fd')", "parent's files": "os.listdir(f'/proc/{os.getppid()}/fd')",
    "kernel": "os.listdir('/sys')", "handle": "call(304, -100, b'x' * 24, 0)", "name to handle": "call(303, -100, own.encode(), b'\\x80' + bytes(150), bytes(8), 0)", "terminal": "os.open('/dev/tty', os.O_RDONLY)",
    "disk": "os.open('/dev/sda', os.O_RDONLY)", "memory device": "os.open('/dev/mem', os.O_RDONLY)", "kernel log": "call(103, 3, bytes(99), 99)", "files that are open": "[os.fstat(n) for n in range(5, 64)]",
    "more open files": "[os.fstat(n) for n in range(64, 1024)]",
}  # fmt: skip
_PRIVILEGE = {
    "remount": "c.mount(None, b'/', None, 32 | 4096, None)", "mount": "c.mount(b'none', b'/tmp', b'tmpfs', 0, None)", "unmount": "c.umount2(b'/proc', 2)", "new mount": "call(430, b'tmpfs', 0)", "mount attributes": "call(442, -100, b'/', 0x8000, bytes(32), 32)",
    "copy of a mount": "call(428, -100, b'/', 1)", "pivot_root": "call(155, b'/', b'/')", "chroot": "os.chroot('/')", "unshare user": "c.unshare(0x10000000)", "unshare files": "c.unshare(0x20000)", "unshare network": "c.unshare(0x40000000)",
    "setns": "c.setns(3, 0)", "clone a namespace": "call(56, 0x10000000 | 17, 0, 0, 0, 0)", "clone3": "call(435, struct.pack('11Q', 0x10000000, 0, 0, 0, 17, 0, 0, 0, 0, 0, 0), 88)",
    "setuid": "os.setuid(0)", "setresuid": "os.setresuid(0, 0, 0)", "setgid": "os.setgid(0)", "setgroups": "os.setgroups([0])", "capset": "c.capset((ctypes.c_uint32 * 2)(0x20080522, 0), (ctypes.c_uint32 * 6)(*[0xffffffff] * 6))",
    "ambient": "c.prctl(47, 2, 21, 0, 0)", "dumpable": "c.prctl(4, 1, 0, 0, 0)", "outlive the parent": "c.prctl(1, 0, 0, 0, 0)", "new filter": "call(317, 1, 0, None)", "keep capabilities": "c.prctl(8, 1, 0, 0, 0)",
    "tracer": "c.prctl(0x59616d61, -1, 0, 0, 0)", "personality": "c.personality(0x0400000)", "bpf": "call(321, 0, bytes(128), 128)", "perf": "call(298, bytes(128), 0, -1, -1, 0)", "userfaultfd": "call(323, 1)",
    "io_uring": "call(425, 1, bytes(120))", "io_setup": "call(206, 1, bytes(8))", "key": "call(248, b'user', b'x', b'x', 1, -3)", "keyctl": "call(250, 0, -3, 1)", "module": "call(313, 3, b'', 0)", "reboot": "call(169, 1, 2, 3)", "clock": "time.clock_settime(0, 0)",
    "host name": "socket.sethostname('x')", "io ports": "call(172, 3)", "raise limits": "resource.setrlimit(resource.RLIMIT_FSIZE, (-1, -1))", "raise memory": "resource.setrlimit(resource.RLIMIT_AS, (-1, -1))", "limits of the parent": "resource.prlimit(os.getppid(), resource.RLIMIT_CPU, (1, 1))",
    "call of 32 bits": "call(0x40000000 + 39)", "another landlock": "call(444, bytes(8), 8, 0)", "secret memory": "call(447, 0)", "ioctl": "fcntl.ioctl(3, 0x5412, b'x')", "owner of a signal": "fcntl.fcntl(3, fcntl.F_SETOWN, os.getppid())", "signal of a file": "fcntl.fcntl(3, 10, 9)", "asynchronous": "fcntl.fcntl(3, fcntl.F_SETFL, 0x2000)",
}  # fmt: skip
_PROCESSES = {
    "fork": "os.fork() or os._exit(0)", "fork of C": "c.fork() or os._exit(0)", "bare fork": "call(57) or os._exit(0)", "bare vfork": "call(58) or os._exit(0)", "bare clone": "call(56, 17, 0, 0, 0, 0) or os._exit(0)", "execve": "os.execv('/bin/true', ['true'])", "bare execve": "call(59, b'/bin/true', None, None)",
    "execveat": "call(322, -100, b'/bin/true', None, None, 0)", "spawn": "os.posix_spawn('/bin/true', ['true'], {{}})", "system": "_checked(-1 if _libc.system(b'true') else 0)", "Popen": "subprocess.Popen(['true'])", "memory file": "os.memfd_create('x')", "execute from memory": "os.fexecve(3, [], {{}})",
    "kill parent": "os.kill(os.getppid(), 0)", "kill all": "os.kill(-1, 0)", "kill group": "os.killpg(0, 0)", "tkill": "call(200, os.getppid(), 0)", "tgkill": "call(234, os.getppid(), os.getppid(), 0)", "sigqueue": "call(129, os.getppid(), 10, bytes(128))", "pidfd": "os.pidfd_open(os.getppid())", "own pidfd": "os.pidfd_open(os.getpid())", "getfd": "call(438, 3, 0, 0)", "signal by pidfd": "call(424, 3, 0, None, 0)",
    "trace parent": "c.ptrace(16, os.getppid(), None, None)", "be traced": "c.ptrace(0, 0, None, None)", "read parent": "call(310, os.getppid(), None, 0, None, 0, 0)", "write parent": "call(311, os.getppid(), None, 0, None, 0, 0)", "compare": "call(312, os.getppid(), os.getpid(), 0, 0, 0)", "pages of parent": "call(279, os.getppid(), 0, None, None, None, 0)",
    "priority of parent": "os.setpriority(os.PRIO_PROCESS, os.getppid(), 19)", "processors of parent": "os.sched_setaffinity(os.getppid(), {{0}})", "scheduler of parent": "os.sched_setscheduler(os.getppid(), os.SCHED_BATCH, os.sched_param(0))", "io priority": "call(251, 1, os.getppid(), 0)", "session": "os.setsid()", "group": "os.setpgid(0, 0)",
    "shared memory": "c.shmget(0, 4096, 0o1600)", "semaphores": "c.semget(0, 1, 0o1600)", "messages": "c.msgget(0, 0o1600)", "message queue": "call(240, b'x', 0o102, 0o600, None)",
}  # fmt: skip
_SOCKETS = {
    family: f"socket.socket(socket.AF_{family}, {kind})"
    for family, kind in (("INET", 1), ("INET6", 2), ("UNIX", 1), ("NETLINK", 3), ("PACKET", 3), ("VSOCK", 1), ("ALG", 5))
} | {
    "Unix by C": "c.socket(1, 1, 0)", "pair": "socket.socketpair()", "pair by C": "c.socketpair(1, 1, 0, (ctypes.c_int * 2)())", "connect": "s = socket.socket(socket.AF_UNIX); s.connect(path)", "abstract": "s = socket.socket(socket.AF_UNIX); s.connect(chr(0) + name)",
    "FIFO written": "os.write(os.open(fifo, os.O_WRONLY | os.O_NONBLOCK), b'x')", "FIFO both": "os.open(fifo, os.O_RDWR)", "FIFO read": "os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)", "address": "socket.getaddrinfo('localhost', 80)[0][4][0] == '' or socket.create_connection(('127.0.0.1', 9))",
    "bare socket": "call(41, 2, 1, 0)", "bare connect": "call(42, 3, bytes(16), 16)", "received": "call(47, 3, None, 0)",
}  # fmt: skip
_TRUTH = {
    "import": "import arm3r_cpp", "import anew": "[sys.modules.pop(m) for m in list(sys.modules) if m.startswith('arm3r')]; import arm3r_cpp.core.arm", "its extension": "sys.modules.pop('arm3r_cpp', None); sys.path.insert(0, package); import _arm3r",
    "from its parent": "sys.modules.pop('arm3r_cpp', None); sys.path.insert(0, os.path.dirname(package)); import arm3r_cpp", "in a found module": "next(m for m in list(sys.modules.values()) if 'arm3r_cpp' in str(getattr(m, '__package__', ''))).Arm",
    "among objects": "[o for o in gc.get_objects() if type(o).__name__ in ('Arm', 'ThreeR', 'FunctionTask', 'Scenario')] or open('')", "loader": "import importlib.machinery as m; m.SourceFileLoader('x', package + '/__init__.py').load_module()", "library": "ctypes.CDLL(library)",
    "library by name": "ctypes.CDLL('libarm3r.so')", "read library": "open(library, 'rb')", "read truth": "open(os.path.join(package, 'exercises', 'arms.py'))", "callers": "[f for f in sys._current_frames().values() if 'truth' in f.f_globals or 'TASKS' in f.f_globals] or open('')", "preload": "os.environ['LD_PRELOAD'] = library; ctypes.CDLL(library)",
}  # fmt: skip
GROUPS = {
    "write": _WRITE,
    "read": _READ,
    "privilege": _PRIVILEGE,
    "processes": _PROCESSES,
    "sockets": _SOCKETS,
    "truth": _TRUTH,
}
WAYS = {
    f"{group}: {name}": body.replace("{{", "{").replace("}}", "}")
    for group, ways in GROUPS.items()
    for name, body in ways.items()
}


def text(names: tuple[str, ...]) -> str:
    """A Python file whose function `gravity` tries the way of a number: 1.0 where it is open."""
    return f"WAYS = {list(WAYS.values())!r}\n{HEAD.format(names=names)}"
