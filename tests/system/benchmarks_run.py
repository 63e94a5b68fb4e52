"""The benchmarks run, at a size at which their times mean nothing: their tables have the columns that the
documents explain, numbers that can be true, and the same bits where they must be the same."""

import json
import math
import os
import re
import subprocess
import sys
import unittest

import _mpm

PROGRAMS = "throughput", "scaling", "feature_cost"
sys.path.insert(0, str(_mpm.SOURCE / "benchmarks"))

from common import results  # noqa: E402: found by the line above


@unittest.skipUnless(all((_mpm.BIN / p).exists() for p in PROGRAMS), "built without MPM_BENCHMARKS")
class Benchmarks(_mpm.RunOnce):
    command = ("benchmarks/run_all.py", "--tiny", "--ranks", "1", "2", "--threads", "1", "2", "--parts", *PROGRAMS)

    def rows(self, name, words=()):
        """Rows of a table; whatever is not among `words` is a number."""
        head, rows = results.read(self.out / name)
        self.assertTrue(any(line.startswith("processor") for line in head), head)
        for row in rows:
            for key, value in row.items():
                if key not in words:
                    self.assertIsInstance(value, float, f"{name}: {key} is {value!r}")
        return rows

    def test_throughput(self):
        rows = self.rows("throughput.csv", {"scheme"})
        self.assertEqual([r["scheme"] for r in rows], ["MUSL", "USF", "USL"])
        for r in rows:
            self.assertGreater(r["particles"], 1000)
            # Which of them is larger is the machine's matter, at this size and beside other programs.
            for rate in ("best_ns", "floor_ns", "fma_flops"):
                self.assertGreater(r[rate], 0)
            self.assertGreaterEqual(r["median_ns"], r["best_ns"])
            flops = 1e9 * r["operations"] / r["best_ns"]
            for given, expected in [(r["ratio_to_floor"], r["best_ns"] / r["floor_ns"]),
                                    (r["share_flop"], flops / r["fma_flops"])]:
                self.assertAlmostEqual(given / expected, 1, delta=2e-3)  # four digits in the file
            self.assertEqual(r["state_bytes"], 152)  # README
            self.assertGreater(r["moved_bytes"], 2 * r["state_bytes"])
        phases = self.rows("phases.csv", {"scheme", "phase"})
        for r in rows:
            of_phases = sum(p["ns"] for p in phases if p["scheme"] == r["scheme"])
            self.assertAlmostEqual(of_phases / r["best_ns"], 1, delta=2e-3)  # four digits in the file

    def test_scaling(self):
        rows = self.rows("scaling.csv", {"study", "over", "partition", "clock", "state"})
        cases = {(r["study"], r["partition"], r["ranks"], r["threads"]) for r in rows}
        for study in ("strong", "weak"):
            self.assertLessEqual({(study, "metis", 2, 1), (study, "uniform", 2, 1), (study, "", 1, 2)}, cases)
        self.assertIn(("copies", "", 1, 1), cases)
        self.assertEqual(len({r["state"] for r in rows if r["study"] in ("strong", "copies")}), 1)
        for r in rows:
            self.assertGreater(r["step_ms"], 0)
            self.assertGreaterEqual(r["imbalance"], 1)
            self.assertEqual(r["oversubscribed"], r["ranks"] * r["threads"] > os.cpu_count())
            self.assertEqual(r["clock"], "processor" if r["oversubscribed"] else "wall")
            if not r["oversubscribed"]:
                self.assertLess(sum(value for key, value in r.items() if key.endswith("_share")), 1)
            if r["ranks"] * r["threads"] == 1:
                self.assertEqual(r["efficiency"], 1)
            cores = r["ranks"] * r["threads"]
            expected = 1e6 * r["step_ms"] * cores / r["particles"]
            self.assertAlmostEqual(r["core_ns"] / expected, 1, delta=1e-4)  # six digits in the file

    def test_more_threads_than_cores(self):
        """The wall's time is not taken where it means nothing."""
        threads = os.cpu_count() + 1
        outcome = _mpm.run(["--particles", 1e3, "--repeats", 1, "--warm-up", 0, "--threads", threads],
                           program="scaling")
        self.assertEqual(outcome.code, 0, outcome)
        case = json.loads(outcome.out)
        self.assertTrue(case["oversubscribed"])
        self.assertEqual(case["clock"], "processor")
        self.assertEqual(case["step_s"], case["compute_s"]["max"])

    def test_feature_cost(self):
        rows = self.rows("feature_cost.csv", {"family", "feature", "against", "law_ns"})
        by_name = {r["feature"]: r for r in rows}
        same = by_name["the same scene twice"]
        self.assertEqual((same["added_state_bytes"], same["same_bits"]), (0, 1))
        for feature, added in {"heating (SpecHeat)": 8, "strains shown (exx)": 48, "PlaStrain, never reached": 16,
                               "artificial viscosity in shocks only": 16, "update 4, accumulated strain": 48, "IsoHarden": 8, "JohnsonCook": 16}.items():
            self.assertEqual(by_name[feature]["added_state_bytes"], added, feature)  # doubles that the laws keep
        for feature in ("USF", "USL", "artificial viscosity", "JohnsonCook"):
            self.assertEqual(by_name[feature]["same_bits"], 0, f"{feature} does nothing")
        for r in rows:
            self.assertGreater(r["ns"], 0)
            self.assertGreaterEqual(r["held_bytes"], r["state_bytes"])
            is_law = r["family"] in ("strength law", "equation of state", "failure law")
            self.assertEqual(is_law, not math.isnan(r["law_ns"]), r["feature"])
            if r["family"] == "off":
                self.assertEqual((r["added_state_bytes"], r["same_bits"]), (0, 1), r["feature"])

    def test_every_law_is_there(self):
        """Nothing is left out but what the program says it cannot do yet."""
        for line in re.findall(r"^left out: (.*)", self.outcome.stdout, re.MULTILINE):
            self.assertIn("not implemented yet", line)

    def test_tables_and_pictures(self):
        for picture in ("throughput.png", "scaling.png", "features.png", "laws.png"):
            self.assertGreater((self.out / picture).stat().st_size, 5000, picture)
        tables = (self.out / "benchmarks.md").read_text()
        for head in ("Throughput", "Phases", "Scaling", "Features", "Laws", "Off"):
            self.assertIn(f"\n## {head}\n", tables)
        for line in re.findall(r"^\|.*", tables, re.MULTILINE):
            self.assertTrue(line.endswith("|") and "nan" not in line, line)

    def test_tables_find_their_place(self):
        """docs/benchmarks.md has a place for every table, and what stands around it stays."""
        document = (_mpm.SOURCE / "docs/benchmarks.md").read_text()
        names = re.findall(r"<!-- begin (\w+) -->", document)
        self.assertEqual(names, re.findall(r"<!-- end (\w+) -->", document))

        def emptied(text):
            return re.sub(r"(<!-- begin \w+ -->\n).*?(<!-- end)", r"\1\2", text, flags=re.DOTALL)

        path = self.write(emptied(document), "benchmarks.md")  # tables that this run has not measured would stay
        command = [sys.executable, "-c", "import pathlib, sys, run_all; from common import results; "
                   "results.refresh(pathlib.Path(sys.argv[1]), run_all.tables(pathlib.Path(sys.argv[2])))",
                   path, self.out]
        for _ in range(2):  # the second time in the place of the first
            subprocess.run(command, check=True, cwd=_mpm.SOURCE / "benchmarks", env=_mpm.ENVIRONMENT)
        filled = path.read_text()
        self.assertEqual(filled.count("| MUSL | "), (self.out / "benchmarks.md").read_text().count("| MUSL | "))
        self.assertEqual(emptied(filled), emptied(document))


_mpm.main()
