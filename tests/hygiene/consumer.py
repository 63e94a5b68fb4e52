"""Installs the build into a folder of its own, then configures, builds and runs a project that only knows this folder:
programs with a user's own laws. They are compiled for the compiler's baseline, without the library's -march, and once
more with it."""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import unittest

HERE = pathlib.Path(__file__).resolve().parent / "consumer"

ELASTIC = 'Young="117e3" Poisson="0.35" Yield0="157"'
BUILT_IN = [f'<StrengthModel type="IsoHarden" {ELASTIC} TangMod="423.461758"/>',
            '<EquationOfState type="Polynomial2" A1="130e3" A2="200e3" A3="0" B0="2" B1="0" T1="130e3" T2="0"/>',
            '<FailureModel type="PlaStrain" epmax="0.15"/>']
SLOPE = 117e3 * 423.461758 / (117e3 - 423.461758)
OWN = [f'<StrengthModel type="MyHardening" {ELASTIC} Slope="{SLOPE!r}"/>',
       '<EquationOfState type="MyBulk" A1="130e3" A2="200e3" B0="2"/>',
       '<FailureModel type="MyLimit" limit="0.15"/>']


def call(*words, code=0):
    """The command's words, standard output and error together; it must leave with the code."""
    result = subprocess.run([str(w) for w in words], cwd=arguments.work, text=True, stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT)
    if result.returncode != code:
        raise AssertionError(f"{' '.join(map(str, words))}\nleft with {result.returncode}, expected {code}\n{result.stdout}")
    return result.stdout


def build(name, *flags):
    """The project's programs; `flags`: what its user compiles with."""
    folder = arguments.work / name
    call("cmake", "-G", arguments.generator, "-S", HERE, "-B", folder, f"-DCMAKE_PREFIX_PATH={arguments.work}/prefix",
         f"-DCMAKE_BUILD_TYPE={arguments.build_type}", f"-DCMAKE_CXX_COMPILER={arguments.compiler}",
         f"-DCMAKE_CXX_COMPILER_LAUNCHER={arguments.launcher}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
         f"-DCMAKE_CXX_FLAGS={' '.join([*arguments.flags, *flags])}")
    call("cmake", "--build", folder)
    return folder


def write(name, laws):
    text = (HERE / "case.xmp").read_text().replace("{laws}", "\n".join(laws))
    path = arguments.work / f"{name}.xmp"
    path.write_text(text)
    return path


def run(program, case, folder, ranks=1):
    """The run's state hash and the totals of its end."""
    words = [program, case, "--output-dir", arguments.work / folder]
    output = call(*(["mpirun", "-n", ranks] if ranks > 1 else []), *words)
    state = re.search(r"^state +([0-9a-f]{16})", output, re.MULTILINE)[1]
    return state, json.loads((arguments.work / folder / f"{case.stem}.summary.json").read_text())


class Consumer(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(arguments.work, ignore_errors=True)
        arguments.work.mkdir(parents=True)
        call("cmake", "--install", arguments.build, "--prefix", arguments.work / "prefix")
        cls.built = {"baseline": build("baseline")}
        if arguments.arch:
            cls.built["as the library"] = build("arch", f"-march={arguments.arch}")
        cls.mine = cls.built["baseline"]

    def assert_close(self, found, expected):
        for name in ("kinetic", "internal"):
            a, b = found["energy"][name], expected["energy"][name]
            self.assertGreater(b, 0)
            self.assertLessEqual(abs(a - b), 1e-12 * b, name)
        a, b = found["bodies"][0], expected["bodies"][0]
        self.assertEqual(a["failed"], b["failed"])
        self.assertGreater(b["failed"], 0)
        self.assertLessEqual(abs(a["max_epef"] - b["max_epef"]), 1e-12 * b["max_epef"])

    def test_the_machine_is_the_users_choice(self):
        """The installed target names no machine, and lets go none of the flags that results depend on."""
        for command in json.loads((self.mine / "compile_commands.json").read_text()):
            self.assertNotRegex(command["command"], "-march|-mavx|-mtune")
            self.assertIn("-ffp-contract=fast", command["command"])
            self.assertRegex(command["command"], "-DMPM_SIMD_LANES=[1248]")

    def test_built_in_laws_keep_their_bits(self):
        case = write("theirs", BUILT_IN)
        expected, _ = run(arguments.work / "prefix/bin/mpm_run", case, "theirs")
        for name, folder in self.built.items():
            with self.subTest(compiled=name):
                self.assertEqual(run(folder / "my_run", case, "same")[0], expected)

    def test_own_laws_give_the_numbers_of_the_built_in_ones(self):
        """Alone, together, and each beside the built-in laws of the other families."""
        _, expected = run(arguments.work / "prefix/bin/mpm_run", write("theirs", BUILT_IN), "theirs")
        for name, folder in self.built.items():
            for own in range(1, 8):
                laws = [OWN[i] if own & 1 << i else BUILT_IN[i] for i in range(3)]
                with self.subTest(compiled=name, laws=laws):
                    self.assert_close(run(folder / "my_run", write(f"own{own}", laws), name.split()[0])[1], expected)

    def test_own_laws_keep_their_bits_on_two_ranks(self):
        case = write("mine", OWN)
        self.assertEqual(run(self.mine / "my_run", case, "two", ranks=2)[0], run(self.mine / "my_run", case, "one")[0])

    def test_input_is_checked(self):
        wrong = write("wrong", [f'<StrengthModel type="MyHardening" {ELASTIC} Slope="-1"/>', *OWN[1:]])
        self.assertIn(f'{wrong.name}:5: <StrengthModel Slope="-1">: expected a number of at least 0',
                      call(self.mine / "my_run", wrong, code=2))
        misspelt = write("misspelt", [OWN[0].replace("Slope", "Slpe"), OWN[1].replace("MyBulk", "MyBlk"), OWN[2]])
        output = call(self.mine / "my_check", misspelt, code=2)
        self.assertRegex(output, r"Slpe.*did you mean 'Slope'")
        self.assertRegex(output, r"MyBlk.*did you mean 'MyBulk'")
        output = call(arguments.work / "prefix/bin/mpm_check", write("mine", OWN), code=2)
        self.assertIn("MyHardening", output)

    def test_the_reference_lists_the_laws(self):
        reference = call(self.mine / "my_check", "--reference")
        for words in ('`type="MyHardening"`: von Mises with linear hardening, a user\'s own',
                      "| `Slope` | a number of at least 0 | required | stress | growth of the yield stress",
                      '`type="MyBulk"`: quadratic in the compression, with heat',
                      '`type="MyLimit"`: plastic strain above a limit'):
            self.assertIn(words, reference)
        self.assertNotIn("MyHardening", call(arguments.work / "prefix/bin/mpm_check", "--reference"))

    def test_mpm_point_drives_the_laws(self):
        def table(program, laws):
            text = call(program, write("point", laws), "--path", "uniaxial_stress 0.1 rate 1", "-n", 50)
            return [[float(x) for x in row.split(",")] for row in text.splitlines() if re.match(r"[-0-9.]", row)]

        mine, theirs = table(self.mine / "my_point", OWN), table(arguments.work / "prefix/bin/mpm_point", BUILT_IN)
        self.assertEqual(len(mine), 51)
        scale = [max(abs(row[i]) for row in theirs) for i in range(len(theirs[0]))]
        for a, b in zip(mine, theirs):
            for x, y, most in zip(a, b, scale):
                self.assertLessEqual(abs(x - y), 2e-5 * most + 1e-9)  # six digits are printed, of zero stresses too

    def test_own_laws_pass_the_tests_that_hold_for_every_law(self):
        for laws in (OWN[:1], OWN[:2], OWN):
            with self.subTest(laws=laws):
                output = call(self.mine / "my_point", write("tested", laws), "--test", "--duration", 0.02, "--cell-size", 1)
                self.assertEqual(len(re.findall(r"^passed ", output, re.MULTILINE)), 15, output)

    def test_what_cannot_be_a_law_is_refused_by_name(self):
        output = call(self.mine / "my_refused", write("theirs", BUILT_IN), code=2)
        self.assertEqual(output.splitlines(), [
            "StrengthModel 'IsoHarden': a built-in law has this name: choose another",
            "EquationOfState 'Bare', parameter 'A1': no meaning: add .meaning, one line for the keyword reference",
            "EquationOfState 'Bare', parameter 'A1': no range: add .min, .max or both, or .any_number = true if every "
            "finite number is valid"])


parser = argparse.ArgumentParser()
for option in ("build", "generator", "build-type", "compiler", "launcher", "arch"):
    parser.add_argument(f"--{option}", required=True)
parser.add_argument("--sanitize", action="store_true")
arguments = parser.parse_args()
arguments.work = pathlib.Path(arguments.build) / "tests/consumer"
arguments.flags = ["-fsanitize=address,undefined"] if arguments.sanitize else []
unittest.main(argv=["consumer"], verbosity=2)
