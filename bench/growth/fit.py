"""Fits power laws cost = a n^b to measured costs, by least squares of the logarithms."""
import math
import random
import statistics


def slope(sizes, costs):
    """Returns exponent b and factor a of the power law through at least two sizes and their costs."""
    x = [math.log(size) for size in sizes]
    y = [math.log(cost) for cost in costs]
    mean_x, mean_y = statistics.fmean(x), statistics.fmean(y)
    b = sum((p - mean_x) * (q - mean_y) for p, q in zip(x, y)) / sum((p - mean_x) ** 2 for p in x)
    return b, math.exp(mean_y - b * mean_x)


def fit(sizes, rounds, resamples=2000, seed=1):
    """Fits a power law to the medians over `rounds`, each of which is a list of costs by size.

    Returns the medians, the exponent and factor, the exponent's 95 % interval, and the exponent between the last two
    sizes. The interval is a bootstrap over whole rounds, because a disturbance changes all sizes of a round. It covers
    the noise between rounds. The last exponent shows whether the costs depart from a power law."""
    def medians(chosen):
        return [statistics.median(costs) for costs in zip(*chosen)]
    middle = medians(rounds)
    chance = random.Random(seed)
    exponents = sorted(slope(sizes, medians(chance.choices(rounds, k=len(rounds))))[0] for _ in range(resamples))
    exponent, factor = slope(sizes, middle)
    return {"medians": middle, "exponent": exponent, "factor": factor,
            "low": exponents[int(.025 * resamples)], "high": exponents[int(.975 * resamples) - 1],
            "last": slope(sizes[-2:], middle[-2:])[0]}
