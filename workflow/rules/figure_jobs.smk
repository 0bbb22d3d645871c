"""What each figure draws, and what its caption says."""


def figures(*kinds):
    """Names of the figures of some kinds."""
    return [name for name, figure in config["figures"].items() if figure["kind"] in kinds]


def one_of(choices):
    """Pattern of a wildcard that takes one of some values, or none if there are none."""
    return "|".join(choices) or "(?!)"


def figure_kind(wildcards):
    return config["figures"][wildcards.figure]["kind"]


def figure_entries(wildcards):
    return config["figures"][wildcards.figure]["data"]


def figure_caption(wildcards, output):
    """What the report's caption says of a figure.

    Since it takes `output`, Snakemake does not compare it: a title is not drawn.
    """
    return figure_entry(wildcards.figure)


def figure_entry(name):
    """A figure's entry, with what its caption says of the data in place of the names alone."""
    figure = config["figures"][name]
    return figure | {"data": {name: said(figure["kind"], name) for name in figure["data"]}}


def caption_of(name, wildcards):
    return {name: figure_entry(name)}


# What captions say of an entry beside its oscillator and damper.
SAID = {
    "design_rules": ["restitutions", "contact_stiffnesses", "frequencies"],
    "studies": ["frequency", "restitution"],
    "balance_map": ["damping", "linear_frequency", "mass_ratio", "clearance", "restitution"],
}


def said(kind, name):
    """Parameters of what a figure draws, those in its caption alone; a schematic has none."""
    if kind == "schematic":
        return {}
    if kind == "free":
        return {"oscillator": oscillator_of(name)}
    entry = config[SECTIONS[kind]][name]
    found = {key: entry[key] for key in SAID.get(kind, ["frequency"]) if key in entry}
    if "oscillator" in entry:
        found["oscillator"] = oscillator_of(entry["oscillator"])
        if kind != "studies":
            found["damper"] = damper_of(entry) if "mass_ratio" in entry else None
    if found.get("damper") and kind not in ("harmonics", "contact_model"):
        del found["damper"]["contact_stiffness"]
    return found


def figure_module(wildcards):
    """Full name of the module that draws a figure; it is called as the kind, but for two."""
    kind = figure_kind(wildcards)
    others = {
        "release": "migration",
        "branches": "orbits",
        "design": "harmonic_balance",
        "harmonics": "harmonic_convergence",
        "verdicts": "method_verdicts",
    }
    return f"impact_damper.figures.{others.get(kind, kind)}"


def figure_code(wildcards):
    """Sources of the drawing script and of the module that draws a figure."""
    return code("draw.py", module_file(figure_module(wildcards)))


def figure_data(wildcards):
    """Files that a figure draws, by stage."""
    figure = config["figures"][wildcards.figure]
    kind, chosen = figure["kind"], figure["data"]
    if kind == "free":
        return {"free_branches": data("free_branches", chosen)}
    if kind in ("response", "branches"):
        oscillators = sorted({config["curves"][name]["oscillator"] for name in chosen})
        stages = ["branches"] if kind == "branches" else ["design", "response", "subharmonic"]
        return {"free_branches": data("free_branches", oscillators)} | {
            stage: data(stage, [name for name in chosen if name in names(stage)])
            for stage in dict.fromkeys([*stages, "branches"])
        }
    stage = "migration" if kind == "release" else kind
    return {stage: data(stage, chosen)}


def caption_template(name):
    """Template of a figure's caption."""
    kind = config["figures"][name]["kind"]
    return local(ROOT / "workflow/report" / f"{kind}.rst")
