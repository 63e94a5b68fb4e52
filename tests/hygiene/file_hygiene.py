"""Plain text, one header guard, a readable length: the state in which every file stays."""

import _tree

MAX_LINES = 800
CODE = {".hpp", ".cpp"}
HAND_WRITTEN = CODE | {".py", ".sh", ".cmake"}


def faults(path, data, tracked):
    """Messages for one file; path relative to the root, data its bytes."""
    found = []
    if b"\0" in data[:8192]:
        return [f"{path}: a binary file is tracked"] if tracked else []
    if b"\r\n" in data:
        found.append(f"{path}: CRLF line ends")
    if path.suffix in CODE and b"\t" in data:
        found.append(f"{path}:{data[: data.index(9)].count(10) + 1}: tab")
    if path.suffix == ".hpp" and b"#pragma once" not in data:
        found.append(f"{path}: no #pragma once")
    if path.suffix in HAND_WRITTEN and data.count(b"\n") > MAX_LINES:
        found.append(f"{path}: {data.count(10)} lines, more than {MAX_LINES}")
    return found


def self_test():
    planted = [
        ("a.bin", b"\0", 1),
        ("a.md", b"one\r\ntwo\n", 1),
        ("a.hpp", b"#pragma once\n\tint a;\n", 1),
        ("a.hpp", b"int a;\n", 1),
        ("a.cpp", b"\n" * (MAX_LINES + 1), 1),
        ("a.cpp", b"\n" * MAX_LINES, 0),
    ]
    results = ((name, faults(_tree.pathlib.PurePosixPath(name), data, True), n) for name, data, n in planted)
    return [f"self-test: {name}: expected {n} faults, got {got}" for name, got, n in results if len(got) != n]


errors = self_test()
tracked = set(_tree.files(tracked_only=True))
paths = _tree.files()
for path in paths:
    errors += faults(path, (_tree.ROOT / path).read_bytes(), path in tracked)
_tree.finish(errors, len(paths))
