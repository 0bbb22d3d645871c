"""What each figure draws, and what its caption says."""

from impact_damper.workflow.captions import in_words


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
    """A figure's entry, and in words the parameters of the cases that it draws."""
    figure = config["figures"][name]
    return figure | {"cases": "; ".join(said(figure["kind"], case) for case in figure["data"])}


def caption_of(name, wildcards):
    return {name: figure_entry(name)}


# Keys of an entry that hold values of a parameter, beside its oscillator and damper.
VALUES = {
    "design_rules": {
        "restitutions": "restitution",
        "contact_stiffnesses": "contact_stiffness",
        "frequencies": "frequency",
    },
    "studies": {"frequency": "frequency", "restitution": "restitution"},
}
# Kinds of figures whose captions name each case.
NAMED = ("accuracy", "design_rules")


def said(kind, name):
    """Parameters of one case that a figure draws, in words; a schematic has none."""
    if kind == "schematic":
        return ""
    if kind == "free":
        return in_words(oscillator_of(name))
    entry = config[SECTIONS[kind]][name]
    values = {}
    if "oscillator" in entry:
        values |= oscillator_of(entry["oscillator"])
    if kind == "balance_map":
        values |= entry
    elif "mass_ratio" in entry and kind != "studies":
        values |= damper_of(entry)
        if kind not in ("harmonics", "contact_model"):
            del values["contact_stiffness"]
    keys = VALUES.get(kind, {"frequency": "frequency"})
    values |= {parameter: entry[key] for key, parameter in keys.items() if key in entry}
    return f"{name.replace('_', ' ')}: {in_words(values)}" if kind in NAMED else in_words(values)


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
