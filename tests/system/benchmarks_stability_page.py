"""docs/stability.md has the tables of its files: what benchmarks/stability measured and kept is what the page shows."""

import sys
import unittest

import _mpm

sys.path[:0] = [str(_mpm.SOURCE / "benchmarks/stability"), str(_mpm.SOURCE / "benchmarks")]

import limits  # noqa: E402: found by the line above
import long_runs  # noqa: E402
import theory  # noqa: E402
import user_inputs  # noqa: E402
import verdicts  # noqa: E402
from common import results  # noqa: E402


class Page(_mpm.Case):
    def test_tables_are_those_of_the_csv_files(self):
        page = limits.PAGE.read_text()
        path = self.write(page, "stability.md")
        for blocks, remedy in ((limits.tables(results.read(limits.TABLE)[1]), "limits.py --tables"),
                               (verdicts.tables(), "verdicts.py --tables"),
                               (user_inputs.tables(results.read(user_inputs.TABLE)[1]), "user_inputs.py --tables"),
                               (long_runs.tables(), "long_runs.py --tables")):
            results.refresh(path, blocks)
            self.assertEqual(path.read_text(), page, f"run {remedy}")

    def test_theory_and_limits_of_the_program(self):
        """Both are cheap: those on file are those of today."""
        for row in results.read(limits.TABLE)[1]:
            method = tuple(row[key] for key in limits.KEYS)
            with self.subTest(method):
                self.assertAlmostEqual(limits.of_program(method), row["program"], delta=1e-5)
                if row["transfer"] == "FLIP" and row["mass"] == "lumped" and row["scheme"] != "USF":  # MUSL's
                    self.assertAlmostEqual(theory.limit(*method[:1], row["scheme"]), row["theory"], delta=1e-5)


class Merged(unittest.TestCase):
    def test_rows_that_are_not_measured_stay(self):
        def row(**more):
            return {"shape": "SGMP", "transfer": "FLIP", "scheme": "MUSL", "mass": "lumped", "theory": 2.0, "program": 1.25, **more}

        old = limits.merged([], [row(block=1.0, fluid=1.1), row(shape="linear", block=0.9)])
        self.assertEqual([r["shape"] for r in old], ["linear", "SGMP"])
        new = limits.merged(old, [row(fluid=1.2), row(shape="DDMP", bar=1.5)])
        self.assertEqual([(r["shape"], r["block"], r["fluid"], r["bar"]) for r in new],
                         [("linear", 0.9, "", ""), ("DDMP", "", "", 1.5), ("SGMP", 1.0, 1.2, "")])


if __name__ == "__main__":
    _mpm.main()
