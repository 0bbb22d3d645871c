"""What depends on what, written down from the paper's stages and not taken from the workflow.

A job has the name of what it makes, as `free/h215`. `{0}` is what the first star of a key stands
for; a star in a job's name is every entry; what is not there is left out. A study is made from
chunks, as `study_chunks/plane/1-of-4`.
"""

# Stages that an entry of a section goes through.
STAGES = {
    "oscillators": ["free_design", "free", "free_branches"],
    "curves": ["design", "design_orbit", "response", "subharmonic", "branches"],
    "motions": ["motion"],
    "collisions": ["collisions"],
    "optima": ["optimum"],
    "migration": ["migration"],
    "release_scans": ["release_scan"],
    "harmonics": ["harmonics"],
    "design_rules": ["design_rules"],
    "contact_model": ["contact_model"],
    "rigid_limit": ["rigid_limit"],
    "balance_map": ["balance_map"],
    "missed_contacts": ["missed_contacts"],
    "stable_steps": ["stable_steps"],
    "verdicts": ["verdicts"],
    "scenes": ["accuracy"],
    "studies": ["study_chunks", "studies"],
}

# Stages that run motions until they settle.
SETTLING = (
    "free/* response/* subharmonic/* motion/* optimum/* design_orbit/* migration/* release_scan/* "
    "contact_model/* rigid_limit/* balance_map/* study_chunks/*"
)
SEARCHING = "free/* response/* subharmonic/* optimum/* design_orbit/* release_scan/* study_chunks/*"

# Jobs that read a value, where that is not every stage of the entry in which it stands.
READERS = {
    "seed": f"{SEARCHING} collisions/* migration/* contact_model/* rigid_limit/* missed_contacts/*",
    "points.harmonic_balance": "free_design/* design/*",
    "points.free": "free/*",
    "points.simulated": "response/* subharmonic/*",
    "points.clearances": "optimum/*",
    "points.scanned": "release_scan/*",
    "points.map_*": "balance_map/*",
    "search.starts": "free/* response/* subharmonic/*",
    "search.sweep_starts": "optimum/* design_orbit/*",
    "search.scan_starts": "release_scan/* contact_model/* rigid_limit/*",
    "search.study_starts": "study_chunks/*",
    "chunks": "study_chunks/*",
    "search.radius": f"{SEARCHING} collisions/*",
    "settling.*": SETTLING,
    "controller.*": "migration/*",
    "controller.releases": "migration/* release_scan/*",
    "comparison.*": "accuracy/*",
    # Not what is at one frequency of its own.
    "oscillators.*.frequencies.*": "free_design/{0} free/{0} free_branches/{0}",
}

# Stages whose range of frequencies is that of the oscillator.
OVER_FREQUENCY = ("design", "response", "subharmonic", "branches")

# Sections without contacts, or with stiffnesses of their own.
OTHER_STIFFNESS = ("oscillators", "harmonics", "design_rules", "missed_contacts")

# Tables, and the stages whose data they hold.
TABLES = {
    "harmonic_balance": "design design_orbit",
    "bands": "design free_branches branches response",
    "optimum": "optimum",
    "subharmonic": "free_branches branches subharmonic",
    "orbits": "free_branches branches",
    "bifurcations": "free_branches branches",
    "migration": "migration",
    "release_scan": "release_scan",
    "contact_model": "contact_model",
    "contact_motions": "contact_model",
    "rigid_limit": "rigid_limit",
    "design_rules": "design_rules optimum",
    "harmonic_convergence": "harmonics",
    "grazing": "missed_contacts",
    "steps": "stable_steps",
    "verdicts": "verdicts",
    "balance_map": "balance_map",
    "models": "accuracy",
    "readings": "design free_branches branches response optimum",
    "claims": "design design_orbit free_branches branches response motion collisions optimum "
    "subharmonic migration release_scan",
}

# Sections whose entries a kind of figure draws, where it is not that of the same name.
DRAWN = {
    "free": "oscillators",
    "design": "curves",
    "response": "curves",
    "branches": "curves",
    "motion": "motions",
    "optimum": "optima",
    "release": "migration",
    "accuracy": "scenes",
}
# Scripts, and the jobs that they do.
SCRIPTS = {
    "free_harmonic_balance": "free_design/*",
    "harmonic_balance": "design/*",
    "design_orbit": "design_orbit/*",
    "free_response": "free/*",
    "frequency_response": "response/*",
    "free_branches": "free_branches/*",
    "damped_branches": "branches/*",
    "steady_motion": "motion/*",
    "collisions": "collisions/*",
    "clearance_sweep": "optimum/*",
    "subharmonic_suppression": "subharmonic/*",
    "migration_trials": "migration/*",
    "release_destinations": "release_scan/*",
    "contact_map": "contact_model/*",
    "rigid_error": "rigid_limit/*",
    "optima_against_rules": "design_rules/*",
    "harmonic_convergence": "harmonics/*",
    "grazing_passages": "missed_contacts/*",
    "fixed_step_runs": "stable_steps/*",
    "method_verdicts": "verdicts/*",
    "harmonic_balance_map": "balance_map/*",
    "scene_accuracy": "accuracy/*",
    "study_cells": "study_chunks/*",
    "study_grid": "studies/*",
    "captions": "captions",
    "claims": "tables/claims",
    "table": "tables/*",
    "draw": "figures/*",
    "draw_schematic": "figures/*",
}
