"""docs/materials.md: its commands run, say what it says they say, and give the numbers that it names."""

import csv
import math
import re
import shlex
import xml.etree.ElementTree as ElementTree

import _mpm
from _mpm import DONE, SOURCE, Case

GUIDE = (SOURCE / "docs/materials.md").read_text(encoding="utf-8")


def blocks(kind):
    return re.findall(rf"^```{kind}\n(.*?)^```", GUIDE, re.MULTILINE | re.DOTALL)


class Guide(Case):
    def table(self, name):
        with open(self.folder / name, encoding="utf-8") as file:
            names, units, *rows = csv.reader(file)
        return dict(zip(names, units)), [dict(zip(names, map(float, row))) for row in rows]

    def test_examples(self):
        said = ""
        commands = [line for block in blocks("sh") for line in block.splitlines()]
        self.assertGreaterEqual(len(commands), 6)
        for line in commands:
            program, *arguments = shlex.split(line)
            outcome = _mpm.run(arguments, program=program, cwd=self.folder)
            self.assertEqual(outcome.code, DONE, (line, outcome))
            said += outcome.err
        for line in (line for block in blocks("text") for line in block.splitlines()):
            self.assertIn(line, said)

        # Example 2: the numbers of the text.
        stress = {}
        for name in ("slow", "fast", "adiabatic"):
            units, rows = self.table(f"{name}.csv")
            self.assertEqual((units["stress_xx"], units["temperature"]), ("Pa", "K"))
            self.assertAlmostEqual(rows[-1]["strain"], 0.1, delta=1e-12)
            stress[name] = rows[-1]["stress_xx"] / 1e6
            temperature = rows[-1]["temperature"]
        for name, printed in (("slow", "232.1"), ("fast", "272.0"), ("adiabatic", "271.1")):
            self.assertEqual(f"{stress[name]:.1f}", printed)
            self.assertIn(printed, GUIDE)
        rate_constant = {name: (stress[name] / stress["slow"] - 1) / math.log(1000) for name in ("fast", "adiabatic")}
        self.assertIn(f"= {rate_constant['fast']:.4f}.", GUIDE)
        self.assertIn(f"would give C = {rate_constant['adiabatic']:.4f}", GUIDE)
        self.assertIn(f"warms by {temperature - 293:.0f} K", GUIDE)

        # The picture is well-formed, with its three curves and the 21 measured points.
        svg = ElementTree.parse(self.folder / "model.svg").getroot()
        space = "{http://www.w3.org/2000/svg}"
        self.assertEqual(len(svg.findall(f"{space}polyline")), 3)
        self.assertEqual(len(svg.findall(f"{space}circle")), 21)

    def test_inputs(self):
        for block in blocks("xml"):
            text = f'<PeneBlast version="1.0">{block}</PeneBlast>'
            case = self.folder / "material.xmp"
            case.write_text(text, encoding="utf-8")
            outcome = _mpm.run([case, "-p", "uniaxial_stress 0.01 steps 5"], program="mpm_point")
            self.assertEqual(outcome.code, DONE, outcome)


if __name__ == "__main__":
    _mpm.main()
