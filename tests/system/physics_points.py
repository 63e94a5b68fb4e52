"""Means in cells: histories at points and the number of occupied cells, with functions whose particles belong to cells and with
those whose particles belong to nodes, where up to eight bricks, also of several ranks, have particles in one cell."""

import _mpm

SHAPES = ("linear", "CubicBSpline", "SGMP", "uGIMP")


class Points(_mpm.Case):
    def scene(self, shape, block, output):
        grid = _mpm.grid((0, 0, 0), (16, 10, 10)).replace("<Grid>", f'<Grid shape="{shape}">')
        return self.write(_mpm.scene([block], grid, _mpm.solution(1e-9), output=output))

    def test_mean_velocity_at_points(self):
        block = _mpm.block("block", (1, 1, 1), (6, 6, 6), ("x", 0, 0))
        points = "".join(f'<Point x="{x}" y="3.5" z="2.5"/>' for x in (2.4, 3.4, 4.4))
        for shape in SHAPES:
            for ranks in (1, 2):
                with self.subTest(shape=shape, ranks=ranks):
                    self.run_in("run", [self.scene(shape, block, f'<TimeHistory var="velocity_0">{points}</TimeHistory>')], ranks=ranks)
                    table = _mpm.table(self.folder / "run/case_curv.dat")
                    found = [values[0] for name, values in table.items() if name.startswith("velocity_0")]
                    for value, x in zip(found, (2.4, 3.4, 4.4)):
                        # Of particles at a quarter and at three quarters of the cell.
                        weights = [1 - abs(place - x) for place in (int(x) + 0.25, int(x) + 0.75)]
                        exact = sum(w * (int(x) + f) for w, f in zip(weights, (0.25, 0.75))) / sum(weights)
                        self.assertAlmostEqual(value, exact, delta=1e-6)
                    self.assertEqual(len(found), 3)

    def test_occupied_cells(self):
        for size in (1, 4):
            block = _mpm.block("block", (3, 3, 3), (size, size, size))
            for shape in SHAPES:
                for ranks in (1, 3):
                    with self.subTest(size=size, shape=shape, ranks=ranks):
                        self.run_in("run", [self.scene(shape, block, '<Statistics memory="0" cell_occupy="1"/>')], ranks=ranks)
                        share = _mpm.table(self.folder / "run/case.sta")["cell_occupancy"][0]
                        self.assertAlmostEqual(share * 1600, size**3, delta=1e-9)


_mpm.main()
