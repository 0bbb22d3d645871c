"""What each job needs: its parameters, in one dictionary that holds no others, and its data."""

from functools import partial
from itertools import chain

# Section of the configuration whose entries a stage computes, each into a file of its name.
STAGES = {
    "free_design": "oscillators",
    "design": "curves",
    "design_orbit": "curves",
    "free": "oscillators",
    "response": "curves",
    "free_branches": "oscillators",
    "branches": "curves",
    "motion": "motions",
    "collisions": "collisions",
    "optimum": "optima",
    "subharmonic": "curves",
    "migration": "migration",
    "release_scan": "release_scans",
    "contact_model": "contact_model",
    "rigid_limit": "rigid_limit",
    "design_rules": "design_rules",
    "harmonics": "harmonics",
    "missed_contacts": "missed_contacts",
    "stable_steps": "stable_steps",
    "verdicts": "verdicts",
    "balance_map": "balance_map",
    "accuracy": "scenes",
    "studies": "studies",
}

# Stages whose data a table holds.
TABLES = {
    "harmonic_balance": ["design", "design_orbit"],
    "bands": ["design", "free_branches", "branches", "response"],
    "optimum": ["optimum"],
    "subharmonic": ["free_branches", "branches", "subharmonic"],
    "orbits": ["free_branches", "branches"],
    "bifurcations": ["free_branches", "branches"],
    "migration": ["migration"],
    "release_scan": ["release_scan"],
    "contact_model": ["contact_model"],
    "contact_motions": ["contact_model"],
    "rigid_limit": ["rigid_limit"],
    "design_rules": ["design_rules", "optimum"],
    "harmonic_convergence": ["harmonics"],
    "grazing": ["missed_contacts"],
    "steps": ["stable_steps"],
    "verdicts": ["verdicts"],
    "balance_map": ["balance_map"],
    "models": ["accuracy"],
    "readings": ["design", "free_branches", "branches", "response", "optimum"],
    "claims": [
        "design",
        "design_orbit",
        "free_branches",
        "branches",
        "response",
        "motion",
        "collisions",
        "optimum",
        "subharmonic",
        "migration",
        "release_scan",
    ],
}

# Module of `tables` that makes a table.
TABLE_MODULES = {
    "harmonic_balance": "design",
    "harmonic_convergence": "design",
    "bands": "responses",
    "subharmonic": "responses",
    "orbits": "responses",
    "bifurcations": "responses",
    "optimum": "clearance",
    "migration": "migration",
    "release_scan": "migration",
    "contact_model": "contact",
    "contact_motions": "contact",
    "rigid_limit": "contact",
    "design_rules": "clearance",
    "grazing": "integrators",
    "steps": "integrators",
    "verdicts": "integrators",
    "balance_map": "balance_map",
    "models": "accuracy",
    "readings": "accuracy",
}


def names(stage):
    """Names of the entries that a stage computes."""
    section = config[STAGES[stage]]
    return [name for name, entry in section.items() if stage in entry.get("stages", [stage])]


def data(stage, chosen=None):
    """Files of a stage, all or those of the chosen entries."""
    return expand(f"<results>/{stage}/{{name}}.nc", name=names(stage) if chosen is None else chosen)


def parts(job, stage):
    """Parameters of a stage's jobs, each with its name; `job` gives all of them for an entry.

    One by one, so that a dry run tells which of them changed; and with its name in its value, for
    Snakemake compares the values as a set. The entry's name is one of them, since a file of data
    holds it: another entry with the same values shall not take that file from a cache.
    """

    def named(wildcards):
        return {"name": "/".join(wildcards)}

    def part(key, wildcards):
        return {key: job(*wildcards)[key]}

    return {"name": named} | {key: partial(part, key) for key in chain(*map(job, names(stage)))}


def oscillator_of(name):
    entry = config["oscillators"][name]
    return {key: entry[key] for key in ("damping", "linear_frequency")}


def damper_of(entry):
    keys = ("mass_ratio", "clearance", "restitution", "contact_stiffness")
    given = {key: entry[key] for key in keys if key in entry}
    return {"contact_stiffness": config["contact_stiffness"]} | given


def grid(span, points):
    """Arguments of `numpy.linspace`."""
    return [span["first"], span["last"], config["points"][points]]


def frequencies_of(oscillator, points):
    return grid(config["oscillators"][oscillator]["frequencies"], points)


def search(starts):
    given = config["search"]
    return {"starts": given[starts], "radius": given["radius"], "seed": config["seed"]}


def settling():
    """How motions are run, at the tolerance of the scene that is named."""
    given = {key: value for key, value in config["settling"].items() if key != "scene"}
    return given | {"tolerance": config["scenes"][config["settling"]["scene"]]["tolerance"]}


def free_design_job(name):
    return {
        "oscillator": oscillator_of(name),
        "frequencies": frequencies_of(name, "harmonic_balance"),
    }


def design_job(name):
    curve = config["curves"][name]
    return {
        "oscillator": oscillator_of(curve["oscillator"]),
        "damper": damper_of(curve),
        "frequencies": frequencies_of(curve["oscillator"], "harmonic_balance"),
    }


def free_job(name):
    return {
        "oscillator": oscillator_of(name),
        "frequencies": frequencies_of(name, "free"),
        "search": search("starts"),
        "settling": settling(),
    }


def response_job(name):
    curve = config["curves"][name]
    return {
        "oscillator": oscillator_of(curve["oscillator"]),
        "damper": damper_of(curve),
        "frequencies": frequencies_of(curve["oscillator"], "simulated"),
        "search": search("starts"),
        "settling": settling(),
    }


def motion_job(name):
    motion = config["motions"][name]
    return {
        "oscillator": oscillator_of(motion["oscillator"]),
        "damper": damper_of(motion),
        "frequency": motion["frequency"],
        "settling": settling(),
    }


def collisions_job(name):
    motion = config["collisions"][name]
    return {
        "oscillator": oscillator_of(motion["oscillator"]),
        "damper": damper_of(motion),
        "frequency": motion["frequency"],
        "radius": config["search"]["radius"],
        "seed": config["seed"],
    }


def optimum_job(name):
    optimum = config["optima"][name]
    return {
        "oscillator": oscillator_of(optimum["oscillator"]),
        "damper": damper_of(optimum),
        "frequency": optimum["frequency"],
        "clearances": grid(optimum["clearances"], "clearances"),
        "search": search("sweep_starts"),
        "settling": settling(),
    }


def migration_job(name):
    run = config["migration"][name]
    return {
        "oscillator": oscillator_of(run["oscillator"]),
        "damper": damper_of(run),
        "frequency": run["frequency"],
        "controller": config["controller"] | {"longest_hold": run["longest_hold"]},
        "seed": config["seed"],
        "settling": settling(),
    }


def release_scan_job(name):
    scan = config["release_scans"][name]
    return {
        "oscillator": oscillator_of(scan["oscillator"]),
        "damper": damper_of(scan),
        "frequencies": grid(scan["frequencies"], "scanned"),
        "search": search("scan_starts"),
        "releases": config["controller"]["releases"],
        "lifetime": scan["lifetime"],
        "settling": settling(),
    }


def table_module(wildcards):
    """Full name of the module that makes a table."""
    return f"impact_damper.tables.{TABLE_MODULES[wildcards.table]}"


def table_code(wildcards):
    """Sources of a table's script and of the module that makes it."""
    return code("table.py", module_file(table_module(wildcards)))


def table_data(wildcards):
    """Files that a table condenses, by stage."""
    return {stage: data(stage) for stage in TABLES[wildcards.table]}
