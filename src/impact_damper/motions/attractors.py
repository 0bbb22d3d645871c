"""Attractors, labels of states, and release sets.

An attractor is a stable orbit. The label of a state names the attractor to which the state leads. A
release set holds all states of the free oscillator that lead to the goal of migration. A
neighbourhood is an ellipse around a state of a free orbit at the strobe (W T = pi/2). A motion that
enters the ellipse tends to the orbit, so its run ends (docs/explanation/neighbourhoods.md).
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.ndimage import distance_transform_edt, maximum_filter, minimum_filter

from impact_damper.data.datasets import is_settled
from impact_damper.data.variables import BASIN_LABEL
from impact_damper.kernel.single import workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import FREQUENCY, cubic_spring, pack
from impact_damper.motions import ensemble, records, traces
from impact_damper.motions.start_states import free_motions
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, STROBE, strobe_time

# The largest neighbourhood of an orbit is found by HALVINGS bisections, with STEPS time steps in a
# forcing cycle. In a period of the orbit the neighbourhood's size is multiplied by at most FACTOR.
STEPS, FACTOR, HALVINGS = 256, 0.98, 30
# ALIKE: two free orbits are equal if their states at the strobe differ by less than this number.
# SAME: two motions with the damper are equal if their max |Z1| differ by less than this fraction.
ALIKE, SAME = 1e-6, 1e-5
# Grid of states in the search for orbits. SEARCHED: number of grid points along each axis. On both
# sides of 0 the grid reaches REACH/2 times the largest |Z1| and |Z1'| of free motions.
REACH, SEARCHED = 3.0, 24
# Labels of unsettled motions, by outcome. The label of a settled motion is its attractor's index.
LABELS = {
    records.UNRESOLVED: BASIN_LABEL["unresolved"],
    records.DIVERGED: BASIN_LABEL["escaped"],
    records.ESCAPED: BASIN_LABEL["escaped"],
    records.CHAOTIC: BASIN_LABEL["chaotic"],
    records.NON_COLLIDING: BASIN_LABEL["no_contact"],
    records.DRIFTING: BASIN_LABEL["no_contact"],
    records.QUASI_PERIODIC: BASIN_LABEL["quasi_periodic"],
}
# PHASES: number of forcing phases in a release set, even. WIDTH: half width of its grids in Z1,
# divided by max |Z1| of the resonance motion. REFINED: fine cells per coarse cell along each axis.
PHASES, WIDTH, REFINED = 16, 1.6, 4


class Attractors(NamedTuple):
    """Stable orbits of the free oscillator, by ascending max |Z1|, and their neighbourhoods.

    Neighbourhood k belongs to the orbit records[owner[k]]. It contains a state z at the strobe if
    |shape[k] (z - centre[k])| < 1. If no neighbourhood could be proved, shape[k] is infinite.
    """

    records: np.ndarray
    owner: np.ndarray
    centre: np.ndarray
    shape: np.ndarray


def find_attractors(p, states, settling) -> Attractors:
    """Return the attractors of the free motions that start in `states`, (Z1, Z1') at the strobe."""
    starts = np.tile(np.asarray(states, float).reshape(-1, 2), 2)
    motions = ensemble.settle(np.tile(p, (len(starts), 1)), starts, settling, from_strobe=True)
    return with_neighbourhoods(p, _distinct(p, motions[is_settled(motions)]))


def free_attractors(p, window, settling) -> Attractors:
    """Return the attractors of the free motions that start on a grid with half widths `window`."""
    grid = [np.linspace(-half, half, SEARCHED) for half in window]
    states = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    return find_attractors(p, states, settling)


def with_neighbourhoods(p, records) -> Attractors:
    """Return the orbits in `records`, with a neighbourhood of each of their strobe states."""
    orbits = [orbit_states(p, record, STROBE)[:, :2] for record in records]
    shapes = [neighbourhood(p, state, len(states)) for states in orbits for state in states]
    owner = np.repeat(np.arange(len(records)), records["period"])
    centres = np.concatenate([np.empty((0, 2)), *orbits])
    return Attractors(records, owner, centres, np.array(shapes).reshape(-1, 2, 2))


def orbit_states(p, record, phase):
    """Return the states, shape (period, 4), in which an orbit passes a forcing phase."""
    period = 2 * np.pi / p[FREQUENCY]
    begin = strobe_time(p)
    first = begin + (phase / p[FREQUENCY] - begin) % period
    times = first + period * np.arange(record["period"])
    return traces.states_at(p, record["state"], begin, times, POLISH_TOLERANCE)


def _distinct(p, motions):
    """Return one record of each orbit, by ascending max |Z1|. Mirror images count as two."""
    kept, seen = [], []
    for record in motions[np.argsort(motions["maximum_displacement"], kind="stable")]:
        known = any(
            len(orbit) == record["period"]
            and np.min(np.max(np.abs(orbit - record["state"][:2]), axis=1)) < ALIKE
            for orbit in seen
        )
        if not known:
            kept.append(record)
            seen.append(orbit_states(p, record, STROBE)[:, :2])
    return np.array(kept, motions.dtype)


def linear_flow(p, state, periods):
    """Return Z1 (n,) and dz(t)/dz(0) (n, 2, 2) at n points of an orbit, where z is (Z1, Z1')."""
    y, tangents, work = np.tile(state, 2), np.eye(4)[:2].copy(), workspace()
    times = strobe_time(p) + np.arange(periods * STEPS + 1) * 2 * np.pi / (STEPS * p[FREQUENCY])
    displacement, matrices = [y[0]], [np.eye(2)]
    for begin, end in zip(times, times[1:], strict=False):
        advance(p, y, tangents, 0, begin, end, POLISH_TOLERANCE, work)
        displacement.append(y[0])
        matrices.append(tangents[:, :2].T.copy())
    return np.array(displacement), np.array(matrices)


def neighbourhood(p, state, periods):
    """Return S for a neighbourhood of an orbit's `state`: all states z with |S (z - state)| < 1.

    All motions from the neighbourhood tend to the orbit. If this cannot be proved, S is infinite.
    """
    displacement, matrices = linear_flow(p, state, periods)
    values, vectors = np.linalg.eig(matrices[-1])
    if not np.max(np.abs(values)) < 1:
        return np.full((2, 2), np.inf)
    if np.iscomplexobj(vectors):
        vectors = np.stack([vectors[:, 0].real, vectors[:, 0].imag], axis=1)
    vectors = vectors / np.sqrt(abs(np.linalg.det(vectors)))
    forward = matrices @ vectors
    gain = np.linalg.norm(forward[:, 0], axis=1)
    kick = np.linalg.norm(np.linalg.inv(forward)[:, :, 1], axis=1)
    cubic = abs(cubic_spring(p)[1])
    square = 3 * cubic * kick * np.abs(displacement) * gain**2
    coefficients = np.array([square, cubic * kick * gain**3])
    largest = np.maximum(coefficients[:, :-1], coefficients[:, 1:])
    radius = _radius(largest, 2 * np.pi / (STEPS * p[FREQUENCY]), np.max(np.abs(values)))
    with np.errstate(divide="ignore"):
        return np.linalg.inv(vectors) / radius


def _radius(coefficients, step, contraction):
    low, high = 0.0, 10.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        # r bounds a motion's distance from the orbit. It grows at the rate a r^2 + b r^3. A step
        # takes the rate at `ahead`, the largest r possible in the step. So r is never too small.
        r = middle
        for a, b in coefficients.T:
            ahead = r + 2 * step * (a + b * r) * r * r
            if r + step * (a + b * ahead) * ahead * ahead > ahead:
                r = np.inf
                break
            r += step * (a + b * ahead) * ahead * ahead
        low, high = (middle, high) if contraction * r < FACTOR * middle else (low, middle)
    return low


def label_damped(p, states, phase, settling, known=(), workers=1, progress=None):
    """Run motions with the damper from states (n, 4); return labels, cycles run, and attractors.

    `phase` is the forcing phase of the states. The attractors are `known`, then new records.
    A label is the index of an attractor, or a flag in LABELS if the motion does not settle.
    """
    begin = phase % (2 * np.pi) / p[FREQUENCY]
    if begin > strobe_time(p):
        begin -= 2 * np.pi / p[FREQUENCY]
    rows = np.tile(p, (len(states), 1))
    running = {"workers": workers, "progress": progress}
    motions = ensemble.settle(rows, states, settling, start=begin, **running)
    labels = np.full(len(motions), BASIN_LABEL["unresolved"])
    for outcome, label in LABELS.items():
        labels[motions["outcome"] == outcome] = label
    attractors = list(known)
    settled = np.flatnonzero(motions["outcome"] == records.SETTLED)
    order = settled[np.argsort(motions["maximum_displacement"][settled], kind="stable")]
    for i in order:
        for index, each in enumerate(attractors):
            ratio = motions["maximum_displacement"][i] / each["maximum_displacement"]
            if each["period"] == motions["period"][i] and abs(ratio - 1) < SAME:
                labels[i] = index
                break
        else:
            labels[i] = len(attractors)
            attractors.append(motions[i])
    return labels, motions["periods_run"], np.array(attractors, records.MOTION)


class ReleaseSet(NamedTuple):
    """The states of the free oscillator at one frequency that lead to the goal of migration.

    The goal is the smallest free motion of period 1, the attractor with the index `goal`. `depth`
    has the axes phase, Z1', Z1. It holds the distance of each grid cell from the edge of the set,
    in the plane (Z1, Z1'/W), negative outside the set. `half` holds the half widths of the grid.
    """

    p: np.ndarray
    attractors: Attractors
    goal: int
    depth: np.ndarray
    half: np.ndarray


def release_set(oscillator, frequency, settling, *, cells=64, workers=1) -> ReleaseSet:
    """Compute the release set at PHASES phases of the forcing, on `cells`^2 coarse grid cells."""
    p = pack(oscillator, None, frequency)
    known = free_motions(oscillator, frequency, settling)
    window = REACH / 2 * np.array([known.displacement, known.speed])
    attractors = free_attractors(p, window, settling)
    ones = np.flatnonzero(attractors.records["period"] == 1)
    if len(ones) < 2 or ones[-1] != len(attractors.records) - 1:
        raise ValueError(
            f"frequency = {frequency:g}: must have a non-resonance and a resonance motion "
            "without the damper"
        )
    goal = int(ones[0])
    size = attractors.records["maximum_displacement"][-1]
    half = WIDTH * size * np.array([1.0, p[FREQUENCY]])
    depth = []
    # The goal equals its mirror image. So the set at the phase W T + pi is the mirror image of the
    # set at the phase W T, and motions are run only from phases below pi.
    for k in range(PHASES // 2):

        def reach_goal(states, phase=2 * math.pi * k / PHASES):
            arguments = attractors, settling.tolerance, settling.limit, workers
            return ensemble.label_states(p, states, phase, *arguments)[0] == goal

        inside = _refined(reach_goal, half, cells)
        depth.append(signed_distance(inside) * 2 * WIDTH * size / len(inside))
    depth = np.array(depth + [each[::-1, ::-1] for each in depth])
    return ReleaseSet(p, attractors, goal, depth, half)


def _refined(inside, half, cells):
    mask = inside(_centres(half, cells)).reshape(cells, cells)
    for _ in range(int(math.log2(REFINED))):
        # Split each cell in four. Test the parts only if the cell lies at the edge of the set.
        edge = maximum_filter(mask, 3) != minimum_filter(mask, 3)
        fine, edge = (np.kron(each, np.ones((2, 2), bool)) for each in (mask, edge))
        cells *= 2
        fine[edge] = inside(_centres(half, cells)[edge.ravel()])
        mask = fine
    return mask


def _centres(half, cells):
    middles = (np.arange(cells) + 0.5) * 2 / cells - 1
    return np.stack(np.meshgrid(half[0] * middles, half[1] * middles), axis=-1).reshape(-1, 2)


def signed_distance(inside):
    """Return each cell's distance from the edge of a set, in cell widths (outside: negative)."""
    if inside.all() or not inside.any():
        return np.where(inside, np.inf, -np.inf)
    # The transform measures to the centre of the nearest cell beyond the edge: half a cell too far.
    inward, outward = distance_transform_edt(inside), distance_transform_edt(~inside)
    return np.where(inside, inward - 0.5, 0.5 - outward)
