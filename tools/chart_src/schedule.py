"""Which methods get the next level of samples in the time that is left."""

GROWTH = 2.2  # of a level's time over that of half the samples: a little more than twice


def kept_back(cost_s, spp, max_spp, most_s):
    """Seconds for the levels after `spp` of a method whose level `spp` takes `cost_s`: as many as fit
    into `most_s`."""
    kept = 0.0
    while 2 * spp <= max_spp and kept + GROWTH * cost_s <= most_s:
        spp, cost_s = 2 * spp, GROWTH * cost_s
        kept += cost_s
    return kept


def fitting(names, took, spp, max_spp, left_s, all_s):
    """Those of `names`, in order, whose level `spp` fits into `left_s` seconds beside the later levels of the
    first, which has a right to half of `all_s`: its curve is what all others are compared with.
    `took[name, spp]` are the seconds of a level done; a method without the level before has been left out
    and stays so."""
    def cost(name):
        return 0.0 if spp == 1 else GROWTH * took.get((name, spp // 2), float("inf"))
    if spp > 1:
        spent = sum(seconds for (name, _), seconds in took.items() if name == names[0])
        first = cost(names[0])
        left_s -= kept_back(first, spp, max_spp, min(all_s / 2 - spent, left_s) - first)
    fits = []
    for name in names:
        if cost(name) <= left_s:
            fits.append(name)
            left_s -= cost(name)
    return fits
