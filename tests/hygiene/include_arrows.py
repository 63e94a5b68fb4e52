"""Which folder may include what. Every rule is also tried on a planted offence, so a rule that sleeps is noticed."""

import re

import _tree

# Our libraries, and what each may see of the others. Apps, benchmarks and tests see all of them.
ARROWS = {
    "core": {"core"},
    "parallel": {"parallel", "core"},
    "physics": {"physics", "core"},
    "io": {"io", "core", "parallel"},
}
FOLDERS = set(ARROWS) | {"apps", "benchmarks", "tests"}

# Headers of other libraries, and the paths that may include them.
FENCED = [
    ("MPI", re.compile(r"^mpi(-ext)?\.h$"), re.compile(r"^(parallel|tests/parallel)/")),
    ("METIS", re.compile(r"^metis\.h$"), re.compile(r"^parallel/")),
    ("PETSc", re.compile(r"^petsc.*\.h(pp)?$"), re.compile(r"(^|/)(petsc|implicit)/")),
    ("HDF5", re.compile(r"^(hdf5|H5\w*)\.h$"), re.compile(r"^(io|tests/io)/")),
    ("libxml2", re.compile(r"^(libxml2?/|libxml)"), re.compile(r"^(io|tests/io)/")),
]

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def offences(path, text):
    """Messages for the wrong includes of one file; path relative to the root."""
    found = []
    home = path.split("/")[0]
    for match in INCLUDE.finditer(text):
        quote, header = match.groups()
        line = text.count("\n", 0, match.start()) + 1

        def wrong(why):
            found.append(f"{path}:{line}: #include {header}: {why}")

        first = header.split("/")[0]
        ours = "/" in header and first in FOLDERS
        if home in ARROWS and ours and first not in ARROWS[home]:
            wrong(f"{home} may include {', '.join(sorted(ARROWS[home]))} only")
        if home in ARROWS and quote == '"' and not ours:
            wrong("includes of ours start at the root, others take <>")
        if home == "apps" and first in ("tests", "benchmarks"):
            wrong("programs stand on the libraries")
        for name, headers, allowed in FENCED:
            if headers.match(header) and not allowed.search(path):
                wrong(f"{name} is fenced: {allowed.pattern}")
    return found


def self_test():
    planted = [
        ("core/a.hpp", '#include "physics/law.hpp"', 1),
        ("core/a.hpp", "#include <parallel/halo.hpp>", 1),
        ("core/a.hpp", "  #  include <mpi.h>", 1),
        ("core/a.hpp", '#include "neighbour.hpp"', 1),
        ("core/a.hpp", '#include "tests/support/naive.hpp"', 1),
        ("physics/a.cpp", '#include "io/scene.hpp"', 1),
        ("physics/a.cpp", "#include <mpi.h>\n#include <hdf5.h>", 2),
        ("physics/law/a.cpp", "#include <petscsnes.h>", 1),
        ("parallel/a.cpp", '#include "physics/law.hpp"', 1),
        ("parallel/a.cpp", '#include "io/scene.hpp"', 1),
        ("parallel/a.cpp", "#include <hdf5.h>", 1),
        ("io/a.cpp", '#include "physics/law.hpp"', 1),
        ("io/a.cpp", "#include <mpi.h>", 1),
        ("apps/a.cpp", "#include <mpi.h>", 1),
        ("apps/a.cpp", "#include <libxml/parser.h>", 1),
        ("apps/a.cpp", '#include "benchmarks/timer.hpp"', 1),
        ("benchmarks/a.cpp", "#include <metis.h>", 1),
        ("tests/core/a.cpp", "#include <H5Fpublic.h>", 1),
        ("core/a.cpp", '#include "core/grid/grid.hpp"\n#include <vector>\n#include <Eigen/Dense>', 0),
        ("physics/implicit/a.cpp", '#include <petscsnes.h>\n#include "core/grid/grid.hpp"', 0),
        ("parallel/a.cpp", '#include <mpi.h>\n#include <metis.h>\n#include "core/version.hpp"', 0),
        ("io/a.cpp", '#include <hdf5.h>\n#include <libxml/parser.h>\n#include "parallel/halo.hpp"', 0),
        ("apps/a.cpp", '#include "io/scene.hpp"\n#include "physics/law.hpp"\n#include <CLI/CLI.hpp>', 0),
        ("tests/parallel/a.cpp", '#include <mpi.h>\n#include "tests/support/naive.hpp"', 0),
    ]
    return [
        f"self-test: {path} with {text!r}: expected {expected} offences, got {offences(path, text)}"
        for path, text, expected in planted
        if len(offences(path, text)) != expected
    ]


errors = self_test()
sources = _tree.files(suffixes={".hpp", ".cpp", ".h"})
for source in sources:
    errors += offences(str(source), (_tree.ROOT / source).read_text(errors="replace"))
_tree.finish(errors, len(sources))
