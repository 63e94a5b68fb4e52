"""The cases of the accuracy benchmark. A new one is a module beside these and a line of this list."""

from cases import (colliding_discs, column, crossing, dam_break, detonation, elastic_statics, expanding_ring,
                   flying_plate, incompressible, manufactured_cube, on_face, plane_shock, rest, riemann, sedov, spinning_cube, standing_wave,
                   taylor_bar, vortex)

CASES = {module.CASE.name: module.CASE for module in (
    manufactured_cube, vortex, crossing, on_face, standing_wave, riemann, plane_shock, detonation, sedov, column,
    elastic_statics, expanding_ring, incompressible, spinning_cube, colliding_discs, taylor_bar, dam_break, rest,
    flying_plate)}
