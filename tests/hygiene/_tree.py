"""The files of the source tree: tracked, or untracked and not ignored."""

import os
import pathlib
import subprocess

ROOT = pathlib.Path(os.environ.get("MPM_SOURCE", pathlib.Path(__file__).parents[2])).resolve()


def files(tracked_only=False, suffixes=None):
    """Existing files relative to ROOT, sorted. Outside a git checkout: all but build folders."""
    command = ["git", "-c", "safe.directory=*", "ls-files", "-z", "--cached"]
    if not tracked_only:
        command += ["--others", "--exclude-standard"]
    result = subprocess.run(command, cwd=ROOT, capture_output=True)
    if result.returncode == 0:
        names = {os.fsdecode(name) for name in result.stdout.split(b"\0") if name}
    else:
        names = {str(p.relative_to(ROOT)) for p in ROOT.rglob("*")}
        names = {n for n in names if n.split("/")[0] not in (".git", "build", "out")}
    paths = (pathlib.PurePosixPath(name) for name in sorted(names))
    return [p for p in paths if (ROOT / p).is_file() and (suffixes is None or p.suffix in suffixes)]


def finish(errors, checked):
    """Prints the verdict and leaves with the exit code."""
    for error in errors:
        print(error)
    print(f"{checked} checked, {len(errors)} wrong")
    raise SystemExit(1 if errors else 0)
