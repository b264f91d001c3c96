"""What systems do differently: processors, locks, the end of processes, their confinement, and pipes with a deadline.

In come files, numbers of processes and ends of pipes; out goes what Linux, macOS and Windows do alike under one name.
`cpus` counts processors, `file_lock` locks a file, `processes` ends a process with all that it started, or this one as
by a signal, and `timed_pipe` reads from another process with `patience`. `confinement` bars a process from the rest,
with the kernel's `landlock` and `seccomp`, and `limits` bounds what it uses. This room must not know the rest of the
package. `mypy --platform win32` (`make lint`) finds a use of what a system does not have.
"""
