"""Ways out of the process in which Octave evaluates a user's file: each is code that sets `open`, or fails.

At hand are `own`, `folder`, `other`, `fifo` and `package`, the paths of files and folders. A way is open where `open` is
true behind it.
"""

# ruff: noqa: E501

from __future__ import annotations

_PROCESSES = {
    "system": "[s, t] = system('echo here'); open = ! isempty(t);",
    "system without a shell's output": "open = system('true') == 0;",
    "system beside": "open = system('true', false, 'async') > 0;",
    "shell_cmd": "open = shell_cmd('true') == 0;",
    "unix": "[s, t] = unix('echo here'); open = ! isempty(t);",
    "popen": "f = popen('echo here', 'r'); open = f > 0 && ischar(fgetl(f));",
    "popen to write": "f = popen('cat', 'w'); open = f > 0 && fputs(f, 'x') == 0;",
    "popen2": "[in, out, pid] = popen2('cat'); open = pid > 0;",
    "fork": "[pid, m] = fork(); if pid == 0, exit(0); end; open = pid > 0;",
    "exec": "open = exec('/bin/true') == 0;",
    "kill the parent": "open = kill(getppid(), 0) == 0;",
    "kill all": "open = kill(-1, 0) == 0;",
    "run": "run('/bin/true'); open = true;",
    "python": "[t, s] = python('-c', 'print(1)'); open = s == 0;",
    "perl": "open = ! isempty(perl('-e', 'print 1'));",
    "browser": "open = web('http://127.0.0.1:9/') == 0;",
    "mex": "open = mkoctfile('-p', 'CC') != 0;",
    "mkoctfile": "[t, s] = mkoctfile('x.c'); open = s == 0;",
    "uname by a shell": "open = ! isempty(evalc('!uname'));",
    "package manager": "pkg('install', 'https://localhost/x.tar.gz'); open = true;",
    "Java": "javaMethod('exec', javaMethod('getRuntime', 'java.lang.Runtime'), 'true'); open = true;",
}
_READ = {
    "another's file": "open = fopen(other) >= 0;",
    "fileread": "open = ! isempty(fileread(other));",
    "load": "load(other); open = true;",
    "importdata": "importdata(other); open = true;",
    "textscan": "open = ! isempty(textscan(fopen(other), '%s'));",
    "source": "source(other); open = true;",
    "evaluated as a function": "addpath(fileparts(other)); open = secret_of_other() == 1;",
    "autoload": "autoload('secret_of_other', other); open = secret_of_other() == 1;",
    "by a link": "open = fopen([folder '/link.m']) >= 0;",
    "by a path": "open = fopen([folder '/../other/secret_of_other.m']) >= 0;",
    "hidden": "open = fopen([folder '/.hidden']) >= 0;",
    "folder of others": "open = ! isempty(readdir([folder '/..']));",
    "dir": "open = ! isempty(dir([folder '/..']));",
    "glob": "open = ! isempty(glob([folder '/../*/*.m']));",
    "ls": "open = ! isempty(ls('/'));",
    "what": "open = ! isempty(what('/root').m);",
    "users": "open = ! isempty(fileread('/etc/passwd'));",
    "getpwnam": "open = isstruct(getpwnam('root'));",
    "getpwuid": "open = isstruct(getpwuid(getuid()));",
    "getgrnam": "open = isstruct(getgrnam('root'));",
    "shadow": "open = fopen('/etc/shadow') >= 0;",
    "root": "open = ! isempty(readdir('/'));",
    "homes": "open = ! isempty(readdir('/home'));",
    "home of root": "open = ! isempty(readdir('/root'));",
    "temporary files": "open = ! isempty(readdir('/tmp'));",
    "processes": "open = ! isempty(readdir('/proc'));",
    "status": "open = fopen('/proc/self/status') >= 0;",
    "own memory": "open = fopen('/proc/self/mem') >= 0;",
    "environment of the parent": "open = fopen(sprintf('/proc/%d/environ', getppid())) >= 0;",
    "memory": "memory(); open = true;",
    "disk": "open = fopen('/dev/sda') >= 0;",
    "FIFO": "open = fopen(fifo, 'r+') >= 0;",
    "package's library": "autoload('f', [package '/_arm3r.so']); f(); open = true;",
    "an oct-file of another folder": "autoload('f', '/tmp/x.oct'); f(); open = true;",
}
_WRITE = {
    "write": "open = fopen(own, 'w') >= 0;",
    "append": "open = fopen(own, 'a') >= 0;",
    "read and write": "open = fopen(own, 'r+') >= 0;",
    "create": "open = fopen([folder '/new'], 'w') >= 0;",
    "save": "x = 1; save('-text', [folder '/new'], 'x'); open = exist([folder '/new'], 'file') == 2;",
    "csvwrite": "csvwrite([folder '/new'], 1); open = true;",
    "diary": "diary([folder '/new']); disp(1); diary off; open = exist([folder '/new'], 'file') == 2;",
    "temporary": "open = fopen('/tmp/arm3r_octave_way_out', 'w') >= 0;",
    "tmpfile": "open = tmpfile() >= 0;",
    "mkstemp": "open = mkstemp([folder '/newXXXXXX']) >= 0;",
    "shared memory": "open = fopen('/dev/shm/arm3r_octave_way_out', 'w') >= 0;",
    "unlink": "open = unlink(own) == 0;",
    "delete": "delete(own); open = exist(own, 'file') != 2;",
    "rename": "open = rename(own, [own 'x']) == 0;",
    "copy": "open = copyfile(own, [own 'x']);",
    "move": "open = movefile(own, [own 'x']);",
    "link": "open = link(own, [own 'x']) == 0;",
    "symbolic link": "open = symlink(own, [own 'x']) == 0;",
    "make a folder": "open = mkdir([folder '/new']);",
    "remove a folder": "open = rmdir(folder);",
    "remove a folder with all in it": "confirm_recursive_rmdir(false); open = rmdir(folder, 's');",
    "make a FIFO": "open = mkfifo([folder '/new'], 384) == 0;",
    "FIFO written": "open = fopen(fifo, 'w') >= 0;",
    "tar": "tar([folder '/new.tar'], own); open = exist([folder '/new.tar'], 'file') == 2;",
    "zip": "open = ! isempty(zip([folder '/new.zip'], own));",
    "history": "history_file([folder '/new']); history -w; open = exist([folder '/new'], 'file') == 2;",
    "save the path": "open = savepath([folder '/new']) == 0;",
    "publish": "publish(own); open = true;",
    "print": "print([folder '/new.png']); open = true;",
    "mask of new files": "umask(0); open = umask(0) == 0;",
}
_NETWORK = {
    "urlread": "[t, open] = urlread('http://127.0.0.1:9/');",
    "urlread of a file": "[t, open] = urlread(['file://' other]);",
    "urlread of users": "[t, open] = urlread('file:///etc/passwd');",
    "urlwrite": "[f, open] = urlwrite('http://127.0.0.1:9/', [folder '/new']);",
    "urlwrite of a file": "[f, open] = urlwrite(['file://' other], [folder '/new']);",
    "webread": "webread('http://127.0.0.1:9/'); open = true;",
    "ftp": "d = dir(ftp('127.0.0.1')); open = ! isempty(d(1).name);",
    "Java's socket": "javaObject('java.net.Socket', '127.0.0.1', 9); open = true;",
}
GROUPS = {"processes": _PROCESSES, "read": _READ, "write": _WRITE, "network": _NETWORK}
WAYS = {f"{group}: {name}": body for group, ways in GROUPS.items() for name, body in ways.items()}

_TEXT = """
function out = gravity(way)
  own = '{own}'; folder = '{folder}'; other = '{other}'; fifo = '{fifo}'; package = '{package}';
  open = false;
  try
    switch way
{cases}
    end
  catch
    open = false;
  end
  out = double(any(open));
end
"""


def text(own: str, folder: str, other: str, fifo: str, package: str) -> str:
    """A MATLAB file whose function `gravity` tries the way of a number: 1 where it is open."""
    cases = "\n".join(f"      case {number}\n        {body}" for number, body in enumerate(WAYS.values()))
    return _TEXT.format(own=own, folder=folder, other=other, fifo=fifo, package=package, cases=cases)
