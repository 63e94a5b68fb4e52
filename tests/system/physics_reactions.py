"""Reactions of bodies whose velocity is prescribed and of rigid bodies: .sta and histories against exact ones.

Prints what it measures."""

import math

import _cases
import _mpm
import numpy as np
import physics_implicit
import physics_rigid

YOUNG, POISSON = 1000.0, 0.3
AXES = "xyz"


def driven(vx="0", vy="0", vz="0"):
    return f'<PrescribedVelocity vx="{vx}" vy="{vy}" vz="{vz}"/>'


def drive(status, name, letter="f"):
    return np.array([status[f"{letter}{axis}[drive:{name}]"] for axis in AXES])


def impulse(rows, forces, algorithm="MUSL"):
    """Sum of force times interval over the rows after the first, one for each step."""
    return (forces[:, 1:] * np.diff(_cases.impulse_time(rows["time"], algorithm))).sum(axis=1)


def hit(algorithm="MUSL", end=1.0, more=""):
    """A driven block, which also shears, runs into a free one in empty space."""
    bodies = [_mpm.block("ram", (2, 3, 3), (3, 3, 3), more=driven("3 + sin(5*t)", "0.2*(x - 3)", "0.5*t")),
              _mpm.block("block", (5, 3.5, 3), (4, 3, 4))]
    histories = '<TimeHistory var="moment|force"><Body name="ram"/></TimeHistory>'
    return _mpm.scene(bodies, _mpm.grid((0, 0, 0), (20, 12, 12)), _mpm.solution(end, algorithm),
                      output=f'<Console print_time="{end / 7}"/><Restart time_interval="{end / 2}"/>' + histories, more=more)


def rows(path):
    return [line for line in path.read_text().splitlines() if line and not line.startswith("#")]


class Reactions(_mpm.Case):
    def go(self, text, folder="run", **how):
        outcome = self.run_in(folder, [self.write(text)], **how)
        return outcome, _cases.status(self.folder / folder)

    def test_pushing_a_column(self):
        """Slowly by 0.5 % in uniaxial strain: the stress in the column times its area, and with smaller cells that of the law: the
        driven body, as soft as the column, is strained in its first cell, too."""
        end, length, by, errors = 8.0, 8.0, 0.04, []
        mu, lame = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
        stretch = 1 - by / length
        exact = 4 * (mu * (stretch**2 - 1) + lame * math.log(stretch)) / stretch
        law = _mpm.material(strength=f'type="NeoHookean" Young="{YOUNG}" Poisson="{POISSON}"')
        # From rest to rest.
        speed = f"if(t &lt; {end / 2}, {-by * 2 / end!r}*(1 - cos({4 * math.pi / end!r}*t)), 0)"
        for cell in (1.0, 0.5):
            bodies = [_mpm.block("column", (0, 0, 0), (2, 2, length), dp=cell / 2),
                      _mpm.block("ram", (0, 0, length), (2, 2, 2), dp=cell / 2, more=driven(vz=speed))]
            text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), (2, 2, 12), "222220", cell), _mpm.solution(end), [law],
                              output=f'<Console print_time="{end / 40}"/><TimeHistory var="SigmaZ"><Point x="1" y="1" z="4"/></TimeHistory>')
            _, status = self.go(text)
            half = len(status["time"]) // 2
            force, moment = (drive(status, "ram", letter)[:, half + 2:].mean(axis=1) for letter in "fm")
            history = _mpm.table(self.folder / "run/case_curv.dat")
            late = np.array(history["time"]) > 0.55 * end
            inside = 4 * np.array(history["SigmaZ[point1]"])[late].mean()
            errors.append(force[2] / exact - 1)
            print(f"driven ram on a column, cells of {cell}: force {force[2]:.3f}, stress in the column times area {inside:.3f}, law {exact:.3f}")
            self.assertAlmostEqual(force[2] / inside, 1, delta=0.01)
            self.assertLess(np.abs(force[:2]).max(), 1e-9 * abs(exact))
            self.assertLess(np.abs(moment).max(), 1e-9 * abs(exact))
        self.assertLess(abs(errors[0]), 1 / (length + 1) + 0.02)
        self.assertLess(abs(errors[1]), 0.6 * abs(errors[0]))

    def test_momentum(self):
        """What the drive gives is all that the momentum of the scene gains, from row to row."""
        for algorithm in ("MUSL", "USF", "USL", "USAVG"):
            with self.subTest(algorithm=algorithm):
                _, status = self.go(hit(algorithm), algorithm)
                momentum = np.array([status[f"p{axis}"] for axis in AXES])
                history = _mpm.table(self.folder / algorithm / "case_curv.dat")
                shown = np.searchsorted(history["step"], status["step"])
                times = _cases.impulse_time(history["time"], algorithm)[shown]
                given, gained = drive(status, "ram")[:, 1:] * np.diff(times), np.diff(momentum)
                error = np.abs(given - gained).max() / np.abs(momentum).max()
                print(f"driven block hits a free one, {algorithm}: momentum closed to {error:.1e}")
                self.assertGreater(np.abs(status["px[body:block]"][-1]), 10)
                self.assertLess(error, 1e-12)
                every = impulse(history, drive(history, "ram"), algorithm)
                self.assertLess(np.abs(every - given.sum(axis=1)).max(), 1e-12 * np.abs(momentum).max())
                self.assertGreater(len(history["time"]), 3 * len(status["time"]))

    def test_short_last_step(self):
        """Its velocities advance over another time than its positions, here 1/64 of it: the force goes on as before."""
        bodies = [_mpm.block("ram", (2, 2, 4), (2, 2, 2), of="iron", more=driven(vz="-3")), _mpm.block("block", (2, 2, 2), (2, 2, 2))]
        text = _mpm.scene(bodies, _mpm.grid((0, 0, 2), (8, 8, 8), "000010"), _mpm.solution(0.0907, factor=0.9),
                          [_mpm.material(), _mpm.material("iron", strength='type="Rigid"')],
                          '<TimeHistory var="force"><Body name="ram"/></TimeHistory>', '<Contact enable="1" record_contact_force="1"/>')
        text = text.replace(bodies[1], '</Component><Component name="second">' + bodies[1])
        self.go(text)
        table = _mpm.table(self.folder / "run/case_curv.dat")
        steps = np.diff(table["time"])
        self.assertLess(steps[-1], 0.01 * steps[-2])
        for name in ("fz[contact:ram]", "contact_z[1,2]"):
            force = np.array(table[name])
            print(f"last steps {steps[-2]:.2e} and {steps[-1]:.2e}: {name} {force[-3:]}")
            self.assertLess(abs(force[-1] - force[-2]), abs(force[-2] - force[-3]))

    def test_other_body_after_a_restart(self):
        """Means of a body that the input adds to the histories begin at the restart; in every step they are those of a whole run."""
        def text(name, order):
            bodies = {"left": _mpm.block("left", (2, 2, 2), (2, 2, 2), more=driven("1")), "block": _mpm.block("block", (4, 2, 2), (2, 2, 2)),
                      "right": _mpm.block("right", (6, 2, 2), (1, 2, 2), more=driven())}
            output = f'<Console print_time="0.2"/><Restart time_interval="0.1"/><TimeHistory var="force"><Body name="{name}"/></TimeHistory>'
            return _mpm.scene([bodies[b] for b in order], _mpm.grid((0, 0, 0), (8, 8, 8)), _mpm.solution(0.2), output=output)

        _, whole = self.go(text("right", ("left", "block", "right")), "whole")
        expected = _mpm.table(self.folder / "whole/case_curv.dat")
        for order in (("left", "block", "right"), ("right", "block", "left")):
            with self.subTest(order=order):
                self.go(text("left", ("left", "block", "right")), order[0])
                first = min(_mpm.restarts(self.folder / order[0]), key=lambda path: int(path.stem.rpartition("_")[2]))
                self.run_in(order[0], [first, "-rt", self.write(text("right", order))])
                found = _mpm.table(self.folder / order[0] / "case_curv.dat")
                n = len(found["step"])
                self.assertEqual(found["step"], expected["step"][-n:])
                for axis in AXES:
                    forces = [np.array(table[f"f{axis}[drive:right]"])[-n:] for table in (found, expected)]
                    # Round-off of sums in another order, over the last step, which is short.
                    np.testing.assert_allclose(*forces, rtol=1e-9, atol=1e-9)

    @_mpm.needs_implicit_steps
    def test_implicit_equilibrium(self):
        """The force of a rigid ram on a column is the stress in it times its area in every step, for every shape; the same on two
        ranks and through a restart."""
        for shape in physics_implicit.SHAPES:
            with self.subTest(shape=shape):
                text = physics_implicit.column(shape, output='<Console print_time="0.1"/><Restart time_interval="0.5"/>'
                                               '<TimeHistory var="SigmaZ"><Point x="1" y="1" z="2"/></TimeHistory>')
                _, status = self.go(text, shape)
                inside = 4 * np.array(_mpm.table(self.folder / shape / "case_curv.dat")["SigmaZ[point1]"])[1:]
                force = drive(status, "ram")[:, 1:]
                off, across = np.abs(force[2] / inside - 1).max(), np.abs(force[:2]).max() / np.abs(force).max()
                turning = np.abs(drive(status, "ram", "m")).max() / np.abs(force).max()
                print(f"implicit steps, ram on a column, {shape}: force off by {off:.1e}, across {across:.1e}, moment {turning:.1e}")
                self.assertEqual(len(inside), 10)
                # Others than shapes of domains that fill the column have noise where particles have crossed cells.
                if shape != "linear":
                    self.assertLess(off, 1e-3 if shape in ("cpGIMP", "CPDI", "CPDI2") else 0.05)
                self.assertLess(max(across, turning), 1e-6)
        forces = drive(status, "ram")
        for name, how in (("ranks", {"ranks": 2}), ("restart", {})):
            file = _mpm.restarts(self.folder / shape)[0] if name == "restart" else self.write(text)
            self.run_in(name, [file], **how)
            again = drive(_cases.status(self.folder / name), "ram")
            np.testing.assert_allclose(again[:, 1:], forces[:, 1 - again.shape[1]:], atol=1e-5 * np.abs(forces).max())

    @_mpm.needs_implicit_steps
    def test_implicit_momentum(self):
        """What the drive gives is all that the momentum gains, to the solver's tolerance."""
        bodies = [_mpm.block("ram", (2, 3, 3), (3, 3, 3), more=driven("3", "0.2*(x - 3)", "0.5*t")),
                  _mpm.block("block", (5, 3.5, 3), (4, 3, 4))]
        for rule in ('rule="newmark"', 'rule="backward_euler"'):
            for shape in ("linear", "QuadraticBSpline"):
                with self.subTest(rule=rule, shape=shape):
                    grid = _mpm.grid((0, 0, 0), (20, 12, 12)).replace("<Grid>", f'<Grid shape="{shape}">')
                    solution = physics_implicit.implicit(0.2, "dynamic", 0.01, rule)
                    _, status = self.go(_mpm.scene(bodies, grid, solution, [physics_implicit.SOFT], '<Console print_time="0.02"/>'))
                    momentum = np.array([status[f"p{axis}"] for axis in AXES])
                    given, gained = drive(status, "ram")[:, 1:] * np.diff(status["time"]), np.diff(momentum)
                    error = np.abs(given - gained).max() / np.abs(momentum).max()
                    print(f"implicit steps, driven block hits a free one, {rule}, {shape}: momentum closed to {error:.1e}")
                    self.assertGreater(np.abs(status["px[body:block]"][-1]), 1)
                    self.assertLess(error, 1e-6)

    @_mpm.needs_implicit_steps
    def test_implicit_frames(self):
        """A block meets a driven body: the same whether the body hardly moves or is held still, and the books of energy close alike in
        frames in which both move."""
        for rule in ('rule="newmark"', 'rule="backward_euler"', 'rule="generalised_alpha" spectral_radius="0.8"'):
            found = {}
            # Backward Euler damps.
            for speed in (0, 1e-9) if "euler" in rule else (0, 1e-9, 1.0, -1.0):
                bodies = [_mpm.block("body", (0, 0, 4), (2, 2, 2), (0, 0, speed), more=driven(vz=speed)),
                          _mpm.block("block", (0, 0, 6), (2, 2, 3), (0, 0, speed - 0.5))]
                solution = physics_implicit.implicit(0.4, "dynamic", 0.02, rule + ' rtol="1e-9"')
                text = _mpm.scene(bodies, _mpm.grid((0, 0, 0), (2, 2, 14), "222200"), solution, [physics_implicit.SOFT],
                                  '<Console print_time="0.1"/>')
                _, status = self.go(text)
                energy = _mpm.summary(self.folder / "run")["energy"]
                momentum = status["pz[body:block]"] - 12 * speed
                lost = energy["total"] - energy["initial_total"] - energy["external_work"]
                found[speed] = momentum, lost
                print(f"{rule}, frame {speed}: block's momentum {momentum[-1]:+.4f}, energy less work {lost:+.4f} of 1.5")
                self.assertLess(abs(lost), 1.5 if "euler" in rule else 0.5)
            np.testing.assert_allclose(found[1e-9][0], found[0][0], atol=1e-5)
            for speed in set(found) - {0, 1e-9}:  # other cells are crossed
                self.assertAlmostEqual(found[speed][1], found[0][1], delta=0.2)

    def test_moment(self):
        """A body that is driven to turn: the moment about its centre is its inertia times the angular acceleration. It hardly
        has strength."""
        end, rate = 0.05, 4.0
        weak = _mpm.material(strength='type="IsoElastic" Young="1e-6" Poisson="0.3"')
        body = _mpm.block("wheel", (3, 3, 3), (4, 4, 2), more=driven(f"-{rate}*t*(y - 5)", f"{rate}*t*(x - 5)"))
        text = _mpm.scene([body], _mpm.grid((0, 0, 0), (10, 10, 8)), _mpm.solution(end).replace(
            '<TimeStep factor="0.5"/>', f'<TimeStep specified="{end / 50!r}"/>'), [weak], output=f'<Console print_time="{end}"/>')
        _, status = self.go(text)
        moment = drive(status, "wheel", "m")[:, -1]
        # Of 8 x 8 particles of mass 1/8 on a side of 4, by 4 layers.
        places = np.arange(-1.75, 2, 0.5)
        inertia = 4 / 8 * 2 * len(places) * (places**2).sum()
        print(f"driven wheel: moment {moment[2]:.6f}, inertia times acceleration {rate * inertia:.6f}")
        self.assertAlmostEqual(moment[2] / (rate * inertia), 1, delta=1e-4)
        self.assertLess(np.abs(drive(status, "wheel")[:, -1]).max(), 1e-9)
        self.assertLess(np.abs(moment[:2]).max(), 1e-9)

    def test_same_bits(self):
        """Ranks, threads, partitions and restarts, and a restart with nothing left to do."""
        def files(folder):
            return rows(self.folder / folder / "case.sta"), rows(self.folder / folder / "case_curv.dat")

        self.go(hit(), "one")
        expected = files("one")
        for ranks, threads, more in ((1, 2, ""), (3, 1, ""), (2, 1, '<DomainDecomposition method="metis"/>')):
            with self.subTest(ranks=ranks, threads=threads):
                self.go(hit(more=more), "other", ranks=ranks, threads=threads)
                self.assertEqual(files("other"), expected)
        for restart in _mpm.restarts(self.folder / "one"):
            with self.subTest(restart=restart.name):
                self.run_in("one", [restart], ranks=2)
                self.assertEqual(files("one"), expected)

    def test_rigid_body_in_a_history(self):
        """Forces and moments of contact on a free rigid brick, step by step: its momentum and angular momentum."""
        end = 1.0
        pictures = f'<PostProcessing time_interval="{end}" h5part="1" var="velocity_0|velocity_1|velocity_2"/>'
        history = '<TimeHistory var="force|moment"><Body name="brick"/></TimeHistory>'
        text = physics_rigid.thrown(end, pictures + history)
        self.run_in("run", [self.write(text)])
        table = _mpm.table(self.folder / "run/case_curv.dat")
        brick = _mpm.summary(self.folder / "run")["bodies"][1]
        gained = brick["mass"] * (np.array(brick["velocity"]) - [0.4, 0.2, -2])
        given = impulse(table, np.array([table[f"f{a}[contact:brick]"] for a in AXES]))
        self.assertGreater(np.abs(gained).max(), 1)
        self.assertLess(np.abs(given - gained).max(), 1e-11 * np.abs(gained).max())
        states = _cases.States(self.folder / "run")
        mine = states.column("x", 0).size  # of all particles
        of_brick = np.arange(mine) >= mine - 4 * 6 * 4
        place = np.array([states.column(a)[of_brick] for a in AXES]).T
        velocity = np.array([states.column(f"velocity_{a}")[of_brick] for a in range(3)]).T
        arm = place - place.mean(axis=0)
        turns = (brick["mass"] / len(arm)) * np.cross(arm, velocity - velocity.mean(axis=0)).sum(axis=0)
        moment = impulse(table, np.array([table[f"m{a}[contact:brick]"] for a in AXES]))
        print(f"brick: angular momentum {turns}, impulse of the moment {moment}")
        self.assertGreater(np.abs(turns).max(), 0.1)
        self.assertLess(np.abs(moment - turns).max(), 1e-4 * np.abs(turns).max())

    def test_scenes_without_have_no_columns(self):
        self.go(_mpm.bounce(0.1))
        self.assertNotIn("drive:", (self.folder / "run/case.sta").read_text())


if __name__ == "__main__":
    _mpm.main()
