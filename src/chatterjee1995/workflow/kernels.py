"""Compile all kernels (numba functions) into the cache before jobs call them."""

import gc
import json
import sys
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from impact_damper.kernel.sources import kernel_digest, module_file

WARM_UP = "impact_damper.command.warm_up"


def compiled_kernels(orders) -> str:
    """Return a text that changes with the sources of the kernels and with the Taylor `orders`."""
    return f"{kernel_digest(*map(module_file, (WARM_UP, __name__)))} {orders}\n"


def compile_all(processes, orders) -> None:
    """Compile all kernels. `orders` are pairs of Taylor orders for the stage `accuracy`."""
    from chatterjee1995.workflow.job import end_with_parent
    from impact_damper.command.warm_up import warm_up_orbits, warm_up_settling

    # Garbage collection would take a fifth of the time. Forked processes inherit this setting.
    gc.disable()
    fork = get_context("fork")
    with ProcessPoolExecutor(processes, fork, initializer=end_with_parent) as pool:
        tasks = [pool.submit(warm_up_orbits), pool.submit(warm_up_settling)]
        for task in [*tasks, pool.submit(warm_up_paper, orders)]:
            task.result()


def warm_up_paper(orders=()) -> None:
    """Call each kernel of the stages, so that all jobs load the same code from the cache."""
    import numpy as np

    from chatterjee1995.methods.integrators import integrators
    from chatterjee1995.methods.integrators.taylor import ORDERS, taylor
    from chatterjee1995.methods.orbit_models import rigid
    from chatterjee1995.methods.passages import draw_passages, without_walls
    from chatterjee1995.stages.collisions import first_collision
    from chatterjee1995.stages.release_policies import release_policies
    from impact_damper.command.warm_up import DAMPER, FREQUENCY, OSCILLATOR
    from impact_damper.model.packed import pack
    from impact_damper.model.settling import Settling
    from impact_damper.motions.strobe_map import strobe_time

    p = pack(OSCILLATOR, DAMPER, 2.0)
    start, begin = np.array([0.082, 0.169, 0.381, -1.088]), strobe_time(p)
    for each in (ORDERS, *map(tuple, orders)):
        taylor(p, start, begin, 1, 1e-3, each)
    first_collision(p, start, 1, 1e-3)
    rigid(p, 0.75, start, begin, 1, 1e-3)
    for each in integrators("accuracy").values():
        for locate in each.located:
            each.run(p, start, begin, 1, 1e-3, locate, 1000)
    for each in integrators("missed_contacts").values():
        each.flight(without_walls(p), start, 1.0, 100 if each.fixed else 1e-3, 0.5)
    for each in integrators("stable_steps").values():
        each.largest_displacements(p, start, begin, 1, 100)
    draw_passages(p, 1, 2.0, 0.1, 1995)
    # This call comes last, because it needs kernels that `warm_up_settling` compiles.
    settling = Settling(patience=100, limit=100, watched=1)
    numbers = {"trials": 1, "cells": 4, "settling": settling}
    release_policies(OSCILLATOR, [DAMPER], [FREQUENCY], **numbers)


if __name__ == "__main__":
    compile_all(*json.loads(sys.argv[1]))
