"""A scene that leaves its scheme to the program, and in which MUSL gains energy: it goes on with USAVG, at the same step and with
the same bits on any ranks and threads and through a restart before the change or after it; a named scheme stays.

The scene: an elastic block that vibrates while it drifts across cells, where MUSL with linear functions gains several per cent of the
energy."""

import _mpm
from _mpm import Case

END, RESTARTS = 6.0, 1.5
SPEED = [f"{drift}+0.5*cos(pi*({axis}-{low})/6)" for drift, axis, low in zip((0.4, 0.3, 0.2), "xyz", (2.1, 2.2, 2.3))]
SOFT = _mpm.material("soft", 1.0, 'type="IsoElastic" Young="1000" Poisson="0.3"')
OUTPUT = f'<Console print_time="{END / 50}"/><Restart time_interval="{RESTARTS}"/>'


def scene(algorithm="", shape="linear", transfer="", speed=SPEED, factor=0.9):
    body = _mpm.block("block", (2.1, 2.2, 2.3), (6, 6, 6), speed, 0.5, "soft")
    solution = _mpm.solution(END, "MUSL", factor, transfer).replace('algorithm="MUSL"', algorithm)
    return _mpm.scene([body], _mpm.grid((0, 0, 0), (12, 12, 12)).replace("<Grid>", f'<Grid shape="{shape}">'), solution, [SOFT],
                      OUTPUT)


def change(outcome):
    """The line of the log that says when the scheme has changed."""
    said = [line for line in outcome.out.splitlines() if line.startswith("scheme ") and "goes on with USAVG" in line]
    assert len(said) <= 1, said
    return said[0] if said else ""


class SchemeChange(Case):
    def test_the_energy_is_kept(self):
        """With every way to leave the scheme open; a named MUSL gains a multiple."""
        drift = {}
        for name, algorithm in (("open", ""), ("auto", 'algorithm="auto"'), ("MUSL", 'algorithm="MUSL"')):
            done = self.run_in(name, [self.write(scene(algorithm))])
            drift[name] = _mpm.summary(self.folder / name)["energy"]["relative_drift"]
            self.assertEqual(bool(change(done)), name != "MUSL")
            self.assertEqual("scheme_change" in _mpm.summary(self.folder / name), name != "MUSL")
        self.assertEqual(drift["open"], drift["auto"])
        self.assertLess(abs(drift["auto"]), 0.015)
        self.assertGreater(drift["MUSL"], 0.04)
        self.assertEqual(_mpm.summary(self.folder / "open")["scheme_change"]["to"], "USAVG")

    def test_same_bits(self):
        path = self.write(scene())
        alone = self.run_in("alone", [path])
        when = _mpm.summary(self.folder / "alone")["scheme_change"]["after_step"]
        self.assertIn(f"step {when}, ", change(alone))
        restarts = _mpm.restarts(self.folder / "alone")
        for n, how in enumerate(({"ranks": 3}, {"ranks": 2, "threads": 2})):
            other = self.run_in(f"other{n}", [path], **how)
            self.assertEqual(other.state, alone.state)
            self.assertEqual(change(other), change(alone))
        # The two restart files that are kept are of after the change.
        for n, (file, how) in enumerate(zip(restarts, ({"ranks": 2}, {}))):
            again = self.run_in(f"again{n}", [file], **how)
            self.assertEqual(again.state, alone.state)
            self.assertEqual(change(again), "", "it has been said")
            self.assertEqual(_mpm.summary(self.folder / f"again{n}")["scheme_change"]["after_step"], when)

    def test_same_bits_from_a_restart_before_the_change(self):
        """With shorter steps, so that the change comes late."""
        text = scene(factor=0.5)
        alone = self.run_in("alone", [self.write(text)])
        when = _mpm.summary(self.folder / "alone")["scheme_change"]["after_step"]
        part = self.run_in("part", [self.write(text.replace(f'time_interval="{RESTARTS}"', 'time_interval="0.05"')), "-nsteps", "2"])
        self.assertEqual(change(part), "")
        before = _mpm.restarts(self.folder / "part")[-1]
        again = self.run_in("again", [before], ranks=2)
        self.assertEqual(again.state, alone.state)
        self.assertIn(f"step {when}, ", change(again))

    def test_what_does_not_change(self):
        """Transfers that lose energy with any scheme stay with MUSL, and a scene that keeps its energy does: the block that only drifts."""
        for name, text in (("PIC", scene(transfer='transfer="PIC"')), ("kept", scene(shape="SGMP", speed=(0.4, 0.3, 0.2)))):
            done = self.run_in(name, [self.write(text)])
            self.assertEqual(change(done), "")
            self.assertNotIn("scheme_change", _mpm.summary(self.folder / name))

    def test_a_restart_with_a_named_scheme(self):
        """-rt with an input that names MUSL goes on with MUSL."""
        self.run_in("alone", [self.write(scene())])
        named = self.write(scene('algorithm="MUSL"').replace(f'EndTime value="{END!r}"', f'EndTime value="{2 * END!r}"'), "named.xmp")
        done = self.run_in("named", [_mpm.restarts(self.folder / "alone")[-1], "-rt", named])
        self.assertNotIn("scheme_change", _mpm.summary(self.folder / "named", "named"))
        self.assertIn("stress and motion", done.out)


if __name__ == "__main__":
    _mpm.main()
