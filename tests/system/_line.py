"""The explicit material point method on a line, written for itself from the thesis: the oracle for uniaxial strain.

One material: no strength, Mie-Grueneisen pressure, artificial viscosity. A wall without velocity at x = 0. Nothing is
shared with the solver; the equations are thesis 2-26 to 2-43 (step), 2-57, 2-69, 2-73, 2-74 (viscosity, time step)
and 2-82 to 2-92 (energy and pressure together), in the form that physics/material/pressure_stage.hpp states; the limiter
of the viscosity is that of L. Cullen and W. Dehnen (MNRAS 408 (2010) 669, eqs. 13 to 18), as viscosity_limiter.hpp adapts
it."""

import numpy as np

# Share of a full node's mass below which USL's strain leaves out part of its increment: usl_mass_floor of
# core/step/passes_with.hpp. A full node has the mass of a cell, on the wall half of it.
USL_MASS_FLOOR = 0.2
# wave_limit of core/step/wave_limit.hpp for linear functions.
WAVE_LIMIT = {"MUSL": 1.0, "USF": 0.5, "USL": 0.24, "USAVG": 1.0}


# shock_width of physics/material/viscosity_limiter.hpp, in cells.
SHOCK_WIDTH = 6.0


class Line:
    def __init__(self, length, cell, split, speed, algorithm, factor, density, c0, s1, gamma0, bq1, bq2, limited=False):
        self.cell, self.algorithm, self.factor = cell, algorithm, factor
        self.density, self.c0, self.s1, self.gamma0, self.bq1, self.bq2 = density, c0, s1, gamma0, bq1, bq2
        count = round(length / cell) * split
        size = cell / split
        self.x = (np.arange(count) + 0.5) * size
        self.v = np.full(count, float(speed))
        self.mass = np.full(count, density * size)
        self.first_volume = np.full(count, size)
        self.volume = self.first_volume.copy()
        self.p, self.q, self.energy = np.zeros(count), np.zeros(count), np.zeros(count)
        self.limited, self.alpha, self.rate_before = limited, np.zeros(count), None
        self.nodes = round(length / cell) + 4
        self.wave_limit = WAVE_LIMIT[algorithm]
        self.critical = cell / (c0 / self.wave_limit + abs(speed))
        self.steps = 0

    def run(self, end):
        time = impulses = before = 0.0
        while time < end * (1 - 1e-12):
            dt = min(self.factor * self.critical, end - time)
            # Velocities are advanced from the middle of the step before to that of this one, at the end to the impulses of the
            # whole time; with USF over the step.
            last = time + dt >= end
            own = end - impulses if last else 0.5 * ((before or dt) + dt)
            self.step(dt, dt if self.algorithm == "USF" else own, before)
            time, impulses, before = time + dt, impulses + own, dt
            self.steps += 1

    def step(self, dt, velocity_dt, before):
        """`before`: the length of the step before."""
        lower = np.floor(self.x / self.cell).astype(int)
        s = self.x / self.cell - lower
        node, share, slope = np.stack([lower, lower + 1]), np.stack([1 - s, s]), np.array([[-1], [1]]) / self.cell

        def to_nodes(values):
            return np.bincount(node.ravel(), (values + 0 * share).ravel(), self.nodes)

        def at_wall(velocity):
            velocity[0] = 0
            return velocity

        def velocity_of(momentum):
            return at_wall(np.divide(momentum, mass, out=np.zeros(self.nodes), where=mass > 0))

        def rate(velocity):
            return (slope * velocity[node]).sum(axis=0)

        mass, momentum = to_nodes(share * self.mass), to_nodes(share * self.mass * self.v)
        if self.algorithm == "USF":
            start = velocity_of(momentum)
            at_new_places = rate(start) + self.released(s, (share * start[node]).sum(axis=0), dt)
            wave = self.stress(at_new_places / (1 - dt * at_new_places), dt)
        if self.algorithm == "USAVG" and before:  # with the viscosity that the forces have
            at_new_places = rate(velocity_of(momentum))
            self.stress(at_new_places / (1 - before / 2 * at_new_places), before / 2, half=2)
        dv = velocity_dt * velocity_of(to_nodes(slope * self.volume * (self.p + self.q)))
        velocity = at_wall(velocity_of(momentum) + dv)
        self.v += (share * dv[node]).sum(axis=0)
        if self.algorithm == "USL":
            full = np.full(self.nodes, self.density * self.cell)
            full[0] /= 2
            left_out = np.maximum(0, 1 - mass / (USL_MASS_FLOOR * full))
            wave = self.stress(rate(at_wall(velocity - left_out * dv)), dt)
        if self.algorithm == "MUSL":
            wave = self.stress(rate(velocity_of(to_nodes(share * self.mass * self.v))), dt)
        if self.algorithm == "USAVG":
            again = rate(velocity_of(to_nodes(share * self.mass * self.v)))
            wave = self.stress(again, dt / 2, half=1)
        signal = wave + np.abs(self.v)
        if self.algorithm == "USF":  # wave speeds and velocities are of two passes: each brick's largest of both
            bricks = [lower // 4 == brick for brick in range(lower.max() // 4 + 1)]
            signal = np.array([wave[b].max() + np.abs(self.v[b]).max() for b in bricks if b.any()])
        self.x += dt * (share * velocity[node]).sum(axis=0)
        self.critical = self.cell / signal.max()

    def released(self, place, velocity, dt):
        """What USF adds to the rate of strain of particles trapped at a face of cells (core/shape/face_traps.hpp): those that
        leave it at a speed below twice the largest kick. Of a layer of particles one alone kicks so little that its speed is
        the larger one throughout."""
        upper = place > 0.5
        distance, away = self.cell * np.where(upper, 1 - place, place), np.where(upper, -velocity, velocity)
        kick = dt * self.volume * self.p / (self.mass * self.cell)
        trapped = (kick > 0) & (away > 0) & (away < 2 * kick) & (distance < 2 * dt * away)
        part = 2 - np.divide(away, kick, out=np.ones_like(kick), where=kick > 0)
        return np.where(trapped, away * np.minimum(1, part) / self.cell, 0)

    def stress(self, rate, dt, half=0):
        """Pressure, viscosity and energy after a step at this rate of strain; the speed for the next time step. `half`: of USAVG's
        strain, 1 at the end of a step, 2 at the start of the next; the viscosity that acts in a step does the work around it."""
        new_viscosity = (1, 0, 2)[half]
        volume = self.volume * (1 + rate * dt)
        rho = self.mass / volume
        mu = rho / self.density - 1
        a, slope = self.cold(mu)
        h = (volume - self.volume) / (2 * self.first_volume)

        def sound(p):
            return np.sqrt(np.maximum((1 + mu) * slope + self.gamma0 * p / (1 + mu), 0) / rho)

        squeeze = np.maximum(-rate, 0)
        c = sound(self.p)
        q = rho * self.cell * squeeze * (self.bq1 * self.cell * squeeze + self.bq2 * c)
        if self.limited:
            q *= self.limit(rate, c, dt, half)
        star = self.energy - h * (self.p + (2 - new_viscosity) * self.q + new_viscosity * q)
        self.p = (a + self.gamma0 * star) / (1 + self.gamma0 * h)
        self.energy = star - h * self.p
        self.q, self.volume = q, volume
        damping = np.where(squeeze > 0, self.bq2 * c + self.bq1 * self.cell * squeeze, 0)
        return (damping + np.sqrt(damping**2 + sound(self.p) ** 2)) / self.wave_limit

    def limit(self, rate, c, dt, half):
        """The factor alpha of the viscosity: that of the switch where it is larger, else on its way down to it. The velocity
        changes once in a step: the half at its start finds no growth."""
        squeeze = np.maximum(-rate, 0)
        grows = squeeze**2 if self.rate_before is None else np.maximum(self.rate_before - rate, 0) / (2 * dt if half else dt)
        if half == 2:
            grows = np.zeros_like(rate)
        else:
            self.rate_before = rate
        own = (32 * squeeze) ** 2  # 2 (1 - R)^4 D with R = -1; the deviator of uniaxial strain has S : S = 2/3 D^2
        shock = np.divide(own, own + 2 / 3 * rate**2, out=np.zeros_like(rate), where=own > 0)
        signal = c + self.cell * squeeze
        local = np.minimum((SHOCK_WIDTH * self.cell / signal) ** 2 * shock * grows, 1)
        relaxed = local + (self.alpha - local) / (1 + 0.1 * signal * dt / self.cell)
        self.alpha = np.maximum(local, relaxed)
        return self.alpha

    def cold(self, mu):
        """p = a + gamma0 E: a and da/dmu. In tension a is linear."""
        stiffness, m = self.density * self.c0**2, np.maximum(mu, 0)
        pole = 1 - (self.s1 - 1) * m
        top = m * (1 + (1 - self.gamma0 / 2) * m)
        top_slope = 1 + (2 - self.gamma0) * m
        slope = (top_slope + 2 * (self.s1 - 1) * top / pole) / pole**2
        return stiffness * (top / pole**2 + np.minimum(mu, 0)), stiffness * np.where(mu > 0, slope, 1)
