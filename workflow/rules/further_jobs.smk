"""Jobs of the stages beyond the paper: exact orbits, harmonics, rules, and where methods fail."""


def design_orbit_job(name):
    curve = config["curves"][name]
    return {
        "oscillator": oscillator_of(curve["oscillator"]),
        "damper": damper_of(curve),
        "search": search("sweep_starts"),
        "settling": settling(),
    }


def span_of(oscillator):
    """Ends of an oscillator's range of frequencies."""
    span = config["oscillators"][oscillator]["frequencies"]
    return [span["first"], span["last"]]


def free_branches_job(name):
    return {
        "oscillator": oscillator_of(name),
        "frequencies": span_of(name),
    }


def branches_job(name):
    curve = config["curves"][name]
    return {
        "oscillator": oscillator_of(curve["oscillator"]),
        "damper": damper_of(curve),
        "frequencies": span_of(curve["oscillator"]),
    }


def branch_motions(wildcards):
    """Files of the motions from which the branches of a curve begin."""
    stages = config["curves"][wildcards.curve]["stages"]
    return [
        path
        for stage in ("response", "subharmonic")
        if stage in stages
        for path in data(stage, [wildcards.curve])
    ]


def harmonics_job(name):
    scene = config["harmonics"][name]
    return {
        "oscillator": oscillator_of(scene["oscillator"]),
        "damper": damper_of(scene) if "mass_ratio" in scene else None,
        "frequency": scene["frequency"],
        "highest": scene["highest"],
        "highest_cold": scene["highest_cold"],
    }


def design_rules_job(name):
    grids = config["design_rules"][name]
    return {
        "oscillator": oscillator_of(grids["oscillator"]),
        "grid": [
            grids[key]
            for key in ("mass_ratios", "restitutions", "contact_stiffnesses", "frequencies")
        ],
    }


def balance_map_job(name):
    entry = config["balance_map"][name]
    fixed = {key: entry[key] for key in ("damping", "linear_frequency") if key in entry}
    # the function follows rule (19) where it is given no clearance
    fixed |= {key: value for key, value in damper_of(entry).items() if value != "rule"}
    return {
        "parameter": entry["parameter"],
        "values": grid(entry["values"], "map_values"),
        "frequency_ratios": grid(entry["frequency_ratios"], "map_frequencies"),
        "fixed": fixed,
        "settling": settling(),
    }


def even(axis):
    """Arguments of `numpy.linspace` for an axis of a study, which is a number or a range."""
    if isinstance(axis, dict):
        return [axis["first"], axis["last"], axis["points"]]
    return [axis, axis, 1]


def study_cells_job(name, chunk="1-of-1"):
    study = config["studies"][name]
    axes = {key: even(study[key]) for key in AXES}
    number, chunks = map(int, chunk.split("-of-"))
    cells = math.prod(points for _, _, points in axes.values())
    return {
        "oscillator": oscillator_of(study["oscillator"]),
        "axes": axes,
        "cells": [cells * (number - 1) // chunks, cells * number // chunks],
        "contact_stiffness": config["contact_stiffness"],
        "search": search("study_starts"),
        "settling": settling(),
    }


def contact_model_job(name):
    model = config["contact_model"][name]
    return {
        "oscillator": oscillator_of(model["oscillator"]),
        "damper": damper_of(model),
        "frequencies": model["frequencies"],
        "used": model["restitutions"],
        "periods": model["periods"],
        "starts": config["search"]["scan_starts"],
        "seed": config["seed"],
        "map": {
            "restitutions": [model["smallest_restitution"], 1, model["cells"]["restitutions"]],
            "loads": [model["largest_load"], model["cells"]["loads"]],
        },
        "settling": settling(),
    }


def rigid_limit_job(name):
    limit = config["rigid_limit"][name]
    ends = [limit["stiffnesses"]["first"], limit["stiffnesses"]["last"]]
    frequencies = [limit["frequencies"]["first"], limit["frequencies"]["last"]]
    return {
        "oscillator": oscillator_of(limit["oscillator"]),
        "damper": damper_of(limit),
        "frequency": limit["frequency"],
        "frequencies": [*frequencies, limit["cells"]["frequencies"]],
        "stiffnesses": [*ends, limit["cells"]["stiffnesses"]],
        "starts": config["search"]["scan_starts"],
        "seed": config["seed"],
        "settling": settling(),
    }


def missed_contacts_job(name):
    given = config["missed_contacts"][name]
    return given | {"oscillator": oscillator_of(given["oscillator"]), "seed": config["seed"]}


def stable_steps_job(name):
    given = config["stable_steps"][name]
    return {
        "oscillator": oscillator_of(given["oscillator"]),
        "damper": damper_of(given),
        **{
            key: given[key]
            for key in ("frequency", "stiffnesses", "scaled_steps", "most_steps", "periods")
        },
    }


def verdicts_job(name):
    given = config["verdicts"][name]
    return given | {
        "oscillator": oscillator_of(given["oscillator"]),
        "contact_stiffness": config["contact_stiffness"],
    }


def accuracy_job(name):
    scene = config["scenes"][name]
    return {
        "oscillator": oscillator_of(scene["oscillator"]),
        "damper": damper_of(scene) if "mass_ratio" in scene else None,
        **{key: scene[key] for key in ("frequency", "state", "periods", "motion", "accuracy")},
        "tolerance": scene.get("tolerance"),
        "settings": config["comparison"],
    }
