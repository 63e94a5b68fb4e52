"""One bit flips in some file of a run that was killed or stopped; then the run goes on. It must reach its end with the
right state, or say what is wrong and leave with exit code 2 or 5: no signal, no hang, no wrong state.

    bit_flips.py [flips, 300] [seed, 1]"""

import collections
import random
import shutil
import signal

import _attack
from _attack import _mpm, _resume

MORE = 0.2  # simulated time to go, a few steps


def kind_of(path):
    return "_curv.dat" if path.name.endswith("_curv.dat") else path.suffix


class Victims:
    """A killed and a stopped run, each with the input with which it goes on and the state at which that ends."""

    def __init__(self, ground):
        self.folder = ground.folder
        self.states, self.files = {}, {}
        for name in ("killed", "stopped"):
            case, out = self.case(name), self.folder / name / "out"
            case.parent.mkdir()
            case.write_text(_resume.scene(pictures="both"))
            if name == "killed":
                _resume.start_and_kill(case, out, files=3)
            else:
                process = _mpm.start([case, "--output-dir", out])
                assert _resume.wait_for(lambda: len(_mpm.restarts(out)) > 1, process)
                process.send_signal(signal.SIGUSR1)
                assert _mpm.finish(process).code == _mpm.STOPPED
            end = _resume.time_of(_mpm.restarts(out)[-1]) + MORE
            case.write_text(_resume.scene(end, pictures="both"))
            outcome = _mpm.run([case, "--output-dir", self.folder / name / "undisturbed"])
            assert outcome.code == 0, outcome
            self.states[name] = outcome.state
            self.files[name] = collections.defaultdict(list)
            for path in sorted(out.rglob("*")):
                if path.is_file() and path.stat().st_size > 0 and path.suffix not in (".lock", ".part"):
                    self.files[name][kind_of(path)].append(path.relative_to(out))

    def case(self, name):
        return self.folder / name / "case.xmp"


def flip(path, chance):
    data = bytearray(path.read_bytes())
    place = chance.randrange(len(data))
    data[place] ^= 1 << chance.randrange(8)
    path.write_bytes(data)
    return place


def main():
    flips, seed = _attack.trials(300)
    ground = _attack.Ground("flips")
    victims = Victims(ground)
    chance = random.Random(seed)
    ends = collections.Counter()
    kinds = sorted({(name, kind) for name in victims.files for kind in victims.files[name]})
    for n in range(flips):
        name, kind = kinds[n % len(kinds)]
        out = ground.folder / f"flip{n}"
        shutil.copytree(ground.folder / name / "out", out)
        path = out / chance.choice(victims.files[name][kind])
        place = flip(path, chance)
        what = f"byte {place} of {path.relative_to(out)} of the {name} run"
        ranks = 2 if n % 7 == 3 else 1
        outcome = _mpm.run([out / "case.pe", "-rt", victims.case(name), "--output-dir", out], ranks=ranks)
        said = "warning:" in outcome.out or outcome.complaint
        if outcome.code == 0 and outcome.state == victims.states[name]:
            ends[kind, "right, with a warning" if said else "right"] += 1
            # A picture's own .vtu and .pvtu files are not looked at when a run goes on.
            look = not said and kind not in (".vtu", ".pvtu")
            wrong = _attack.differences(out, ground.folder / name / "undisturbed") if look else []
            if wrong:
                ground.fault(n, f"{what}: other contents and no word of it: {', '.join(wrong)}")
                continue
        elif outcome.code in (_mpm.INPUT_ERROR, _mpm.FILE_ERROR) and outcome.complaint:
            ends[kind, f"refused with exit code {outcome.code}"] += 1
        else:
            ends[kind, "FAULT"] += 1
            ground.fault(n, f"{what}: {outcome}")
            continue
        shutil.rmtree(out)
    for (kind, end), number in sorted(ends.items()):
        print(f"{kind:<12} {end:<28} {number:>5}")
    ground.end()


if __name__ == "__main__":
    main()
