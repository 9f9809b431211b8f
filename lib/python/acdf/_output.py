"""Writes a file: whole or not at all, where its name leads, with the owner and mode of the file that it replaces."""

from __future__ import annotations

import errno
import os
import secrets
import stat
from typing import Optional


def write_file(path: str, data: bytes) -> None:
    """Writes a file beside the target, syncs it and renames it. Symbolic links stay. A pipe or a device, which cannot be
    replaced, is written to directly. Raises OSError; a file that was there then stays as it was."""
    replaced = _status(path)
    if replaced is not None and not stat.S_ISREG(replaced.st_mode):
        with open(path, "wb") as out:  # raises where it is a folder
            out.write(data)
        return
    if not os.path.basename(path):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), path)
    target = os.path.realpath(path)  # also of a link to a file that does not exist yet
    folder = os.path.dirname(target)
    temporary = os.path.join(folder, f".acdf-{secrets.token_hex(8)}.part")
    # Nobody else reads what replaces a private file, not even before it gets its mode.
    private = _new_file(temporary, 0o666 if replaced is None else 0o600)
    try:
        with os.fdopen(private, "wb") as out:
            out.write(data)
            out.flush()
            if replaced is not None:
                _take_over(temporary, replaced)
            os.fsync(out.fileno())
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise
    _sync_folder(folder)


def _status(path: str) -> Optional[os.stat_result]:
    try:
        return os.stat(path)  # of what a link leads to; raises where links lead in a circle
    except FileNotFoundError:
        return None


def _new_file(path: str, mode: int) -> int:
    return os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), mode)


def _take_over(path: str, replaced: os.stat_result) -> None:
    mode = stat.S_IMODE(replaced.st_mode)
    try:
        if hasattr(os, "chown"):
            os.chown(path, replaced.st_uid, replaced.st_gid)
    except OSError:  # another user's file; to run as its owner is not ours to grant
        mode &= 0o777
    os.chmod(path, mode)


def _sync_folder(folder: str) -> None:
    """So that the name outlives a power cut. Some systems cannot sync folders: there is nothing better to do then."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    try:
        opened = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    except OSError:
        return
    try:
        os.fsync(opened)
    except OSError:
        pass
    finally:
        os.close(opened)
