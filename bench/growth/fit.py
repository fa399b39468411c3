"""Power laws through measured costs: cost = a n^b, by least squares of the logarithms."""
import math
import random
import statistics


def slope(sizes, costs):
    """Exponent b and factor a of the least squares line through (log size, log cost). At least two sizes."""
    x = [math.log(size) for size in sizes]
    y = [math.log(cost) for cost in costs]
    mean_x, mean_y = statistics.fmean(x), statistics.fmean(y)
    b = sum((p - mean_x) * (q - mean_y) for p, q in zip(x, y)) / sum((p - mean_x) ** 2 for p in x)
    return b, math.exp(mean_y - b * mean_x)


def fit(sizes, rounds, resamples=2000, seed=1):
    """Of `rounds`, a list of costs by size each: the medians by size, their exponent, its 95 % interval (bootstrap
    over whole rounds, since what disturbs a round disturbs all sizes of it), and the exponent of the last step alone.
    The interval holds what the rounds differ by; how far the points are from a power law shows in the last step."""
    def medians(chosen):
        return [statistics.median(costs) for costs in zip(*chosen)]
    middle = medians(rounds)
    chance = random.Random(seed)
    exponents = sorted(slope(sizes, medians(chance.choices(rounds, k=len(rounds))))[0] for _ in range(resamples))
    exponent, factor = slope(sizes, middle)
    return {"medians": middle, "exponent": exponent, "factor": factor,
            "low": exponents[int(.025 * resamples)], "high": exponents[int(.975 * resamples) - 1],
            "last": slope(sizes[-2:], middle[-2:])[0]}
