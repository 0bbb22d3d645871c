"""Steps of the design of a damper for a machine, in the order in which they are run.

A start is a random initial state. A motion is quiet if its largest displacement is at most the
quiet limit. The cliff is the gap beyond which fewer starts lead to quiet motions.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from impact_damper.data.datasets import shown_variable
from impact_damper.data.variables import VARIABLES
from impact_damper.design import choose, cliff, compare, deviations, labelled, operating
from impact_damper.design.absorber_responses import SHARES, absorber_responses
from impact_damper.design.chosen_motions import reached_motions
from impact_damper.design.kept_steps import KeptSteps
from impact_damper.design.masses import alternatives, judge
from impact_damper.design.refine import dependence
from impact_damper.design.ring_down import ring_down
from impact_damper.design.screen import screen
from impact_damper.design.swept_sine import swept_sine
from impact_damper.design.task import Task
from impact_damper.model.hertz import HertzContact
from impact_damper.model.settling import Settling
from impact_damper.motions.response import frequency_response
from impact_damper.orbits.orbit_branches import orbit_branches

# A swept sine changes the frequency at the rate SWEEP (damping ratio x natural frequency in Hz)^2
# Hz/s, or faster if it would last longer than MOST_SWEPT cycles.
SWEEP, MOST_SWEPT = 4.0, 6000
# Tuned absorbers, with which the damper is compared, are tuned for the smallest maximum of the
# response over a range of frequencies. The range extends from ABSORBED[0] times the lowest
# frequency of band and resonance to ABSORBED[1] times the highest.
ABSORBED = 0.5, 2.0
# BARE: variables of the response without the damper, with their names in the dataset of a design.
# TRANSIENT: variables and dimensions of transients, which get a prefix in the dataset of a design.
BARE = {
    "followed_value": "bare_frequency",
    "orbit_displacement": "bare_displacement",
    "orbit_stability": "bare_stability",
    "orbit_branch": "bare_branch",
}
TRANSIENT = ("time", "frequency", "envelope", "window_contacts", "transient_status", "window")


class DesignSteps(NamedTuple):
    """The steps of a design, each of which returns a dataset.

    Attributes
    ----------
    task : Task
    contact : HertzContact or None
    kept : KeptSteps
    workers : int
    progress : bool or None
        Whether progress bars are shown.
    """

    task: Task
    contact: HertzContact | None
    kept: KeptSteps
    workers: int
    progress: bool | None

    def run(self):
        """Return the `choose.Choice` of the gap, and a list of the datasets of all steps."""
        task, step = self.task, self.kept.step
        first = step("screening", self.screening)
        compared = step("comparison", lambda: self.comparison(first))
        comparison = labelled.comparison_of(compared, task)
        limit = comparison.limit
        edges = step("cliff", lambda: self.cliff(comparison))
        kinds = VARIABLES["design_choice"].flags
        kind = next(name for name, number in kinds.items() if number == edges["design_choice"])
        choice = choose.Choice(float(edges["design_gap"]), kind)
        gap = choice.gap
        frequency = _critical(edges, first)
        response = step("response", lambda: self.response(gap))
        cloud = step("tolerances", lambda: self.deviations(choice, frequency, limit))
        parts = [
            first,
            compared,
            edges,
            step("orbits", lambda: self.orbits(gap, frequency)),
            response,
            step("motions", lambda: reached_motions(task, gap, response, limit, self.contact)),
            cloud,
            step("maps", lambda: self.maps(gap, frequency, limit)),
            step("masses", lambda: self.masses(gap, limit)),
            step("transients", lambda: self.transients(gap)),
            step("competitors", self.competitors),
        ]
        return choice, parts

    def running(self, title) -> dict:
        """Return the arguments `workers` and `progress` of a step, a dict."""
        return {"workers": self.workers, "progress": title if self.progress else None}

    def screening(self):
        """Return the first look: the machine alone, rules for the gap, and exact orbits."""
        return labelled.screening_dataset(
            self.task, screen(self.task, **self.running("First look"))
        )

    def comparison(self, first):
        """Return the comparisons of gaps by starts; `first` is the dataset of the screening."""
        span, limit = first["screened_gap"].values[[0, -1]], float(first["orbit_limit"])
        running = self.running("Gaps, coarsely")
        coarse = compare.coarse_comparison(self.task, span, limit, **running)
        running = self.running("Candidates")
        candidates = compare.candidate_comparison(self.task, coarse, **running)
        return labelled.comparison_dataset(coarse, candidates)

    def cliff(self, comparison):
        """Return the chosen gap, the cliffs around it, and lives of chaos beyond them."""
        task, limit = self.task, comparison.limit
        running = self.running("Tolerances of gaps")
        choice, edges = cliff.choose_with_edges(task, comparison, **running)
        known = [edge for edge in reversed(edges) if np.isfinite(edge.frequency)]
        lives = cliff.find_lives(task, known[0], limit, **self.running("Lives")) if known else None
        return labelled.cliff_dataset(choice, edges, lives)

    def orbits(self, gap, frequency):
        """Return the quiet orbit over the gap and over the force, and its derivatives.

        `gap` is in mm and `frequency` in Hz, as in the other steps.
        """
        force = "force" if self.task.machine.unbalance is None else "unbalance"
        orbit = cliff.quiet_orbit(self.task, gap, frequency, workers=self.workers)
        over_gap, over_force = (
            cliff.quiet_branch(self.task, gap, frequency, orbit, parameter)
            for parameter in ("clearance", force)
        )
        found = labelled.branch_dataset(self.task, over_gap, "gap")
        found = found.merge(labelled.branch_dataset(self.task, over_force, "force"))
        found = found.merge(labelled.dependence_dataset(dependence(self.task, orbit)))
        return found.assign(branch_frequency=shown_variable("branch_frequency", frequency))

    def response(self, gap):
        """Return the response with and without the damper: motions and branches of orbits."""
        task, span = self.task, self.task.band
        # Motions that have not settled after the largest number of cycles are run further. The
        # comparisons of gaps do not do this, to save time.
        settling = replace(task.settling, further=Settling().further)
        searched = {"starts": task.starts, "seed": task.seed, "settling": settling}
        searched |= self.running("Response")
        damper = task.damper(1e-3 * gap)
        motions = frequency_response(task.machine, damper, task.grid, **searched)
        orbits = orbit_branches(task.machine, damper, span=span, motions=[motions])
        alone = frequency_response(task.machine, None, task.grid, **searched)
        alone = orbit_branches(task.machine, None, span=span, motions=[alone])
        bare = {new: shown_variable(new, alone[old].values) for old, new in BARE.items()}
        # The motions have a variable `branch`, so the dimension `branch` of the orbits is renamed.
        # All steps get the same coordinate `frequency`.
        motions = motions.assign_coords(frequency=shown_variable("frequency", task.grid))
        return motions.merge(orbits.rename_dims(branch="curve")).merge(xr.Dataset(bare))

    def deviations(self, choice, frequency, limit):
        """Return the tests with deviating values and with new starts; `limit` is in mm."""
        task, gap = self.task, choice.gap
        running = self.running("Tolerances")
        samples = deviations.sample_tolerances(task, gap, frequency, limit, **running)
        running = self.running("Unseen starts")
        unseen = deviations.check_unseen(task, gap, limit, **running)
        promise = deviations.promise(task, choice.kind, samples, unseen)
        return labelled.deviations_dataset(samples, unseen, promise, limit)

    def maps(self, gap, frequency, limit):
        """Return maps over frequency and force, and over gap and restitution."""
        task, running = self.task, self.running("Operating range")
        orbit = cliff.quiet_orbit(task, gap, frequency, workers=self.workers)
        given = (task, gap, frequency, orbit, limit)
        forces = operating.force_map(*given, **running)
        return forces.merge(operating.damper_map(*given, **running))

    def masses(self, gap, limit):
        """Return this damper and dampers of other masses, judged by the same tests."""
        running = self.running("Other masses")
        found = [judge(self.task, gap, limit, **running)]
        return labelled.masses_dataset(found + alternatives(self.task, limit, **running))

    def transients(self, gap):
        """Return a swept sine and a ring-down, each with and without the damper."""
        task, machine = self.task, self.task.machine
        damper = task.damper(1e-3 * gap)
        # A sweep over a nonlinear machine leads to its large motions only if it passes all its
        # resonances, which may lie outside the band.
        low = min(task.band[0], task.resonance[0])
        high = max(task.band[1], task.resonance[1])
        span = (high**2 - low**2) / 2
        decay = machine.viscous_damping / (4 * np.pi * machine.mass)
        rate = min(max(SWEEP * decay**2, span / MOST_SWEPT), 0.01 * low**2)
        swept = swept_sine(machine, damper, (low, high), rate)
        first = 1e-3 * float(task.millimetres(1.0))
        rung = ring_down(machine, damper, first)
        return _prefixed(swept, "sweep").merge(_prefixed(rung, "ring"))

    def competitors(self):
        """Return the responses with a tuned absorber of the same mass."""
        task = self.task
        low, high = task.resonance
        band = ABSORBED[0] * min(low, task.band[0]), ABSORBED[1] * max(high, task.band[1])
        return absorber_responses(task.machine, task.mass, task.grid, SHARES, band=band)


def _critical(edges, first):
    """Return the frequency (Hz) at which the cliff is met first.

    Without a cliff, return the frequency at which the machine without damper moves most. `edges`
    and `first` are the datasets of the steps `cliff` and `screening`.
    """
    known = edges["cliff_frequency"].values[np.isfinite(edges["cliff_frequency"].values)]
    return float(known[-1]) if len(known) else float(first["worst_frequency"])


def _prefixed(data, prefix):
    """Return the dataset of a transient with a prefix before the names of its variables."""
    names = {name: f"{prefix}_{name}" for name in TRANSIENT}
    return data.rename({old: new for old, new in names.items() if old in {*data, *data.dims}})
