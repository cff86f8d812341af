#!/usr/bin/env python3
"""Every bad input through the real programs: exit code, message, files, time and memory.

    run_rows.py RENDERER COMPARE [NAME...]

Prints each row that is not as the table says and a count; exit code 1 if there is one.
"""
import fnmatch
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
sys.dont_write_bytecode = True
import rows_mesh  # noqa: E402
import rows_run  # noqa: E402
import rows_xml  # noqa: E402

ROWS = rows_xml.ROWS + rows_mesh.ROWS + rows_run.ROWS
OLD = b"an older image"
SANITIZED = os.environ.get("PLUMB_SANITIZED") == "1"
FREE_MEMORY = 64 << 20  # what the program takes for itself
NOBODY = 65534


class Skipped(Exception):
    """This row cannot run here."""


def write_files(folder, files):
    size = 0
    for name, content in {"out.exr": OLD, **files}.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if callable(content):
            content(path)
        else:
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        size += path.stat().st_size
    return size


def contents(folder):
    """Name to bytes; only the size of what is large."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_symlink() or path.is_dir():
            found[name] = "link" if path.is_symlink() else "folder"
        else:
            large = path.stat().st_size > 1 << 22
            found[name] = path.stat().st_size if large else path.read_bytes()
    return found


def german(folder):
    """The environment of a locale whose decimal point is a comma, made in the folder's parent."""
    where = folder.parent / "locales"
    if not where.exists():
        where.mkdir()
        if shutil.which("localedef"):  # its exit code is 1 with warnings, and without its sources
            subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", str(where / "de_DE.UTF-8")],
                           capture_output=True, check=False)
    if not (where / "de_DE.UTF-8" / "LC_NUMERIC").exists():
        raise Skipped("no locale with a decimal comma can be made (Debian's package locales)")
    return {"LOCPATH": str(where), "LC_ALL": "de_DE.UTF-8"}


def command_of(row, folder, program):
    """The command and its environment."""
    environment = {**os.environ, **(german(folder) if row.german else {})}
    before = row.before if row.before.endswith(";") else f"exec {row.before}"
    if row.before.endswith(";"):
        before += " exec"
    return ["bash", "-c", f'{before} "$0" "$@"', program, *row.arguments], environment


def run(row, folder, program):
    command, environment = command_of(row, folder, program)
    user = NOBODY if row.as_nobody and os.geteuid() == 0 else None
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen(command, cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, user=user)
    out, err = process.communicate(timeout=300)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - used.ru_utime - used.ru_stime
    code = process.returncode if process.returncode >= 0 else 128 - process.returncode
    return code, out.decode(errors="replace"), err.decode(errors="replace"), seconds


def message_errors(row, out, err):
    """What is wrong with what the program said."""
    lines = err.splitlines()
    if row.code < 2:
        said = out if row.written == ["stdout"] else err
        start = f"{row.place}: warning: {row.what}" if row.program == "renderer" and row.place else row.what
        if row.what and not any(line.startswith(start) for line in said.splitlines()):
            yield f"does not say {start!r}"
        if not row.what and "warning" in err:
            yield "warns of what is fine"
        return
    if row.code >= 128:
        if err:
            yield "says something"
        return
    start = f"{row.place}: error: {row.what}" if row.place else f"error: {row.what}"
    if not lines or not lines[0].startswith(start):
        yield f"does not begin with {start!r}"
    if lines[1:] != [f"  included from {place}" for place in row.chain]:
        yield f"the lines below are not the include chain {row.chain}"
    if out and row.program == "renderer":
        yield f"prints {out!r} on stdout"


def file_errors(row, before, after):
    """What is wrong with the files."""
    changed = {name for name in before.keys() | after.keys() if before.get(name) != after.get(name)}
    for pattern in row.written:
        matching = fnmatch.filter(changed, pattern)
        if not matching and pattern != "stdout":
            yield f"does not write {pattern}"
        changed.difference_update(matching)
    if changed:
        yield f"changes {sorted(changed)}"


def peak_memory(row, folder, program):
    """Of the same call in a process of its own, bytes."""
    command, environment = command_of(row, folder, program)
    script = ("import resource, subprocess, sys\n"
              "subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)\n"
              "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
    done = subprocess.run([sys.executable, "-c", script, *command], cwd=folder, env=environment,
                          capture_output=True, text=True, check=True)
    return int(done.stdout) * 1024


def errors_of(row, programs, root):
    if SANITIZED and ("ulimit -s" in row.before or "ulimit -v" in row.before):
        raise Skipped("a sanitizer takes more stack and address space itself")
    folder = root / "row"
    folder.mkdir()
    try:
        size = write_files(folder, row.files)
        program = programs[row.program]
        if row.as_nobody and os.geteuid() == 0:
            if not reachable(program):
                raise Skipped("the program cannot be reached without rights")
            os.chmod(folder, 0o777)
        subprocess.run(["bash", "-c", row.prepare], cwd=folder, check=True)
        before = contents(folder)
        code, out, err, seconds = run(row, folder, program)
        if code != row.code:
            yield f"exit code {code}, expected {row.code}"
        wrong_words = list(message_errors(row, out, err))
        yield from wrong_words
        if wrong_words or code != row.code:
            yield f"says {(err + out)[:300]!r}"
        yield from file_errors(row, before, contents(folder))
        refused = 2 <= row.code < 128 and not row.slow
        if refused and not SANITIZED:
            if seconds >= 1:
                yield f"refuses after {seconds:.2f} s"
            if size > 1 << 20 and peak_memory(row, folder, program) > FREE_MEMORY + 10 * size:
                yield "takes more than 10 times the input's memory"
    finally:
        subprocess.run(["chmod", "-R", "u+rwX", str(folder)], check=False)
        shutil.rmtree(folder)


def reachable(program):
    """Whether a user without rights may run the program."""
    try:
        return subprocess.run([program, "--version"], user=NOBODY, capture_output=True, check=False).returncode == 0
    except PermissionError:
        return False


def check_elsewhere():
    for name, (file, words) in rows_run.ELSEWHERE.items():
        if words not in (HERE.parent / file).read_text(encoding="utf-8"):
            yield f"{name}: no longer in {file} ({words!r})"


def main(arguments):
    programs = {"renderer": os.path.abspath(arguments[0]), "compare": os.path.abspath(arguments[1])}
    names = [row.name for row in ROWS]
    assert len(names) == len(set(names)), "a row stands twice"
    wanted = [row for row in ROWS if not arguments[2:] or any(part in row.name for part in arguments[2:])]
    failed, skipped = 0, 0
    for line in check_elsewhere():
        print(line)
        failed += 1
    with tempfile.TemporaryDirectory() as root:
        os.chmod(root, 0o755)
        for row in wanted:
            try:
                errors = list(errors_of(row, programs, pathlib.Path(root)))
            except Skipped as why:
                print(f"{row.name}: skipped: {why}")
                skipped += 1
                continue
            for error in errors:
                print(f"{row.name}: {error}")
            failed += bool(errors)
    print(f"{len(wanted) - failed - skipped} rows as expected, {failed} not, {skipped} skipped")
    return 1 if failed or not wanted else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
