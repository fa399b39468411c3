"""Tests fits of costs with known power laws."""
import random
import unittest

import fit

SIZES = [1, 4, 16, 64]


class Fit(unittest.TestCase):
    def test_a_power_law_is_found_exactly(self):
        found = fit.fit(SIZES, [[3 * n ** .75 for n in SIZES]] * 6)
        for name, wanted in {"exponent": .75, "low": .75, "high": .75, "last": .75, "factor": 3}.items():
            self.assertAlmostEqual(found[name], wanted, msg=name)

    def test_the_last_step_tells_what_a_constant_hides(self):
        found = fit.fit(SIZES, [[10 + n for n in SIZES]] * 6)
        self.assertLess(found["exponent"], found["last"])

    def test_the_interval_holds_the_exponent_of_noisy_rounds(self):
        chance = random.Random(7)
        held, runs = 0, 60
        for _ in range(runs):
            rounds = [[n * chance.lognormvariate(0, .1) for n in SIZES] for _ in range(12)]
            found = fit.fit(SIZES, rounds, resamples=200)
            self.assertLess(found["high"] - found["low"], .2)
            held += found["low"] <= 1 <= found["high"]
        self.assertGreater(held, .8 * runs)

    def test_one_disturbed_round_moves_nothing(self):
        found = fit.fit(SIZES, [[1, 1, 1, 1]] * 5 + [[1, 1, 1, 50]])
        self.assertEqual(found["exponent"], 0)


unittest.main()
