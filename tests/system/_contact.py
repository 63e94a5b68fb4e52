"""Scenes of two elastic components in contact, and what is measured of them: a block that slides down a plane, discs that meet head on.

Gaps are in cells."""

import math

import _cases
import _mpm
import numpy as np

SHARED_NODE, SURFACES = "", 'distance_type="2" min_distance="0.05"'
YOUNG = 1000.0
EVERY_STEP = '<TimeHistory var="pres"><Point x="1" y="1" z="0.5"/></TimeHistory>'


def component(name, bodies, weight=0.0):
    return f'<Component name="{name}" normal_vector_weight="{weight}">{bodies}</Component>'


def scene(components, grid, solution, output, shape="linear", kind=1, distance=SURFACES, friction=0.0, young=YOUNG,
          normal="mass_gradient", transfer=""):
    material = _mpm.material(strength=f'type="IsoElastic" Young="{young}" Poisson="0.3" bq1="0" bq2="0"')
    rubs = _mpm.friction("soft", "soft", friction)
    return "\n".join(['<?xml version="1.0" encoding="utf-8"?>', '<PeneBlast version="1.0">', material, rubs, *components,
                      grid.replace("<Grid>", f'<Grid shape="{shape}">'),
                      f'<Contact enable="1" contact_type="{kind}" {distance} record_contact_force="1" '
                      f'contact_normal="{normal}"/>', solution.replace("<Solution ", f"<Solution {transfer} "),
                      f"<Output>{output}</Output>", "</PeneBlast>", ""])


def sliding(friction, kind, distance, shape="linear", end=4.0, output="", weight=1, **more):
    """A block on a base that is held from below, under a body force along its plane at 30 degrees to the x axis. The
    weight comes on slowly, then the rest: the plane's slope has the tangent 0.6."""
    slope = "0.6*min(max((t-0.5)/0.25,0),1)"
    force = (f'<BodyForce bx="{math.cos(math.radians(30))!r}*{slope}" by="{math.sin(math.radians(30))!r}*{slope}" '
             'bz="-min(t/0.5,1)"/>')
    # The base's normals are those of its plane; those of the block tilt at its edges.
    bodies = [component("base", _mpm.block("base", (0, 0, 0), (12, 10, 2)), weight),
              component("top", _mpm.block("top", (2.2, 2.3, 2), (5, 4, 1), more=force))]
    return scene(bodies, _mpm.grid((0, 0, 0), (12, 10, 6), "000010"), _mpm.solution(end),
                 f'<Console print_time="{end / 40}"/>' + output, shape, kind, distance, friction, 1e4, **more)


def discs(kind, distance, shape, rings=0, end=3.6, output="", speed=0.5, friction=0.0, offset=0.0, **more):
    """Two discs of radius 5, 0.6 apart, in a layer of one cell between symmetry planes."""

    def disc(name, x, y, velocity):
        return component(name, f'<Body name="{name}" material="soft" type="Cylinder"><Geometry dp_bottom="0.5" dp_top="0.5" '
                         f'x0="{x}" y0="{y}" z0="0" Bottom_Outer_Radius="5" Top_Outer_Radius="5" height="1" '
                         f'discretization="{rings}"/><InitialVelocity vx="{velocity}" vy="0" vz="0"/></Body>')

    return scene([disc("left", 6.23, 7.35, speed), disc("right", 16.83, 7.35 + offset, -speed)],
                 _mpm.grid((-2, 0, 0), (25, 16, 1), "000022"), _mpm.solution(end),
                 f'<Console print_time="{end / 50}"/>' + EVERY_STEP + output, shape, kind, distance, friction, **more)


class Case(_mpm.Case):
    def go(self, text, folder="run", **how):
        outcome = self.run_in(folder, [self.write(text)], **how)
        return outcome.state, _mpm.summary(self.folder / folder), _cases.status(self.folder / folder)

    def forces(self, folder="run"):
        found = _mpm.table(self.folder / folder / "case_curv.dat")
        return np.array(found["time"]), np.column_stack([found[f"contact_{a}[1,2]"] for a in "xyz"])

    def motion(self, status):
        """Times, and the block's velocities along the slope and across."""
        along = np.array([math.cos(math.radians(30)), math.sin(math.radians(30))])
        velocity = np.column_stack([status[f"v{a}[body:top]"] for a in "xy"])
        return status["time"], velocity @ along, velocity @ np.array([-along[1], along[0]])

    def acceleration(self, status, friction):
        """Of the block, over Coulomb's."""
        time, speed, _ = self.motion(status)
        late = time >= 1
        return np.polyfit(time[late], speed[late], 1)[0] / (0.6 - friction)

    def slide(self, friction, kind, distance, shape, **more):
        """Prints and returns: acceleration over Coulomb's, what it slid, friction heat over mu N s, velocity across over
        along, energy drift."""
        _, summary, status = self.go(sliding(friction, kind, distance, shape, **more))
        time, speed, across = self.motion(status)
        late = time >= 1
        acceleration = self.acceleration(status, friction)
        first = np.argmax(late)
        slid = np.trapz(speed[first:], time[first:])
        heat = status["friction_heat"][-1] - status["friction_heat"][first]
        heat = heat / (friction * 20 * slid) if friction > 0 else heat / (0.6 * 20 * slid)
        drift = summary["energy"]["relative_drift"]
        print(f"sliding mu {friction} type {kind} {distance or 'shared node':38} {shape:16} {more or ''} a/exact - 1 "
              f"{acceleration - 1:+.5f} heat/(mu N s) - 1 {heat - 1:+.5f} across/along {across[-1] / speed[-1]:+.1e} "
              f"slid {slid:.3f} drift {drift:+.1e}")
        return acceleration, slid, heat, across[-1] / speed[-1], drift
