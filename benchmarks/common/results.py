"""Shared by the benchmark scripts: paths and runs of the programs, reading and writing of tables."""

import csv
import json
import math
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(os.environ.get("MPM_SOURCE", pathlib.Path(__file__).parents[2])).resolve()
BIN = pathlib.Path(os.environ.get("MPM_BIN", ROOT / "build/release/bin")).resolve()
CORES = os.cpu_count()


def environment(**more):
    """Settings of Open MPI for root, usually in a container: allowed to run, and no copies between processes,
    for which containers lack permission."""
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_btl_vader_single_copy_mechanism": "none"} if os.geteuid() == 0 else {}
    return {**os.environ, **root, **more}


def run(command, echo=False, **more):
    """The standard output of the program; SystemExit with its message on failure."""
    command = [str(word) for word in command]
    print("$", " ".join(command), file=sys.stderr, flush=True)
    program = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment(**more))
    said = ""
    for line in program.stdout:
        said += line
        if echo:
            print(line, end="", flush=True)
    if program.wait() != 0:
        raise SystemExit(f"{' '.join(command)}\nended with exit code {program.returncode}\n{said}")
    return said


def refuse(message):
    """Ends the script with the exit code that the programs have for wrong input."""
    print(message, file=sys.stderr)
    raise SystemExit(2)


def reason(said):
    """What a program complained about, in one line without the folder of its input file."""
    lines = [line.strip() for line in said.splitlines() if line.strip()]
    return lines[0].split(".xmp:")[-1] if lines else "no message"


def last_json(text):
    return json.loads(text.strip().splitlines()[-1])


def number(word):
    """A number if the text is one, else the text."""
    try:
        return float(word)
    except ValueError:
        return word


def read(path):
    """Lines at the head that start with #, and the rows as dictionaries with numbers as numbers."""
    lines = path.read_text().splitlines()
    head = [line[2:] for line in lines if line.startswith("# ")]
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    return head, [{key: number(value) for key, value in row.items()} for row in rows]


def write(path, rows, head=()):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        file.writelines(f"# {line}\n" for line in head)
        out = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        out.writeheader()
        out.writerows({k: f"{v:.6g}" if isinstance(v, float) else v for k, v in row.items()} for row in rows)


def markdown(rows, columns):
    """columns: {heading: (function of a row, format)}; – where the function gives None or NaN."""

    def cell(value, how):
        absent = value is None or value == "" or isinstance(value, float) and math.isnan(value)
        return "–" if absent else value if isinstance(value, str) else format(value, how)

    lines = ["| " + " | ".join(columns) + " |",
             "|" + "|".join(" ---: " if how else " --- " for _, how in columns.values()) + "|"]
    lines += ["| " + " | ".join(cell(of(row), how) for of, how in columns.values()) + " |" for row in rows]
    return "\n".join(lines)


def refresh(path, blocks):
    """Puts each text between its marks, `<!-- begin NAME -->` and `<!-- end NAME -->`, which must be there."""
    text = path.read_text()
    for name, block in blocks.items():
        marks = re.compile(rf"(<!-- begin {name} -->\n).*?(<!-- end {name} -->)", re.DOTALL)
        if not marks.search(text):
            raise SystemExit(f"{path}: no marks <!-- begin {name} --> and <!-- end {name} -->")
        text = marks.sub(lambda m: m.group(1) + block.rstrip() + "\n" + m.group(2), text)
    path.write_text(text)
