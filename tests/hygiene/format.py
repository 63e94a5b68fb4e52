"""Every source as .clang-format has it. With --fix: make it so."""

import shutil
import subprocess
import sys

import _tree

program = shutil.which("clang-format-14")
if program is None:
    raise SystemExit("clang-format-14 is missing: run cmake/setup.sh (other versions format differently)")

sources = [str(p) for p in _tree.files(suffixes={".hpp", ".cpp"})]
mode = ["-i"] if "--fix" in sys.argv else ["--dry-run", "--Werror"]
errors = []
if sources:
    result = subprocess.run([program, "--style=file", *mode, *sources], cwd=_tree.ROOT, capture_output=True, text=True)
    places = [line.split(": error:")[0] for line in result.stderr.splitlines() if ": error:" in line]
    by_file = {}
    for place in places:
        path, line, *_ = place.rsplit(":", 2)
        by_file.setdefault(path, []).append(line)
    errors = [f"{path}: not as .clang-format has it, lines {', '.join(dict.fromkeys(n))}" for path, n in by_file.items()]
    if errors:
        errors.append("remedy: cmake --build --preset dev --target format")
    elif result.returncode != 0:
        errors.append(result.stderr)
_tree.finish(errors, len(sources))
