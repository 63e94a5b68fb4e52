"""Contact where particles take velocities from the nodes, wholly (PIC, APIC, TPIC, XPIC, FMPM) or in part, and with the consistent mass
matrix: what slides, and the impulses and the energy that contact records.

Prints what it measures."""

import _contact
import _mpm
import numpy as np

PIC, APIC, TPIC, AFLIP = (f'transfer="{name}"' for name in ("PIC", "APIC", "TPIC", "AFLIP"))
XPIC, FMPM = 'transfer="XPIC" xpic_order="3"', 'transfer="FMPM" xpic_order="4"'
LUMPED, CONSISTENT = 'transfer="FLIP"', 'transfer="FLIP" mass="consistent"'
PLAIN = (LUMPED, 'transfer="FLIP" flip_fraction="0.95"', PIC, XPIC, FMPM, CONSISTENT)


class ContactOfTransfers(_contact.Case):
    def test_sliding_with_corrected_velocities(self):
        """Contact acts on the sums of the orders, too."""
        for transfer in (XPIC, FMPM):
            for shape, most in (("linear", 0.02), ("QuadraticBSpline", 0.01)):
                with self.subTest(transfer=transfer, shape=shape):
                    acceleration, slid, heat, across, _ = self.slide(0.3, 1, _contact.SURFACES, shape, transfer=transfer)
                    self.assertGreater(slid, 1.2)
                    self.assertAlmostEqual(acceleration, 1, delta=most)
                    self.assertAlmostEqual(heat, 1, delta=most)
                    self.assertLess(abs(across), 1e-3)

    def test_sliding_with_consistent_mass(self):
        """Forces and the impulses of contact, which balance, are solved for together. (Impulses by lumped mass beside solved forces drove the
        block 28 % too fast, with type 0.)"""
        for kind in (0, 1):
            for shape in ("linear", "QuadraticBSpline"):
                for friction in (0, 0.3):
                    with self.subTest(kind=kind, shape=shape, friction=friction):
                        acceleration, slid, heat, across, drift = self.slide(friction, kind, _contact.SURFACES, shape, transfer=CONSISTENT)
                        self.assertGreater(slid, 1.2)
                        self.assertAlmostEqual(acceleration, 1, delta=1e-3)
                        if friction > 0:
                            self.assertAlmostEqual(heat, 1, delta=2e-3)
                        self.assertLess(abs(across), 1e-3)
                        self.assertLess(abs(drift), 1e-3)

    def test_rebound_with_consistent_mass(self):
        """Of discs, as with lumped mass: nothing is gained, and the books know what is lost. (Blows of contact that were solved for, too,
        gained 6.5 % in the blow of a rigid brick.)"""
        for shape in ("linear", "uGIMP", "QuadraticBSpline", "DDMP"):
            for kind in (0, 1):
                with self.subTest(shape=shape, kind=kind):
                    restitution = {}
                    for transfer in (LUMPED, CONSISTENT):
                        _, summary, status = self.go(_contact.discs(kind, _contact.SURFACES, shape, transfer=transfer))
                        restitution[transfer] = status["vx[body:right]"][-1] / 0.5
                        lost, drift = 1 - status["total"][-1] / status["total"][0], summary["energy"]["relative_drift"]
                        print(f"rebound {shape:16} type {kind} {transfer:33} lost {lost:+.4f} restitution {restitution[transfer]:.4f} drift {drift:+.1e}")
                        self.assertLess(abs(drift), 0.04)
                        self.assertLess(lost, 0.08)
                        self.assertGreater(lost, -0.001, "nothing is gained")
                    self.assertAlmostEqual(restitution[CONSISTENT], restitution[LUMPED], delta=0.03)

    def test_recorded_impulses(self):
        """They are those that the bodies get. With type 0, where particles take velocities from the nodes, these had 2 to 6 % more."""
        for shape, transfers in (("linear", PLAIN), ("QuadraticBSpline", (*PLAIN, APIC, TPIC, AFLIP))):
            for transfer in transfers:
                with self.subTest(transfer=transfer, shape=shape):
                    self.check_impulses(transfer, shape)

    def check_impulses(self, transfer, shape):
        energies = []
        for kind in (0, 1, 2):
            _, summary, status = self.go(_contact.discs(kind, _contact.SURFACES, shape, transfer=transfer))
            time, force = self.forces()
            energies.append(summary["energy"])
            momentum = max(np.abs(status[f"p{a}"]).max() for a in "xyz") / status["px[body:left]"][0]
            gained = status["px[body:right]"][-1] - status["px[body:right]"][0]
            recorded = np.sum(force[1:, 0] * np.diff(time))
            print(f"impulses {transfer:36} {shape:16} type {kind} recorded/gained - 1 {recorded / gained - 1:+.1e} momentum {momentum:.1e} "
                  f"restitution {status['vx[body:right]'][-1] / 0.5:.4f} lost {1 - status['total'][-1] / status['total'][0]:+.4f} "
                  f"drift {energies[-1]['relative_drift']:+.1e}")
            self.assertLess(momentum, 2e-12)
            self.assertEqual(force[-1, 0], 0, "they have parted")
            self.assertAlmostEqual(recorded / gained, 1, delta=2e-4)
        if transfer in (PIC, APIC, TPIC):  # types 0 and 2 give these particles the same
            booked = [energy["dissipated_by_contact"] for energy in energies]
            self.assertAlmostEqual(booked[0] / booked[2], 1, delta=1e-6)
        if transfer in (XPIC, FMPM):
            self.assertLess(max(energy["relative_drift"] for energy in energies), 0.01, "they lose energy, and gain none")


if __name__ == "__main__":
    _mpm.main()
